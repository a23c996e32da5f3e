//! What is known of a probability after independent repeats: a figure with its error, a bound, or why there is no figure.

use serde::{Serialize, Serializer};
use slipfit_tolerance::{
    failure::{
        importance::mean_and_error,
        subset::Stopped,
        tail::{MOST_ERROR, agrees},
    },
    statistics::{
        binomial,
        interval::{CONFIDENCE, student_factor},
    },
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
    /// No malfunction was found.
    Rarer {
        /// With 95 % confidence, from units that were drawn and counted: the search itself proves nothing.
        rarer_than: f64,
        /// About the probability of the last subset in which none was found.
        searched_to: f64,
        /// Repeats of the search.
        searches: usize,
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
    /// Of repeats, each of which began with so many independent `units`.
    pub fn of(repeats: &[Result<f64, Stopped>], units: u64) -> Self {
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
            Some(searched_to) if reached.is_empty() || searched_to <= LAST => {
                let searches = repeats.len();
                Self::Rarer { rarer_than: none_of(searches as u64 * units), searched_to, searches }
            }
            None if reached.is_empty() => Reason::Flat.into(),
            _ => Reason::Missed { reached: reached.len() }.into(),
        }
    }

    /// The same, with what `hits` among other `units` that were counted say: none where they contradict it. `drawn` is how many units
    /// the repeats began with.
    pub fn checked(self, hits: u64, units: u64, drawn: u64) -> Self {
        match self {
            Self::Probability(Estimate { probability, standard_error, .. })
                if !agrees(Some((hits, units)), probability, standard_error) =>
            {
                Reason::Counted { hits, units, probability }.into()
            }
            Self::Rarer { searched_to, .. } if hits > 0 => {
                Reason::Counted { hits, units, probability: searched_to }.into()
            }
            Self::Rarer { searched_to, searches, .. } => {
                Self::Rarer { rarer_than: none_of(drawn + units), searched_to, searches }
            }
            other => other,
        }
    }

    /// The same, where a share `unknown` of the production may malfunction, too, as it has no verdict.
    pub fn or_more(mut self, unknown: f64) -> Self {
        match &mut self {
            Self::Probability(Estimate { interval: [_, most], .. }) | Self::Rarer { rarer_than: most, .. } => {
                *most = (*most + unknown).min(1.0);
            }
            Self::Unknown { .. } => (),
        }
        self
    }

    /// Of malfunctions that exclude each other.
    pub fn sum<'a>(parts: impl Iterator<Item = &'a Self>) -> Self {
        let (mut sum, mut square, mut ends) = (0.0, 0.0, [0.0; 2]);
        let mut rarer = (0.0, 0.0, 0);
        for part in parts {
            match part {
                Self::Probability(Estimate { probability, standard_error, interval: [low, high] }) => {
                    sum += probability;
                    square += standard_error * standard_error;
                    ends[0] += (probability - low) * (probability - low);
                    ends[1] += (high - probability) * (high - probability);
                }
                Self::Rarer { rarer_than, searched_to, searches } => {
                    // With none among n units of each part, exp(−n·Σp) is the chance of that at most: the least n counts.
                    rarer = (f64::max(rarer.0, *rarer_than), rarer.1 + searched_to, rarer.2 + searches);
                }
                Self::Unknown { .. } => return Reason::Part.into(),
            }
        }
        let (rarer_than, searched_to, searches) = rarer;
        if sum == 0.0 {
            return Self::Rarer { rarer_than, searched_to, searches };
        }
        let interval = [sum - libm::sqrt(ends[0]), (sum + libm::sqrt(ends[1]) + searched_to).min(1.0)];
        Self::Probability(Estimate { probability: sum, standard_error: libm::sqrt(square), interval })
    }
}

