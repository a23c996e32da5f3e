//! A population as a whole: what its units did together, and what from.

use super::{
    drivers,
    drivers::Driver,
    production::Production,
    simulate_units,
    statistics::{Statistics, malfunctions},
    subject::Subject,
    tally::{Counter, Duty, Tally},
};
use crate::dynamics::{outcome::Verdict, simulate::SimulateError};

/// A population.
#[derive(Clone, Debug)]
pub struct Population {
    /// What is kept of its units.
    pub tally: Tally,
    /// What they did together.
    pub statistics: Statistics,
    /// What drives the greatest force, the strongest first.
    pub of_force: Vec<Driver>,
    /// What drives malfunction, likewise.
    pub of_malfunction: Vec<Driver>,
}

/// What units do, as far as requirements look at it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Judgement {
    /// Units that malfunction.
    pub failed: u64,
    /// Others that come to no verdict.
    pub undecided: u64,
    /// All.
    pub units: u64,
}

/// How many of the first `count` units of a `production` of `subject` malfunction, and how many come to no verdict; see
/// [`Population::study`].
///
/// # Errors
/// See [`simulate_units`].
pub fn judge(
    subject: &dyn Subject,
    production: &Production,
    count: u64,
    limit: Option<f64>,
    done: impl Fn(u64) + Sync,
) -> Result<Judgement, SimulateError> {
    let mut found = Judgement { units: count, ..Judgement::default() };
    simulate_units(subject, production, 0..count, done, |_, units| {
        for unit in units {
            let fails = malfunctions(unit, limit);
            found.failed += u64::from(fails);
            found.undecided += u64::from(!fails && unit.outcome.verdict == Verdict::Undecided);
        }
    })?;
    Ok(found)
}

impl Population {
    /// The first `count` units of a `production` of `subject` with this `duty`, on all threads of the current pool. `done` is
    /// called with how many have been simulated.
    ///
    /// # Errors
    /// See [`simulate_units`].
    pub fn study(
        subject: &dyn Subject,
        production: &Production,
        count: u64,
        duty: Duty,
        done: impl Fn(u64) + Sync,
    ) -> Result<Self, SimulateError> {
        let counter = Counter::new(subject, duty);
        let mut tally = counter.nothing();
        simulate_units(subject, production, 0..count, done, |_, units| counter.add(&mut tally, units))?;
        Ok(Self::of(production, tally, duty))
    }

    /// Of the `tally` of a `production` with this `duty`.
    pub fn of(production: &Production, tally: Tally, duty: Duty) -> Self {
        Self {
            statistics: Statistics::new(&tally, duty),
            of_force: drivers::of_force(production, &tally.outcomes, tally.counts.units),
            of_malfunction: drivers::of_malfunction(production, &tally.outcomes, tally.counts.units),
            tally,
        }
    }
}
