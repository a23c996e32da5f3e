//! Reads vectorial tolerances.

use slipfit_tolerance::failure::dot;

use crate::scene::SceneError;

use super::{
    draft::{Draft, FeatureDraft},
    toleranced,
};

/// Components of the position vector and the orientation vector, each with its own tolerance, in the part's frame. Gives whether there are
/// any.
pub(super) fn read(made: &mut FeatureDraft, draft: &mut Draft) -> Result<bool, SceneError> {
    let Some(table) = made.table.get("vectorial") else { return Ok(false) };
    table.expect_table()?;
    for (key, quantity) in [("position", &toleranced::LENGTH), ("orientation", &toleranced::RATIO)] {
        let Some(vector) = table.get(key) else { continue };
        vector.expect_table()?;
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let Some(field) = vector.get(axis) else { continue };
            let size = toleranced::deviation(&field, quantity, draft.defaults.sigma)?;
            let variable = draft.add(size.contributor(format!("{} {key} {axis}", made.name)), &[0.0]);
            let mut component = [0.0; 3];
            component[i] = 1.0;
            let component = made.pose.direction(component);
            if key == "position" {
                made.feature.shift(variable, component, 1.0);
                continue;
            }
            if dot(&made.feature.nominal[1], &component).abs() > 1.0 - 1e-9 {
                field.warn(&format!("`{}` has no effect: a direction does not tilt along itself", field.key));
            }
            made.feature.tilt(variable, component, 1.0);
        }
    }
    Ok(true)
}
