//! Units of a mechanism's production, each run by the desk.

use slipfit_system::{interrupt, parallel};

use super::{
    Unit, UnitOutcome,
    production::Drawn,
    stroke::Stroke,
    subject::Subject,
    unit::{Decisive, Fault, is_near_a_limit},
};
use crate::{
    dynamics::{
        outcome::{Outcome, Verdict},
        simulate::SimulateError,
    },
    mechanism::{
        ByDrive, ENERGY, Mechanism, MechanismRun, Parameter, ProductionUnit, batch_size, confirmed, run, run_units,
    },
    setup::{Adjustable, RunSpec},
};

/// Error that a step may make, as a share of the mechanism's own speed, unless the scene allows more. Of the shipped mechanisms it costs
/// the peak effort of 95 % of all units less than 0.06 %, and units near the limit of a verdict are run again.
const ERROR: f64 = 1e-4;

impl Subject for ByDrive<'_> {
    /// A unit whose gaps its joints do not allow cannot be assembled: it is jammed where it stands.
    fn units(&self, drawn: &Drawn) -> Result<Vec<Unit>, SimulateError> {
        let all: Vec<usize> = (0..drawn.gaps.len()).collect();
        let unit = |(i, (outcome, _)): (usize, (UnitOutcome, f64))| Unit {
            number: drawn.numbers.start + i as u64,
            gaps: drawn.gaps[i].clone(),
            outcome,
        };
        Ok(units(self, drawn, &all)?.into_iter().enumerate().map(unit).collect())
    }

    fn decisive(&self, drawn: &Drawn, asked: &[usize]) -> Result<Vec<Result<Decisive, Fault>>, SimulateError> {
        let decisive = |(outcome, share): (UnitOutcome, f64)| {
            if let Some(fault @ (Fault::Unsolved | Fault::OutOfBounds)) = outcome.fault {
                return Err(fault);
            }
            let speed = (outcome.verdict != Verdict::Undecided).then_some(share);
            Ok(Decisive { speed, force: outcome.peak_force })
        };
        Ok(units(self, drawn, asked)?.into_iter().map(decisive).collect())
    }

    fn stroke(&self, drawn: &Drawn, i: usize, friction: f64, every: f64) -> Result<Stroke, SimulateError> {
        let ProductionUnit { mut mechanism, gaps } = made(self, drawn, i);
        Parameter::Friction.change(&mut mechanism, &mut |coefficient| coefficient * (1.0 + friction));
        let mut run = run(&mechanism, &gaps, every)?;
        Ok(Stroke { outcome: run.outcomes[self.index()], trajectory: run.trajectories.swap_remove(self.index()) })
    }

    fn trouble(&self, drawn: &Drawn, i: usize) -> Option<String> {
        let ProductionUnit { mechanism, gaps } = made(self, drawn, i);
        let run = run(&mechanism, &gaps, mechanism.run.duration).map_err(SimulateError::from);
        run.and_then(|run| judged(self, drawn, i, &run)).err().map(|error| error.to_string())
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

/// What those of the units that were `drawn` which are `asked` for do, and their final speeds as shares of the command.
fn units(driven: &ByDrive, drawn: &Drawn, asked: &[usize]) -> Result<Vec<(UnitOutcome, f64)>, SimulateError> {
    let pieces: Vec<&[usize]> = asked.chunks(batch_size(driven.mechanism())).collect();
    let found = parallel::try_map(&pieces, |piece| together(driven, drawn, piece))?;
    Ok(found.into_iter().flatten().collect())
}

/// The same of a few.
fn together(driven: &ByDrive, drawn: &Drawn, asked: &[usize]) -> Result<Vec<(UnitOutcome, f64)>, SimulateError> {
    let fits = |i: &usize| driven.fits(&drawn.gaps[*i]);
    let made: Vec<ProductionUnit> = asked.iter().filter(|i| fits(i)).map(|i| made(driven, drawn, *i)).collect();
    let mut runs = run_units(&made, usize::MAX).into_iter();
    let mut found = Vec::with_capacity(asked.len());
    for i in asked {
        if interrupt::requested() {
            return Err(SimulateError::Interrupted);
        }
        let run = if fits(i) { runs.next() } else { None };
        found.push(match run {
            None => (Fault::Unassembled.outcome(), 0.0),
            Some(run) => match run.map_err(SimulateError::from).and_then(|run| judged(driven, drawn, *i, &run)) {
                Ok((outcome, at_desk)) => (told(&outcome, at_desk), outcome.share),
                Err(error) => (Fault::of(error)?.outcome(), 0.0),
            },
        });
    }
    Ok(found)
}

/// Unit `i` of those `drawn`, to the tolerance of populations.
fn made(driven: &ByDrive, drawn: &Drawn, i: usize) -> ProductionUnit {
    let own = mechanism_of(driven.mechanism(), drawn, i);
    let run = RunSpec { error: own.run.error.max(ERROR), ..own.run };
    ProductionUnit { mechanism: Mechanism { run, ..own }, gaps: drawn.gaps[i].clone() }
}

/// What the run of unit `i` found, run again where that is in doubt; and whether it was.
fn judged(driven: &ByDrive, drawn: &Drawn, i: usize, found: &MechanismRun) -> Result<(Outcome, bool), SimulateError> {
    let outcome = found.outcomes[driven.index()];
    let has_energy_from_nowhere = found.energy_excess.is_nan() || found.energy_excess > ENERGY;
    let is_doubtful = is_near_a_limit(outcome.share) || outcome.swings.is_some() || has_energy_from_nowhere;
    // No verdict stays none.
    if outcome.verdict == Verdict::Undecided || !is_doubtful {
        return Ok((outcome, false));
    }
    let own = mechanism_of(driven.mechanism(), drawn, i);
    let [exact, _] = confirmed(&own, &drawn.gaps[i], own.run.duration)?;
    Ok((exact.outcomes[driven.index()], true))
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
