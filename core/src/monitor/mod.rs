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

mod jam;
mod level;
mod tight;

use crate::{
    ParameterError,
    error::bounded,
    table::{AxisKind, Nodes, Table, TableError},
};

pub use jam::JamWatch;
pub use level::{BankError, Estimate, LevelBank};
use tight::Band;
pub use tight::{TightWatch, Tightness};

/// What the drive measures once a period. Of what it cannot measure, a force is given as 0 and a speed as the command, which say
/// nothing. What it fails to measure is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sample {
    /// Time since the motion's start, the table's time (s).
    pub time: f32,
    /// The drive's force (N).
    pub force: f32,
    /// The slide's speed along the drive (m/s).
    pub speed: f32,
    /// The commanded speed (m/s).
    pub command: f32,
}

/// The greatest force (N), either sign, that counts as measured.
const FORCE_MOST: f32 = 1e9;

impl Sample {
    /// The force (N); none if it is not finite or exceeds 10⁹ N, which nothing measures.
    pub(crate) fn measured_force(&self) -> Option<f32> {
        (self.force.abs() <= FORCE_MOST).then_some(self.force)
    }

    /// Whether all of it was measured: every number is finite, and the force at most 10⁹ N.
    pub fn is_valid(&self) -> bool {
        let rest = self.time.is_finite() && self.speed.is_finite() && self.command.is_finite();
        rest && self.measured_force().is_some()
    }

    /// What is `x` along the axis, in the direction of the command.
    pub(crate) fn along(&self, x: f32) -> f32 {
        if self.command < 0.0 { -x } else { x }
    }
}

/// Where free ends, and when a jam is one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limits {
    /// Time from one sample to the next (s).
    pub period: f32,
    /// Until this time (s) of the motion only the force limit counts: it covers breakaway, before which a slide creeps
    /// at any speed.
    pub blind: f32,
    /// A force (N) beyond which it is a jam, either sign.
    pub force_most: f32,
    /// How long (s) a jam's sign has to last before it is reported; noise on a single sample is none. And how long no sample
    /// has to be of use before there is [`Verdict::NoData`].
    pub hold: f32,
    /// Time constant (s) over which force is averaged before it is compared with the table's.
    pub smoothing: f32,
    /// By how many levels a unit may be tighter than it is taken for, and off the level that the monitor was made for. By fewer
    /// where the table ends, or where its units end differently from this one.
    pub band: f32,
    /// What the averaged force (N) may differ from the table's beyond that band, for noise.
    pub margin: f32,
    /// How fast (N/s) the averaged force may rise away from the table's.
    pub rise: f32,
}

impl Limits {
    /// Limits for samples a `period` (s) apart with white noise of standard deviation `noise` (N) on the force: averages
    /// over 20 periods, five standard deviations of what the average leaves of the noise, jams held for ten periods,
    /// no blind time and no force limit.
    pub fn for_noise(period: f32, noise: f32) -> Self {
        let smoothing = 20.0 * period;
        // An average over τ leaves √(T/2τ) of white noise.
        let margin = 5.0 * noise * 0.158;
        Self {
            period,
            blind: 0.0,
            force_most: FORCE_MOST,
            hold: 10.0 * period,
            smoothing,
            band: 0.5,
            margin,
            rise: margin / smoothing,
        }
    }

    /// These limits, if a monitor or a jam watch takes them.
    ///
    /// # Errors
    /// [`ParameterError`] names the first that is out of bounds or not finite.
    #[inline]
    pub fn checked(self) -> Result<Self, ParameterError<f32>> {
        bounded("monitor.period", self.period, [1e-6, 1.0])?;
        bounded("monitor.blind", self.blind, [0.0, 1e6])?;
        bounded("monitor.force_most", self.force_most, [1e-6, f64::from(FORCE_MOST)])?;
        bounded("monitor.hold", self.hold, [0.0, 10.0])?;
        bounded("monitor.smoothing", self.smoothing, [0.0, 10.0])?;
        bounded("monitor.band", self.band, [0.0, 100.0])?;
        bounded("monitor.margin", self.margin, [0.0, 1e9])?;
        bounded("monitor.rise", self.rise, [0.0, 1e12])?;
        Ok(self)
    }

    /// Whether it is too early at `sample`, or not known how late, for anything but the force limit.
    fn is_blind(&self, sample: &Sample) -> bool {
        !sample.time.is_finite() || sample.time < self.blind
    }
}

/// What a sample says about the drive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Verdict {
    /// Too early to say.
    #[default]
    Blind,
    /// As the table has it.
    Free,
    /// More force in the direction of the command than the table's for this unit's level, or rising away from it.
    Tight,
    /// Standing still against the command, or at the limit of force.
    Jam,
    /// For [`Limits::hold`] no sample was of use: a number was missing, as of a dead sensor, or the table has no force then.
    NoData,
}

/// Why there is no monitor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MonitorError {
    /// The table is not one over tolerance level and time.
    Table(TableError),
    /// The level or a limit is out of bounds.
    Parameter(ParameterError<f32>),
    /// The table has no unit of that level, see [`Lookup::mixed`](crate::table::Lookup::mixed).
    Mixed {
        /// The level.
        level: f32,
        /// Levels of the table on either side, of units of which one runs and the other jams, say.
        between: [f32; 2],
    },
}

impl core::fmt::Display for MonitorError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Table(error) => write!(f, "no table over tolerance level and time: {error}"),
            Self::Parameter(error) => error.fmt(f),
            Self::Mixed { level, between: [low, high] } => {
                write!(
                    f,
                    "monitor.level is {level}, the table has no unit between its levels {low} and {high}, which end differently"
                )
            }
        }
    }
}

impl core::error::Error for MonitorError {}

impl From<ParameterError<f32>> for MonitorError {
    fn from(error: ParameterError<f32>) -> Self {
        Self::Parameter(error)
    }
}

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
