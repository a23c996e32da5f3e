//! The limits that the samples of a drive are compared with.

use super::sample::{FORCE_MOST, Sample};
use crate::{ParameterError, error::bounded};

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
    /// has to be of use before there is [`Verdict::NoData`](super::Verdict::NoData).
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
    pub(super) fn is_blind(&self, sample: &Sample) -> bool {
        !sample.time.is_finite() || sample.time < self.blind
    }
}
