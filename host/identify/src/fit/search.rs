//! From several starts to one estimate.

use rayon::prelude::*;
use slipfit_core::sampling::stream::{Rng, uniform, unit_stream};
use slipfit_tolerance::numeric::normal::quantile;

use super::{
    By, Fit, grid,
    least_squares::{CLOSE, Cost, NEAR, minimise},
    loss::Loss,
    loss::scale,
};
use crate::{
    beforehand::Beforehand,
    model::{Model, ModelError, Parameter},
};

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

    let runs = model.runs();
    let known = |output: &[f64]| Beforehand::of(parameters, &residuals(output), &runs);
    let loss = options.loss;
    let (values, output) = if options.grid {
        let coarse = grid::search(model, loss).unwrap_or(stated);
        let output = model.simulate(&coarse)?;
        let beforehand = known(&output);
        let cost = Cost { loss, scale: deviation(&output, Loss::Huber), beforehand: &beforehand };
        let of = |values: &[f64], output: &[f64]| cost.of(&residuals(output), values);
        // Between its points the output may be smooth: then the gradient leads farther.
        match minimise(model, &coarse, &free, cost, CLOSE) {
            Ok((values, fine)) if of(&values, &fine) < of(&coarse, &output) => (values, fine),
            _ => (coarse, output),
        }
    } else {
        let mut best: Option<(f64, Vec<f64>, Vec<f64>)> = None;
        for start in promising(model, &stated, options.starts) {
            let output = model.simulate(&start)?;
            let beforehand = known(&output);
            let cost = Cost { loss: Loss::Squares, scale: deviation(&output, Loss::Squares), beforehand: &beforehand };
            let (values, output) = minimise(model, &start, &free, cost, NEAR)?;
            let found = deviation(&output, Loss::Huber);
            if best.as_ref().is_none_or(|(least, ..)| found < *least) {
                best = Some((found, values, output));
            }
        }
        let Some((_, mut values, mut output)) = best else {
            let output = model.simulate(&stated)?;
            return finish(model, stated, output, options, least);
        };
        // The scale follows the estimate. Two rounds leave it within its own error. Squares without anything known beforehand have none.
        let has_known = parameters.iter().any(|parameter| parameter.prior.is_some());
        let rounds = match (has_known, loss) {
            (true, _) => 3,
            (false, Loss::Squares) => 1,
            (false, _) => 2,
        };
        for _ in 0..rounds {
            let beforehand = known(&output);
            let cost = Cost { loss, scale: deviation(&output, loss), beforehand: &beforehand };
            (values, output) = minimise(model, &values, &free, cost, CLOSE)?;
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

/// Starts that are drawn for each parameter of which something is known beforehand, and how many of the best are followed then.
const FOR_KNOWN: usize = 4;
const FOLLOWED: usize = 3;

/// The `stated` start and the best of some others, if they are better: from within the bounds, or as what is known beforehand has it.
fn promising<M: Model + ?Sized>(model: &M, stated: &[f64], starts: usize) -> Vec<Vec<f64>> {
    let parameters = model.parameters();
    let bounded = parameters.iter().all(Parameter::is_bounded);
    if !bounded || parameters.is_empty() {
        return vec![stated.to_vec()];
    }
    let known = parameters.iter().filter(|parameter| parameter.prior.is_some()).count();
    let drawn = |k: u64| -> Vec<f64> {
        let mut stream = unit_stream(START_SEED, k);
        let value = |parameter: &Parameter| {
            let [low, high] = parameter.bounds;
            let share = uniform(stream.next_u64());
            match parameter.prior {
                None => low + share * (high - low),
                Some([mean, deviation]) => (mean + deviation * quantile(share)).clamp(low, high),
            }
        };
        parameters.iter().map(value).collect()
    };
    let mut all = vec![stated.to_vec()];
    all.extend((0..(starts + FOR_KNOWN * known) as u64).map(drawn));
    let cost = |values: &Vec<f64>| {
        let Ok(output) = model.simulate(values) else { return f64::INFINITY };
        model.measured().iter().zip(&output).map(|(measured, output)| (measured - output).abs()).sum()
    };
    let costs: Vec<f64> = all.par_iter().map(cost).collect();
    let mut order: Vec<usize> = (0..all.len()).filter(|k| costs[*k].is_finite()).collect();
    if order.is_empty() {
        return vec![stated.to_vec()];
    }
    order.sort_by(|one, other| costs[*one].total_cmp(&costs[*other]));
    order.truncate(if known > 0 { FOLLOWED } else { 1 });
    // The stated start is followed, too, if it can be computed.
    if !order.contains(&0) && costs[0].is_finite() {
        order.insert(0, 0);
    }
    order.into_iter().map(|k| std::mem::take(&mut all[k])).collect()
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
