//! A jam, by force and speed alone: a table at a jamming level holds the jam and would call it expected.

use super::{Limits, Sample};

/// The part of the command below which a slide stands.
const STANDING: f32 = 0.1;

/// What decides about a jam.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JamWatch {
    /// The slide has moved with the command.
    has_moved: bool,
    /// How long it has stood since (s).
    standing: f32,
    /// How long the force has been beyond its limit (s).
    pushing: f32,
}

impl JamWatch {
    /// Whether there is a jam at `sample`: speed below a tenth of the command for [`Limits::hold`] after it was above, or
    /// force beyond its limit for as long.
    #[inline]
    pub(super) fn step(&mut self, limits: &Limits, sample: &Sample, is_blind: bool) -> bool {
        let least = STANDING * sample.command.abs();
        // Speed the wrong way is no motion with the command.
        let along = if sample.command < 0.0 { -sample.speed } else { sample.speed };
        self.has_moved |= !is_blind && least > 0.0 && along > least;
        let stands = self.has_moved && along < least;
        let pushes = sample.force.abs() > limits.force_most;
        self.standing = if stands { self.standing + limits.period } else { 0.0 };
        self.pushing = if pushes { self.pushing + limits.period } else { 0.0 };
        (stands && self.standing > limits.hold) || (pushes && self.pushing > limits.hold)
    }
}

#[cfg(test)]
mod tests {
    use super::{JamWatch, Limits, Sample};

    #[test]
    fn holds_before_it_reports() {
        let limits = Limits { hold: 0.0095, force_most: 3.0, ..Limits::for_noise(1e-3, 0.0) };
        let at = |force, speed| Sample { time: 1.0, force, speed, command: 0.1 };
        let mut watch = JamWatch::default();
        // Never moved: no jam, however long.
        assert!((0..100).all(|_| !watch.step(&limits, &at(1.0, 0.0), false)));
        // Moved while blind does not count either.
        assert!(!watch.step(&limits, &at(1.0, 0.05), true) && !watch.step(&limits, &at(1.0, 0.0), false));
        assert!(!watch.step(&limits, &at(1.0, 0.05), false));
        let reports: [bool; 12] = core::array::from_fn(|_| watch.step(&limits, &at(1.0, 0.0), false));
        assert_eq!(reports.iter().position(|report| *report), Some(9));
        // Over as soon as it moves.
        assert!(!watch.step(&limits, &at(1.0, 0.05), false));
        let reports: [bool; 12] = core::array::from_fn(|_| watch.step(&limits, &at(-3.1, 0.05), false));
        assert_eq!(reports.iter().position(|report| *report), Some(9));
        assert!((0..100).all(|_| !watch.step(&limits, &at(f32::NAN, f32::NAN), false)));
    }
}
