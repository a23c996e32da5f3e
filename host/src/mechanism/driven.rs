//! A mechanism by one of its drives, as sweeps, tables and reports take it.

use slipfit_core::drive::Drive;

use super::{Action, ENERGY, Mechanism, MechanismRun, RunError, doubts, hash::hash, run};
use crate::{
    dynamics::{
        confirm::figures_agree,
        driven::{DriveKind, Driven, Motion},
        error_control,
        outcome::Verdict,
        setpoint::Setpoint,
        simulate::SimulateError,
        sweep::{Level, classes},
        trust::Trust,
    },
    setup::{LevelRange, RunSpec},
};

/// How much finer the run is that each is held against.
const FINER: f64 = 10.0;

/// The run of the unit of `mechanism` with these `gaps` (m) at a tenth of the tolerance, told of every `every` (s).
///
/// # Errors
/// See [`RunError`].
pub fn finer(mechanism: &Mechanism, gaps: &[f64], every: f64) -> Result<MechanismRun, RunError> {
    let spec = RunSpec { error: mechanism.run.error / FINER, ..mechanism.run };
    run(&Mechanism { run: spec, ..mechanism.clone() }, gaps, every)
}

/// The greatest difference of a column to a [`finer`] run with which a run is taken as it is.
const AGREES: f64 = 0.003;

/// How often a finer run takes the place of one that it does not confirm.
const REFINED: usize = 2;

/// The run of that unit to the scene's tolerance, and the [`finer`] one that it is held against. Where the two differ by more than 0.3 %
/// in a column, the finer one takes its place and is held against one at a tenth of its own tolerance, twice at most: its tolerance
/// says which it is. Verdicts are undecided where the last two still differ in verdict or figures, or where the run has energy that
/// nothing supplied.
///
/// # Errors
/// See [`RunError`].
pub fn confirmed(mechanism: &Mechanism, gaps: &[f64], every: f64) -> Result<[MechanismRun; 2], RunError> {
    let mut asked = mechanism.clone();
    let (mut one, mut better) = (run(&asked, gaps, every)?, finer(&asked, gaps, every)?);
    for _ in 0..REFINED {
        if one.agreement(&better, mechanism).share <= AGREES {
            break;
        }
        asked.run.error /= FINER;
        let finest = match finer(&asked, gaps, every) {
            Ok(finest) => finest,
            Err(interrupted @ RunError::Stopped { stopped: error_control::Stopped::Interrupted }) => {
                return Err(interrupted);
            }
            // A drive that runs away may have no finer run. The difference is then warned of.
            Err(_) => break,
        };
        one = std::mem::replace(&mut better, finest);
    }
    let excess = one.energy_excess;
    for ((outcome, finer), named) in one.outcomes.iter_mut().zip(&better.outcomes).zip(&mechanism.drives) {
        let agrees = figures_agree(outcome, finer, named.scale(finer.end.t));
        if excess.is_nan() || excess > ENERGY || !agrees {
            outcome.verdict = Verdict::Undecided;
        }
    }
    Ok([one, better])
}

/// A mechanism and one of its drives.
#[derive(Clone, Copy, Debug)]
pub struct ByDrive<'a> {
    mechanism: &'a Mechanism,
    drive: usize,
}

impl<'a> ByDrive<'a> {
    /// By the drive of that number; `None` if there is none.
    pub fn new(mechanism: &'a Mechanism, drive: usize) -> Option<Self> {
        (drive < mechanism.drives.len()).then_some(Self { mechanism, drive })
    }

    /// The mechanism.
    pub fn mechanism(&self) -> &'a Mechanism {
        self.mechanism
    }

    /// Which of its drives it is.
    pub fn index(&self) -> usize {
        self.drive
    }

    /// The drive's name.
    pub fn name(&self) -> &'a str {
        &self.mechanism.drives[self.drive].name
    }
}

impl Action {
    /// What a drive gives that acts so.
    pub fn kind(self) -> DriveKind {
        match self {
            Self::Pushes { .. } => DriveKind::Pushes,
            Self::Turns { .. } => DriveKind::Turns,
        }
    }
}

impl Driven for ByDrive<'_> {
    fn title(&self) -> &str {
        &self.mechanism.title
    }

    fn kind(&self) -> DriveKind {
        self.mechanism.drives[self.drive].action.kind()
    }

    fn drive(&self) -> &Drive<f64> {
        &self.mechanism.drives[self.drive].drive
    }

    fn setpoint(&self) -> Setpoint {
        self.mechanism.drives[self.drive].setpoint()
    }

    fn has_segments(&self) -> bool {
        self.mechanism.drives[self.drive].command.is_some()
    }

    fn run(&self) -> RunSpec {
        self.mechanism.run
    }

    fn levels(&self) -> &LevelRange {
        &self.mechanism.sweep
    }

    fn gap_names(&self) -> Vec<String> {
        self.mechanism.gaps.iter().map(|gap| gap.name.clone()).collect()
    }

    fn hash(&self) -> u64 {
        hash(self.mechanism, self.drive)
    }

    fn level(&self, n: f64, motion: Motion) -> Result<Level, SimulateError> {
        let gaps = self.mechanism.gaps_at(&[n]).map_err(|error| SimulateError::Parameter(error.to_string()))?;
        let mut commanded = Mechanism { run: motion.run, ..self.mechanism.clone() };
        commanded.drives[self.drive].set_speed(motion.speed);
        let [mut one, finer] = confirmed(&commanded, &gaps, motion.every)?;
        let mut doubts = doubts(&commanded, &one, &finer, &one.agreement(&finer, &commanded));
        let (outcome, trajectory) = (one.outcomes[self.drive], one.trajectories.swap_remove(self.drive));
        let difference = trajectory.greatest_difference(&finer.trajectories[self.drive], self.drive().ramp_start);
        let trust = Trust::default().compared(difference, None);
        if doubts.is_empty() {
            doubts.extend(trust.warning());
        }
        Ok(Level { n, trajectory, outcome, solved: one.solved(), trust, doubts, classes: classes(&gaps) })
    }
}
