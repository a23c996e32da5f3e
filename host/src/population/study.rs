//! A population as a whole: its units, what they did together, and what from.

use super::{
    PIECE, Unit,
    drivers::{Driver, Drivers},
    production::Production,
    simulate_units,
    statistics::{Share, Statistics, malfunctions},
    subject::{Subject, UnitGaps},
};
use crate::dynamics::simulate::SimulateError;
use slipfit_core::slide::CONTACTS;

/// Units that find classes for what drives the figures.
const PILOT: u64 = 1024;

/// A population.
#[derive(Clone, Debug)]
pub struct Population<G = [f64; CONTACTS]> {
    /// Every unit, in order.
    pub units: Vec<Unit<G>>,
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
    /// The first `count` units of a `production` of `subject`, on all threads of the current pool; `limit` (N) is a motor's
    /// greatest force, `stroke` (m) what each unit is to travel. `done` is called with how many have been simulated.
    ///
    /// # Errors
    /// See [`simulate_units`].
    pub fn study<S: Subject<Gaps = G>>(
        subject: &S,
        production: &Production<G>,
        count: u64,
        (limit, stroke): (Option<f64>, Option<f64>),
        done: impl Fn(u64) + Sync,
    ) -> Result<Self, SimulateError> {
        let (mut units, mut causes) = (Vec::new(), Causes::new(production));
        simulate_units(subject, production, 0..count, done, |drawn, piece| {
            causes.add(&drawn.variables, piece, limit);
            units.extend_from_slice(piece);
        })?;
        Ok(causes.population(production, units, (limit, stroke)))
    }

    /// Of all `units` of a `production`, in order; `limit` and `stroke` as in [`study`](Self::study).
    pub fn of(production: &Production<G>, units: Vec<Unit<G>>, (limit, stroke): (Option<f64>, Option<f64>)) -> Self {
        let mut causes = Causes::new(production);
        for (start, piece) in (0..).step_by(PIECE).zip(units.chunks(PIECE)) {
            causes.add(&production.draw(start..start + piece.len() as u64).variables, piece, limit);
        }
        causes.population(production, units, (limit, stroke))
    }
}

/// What drives the greatest force and malfunction.
struct Causes {
    of_force: Drivers,
    of_malfunction: Drivers,
}

impl Causes {
    fn new<G: UnitGaps>(production: &Production<G>) -> Self {
        let pilot = production.draw(0..PILOT).variables;
        Self { of_force: Drivers::new(&pilot), of_malfunction: Drivers::new(&pilot) }
    }

    /// Takes note of the `units` of a piece, drawn with these `variables`, a column each.
    fn add<G>(&mut self, variables: &[Vec<f64>], units: &[Unit<G>], limit: Option<f64>) {
        let start = units.first().map_or(0, |unit| unit.number);
        let forces: Vec<_> = units.iter().map(|unit| unit.outcome.peak_force).collect();
        let failed: Vec<_> = units.iter().map(|unit| Some(f64::from(u8::from(malfunctions(unit, limit))))).collect();
        self.of_force.add(start, variables, &forces);
        self.of_malfunction.add(start, variables, &failed);
    }

    fn population<G: UnitGaps>(
        &self,
        production: &Production<G>,
        units: Vec<Unit<G>>,
        (limit, stroke): (Option<f64>, Option<f64>),
    ) -> Population<G> {
        let contributors = production.contributors();
        Population {
            statistics: Statistics::new(&units, limit, stroke),
            units,
            of_force: self.of_force.ranked(&contributors),
            of_malfunction: self.of_malfunction.ranked(&contributors),
        }
    }
}
