//! Tight, by the table's band for this unit's level.

use super::{Limits, Sample};
use crate::table::{Nodes, Table};

/// Averages of the force beyond the table's (N).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TightWatch {
    excess: f32,
    /// The average of the average, so that the two tell how it rises.
    slower: f32,
}

/// Force against the table's band.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tightness {
    /// The force (N) that the table has for this unit now.
    pub expected: f32,
    /// By how much (N) the averaged force may exceed it.
    pub band: f32,
    /// By how much (N) it does.
    pub excess: f32,
    /// How fast (N/s) that rises.
    pub rise: f32,
    /// Whether it rises too fast.
    is_fast: bool,
}

impl Tightness {
    /// Whether the averaged force is above the band or leaving it.
    pub fn is_tight(&self) -> bool {
        self.excess > self.band || self.is_fast
    }
}

impl TightWatch {
    /// Compares `sample` with what `table` has for `level`. Passes over a force that is not finite.
    #[inline]
    pub(super) fn step<V: Nodes>(
        &mut self,
        table: &Table<'_, 2, V>,
        level: f32,
        limits: &Limits,
        sample: &Sample,
    ) -> Tightness {
        let expected = table.lookup([level, sample.time]).force;
        let tighter = table.lookup([level + limits.band, sample.time]).force;
        let apart = (tighter - expected).abs();
        let band = apart + limits.margin;
        let beyond = sample.force - expected;
        let beyond = if beyond.is_finite() { beyond } else { self.excess };
        let per_step = 1.0 / (limits.smoothing + limits.period);
        let weight = limits.period * per_step;
        self.excess += weight * (beyond - self.excess);
        self.slower += weight * (self.excess - self.slower);
        let rise = (self.excess - self.slower) * per_step;
        // What the band itself allows within its time is no alarm.
        let is_fast = rise > limits.rise + apart * per_step;
        Tightness { expected, band, excess: self.excess, rise, is_fast }
    }
}
