//! What the drive measures, and what that says about it.

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
pub(crate) const FORCE_MOST: f32 = 1e9;

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
    /// For [`Limits::hold`](super::Limits::hold) no sample was of use: a number was missing, as of a dead sensor, or the table has
    /// no force then.
    NoData,
    /// The motion has come to the end of the table of a production, beyond which nothing is watched.
    Ended,
}

#[cfg(test)]
mod tests {
    use super::Sample;

    const GOOD: Sample = Sample { time: 0.3, force: 1.0, speed: 0.1, command: 0.1 };

    #[test]
    fn a_sample_is_valid_if_all_of_it_is() {
        assert!(GOOD.is_valid() && GOOD.measured_force() == Some(1.0));
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for sample in [
                Sample { time: bad, ..GOOD },
                Sample { force: bad, ..GOOD },
                Sample { speed: bad, ..GOOD },
                Sample { command: bad, ..GOOD },
            ] {
                assert!(!sample.is_valid(), "{sample:?}");
            }
        }
        for (force, measured) in [(1e9, true), (-1e9, true), (1.001e9, false), (-1.001e9, false)] {
            let sample = Sample { force, ..GOOD };
            assert_eq!((sample.is_valid(), sample.measured_force()), (measured, measured.then_some(force)));
        }
    }

    #[test]
    fn along_is_in_the_direction_of_the_command() {
        for (command, found) in [(0.1, 2.0), (0.0, 2.0), (-0.0, 2.0), (-0.1, -2.0), (f32::NAN, 2.0)] {
            assert_eq!(Sample { command, ..GOOD }.along(2.0), found, "{command}");
        }
    }
}
