//! Families of distributions that measured values may follow, fitted by maximum likelihood.

mod johnson_sb;
mod johnson_su;
mod lognormal;
mod mixture;
mod normal;
mod posterior;
mod shifted;
#[cfg(test)]
mod tests;
mod weibull;

use std::fmt;

use serde::Serialize;
use slipfit_tolerance::numeric::normal::quantile;

pub use self::{
    johnson_sb::JohnsonSb, johnson_su::JohnsonSu, lognormal::Lognormal, mixture::TwoNormals, normal::Normal,
    posterior::Posterior, weibull::Weibull,
};

/// A distribution of a family.
pub trait Family: fmt::Debug + Send + Sync {
    /// Its parameters with their usual names, in the unit of the values where they have one.
    fn parameters(&self) -> Vec<(&'static str, f64)>;

    /// The logarithm of its density; −∞ where it is 0.
    fn ln_density(&self, x: f64) -> f64;

    /// The probabilities of values up to `x` and above it, each accurate where it is small.
    fn tails(&self, x: f64) -> [f64; 2];

    /// The value below which it lies with the same probability as a standard normal below `score`: its quantile, accurate
    /// in both tails.
    fn value(&self, score: f64) -> f64;

    /// The probability of values up to `x`.
    fn cdf(&self, x: f64) -> f64 {
        self.tails(x)[0]
    }

    /// The value below which it lies with a `probability` between 0 and 1.
    fn quantile(&self, probability: f64) -> f64 {
        self.value(quantile(probability))
    }

    /// The logarithm of the likelihood of `values`.
    fn ln_likelihood(&self, values: &[f64]) -> f64 {
        values.iter().map(|x| self.ln_density(*x)).sum()
    }
}

/// The families.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Normal.
    Normal,
    /// The logarithm is normal.
    Lognormal,
    /// The logarithm of the distance from a lower end is normal.
    ShiftedLognormal,
    /// Weibull, from 0 on.
    Weibull,
    /// Weibull from another lower end on.
    ShiftedWeibull,
    /// Johnson's unbounded system.
    JohnsonSu,
    /// Johnson's system with two ends.
    JohnsonSb,
    /// A mixture of two normals.
    TwoNormals,
}

/// Why a family was not fitted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// Fewer parts than the family needs.
    #[error("{family} needs {least} measured parts, but there are {found}")]
    FewParts {
        /// The family.
        family: Kind,
        /// Parts that it needs.
        least: usize,
        /// Parts that there are.
        found: usize,
    },
    /// Fewer parts than it takes to choose among families.
    #[error(
        "to choose a distribution takes {least} measured parts, but there are {found}; state one, such as `normal`"
    )]
    FewToChoose {
        /// Parts that it takes.
        least: usize,
        /// Parts that there are.
        found: usize,
    },
    /// All values are the same.
    #[error("all measured values are {0}, so there is no variation to fit")]
    NoVariation(f64),
    /// Values that the family does not have.
    #[error("{family} has positive values alone, but one part has {value}")]
    NotPositive {
        /// The family.
        family: Kind,
        /// A value.
        value: f64,
    },
    /// Values too far apart for numbers.
    #[error("the values differ by more than numbers hold")]
    TooFarApart,
    /// A likelihood that grows towards an end of the parameters' range.
    #[error("{0} has no likeliest parameters for these values; a simpler family fits as well")]
    NoMaximum(Kind),
}

