//! A run as it can be drawn: where the slide is and which gaps are closed, at a number of moments.

use slipfit_core::{pose::Pose, slide::CONTACTS};

use super::{
    desk,
    outcome::Outcome,
    simulate::{Settings, SimulateError},
};
use crate::setup::Scene;

/// Moments of a run that is played.
pub const MOMENTS: usize = 160;

/// A moment of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// When (s).
    pub t: f64,
    /// Velocity along z (m/s).
    pub vz: f64,
    /// Displacement (m) of the centre of mass from its nominal place, along the frame's x, y, z.
    pub displacement: [f64; 3],
    /// How the slide is turned from its nominal pose: the axis in the frame, as long as the angle (rad).
    pub turn: [f64; 3],
    /// Gaps (m) in the order of Table 2, negative where pressed in.
    pub gaps: [f64; CONTACTS],
}

/// A run in moments.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// The moments, t ascending, from rest to the end.
    pub frames: Vec<Frame>,
    /// What the slide did.
    pub outcome: Outcome,
}

/// The slide of `scene` with these `gaps` (m) at about `count` moments, half of them evenly spread over the steps of the
/// desk, which are short where much happens, and half over the time; and what it did.
///
/// # Errors
/// See [`SimulateError`].
pub fn film(scene: &Scene, gaps: &[f64], count: usize) -> Result<Film, SimulateError> {
    let mut frames = Vec::new();
    let mut see = |t: f64, vz: f64, pose: &Pose<f64>, gaps: &[f64; CONTACTS]| frames.push(frame(t, vz, pose, gaps));
    let settings = Settings::desk(scene, 1e-3);
    let run = desk::seen(scene, gaps, &settings, desk::tolerance(scene), Some(&mut see))?;
    let times: Vec<f64> = frames.iter().map(|frame| frame.t).collect();
    let frames = chosen(&times, count).into_iter().map(|number| frames[number]).collect();
    Ok(Film { frames, outcome: run.outcome })
}

fn frame(t: f64, vz: f64, pose: &Pose<f64>, gaps: &[f64; CONTACTS]) -> Frame {
    let (w, v) = (pose.orientation.w, pose.orientation.v);
    let sine = v.norm();
    // As long as the angle; for the least of them twice the sine of its half.
    let factor = if sine > 1e-12 { 2.0 * libm::atan2(sine, w) / sine } else { 2.0 };
    Frame { t, vz, displacement: pose.displacement_w.into(), turn: (v * factor).into(), gaps: *gaps }
}

/// Which of ascending `times` are shown where about `count` are: half of them evenly spread over all, half over the time.
pub fn chosen(times: &[f64], count: usize) -> Vec<usize> {
    let Some(last) = times.last() else { return Vec::new() };
    let half = (count / 2).max(1);
    let by_step = (0..=half).map(|k| k * (times.len() - 1) / half);
    let by_time = (0..=half).map(|k| {
        let t = last * k as f64 / half as f64;
        times.partition_point(|time| *time < t).min(times.len() - 1)
    });
    let mut numbers: Vec<usize> = by_step.chain(by_time).collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

#[cfg(test)]
mod tests {
    use super::{Film, film};
    use crate::dynamics::{
        example,
        simulate::{Settings, simulate},
    };

    #[test]
    fn frames_go_from_rest_to_the_end_and_show_what_is_pressed() {
        let scene = example::cd_rom();
        let gaps = scene.gaps_at(&[2.5; 16]);
        let Film { frames, outcome } = film(&scene, &gaps, 100).unwrap();
        assert!(frames.len() > 40 && frames.len() <= 102, "{}", frames.len());
        assert!(frames.windows(2).all(|pair| pair[0].t < pair[1].t));
        let run = simulate(&scene, &gaps, &Settings::desk(&scene, 1e-3)).unwrap();
        assert_eq!(outcome, run.outcome);
        let last = frames.last().unwrap();
        assert!((last.displacement[2] - outcome.end.z).abs() < 1e-6 && (last.t - outcome.end.t).abs() < 1e-6);
        // At this level the slide lies on its rails, and compressed gaps were let go.
        assert!(last.gaps.iter().any(|gap| *gap < 0.0) && frames[0].gaps.iter().any(|gap| *gap < 0.0));
        assert!(last.turn.iter().all(|angle| angle.abs() < 0.02));
    }
}
