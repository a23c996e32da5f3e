//! A population as a whole: what its units did together, and what from.

use super::{
    drivers,
    drivers::Driver,
    production::Production,
    simulate_units,
    statistics::{Share, Statistics, malfunctions},
    subject::{Subject, UnitGaps},
    tally::{Counter, Duty, Tally},
};
use crate::dynamics::simulate::SimulateError;
use slipfit_core::slide::CONTACTS;

/// A population.
#[derive(Clone, Debug)]
pub struct Population<G = [f64; CONTACTS]> {
    /// What is kept of its units.
    pub tally: Tally<G>,
    /// What they did together.
    pub statistics: Statistics,
    /// What drives the greatest force, the strongest first.
    pub of_force: Vec<Driver>,
    /// What drives malfunction, likewise.
    pub of_malfunction: Vec<Driver>,
}

/// The share of the first `count` units of a `production` of `subject` that malfunction; see [`Population::study`].
///
/// # Errors
/// See [`simulate_units`].
pub fn share_of_malfunctions<S: Subject>(
    subject: &S,
    production: &Production<S::Gaps>,
    count: u64,
    limit: Option<f64>,
    done: impl Fn(u64) + Sync,
) -> Result<Share, SimulateError> {
    let mut failed = 0;
    simulate_units(subject, production, 0..count, done, |_, units| {
        failed += units.iter().filter(|unit| malfunctions(unit, limit)).count() as u64;
    })?;
    Ok(Share::new(failed, count))
}

impl<G: UnitGaps> Population<G> {
    /// The first `count` units of a `production` of `subject` with this `duty`, on all threads of the current pool. `done` is
    /// called with how many have been simulated.
    ///
    /// # Errors
    /// See [`simulate_units`].
    pub fn study<S: Subject<Gaps = G>>(
        subject: &S,
        production: &Production<G>,
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
    pub fn of(production: &Production<G>, tally: Tally<G>, duty: Duty) -> Self {
        Self {
            statistics: Statistics::new(&tally, duty),
            of_force: drivers::of_force(production, &tally.outcomes, tally.counts.units),
            of_malfunction: drivers::of_malfunction(production, &tally.outcomes, tally.counts.units),
            tally,
        }
    }
}
