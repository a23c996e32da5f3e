//! Against the definition of the joint, a pendulum, and the friction circle.

use super::*;
use crate::{
    SVector, Vector3,
    drive::Drive,
    integrator::{Extrapolated, ImplicitEuler},
    kernel::Kernel,
    law::{Exact, Frictionless, Regularised, ThreeHalves},
    planar::{Planar, PlanarBody, PlanarPose},
};

const CLEARANCE: f64 = 2e-5;
const RADIUS: f64 = 5e-3;
const STIFFNESS: f64 = 3e6;
const WAY: Way<f64> = Way { a: 0.0, mass_rate: 80.0, tangent_share: 1.0 };

fn contact(damping: f64) -> Impact<f64, ThreeHalves<f64>> {
    Impact::new(ThreeHalves::new(STIFFNESS).unwrap(), damping, 1e-4).unwrap()
}

/// At an offset, a velocity and an angular velocity.
fn force<F: Friction<f64>>(friction: F, memory: F::Memory, at: [f64; 5]) -> JointForce<f64, F::Memory> {
    let [x, z, ux, uz, rotation] = at;
    let pin = SeenPin { offset: Vector2::new(x, z), u: Vector2::new(ux, uz), rotation };
    Journal::new(CLEARANCE, RADIUS).unwrap().force((&contact(1000.0), &friction), &memory, &pin, WAY)
}

fn slopes_are_derivatives<F: Friction<f64>>(friction: F, memory: F::Memory, at: [f64; 5]) {
    let three = |force: JointForce<f64, F::Memory>| [force.force.x, force.force.y, force.moment.unwrap().torque];
    let (found, h) = (force(friction, memory, at), [1e-11, 1e-11, 1e-9, 1e-9, 1e-7]);
    let moment = found.moment.unwrap();
    for i in 0..5 {
        // The body's displacement moves the pin the other way, as seen from it.
        let h = if i < 2 { -h[i] } else { h[i] };
        let moved = |by: f64| {
            let mut at = at;
            at[i] += by;
            three(force(friction, memory, at))
        };
        let (ahead, behind) = (moved(h), moved(-h));
        let column = |matrix: Matrix2<f64>, row: Vector2<f64>, j: usize| [matrix[(0, j)], matrix[(1, j)], row[j]];
        let found = match i {
            0 | 1 => column(found.stiffness, moment.stiffness, i),
            2 | 3 => column(found.impedance, moment.impedance, i - 2),
            _ => [moment.force_by_rotation.x, moment.force_by_rotation.y, moment.torque_by_rotation],
        };
        for row in 0..3 {
            let (found, slope) = (found[row], (behind[row] - ahead[row]) / (2.0 * h.abs()));
            assert!(libm::fabs(found - slope) < 2e-5 * (1.0 + libm::fabs(slope)), "{row} {i}: {found} {slope}");
        }
    }
}

#[test]
fn slopes_are_derivatives_of_force_and_torque() {
    let at = [2.1e-5, -1.3e-5, 3e-4, 7e-4, 0.02];
    slopes_are_derivatives(Frictionless, (), at);
    slopes_are_derivatives(Regularised::new(0.3, 2e-3).unwrap(), (), at);
    slopes_are_derivatives(Regularised::new(0.3, 1e-5).unwrap(), (), at);
    // Sliding, then sticking.
    slopes_are_derivatives(Exact::new(0.3).unwrap(), [0.02, 0.0], at);
    slopes_are_derivatives(Exact::new(0.3).unwrap(), [1e-3, 0.0], [2.1e-5, -1.3e-5, 3e-4, 5e-4, -0.12]);
}

#[test]
fn is_the_same_all_round_and_nothing_inside() {
    let friction = Regularised::new(0.3, 1e-4).unwrap();
    let first = force(friction, (), [3e-5, 0.0, 1e-3, 2e-4, 0.1]);
    for step in 1..12 {
        let (sine, cosine) = libm::sincos(f64::from(step) * core::f64::consts::FRAC_PI_6);
        let turn = |[x, z]: [f64; 2]| [cosine * x - sine * z, sine * x + cosine * z];
        let ([x, z], [ux, uz]) = (turn([3e-5, 0.0]), turn([1e-3, 2e-4]));
        let turned = force(friction, (), [x, z, ux, uz, 0.1]);
        let miss = turned.force - Vector2::from(turn([first.force.x, first.force.y]));
        assert!(miss.norm() < 1e-12 * first.force.norm());
        let torque = first.moment.unwrap().torque;
        assert!(libm::fabs(turned.moment.unwrap().torque - torque) < 1e-12 * libm::fabs(torque));
    }
    for [x, z] in [[0.0, 0.0], [1e-20, 0.0], [0.0, -CLEARANCE], [1.4e-5, 1.4e-5]] {
        for [ux, uz] in [[0.1, -0.2], [0.0, 0.0]] {
            nothing(force(friction, (), [x, z, ux, uz, 3.0]));
            nothing(force(Exact::new(0.3).unwrap(), [0.0; 2], [x, z, ux, uz, 0.0]));
        }
    }
    assert_eq!(Journal::new(0.0, 0.0).map(|_| ()).unwrap_err().parameter, "journal.clearance");
    assert_eq!(Journal::new(1e-5, -1.0).map(|_| ()).unwrap_err().parameter, "journal.radius");
    assert!(Journal::new(f64::NAN, 0.0).is_err());
}

