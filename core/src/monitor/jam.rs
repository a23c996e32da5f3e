//! A jam, by force and speed alone: a table at a jamming level holds the jam and would call it expected.

use super::{Limits, Sample, Verdict};

/// The part of the command below which a slide stands.
pub const STANDING: f32 = 0.1;

/// What decides about a jam; it needs no table. A motion starts with a fresh one.
///
/// ```
/// # use slipfit_core::{ParameterError, monitor::{JamWatch, Limits, Sample, Verdict}};
/// # fn interrupt() -> Result<(), ParameterError<f32>> {
/// let limits = Limits { blind: 0.2, force_most: 3.5, ..Limits::for_noise(1e-3, 0.0) }.checked()?; // parameters
/// let mut watch = JamWatch::default(); // state
/// let verdict = watch.step(&limits, &Sample { time: 0.3, force: 0.25, speed: 0.01, command: 0.02 });
/// assert_eq!(verdict, Verdict::Free);
/// # Ok(()) }
/// # interrupt().unwrap();
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JamWatch {
    /// The slide has moved with the command.
    has_moved: bool,
    /// How long it has stood since (s).
    standing: f32,
    /// How long the force has been beyond its limit (s).
    pushing: f32,
    /// For how long samples have not been whole (s).
    missing: f32,
}

impl JamWatch {
    /// What `sample` says, after those before it; never [`Verdict::Tight`].
    ///
    /// It is a jam where the speed is below a tenth of the command for [`Limits::hold`] after it was above, past
    /// [`Limits::blind`], or the force beyond [`Limits::force_most`] for as long. Without a command a slide may stand. A number
    /// that is not valid neither counts nor starts anew. Where for as long no sample has been [`Sample::is_valid`],
    /// nothing watches the drive: [`Verdict::NoData`], unless it was jammed before. Of the limits, which should be
    /// [`Limits::checked`], only these and the period count.
    #[inline]
    #[must_use]
    pub fn step(&mut self, limits: &Limits, sample: &Sample) -> Verdict {
        let least = STANDING * sample.command.abs();
        // Speed the wrong way is no motion with the command.
        let along = sample.along(sample.speed);
        if along.is_finite() && least.is_finite() {
            self.has_moved |= !limits.is_blind(sample) && least > 0.0 && along > least;
            let stands = self.has_moved && least > 0.0 && along < least;
            self.standing = if stands { self.standing + limits.period } else { 0.0 };
        }
        if let Some(force) = sample.measured_force() {
            self.pushing = if force.abs() > limits.force_most { self.pushing + limits.period } else { 0.0 };
        }
        self.missing = if sample.is_valid() { 0.0 } else { self.missing + limits.period };
        let is_jammed = self.standing > limits.hold || self.pushing > limits.hold;
        match (is_jammed, self.missing > limits.hold, limits.is_blind(sample)) {
            (true, ..) => Verdict::Jam,
            (_, true, _) => Verdict::NoData,
            (.., true) => Verdict::Blind,
            _ => Verdict::Free,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::{JamWatch, Limits, Sample, Verdict};

    fn limits() -> Limits {
        Limits { blind: 1.0, hold: 0.0095, force_most: 3.0, ..Limits::for_noise(1e-3, 0.0) }
    }

    fn at(force: f32, speed: f32) -> Sample {
        Sample { time: 1.0, force, speed, command: 0.1 }
    }

    /// A watch that has seen the slide move.
    fn moving() -> JamWatch {
        let mut watch = JamWatch::default();
        assert_eq!(watch.step(&limits(), &at(1.0, 0.05)), Verdict::Free);
        watch
    }

    /// After how many of `samples` a jam is first reported.
    fn reported(mut watch: JamWatch, mut samples: impl Iterator<Item = Sample>) -> Option<usize> {
        samples.position(|sample| watch.step(&limits(), &sample) == Verdict::Jam)
    }

    #[test]
    fn holds_before_it_reports() {
        // Never moved: no jam, however long.
        assert_eq!(reported(JamWatch::default(), [at(1.0, 0.0); 100].into_iter()), None);
        // Moved while blind does not count either.
        let mut watch = JamWatch::default();
        for time in [0.9, f32::NAN, f32::INFINITY] {
            assert_eq!(watch.step(&limits(), &Sample { time, ..at(1.0, 0.05) }), Verdict::Blind);
        }
        assert_eq!(reported(watch, [at(1.0, 0.0); 100].into_iter()), None);
        assert_eq!(reported(moving(), [at(1.0, 0.0); 12].into_iter()), Some(9));
        // Over as soon as it moves.
        let mut watch = moving();
        assert_eq!((0..12).map(|_| watch.step(&limits(), &at(1.0, 0.0))).last(), Some(Verdict::Jam));
        assert_eq!(watch.step(&limits(), &at(1.0, 0.05)), Verdict::Free);
        assert_eq!(reported(watch, [at(-3.1, 0.05); 12].into_iter()), Some(9));
    }

    #[test]
    fn without_a_command_a_slide_may_stand() {
        for (command, speed) in [(0.0, -1e-6), (0.0, 0.0), (0.0, 1e-6), (-0.0, -1e-6), (-0.0, 1e-6)] {
            let rest = Sample { command, ..at(0.0, speed) };
            assert_eq!(reported(moving(), [rest; 1000].into_iter()), None, "{command} {speed}");
        }
    }

    #[test]
    fn what_is_not_measured_hides_no_jam_and_makes_none() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN] {
            // Every tenth number of a jam is missing: reported one sample later, and then at every sample.
            let gaps = |i: usize, good: f32| if i % 10 == 5 { bad } else { good };
            let (force, speed) = ((0..100).map(|i| at(gaps(i, 3.1), 0.05)), (0..100).map(|i| at(0.0, gaps(i, 0.0))));
            assert_eq!(reported(moving(), force.clone()), Some(10), "force {bad}");
            let mut watch = moving();
            assert_eq!(force.filter(|sample| watch.step(&limits(), sample) == Verdict::Jam).count(), 90, "force {bad}");
            // A speed is taken as it is, however great, if it is finite.
            if !bad.is_finite() {
                assert_eq!(reported(moving(), speed), Some(10), "speed {bad}");
            }
            // Nothing but gaps is no jam.
            assert_eq!(reported(moving(), [at(bad, 0.05); 100].into_iter()), None, "force {bad}");
            let gap = Sample { command: bad, ..at(0.0, f32::NAN) };
            assert_eq!(reported(moving(), [gap; 100].into_iter()), None, "command {bad}");
        }
    }

