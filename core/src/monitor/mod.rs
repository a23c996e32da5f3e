//! Watches a running drive by its flash table: free, tight, jammed or without data, and which tolerance level the unit has.
//!
//! [`Monitor`] holds what does not change, [`Watch`] what does; [`JamWatch`] watches for jams without a table;
//! [`LevelBank`] estimates n from a stroke. Work and memory of a sample are bounded, and no run is stored.
//!
//! ```
//! # use slipfit_core::{monitor::{Limits, Monitor, Sample, Watch, Verdict}, table::{Nodes, Table}};
//! # fn interrupt<V: Nodes>(table: Table<'_, 2, V>) -> Result<(), slipfit_core::monitor::MonitorError> {
//! let limits = Limits { blind: 0.2, ..Limits::for_noise(1e-3, 0.02) };
//! let monitor = Monitor::new(table, 2.5, limits)?; // parameters
//! let mut watch = Watch::default(); // state
//! let sample = Sample { time: 0.3, force: 0.25, speed: 0.01, command: 0.02 };
//! let report = monitor.step(&mut watch, &sample);
//! assert!(report.verdict != Verdict::Jam);
//! # Ok(()) }
//! ```

mod error;
mod jam;
mod level;
mod limits;
mod sample;
mod tight;

use crate::{
    error::bounded,
    table::{AxisKind, Nodes, Table},
};

pub use error::MonitorError;
pub use jam::{JamWatch, STANDING};
pub use level::{BankError, Estimate, LevelBank};
pub use limits::Limits;
pub(crate) use sample::FORCE_MOST;
pub use sample::{Sample, Verdict};
use tight::Band;
pub use tight::{TightWatch, Tightness};

/// A monitor's answer to a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[must_use = "the verdict has to be acted on"]
pub struct Report {
    /// The verdict.
    pub verdict: Verdict,
    /// Force against the table's band.
    pub tightness: Tightness,
}

/// Everything about a monitored drive that does not change during a motion.
#[derive(Clone, Copy, Debug)]
pub struct Monitor<'a, V> {
    table: Table<'a, 2, V>,
    /// The level the unit was taken for at first: its band is about that.
    reference: f32,
    level: f32,
    band: Band,
    limits: Limits,
}

/// Everything that changes. A motion starts with a fresh one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Watch {
    /// Towards tight.
    pub tight: TightWatch,
    /// Towards a jam.
    pub jam: JamWatch,
}

impl<'a, V: Nodes> Monitor<'a, V> {
    /// A monitor of a unit of tolerance level `level` by `table`, over level and time.
    ///
    /// # Errors
    /// [`MonitorError`] if the table is over anything else, or names the first parameter that is out of bounds or not
    /// finite; the level has to lie on the table's axis.
    pub fn new(table: Table<'a, 2, V>, level: f32, limits: Limits) -> Result<Self, MonitorError> {
        let table = table.expect_axes([AxisKind::Level, AxisKind::Time]).map_err(MonitorError::Table)?;
        let [levels, _] = table.axes();
        bounded("monitor.level", level, [f64::from(levels.first()), f64::from(levels.last())])?;
        let limits = limits.checked()?;
        let band = Band::of(&table, level, limits.band)?;
        Ok(Self { table, reference: level, level, band, limits })
    }

    /// The level the unit is taken for.
    pub fn level(&self) -> f32 {
        self.level
    }

    /// Takes the unit for what `estimate` says from now on, if the table has such a unit, within the band of the level
    /// that the monitor was made for, and its deviation is 0 to that band; says whether it was. The band does not move along: a unit that leaves it, at once or
    /// motion by motion, is tight, not to be got used to.
    #[must_use = "the level may not have been taken"]
    pub fn adapt(&mut self, estimate: &Estimate) -> bool {
        let [levels, _] = self.table.axes();
        let within = (estimate.level - self.reference).abs() <= self.limits.band
            && (0.0..=self.limits.band).contains(&estimate.deviation)
            && estimate.level >= levels.first()
            && estimate.level <= levels.last();
        let band = Band::of(&self.table, estimate.level, self.limits.band).ok().filter(|_| within);
        if let Some(band) = band {
            (self.level, self.band) = (estimate.level, band);
        }
        band.is_some()
    }

    /// What `sample` says, after those that `watch` has seen. A number that is not finite, a force beyond 10⁹ N, and a time at
    /// which the table has no force are passed over: what depends on them stays as it was.
    #[inline]
    pub fn step(&self, watch: &mut Watch, sample: &Sample) -> Report {
        let tightness = watch.tight.step(&self.table, &self.band, &self.limits, sample);
        let verdict = match watch.jam.step(&self.limits, sample) {
            Verdict::Free if watch.tight.is_without(&self.limits) => Verdict::NoData,
            Verdict::Free if tightness.is_tight() => Verdict::Tight,
            verdict => verdict,
        };
        Report { verdict, tightness }
    }
}

#[cfg(test)]
mod tests;
