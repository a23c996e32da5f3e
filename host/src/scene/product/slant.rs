//! Whether features are drawn as their orientations to datums say.

use slipfit_tolerance::{number::fixed, product::feature::Shape};

use super::{Draft, callout::Callout};

/// The sine of the angle from which on what is drawn is another direction.
const SLANTED: f64 = 0.02;

/// Warns of a parallelism or a perpendicularity between features that are drawn at another angle.
pub(super) fn warn(index: usize, callout: &Callout, draft: &Draft) {
    let is_parallel = match callout.name {
        "parallelism" => true,
        "perpendicularity" => false,
        _ => return,
    };
    let Some(datum) = callout.datums.first() else { return };
    let [own, other] = [index, datum.feature].map(|feature| &draft.assembly.features[feature]);
    if [own.shape, other.shape].contains(&Shape::Point) {
        return;
    }
    let along: f64 = own.nominal[1].iter().zip(other.nominal[1]).map(|(a, b)| a * b).sum();
    // An axis lies along a face where it is at a right angle to the face's normal.
    let expected_along = is_parallel == (own.shape == other.shape);
    let off = if expected_along { libm::sqrt((1.0 - along * along).max(0.0)) } else { along.abs() };
    if off > SLANTED {
        let angle = libm::acos(along.abs().min(1.0)).to_degrees();
        let angle = if own.shape == other.shape { angle } else { 90.0 - angle };
        callout.field.warn(&format!(
            "the {} of {}: it is drawn at {}° to its datum {}",
            callout.name,
            draft.feature_names[index],
            fixed(angle, 1),
            draft.feature_names[datum.feature]
        ));
    }
}
