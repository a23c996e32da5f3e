//! One body on four pins of the frame at the desk, by its fast types: error-controlled steps, or those of a controller in any of
//! its schemes and numbers.

#[cfg(target_arch = "x86_64")]
pub mod abreast;
mod fixed_steps;
mod watch;

use std::ops::ControlFlow;

use slipfit_core::{
    SVector,
    integrator::{Motion, Rodas4},
    law::{Elastic, Friction},
    menu::SlideData,
    pose::Pose,
    slide::{ABSENT, CONTACTS, NO_INTERNAL, Slide},
};

pub use fixed_steps::{At, Controller, Report, Witness, by_controller};
pub use watch::{SlideMotion, Watch, approaches};

use crate::{
    closing::Gaps,
    error_control::{Accelerations, Effort, Sensitivity, Stopped, Tolerance, Watched, integrate},
    laws::SlidingSlide,
    out_of_line::{Contacts, OutOfLine},
};

/// Sees the time (s), the motion and the gaps (m) at the start and at the end of every step, with the step's accelerations, and says
/// whether to go on.
pub type See<'a> = &'a mut dyn FnMut(f64, &SlideMotion, &[f64; CONTACTS], Option<Accelerations<6>>) -> ControlFlow<()>;

/// Moves the slide that `data` describes from rest over `duration` (s), each step held to `tolerance`; a `stick_band` (m/s) is used
/// in place of true stick.
///
/// # Errors
/// See [`Stopped`].
pub fn by_desk(
    data: &SlideData<f64>,
    stick_band: f64,
    duration: f64,
    tolerance: Tolerance,
    see: See,
) -> Result<Effort, Stopped> {
    let sensitivity = Sensitivity { mass: data.body.mass, gain: data.drive.gain };
    let lever = data.body.pins_w.iter().map(|pin| pin.norm()).fold(0.0, f64::max);
    let run = Run { sensitivity, lever, duration, tolerance };
    match SlidingSlide::new(data, stick_band)? {
        SlidingSlide::Usual(slide) => {
            #[cfg(target_arch = "x86_64")]
            if let Some(pins) = abreast::SideBySide::new(data, stick_band) {
                return run.of(&OutOfLine::by(slide, pins), see);
            }
            run.of(&OutOfLine::new(slide), see)
        }
        SlidingSlide::Chosen(slide) => run.of(&OutOfLine::new(slide), see),
    }
}

/// A run whose slide's type is to be known.
struct Run {
    sensitivity: Sensitivity,
    /// Distance (m) of the farthest pin from the centre of mass at the start.
    lever: f64,
    duration: f64,
    tolerance: Tolerance,
}

impl Run {
    fn of<E: Elastic<f64>, F: Friction<f64, Internal = ()>, C>(
        self,
        driven: &OutOfLine<Slide<f64, E, F>, C>,
        see: See,
    ) -> Result<Effort, Stopped>
    where
        C: Contacts<f64, Slide<f64, E, F>, 6> + Watch<Slide<f64, E, F>>,
    {
        let zero = SVector::zeros();
        let rest = Motion { pose: Pose::nominal(), velocity: zero, acceleration: zero, internal: NO_INTERNAL };
        let slide = driven.mechanism();
        let error = |step: &_, length| self.sensitivity.error(self.tolerance, step, length);
        let gaps = |motion: &SlideMotion, gaps: &mut Gaps| {
            let [velocity, spin] = [0, 3].map(|first| motion.velocity.fixed_rows::<3>(first).norm());
            // A point of the slide at a pin moves no faster than its centre of mass and its turning together.
            let speed = velocity + spin * (self.lever + motion.pose.displacement_w.norm());
            gaps.clear(spin);
            driven.contacts().watch(slide, motion, speed, gaps);
        };
        let watched = Watched { gaps, depth: self.tolerance.position, bends: &[] };
        integrate::<Rodas4, _, 6>(driven, rest, self.duration, error, watched, |t, motion, accelerations, gaps| {
            let mut of_pins = [ABSENT; CONTACTS];
            for (wall, of_wall) in gaps.gaps().enumerate() {
                of_wall.iter().enumerate().for_each(|(pin, gap)| of_pins[4 * pin + wall] = *gap);
            }
            see(t, motion, &of_pins, accelerations)
        })
    }
}
