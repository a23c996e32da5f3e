//! Units of a mechanism's production, each run by the desk.

use slipfit_system::{interrupt, parallel};

use super::{
    Unit, UnitOutcome,
    production::Drawn,
    subject::Subject,
    unit::{Decisive, Fault, is_near_a_limit},
};
use crate::{
    dynamics::{
        outcome::{Outcome, Verdict},
        simulate::SimulateError,
    },
    mechanism::{ByDrive, ENERGY, Mechanism, confirmed, run},
    setup::{Adjustable, RunSpec},
};

/// Error that a step may make, as a share of the mechanism's own speed, unless the scene allows more. Of the shipped mechanisms it costs
/// the peak effort of 95 % of all units less than 0.06 %, and units near the limit of a verdict are run again.
const ERROR: f64 = 1e-4;

impl Subject for ByDrive<'_> {
    /// A unit whose gaps its joints do not allow cannot be assembled: it is jammed where it stands.
    fn units(&self, drawn: &Drawn) -> Result<Vec<Unit>, SimulateError> {
        let unit = |i: usize| {
            let (found, _) = unit(self, drawn, i)?;
            Ok(Unit { number: drawn.numbers.start + i as u64, gaps: drawn.gaps[i].clone(), outcome: found })
        };
        parallel::each(drawn.gaps.len(), unit).into_iter().collect()
    }

    fn decisive(&self, drawn: &Drawn, asked: &[usize]) -> Result<Vec<Result<Decisive, Fault>>, SimulateError> {
        let decisive = |i: &usize| {
            let (outcome, share) = unit(self, drawn, *i)?;
            if let Some(fault @ (Fault::Unsolved | Fault::OutOfBounds)) = outcome.fault {
                return Ok(Err(fault));
            }
            let speed = (outcome.verdict != Verdict::Undecided).then_some(share);
            Ok(Ok(Decisive { speed, force: outcome.peak_force }))
        };
        parallel::try_map(asked, decisive)
    }

    fn trouble(&self, drawn: &Drawn, i: usize) -> Option<String> {
        of_run(self, drawn, i).err().map(|error| error.to_string())
    }

    fn gaps_at(&self, n: &[f64]) -> Vec<f64> {
        self.mechanism().stated_gaps_at(n)
    }

    fn levels_of(&self, gaps: &[f64]) -> Vec<Option<f64>> {
        self.mechanism().levels_of(gaps)
    }

    fn fits(&self, gaps: &[f64]) -> bool {
        self.mechanism().misfit(gaps).is_none()
    }

    fn combinations(&self) -> u64 {
        128
    }

    fn parameters(&self) -> usize {
        self.mechanism().vary.len()
    }
}

/// The mechanism of unit `i` of those `drawn`.
pub fn mechanism_of(mechanism: &Mechanism, drawn: &Drawn, i: usize) -> Mechanism {
    let mut own = mechanism.clone();
    for (varied, deviation) in mechanism.vary.iter().zip(&drawn.deviations[i]) {
        varied.parameter.vary(&mut own, *deviation);
    }
    own
}

/// What unit `i` of those `drawn` does, and its final speed as a share of the command.
fn unit(driven: &ByDrive, drawn: &Drawn, i: usize) -> Result<(UnitOutcome, f64), SimulateError> {
    if interrupt::requested() {
        return Err(SimulateError::Interrupted);
    }
    if !driven.fits(&drawn.gaps[i]) {
        return Ok((Fault::Unassembled.outcome(), 0.0));
    }
    match of_run(driven, drawn, i) {
        Ok((outcome, share, at_desk)) => Ok((told(&outcome, at_desk), share)),
        Err(error) => Ok((Fault::of(error)?.outcome(), 0.0)),
    }
}

/// What the run of unit `i` found, its final speed as a share of the command, and whether it was run again.
fn of_run(driven: &ByDrive, drawn: &Drawn, i: usize) -> Result<(Outcome, f64, bool), SimulateError> {
    let gaps = &drawn.gaps[i];
    let own = mechanism_of(driven.mechanism(), drawn, i);
    let spec = RunSpec { error: own.run.error.max(ERROR), ..own.run };
    let found = run(&Mechanism { run: spec, ..own.clone() }, gaps, spec.duration)?;
    let outcome = found.outcomes[driven.index()];
    let has_energy_from_nowhere = found.energy_excess.is_nan() || found.energy_excess > ENERGY;
    let is_doubtful = is_near_a_limit(outcome.share) || outcome.swings.is_some() || has_energy_from_nowhere;
    // No verdict stays none.
    if outcome.verdict == Verdict::Undecided || !is_doubtful {
        return Ok((outcome, outcome.share, false));
    }
    let [exact, _] = confirmed(&own, gaps, spec.duration)?;
    let exact = exact.outcomes[driven.index()];
    Ok((exact, exact.share, true))
}

fn told(outcome: &Outcome, at_desk: bool) -> UnitOutcome {
    let Outcome { verdict, breakaway, peak_force, settled_force, final_velocity, end, .. } = *outcome;
    UnitOutcome {
        verdict,
        breakaway,
        peak_force,
        settled_force,
        final_velocity,
        end,
        most_loaded: None,
        at_desk,
        fault: None,
    }
}
