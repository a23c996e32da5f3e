//! At which angle to a datum a feature is drawn.

use slipfit_tolerance::product::feature::{Feature, Shape};

/// The sine of the angle from which on what is drawn is another direction.
const SLANTED: f64 = 0.02;

/// The angle (°) between a feature and its datum, as drawn, if they are not parallel, or not perpendicular where that is meant. None of
/// points, which have no direction of their own.
pub(super) fn slant([own, datum]: [&Feature; 2], is_parallel: bool) -> Option<f64> {
    if [own.shape, datum.shape].contains(&Shape::Point) {
        return None;
    }
    let along: f64 = own.nominal[1].iter().zip(datum.nominal[1]).map(|(a, b)| a * b).sum();
    // An axis lies along a face where it is at a right angle to the face's normal.
    let are_alike = own.shape == datum.shape;
    let expected_along = is_parallel == are_alike;
    let off = if expected_along { libm::sqrt((1.0 - along * along).max(0.0)) } else { along.abs() };
    let angle = libm::acos(along.abs().min(1.0)).to_degrees();
    (off > SLANTED).then_some(if are_alike { angle } else { 90.0 - angle })
}
