//! The best point of a grid that is refined about its best point: for models whose output jumps with their parameters.

use slipfit_system::parallel;

use super::{
    least_squares::Cost,
    loss::{Loss, scale},
};
use crate::{beforehand::Beforehand, model::Model};

/// The most parameters for which a grid is searched.
pub const MOST: usize = 3;
/// Points along each parameter.
const POINTS: usize = 9;
/// How often the grid is refined, each time to the cells about its best point.
const LEVELS: usize = 3;

/// The best values, `None` where no point has an output. Parameters need two bounds.
pub fn search<M: Model + ?Sized>(model: &M, loss: Loss) -> Option<Vec<f64>> {
    let parameters = model.parameters();
    let mut ranges: Vec<[f64; 2]> = parameters.iter().map(|parameter| parameter.bounds).collect();
    let mut best: Option<(f64, Vec<f64>)> = None;
    let mut reference: Option<(f64, Beforehand)> = None;
    for _ in 0..LEVELS {
        let count = (0..parameters.len()).fold(1, |count, _| count * POINTS);
        let point = |k: usize| -> Vec<f64> {
            let mut rest = k;
            let along = |[low, high]: &[f64; 2]| {
                let i = rest % POINTS;
                rest /= POINTS;
                low + (high - low) * i as f64 / (POINTS - 1) as f64
            };
            ranges.iter().map(along).collect()
        };
        // In the order of the points, whatever the number of threads.
        let residuals: Vec<Option<Vec<f64>>> = parallel::each(count, |k| {
            let output = model.simulate(&point(k)).ok()?;
            Some(model.measured().iter().zip(&output).map(|(measured, output)| measured - output).collect())
        });
        // One scale for all points of all grids: that of the best by absolute values.
        let (scale, beforehand) = match &reference {
            Some(reference) => reference,
            None => {
                let of = |residuals: &Vec<f64>| scale(residuals, Loss::Huber).max(f64::MIN_POSITIVE);
                let best = residuals.iter().flatten().min_by(|one, other| of(one).total_cmp(&of(other)))?;
                reference.insert((of(best), Beforehand::of(parameters, best, &model.runs())))
            }
        };
        let cost = Cost { loss, scale: *scale, beforehand };
        for (k, residuals) in residuals.iter().enumerate() {
            let Some(residuals) = residuals else { continue };
            let found = cost.of(residuals, &point(k));
            if best.as_ref().is_none_or(|(least, _)| found < *least) {
                best = Some((found, point(k)));
            }
        }
        let (_, at) = best.as_ref()?;
        for ((range, value), parameter) in ranges.iter_mut().zip(at).zip(parameters) {
            let cell = 1.5 * (range[1] - range[0]) / (POINTS - 1) as f64;
            *range = [(value - cell).max(parameter.bounds[0]), (value + cell).min(parameter.bounds[1])];
        }
    }
    best.map(|(_, values)| values)
}
