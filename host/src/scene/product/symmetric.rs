//! What tolerances about an axis or a middle need of their datums: run-out, coaxiality, concentricity, symmetry.

use slipfit_tolerance::product::{
    contact::{cross, norm},
    feature::Shape,
};

use crate::scene::{Problem, SceneError, value::Field};

use super::draft::{Datum, Draft, FeatureDraft};

/// How far (m) a feature may lie off its datum on the drawing.
const OFF: f64 = 1e-9;

/// Refuses the tolerance `name` where its first datum is not what it turns around or is symmetric to.
pub(super) fn check(
    name: &str,
    field: &Field,
    datums: &[Datum],
    made: &FeatureDraft,
    draft: &Draft,
) -> Result<(), SceneError> {
    let (wanted, allowed) = match name {
        "run_out" | "total_run_out" | "coaxiality" | "concentricity" => (Shape::Axis, "the axis that it is about"),
        "symmetry" => (Shape::Plane, "the plane in the middle"),
        _ => return Ok(()),
    };
    let key = format!("{}.datum", field.key);
    let first = datums.first().ok_or_else(|| field.error(Problem::Missing(key), allowed))?;
    let datum = &draft.assembly.features[first.feature];
    let place = field.get("datum").unwrap_or(field.clone());
    let refuse = |what: String, allowed: &str| Err(place.error(Problem::Unsupported { what }, allowed));
    if datum.shape != wanted {
        return refuse(format!("{name} to {}", datum.shape.article()), allowed);
    }
    let [at, direction] = made.feature.nominal;
    let [origin, towards] = datum.nominal;
    let apart = [0, 1, 2].map(|i| at[i] - origin[i]);
    let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>().abs();
    // Faces and points may run out anywhere on the turned surface; an axis is on that of its datum.
    let lies = match (wanted, made.feature.shape) {
        (Shape::Axis, Shape::Axis) => norm(cross(apart, towards)) <= OFF && norm(cross(direction, towards)) <= OFF,
        (Shape::Axis, _) => true,
        (_, Shape::Axis) => dot(apart, towards) <= OFF && dot(direction, towards) <= OFF,
        (_, _) => dot(apart, towards) <= OFF && norm(cross(direction, towards)) <= OFF,
    };
    if lies {
        return Ok(());
    }
    refuse(format!("{name} of a feature that the drawing has off its datum"), "features on one line, or in one plane")
}