/// What a probability is below with 95 % confidence, if none of so many `units` had it (Clopper and Pearson).
fn none_of(units: u64) -> f64 {
    binomial::limits(0, units.max(1), 1.0 - CONFIDENCE)[1]
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
    use slipfit_tolerance::failure::subset::Stopped;

    #[test]
    fn no_figure_is_given_that_is_not_known() {
        let mut repeats = vec![Ok(1e-5); REPEATS];
        assert!(matches!(Finding::of(&repeats, 1024), Finding::Probability(_)));
        repeats[3] = Ok(1e-2);
        assert!(matches!(Finding::of(&repeats, 1024), Finding::Unknown { reason: Reason::Spread(_) }));
        repeats[3] = Err(Stopped::Rarer(1e-9));
        assert_eq!(Finding::of(&repeats, 1024), Reason::Missed { reached: REPEATS - 1 }.into());
        let known = Finding::Probability(Estimate::new(1e-4, 1e-5));
        assert_eq!(known.clone().checked(0, 5000, 1), known);
        assert!(matches!(known.checked(9, 5000, 1), Finding::Unknown { reason: Reason::Counted { .. } }));
    }

    /// What no search has found is rare only as far as units were drawn: none of n is p < 1 − 0.05^(1/n), with 95 % confidence.
    #[test]
    fn what_was_not_found_is_as_rare_as_the_units_prove() {
        let pilots = [Err(Stopped::Rarer(1e-9)); 4];
        let Finding::Rarer { rarer_than, searched_to, searches } = Finding::of(&pilots, 1024) else { panic!() };
        assert!((rarer_than / (1.0 - libm::pow(0.05, 1.0 / 4096.0)) - 1.0).abs() < 1e-9, "{rarer_than}");
        assert_eq!((searched_to, searches), (1e-9, 4));
        let Finding::Rarer { rarer_than, .. } = Finding::of(&pilots, 1024).checked(0, 5904, 4096) else { panic!() };
        assert!((rarer_than / 2.995_732e-4 - 1.0).abs() < 2e-4, "{rarer_than}");
        // Below the last level some repeats find a malfunction, and some do not.
        let some = Finding::of(&[Ok(3e-9), Err(Stopped::Rarer(2e-9))], 1024);
        assert!(matches!(some, Finding::Rarer { searched_to: 3e-9, searches: 2, .. }));
        assert!(matches!(some.checked(3, 5000, 2048), Finding::Unknown { reason: Reason::Counted { hits: 3, .. } }));
    }

    /// What has no verdict may malfunction: it raises the upper end alone.
    #[test]
    fn units_without_a_verdict_widen_the_interval() {
        let known = Finding::Probability(Estimate::new(1e-5, 1e-6));
        let (Finding::Probability(found), Finding::Probability(wider)) = (known.clone(), known.clone().or_more(2e-5))
        else {
            panic!()
        };
        assert_eq!((wider.probability, wider.interval[0]), (found.probability, found.interval[0]));
        assert!((wider.interval[1] - found.interval[1] - 2e-5).abs() < 1e-18);
        let none = Finding::Rarer { rarer_than: 1e-4, searched_to: 1e-9, searches: 4 };
        assert!(matches!(none.clone().or_more(1e-4), Finding::Rarer { rarer_than: 2e-4, .. }));
        // Of malfunctions that exclude each other.
        let Finding::Probability(sum) = Finding::sum([&known, &known, &none].into_iter()) else { panic!() };
        assert!((sum.probability / 2e-5 - 1.0).abs() < 1e-12 && (sum.standard_error / 1.41421e-6 - 1.0).abs() < 1e-5);
        let width = core::f64::consts::SQRT_2 * (found.interval[1] - found.probability) + 1e-9;
        assert!((sum.interval[1] - sum.probability - width).abs() < 1e-15, "{sum:?}");
        assert_eq!(
            Finding::sum([&none, &none].into_iter()),
            Finding::Rarer { rarer_than: 1e-4, searched_to: 2e-9, searches: 8 }
        );
        assert_eq!(Finding::sum([&known, &Reason::Flat.into()].into_iter()), Reason::Part.into());
    }
}
