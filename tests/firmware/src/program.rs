//! What image and host both run: the opening of the slide at several tolerance levels, its force predicted by the
//! kernel and looked up in the table.

use core::{
    fmt::{Arguments, Write},
    hint::black_box,
};

use heapless::String;
use slipfit_core::{
    Scalar,
    integrator::{ImplicitEuler, Integrator},
    kernel::{Kernel, Report},
    pose::Pose,
    table::{Lookup, Table},
};
use slipfit_problems::cd_rom::{self, CdRomSlide, CdRomState};

use crate::{count::Count, fingerprint::Fingerprint};

/// The scheme that predicts.
type Scheme = ImplicitEuler<4>;

type SlideKernel = Kernel<f32, CdRomSlide<f32>, Scheme>;

/// Tolerance levels, from loose to tight.
const LEVELS: [f32; 7] = [-3.0, 0.0, 1.0, 2.5, 3.43, 5.0, 6.0];

/// Step (s).
const STEP: f32 = 1e-3;

/// Steps of the opening.
const STEPS: u32 = 200;

/// Steps from one printed line to the next.
const STEPS_A_LINE: u32 = 20;

/// What the program needs of the machine it runs on.
pub trait Machine {
    /// Prints `line`, which ends in a newline.
    fn print(&mut self, line: &str);

    /// Does `work` and says how many instructions it took, if the machine can tell.
    fn instructions(&mut self, work: impl FnOnce()) -> Option<u32>;

    /// Does `work` and says how many bytes of stack it took, if the machine can tell.
    fn stack(&mut self, work: impl FnOnce()) -> Option<u32>;
}

/// Instructions counted so far.
#[derive(Default)]
struct Costs {
    step: Count,
    lookup: Count,
}

/// Runs the opening at every level on `machine`, whose flash table is at the start of `flash`.
pub fn run(machine: &mut impl Machine, flash: &[u8]) {
    print(machine, format_args!("CD-ROM slide, opening of {STEPS} steps of 1 ms in f32, {}", Scheme::NAME));
    let table = Table::open(flash);
    match &table {
        Ok(table) => print(machine, format_args!("table of {} bytes", table.length())),
        Err(error) => print(machine, format_args!("no table: {error}")),
    }

    let mut costs = Costs::default();
    for n in LEVELS {
        open(machine, n, table.as_ref().ok(), &mut costs);
    }

    print(machine, format_args!(""));
    // A machine that counts starts its lines so that they can be left out of a comparison.
    if let Some(range) = costs.step.range() {
        print(machine, format_args!("instructions of a step: {range}"));
    }
    if let Some(range) = costs.lookup.range() {
        print(machine, format_args!("instructions of a lookup: {range}"));
    }
    let (kernel, mut state) = at_rest(0.0);
    if let Some(bytes) = machine.stack(|| _ = black_box(step(&kernel, &mut state))) {
        print(machine, format_args!("stack of a step: {bytes} bytes"));
    }
    print(machine, format_args!("done"));
}

/// Runs the opening at tolerance level `n`.
fn open(machine: &mut impl Machine, n: f32, table: Option<&Table<'_>>, costs: &mut Costs) {
    let (kernel, mut state) = at_rest(n);
    let (mut states, mut lookups) = (Fingerprint::default(), Fingerprint::default());
    let (mut clamped, mut worst_residual) = (0, 0.0);
    print(machine, format_args!("\nn = {n}\n t (ms)  kernel (N)   table (N)"));
    while state.steps < STEPS {
        let mut residual = 0.0;
        costs.step.add(machine.instructions(|| residual = step(&kernel, &mut state).residual));
        worst_residual = residual.max_of(worst_residual);
        states.add_state(&state);
        let t = kernel.time(state.steps);
        let force = kernel.mechanism().drive().force(t, state.motion.velocity[2]);

        let mut looked_up = None;
        if let Some(table) = table {
            costs.lookup.add(machine.instructions(|| looked_up = Some(lookup(table, [n, t]))));
        }
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
fn at_rest(n: f32) -> (SlideKernel, CdRomState<f32>) {
    let kernel = SlideKernel::new(cd_rom::slide(n), STEP).expect("the step is in bounds");
    let kernel = black_box(kernel);
    (kernel, kernel.at_rest(Pose::nominal()))
}

/// The step as a controller calls it, once in the image.
#[inline(never)]
fn step(kernel: &SlideKernel, state: &mut CdRomState<f32>) -> Report<f32> {
    kernel.step(state)
}

/// The lookup as a controller calls it, once in the image.
#[inline(never)]
fn lookup(table: &Table<'_>, at: [f32; 2]) -> Lookup {
    table.lookup(at)
}

/// Prints one line in one go, because every write stops the machine for its debugger.
fn print(machine: &mut impl Machine, text: Arguments<'_>) {
    let mut line = String::<128>::new();
    writeln!(line, "{text}").expect("a line fits its buffer");
    machine.print(&line);
}
