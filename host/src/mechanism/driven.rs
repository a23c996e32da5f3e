//! A mechanism by one of its drives, as sweeps, tables and reports take it.

use slipfit_core::drive::Drive;

use super::{Action, Mechanism, hash::hash, run};
use crate::{
    driven::{DriveKind, Driven, Motion},
    outcome::Verdict,
    scene::{LevelRange, RunSpec},
    simulate::SimulateError,
    sweep::{Level, classes},
    trust::Trust,
};

/// How much finer the run is that each is held against.
const FINER: f64 = 0.1;

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
        commanded.drives[self.drive].drive.speed = motion.speed;
        let mut one = run(&commanded, &gaps, motion.every)?;
        commanded.run.error *= FINER;
        let finer = run(&commanded, &gaps, motion.every)?;
        let (mut outcome, trajectory) = (one.outcomes[self.drive], one.trajectories.swap_remove(self.drive));
        if finer.outcomes[self.drive].verdict != outcome.verdict {
            outcome.verdict = Verdict::Undecided;
        }
        let difference = trajectory.greatest_difference(&finer.trajectories[self.drive], self.drive().ramp_start);
        let trust = Trust::default().compared(difference, None);
        Ok(Level { n, trajectory, outcome, solved: one.solved(), trust, classes: classes(&gaps) })
    }
}
