//! The shipped mechanisms as composed types against the desk: what is written of them is current, and has the bits of the
//! elements that are chosen at run time.

use std::path::PathBuf;

use slipfit::{
    mechanism::{Mechanism, Mounts, planar, rust_source, spatial},
    scene::{SceneFile, shipped},
};
use slipfit_core::{
    SVector,
    integrator::{Extrapolated, Integrator},
    kernel::Kernel,
    mechanism::Mechanism as Mechanics,
    system::{System, ThroughJoints},
};
use slipfit_problems::mechanisms;
use slipfit_tests::known_runs::mechanism_rows;

fn scene(name: &str) -> Mechanism {
    let text = match name {
        "motion-plane" => include_str!("problems/scenes/motion-plane.toml"),
        "motion-rails" => include_str!("problems/scenes/motion-rails.toml"),
        "motion-space" => include_str!("problems/scenes/motion-space.toml"),
        shipped_name => shipped(shipped_name).unwrap(),
    };
    SceneFile::parse(name, text, &[]).unwrap_or_else(|error| panic!("{error}")).mechanism.unwrap()
}

/// What a system of two scalars starts from.
type Start<P, const D: usize> = (P, SVector<f64, D>);

/// Takes `steps` steps by `I` of `one` and `other`, which must have the same bits all the time.
fn same_bits<A, B, P, I, const D: usize>(one: A, other: B, (pose, velocity): Start<P, D>, step: f64, steps: u32)
where
    P: Copy + PartialEq + std::fmt::Debug,
    A: Mechanics<f64, D, Pose = P, Internal: PartialEq + std::fmt::Debug>,
    B: Mechanics<f64, D, Pose = P, Internal: PartialEq + std::fmt::Debug>,
    I: Integrator,
{
    let (one, other) = (Kernel::<f64, _, I>::new(one, step).unwrap(), Kernel::<f64, _, I>::new(other, step).unwrap());
    let (mut a, mut b) = (one.at_rest(pose), other.at_rest(pose));
    (a.motion.velocity, b.motion.velocity) = (velocity, velocity);
    for k in 0..steps {
        let reports = (one.step(&mut a), other.step(&mut b));
        assert_eq!(reports.0, reports.1, "step {k}");
        assert_eq!((a.motion.pose, a.motion.velocity), (b.motion.pose, b.motion.velocity), "step {k}");
    }
    assert!(a.motion.velocity != velocity, "it moves");
}

#[test]
fn what_is_written_is_current() {
    for name in [
        "ball-rod",
        "four-bar",
        "hatch",
        "linear-guide",
        "motion-plane",
        "motion-rails",
        "motion-space",
        "slider-crank",
        "slider-crank-guide",
        "telescopic-drawer",
        "woodpecker-toy",
    ] {
        let file = format!("tests/problems/src/mechanisms/{}.rs", name.replace('-', "_"));
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(&file);
        let written = std::fs::read_to_string(path).unwrap();
        let folder = if name.starts_with("motion") { "tests/problems/scenes" } else { "host/scenes" };
        let command = format!("slipfit kernel {folder}/{name}.toml -o {file}");
        assert!(written == rust_source(&scene(name)).unwrap(), "not current, to be written by {command}");
    }
}

/// The stick band (m/s) that stands for true stick, which no shipped mechanism has.
const NO_STICK: f64 = 1.0;

macro_rules! in_plane {
    ($($test:ident: $name:ident;)*) => {$(
        #[test]
        fn $test() {
            const D: usize = mechanisms::$name::DIMENSION;
            let mechanism = scene(&stringify!($name).replace('_', "-"));
            let mounts = Mounts::of(&mechanism).unwrap();
            let gaps = mechanism.gaps_at(&[0.0]).unwrap();
            let tree = planar::bodies::<D>(&mechanism, &mounts).unwrap();
            let elements = planar::elements::<D>(&mechanism, &mounts, &gaps, NO_STICK).unwrap();
            let chosen = System::new(tree, &elements[..]);
            let composed = mechanisms::$name::unit(0.0f64).unwrap();
            let start = mechanisms::$name::start::<f64>();
            let (step, steps) = (f64::from(mechanisms::$name::STEP), mechanisms::$name::STEPS);
            same_bits::<_, _, _, mechanisms::$name::Scheme, D>(composed, chosen, start, step, steps);
        }
    )*};
}

