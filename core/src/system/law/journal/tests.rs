//! Derivatives against differences, symmetry, and nothing where nothing touches.

use super::*;
use crate::law::{Exact, Frictionless, Impact, Regularised, ThreeHalves};

const CLEARANCE: f64 = 2e-5;
const RADIUS: f64 = 5e-3;
const WAY: Way<f64> = Way { over: None, mass_rate: 80.0, tangent_share: 1.0 };

/// Where the pin is (m), how it moves against the hole (m/s), and how fast hole and pin turn (rad/s).
type At = [f64; 6];

fn response<F: Friction<f64>>(friction: F, internal: F::Internal, [x, y, u, v, hole, pin]: At) -> Response<f64, 4> {
    let normal = Impact::new(ThreeHalves::new(3e6).unwrap(), 1000.0, 1e-4).unwrap();
    let journal = Journal { clearance: CLEARANCE, radius: RADIUS, contact: Contact { normal, friction } };
    journal.response(0.0, &[x, y, 0.0, 0.0].into(), &[u, v, hole, pin].into(), &internal, WAY).0
}

fn derivatives_are_those_of_the_force<F: Friction<f64>>(friction: F, internal: F::Internal, at: At) {
    let found = response(friction, internal, at);
    for (i, h) in [1e-11, 1e-11, 1e-9, 1e-9, 1e-7, 1e-7].into_iter().enumerate() {
        let moved = |by: f64| {
            let mut at = at;
            at[i] += by;
            response(friction, internal, at).force
        };
        let by_difference = (moved(-h) - moved(h)) / (2.0 * h);
        let told = if i < 2 { found.stiffness.column(i) } else { found.impedance.column(i - 2) };
        for (told, by_difference) in told.iter().zip(&by_difference) {
            let miss = libm::fabs(told - by_difference);
            assert!(miss < 2e-5 * (1.0 + libm::fabs(*by_difference)), "{i}: {told} {by_difference}");
        }
    }
}

#[test]
fn derivatives_are_those_of_the_forces() {
    let at = [2.1e-5, -1.3e-5, -3e-4, -7e-4, 0.02, -0.01];
    derivatives_are_those_of_the_force(Frictionless, (), at);
    derivatives_are_those_of_the_force(Regularised::new(0.3, 2e-3).unwrap(), (), at);
    derivatives_are_those_of_the_force(Regularised::new(0.3, 1e-5).unwrap(), (), at);
    // Sliding, then sticking.
    derivatives_are_those_of_the_force(Exact::new(0.3).unwrap(), [-0.02, 0.0], at);
    let sticking = [2.1e-5, -1.3e-5, -3e-4, -5e-4, -0.12, 0.0];
    derivatives_are_those_of_the_force(Exact::new(0.3).unwrap(), [-1e-3, 0.0], sticking);
}

#[test]
fn is_the_same_all_round_and_nothing_inside() {
    let friction = Regularised::new(0.3, 1e-4).unwrap();
    let [fx, fy, on_hole, on_pin] = response(friction, (), [3e-5, 0.0, 1e-3, 2e-4, 0.1, 0.0]).force.data.0[0];
    for step in 1..12 {
        let (sine, cosine) = libm::sincos(f64::from(step) * core::f64::consts::FRAC_PI_6);
        let turn = |[x, y]: [f64; 2]| [cosine * x - sine * y, sine * x + cosine * y];
        let ([x, y], [u, v], [fx, fy]) = (turn([3e-5, 0.0]), turn([1e-3, 2e-4]), turn([fx, fy]));
        let turned = response(friction, (), [x, y, u, v, 0.1, 0.0]).force;
        let miss = turned - SVector::<f64, 4>::new(fx, fy, on_hole, on_pin);
        assert!(miss.norm() < 1e-12 * turned.norm(), "{turned}");
    }
    for [x, y] in [[0.0, 0.0], [1e-20, 0.0], [0.0, -CLEARANCE], [1.4e-5, 1.4e-5]] {
        for [u, v] in [[0.1, -0.2], [0.0, 0.0]] {
            nothing(response(friction, (), [x, y, u, v, 3.0, 0.0]));
            nothing(response(Frictionless, (), [x, y, u, v, 3.0, 0.0]));
            nothing(response(Exact::new(0.3).unwrap(), [0.0; 2], [x, y, u, v, 0.0, 0.0]));
        }
    }
}

fn nothing(found: Response<f64, 4>) {
    let numbers = found.force.iter().chain(&found.impedance).chain(&found.stiffness);
    assert!(numbers.into_iter().all(|number| *number == 0.0), "{found:?}");
}
