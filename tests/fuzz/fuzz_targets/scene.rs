//! The scene constant: any numbers are refused, or make a kernel that stays finite.
#![no_main]

use libfuzzer_sys::fuzz_target;
use slipfit_core::{
    integrator::{Extrapolated, ImplicitEuler, Integrator},
    kernel::Kernel,
    law::{Elastic, Friction},
    menu::{ContactData, FrictionData, SlideVisitor},
    pose::Pose,
    scene::SceneData,
    slide::Slide,
};
use slipfit_problems::cd_rom;

/// Steps a slide.
struct Stepped;

impl SlideVisitor<f32> for Stepped {
    type Output = ();

    fn visit<E: Elastic<f32>, F: Friction<f32>>(self, slide: Slide<f32, E, F>) {
        stepped::<E, F, ImplicitEuler<4>>(slide);
        stepped::<E, F, Extrapolated<2, 4>>(slide);
    }
}

fn stepped<E: Elastic<f32>, F: Friction<f32>, I: Integrator>(slide: Slide<f32, E, F>) {
    let kernel = Kernel::<f32, _, I>::new(slide, 1e-3).expect("the step is in bounds");
    let mut state = kernel.at_rest(Pose::nominal());
    for _ in 0..20 {
        let report = kernel.step(&mut state);
        assert!(!report.residual.is_nan() && !report.error.is_nan());
        assert!(state.motion.velocity.iter().all(|velocity| velocity.is_finite()));
    }
}

/// What is changed of the CD-ROM slide: which number, to what; then the normal law and the friction law.
type Input = (Vec<(u8, f32)>, u8, f32);

fuzz_target!(|input: Input| {
    let (changes, laws, n) = input;
    let data = cd_rom::data(0.0f32);
    let mut numbers = [0.0; 64];
    let valid = [data.body.mass, 1.5, 1e3, 1e-4, 0.3, 1e-4, 40.0, 0.05, 1.0, 0.1, 3e6];
    let vectors = [data.body.inertia_b, data.body.gravity_w, data.drive.point_b];
    let vectors = vectors.iter().chain(&data.body.pins_w).flatten().copied();
    let gaps = data.body.gaps.into_iter().chain([2e-5; 16]);
    numbers.iter_mut().zip(valid.into_iter().chain(vectors).chain(gaps)).for_each(|(slot, number)| *slot = number);
    for (place, number) in changes {
        numbers[usize::from(place) % 64] = number;
    }
    let [mass, exponent, damping, depth, coefficient, stick_band, drive_gain, start, end, drive_speed, stiffness] =
        *numbers.first_chunk().expect("enough numbers");
    let triple = |i: usize| [numbers[i], numbers[i + 1], numbers[i + 2]];
    let scene = SceneData {
        mass,
        inertia_b: triple(11),
        gravity_w: triple(14),
        pins_w: [20, 23, 26, 29].map(triple),
        gap_means: *numbers[32..].first_chunk().expect("enough numbers"),
        gap_deviations: *numbers[48..].first_chunk().expect("enough numbers"),
        contact: ContactData {
            stiffness,
            exponent: match laws & 3 {
                0 => 1.0,
                1 => 1.5,
                _ => exponent,
            },
            damping,
            depth,
        },
        friction: match laws >> 2 & 3 {
            0 => FrictionData::None,
            1 => FrictionData::Regularised { coefficient, stick_band },
            _ => FrictionData::Exact { coefficient },
        },
        drive_gain,
        drive_ramp: [start, end],
        drive_speed,
        drive_point_b: triple(17),
    };
    // Refusals are answers too.
    let _ = scene.at(n).and_then(|unit| unit.visit(Stepped));
});
