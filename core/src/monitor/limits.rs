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

#[cfg(test)]
mod tests {
    use super::Limits;
    use crate::monitor::Sample;

    #[test]
    fn limits_for_noise_are_five_deviations_of_its_average() {
        let Limits { period, blind, force_most, hold, smoothing, band, margin, rise } = Limits::for_noise(2e-3, 0.02);
        assert_eq!((period, blind, force_most, band), (2e-3, 0.0, 1e9, 0.5));
        let near = |found: f32, expected: f64| (f64::from(found) - expected).abs() < 2e-3 * expected;
        assert!(near(hold, 0.02) && near(smoothing, 0.04), "{hold} {smoothing}");
        // √(T/2τ) of white noise is left.
        let left = 0.02 * libm::sqrt(2e-3 / (2.0 * 0.04));
        assert!(near(margin, 5.0 * left) && near(rise, 5.0 * left / 0.04), "{margin} {rise}");
    }

    #[test]
    fn each_limit_has_its_bounds() {
        let good = Limits::for_noise(1e-3, 0.02);
        type Change = fn(&mut Limits) -> &mut f32;
        let all: [(&str, Change, [f32; 2], [f32; 2]); 8] = [
            ("monitor.period", |limits| &mut limits.period, [1e-6, 1.0], [0.9e-6, 1.1]),
            ("monitor.blind", |limits| &mut limits.blind, [0.0, 1e6], [-1e-9, 1.1e6]),
            ("monitor.force_most", |limits| &mut limits.force_most, [1e-6, 1e9], [0.9e-6, 1.1e9]),
            ("monitor.hold", |limits| &mut limits.hold, [0.0, 10.0], [-1e-9, 10.1]),
            ("monitor.smoothing", |limits| &mut limits.smoothing, [0.0, 10.0], [-1e-9, 10.1]),
            ("monitor.band", |limits| &mut limits.band, [0.0, 100.0], [-1e-9, 100.1]),
            ("monitor.margin", |limits| &mut limits.margin, [0.0, 1e9], [-1e-9, 1.1e9]),
            ("monitor.rise", |limits| &mut limits.rise, [0.0, 1e12], [-1e-9, 1.1e12]),
        ];
        for (name, field, inside, outside) in all {
            let with = |value: f32| {
                let mut limits = good;
                *field(&mut limits) = value;
                limits.checked()
            };
            // The ends as f32 has them.
            assert!(with(inside[1]).is_ok() && with(inside[0] * 1.000_001).is_ok(), "{name}");
            for value in outside.into_iter().chain([f32::NAN, f32::INFINITY]) {
                assert_eq!(with(value).unwrap_err().parameter, name, "{value}");
            }
        }
    }

    #[test]
    fn is_blind_before_its_time_and_where_the_time_is_not_known() {
        let limits = Limits { blind: 0.2, ..Limits::for_noise(1e-3, 0.0) };
        let at = |time| limits.is_blind(&Sample { time, force: 0.0, speed: 0.0, command: 0.0 });
        assert_eq!([0.0, 0.199_99, 0.2, 0.3, f32::NAN, f32::INFINITY].map(at), [true, true, false, false, true, true]);
    }
}
