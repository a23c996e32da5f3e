//! Lets features vary in the zones of their tolerances, a narrower one within a wider one.
//!
//! A location holds place and tilts, an orientation tilts, a form both without a datum. Where two of them are given the wider
//! zone keeps what it holds, and the narrower one takes its part of it: a refinement never adds.

use std::ops::Range;

use slipfit_tolerance::{
    model::SIGMA_ZONE,
    model::{
        Contributor, Variation, ZoneRule,
        nested::{Nest, Nested},
        widening::Widening,
    },
    product::{dimension::Toleranced, feature::Shape},
};

use crate::scene::{Problem, SceneError};

use super::{
    draft::{Draft, FeatureDraft},
    geometric::{Callout, Limits, shift},
};

/// Lets a feature vary in the zone of its location; an `orientation` narrows its tilts.
///
/// # Errors
/// A bonus that the zones cannot have together.
pub(super) fn located(
    made: &mut FeatureDraft,
    location: &Callout,
    orientation: Option<&Callout>,
    draft: &mut Draft,
) -> Result<(), SceneError> {
    let direction = made.feature.nominal[1];
    let width = location.width;
    let name = match orientation {
        Some(orientation) => format!("{} {}, {}", made.name, location.name, orientation.name),
        None => format!("{} {}", made.name, location.name),
    };
    let nested = orientation.map(|orientation| {
        // A location that only shifts leaves the tilts to the orientation.
        let rule = if location.rule == ZoneRule::Translation { orientation.rule } else { location.rule };
        (rule, (orientation.width / width).min(1.0))
    });
    let nested =
        nested.or((made.feature.shape == Shape::Axis && location.holds_tilts()).then_some((location.rule, 1.0)));
    // An orientation that is as wide narrows nothing.
    let bonus = location.bonus.or(orientation.and_then(|orientation| orientation.bonus));
    let narrows = |orientation: &Callout| orientation.width < width || bonus.is_some();
    let of = match made.feature.shape {
        Shape::Axis if orientation.is_some_and(narrows) => Nest::Axis,
        Shape::Axis => Nest::Ends,
        _ => Nest::Face,
    };
    if let Some(orientation) = orientation {
        bonus_of_both(made, location, orientation)?;
    }
    let variation = match (made.feature.shape, nested) {
        (Shape::Point, _) => {
            shift(made, location.name, &of_point(location), direction, draft);
            return Ok(());
        }
        (Shape::Axis, _) if location.name == "symmetry" => {
            // Between two planes: along their normal alone.
            let normal = draft.assembly.features[location.datums[0].feature].nominal[1];
            shift(made, location.name, &of_point(location), normal, draft);
            if let Some(orientation) = orientation {
                oriented(made, orientation, draft);
            }
            return Ok(());
        }
        (_, Some((rule, tilts))) => Variation::Nested(Nested { of, rule, tilts }),
        (Shape::Plane, None) => Variation::Zone(location.rule),
        (Shape::Axis, None) => Variation::Disc(location.rule),
    };
    let count = variation.variables();
    let first = draft.add(Contributor { name, variation }, &[0.0; 4][..count]);
    let tilts = match of {
        Nest::Face => {
            made.feature.shift(first, direction, width / 2.0);
            first + 1..first + count
        }
        Nest::Ends | Nest::Axis => {
            for (variable, side) in (first..).zip(made.sides) {
                made.feature.shift(variable, side, width / 2.0);
            }
            first + 2..first + count
        }
    };
    tilt(made, tilts.clone(), width);
    widen(made, first..tilts.start, location, Some((tilts, orientation.unwrap_or(location))), draft);
    Ok(())
}

/// How far a point, or an axis between two planes, is off in its zone: where it is normal, a sixth of the zone is its standard
/// deviation.
fn of_point(callout: &Callout) -> Toleranced {
    Toleranced::in_zone(callout.width, callout.rule, callout.width / 6.0)
}

/// Lets the zones of places and tilts go with the size, where they are at a condition of material.
fn widen(
    made: &mut FeatureDraft,
    places: Range<usize>,
    location: &Callout,
    orientation: Option<(Range<usize>, &Callout)>,
    draft: &mut Draft,
) {
    let zone = places.start;
    let mut size = None;
    let mut growth = [0.0; 2];
    let zones = [Some((places, location)), orientation];
    for (growth, (variables, callout)) in growth.iter_mut().zip(zones.into_iter().flatten()) {
        if let Some(bonus) = callout.bonus {
            made.feature.widen(variables, bonus, callout.width);
            *growth = bonus.sign / callout.width;
            size = Some(bonus.size);
        }
    }
    draft.widenings.extend(size.map(|size| Widening { zone, size, growth }));
}

