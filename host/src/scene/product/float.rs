//! The play in which a hole floats on its pin, or a datum shifts in its boundary.

use slipfit_tolerance::{
    model::{
        Contributor, Variation, ZoneRule,
        nested::{Nest, Nested},
        widening::Widening,
    },
    product::float::{Float, Size},
};

use super::draft::Draft;

/// The play of a hole on a pin, each with its diameter (m) in the middle of its limits: a contributor called `name`, that goes by
/// `rule`, if it floats at all. It tilts if `tilt`, see [`Float::tilt`], is not 0.
pub(super) fn floating(
    name: String,
    fit: Option<usize>,
    diameters: [(Size, f64); 2],
    rule: Option<ZoneRule>,
    tilt: f64,
    draft: &mut Draft,
) -> Float {
    let variation = rule.map(|rule| match tilt > 0.0 {
        true => Variation::Nested(Nested { of: Nest::Ends, rule, tilts: 1.0 }),
        false => Variation::Disc(rule),
    });
    let first = variation.map(|variation| {
        let count = variation.variables();
        draft.add(Contributor { name, variation }, &[0.0; 4][..count])
    });
    let [hole, pin] = diameters.map(|(_, middle)| middle);
    for ((size, _), sign) in diameters.into_iter().zip([1.0, -1.0]) {
        if let (Size::Actual(size), Some(zone), true) = (size, first, hole > pin) {
            draft.widenings.push(Widening { zone, size, growth: [sign / (hole - pin); 2] });
        }
    }
    Float { fit, diameters: diameters.map(|(size, _)| size), first, tilt: if rule.is_some() { tilt } else { 0.0 } }
}
