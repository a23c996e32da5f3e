//! From several starts to one estimate.

use slipfit_core::sampling::stream::{Rng, uniform, unit_stream};
use slipfit_system::parallel;
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
    /// Starts beside the stated one, drawn within the bounds or as what is known beforehand has it, of which the best are followed.
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
        // At a start what the model does not yet explain is no noise, and what is known beforehand must not outweigh it.
        let independent = Beforehand::beside_independent(parameters);
        let mut best: Option<(f64, Vec<f64>, Vec<f64>)> = None;
        let mut failed = None;
        for start in promising(model, &stated, options.starts) {
            // Squares have their minimum at the same place in any unit, if nothing stands beside them.
            let scale = match independent.is_nothing() {
                true => Ok(1.0),
                false => model.simulate(&start).map(|output| deviation(&output, Loss::Squares)),
            };
            let found = scale.and_then(|scale| {
                minimise(model, &start, &free, Cost { loss: Loss::Squares, scale, beforehand: &independent }, NEAR)
            });
            match found {
                Ok((values, output)) => {
                    let found = judged(deviation(&output, Loss::Huber), &values, &independent, model.measured().len());
                    if best.as_ref().is_none_or(|(least, ..)| found < *least) {
                        best = Some((found, values, output));
                    }
                }
                Err(error) => failed = Some(error),
            }
        }
        let (mut values, mut output) = match (best, failed) {
            (Some((_, values, output)), _) => (values, output),
            (None, Some(error)) => return Err(error),
            (None, None) => (stated.clone(), model.simulate(&stated)?),
        };
        let mut round = |of: &dyn Fn(&[f64]) -> Beforehand| -> Result<f64, ModelError> {
            let (scale, beforehand) = (deviation(&output, loss), of(&output));
            (values, output) = minimise(model, &values, &free, Cost { loss, scale, beforehand: &beforehand }, CLOSE)?;
            Ok(scale)
        };
        if independent.is_nothing() {
            // The scale follows the estimate. Two rounds leave it within its own error; squares have none.
            for _ in 0..if loss == Loss::Squares { 1 } else { 2 } {
                round(&|_| independent.clone())?;
            }
        } else {
            // What is known beforehand counts the more the greater the scale is: until both settle. How much the samples' noise follows itself
            // is seen only then.
            settle(|| round(&|_| independent.clone()))?;
            settle(|| round(&known))?;
        }
        (values, output)
    };
    finish(model, values, output, options, least)
}

/// Repeats a `round`, which says the scale that it began with, until that settles.
fn settle(mut round: impl FnMut() -> Result<f64, ModelError>) -> Result<(), ModelError> {
    const MOST: usize = 10;
    const SETTLED: f64 = 1e-3;
    let mut before = round()?;
    for _ in 1..MOST {
        let scale = round()?;
        if (scale - before).abs() < SETTLED * scale {
            break;
        }
        before = scale;
    }
    Ok(())
}

/// How well `values` explain so many `samples` with residuals of this `deviation`, and what is known `beforehand`: twice the negative logarithm
/// of their likelihood.
fn judged(deviation: f64, values: &[f64], beforehand: &Beforehand, samples: usize) -> f64 {
    2.0 * samples as f64 * libm::log(deviation) + beforehand.cost(values)
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
    let costs: Vec<f64> = parallel::map(&all, cost);
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

    /// What is known beforehand is five deviations off, and the record knows the values far better.
    #[test]
    fn a_record_outweighs_what_is_known_beforehand() {
        let noise = |i: usize| 0.01 * (f64::from((i as u32).wrapping_mul(2_654_435_761) >> 16) / 32_768.0 - 1.0);
        let measured: Vec<f64> = decay(3.0, 2.0).iter().enumerate().map(|(i, y)| y + noise(i)).collect();
        for loss in Loss::ALL {
            let mut model = of(measured.clone(), [0.0, 9.0]);
            model.parameters[0].prior = Some([2.0, 0.2]);
            model.parameters[0].start = 2.0;
            let found = values(&model, Options { loss, starts: 0, ..Options::default() });
            assert!((found.values[0] - 3.0).abs() < 0.01 && (found.values[1] - 2.0).abs() < 0.02, "{:?}", found.values);
        }
    }
}