fn nothing<M>(found: JointForce<f64, M>) {
    let moment = found.moment.unwrap();
    let slopes = found.impedance.iter().chain(&found.stiffness).chain(&moment.impedance).chain(&moment.stiffness);
    assert!(slopes.chain(&found.force).all(|number| *number == 0.0) && moment.torque == 0.0);
}

const MASS: f64 = 0.08;
const INERTIA: f64 = 3e-4;
const LEVER: f64 = 0.05;
const GRAVITY: f64 = 9.81;

/// A body that hangs from one pin, which is at `pin` (m) from its centre of mass.
fn pendulum<F: Friction<f64>>(
    radius: f64,
    pin: Vector2<f64>,
    friction: F,
) -> Planar<f64, Journal<f64>, ThreeHalves<f64>, F, 1> {
    let body = PlanarBody {
        mass: MASS,
        inertia: INERTIA,
        gravity_w: Vector2::new(0.0, -GRAVITY),
        pins_w: [pin],
        joints: [Journal::new(CLEARANCE, radius).unwrap()],
    };
    let drive = Drive { gain: 0.0, ramp_start: 0.0, ramp_end: 1.0, speed: 0.0, point_b: Vector3::zeros() };
    Planar::new(body, contact(1000.0), friction, drive).unwrap()
}

#[test]
fn hangs_as_deep_as_its_weight_presses() {
    let kernel =
        Kernel::<_, _, ImplicitEuler<4>>::new(pendulum(RADIUS, Vector2::new(0.0, LEVER), Frictionless), 1e-3).unwrap();
    let mut state = kernel.at_rest::<3>(PlanarPose::nominal());
    for _ in 0..if cfg!(miri) { 2 } else { 2000 } {
        kernel.step(&mut state);
    }
    let depth = libm::pow(MASS * GRAVITY / STIFFNESS, 2.0 / 3.0);
    let height = state.motion.pose.displacement_w.y;
    assert!(cfg!(miri) || libm::fabs(height + CLEARANCE + depth) < 1e-9, "{height}");
}

/// In the limit of a stiff pin without clearance it swings about the pin.
#[test]
#[cfg_attr(miri, ignore = "an interpreter has no time for a whole swing")]
fn swings_with_the_period_of_a_physical_pendulum() {
    let kernel =
        Kernel::<_, _, Extrapolated<2, 4>>::new(pendulum(RADIUS, Vector2::new(0.0, LEVER), Frictionless), 1e-4)
            .unwrap();
    let mut state = kernel.at_rest::<3>(PlanarPose::nominal());
    // Settled on its pin, then pushed.
    for _ in 0..5000 {
        kernel.step(&mut state);
    }
    let rate = 0.05;
    state.motion.velocity = SVector::<f64, 3>::new(-rate * LEVER, 0.0, rate);
    let (from, mut crossings, mut last) = (kernel.time(state.steps), 0, 0.0);
    let mut before = state.motion.pose.half_turn[1];
    for _ in 0..30_000 {
        kernel.step(&mut state);
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

/// The pin's middle off the hole's, in the frame's axes. A turn by the angle about y = z × x takes (0, 1) towards x.
fn off([x, z, angle, ..]: [f64; 6]) -> [f64; 2] {
    let (sine, cosine) = libm::sincos(angle);
    [-x - sine * LEVER, LEVER - z - cosine * LEVER]
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
        let u = [vx + w * lever[1], vz - w * lever[0]];
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
        torque = lever[1] * fx - lever[0] * fz;
    }
    [vx, vz, w, fx / MASS, fz / MASS - GRAVITY, torque / INERTIA]
}

#[test]
#[cfg_attr(miri, ignore = "an interpreter has no time for so many steps")]
fn moves_as_its_definition_says() {
    let (friction, stick_band) = (0.3, 1e-2);
    let pendulum = pendulum(RADIUS, Vector2::new(0.0, LEVER), Regularised::new(friction, stick_band).unwrap());
    let kernel = Kernel::<_, _, Extrapolated<2, 4>>::new(pendulum, 2e-6).unwrap();
    let mut state = kernel.at_rest::<3>(PlanarPose::nominal());
    state.motion.velocity = SVector::<f64, 3>::new(0.01, 0.02, 1.5);
    let mut other = [0.0, 0.0, 0.0, 0.01, 0.02, 1.5];
    let (mut touched, h) = (0, 2e-7);
    for _ in 0..10_000 {
        kernel.step(&mut state);
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
        let PlanarPose { displacement_w, half_turn } = state.motion.pose;
        let miss =
            [displacement_w.x - other[0], displacement_w.y - other[1], 2.0 * libm::asin(half_turn[1]) - other[2]];
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
        let kernel = Kernel::<_, _, ImplicitEuler<4>>::new(pendulum(RADIUS, pin, Exact::new(friction).unwrap()), 1e-3);
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