    #[test]
    fn dead_sensors_are_no_data_unless_there_was_a_jam() {
        let (good, jammed) = (at(1.0, 0.05), at(3.1, 0.0));
        for dead in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let without: [fn(f32, Sample) -> Sample; 5] = [
                |dead, sample| Sample { time: dead, ..sample },
                |dead, sample| Sample { force: dead, ..sample },
                |dead, sample| Sample { speed: dead, ..sample },
                |dead, sample| Sample { command: dead, ..sample },
                |dead, _| Sample { time: dead, force: dead, speed: dead, command: dead },
            ];
            for without in without {
                let sample = without(dead, good);
                for mut watch in [JamWatch::default(), moving()] {
                    let verdicts: Vec<_> = (0..1099).map(|_| watch.step(&limits(), &sample)).collect();
                    assert!(verdicts[..9].iter().all(|verdict| *verdict != Verdict::NoData), "{sample:?}");
                    assert!(verdicts[9..].iter().all(|verdict| *verdict == Verdict::NoData), "{sample:?}");
                    // Over with the first whole sample, and a sample in ten is enough.
                    assert_eq!(watch.step(&limits(), &good), Verdict::Free);
                    let one_in_nine = (0..99).map(|i| if i % 9 == 8 { good } else { sample });
                    assert!(
                        one_in_nine.map(|sample| watch.step(&limits(), &sample)).all(|found| found != Verdict::NoData)
                    );
                }
                // Too early to say, dead all the same.
                let early = Sample { time: if sample.time.is_finite() { 0.1 } else { dead }, ..sample };
                let mut watch = JamWatch::default();
                assert_eq!((0..100).map(|_| watch.step(&limits(), &early)).last(), Some(Verdict::NoData));
                // A jam stays one.
                let mut watch = moving();
                assert_eq!((0..12).map(|_| watch.step(&limits(), &jammed)).last(), Some(Verdict::Jam));
                let sample = without(dead, jammed);
                assert_eq!((0..100).map(|_| watch.step(&limits(), &sample)).last(), Some(Verdict::Jam), "{sample:?}");
            }
        }
    }

    /// At the tenth of the command it neither moves nor stands; at the limit of force it does not push too hard.
    #[test]
    fn limits_themselves_are_no_sign_of_a_jam() {
        let tenth = super::STANDING * 0.1;
        let mut watch = JamWatch::default();
        assert_eq!(watch.step(&limits(), &at(1.0, tenth)), Verdict::Free);
        assert_eq!(reported(watch, [at(1.0, 0.0); 100].into_iter()), None, "it never moved");
        // Nor does it move with a command where there is none.
        let mut watch = JamWatch::default();
        assert_eq!(watch.step(&limits(), &Sample { command: 0.0, ..at(1.0, 0.05) }), Verdict::Free);
        assert_eq!(reported(watch, [at(1.0, 0.0); 100].into_iter()), None, "it moved without a command");
        assert_eq!(reported(moving(), [at(1.0, tenth); 100].into_iter()), None);
        assert_eq!(reported(moving(), [at(1.0, tenth.next_down()); 100].into_iter()), Some(9));
        assert_eq!(reported(moving(), [at(3.0, 0.05); 100].into_iter()), None);
        assert_eq!(reported(moving(), [at(3.0f32.next_up(), 0.05); 100].into_iter()), Some(9));
        // Held for exactly as long as is asked for, which a power of two has without rounding.
        let exact = Limits { hold: 0.0625, period: 0.0078125, ..limits() };
        let mut watch = JamWatch::default();
        let verdicts: Vec<_> = (0..10).map(|_| watch.step(&exact, &at(3.5, 0.05))).collect();
        assert_eq!(verdicts.iter().position(|verdict| *verdict == Verdict::Jam), Some(8));
        let mut watch = JamWatch::default();
        let lost = Sample { speed: f32::NAN, ..at(1.0, 0.05) };
        let verdicts: Vec<_> = (0..10).map(|_| watch.step(&exact, &lost)).collect();
        assert_eq!(verdicts.iter().position(|verdict| *verdict == Verdict::NoData), Some(8));
    }

    /// Backwards as forwards, and the wrong way is no motion.
    #[test]
    fn speed_counts_along_the_command() {
        let backwards = |force, speed| Sample { command: -0.1, ..at(force, speed) };
        let mut watch = JamWatch::default();
        assert_eq!(watch.step(&limits(), &backwards(-1.0, -0.05)), Verdict::Free);
        assert_eq!(reported(watch, [backwards(-1.0, -0.05); 100].into_iter()), None);
        assert_eq!(reported(watch, [backwards(-1.0, 0.0); 12].into_iter()), Some(9));
        assert_eq!(reported(watch, [backwards(-1.0, 0.05); 12].into_iter()), Some(9));
        assert_eq!(reported(moving(), [at(1.0, -0.05); 12].into_iter()), Some(9));
    }
}
