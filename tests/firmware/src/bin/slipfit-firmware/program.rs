//! What image and host both run: the opening of the slide at several tolerance levels, its force predicted by the
//! kernel and looked up in the table.

use core::hint::black_box;

use slipfit_core::{
    Scalar,
    integrator::{ImplicitEuler, Integrator},
    kernel::{Kernel, Report, StateOf},
    law::{Exact, Friction, Regularised, ThreeHalves},
    pose::Pose,
    slide::Slide,
    table::{AxisKind, F32Nodes, Lookup, Nodes, Table},
};
use slipfit_problems::cd_rom::{self, STICK_BAND};

use slipfit_firmware::{
    count::Count,
    fingerprint::{Fingerprint, Remembered},
    machine::{Machine, print},
};

/// The scheme that predicts.
type Scheme = ImplicitEuler<4>;

/// The slide with friction law `F`, its kernel and state.
type SlideWith<F> = Slide<f32, ThreeHalves<f32>, F>;
type SlideKernel<F> = Kernel<f32, SlideWith<F>, Scheme>;
type SlideState<F> = StateOf<f32, SlideWith<F>, 6>;

/// Tolerance levels, from loose to tight.
const LEVELS: [f32; 7] = [-3.0, 0.0, 1.0, 2.5, 3.43, 5.0, 6.0];

/// Coefficient of friction.
const COEFFICIENT: f32 = 0.3;

/// Step (s).
const STEP: f32 = 1e-3;

/// Steps of the opening.
const STEPS: u32 = 200;

/// Steps from one printed line to the next.
const STEPS_A_LINE: u32 = 20;

/// What the table must be stamped with: the scene as shipped.
const SCENE_HASH: u64 = 0x83f7_41c2_0cd1_f0bd;

/// What stands for a table where there is none.
const NO_TABLE: Option<&Table<'_, 2, F32Nodes<'_>>> = None;

/// Instructions counted so far.
#[derive(Default)]
struct Costs {
    step: Count,
    lookup: Count,
}

/// Runs the opening at every level on `machine`, whose flash table is at the start of `flash`; it does without one.
pub fn run(machine: &mut impl Machine, flash: &[u8]) -> bool {
    print(machine, format_args!("CD-ROM slide, opening of {STEPS} steps of 1 ms in f32, {}", Scheme::NAME));
    // Hidden from the optimiser, so that the lookup is compiled for any table.
    let axes = [AxisKind::Level, AxisKind::Time];
    let table = black_box(Table::open(flash).and_then(|table| table.expect_axes(axes)?.expect_scene(SCENE_HASH)));
    match &table {
        Ok(table) => print(machine, format_args!("table of {} bytes", table.length())),
        Err(error) => print(machine, format_args!("no table: {error}")),
    }

    let regularised = Regularised::new(COEFFICIENT, STICK_BAND as f32).expect("the law is in bounds");
    let exact = Exact::new(COEFFICIENT).expect("the law is in bounds");
    let law = "regularised friction";
    match table.ok().map(|table| (table.f32(), table.i16())) {
        Some((Some(table), _)) => all_levels(machine, law, regularised, Some(&table)),
        Some((_, Some(table))) => all_levels(machine, law, regularised, Some(&table)),
        _ => all_levels(machine, law, regularised, NO_TABLE),
    }
    all_levels(machine, "exact friction", exact, NO_TABLE);
    print(machine, format_args!("done"));
    true
}

/// Runs the opening at every level with one friction law.
fn all_levels<F: Friction<f32>, V: Nodes>(
    machine: &mut impl Machine,
    law: &str,
    friction: F,
    table: Option<&Table<'_, 2, V>>,
) where
    F::Internal: Remembered,
{
    print(machine, format_args!("\n== {law}"));
    let mut costs = Costs::default();
    for n in LEVELS {
        open(machine, n, friction, table, &mut costs);
    }

    print(machine, format_args!(""));
    // A machine that counts starts its lines so that they can be left out of a comparison.
    if let Some(range) = costs.step.range() {
        print(machine, format_args!("instructions of a step, {law}: {range}"));
    }
    if let Some(range) = costs.lookup.range() {
        print(machine, format_args!("instructions of a lookup: {range}"));
    }
    let (kernel, mut state) = at_rest(0.0, friction);
    if let Some(bytes) = machine.stack(|| _ = black_box(step(&kernel, &mut state))) {
        print(machine, format_args!("stack of a step, {law}: {bytes} bytes"));
    }
    print(machine, format_args!("parameters {} bytes, state {} bytes", size_of_val(&kernel), size_of_val(&state)));
}

/// Runs the opening at tolerance level `n`.
fn open<F: Friction<f32>, V: Nodes>(
    machine: &mut impl Machine,
    n: f32,
    friction: F,
    table: Option<&Table<'_, 2, V>>,
    costs: &mut Costs,
) where
    F::Internal: Remembered,
{
    let (kernel, mut state) = at_rest(n, friction);
    let (mut states, mut lookups) = (Fingerprint::default(), Fingerprint::default());
    let (mut clamped, mut worst_residual) = (0, 0.0);
    print(machine, format_args!("\nn = {n}\n t (ms)  kernel (N)   table (N)"));
    while state.steps < STEPS {
        let mut residual = 0.0;
        costs.step.add(machine.instructions(|| residual = step(&kernel, &mut state).residual));
        worst_residual = residual.max_of(worst_residual);
        states.add_motion(&state.motion);
        let t = kernel.time(state.steps);
        let force = kernel.mechanism().drive().force(t, state.motion.velocity[2]);

        let looked_up = table.map(|table| {
            let mut found = Lookup::default();
            costs.lookup.add(machine.instructions(|| found = lookup(table, [n, t])));
            found
        });
        if let Some(found) = looked_up {
            lookups.add(found.force);
            lookups.add(found.velocity);
            clamped += u32::from(found.clamped);
        }

        if state.steps.is_multiple_of(STEPS_A_LINE) {
            match looked_up {
                Some(found) => print(machine, format_args!("{:7}{force:12.6}{:12.6}", state.steps, found.force)),
                None => print(machine, format_args!("{:7}{force:12.6}           -", state.steps)),
            }
        }
    }
    print(machine, format_args!("all states  {states}, worst residual {worst_residual:.3e} N s"));
    if table.is_some() {
        print(machine, format_args!("all lookups {lookups}, {clamped} clamped"));
    }
}

/// The slide's kernel at tolerance level `n`, hidden from the optimiser so that its step is compiled for any slide, and
/// its first state.
fn at_rest<F: Friction<f32>>(n: f32, friction: F) -> (SlideKernel<F>, SlideState<F>) {
    let slide = cd_rom::with_friction(&cd_rom::data(n), friction);
    let kernel = black_box(SlideKernel::new(slide, STEP).expect("the step is in bounds"));
    (kernel, kernel.at_rest(Pose::nominal()))
}

/// The step as a controller calls it, once a law in the image.
#[inline(never)]
fn step<F: Friction<f32>>(kernel: &SlideKernel<F>, state: &mut SlideState<F>) -> Report<f32> {
    kernel.step(state)
}

/// The lookup as a controller calls it, once in the image.
#[inline(never)]
fn lookup<V: Nodes>(table: &Table<'_, 2, V>, at: [f32; 2]) -> Lookup {
    table.lookup(at)
}
