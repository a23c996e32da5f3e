//! A ladder of scene types, each with less than the one above: what a scene does not need is not paid for.

use core::{fmt::Display, hint::black_box};

use slipfit_core::{
    Vector2,
    ahead::{self, Ahead, Prediction},
    drive::{Drive, SetpointDrive},
    integrator::{ImplicitEuler, Integrator},
    kernel::{Kernel, Report, StateOf},
    law::{
        ClearanceFit, Elastic, Exact, Friction, Frictionless, Impact, Linear, Pad, Power, Regularised, Slot,
        ThreeHalves,
    },
    mechanism::Mechanism,
    menu::SlideData,
    pose::Pose,
    slide::{Body, PINS, Slide},
    system::{
        AxisBody, Element, System,
        law::{Contact, Journal, Pusher, Slot as PlanarSlot},
        on_axis,
        planar::{Floating, Hole, Pin, PlanarPose, Pull},
    },
};
use slipfit_problems::{
    cd_rom::{self, STICK_BAND},
    mechanisms,
};

use slipfit_firmware::{
    count::Count,
    fingerprint::Fingerprint,
    machine::{Machine, print},
};

/// The scheme of every rung.
type Scheme = ImplicitEuler<4>;

/// Step (s), and steps that are counted.
const STEP: f32 = 1e-3;
const STEPS: u32 = 200;
const MECHANISM_STEPS: u32 = 100;

/// Coefficient of friction, where there is any.
const COEFFICIENT: f32 = 0.3;

/// Tolerance level of every rung.
const LEVEL: f32 = 2.5;

/// Periods from the clock's start to the release of the slide that is predicted ahead.
const EARLY: u32 = 70;

type Unit<E, F> = Slide<f32, E, F>;
type WithClearance<F> = Slide<f32, ThreeHalves<f32>, F, ClearanceFit<f32>>;
type Normal = Impact<f32, ThreeHalves<f32>>;
type Pulled = Element<Pull<f32>, Pusher<Drive<f32>>, 2>;
type Slotted = Element<Pin<f32>, PlanarSlot<f32, Normal, Regularised<f32>>, 2>;
type Flat = System<Floating<f32>, ([Slotted; PINS], Pulled)>;
type Lever = System<Floating<f32>, (Element<Hole<f32>, Journal<f32, Normal, Frictionless>, 4>, Pulled)>;
type Driven = AxisBody<f32, ThreeHalves<f32>, Slot<f32>, Drive<f32>>;
type Ball = AxisBody<f32, Linear<f32>, Pad<f32>>;

/// A step of mechanism `M` by scheme `I`.
type StepFn<M, I, const D: usize> = fn(&Kernel<f32, M, I>, &mut StateOf<f32, M, D>) -> Report<f32>;

/// The step of one rung as a controller calls it: a function of its own, whose size can be told.
macro_rules! rungs {
    ($($name:ident: $mechanism:ty, $axes:literal;)*) => {$(
        #[inline(never)]
        fn $name(kernel: &Kernel<f32, $mechanism, Scheme>, state: &mut StateOf<f32, $mechanism, $axes>) -> Report<f32> {
            kernel.step(state)
        }
    )*};
}

/// A slide ahead of the clock of its ramp, and the motions it keeps.
type SlideAhead = Ahead<f32, Slide<f32, ThreeHalves<f32>, Regularised<f32>, [f32; 4], SetpointDrive<f32>>>;
type SlideAheadState = ahead::State<f32, Pose<f32>, 6, 256>;

/// A prediction, the ramp that its command takes, and its motions.
struct AlongRamp {
    ahead: SlideAhead,
    ramp: Drive<f32>,
    state: SlideAheadState,
}

impl AlongRamp {
    fn new(slide: Unit<ThreeHalves<f32>, Regularised<f32>>) -> Self {
        let limits = ahead::Limits { period: STEP, tolerance: 7e-5, lead: 0.2, lag: 0.2, attempts: 1 };
        let ramp = *slide.drive();
        let slide = slide.driven_by(SetpointDrive::new(ramp.gain)).expect("the gain is in bounds");
        let ahead = Ahead::new(slide, limits).expect("the limits are in bounds");
        Self { state: ahead.at_rest(Pose::nominal(), EARLY, |t| ramp.command(t)), ahead, ramp }
    }
}

