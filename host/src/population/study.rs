//! A population as a whole: its units, what they did together, and what from.

use super::{
    PIECE, Unit,
    drivers::{Driver, Drivers},
    production::Production,
    simulate_units,
    statistics::{Share, Statistics, malfunctions},
};
use crate::{dynamics::simulate::SimulateError, scene::Scene};

/// Units that find classes for what drives the figures.
const PILOT: u64 = 1024;

/// A population.
#[derive(Clone, Debug)]
pub struct Population {
    /// Every unit, in order.
    pub units: Vec<Unit>,
    /// What they did together.
    pub statistics: Statistics,
    /// What drives the greatest force, the strongest first.
    pub of_force: Vec<Driver>,
    /// What drives malfunction, likewise.
    pub of_malfunction: Vec<Driver>,
}

/// The share of the first `count` units of a `production` of `scene` that malfunction; see [`Population::study`].
///
/// # Errors
/// See [`simulate_units`].
pub fn share_of_malfunctions(
    scene: &Scene,
    production: &Production,
    count: u64,
    limit: Option<f64>,
    done: impl Fn(u64) + Sync,
) -> Result<Share, SimulateError> {
    let mut failed = 0;
    simulate_units(scene, production, 0..count, done, |_, units| {
        failed += units.iter().filter(|unit| malfunctions(unit, limit)).count() as u64;
    })?;
    Ok(Share::new(failed, count))
}

impl Population {
    /// The first `count` units of a `production` of `scene`, on all threads of the current pool; `limit` (N) is a motor's
    /// greatest force. `done` is called with how many have been simulated.
    ///
    /// # Errors
    /// See [`simulate_units`].
    pub fn study(
        scene: &Scene,
        production: &Production,
        count: u64,
        limit: Option<f64>,
        done: impl Fn(u64) + Sync,
    ) -> Result<Self, SimulateError> {
        let mut units = Vec::new();
        simulate_units(scene, production, 0..count, done, |_, piece| units.extend_from_slice(piece))?;
        Ok(Self::of(production, units, limit))
    }

    /// Of all `units` of a `production`, in order.
    pub fn of(production: &Production, units: Vec<Unit>, limit: Option<f64>) -> Self {
        let pilot = production.draw(0..PILOT).variables;
        let mut drivers = [Drivers::new(&pilot), Drivers::new(&pilot)];
        for (start, piece) in (0..).step_by(PIECE).zip(units.chunks(PIECE)) {
            let variables = production.draw(start..start + piece.len() as u64).variables;
            let of = |figure: &dyn Fn(&Unit) -> Option<f64>| piece.iter().map(figure).collect::<Vec<_>>();
            let figures =
                [of(&|unit| unit.outcome.peak_force), of(&|unit| Some(f64::from(u8::from(malfunctions(unit, limit)))))];
            for (drivers, figures) in drivers.iter_mut().zip(&figures) {
                drivers.add(start, &variables, figures);
            }
        }
        let contributors = production.contributors();
        let [of_force, of_malfunction] = drivers.map(|drivers| drivers.ranked(&contributors));
        Self { statistics: Statistics::new(&units, limit), units, of_force, of_malfunction }
    }
}
