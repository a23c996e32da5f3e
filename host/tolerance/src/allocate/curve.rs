//! Cost against defects.

use super::{
    AllocateError,
    cost::Process,
    requirement::{Kind, OfMeasures, Requirement},
    search::search,
};
use crate::model::Model;

/// Defects (ppm) of the points.
pub const LEVELS: [f64; 9] = [10_000.0, 3_000.0, 1_000.0, 300.0, 100.0, 30.0, 10.0, 3.0, 1.0];

/// The cheapest tolerances with at most some defects.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Units per million with any measure outside of its limits.
    pub ppm: f64,
    /// Cost of all tolerances.
    pub cost: f64,
    /// The tolerances (SI).
    pub tolerances: Vec<f64>,
}

/// Of the [`LEVELS`] that can be reached; the tolerances of each point are where the next starts from. `done` is called after
/// every one.
///
/// # Errors
/// [`AllocateError`], but for levels that cannot be reached.
pub fn curve(
    processes: &[&[Process]],
    start: &[f64],
    model: &(dyn Fn(&[f64]) -> Result<Model, AllocateError> + Sync),
    seed: u64,
    done: impl Fn(),
) -> Result<Vec<Point>, AllocateError> {
    let mut points: Vec<Point> = Vec::new();
    for ppm in LEVELS {
        let requirement = Requirement { measure: None, kind: Kind::Defects(ppm * 1e-6) };
        let start = points.last().map_or(start, |point| &point.tolerances).to_vec();
        let figures = OfMeasures::new(&[requirement], model, &start, seed)?;
        match search(processes, &start, &figures) {
            Ok(found) => {
                points.push(Point { ppm, cost: found.solution.cost, tolerances: found.solution.tolerances });
            }
            Err(AllocateError::Infeasible { .. }) => break,
            Err(error) => return Err(error),
        }
        done();
    }
    Ok(points)
}
