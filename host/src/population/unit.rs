//! One unit of a population: what it did, or why it has no run.

use serde::Serialize;

use crate::dynamics::{
    outcome::{JAMMED, Moment, RUNS, Verdict},
    simulate::SimulateError,
};

/// Units whose final speed, as a share of the command, is this near to a limit between two verdicts are simulated once more
/// at the desk: relative to the limit. Of 12,000 units of two scenes no speed was off by more than a hundredth of that.
const DOUBT: f64 = 0.01;

/// One unit of a population.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// Its number in the production, from 0 on.
    pub number: u64,
    /// Its gaps (m): of a slide in the order of Table 2, else in the mechanism's order.
    pub gaps: Vec<f64>,
    /// What it did.
    pub outcome: UnitOutcome,
}

/// Figures of one unit. Speeds, forces and travel count along the commanded direction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct UnitOutcome {
    /// Verdict at the end.
    pub verdict: Verdict,
    /// Breakaway time (s), if the unit breaks away.
    pub breakaway: Option<f64>,
    /// Magnitude of the greatest force, driving or braking, from the ramp's start on (N); none if the run ends before.
    pub peak_force: Option<f64>,
    /// Mean force over the last 20 ms (N), if it varies by less than 1 %.
    pub settled_force: Option<f64>,
    /// Velocity at the end (m/s).
    pub final_velocity: f64,
    /// The end of the run.
    pub end: Moment,
    /// The contact that was pressed in deepest, in the order of Table 2, and its elastic force (N) then; none if none
    /// was.
    pub most_loaded: Option<(usize, f64)>,
    /// Whether the desk computed it.
    pub at_desk: bool,
    /// Why there is no run, if there is none.
    pub fault: Option<Fault>,
}

/// Why a unit has no run, and so no figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fault {
    /// Its joints do not allow its gaps: it is jammed where it stands.
    Unassembled,
    /// No step of the desk meets the tolerance.
    Unsolved,
    /// One of its parameters is out of bounds.
    OutOfBounds,
}

/// Faults, in the order in which units are counted by them.
pub const FAULTS: [Fault; 3] = [Fault::Unassembled, Fault::Unsolved, Fault::OutOfBounds];

impl Fault {
    /// Of one unit.
    ///
    /// # Errors
    /// What has nothing to do with the unit: somebody asked to stop.
    pub fn of(error: SimulateError) -> Result<Self, SimulateError> {
        match error {
            SimulateError::Unsolved { .. } | SimulateError::NotFinite { .. } => Ok(Self::Unsolved),
            SimulateError::Parameter(_) => Ok(Self::OutOfBounds),
            SimulateError::Every { .. } | SimulateError::Interrupted => Err(error),
        }
    }

    /// What a unit with it did.
    pub fn outcome(self) -> UnitOutcome {
        UnitOutcome {
            verdict: if self == Self::Unassembled { Verdict::Jammed } else { Verdict::Undecided },
            breakaway: None,
            peak_force: None,
            settled_force: None,
            final_velocity: 0.0,
            end: Moment { t: 0.0, z: 0.0 },
            most_loaded: None,
            at_desk: false,
            fault: Some(self),
        }
    }
}

/// The figures that decide whether a unit does its job.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decisive {
    /// Speed at the end as a share of the command; none where no verdict follows from it.
    pub speed: Option<f64>,
    /// Magnitude of the greatest force (N), driving or braking, from the ramp's start on.
    pub force: Option<f64>,
}

/// Whether a final speed, as a `share` of the command, is so near to a limit between two verdicts that a better run has to decide.
pub fn is_near_a_limit(share: f64) -> bool {
    let near = |limit: f64| (share / limit - 1.0).abs() < DOUBT;
    !share.is_finite() || near(RUNS) || near(JAMMED)
}
