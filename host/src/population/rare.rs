//! Rare malfunction: its probability by subset simulation through the dynamics.
//!
//! Every kind of malfunction is a limit state of its own, and so is every side: loose units tip and wedge, tight ones crawl,
//! and levels that follow one of these never see the other. Kinds and sides exclude each other, so that probabilities add up.
//! Independent repeats tell the error.

use rayon::prelude::*;
use serde::{Serialize, Serializer};
use slipfit_core::sampling::stream::derived;

use super::{
    limit_state::{Kind, LimitState, Log, Side},
    production::Production,
};
use crate::{
    scene::Scene,
    simulate::SimulateError,
    tolerance::{
        failure::Margins,
        importance::mean_and_error,
        interval::student_factor,
        subset::{self, Stopped},
        tail::{MOST_ERROR, agrees},
    },
};

/// Independent repeats, whose spread is the error.
pub const REPEATS: usize = 16;
/// Repeats that find out whether there is anything to be found.
const PILOTS: usize = 4;
/// Units of a level.
const UNITS: usize = 1024;
/// Levels: the last one is at about 1e-9, and at 1e-8 where chains stand still now and then.
const LEVELS: u64 = 10;
/// What repeats of which some end without a malfunction may have found for its probability to be below the levels.
const LAST: f64 = 1e-7;

/// What seeds of repeats are derived with.
const STREAM: u64 = 6 << 32;

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

/// One kind of malfunction on one side.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// How units malfunction.
    pub kind: Kind,
    /// Which do.
    pub side: Side,
    /// How many.
    #[serde(flatten)]
    pub finding: Finding,
}

/// Rare malfunction of a production.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rare {
    /// Of any kind, on any side.
    pub malfunction: Finding,
    /// By kind and side.
    pub parts: Vec<Part>,
    /// Units that were simulated for it.
    pub simulated: u64,
}

/// What is asked for.
pub struct Question<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What varies in it.
    pub production: &'a Production<'a>,
    /// Seed of the repeats.
    pub seed: u64,
    /// A motor's force (N).
    pub limit: Option<f64>,
}

impl Question<'_> {
    /// Kinds and sides.
    fn cells(&self) -> Vec<(Kind, Side)> {
        let kinds = [Kind::Crawls, Kind::Jams, Kind::OverLimit];
        let kinds = kinds.into_iter().filter(|kind| *kind != Kind::OverLimit || self.limit.is_some());
        kinds.flat_map(|kind| Side::all(self.scene).iter().map(move |side| (kind, *side))).collect()
    }

    /// How many repeats there are, at most.
    pub fn repeats(&self) -> usize {
        REPEATS * self.cells().len()
    }

    /// The answer, on all threads of the current pool; `counted` is how many units malfunction so of those that were simulated
    /// one by one. `done` is called with repeats as they end.
    ///
    /// # Errors
    /// [`SimulateError`], if a unit cannot be solved or somebody asked to stop.
    pub fn answer(
        &self,
        counted: impl Fn(Kind, Side) -> (u64, u64) + Sync,
        done: impl Fn(usize) + Sync,
    ) -> Result<Rare, SimulateError> {
        let Self { scene, production, limit, .. } = *self;
        let part = |(number, (kind, side)): (usize, (Kind, Side))| {
            let state = || LimitState { scene, production, kind, side, limit, log: Log::default() };
            let seed = derived(self.seed, STREAM + number as u64);
            let (finding, states) = probability(&state, production.factor(), seed, &done);
            let mut all = Log::default();
            for LimitState { log, .. } in states {
                log.error.map_or(Ok(()), Err)?;
                all.simulated += log.simulated;
                all.undecided += log.undecided;
                all.out_of_bounds += log.out_of_bounds;
            }
            let (hits, units) = counted(kind, side);
            let Log { simulated, undecided, out_of_bounds, .. } = all;
            let finding = match finding {
                _ if out_of_bounds > 0 => Reason::OutOfBounds { units: out_of_bounds, simulated }.into(),
                _ if undecided > 0 => Reason::NoVerdict { undecided, simulated }.into(),
                finding => finding.checked(hits, units),
            };
            Ok::<_, SimulateError>((Part { kind, side, finding }, simulated))
        };
        let cells = self.cells();
        let found: Result<Vec<_>, _> = cells.into_par_iter().enumerate().with_max_len(1).map(part).collect();
        let (parts, simulated): (Vec<Part>, Vec<u64>) = found?.into_iter().unzip();
        let malfunction = Finding::sum(parts.iter().map(|part| &part.finding));
        Ok(Rare { malfunction, parts, simulated: simulated.iter().sum() })
    }
}

