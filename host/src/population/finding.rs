//! What is known of a probability after independent repeats: a figure with its error, a bound, or why there is no figure.

use serde::{Serialize, Serializer};

use crate::tolerance::{
    failure::{
        importance::mean_and_error,
        subset::Stopped,
        tail::{MOST_ERROR, agrees},
    },
    statistics::interval::student_factor,
};

/// Independent repeats, whose spread is the error.
pub const REPEATS: usize = 16;
/// What repeats of which some end without a malfunction may have found for its probability to be below the levels.
const LAST: f64 = 1e-7;

/// A probability and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Probability.
    pub probability: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Its 95 % confidence interval.
    pub interval: [f64; 2],
}

/// What is known of a probability.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Finding {
    /// A figure.
    Probability(Estimate),
    /// Where the levels ended without a malfunction.
    Rarer {
        /// About the probability of the last level.
        rarer_than: f64,
    },
    /// No figure.
    Unknown {
        /// Why.
        reason: Reason,
    },
}

/// Why there is no figure.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Reason {
    /// Units without a verdict.
    #[error("{undecided} of {simulated} units come to no verdict")]
    NoVerdict {
        /// Those without.
        undecided: u64,
        /// All.
        simulated: u64,
    },
    /// Units that cannot be simulated.
    #[error("the parameters of {units} of {simulated} units are out of bounds")]
    OutOfBounds {
        /// Those that cannot.
        units: u64,
        /// All.
        simulated: u64,
    },
    /// Nothing to follow.
    #[error("the units do not differ in what decides it")]
    Flat,
    /// Repeats that found none.
    #[error("only {reached} of {} repeats found a malfunction", REPEATS)]
    Missed {
        /// Those that did.
        reached: usize,
    },
    /// Repeats that do not agree.
    #[error("the repeats differ: the standard error is {:.0} % of the figure, allowed are {:.0} %", .0 * 100.0, MOST_ERROR * 100.0)]
    Spread(f64),
    /// Units that were counted.
    #[error("{hits} of {units} units that were counted contradict {probability:.1e}")]
    Counted {
        /// Those that malfunction so.
        hits: u64,
        /// All.
        units: u64,
        /// What was found.
        probability: f64,
    },
    /// Of a sum.
    #[error("a part of it has no figure")]
    Part,
}

impl Serialize for Reason {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl From<Reason> for Finding {
    fn from(reason: Reason) -> Self {
        Self::Unknown { reason }
    }
}

impl Finding {
    /// Of repeats.
    pub fn of(repeats: &[Result<f64, Stopped>]) -> Self {
        let reached: Vec<f64> = repeats.iter().filter_map(|repeat| repeat.ok()).collect();
        if reached.len() == repeats.len() {
            let estimate = Estimate::of(&reached);
            let relative = estimate.standard_error / estimate.probability;
            return if relative <= MOST_ERROR { Self::Probability(estimate) } else { Reason::Spread(relative).into() };
        }
        let bound = |repeat: &Result<f64, Stopped>| match repeat {
            Ok(probability) | Err(Stopped::Rarer(probability)) => Some(*probability),
            Err(Stopped::Flat) => None,
        };
        let bounds: Option<Vec<f64>> = repeats.iter().map(bound).collect();
        match bounds.map(|bounds| bounds.into_iter().fold(0.0, f64::max)) {
            Some(rarer_than) if reached.is_empty() || rarer_than <= LAST => Self::Rarer { rarer_than },
            None if reached.is_empty() => Reason::Flat.into(),
            _ => Reason::Missed { reached: reached.len() }.into(),
        }
    }

    /// The same, unless `hits` among `units` that were counted contradict it.
    pub fn checked(self, hits: u64, units: u64) -> Self {
        let (probability, error) = match &self {
            Self::Probability(estimate) => (estimate.probability, estimate.standard_error),
            Self::Rarer { rarer_than } => (*rarer_than, 0.0),
            Self::Unknown { .. } => return self,
        };
        let agrees = agrees(Some((hits, units)), probability, error);
        if agrees { self } else { Reason::Counted { hits, units, probability }.into() }
    }

    /// Of malfunctions that exclude each other.
    pub fn sum<'a>(parts: impl Iterator<Item = &'a Self>) -> Self {
        let (mut probability, mut square, mut rarer) = (0.0, 0.0, 0.0);
        for part in parts {
            match part {
                Self::Probability(estimate) => {
                    probability += estimate.probability;
                    square += estimate.standard_error * estimate.standard_error;
                }
                Self::Rarer { rarer_than } => rarer += rarer_than,
                Self::Unknown { .. } => return Reason::Part.into(),
            }
        }
        if probability == 0.0 {
            return Self::Rarer { rarer_than: rarer };
        }
        let mut estimate = Estimate::new(probability, libm::sqrt(square));
        estimate.interval[1] += rarer;
        Self::Probability(estimate)
    }
}

impl Estimate {
    /// Of repeats, each the product of many shares and so about lognormal: by logarithms. Levels that adapt themselves and chains
    /// that depend on each other raise the mean of repeats, but hardly their geometric mean; two thirds of the difference of
    /// both are an error, too, for what bias is left.
    fn of(repeats: &[f64]) -> Self {
        let logarithms: Vec<f64> = repeats.iter().map(|probability| libm::log(*probability)).collect();
        let (mean, error) = mean_and_error(&logarithms);
        let bias = error * error * repeats.len() as f64 / 3.0;
        let probability = libm::exp(mean);
        Self::new(probability, libm::hypot(error, bias) * probability)
    }

    /// With the interval that Student's t gives the logarithm.
    fn new(probability: f64, standard_error: f64) -> Self {
        let width = libm::exp(student_factor(REPEATS) * standard_error / probability);
        Self { probability, standard_error, interval: [probability / width, (probability * width).min(1.0)] }
    }
}

#[cfg(test)]
mod tests {
    use super::{Estimate, Finding, REPEATS, Reason};
    use crate::tolerance::failure::subset::Stopped;

    #[test]
    fn no_figure_is_given_that_is_not_known() {
        let mut repeats = vec![Ok(1e-5); REPEATS];
        assert!(matches!(Finding::of(&repeats), Finding::Probability(_)));
        repeats[3] = Ok(1e-2);
        assert!(matches!(Finding::of(&repeats), Finding::Unknown { reason: Reason::Spread(_) }));
        repeats[3] = Err(Stopped::Rarer(1e-9));
        assert_eq!(Finding::of(&repeats), Reason::Missed { reached: REPEATS - 1 }.into());
        assert_eq!(Finding::of(&[Ok(3e-9), Err(Stopped::Rarer(2e-9))]), Finding::Rarer { rarer_than: 3e-9 });
        let known = Finding::Probability(Estimate::new(1e-4, 1e-5));
        assert_eq!(known.clone().checked(0, 5000), known);
        assert!(matches!(known.clone().checked(9, 5000), Finding::Unknown { reason: Reason::Counted { .. } }));
        let rarer = Finding::Rarer { rarer_than: 1e-9 };
        assert!(matches!(rarer.clone().checked(3, 5000), Finding::Unknown { .. }));
        let Finding::Probability(sum) = Finding::sum([&known, &known, &rarer].into_iter()) else { panic!() };
        assert!((sum.probability / 2e-4 - 1.0).abs() < 1e-12 && (sum.standard_error / 1.41421e-5 - 1.0).abs() < 1e-5);
        assert_eq!(Finding::sum([&known, &Reason::Flat.into()].into_iter()), Reason::Part.into());
    }
}
