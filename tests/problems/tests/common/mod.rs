//! What predictions of the CD-ROM slide are compared with.

use slipfit_core::{
    Scalar,
    drive::Push,
    integrator::{Integrator, Rodas4},
    kernel::Kernel,
    menu::SlideData,
    pose::Pose,
    sampling::{
        normal::score,
        stream::{Rng, unit_stream},
    },
};
use slipfit_problems::cd_rom::{self, CdRomSlide};

/// The error of force (N) that a step of a prediction may make.
pub const TOLERANCE: f32 = 7e-5;

/// The force (N) of a drive that pushes by `push`, every millisecond by steps of fourth order in f64 with a thousandth of the tolerance.
pub fn converged<P: Push<f64> + Copy>(data: &SlideData<f64>, push: P, periods: usize) -> Vec<f64> {
    let (gain, mass) = (data.drive.gain, data.body.mass);
    let slide: CdRomSlide<f64> = cd_rom::from_data(data);
    let slide = slide.driven_by(push).expect("the drive is in bounds");
    let kernel = Kernel::<f64, _, Rodas4>::new(slide, 1e-3).expect("the step is in bounds");
    let mut motion = kernel.at_rest(Pose::nominal()).motion;
    let mut h = 1e-5;
    let mut forces = vec![0.0];
    for period in 0..periods {
        let [start, end] = [period, period + 1].map(|period| period as f64 * 1e-3);
        let mut t = start;
        while t < end {
            let length = if t + 1.01 * h >= end { end - t } else { h };
            let step = Rodas4::step(&slide, t, length, &motion);
            let error = (gain * (step.error / mass)).max(step.drift / mass / 3e-5) / (1e-3 * f64::from(TOLERANCE));
            h = length * (0.8 / Scalar::sqrt(Scalar::sqrt(error.max(1e-12)))).clamp(0.2, 3.0);
            if error <= 1.0 {
                t = if length == end - t { end } else { t + length };
                motion = step.motion;
            }
        }
        forces.push(slide.drive().effort(end, motion.velocity.z));
    }
    forces
}

/// Unit `index` drawn from Table 2, its gaps independent.
pub fn drawn(index: u64) -> SlideData<f64> {
    let mut random = unit_stream(1, index);
    let mut data = cd_rom::data(0.0);
    for (gap, [mean, deviation]) in data.body.gaps.iter_mut().zip(cd_rom::TABLE_2) {
        *gap = (mean + deviation * score::<f64>(random.next_u64())) * 1e-3;
    }
    data
}
