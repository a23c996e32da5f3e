//! Against the slide in its plane, a pendulum, the definition of a journal, and the friction circle.

use super::{Floating, Hole, Pin, PlanarPose, Pull};
use crate::{
    SVector, Vector2, Vector3,
    drive::Drive,
    integrator::{Extrapolated, ImplicitEuler, Integrator, Rodas3},
    kernel::Kernel,
    law::{Exact, Friction, Frictionless, Impact, Regularised, ThreeHalves},
    pose::Pose,
    slide::{ABSENT, Body, Slide},
    system::{
        Element, System,
        law::{Contact, Journal, Pusher, Slot},
    },
};

type Normal = Impact<f64, ThreeHalves<f64>>;

const CLEARANCE: f64 = 2e-5;
const RADIUS: f64 = 5e-3;
const STIFFNESS: f64 = 3e6;

fn normal() -> Normal {
    Impact::new(ThreeHalves::new(STIFFNESS).unwrap(), 1000.0, 1e-4).unwrap()
}

const GAPS: [[f64; 2]; 4] = [[1e-5, -2e-5], [2e-4, 1e-4], [-1e-5, 1e-5], [3e-5, 2e-4]];
const PINS: [[f64; 2]; 4] = [[-0.062, -0.018], [0.062, -0.018], [-0.062, 0.018], [0.062, 0.018]];

type Flat<F> =
    System<Floating<f64>, ([Element<Pin<f64>, Slot<f64, Normal, F>, 2>; 4], Element<Pull<f64>, Pusher<Drive<f64>>, 2>)>;

/// The slide, held in its plane by having nothing above and below, and the same body in the plane, whose y is the slide's z.
fn both<F: Friction<f64>>(friction: F) -> (Slide<f64, ThreeHalves<f64>, F>, Flat<F>) {
    let drive =
        Drive { gain: 40.0, ramp_start: 0.0, ramp_end: 0.1, speed: 0.1, point_b: Vector3::new(0.03, 0.0, -0.01) };
    let mut gaps = [ABSENT; 16];
    for ([left, right, ..], gap) in gaps.as_chunks_mut::<4>().0.iter_mut().zip(GAPS) {
        [*left, *right] = gap;
    }
    let body = Body {
        mass: 0.08,
        inertia_b: Vector3::new(1.0, 3e-4, 1.0),
        gravity_w: Vector3::new(2.0, 0.0, 0.5),
        pins_w: PINS.map(|[x, z]| Vector3::new(x, 0.0, z)),
        gaps,
    };
    let slots = core::array::from_fn(|i| Element {
        link: Pin { place: PINS[i].into() },
        law: Slot { gaps: GAPS[i], contact: Contact { normal: normal(), friction } },
    });
    let pull = Pull { point: Vector2::new(0.03, -0.01), axis: Vector2::new(0.0, 1.0) };
    let flat = Floating::new(0.08, 3e-4, Vector2::new(2.0, 0.5), &PINS.map(Vector2::from)).unwrap();
    (
        body.slide(normal(), friction, drive).unwrap(),
        System::new(flat, (slots, Element { link: pull, law: Pusher(drive) })),
    )
}

fn agrees<F: Friction<f64>, I: Integrator>(friction: F, step: f64) {
    let (slide, flat) = both(friction);
    let slide = Kernel::<f64, _, I>::new(slide, step).unwrap();
    let flat = Kernel::<f64, _, I>::new(flat, step).unwrap();
    let (mut a, mut b) = (slide.at_rest::<6>(Pose::nominal()), flat.at_rest::<3>(PlanarPose::nominal()));
    // An interpreter that looks for undefined behaviour has no time for a whole motion.
    for _ in 0..if cfg!(miri) { 2 } else { 2000 } {
        let _ = slide.step(&mut a);
        let _ = flat.step(&mut b);
        let (v, w) = (a.motion.velocity, b.motion.velocity);
        // About the slide's y a turn goes from z to x.
        let miss = [v.x - w.x, v.z - w.y, v[4] + w.z, a.motion.pose.orientation.v.y + b.motion.pose.half_turn[1]];
        assert!(miss.iter().all(|miss| libm::fabs(*miss) < 1e-8), "{miss:?} at {}", a.steps);
    }
    let turned = libm::fabs(b.motion.pose.half_turn[1]);
    assert!(cfg!(miri) || turned > 1e-5 && b.motion.velocity.y > 0.01, "it turns and moves: {turned}");
}