macro_rules! in_space {
    ($($test:ident: $name:ident, $bodies:literal;)*) => {$(
        #[test]
        fn $test() {
            const D: usize = mechanisms::$name::DIMENSION;
            let mechanism = scene(&stringify!($name).replace('_', "-"));
            let gaps = mechanism.gaps_at(&[0.0]).unwrap();
            let bodies = spatial::bodies::<$bodies, D>(&mechanism).unwrap();
            let elements = spatial::elements(&mechanism, &gaps, NO_STICK).unwrap();
            let chosen = System::new(bodies, &elements[..]);
            let composed = mechanisms::$name::unit(0.0f64).unwrap();
            let start = mechanisms::$name::start::<f64>();
            let (step, steps) = (f64::from(mechanisms::$name::STEP), mechanisms::$name::STEPS);
            same_bits::<_, _, _, mechanisms::$name::Scheme, D>(composed, chosen, start, step, steps);
        }
    )*};
}

in_plane! {
    a_slider_crank_has_the_desks_bits: slider_crank;
    a_guided_slider_crank_has_the_desks_bits: slider_crank_guide;
    a_four_bar_has_the_desks_bits: four_bar;
    a_woodpecker_has_the_desks_bits: woodpecker_toy;
    what_motion_can_have_in_a_plane_has_the_desks_bits: motion_plane;
    walls_through_several_gaps_have_the_desks_bits: motion_rails;
}

in_space! {
    a_linear_guide_has_the_desks_bits: linear_guide, 1;
    a_hatch_has_the_desks_bits: hatch, 1;
    a_drawer_has_the_desks_bits: telescopic_drawer, 2;
}

macro_rules! on_joints {
    ($($test:ident: $name:ident, $moves:literal;)*) => {$(
        /// The desk has room for more coordinates than the composed type has; those stand still and change no bit.
        #[test]
        fn $test() {
            use mechanisms::$name::{DIMENSION, STEP, STEPS, Scheme, start, unit};
            let mechanism = scene(&stringify!($name).replace('_', "-"));
            let gaps = mechanism.gaps_at(&[0.0]).unwrap();
            let mounts = spatial::mounts(&mechanism).unwrap().expect("ideal joints");
            let tree = spatial::tree::<3, 18, 8>(&mechanism, &mounts).unwrap();
            let elements = spatial::elements(&mechanism, &gaps, NO_STICK).unwrap();
            let chosen = System::new(tree, ThroughJoints(&elements[..]));
            let one = Kernel::<f64, _, Scheme>::new(unit(0.0).unwrap(), f64::from(STEP)).unwrap();
            let other = Kernel::<f64, _, Scheme>::new(chosen, f64::from(STEP)).unwrap();
            let (mut a, mut b) = (one.at_rest::<DIMENSION>(start().0), other.at_rest::<8>(tree.nominal()));
            let mut most = 0.0f64;
            for k in 0..STEPS {
                assert_eq!(one.step(&mut a), other.step(&mut b), "step {k}");
                let (pose, velocity) = (&b.motion.pose[..DIMENSION], &b.motion.velocity.as_slice()[..DIMENSION]);
                assert_eq!((&a.motion.pose[..], a.motion.velocity.as_slice()), (pose, velocity), "step {k}");
                most = most.max(a.motion.velocity.norm());
            }
            assert!(most > $moves, "it moves");
        }
    )*};
}

on_joints! {
    a_ball_rod_has_the_desks_bits: ball_rod, 1.0;
    what_motion_can_have_in_space_has_the_desks_bits: motion_space, 0.1;
}