/// A period of a command that is known in advance.
#[inline(never)]
fn slide_ahead((): &(), AlongRamp { ahead, ramp, state }: &mut AlongRamp) -> Prediction<f32> {
    let horizon = ahead.horizon(state);
    let speed = ramp.command(ahead.time(state, horizon + 1));
    ahead.plan(state, horizon, speed);
    ahead.step(state)
}

/// Predicts ahead of the clock.
fn ahead(machine: &mut impl Machine, slide: Unit<ThreeHalves<f32>, Regularised<f32>>) {
    let mut run = black_box(AlongRamp::new(slide));
    let (mut count, mut forces) = (Count::default(), Fingerprint::default());
    for _ in 0..STEPS {
        count.add(counted(machine, &(), &mut run, slide_ahead));
    }
    let mut again = AlongRamp::new(slide);
    (0..STEPS).for_each(|_| forces.add(slide_ahead(&(), &mut again).force));
    let (parameters, bytes) = (size_of_val(&run.ahead), size_of_val(&run.state));
    print(machine, format_args!("slide_ahead: parameters {parameters} bytes, state {bytes} bytes, {forces}"));
    if let Some(range) = count.range() {
        print(machine, format_args!("instructions of slide_ahead: {range}"));
    }
    if let Some(bytes) = machine.stack(|| _ = black_box(slide_ahead(&(), &mut run))) {
        print(machine, format_args!("stack of slide_ahead: {bytes} bytes"));
    }
    if let Some(instructions) = counted(machine, &(), &mut run, |(), run| run.ahead.follow(&mut run.state, 0.01)) {
        print(machine, format_args!("instructions of following a command: {instructions}"));
    }
}

rungs! {
    slide_general_exponent: Unit<Power<f32>, Exact<f32>>, 6;
    slide_exact: Unit<ThreeHalves<f32>, Exact<f32>>, 6;
    slide_regularised: Unit<ThreeHalves<f32>, Regularised<f32>>, 6;
    slide_frictionless: Unit<ThreeHalves<f32>, Frictionless>, 6;
    slide_exact_with_clearance: WithClearance<Exact<f32>>, 6;
    slide_regularised_with_clearance: WithClearance<Regularised<f32>>, 6;
    planar_regularised: Flat, 3;
    planar_journal: Lever, 3;
    axis_slot_driven: Driven, 1;
    axis_pad_linear: Ball, 1;
}