#[test]
fn moves_as_the_slide_in_its_plane() {
    // So many passes that both converge: what they leave depends on how the angle is linearised.
    agrees::<_, ImplicitEuler<6>>(Frictionless, 1e-4);
    agrees::<_, Extrapolated<2, 4>>(Regularised::new(0.1, 1e-4).unwrap(), 1e-4);
    agrees::<_, ImplicitEuler<6>>(Exact::new(0.1).unwrap(), 1e-4);
    agrees::<_, Rodas3>(Regularised::new(0.1, 1e-3).unwrap(), 2e-5);
}

#[test]
fn refuses_what_it_cannot_step() {
    let made = |mass, inertia, gravity, pin| {
        Floating::new(mass, inertia, Vector2::new(0.0, gravity), &[Vector2::new(pin, 0.0)]).map(drop)
    };
    assert_eq!(made(1.0, 1.0, -9.81, 0.1), Ok(()));
    for (mass, inertia, gravity, pin, parameter) in [
        (0.0, 1.0, 0.0, 1.0, "mass"),
        (1.0, f64::NAN, 0.0, 1.0, "inertia"),
        (1.0, 1.0, f64::INFINITY, 1.0, "gravity"),
        (1.0, 1.0, 0.0, f64::NAN, "pin.position"),
    ] {
        assert_eq!(made(mass, inertia, gravity, pin).unwrap_err().parameter, parameter);
    }
}

const MASS: f64 = 0.08;
const INERTIA: f64 = 3e-4;
const LEVER: f64 = 0.05;
const GRAVITY: f64 = 9.81;

type Pendulum<F> = System<Floating<f64>, Element<Hole<f64>, Journal<f64, Normal, F>, 4>>;

/// A body that hangs from one pin, which is at `pin` (m) from its centre of mass.
fn pendulum<F: Friction<f64>>(pin: Vector2<f64>, friction: F) -> Pendulum<F> {
    let contact = Contact { normal: normal(), friction };
    let body = Floating::new(MASS, INERTIA, Vector2::new(0.0, -GRAVITY), &[pin]).unwrap();
    let law = Journal { clearance: CLEARANCE, radius: RADIUS, contact };
    System::new(body, Element { link: Hole { centre: pin }, law })
}

#[test]
fn hangs_as_deep_as_its_weight_presses() {
    let kernel = Kernel::<_, _, ImplicitEuler<4>>::new(pendulum(Vector2::new(0.0, LEVER), Frictionless), 1e-3).unwrap();
    let mut state = kernel.at_rest::<3>(PlanarPose::nominal());
    for _ in 0..if cfg!(miri) { 2 } else { 2000 } {
        let _ = kernel.step(&mut state);
    }
    let depth = libm::pow(MASS * GRAVITY / STIFFNESS, 2.0 / 3.0);
    let height = state.motion.pose.displacement.y;
    assert!(cfg!(miri) || libm::fabs(height + CLEARANCE + depth) < 1e-9, "{height}");
}

/// In the limit of a stiff pin without clearance it swings about the pin.
#[test]
#[cfg_attr(miri, ignore = "an interpreter has no time for a whole swing")]
fn swings_with_the_period_of_a_physical_pendulum() {
    let kernel =
        Kernel::<_, _, Extrapolated<2, 4>>::new(pendulum(Vector2::new(0.0, LEVER), Frictionless), 1e-4).unwrap();
    let mut state = kernel.at_rest::<3>(PlanarPose::nominal());
    // Settled on its pin, then pushed.
    for _ in 0..5000 {
        let _ = kernel.step(&mut state);
    }
    let rate = 0.05;
    state.motion.velocity = SVector::<f64, 3>::new(rate * LEVER, 0.0, rate);
    let (from, mut crossings, mut last) = (kernel.time(state.steps), 0, 0.0);
    let mut before = state.motion.pose.half_turn[1];
    for _ in 0..30_000 {
        let _ = kernel.step(&mut state);
        let angle = state.motion.pose.half_turn[1];
        if before < 0.0 && angle >= 0.0 {
            crossings += 1;
            last = kernel.time(state.steps) - from;
        }
        before = angle;
    }
    let period = last / f64::from(crossings);
    let about_pin = INERTIA + MASS * LEVER * LEVER;
    let expected = 2.0 * core::f64::consts::PI * libm::sqrt(about_pin / (MASS * GRAVITY * LEVER));
    assert!(crossings >= 3 && libm::fabs(period / expected - 1.0) < 2e-3, "{period} {expected}");
}

/// The pin's middle off the hole's, in the frame's axes. A turn takes (0, 1) towards −x.
fn off([x, z, angle, ..]: [f64; 6]) -> [f64; 2] {
    let (sine, cosine) = libm::sincos(angle);
    [sine * LEVER - x, LEVER - z - cosine * LEVER]
}

