//! Units of a mechanism's production, each run by the desk.

use rayon::prelude::*;

use super::{PIECE, Unit, UnitOutcome, production::Production, study::Population, unit::is_near_a_limit};
use crate::{
    dynamics::{
        driven::Driven,
        outcome::{Moment, Outcome, Verdict},
        simulate::SimulateError,
    },
    mechanism::{ByDrive, Mechanism, confirmed, run},
    scene::RunSpec,
    system::interrupt,
};

/// Error that a step may make, as a share of the mechanism's own speed, unless the scene allows more.
const ERROR: f64 = 1e-5;

/// A population of a mechanism.
pub type MechanismPopulation = Population<Vec<f64>>;

/// The first `count` units of a `production`, by the drive of `driven`, whose effort `limit` (N, N·m) is the motor's greatest;
/// `done` is called with how many have been simulated. A unit whose gaps its joints do not allow cannot be assembled: it is jammed
/// where it stands.
///
/// # Errors
/// [`SimulateError`] of the first unit that cannot be solved.
pub fn study(
    driven: &ByDrive,
    production: &Production<Vec<f64>>,
    count: u64,
    limit: Option<f64>,
    done: impl Fn(u64) + Sync,
) -> Result<MechanismPopulation, SimulateError> {
    let starts: Vec<u64> = (0..count).step_by(PIECE).collect();
    let piece = |start: &u64| -> Result<Vec<Unit<Vec<f64>>>, SimulateError> {
        let numbers = *start..(start + PIECE as u64).min(count);
        let gaps = production.draw(numbers.clone()).gaps;
        let unit = |(number, gaps): (u64, Vec<f64>)| {
            let outcome = unit(driven, &gaps)?;
            done(1);
            Ok(Unit { number, gaps, outcome })
        };
        numbers.zip(gaps).collect::<Vec<_>>().into_par_iter().map(unit).collect()
    };
    let units: Vec<_> = starts.iter().map(piece).collect::<Result<_, _>>()?;
    Ok(Population::of(production, units.concat(), limit))
}

/// What the unit with these `gaps` (m) does.
///
/// # Errors
/// [`SimulateError`], if it cannot be solved.
pub fn unit(driven: &ByDrive, gaps: &[f64]) -> Result<UnitOutcome, SimulateError> {
    if interrupt::requested() {
        return Err(SimulateError::Interrupted);
    }
    let mechanism = driven.mechanism();
    if mechanism.misfit(gaps).is_some() {
        return Ok(UNASSEMBLED);
    }
    let spec = RunSpec { error: mechanism.run.error.max(ERROR), ..mechanism.run };
    let quick = Mechanism { run: spec, ..mechanism.clone() };
    let outcome = run(&quick, gaps, spec.duration)?.outcomes[driven.index()];
    let share = outcome.final_velocity / driven.drive().command(outcome.end.t).abs();
    if !is_near_a_limit(share) {
        return Ok(told(&outcome, false));
    }
    let [exact, _] = confirmed(mechanism, gaps, spec.duration)?;
    Ok(told(&exact.outcomes[driven.index()], true))
}

/// What a unit does that cannot be assembled.
const UNASSEMBLED: UnitOutcome = UnitOutcome {
    verdict: Verdict::Jammed,
    breakaway: None,
    peak_force: None,
    settled_force: None,
    final_velocity: 0.0,
    end: Moment { t: 0.0, z: 0.0 },
    most_loaded: None,
    at_desk: false,
};

fn told(outcome: &Outcome, at_desk: bool) -> UnitOutcome {
    let Outcome { verdict, breakaway, peak_force, settled_force, final_velocity, end, .. } = *outcome;
    UnitOutcome { verdict, breakaway, peak_force, settled_force, final_velocity, end, most_loaded: None, at_desk }
}
