//! Levels and units for machines.

use serde::Serialize;

use crate::{
    dynamics::{outcome::Verdict, simulate::SimulateError},
    population::{Unit, subject::Subject, tally::Tally, unit::UnitOutcome},
};

/// Levels of eq. 9 that are looked for in the population.
const LEVELS: [f64; 13] = [-6.0, -5.0, -4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0];

/// Where the unit of a level lies in the population.
#[derive(Serialize)]
pub struct LevelReport {
    pub n: f64,
    pub verdict: Verdict,
    peak_force_n: Option<f64>,
    /// Share of the population that needs less force.
    share_below: f64,
}

impl LevelReport {
    /// Of level `n`, whose unit did this, among the units of a `tally`.
    pub fn new(n: f64, outcome: &UnitOutcome, tally: &Tally) -> Self {
        // Those that have no force need none.
        let Tally { counts, figures, .. } = tally;
        let without = counts.units - figures.force.units();
        let below = outcome.peak_force.map_or(0, |force| without + figures.force.below(force));
        let share_below = below as f64 / counts.units.max(1) as f64;
        Self { n, verdict: outcome.verdict, peak_force_n: outcome.peak_force, share_below }
    }

    /// Of those of [`LEVELS`] at which a unit of `subject` can be assembled.
    pub fn all(subject: &dyn Subject, tally: &Tally) -> Result<Vec<Self>, SimulateError> {
        let at = subject.at_levels(&LEVELS)?;
        Ok(at.iter().map(|(n, unit)| Self::new(*n, &unit.outcome, tally)).collect())
    }
}

/// A unit for machines.
#[derive(Serialize)]
pub struct UnitReport {
    pub number: u64,
    pub tightness: f64,
    #[serde(flatten)]
    pub outcome: UnitOutcome,
}

impl UnitReport {
    /// The worst units of `subject`, the worst first.
    pub fn worst(subject: &dyn Subject, tally: &Tally) -> Vec<Self> {
        let report =
            |unit: &Unit| Self { number: unit.number, tightness: subject.tightness(&unit.gaps), outcome: unit.outcome };
        tally.worst.iter().map(report).collect()
    }
}