/// The motion by the definition of the joint, in the frame's axes, of (x, z, angle) and their rates.
fn rates(friction: f64, stick_band: f64, state: [f64; 6]) -> [f64; 6] {
    let [x, z, _, vx, vz, w] = state;
    let off = off(state);
    let distance = libm::hypot(off[0], off[1]);
    let (mut fx, mut fz, mut torque) = (0.0, 0.0, 0.0);
    if distance > CLEARANCE {
        let normal = off.map(|part| part / distance);
        let tangent = [-normal[1], normal[0]];
        // From the centre of mass to where the pin's rim and the wall meet.
        let lever = [RADIUS * normal[0] - x, LEVER + RADIUS * normal[1] - z];
        let u = [vx - w * lever[1], vz + w * lever[0]];
        let depth = distance - CLEARANCE;
        let s = (depth / 1e-4).min(1.0);
        let damper = 1000.0 * s * s * (3.0 - 2.0 * s);
        let press = STIFFNESS * depth * libm::sqrt(depth) - damper * (u[0] * normal[0] + u[1] * normal[1]);
        let press = press.max(0.0);
        let slide = u[0] * tangent[0] + u[1] * tangent[1];
        let share = (libm::fabs(slide) / stick_band).min(1.0);
        let rub = -friction * press * (share * (3.0 - share * share) / 2.0).copysign(slide);
        fx = press * normal[0] + rub * tangent[0];
        fz = press * normal[1] + rub * tangent[1];
        torque = lever[0] * fz - lever[1] * fx;
    }
    [vx, vz, w, fx / MASS, fz / MASS - GRAVITY, torque / INERTIA]
}

#[test]
#[cfg_attr(miri, ignore = "an interpreter has no time for so many steps")]
fn moves_as_its_definition_says() {
    let (friction, stick_band) = (0.3, 1e-2);
    let pendulum = pendulum(Vector2::new(0.0, LEVER), Regularised::new(friction, stick_band).unwrap());
    let kernel = Kernel::<_, _, Extrapolated<2, 4>>::new(pendulum, 2e-6).unwrap();
    let mut state = kernel.at_rest::<3>(PlanarPose::nominal());
    state.motion.velocity = SVector::<f64, 3>::new(0.01, 0.02, 1.5);
    let mut other = [0.0, 0.0, 0.0, 0.01, 0.02, 1.5];
    let (mut touched, h) = (0, 2e-7);
    for _ in 0..10_000 {
        let _ = kernel.step(&mut state);
        for _ in 0..10 {
            let at = |k: [f64; 6], by: f64| core::array::from_fn(|i| other[i] + by * k[i]);
            let k1 = rates(friction, stick_band, other);
            let k2 = rates(friction, stick_band, at(k1, h / 2.0));
            let k3 = rates(friction, stick_band, at(k2, h / 2.0));
            let k4 = rates(friction, stick_band, at(k3, h));
            other = core::array::from_fn(|i| other[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        }
        let [x, z] = off(other);
        touched += u32::from(libm::hypot(x, z) > CLEARANCE);
        let PlanarPose { displacement, half_turn } = state.motion.pose;
        let miss = [displacement.x - other[0], displacement.y - other[1], 2.0 * libm::asin(half_turn[1]) - other[2]];
        assert!(miss.iter().all(|miss| libm::fabs(*miss) < 1e-7), "{miss:?} at {}", state.steps);
    }
    assert!(touched > 1000, "it meets its pin: {touched}");
}

/// The friction circle: a body holds on its pin while its weight passes within r·sin φ, tan φ = μ, and turns beyond.
#[test]
#[cfg_attr(miri, ignore = "an interpreter has no time for so many steps")]
fn holds_within_the_friction_circle() {
    let friction = 0.3;
    let circle = RADIUS * friction / libm::sqrt(1.0 + friction * friction);
    let turned = |share: f64| {
        let pin = Vector2::new(share * circle, 0.0);
        let kernel = Kernel::<_, _, ImplicitEuler<4>>::new(pendulum(pin, Exact::new(friction).unwrap()), 1e-3);
        let kernel = kernel.unwrap();
        let mut state = kernel.at_rest::<3>(PlanarPose::nominal());
        for _ in 0..2000 {
            let report = kernel.step(&mut state);
            assert!(report.residual < 1e-4, "{share}: {} at {}", report.residual, state.steps);
        }
        libm::fabs(state.motion.pose.half_turn[1])
    };
    // It still rolls to and fro in its clearance, and slips a little while it lands.
    let (held, turned) = (turned(0.95), turned(1.05));
    assert!(held < 0.02 && turned > 0.15, "{held} {turned}");
}