/// Runs 200 steps of 1 ms on every rung.
pub fn run(machine: &mut impl Machine, _: &[u8]) -> bool {
    let exact = Exact::new(COEFFICIENT).expect("the law is in bounds");
    let regularised = Regularised::new(COEFFICIENT, STICK_BAND as f32).expect("the law is in bounds");
    let data = cd_rom::data(LEVEL);
    let law = data.contact;
    let power = Power::new(law.stiffness, law.exponent).expect("the law is in bounds");
    let three_halves = ThreeHalves::new(law.stiffness).expect("the law is in bounds");
    let (nominal, drive) = (Pose::nominal(), data.drive);
    rung(machine, "slide_general_exponent", slide(power, exact), nominal, slide_general_exponent);
    rung(machine, "slide_exact", slide(three_halves, exact), nominal, slide_exact);
    full_pass(machine, "", slide(three_halves, exact), one_pass, two_passes);
    rung(machine, "slide_regularised", slide(three_halves, regularised), nominal, slide_regularised);
    ahead(machine, slide(three_halves, regularised));
    rung(machine, "slide_frictionless", slide(three_halves, Frictionless), nominal, slide_frictionless);
    with_clearance(machine, exact, regularised);

    let normal = impact(three_halves);
    let places = data.body.pins_w.map(|pin| Vector2::new(pin.x, pin.z));
    let floating = |gravity: f32| {
        let Body { mass, inertia_b, .. } = data.body;
        Floating::new(mass, inertia_b.y, Vector2::new(0.0, gravity), &places).expect("the body is in bounds")
    };
    let pull = Element { link: Pull { point: Vector2::zeros(), axis: Vector2::new(0.0, 1.0) }, law: Pusher(drive) };
    let slots = [0, 1, 2, 3].map(|pin| Element {
        link: Pin { place: places[pin] },
        law: PlanarSlot {
            gaps: [data.body.gaps[4 * pin], data.body.gaps[4 * pin + 1]],
            contact: Contact { normal, friction: regularised },
        },
    });
    rung(
        machine,
        "planar_regularised",
        System::new(floating(0.0), (slots, pull)),
        PlanarPose::nominal(),
        planar_regularised,
    );
    let law = Journal { clearance: 1e-5, radius: 5e-3, contact: Contact { normal, friction: Frictionless } };
    let journal = Element { link: Hole { centre: places[0] }, law };
    let lever = System::new(floating(-9.81), (journal, pull));
    rung(machine, "planar_journal", lever, PlanarPose::nominal(), planar_journal);

    // Off its slot's middle, and pushed against the end.
    let slot = Slot::new(1e-5, 1e-4).expect("the gaps are in bounds");
    let driven = on_axis(data.body.mass, 0.0, slot, normal, drive).expect("the body is in bounds");
    rung(machine, "axis_slot_driven", driven, 0.0, axis_slot_driven);
    let linear = Linear::new(2e4).expect("the law is in bounds");
    let pad = Pad::new(0.0).expect("the gap is in bounds");
    let ball = on_axis(data.body.mass, -9.81, pad, impact(linear), ()).expect("the body is in bounds");
    rung(machine, "axis_pad_linear", ball, 1e-3, axis_pad_linear);
    every_mechanism(machine);
    true
}

/// The slide with either friction, whose pins fit with clearance.
fn with_clearance(machine: &mut impl Machine, exact: Exact<f32>, regularised: Regularised<f32>) {
    let law = cd_rom::data(LEVEL).contact;
    let three_halves = ThreeHalves::new(law.stiffness).expect("the law is in bounds");
    let nominal = Pose::nominal();
    let unit = slide(three_halves, exact).with_clearance().expect("its slots are wider than their pins");
    rung(machine, "slide_exact_with_clearance", unit, nominal, slide_exact_with_clearance);
    full_pass(machine, " with clearance", unit, one_pass_with_clearance, two_passes_with_clearance);
    let unit = slide(three_halves, regularised).with_clearance().expect("its slots are wider than their pins");
    rung(machine, "slide_regularised_with_clearance", unit, nominal, slide_regularised_with_clearance);
}

/// The step of a shipped mechanism, as a function of its own, and the run of its unit.
macro_rules! mechanisms {
    ($($name:ident;)*) => {
        $(#[inline(never)]
        fn $name(
            kernel: &Kernel<f32, mechanisms::$name::Unit<f32>, Scheme>,
            state: &mut StateOf<f32, mechanisms::$name::Unit<f32>, { mechanisms::$name::DIMENSION }>,
        ) -> Report<f32> {
            kernel.step(state)
        })*

        fn every_mechanism(machine: &mut impl Machine) {
            $({
                let unit = mechanisms::$name::unit(0.0).expect("the shipped scene is in bounds");
                let kernel = Kernel::new(unit, STEP).expect("the step is in bounds");
                let (pose, velocity) = mechanisms::$name::start();
                let mut state = kernel.at_rest(pose);
                state.motion.velocity = velocity;
                steps(machine, stringify!($name), &black_box(kernel), state, MECHANISM_STEPS, $name);
            })*
        }
    };
}

mechanisms! {
    slider_crank;
    slider_crank_guide;
    four_bar;
    woodpecker_toy;
    hatch;
    linear_guide;
    telescopic_drawer;
    ball_rod;
    motion_plane;
}

