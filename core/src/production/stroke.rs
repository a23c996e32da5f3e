//! One stroke: what is measured, what is kept of it, and what there is to say of a sample.

use super::MODES_MOST;
use crate::monitor::{FORCE_MOST, Verdict};

/// What the drive measures once a period. What it fails to measure is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sample {
    /// Time since the motion's start (s), or position (m), as the table has it.
    pub at: f32,
    /// The drive's force (N).
    pub force: f32,
    /// The speed along the drive (m/s).
    pub speed: f32,
    /// The commanded speed (m/s).
    pub command: f32,
}

impl Sample {
    /// Whether all of it was measured.
    pub(super) fn is_valid(&self) -> bool {
        let rest = self.at.is_finite() & self.speed.is_finite() & self.command.is_finite();
        rest & (self.force.abs() <= FORCE_MOST)
    }

    /// What is `x` in the direction of the command.
    pub(super) fn along(&self, x: f32) -> f32 {
        if self.command < 0.0 { -x } else { x }
    }
}

/// What a sample says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[must_use = "the verdict has to be acted on"]
pub struct Report {
    /// The verdict.
    pub verdict: Verdict,
    /// The force (N) that is expected of this unit now, with what this stroke has told of its friction so far.
    pub expected: f32,
    /// The force (N) that was expected before the stroke: before the unit is taught that of the mean.
    pub own: f32,
    /// The speed (m/s) that was expected before the stroke.
    pub speed: f32,
    /// By how much (N) the smoothed force exceeds the expected one, in the direction of the command.
    pub excess: f32,
    /// By how much (N) it may.
    pub limit: f32,
    /// A value of the table lay outside the range that it had when it was opened: the flash has changed. No verdict is Tight then.
    pub damaged: bool,
}

/// What is kept of a stroke. [`Watch::start`](super::Watch::start) makes one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// The place up to which the stroke has been seen.
    pub(super) at: f32,
    /// Smoothed difference from what is expected (N).
    pub(super) smoothed: f32,
    /// Force above the mean times each mode, summed over the places.
    pub(super) sums: [f32; MODES_MOST],
    /// The same times the weight, events cut off.
    pub(super) weighted: f32,
    /// Force above the unit's own times the weight, events cut off.
    pub(super) above: f32,
    /// The squared weight likewise.
    pub(super) squared: f32,
    /// For how many samples the drive has stood.
    pub(super) standing: u32,
    /// For how many samples something was missing.
    pub(super) missing: u32,
    /// No piece of it is missing so far.
    pub(super) is_whole: bool,
    /// The worst so far.
    pub(super) worst: Verdict,
}

impl Stroke {
    pub(super) fn from(first: f32) -> Self {
        Self {
            at: first,
            smoothed: 0.0,
            sums: [0.0; MODES_MOST],
            weighted: 0.0,
            above: 0.0,
            squared: 0.0,
            standing: 0,
            missing: 0,
            is_whole: true,
            worst: Verdict::Blind,
        }
    }

    /// The worst verdict of its samples: a jam, or tight, or neither.
    pub fn worst(&self) -> Verdict {
        self.worst
    }
}
