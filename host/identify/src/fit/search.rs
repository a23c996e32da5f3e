//! From several starts to one estimate.

use rayon::prelude::*;
use slipfit_core::sampling::stream::{Rng, uniform, unit_stream};

use super::{
    By, Fit, grid,
    least_squares::{CLOSE, NEAR, minimise},
    loss::Loss,
    loss::scale,
};
use crate::model::{Model, ModelError, Parameter};

/// How a fit is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// What a residual costs.
    pub loss: Loss,
    /// Starts beside the stated one, drawn within the bounds, of which the best is followed.
    pub starts: usize,
    /// Whether a grid is searched instead of following gradients.
    pub grid: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { loss: Loss::default(), starts: 12, grid: false }
    }
}

/// Least residual, as a share of the measured values, below which deviations are not distinguished.
const EXACT: f64 = 1e-12;

/// Fits a `model` to what was measured.
///
/// # Errors
/// [`ModelError`] where the model cannot be computed at its start, or anywhere on a grid.
pub fn fit<M: Model + ?Sized>(model: &M, options: &Options) -> Result<Fit, ModelError> {
    let parameters = model.parameters();
    let free: Vec<usize> = (0..parameters.len()).collect();
    let stated: Vec<f64> = parameters.iter().map(|parameter| parameter.start).collect();
    let least = EXACT * model.measured().iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()));
    let residuals = |output: &[f64]| -> Vec<f64> {
        model.measured().iter().zip(output).map(|(measured, output)| measured - output).collect()
    };
    let deviation = |output: &[f64], loss: Loss| scale(&residuals(output), loss).max(least);

    let loss = options.loss;
    let (values, output) = if options.grid {
        let coarse = grid::search(model, loss).unwrap_or(stated);
        let output = model.simulate(&coarse)?;
        let scale = deviation(&output, Loss::Huber);
        let cost = |output: &[f64]| -> f64 {
            residuals(output).iter().map(|residual| loss.root(residual / scale)[0]).map(|root| root * root).sum()
        };
        // Between its points the output may be smooth: then the gradient leads farther.
        match minimise(model, &coarse, &free, (loss, scale), CLOSE) {
            Ok((values, fine)) if cost(&fine) < cost(&output) => (values, fine),
            _ => (coarse, output),
        }
    } else {
        let mut best: Option<(f64, Vec<f64>, Vec<f64>)> = None;
        for start in promising(model, &stated, options.starts) {
            let (values, output) = minimise(model, &start, &free, (Loss::Squares, 1.0), NEAR)?;
            let found = deviation(&output, Loss::Huber);
            if best.as_ref().is_none_or(|(least, ..)| found < *least) {
                best = Some((found, values, output));
            }
        }
        let Some((_, mut values, mut output)) = best else {
            let output = model.simulate(&stated)?;
            return finish(model, stated, output, options, least);
        };
        // The scale follows the estimate. Two rounds leave it within its own error; squares have none.
        for _ in 0..if loss == Loss::Squares { 1 } else { 2 } {
            let scale = deviation(&output, loss);
            (values, output) = minimise(model, &values, &free, (loss, scale), CLOSE)?;
        }
        (values, output)
    };
    finish(model, values, output, options, least)
}

fn finish<M: Model + ?Sized>(
    model: &M,
    values: Vec<f64>,
    output: Vec<f64>,
    options: &Options,
    least: f64,
) -> Result<Fit, ModelError> {
    let residuals: Vec<f64> =
        model.measured().iter().zip(&output).map(|(measured, output)| measured - output).collect();
    let scale = scale(&residuals, options.loss).max(least);
    let sensitivities = model.sensitivities(&values, &output)?;
    let by = if options.grid { By::Grid } else { By::Gradient };
    Ok(Fit { values, output, residuals, sensitivities, scale, loss: options.loss, by })
}

/// The `stated` start and the best one of some others, if that is better.
fn promising<M: Model + ?Sized>(model: &M, stated: &[f64], starts: usize) -> Vec<Vec<f64>> {
    let parameters = model.parameters();
    let bounded = parameters.iter().all(Parameter::is_bounded);
    let mut all = vec![stated.to_vec()];
    if !bounded || parameters.is_empty() {
        return all;
    }
    let drawn = (0..starts as u64).map(|k| {
        let mut stream = unit_stream(START_SEED, k);
        let mut share = move || uniform(stream.next_u64());
        parameters
            .iter()
            .map(move |parameter| parameter.bounds[0] + share() * (parameter.bounds[1] - parameter.bounds[0]))
    });
    all.extend(drawn.map(Iterator::collect));
    let costs: Vec<f64> = all
        .par_iter()
        .map(|values| {
            let Ok(output) = model.simulate(values) else { return f64::INFINITY };
            model.measured().iter().zip(&output).map(|(measured, output)| (measured - output).abs()).sum()
        })
        .collect();
    let best = (0..all.len()).min_by(|a, b| costs[*a].total_cmp(&costs[*b])).unwrap_or(0);
    if best == 0 || costs[0].is_infinite() {
        vec![all.swap_remove(best)]
    } else {
        vec![all[0].clone(), all.swap_remove(best)]
    }
}

/// Seed of the drawn starts.
const START_SEED: u64 = 43;

#[cfg(test)]
mod tests {
    use super::{Fit, Loss, Model, ModelError, Options, fit};
    use crate::model::Parameter;

    /// y = a·exp(−b·t).
    struct Decay {
        parameters: [Parameter; 2],
        measured: Vec<f64>,
    }

    fn decay(a: f64, b: f64) -> Vec<f64> {
        (0..200).map(|i| a * libm::exp(-b * 0.01 * f64::from(i))).collect()
    }

    impl Model for Decay {
        fn parameters(&self) -> &[Parameter] {
            &self.parameters
        }

        fn measured(&self) -> &[f64] {
            &self.measured
        }

        fn times(&self) -> Vec<f64> {
            (0..self.measured.len()).map(|i| 0.01 * i as f64).collect()
        }

        fn simulate(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
            Ok(decay(values[0], values[1]))
        }
    }

    fn of(measured: Vec<f64>, bounds: [f64; 2]) -> Decay {
        let parameter =
            |name: &str, bounds: [f64; 2], start| Parameter { name: name.into(), unit: "", bounds, start, prior: None };
        Decay {
            parameters: [parameter("a", [0.0, 10.0], 1.0), parameter("b", bounds, 0.5 * (bounds[0] + bounds[1]))],
            measured,
        }
    }

    fn values(model: &Decay, options: Options) -> Fit {
        fit(model, &options).expect("a fit")
    }

    #[test]
    fn exact_records_give_their_parameters_back() {
        for grid in [false, true] {
            for loss in Loss::ALL {
                let found = values(&of(decay(3.0, 2.0), [0.0, 9.0]), Options { loss, grid, ..Options::default() });
                let off = [found.values[0] - 3.0, found.values[1] - 2.0];
                assert!(off.iter().all(|off| off.abs() < if grid { 1e-2 } else { 1e-6 }), "{loss:?} {grid} {off:?}");
            }
        }
    }

    #[test]
    fn a_bound_holds() {
        let found = values(&of(decay(3.0, 2.0), [2.5, 9.0]), Options::default());
        assert!((found.values[1] - 2.5).abs() < 1e-3, "{:?}", found.values);
    }
}
