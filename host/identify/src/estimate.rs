//! An estimate with what is known of it: determined combinations, deviations, intervals, lack of fit.

use nalgebra::{DMatrix, DVector};
use serde::Serialize;
use slipfit_measured::numeric::tails::student_quantile_above;
use slipfit_system::parallel;

use crate::{
    beforehand::Beforehand,
    doubt::{
        bootstrap,
        covariance::{Linearised, pseudo_inverse, with_known},
        determined::{NoInfluence, Undetermined, check_influence, undetermined},
        lack::{Lack, relative},
        profile::{Profile, profile},
    },
    fit::{By, Fit, Loss, Options, fit, grid},
    model::{Model, ModelError, Parameter},
    signal::noise::Noise,
};

/// A parameter and what is known of it. SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Estimated {
    /// Its name.
    pub name: String,
    /// The symbol of its unit; empty for a plain number.
    pub unit: &'static str,
    /// Estimate; the middle of all that explain the record equally well where it is not determined.
    pub value: f64,
    /// Standard deviation, with what is known beforehand; `None` where neither that nor the record determines it.
    pub deviation: Option<f64>,
    /// The same of the record alone, by the autocovariance of the residuals.
    pub deviation_by_autocovariance: Option<f64>,
    /// The same of the record alone, by the block bootstrap.
    pub deviation_by_bootstrap: Option<f64>,
    /// Interval of 95 %, by `deviation` or by profile likelihood, whichever is wider on each side.
    pub interval: Option<[f64; 2]>,
    /// Interval of 95 % by the block bootstrap, of the record alone.
    pub bootstrap: Option<[f64; 2]>,
    /// Interval of 95 % by profile likelihood.
    pub profile: Profile,
    /// Whether the estimate lies at a bound of the search.
    pub at_bound: bool,
}

/// An estimate of the parameters of a model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Whether the model explains the record.
    pub lack: Lack,
    /// Parameters.
    pub parameters: Vec<Estimated>,
    /// Correlations of the parameters; rows of zeros for what is not determined.
    pub correlation: Vec<Vec<f64>>,
    /// What the record does not determine, in words.
    pub undetermined: Vec<String>,
    /// What a residual cost.
    pub loss: Loss,
    /// What found the estimate.
    pub by: By,
    /// Samples that were compared.
    pub samples: usize,
    /// Independent samples that know as much.
    pub effective_samples: f64,
    /// Standard deviation of the residuals (SI).
    pub residual_deviation: f64,
    /// Measured minus computed, sample by sample.
    #[serde(skip)]
    pub residuals: Vec<f64>,
}

