//! What a step of the shipped slide takes on one core after another, and the bits that all of them must compute.

use core::{fmt, hint::black_box};

use slipfit_core::{
    integrator::ImplicitEuler,
    kernel::{self, Report, StateOf},
    pose::Pose,
};
use slipfit_problems::cd_rom::{self, CdRomSlide};

use crate::{
    count::{Count, Range},
    fingerprint::Fingerprint,
    machine::Machine,
};

/// Steps that are counted.
const STEPS: u32 = 200;

type Kernel = kernel::Kernel<f32, CdRomSlide<f32>, ImplicitEuler<4>>;
type State = StateOf<f32, CdRomSlide<f32>, 6>;

/// What the steps took, if the machine can tell, and what they computed.
#[derive(Clone, Copy, Debug)]
pub struct Steps {
    /// Instructions of a step.
    pub instructions: Option<Range>,
    /// Stack of a step (bytes).
    pub stack: Option<u32>,
    /// Parameters and state (bytes).
    pub object: usize,
    /// All states of the run.
    pub states: Fingerprint,
}

impl Steps {
    /// Takes the steps.
    ///
    /// # Panics
    /// Never: the shipped slide and its step of 1 ms are in bounds.
    pub fn on(machine: &mut impl Machine) -> Self {
        let kernel = black_box(Kernel::new(cd_rom::slide(2.5), 1e-3).expect("the step is in bounds"));
        let mut state = kernel.at_rest(Pose::nominal());
        let (mut count, mut states) = (Count::default(), Fingerprint::default());
        while state.steps < STEPS {
            count.add(counted(machine, &kernel, &mut state));
            states.add_motion(&state.motion);
        }
        let stack = machine.stack(|| _ = black_box(step(&kernel, &mut state)));
        Self { instructions: count.range(), stack, object: size_of::<Kernel>() + size_of::<State>(), states }
    }
}

/// The least and the greatest number of instructions, the bytes of stack and of the object, the states.
impl fmt::Display for Steps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (least, greatest) = self.instructions.map(Range::ends).unwrap_or_default();
        write!(f, "{least} {greatest} {} {} {}", self.stack.unwrap_or_default(), self.object, self.states)
    }
}

/// A step as a controller calls it: a function of its own, whose size can be told.
#[inline(never)]
fn step(kernel: &Kernel, state: &mut State) -> Report<f32> {
    kernel.step(state)
}

/// A function of its own, so that what is around the step is the same every time.
#[inline(never)]
fn counted(machine: &mut impl Machine, kernel: &Kernel, state: &mut State) -> Option<u32> {
    machine.instructions(|| _ = black_box(step(kernel, state)))
}