/// The greatest error of the drive's `effort` by steps of one length (s), as a share of its peak in the reference run `file`, whose
/// rows are a millisecond apart and begin with it.
fn effort_error<M, I, const D: usize>(
    file: &str,
    (mechanism, (pose, velocity)): (M, Start<M::Pose, D>),
    step: f64,
    effort: impl Fn(&M, f64, &M::Pose, &SVector<f64, D>) -> f64,
) -> f64
where
    M: Mechanics<f64, D>,
    I: Integrator,
{
    let kernel = Kernel::<f64, _, I>::new(mechanism, step).unwrap();
    let mut state = kernel.at_rest(pose);
    state.motion.velocity = velocity;
    let (rows, per_row) = (mechanism_rows(file), (1e-3 / step).round() as u32);
    let (mut worst, mut peak) = (0.0f64, 0.0f64);
    for row in &rows[1..] {
        for _ in 0..per_row {
            let _ = kernel.step(&mut state);
        }
        let motion = &state.motion;
        let found = effort(kernel.mechanism(), kernel.time(state.steps), &motion.pose, &motion.velocity);
        worst = worst.max((found - row[0]).abs());
        peak = peak.max(row[0].abs());
    }
    worst / peak
}

macro_rules! effort_errors {
    ($($name:ident, $file:literal;)*) => {[$(
        ($file, effort_error::<_, mechanisms::$name::Scheme, { mechanisms::$name::DIMENSION }>(
            $file,
            (mechanisms::$name::unit(0.0f64).unwrap(), mechanisms::$name::start::<f64>()),
            f64::from(mechanisms::$name::STEP),
            |unit, t, pose, velocity| mechanisms::$name::drive_motor(unit, t, pose, velocity).effort,
        )),
    )*]};
}

/// The scheme and step that each scene states for its controller, and the effort that firmware reads from it.
#[test]
fn controllers_err_by_less_than_a_hundredth_of_the_greatest_effort() {
    let errors = effort_errors![
        slider_crank, "P1-slow";
        slider_crank_guide, "P2-driven";
        four_bar, "P3-slow";
        linear_guide, "S1-runs";
        telescopic_drawer, "S2-first";
    ];
    for (file, error) in errors {
        println!("{file:10} {:.3} %", error * 100.0);
        assert!(error < 0.01, "{file}: {error}");
    }
}

/// Beak and sleeve strike so hard that places and angles need steps of 1 µs: no controller computes a toy.
#[test]
fn the_woodpecker_errs_by_less_than_a_hundredth_of_its_motion_in_steps_of_a_microsecond() {
    let unit = mechanisms::woodpecker_toy::unit(0.0).unwrap();
    let kernel = Kernel::<f64, _, Extrapolated<2, 4>>::new(unit, 1e-6).unwrap();
    let (pose, velocity) = mechanisms::woodpecker_toy::start();
    let mut state = kernel.at_rest(pose);
    state.motion.velocity = velocity;
    let (mut worst, mut peak) = ([0.0f64; 3], [0.0f64; 3]);
    for row in &mechanism_rows("S3-ticks")[1..] {
        for _ in 0..1000 {
            let _ = kernel.step(&mut state);
        }
        let [[y, _], sleeve, bird] = state.motion.pose;
        let angle = |[w, v]: [f64; 2]| 2.0 * libm::atan2(v, w);
        for (k, (found, expected)) in
            [(y, row[0]), (angle(sleeve), row[2]), (angle(bird), row[4])].into_iter().enumerate()
        {
            worst[k] = worst[k].max((found - expected).abs());
            peak[k] = peak[k].max(expected.abs());
        }
    }
    let errors: [f64; 3] = std::array::from_fn(|k| worst[k] / peak[k]);
    println!("{errors:?}");
    assert!(errors.iter().all(|error| *error < 0.01), "{errors:?}");
}