/// The probability that a margin is below 0, which the `factor` of truncated zones raises, and the states that found it.
fn probability<M: Margins + Send>(
    state: &(impl Fn() -> M + Sync),
    factor: f64,
    seed: u64,
    done: impl Fn(usize) + Sync,
) -> (Finding, Vec<M>) {
    let repeat = |number: usize| {
        let mut state = state();
        let found = subset::run(&mut state, UNITS, LEVELS, derived(seed, number as u64));
        done(1);
        (found.map(|run| (factor * run.probability).min(1.0)), state)
    };
    let repeats =
        |numbers: std::ops::Range<usize>| -> Vec<_> { numbers.into_par_iter().with_max_len(1).map(repeat).collect() };
    let mut all = repeats(0..PILOTS);
    if all.iter().any(|(found, _)| found.is_ok()) {
        all.extend(repeats(PILOTS..REPEATS));
    } else {
        done(REPEATS - PILOTS);
    }
    let (found, states): (Vec<_>, Vec<_>) = all.into_iter().unzip();
    (Finding::of(&found), states)
}

impl From<Reason> for Finding {
    fn from(reason: Reason) -> Self {
        Self::Unknown { reason }
    }
}

impl Finding {
    /// Of repeats.
    fn of(repeats: &[Result<f64, Stopped>]) -> Self {
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
    fn checked(self, hits: u64, units: u64) -> Self {
        let (probability, error) = match &self {
            Self::Probability(estimate) => (estimate.probability, estimate.standard_error),
            Self::Rarer { rarer_than } => (*rarer_than, 0.0),
            Self::Unknown { .. } => return self,
        };
        let agrees = agrees(Some((hits, units)), probability, error);
        if agrees { self } else { Reason::Counted { hits, units, probability }.into() }
    }

    /// Of malfunctions that exclude each other.
    fn sum<'a>(parts: impl Iterator<Item = &'a Self>) -> Self {
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
    use rayon::prelude::*;

    use super::{Estimate, Finding, REPEATS, Reason, probability};
    use crate::tolerance::{failure::Margins, subset::Stopped};

    /// A margin of three scores.
    struct Of<F>(F);

    impl<F: Fn(&[f64]) -> f64> Margins for Of<F> {
        fn dimensions(&self) -> usize {
            3
        }

        fn at(&mut self, points: &[Vec<f64>]) -> Vec<f64> {
            points.iter().map(|point| (self.0)(point)).collect()
        }
    }

    fn found(margin: impl Fn(&[f64]) -> f64 + Copy + Send + Sync, seed: u64) -> Finding {
        probability(&|| Of(margin), 1.0, seed, |_| ()).0
    }

    /// z with P(Z > z) = `probability`.
    fn limit(probability: f64) -> f64 {
        -crate::tolerance::normal::quantile(probability)
    }

    /// How often the stated interval holds what is known, over 200 seeds. With 181 or fewer the chance of a true 95 % is below
    /// 1 %.
    #[track_caller]
    fn holds(margin: impl Fn(&[f64]) -> f64 + Copy + Send + Sync, known: f64) {
        let holds = |seed| match found(margin, seed) {
            Finding::Probability(Estimate { interval: [low, high], .. }) => low <= known && known <= high,
            other => panic!("{other:?}"),
        };
        let held = (0..200).into_par_iter().filter(|seed| holds(*seed)).count();
        println!("{known:e}: {held} of 200");
        assert!(held >= 182, "{known:e}: {held} of 200");
    }

    #[test]
    fn stated_intervals_hold_for_a_linear_limit() {
        for known in [1e-5, 1e-7] {
            let limit = limit(known);
            holds(|z| limit - (z[0] + z[1] + z[2]) / libm::sqrt(3.0), known);
        }
    }

    #[test]
    fn stated_intervals_hold_for_two_opposite_limits() {
        for known in [1e-5, 1e-7] {
            let limit = limit(known / 2.0);
            holds(|z| limit - (0.6 * z[0] + 0.8 * z[1]).abs(), known);
        }
    }

    #[test]
    fn what_never_happens_is_rarer_than_the_last_level() {
        let Finding::Rarer { rarer_than } = found(|z| 9.0 - z[0], 1) else { panic!() };
        assert!((1e-10..1e-8).contains(&rarer_than), "{rarer_than}");
        assert_eq!(found(|_| 1.0, 1), Reason::Flat.into());
        // As probable as not, it is counted.
        let Finding::Probability(found) = found(|z| z[0], 1) else { panic!() };
        assert!((found.probability - 0.5).abs() < 4.0 * found.standard_error && found.standard_error < 0.01);
    }

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

    #[test]
    fn the_figure_depends_on_the_seed_alone() {
        let on = |threads: usize, seed: u64| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| found(|z| 4.0 - z[0], seed))
        };
        assert_eq!(on(1, 3), on(4, 3));
        assert!(on(1, 3) != on(1, 4));
    }
}