/// Why there is no estimate.
#[derive(Debug, thiserror::Error)]
pub enum EstimateError {
    /// The model cannot be computed.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A parameter changes nothing.
    #[error(transparent)]
    NoInfluence(#[from] NoInfluence),
    /// A grid of too many parameters, or of one without bounds.
    #[error("a grid needs one to three parameters, each with two bounds, and not {0}")]
    Grid(usize),
    /// More parameters than samples.
    #[error("{parameters} parameters are sought in {samples} samples, and each needs at least ten")]
    Few {
        /// Parameters.
        parameters: usize,
        /// Samples.
        samples: usize,
    },
}

/// Checks what the record determines, fits the `model` to it, and says how well it does.
///
/// # Errors
/// [`EstimateError`] where the model cannot be computed or a parameter has no influence.
pub fn estimate<M: Model + ?Sized>(model: &M, options: &Options) -> Result<Estimate, EstimateError> {
    let (parameters, samples) = (model.parameters(), model.measured().len());
    if samples < 10 * parameters.len().max(1) {
        return Err(EstimateError::Few { parameters: parameters.len(), samples });
    }
    let has_grid = (1..=grid::MOST).contains(&parameters.len()) && parameters.iter().all(Parameter::is_bounded);
    if options.grid && !has_grid {
        return Err(EstimateError::Grid(parameters.len()));
    }
    let mut fitted = fit(model, options)?;
    check_influence(parameters, &fitted.values, model.measured(), &mut fitted.sensitivities)?;
    let runs = model.runs();
    let linearised = Linearised::of(&fitted, runs.clone());
    let undetermined: Vec<Undetermined> = undetermined(parameters, &fitted.values, &linearised);
    let noise = Noise::of(&linearised.residuals, &runs);
    let covariance = linearised.covariance(&noise);
    let drawn = bootstrap::widest(&linearised);
    let has_prior = |i: usize| parameters[i].prior.is_some();
    let is_among = |directions: &[Undetermined], i: usize| directions.iter().any(|one| one.parameters.contains(&i));
    // Neither of two deviations knows all: the one takes the noise for the same everywhere, the other has few blocks.
    let of_record = |i: usize| {
        let by_autocovariance = libm::sqrt(covariance[(i, i)].max(0.0));
        [by_autocovariance, drawn.deviations[i], by_autocovariance.max(drawn.deviations[i])]
    };
    let beforehand = Beforehand::of(parameters, &fitted.residuals, &runs);
    let posterior = (0..parameters.len()).any(has_prior).then(|| {
        let wider = |i: usize| {
            let [own, _, both] = of_record(i);
            if own > 0.0 { both / own } else { 1.0 }
        };
        let (rows, columns) = covariance.shape();
        let wide = DMatrix::from_fn(rows, columns, |i, k| covariance[(i, k)] * wider(i) * wider(k));
        with_known(&beforehand, &wide, &linearised.units)
    });
    let left: Vec<Undetermined> =
        undetermined.iter().filter(|direction| !direction.parameters.iter().any(|i| has_prior(*i))).cloned().collect();
    let effective_samples = noise.effective(samples);
    let freedom = (effective_samples - parameters.len() as f64).max(1.0);
    let quantile = student_quantile_above(0.025, freedom);

    let of = |i: usize| -> Result<Estimated, ModelError> {
        let parameter: &Parameter = &parameters[i];
        let known = !is_among(&left, i);
        let by_record = (!is_among(&undetermined, i)).then(|| of_record(i));
        let value = fitted.values[i];
        let deviation = match &posterior {
            None => by_record.map(|[.., both]| both),
            Some(all) => known.then(|| libm::sqrt(all[(i, i)].max(0.0))),
        };
        let within = |value: f64| value.clamp(parameter.bounds[0], parameter.bounds[1]);
        let reach = deviation.map(|deviation| quantile * deviation);
        let profile = profile(model, &fitted, &linearised, &beforehand, i, reach)?;
        let interval = reach.map(|reach| {
            let [low, high] = [value - reach, value + reach].map(within);
            // What the record does not show has no profile.
            if profile.points.is_empty() {
                return [low, high];
            }
            // A bent output makes one side longer, up to the bound where nothing sets an end.
            let [first, last] = [0, 1].map(|side| profile.ends[side].unwrap_or(parameter.bounds[side]));
            [low.min(first), high.max(last)]
        });
        Ok(Estimated {
            name: parameter.name.clone(),
            unit: parameter.unit,
            value,
            deviation,
            deviation_by_autocovariance: by_record.map(|[one, ..]| one),
            deviation_by_bootstrap: by_record.map(|[_, other, _]| other),
            interval,
            bootstrap: by_record.map(|_| drawn.ranges[i].map(|by| within(fitted.values[i] + by))),
            profile,
            at_bound: parameter.is_at_bound(value),
        })
    };
    let estimated = parallel::each(parameters.len(), of).into_iter().collect::<Result<Vec<_>, _>>()?;
    let held_out = held_out_error(model, &fitted, &linearised, &beforehand);
    let covariance = posterior.unwrap_or(covariance);
    Ok(Estimate {
        lack: Lack::new(model.measured(), &linearised.residuals, &runs, held_out),
        correlation: correlation(&covariance, &left),
        parameters: estimated,
        undetermined: left.into_iter().map(|direction| direction.words).collect(),
        loss: fitted.loss,
        by: fitted.by,
        samples,
        effective_samples,
        residual_deviation: fitted.scale,
        residuals: fitted.residuals,
    })
}

/// Correlations of a `covariance`, 0 for what is `undetermined`.
fn correlation(covariance: &DMatrix<f64>, undetermined: &[Undetermined]) -> Vec<Vec<f64>> {
    let known = |i: usize| !undetermined.iter().any(|direction| direction.parameters.contains(&i));
    let of = |i: usize, k: usize| {
        let product = covariance[(i, i)] * covariance[(k, k)];
        if product > 0.0 && known(i) && known(k) { covariance[(i, k)] / libm::sqrt(product) } else { 0.0 }
    };
    let p = covariance.nrows();
    (0..p).map(|i| (0..p).map(|k| if i == k { 1.0 } else { of(i, k) }).collect()).collect()
}

/// Relative error in the last quarter of each run, for the estimate that the rest gives by the derivatives at the estimate from all.
fn held_out_error<M: Model + ?Sized>(
    model: &M,
    fit: &Fit,
    linearised: &Linearised,
    beforehand: &Beforehand,
) -> Option<f64> {
    let p = linearised.columns.len();
    let mut held_out = vec![false; fit.residuals.len()];
    let mut at = 0;
    for length in &linearised.runs {
        held_out[at + length - length / 4..at + length].fill(true);
        at += length;
    }
    let fitted = |values: &[f64], other: &[f64]| -> f64 {
        values.iter().zip(other).zip(&held_out).filter(|(_, out)| !**out).map(|((a, b), _)| a * b).sum()
    };
    let columns = &linearised.columns;
    let known = beforehand.normal_equations(&fit.values, &linearised.units, fit.scale);
    let added = |i: usize, k: usize| if i == k { known[i][0] } else { 0.0 };
    let products = DMatrix::from_fn(p, p, |i, k| fitted(&columns[i], &columns[k]) + added(i, k));
    let scores = DVector::from_fn(p, |i, _| fitted(&columns[i], &linearised.residuals) + known[i][1]);
    let (inverse, undetermined) = pseudo_inverse(products);
    // A quarter that alone determines a parameter cannot be held out.
    if undetermined.len() > linearised.undetermined.len() {
        return None;
    }
    let moved = inverse * scores;
    let (mut residuals, mut measured) = (Vec::new(), Vec::new());
    for t in (0..held_out.len()).filter(|t| held_out[*t]) {
        let by: f64 = (0..p).map(|i| columns[i][t] * moved[i]).sum();
        residuals.push(linearised.residuals[t] - by);
        measured.push(model.measured()[t]);
    }
    Some(relative(&residuals, &measured))
}