/// Says what a Newton pass of a slide with exact friction takes, its iteration matrix and solution included: a step of two passes less
/// one of a single pass.
fn full_pass<M: Mechanism<f32, 6, Pose = Pose<f32>> + Copy>(
    machine: &mut impl Machine,
    which: &str,
    slide: M,
    one_pass: StepFn<M, ImplicitEuler<1>, 6>,
    two_passes: StepFn<M, ImplicitEuler<2>, 6>,
) {
    let one = Kernel::<f32, _, ImplicitEuler<1>>::new(slide, STEP).expect("the step is in bounds");
    let two = Kernel::<f32, _, ImplicitEuler<2>>::new(slide, STEP).expect("the step is in bounds");
    let (mut state, mut other) = (one.at_rest(Pose::nominal()), two.at_rest(Pose::nominal()));
    let one = counted(machine, black_box(&one), &mut state, one_pass);
    let two = counted(machine, black_box(&two), &mut other, two_passes);
    if let (Some(one), Some(two)) = (one, two) {
        print(machine, format_args!("instructions of a pass{which}: {}", two - one));
    }
}

/// Steps of one pass and of two, as functions of their own.
macro_rules! passes {
    ($($name:ident: $mechanism:ty, $passes:literal;)*) => {$(
        #[inline(never)]
        fn $name(
            kernel: &Kernel<f32, $mechanism, ImplicitEuler<$passes>>,
            state: &mut StateOf<f32, $mechanism, 6>,
        ) -> Report<f32> {
            kernel.step(state)
        }
    )*};
}

passes! {
    one_pass: Unit<ThreeHalves<f32>, Exact<f32>>, 1;
    two_passes: Unit<ThreeHalves<f32>, Exact<f32>>, 2;
    one_pass_with_clearance: WithClearance<Exact<f32>>, 1;
    two_passes_with_clearance: WithClearance<Exact<f32>>, 2;
}

fn impact<E: Elastic<f32>>(elastic: E) -> Impact<f32, E> {
    let law = cd_rom::data(LEVEL).contact;
    Impact::new(elastic, law.damping, law.depth).expect("the law is in bounds")
}

fn slide<E: Elastic<f32>, F: Friction<f32>>(elastic: E, friction: F) -> Unit<E, F> {
    let SlideData { body, drive, .. } = cd_rom::data(LEVEL);
    body.slide(impact(elastic), friction, drive).expect("the slide is in bounds")
}

/// Steps `mechanism` from `pose` and says what that takes.
fn rung<M: Mechanism<f32, D>, const D: usize>(
    machine: &mut impl Machine,
    name: impl Display,
    mechanism: M,
    pose: M::Pose,
    step: StepFn<M, Scheme, D>,
) {
    let kernel = black_box(Kernel::new(mechanism, STEP).expect("the step is in bounds"));
    steps(machine, name, &kernel, kernel.at_rest(pose), STEPS, step);
}

/// Takes so many `steps` of `kernel` from `state` and says what one takes.
fn steps<M: Mechanism<f32, D>, I: Integrator, const D: usize>(
    machine: &mut impl Machine,
    name: impl Display,
    kernel: &Kernel<f32, M, I>,
    mut state: StateOf<f32, M, D>,
    steps: u32,
    step: StepFn<M, I, D>,
) {
    let (mut count, mut velocities) = (Count::default(), Fingerprint::default());
    while state.steps < steps {
        count.add(counted(machine, kernel, &mut state, step));
        state.motion.velocity.iter().for_each(|velocity| velocities.add(*velocity));
    }
    let (parameters, bytes) = (size_of_val(kernel), size_of_val(&state));
    print(machine, format_args!("{name}: parameters {parameters} bytes, state {bytes} bytes, {velocities}"));
    if let Some(range) = count.range() {
        print(machine, format_args!("instructions of {name}: {range}"));
    }
    if let Some(bytes) = machine.stack(|| _ = black_box(step(kernel, &mut state))) {
        print(machine, format_args!("stack of {name}: {bytes} bytes"));
    }
}

/// Instructions of one step. A function of its own, so that what is around the step is the same in every pass of a loop.
#[inline(never)]
fn counted<K, T, R>(machine: &mut impl Machine, kernel: &K, state: &mut T, step: fn(&K, &mut T) -> R) -> Option<u32> {
    machine.instructions(|| _ = black_box(step(kernel, state)))
}