/// Refuses an orientation that is wider than the location at a limit of the size, and rules by which place and tilts depend on
/// each other where only one of both has a bonus.
fn bonus_of_both(made: &FeatureDraft, location: &Callout, orientation: &Callout) -> Result<(), SceneError> {
    let Some(diameter) = made.diameter.filter(|_| location.bonus.or(orientation.bonus).is_some()) else {
        return Ok(());
    };
    let width = |callout: &Callout, size| callout.bonus.map_or(callout.width, |bonus| bonus.at(size));
    let unsupported =
        |what: String, allowed: &str| Err(orientation.field.error(Problem::Unsupported { what }, allowed));
    if diameter.limits.iter().any(|size| width(orientation, *size) > width(location, *size)) {
        let what = format!("{} that is wider than {} at a limit of the diameter", orientation.name, location.name);
        return unsupported(what, "a narrower one, or the same condition of material");
    }
    if !matches!(location.rule, ZoneRule::SigmaZone | ZoneRule::Translation) {
        let what = format!("{} beside {} with a bonus, by this rule,", orientation.name, location.name);
        return unsupported(what, "the rule sigma-zone");
    }
    Ok(())
}

/// Lets a feature tilt in the zone of its orientation.
pub(super) fn oriented(made: &mut FeatureDraft, callout: &Callout, draft: &mut Draft) {
    let variation = match made.feature.shape {
        Shape::Axis => Variation::Disc(callout.rule),
        _ => Variation::Zone(callout.rule),
    };
    let count = variation.variables();
    let name = format!("{} {}", made.name, callout.name);
    let first = draft.add(Contributor { name, variation }, &[0.0; 3][..count]);
    let tilts = if made.feature.shape == Shape::Axis { first..first + count } else { first + 1..first + count };
    tilt(made, tilts.clone(), callout.width);
    // Its tilts are all that the zone has.
    widen(made, tilts, callout, None, draft);
}

/// Lets a feature vary in the zone of its form, which nothing else holds.
pub(super) fn formed(made: &mut FeatureDraft, form: &Callout, draft: &mut Draft) {
    let direction = made.feature.nominal[1];
    if made.feature.shape == Shape::Point {
        return shift(made, form.name, &of_point(form), direction, draft);
    }
    let variation = match made.feature.shape {
        Shape::Axis => Variation::Disc(form.rule),
        _ => Variation::Zone(form.rule),
    };
    let count = variation.variables();
    let name = format!("{} {}", made.name, form.name);
    let first = draft.add(Contributor { name, variation }, &[0.0; 3][..count]);
    if made.feature.shape == Shape::Axis {
        return tilt(made, first..first + count, form.width);
    }
    made.feature.shift(first, direction, form.width / 2.0);
    let tilts = first + 1..first + count;
    // A line is straight along the first extent alone.
    let tilts = if form.limits == Limits::Line { tilts.start..(tilts.start + 1).min(tilts.end) } else { tilts };
    tilt(made, tilts, form.width);
}

/// Lets a plane shift in the zone of its form, as far as that lies within the zone of its orientation, which has the tilts.
pub(super) fn offset_within(made: &mut FeatureDraft, form: &Callout, wider: f64, draft: &mut Draft) {
    let width = form.width.min(wider);
    // As much as the offset varies in a zone of a form alone.
    let deviation = match form.rule {
        ZoneRule::Translation => width / 6.0,
        _ => width / 2.0 * SIGMA_ZONE,
    };
    let offset = Toleranced::in_zone(width, form.rule, deviation);
    let direction = made.feature.nominal[1];
    shift(made, form.name, &offset, direction, draft);
}

/// Lets a feature tilt by `variables`, so that its ends move half of `width` (m) for 1.
fn tilt(made: &mut FeatureDraft, variables: Range<usize>, width: f64) {
    let extents = made.extents.unwrap_or([1.0; 2]);
    // A height that grows along a side tilts the normal of a plane against it; an axis goes where its end goes.
    let sign = if made.feature.shape == Shape::Axis { 1.0 } else { -1.0 };
    for (variable, (side, extent)) in variables.zip(made.sides.into_iter().zip(extents)) {
        made.feature.tilt(variable, side, sign * width / extent);
    }
}