impl Kind {
    /// Every family, the simplest first.
    pub const ALL: [Self; 8] = [
        Self::Normal,
        Self::Lognormal,
        Self::Weibull,
        Self::ShiftedLognormal,
        Self::ShiftedWeibull,
        Self::JohnsonSu,
        Self::JohnsonSb,
        Self::TwoNormals,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Lognormal => "lognormal",
            Self::ShiftedLognormal => "shifted-lognormal",
            Self::Weibull => "weibull",
            Self::ShiftedWeibull => "shifted-weibull",
            Self::JohnsonSu => "johnson-su",
            Self::JohnsonSb => "johnson-sb",
            Self::TwoNormals => "two-normals",
        }
    }

    /// The family of a name.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Number of parameters.
    pub fn parameters(self) -> usize {
        match self {
            Self::Normal | Self::Lognormal | Self::Weibull => 2,
            Self::ShiftedLognormal | Self::ShiftedWeibull => 3,
            Self::JohnsonSu | Self::JohnsonSb => 4,
            Self::TwoNormals => 5,
        }
    }

    /// Measured parts without which it is refused: two for the normal, whose intervals are exact; five for the other
    /// families of two parameters; ten per parameter above, whose estimates are skewed for fewer.
    pub fn least_parts(self) -> usize {
        match self {
            Self::Normal => 2,
            Self::Lognormal | Self::Weibull => 5,
            _ => 10 * self.parameters(),
        }
    }

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
        let ln_likelihood = family.ln_likelihood(values);
        if !ln_likelihood.is_finite() {
            return Err(FitError::NoMaximum(self));
        }
        let (k, n) = (self.parameters() as f64, found as f64);
        // With small samples' correction (N. Sugiura, "Further analysis of the data by Akaike's information criterion
        // and the finite corrections", 1978); infinite where a sample is too small for it.
        let correction = if n > k + 1.0 { 2.0 * k * (k + 1.0) / (n - k - 1.0) } else { f64::INFINITY };
        let aicc = 2.0 * k - 2.0 * ln_likelihood + correction;
        let qq_correlation = qq_correlation(&sample.sorted, family.as_ref());
        Ok(Fit { kind: self, family, ln_likelihood, aicc, qq_correlation })
    }

    fn logarithms(self, sample: &Sample) -> Result<Vec<f64>, FitError> {
        match sample.sorted.first() {
            Some(least) if *least <= 0.0 => Err(FitError::NotPositive { family: self, value: *least }),
            _ => Ok(sample.sorted.iter().map(|x| libm::log(*x)).collect()),
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
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
        match kind.fit(values) {
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

/// A sample as fits start from it.
struct Sample {
    sorted: Vec<f64>,
    mean: f64,
    /// The root of the mean square from the mean, which is the likeliest standard deviation.
    deviation: f64,
}

impl Sample {
    fn new(values: &[f64]) -> Result<Self, FitError> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (Some(first), Some(last)) = (sorted.first(), sorted.last()) else {
            return Err(FitError::FewParts { family: Kind::Normal, least: 2, found: 0 });
        };
        if first == last {
            return Err(FitError::NoVariation(*first));
        }
        let (mean, square) = mean_and_square(&sorted);
        let deviation = libm::sqrt(square);
        if !deviation.is_finite() || deviation <= 0.0 {
            return Err(FitError::TooFarApart);
        }
        Ok(Self { mean, deviation, sorted })
    }

    fn least(&self) -> f64 {
        self.sorted.first().copied().unwrap_or_default()
    }

    fn greatest(&self) -> f64 {
        self.sorted.last().copied().unwrap_or_default()
    }

    fn median(&self) -> f64 {
        self.sorted.get(self.sorted.len() / 2).copied().unwrap_or_default()
    }
}

/// The mean of `values` and their mean square from it.
fn mean_and_square(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let first = values.first().copied().unwrap_or_default();
    let mean = first + values.iter().map(|x| (x - first) / n).sum::<f64>();
    (mean, values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n)
}

/// Correlation of sorted values and the quantiles of a distribution at G. Blom's points (i − 3/8)/(n + 1/4).
fn qq_correlation(sorted: &[f64], family: &dyn Family) -> f64 {
    let n = sorted.len() as f64;
    let quantiles: Vec<f64> = (1..=sorted.len()).map(|i| family.quantile((i as f64 - 0.375) / (n + 0.25))).collect();
    let ((a, aa), (b, bb)) = (mean_and_square(sorted), mean_and_square(&quantiles));
    let ab = sorted.iter().zip(&quantiles).map(|(x, y)| (x - a) * (y - b)).sum::<f64>() / n;
    ab / (libm::sqrt(aa) * libm::sqrt(bb))
}
