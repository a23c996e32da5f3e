//! The shipped mechanisms as composed types against the desk: what is written of them is current, has the bits of the elements
//! that are chosen at run time, and in fixed steps in f32 follows the error-controlled run.

use std::path::PathBuf;

use slipfit::{
    mechanism::{
        Mechanism, Mounts, columns,
        columns::{BodyMotion, State},
        planar, run, rust_source, spatial,
    },
    scene::{SceneFile, shipped},
};
use slipfit_core::{
    SVector, Scalar, Vector3,
    integrator::{Integrator, Motion},
    kernel::Kernel,
    mechanism::Mechanism as Mechanics,
    pose::{Orientation, Pose},
    system::System,
};
use slipfit_problems::mechanisms;

fn scene(name: &str) -> Mechanism {
    SceneFile::parse(name, shipped(name).unwrap(), &[]).unwrap_or_else(|error| panic!("{error}")).mechanism.unwrap()
}

/// What a system of two scalars starts from.
type Start<P, const D: usize> = (P, SVector<f64, D>);

/// Takes `steps` steps by `I` of `one` and `other`, which must have the same bits all the time.
fn same_bits<A, B, P, I, const D: usize>(one: A, other: B, (pose, velocity): Start<P, D>, step: f64, steps: u32)
where
    P: Copy + PartialEq + std::fmt::Debug,
    A: Mechanics<f64, D, Pose = P, Memory: PartialEq + std::fmt::Debug>,
    B: Mechanics<f64, D, Pose = P, Memory: PartialEq + std::fmt::Debug>,
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

/// Rows of a run of `kernel` in f32, every `per_row` steps.
fn rows<M: Mechanics<f32, D>, I: Integrator, const D: usize>(
    mechanism: &Mechanism,
    kernel: &Kernel<f32, M, I>,
    (pose, velocity): (M::Pose, SVector<f32, D>),
    [steps, per_row]: [u32; 2],
    mut told: impl FnMut(&M::Pose, [f64; D]) -> Vec<BodyMotion>,
) -> Vec<Vec<f64>> {
    let mut state = kernel.at_rest(pose);
    state.motion.velocity = velocity;
    let mut rows = Vec::new();
    loop {
        let Motion { pose, velocity, .. } = &state.motion;
        let rates = std::array::from_fn(|k| f64::from(velocity[k]));
        rows.push(mechanism.row(f64::from(kernel.time(state.steps)), &told(pose, rates)));
        if state.steps + per_row > steps {
            return rows;
        }
        for _ in 0..per_row {
            kernel.step(&mut state);
        }
    }
}

/// What a body in a plane does.
fn told_in_plane<const D: usize>(
    mechanism: &Mechanism,
) -> impl FnMut(&[[f32; 2]; D], [f64; D]) -> Vec<BodyMotion> + '_ {
    let mounts = Mounts::of(mechanism).unwrap();
    let tree = planar::bodies::<D>(mechanism, &mounts).unwrap();
    let mut last = [0.0; D];
    move |pose, rates| {
        let state = State::planar(tree.topology(), &pose.map(|pair| pair.map(f64::from)), rates, &last);
        last = state.places;
        columns::planar(mechanism, &mounts, &tree, &state)
    }
}

fn told_in_space<const N: usize, const D: usize>(
    _: &Mechanism,
) -> impl FnMut(&[Pose<f32>; N], [f64; D]) -> Vec<BodyMotion> + '_ {
    let wide = |v: Vector3<f32>| v.map(f64::from);
    move |poses, rates| {
        let poses = poses.map(|Pose { displacement_w, orientation: Orientation { w, v } }| Pose {
            displacement_w: wide(displacement_w),
            orientation: Orientation { w: f64::from(w), v: wide(v) },
        });
        columns::spatial(&State::spatial(&poses, rates))
    }
}

/// A mechanism in fixed steps and at the desk, in rows of the same times, and the worst of each column.
fn errors(mechanism: &Mechanism, found: &[Vec<f64>], every: f64, from: f64) -> Vec<(String, f64)> {
    let desk = run(mechanism, &mechanism.gaps_at(&[0.0]).unwrap(), every).unwrap();
    let (columns, desk) = (desk.samples.columns, desk.samples.rows);
    let count = desk.len().min(found.len());
    let worst = |k: usize| {
        let peak = desk.iter().fold(0.0, |peak: f64, row| peak.max(row[k].abs()));
        let pairs = desk.iter().zip(found).take(count).filter(|(row, _)| row[0] >= from);
        let error = pairs.fold(0.0, |worst: f64, (row, found)| worst.max((row[k] - found[k]).abs()));
        (columns[k].clone(), error / peak.max(1e-12))
    };
    (1..columns.len()).map(worst).collect()
}

#[test]
#[ignore]
fn explore() {
    use slipfit_core::integrator::{Extrapolated, ImplicitEuler, Sdirk2};
    macro_rules! scene {
        ($name:ident, $told:expr) => {{
            let mechanism = scene(&stringify!($name).replace('_', "-"));
            fn go<I: Integrator>(mechanism: &Mechanism, what: &str) {
                for step in [1e-3f32, 5e-4, 2e-4, 1e-4, 5e-5] {
                    let kernel = Kernel::<f32, _, I>::new(mechanisms::$name::unit(0.0f32).unwrap(), step).unwrap();
                    let per_row = (2e-3 / step).round() as u32;
                    let steps = (mechanism.run.duration as f32 / step).round() as u32;
                    let start = mechanisms::$name::start::<f32>();
                    let found = rows(mechanism, &kernel, start, [steps, per_row], $told(mechanism));
                    let errors = errors(mechanism, &found, 2e-3, 0.0);
                    let list: Vec<_> = errors.iter().map(|(name, e)| format!("{} {:.2}%", name.split(' ').next().unwrap(), e * 100.0)).collect();
                    println!("{} {what} {step:e}: {}", stringify!($name), list.join("  "));
                }
            }
            go::<ImplicitEuler<4>>(&mechanism, "euler");
            go::<Extrapolated<2, 4>>(&mechanism, "extra");
            go::<Sdirk2<4>>(&mechanism, "sdirk");
        }};
    }
    scene!(slider_crank, told_in_plane::<3>);
    scene!(slider_crank_guide, told_in_plane::<3>);
    scene!(four_bar, told_in_plane::<3>);
    scene!(woodpecker_toy, told_in_plane::<3>);
    scene!(linear_guide, told_in_space::<1, 6>);
    scene!(hatch, told_in_space::<1, 6>);
    scene!(telescopic_drawer, told_in_space::<2, 12>);
}

#[test]
fn what_is_written_is_current() {
    for name in
        ["four-bar", "hatch", "linear-guide", "slider-crank", "slider-crank-guide", "telescopic-drawer", "woodpecker-toy"]
    {
        let file = format!("tests/problems/src/mechanisms/{}.rs", name.replace('-', "_"));
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(&file);
        let written = std::fs::read_to_string(path).unwrap();
        let command = format!("slipfit kernel host/scenes/{name}.toml -o {file}");
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
}

in_space! {
    a_linear_guide_has_the_desks_bits: linear_guide, 1;
    a_hatch_has_the_desks_bits: hatch, 1;
    a_drawer_has_the_desks_bits: telescopic_drawer, 2;
}
