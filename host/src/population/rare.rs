//! Rare malfunction: its probability by subset simulation through the dynamics.
//!
//! Every kind of malfunction is a limit state of its own, and so is every side: loose units tip and wedge, tight ones crawl,
//! and levels that follow one of these never see the other. Kinds and sides exclude each other, so that probabilities add up.
//! Independent repeats tell the error.

use rayon::prelude::*;
use serde::Serialize;
use slipfit_core::sampling::stream::derived;

use super::{
    finding::{Finding, REPEATS, Reason},
    limit_state::{Kind, LimitState, Log, Side},
    production::Production,
    subject::Subject,
};
use crate::{
    dynamics::simulate::SimulateError,
    tolerance::failure::{Margins, subset},
};

/// Repeats that find out whether there is anything to be found.
const PILOTS: usize = 4;
/// Units of a level.
const UNITS: usize = 1024;
/// Levels: the last one is at about 1e-9, and at 1e-8 where chains stand still now and then.
const LEVELS: u64 = 10;
/// What seeds of repeats are derived with.
const STREAM: u64 = 6 << 32;

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
pub struct Question<'a, S: Subject> {
    /// What the units are of.
    pub subject: &'a S,
    /// What varies in it.
    pub production: &'a Production<'a, S::Gaps>,
    /// Seed of the repeats.
    pub seed: u64,
    /// A motor's force (N).
    pub limit: Option<f64>,
}

impl<S: Subject> Question<'_, S> {
    /// Kinds and sides.
    fn cells(&self) -> Vec<(Kind, Side)> {
        let kinds = [Kind::Crawls, Kind::Jams, Kind::Overruns, Kind::OverLimit];
        let kinds = kinds.into_iter().filter(|kind| *kind != Kind::OverLimit || self.limit.is_some());
        kinds.flat_map(|kind| Side::all(self.subject).iter().map(move |side| (kind, *side))).collect()
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
        let Self { subject, production, limit, .. } = *self;
        let part = |(number, (kind, side)): (usize, (Kind, Side))| {
            let state = || LimitState { subject, production, kind, side, limit, log: Log::default() };
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

#[cfg(test)]
mod tests {
    use rayon::prelude::*;

    use super::probability;
    use crate::{
        population::finding::{Estimate, Finding, Reason},
        tolerance::failure::Margins,
    };

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
        -crate::tolerance::distribution::normal::quantile(probability)
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
    fn the_figure_depends_on_the_seed_alone() {
        let on = |threads: usize, seed: u64| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| found(|z| 4.0 - z[0], seed))
        };
        assert_eq!(on(1, 3), on(4, 3));
        assert!(on(1, 3) != on(1, 4));
    }
}
