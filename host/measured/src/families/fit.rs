//! Fits by maximum likelihood, and the choice among them.

use super::{
    family::Family,
    johnson_sb::JohnsonSb,
    johnson_su::JohnsonSu,
    kind::{FitError, Kind},
    lognormal::Lognormal,
    mixture::TwoNormals,
    normal::Normal,
    posterior::Posterior,
    sample::{Sample, mean_and_square},
    shifted,
    weibull::Weibull,
};

impl Kind {
    /// The likeliest distribution of the family for `values`.
    pub fn fit(self, values: &[f64]) -> Result<Fit, FitError> {
        let found = values.len();
        let least = self.least_parts();
        if found < least {
            return Err(FitError::FewParts { family: self, least, found });
        }
        let sample = Sample::new(values)?;
        let family: Box<dyn Family> = match self {
            Self::Normal => Box::new(Normal { mean: sample.mean, deviation: sample.deviation }),
            Self::Lognormal => Box::new(Lognormal::fit(&self.logarithms(&sample)?, 0.0)),
            Self::Weibull => Box::new(Weibull::fit(&self.logarithms(&sample)?, 0.0)),
            Self::ShiftedLognormal => Box::new(shifted::fit(&sample, self, Lognormal::fit)?),
            Self::ShiftedWeibull => Box::new(shifted::fit(&sample, self, Weibull::fit)?),
            Self::JohnsonSu => Box::new(JohnsonSu::fit(&sample)),
            Self::JohnsonSb => Box::new(JohnsonSb::fit(&sample).ok_or(FitError::NoMaximum(self))?),
            Self::TwoNormals => Box::new(TwoNormals::fit(&sample)),
        };
        Fit::new(self, family, &sample)
    }

    /// The likeliest distribution of the family, or the most probable one where the likelihood has no maximum.
    pub fn fit_or_mode(self, values: &[f64]) -> Result<Fit, FitError> {
        match self.fit(values) {
            Err(FitError::NoMaximum(_)) => {
                let posterior = Posterior::new(self, None, values)?;
                Fit::new(self, posterior.mode().clone_box(), &Sample::new(values)?)
            }
            fit => fit,
        }
    }

    fn logarithms(self, sample: &Sample) -> Result<Vec<f64>, FitError> {
        match sample.sorted.first() {
            Some(least) if *least <= 0.0 => Err(FitError::NotPositive { family: self, value: *least }),
            _ => Ok(sample.sorted.iter().map(|x| libm::log(*x)).collect()),
        }
    }
}

impl Fit {
    fn new(kind: Kind, family: Box<dyn Family>, sample: &Sample) -> Result<Self, FitError> {
        let ln_likelihood = family.ln_likelihood(&sample.sorted);
        if !ln_likelihood.is_finite() {
            return Err(FitError::NoMaximum(kind));
        }
        let (k, n) = (kind.parameters() as f64, sample.sorted.len() as f64);
        // With small samples' correction (N. Sugiura, "Further analysis of the data by Akaike's information criterion
        // and the finite corrections", 1978); infinite where a sample is too small for it.
        let correction = if n > k + 1.0 { 2.0 * k * (k + 1.0) / (n - k - 1.0) } else { f64::INFINITY };
        let aicc = 2.0 * k - 2.0 * ln_likelihood + correction;
        let qq_correlation = qq_correlation(&sample.sorted, family.as_ref());
        Ok(Self { kind, family, ln_likelihood, aicc, qq_correlation })
    }
}

/// A fitted distribution.
#[derive(Debug)]
pub struct Fit {
    /// Its family.
    pub kind: Kind,
    /// The distribution.
    pub family: Box<dyn Family>,
    /// Logarithm of its likelihood.
    pub ln_likelihood: f64,
    /// Akaike's information criterion with the correction for small samples: the lowest is the best.
    pub aicc: f64,
    /// Correlation of the sorted values and the distribution's quantiles.
    pub qq_correlation: f64,
}

/// Measured parts without which no family is chosen.
pub const LEAST_TO_CHOOSE: usize = 30;

/// The fits of all families that fit `values`, the best first, and why others do not.
pub fn choose(values: &[f64]) -> Result<(Vec<Fit>, Vec<FitError>), FitError> {
    if values.len() < LEAST_TO_CHOOSE {
        return Err(FitError::FewToChoose { least: LEAST_TO_CHOOSE, found: values.len() });
    }
    Sample::new(values)?;
    let (mut fits, mut errors) = (Vec::new(), Vec::new());
    for kind in Kind::ALL {
        match kind.fit_or_mode(values) {
            Ok(fit) => fits.push(fit),
            Err(error) => errors.push(error),
        }
    }
    // The order of equals is that of `Kind::ALL`.
    fits.sort_by(|a, b| a.aicc.total_cmp(&b.aicc));
    Ok((fits, errors))
}

/// The fit that stands for the values: the simplest one whose criterion is within 2 of the lowest, as such differences
/// decide nothing (K. Burnham and D. Anderson, "Model Selection and Multimodel Inference", 2002).
pub fn preferred(fits: &[Fit]) -> Option<&Fit> {
    const UNDECIDED: f64 = 2.0;
    let lowest = fits.iter().map(|fit| fit.aicc).fold(f64::INFINITY, f64::min);
    let place = |fit: &&Fit| Kind::ALL.iter().position(|kind| *kind == fit.kind);
    fits.iter().filter(|fit| fit.aicc <= lowest + UNDECIDED).min_by_key(place)
}

/// The fits that are not refuted: those whose criterion is within 7 of the lowest, beyond which a family has little support
/// (K. Burnham and D. Anderson).
pub fn supported(fits: &[Fit]) -> impl Iterator<Item = &Fit> {
    const LITTLE: f64 = 7.0;
    let lowest = fits.iter().map(|fit| fit.aicc).fold(f64::INFINITY, f64::min);
    fits.iter().filter(move |fit| fit.aicc <= lowest + LITTLE)
}

/// Correlation of sorted values and the quantiles of a distribution at G. Blom's points (i − 3/8)/(n + 1/4).
fn qq_correlation(sorted: &[f64], family: &dyn Family) -> f64 {
    let n = sorted.len() as f64;
    let quantiles: Vec<f64> = (1..=sorted.len()).map(|i| family.quantile((i as f64 - 0.375) / (n + 0.25))).collect();
    let ((a, aa), (b, bb)) = (mean_and_square(sorted), mean_and_square(&quantiles));
    let ab = sorted.iter().zip(&quantiles).map(|(x, y)| (x - a) * (y - b)).sum::<f64>() / n;
    ab / (libm::sqrt(aa) * libm::sqrt(bb))
}
