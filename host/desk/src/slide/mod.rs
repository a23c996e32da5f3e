//! One body on four pins of the frame at the desk, by its fast types: error-controlled steps, or those of a controller in any of
//! its schemes and numbers.

#[cfg(target_arch = "x86_64")]
pub mod abreast;
mod fixed_steps;

use std::{array, ops::ControlFlow};

use slipfit_core::{
    SVector,
    integrator::{Motion, Rodas4},
    law::{Elastic, Friction, Normal},
    menu::SlideData,
    pose::Pose,
    slide::{ABSENT, CONTACTS, Internal, NO_INTERNAL, Slide, to_walls},
    system::Seen,
};

pub use fixed_steps::{At, Controller, Report, Witness, by_controller};

use crate::{
    closing::{Approach, Gaps},
    error_control::{Accelerations, Effort, Sensitivity, Stopped, Tolerance, Watched, integrate},
    laws::SlidingSlide,
    out_of_line::{Contacts, OutOfLine},
};

/// Where the slide is and how it moves, with the gaps (m) of its contacts.
pub type SlideMotion = Motion<f64, Pose<f64>, Internal<()>, 6>;

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
    fn of<E: Elastic<f64>, F: Friction<f64, Internal = ()>, C: Contacts<f64, Slide<f64, E, F>, 6>>(
        self,
        driven: &OutOfLine<Slide<f64, E, F>, C>,
        see: See,
    ) -> Result<Effort, Stopped> {
        let zero = SVector::zeros();
        let rest = Motion { pose: Pose::nominal(), velocity: zero, acceleration: zero, internal: NO_INTERNAL };
        let slide = driven.mechanism();
        let error = |step: &_, length| self.sensitivity.error(self.tolerance, step, length);
        let gaps = |motion: &SlideMotion, gaps: &mut Gaps| watch(slide, self.lever, motion, gaps);
        let watched = Watched { gaps, depth: self.tolerance.position };
        integrate::<Rodas4, _, 6>(driven, rest, self.duration, error, watched, |t, motion, accelerations, gaps| {
            let gaps = array::from_fn(|k| gaps.approaches.get(k).map_or(ABSENT, |approach| approach.gap));
            see(t, motion, &gaps, accelerations)
        })
    }
}

/// Fills in the contacts of a `slide` at a `motion`.
fn watch<E: Elastic<f64>, F: Friction<f64, Internal = ()>>(
    slide: &Slide<f64, E, F>,
    lever: f64,
    motion: &SlideMotion,
    gaps: &mut Gaps,
) {
    let Motion { pose, velocity, .. } = motion;
    gaps.spin = velocity.fixed_rows::<3>(3).norm();
    // A point of the slide at a pin moves no faster than its centre of mass and its turning together.
    let speed = velocity.fixed_rows::<3>(0).norm() + gaps.spin * (lever + pose.displacement_w.norm());
    gaps.approaches.clear();
    for (pin, (_, nominal)) in slide.pins(pose, velocity).iter().zip(&slide.elements().0.each) {
        gaps.approaches.extend_from_slice(&approaches(pin, *nominal, speed, &slide.contact().normal));
    }
}

/// The contacts of a `pin` as the slide sees it with its walls, whose gaps (m) are `nominal` where it is drawn and whose law is `normal`. No
/// point of the slide is faster there than `speed` (m/s).
pub fn approaches(pin: &Seen<f64, 3>, nominal: [f64; 4], speed: f64, normal: &impl Normal<f64>) -> [Approach; 4] {
    let (gaps, rates) = (to_walls(nominal, &pin.place), to_walls([0.0; 4], &pin.rate));
    array::from_fn(|k| Approach::new(gaps[k], rates[k], speed, normal))
}
