//! A journal: a hole of the body around a pin, the paper's cylindrical joint (Fig. 3).
//!
//! With the radial clearance q and the pin off the hole's middle by ρ the gap is q − |ρ|, and its normal is along ρ. Where
//! the pin is inside there is no force, and so none where ρ = 0 has no direction.

use nalgebra::{Matrix2, Vector2};

use super::{Joint, JointForce, turn::turned};
use crate::{
    ParameterError, Scalar,
    error::bounded,
    law::{Elastic, Friction, Impact},
    mechanism::Way,
};

/// A journal whose middle is the pin at the nominal pose.
///
/// Friction's memory goes round with the pin: it is the force along the wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Journal<S> {
    clearance: S,
}

impl<S: Scalar + PartialOrd> Journal<S> {
    /// A journal of the radial `clearance` (m).
    ///
    /// # Errors
    /// If the clearance is not finite, or out of bounds: a pin that is as wide as its hole or wider is not held by a contact
    /// at one point.
    pub fn new(clearance: S) -> Result<Self, ParameterError<S>> {
        Ok(Self { clearance: bounded("journal.clearance", clearance, [1e-9, 1.0])? })
    }
}

impl<S: Scalar> Joint<S> for Journal<S> {
    #[inline(always)]
    fn force<E: Elastic<S>, F: Friction<S>>(
        &self,
        (contact, friction): (&Impact<S, E>, &F),
        memory: &F::Memory,
        offset: Vector2<S>,
        u: Vector2<S>,
        way: Way<S>,
    ) -> JointForce<S, F::Memory> {
        let zero = S::zero();
        let squared = offset.dot(&offset);
        let per_radius = squared.max_of(S::from_f64(1e-30)).rsqrt();
        let normal = offset * per_radius;
        let tangent = turned(normal);
        let (outward, sliding) = (u.dot(&normal), u.dot(&tangent));
        let wall = contact.response(squared * per_radius - self.clearance, -outward);
        let (traction, memory) = friction.traction(memory, &way.rubbing([sliding, zero], wall.force));
        let ([rub, ..], [rubbing, ..], [per_normal, _]) = (traction.force, traction.impedance, traction.per_normal);

        // In the axes (normal, tangent), which a displacement along the tangent turns by 1/|ρ|.
        let (damping, stiffness) = (wall.impedance(zero), wall.stiffness());
        let pushed_aside = damping * sliding;
        let by_velocity = Matrix2::new(damping, zero, -per_normal * damping, rubbing);
        let by_place = Matrix2::new(
            stiffness,
            -(pushed_aside + rub) * per_radius,
            -per_normal * stiffness,
            (wall.force + rubbing * outward + per_normal * pushed_aside) * per_radius,
        );
        let axes = Matrix2::from_columns(&[normal, tangent]);
        let in_body = |local: Matrix2<S>| axes * local * axes.transpose();
        JointForce {
            force: normal * wall.force + tangent * rub,
            impedance: in_body(by_velocity + by_place * way.a),
            stiffness: in_body(by_place),
            memory,
        }
    }
}

#[cfg(test)]
mod tests {
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
    const STIFFNESS: f64 = 3e6;
    const WAY: Way<f64> = Way { a: 0.0, mass_rate: 80.0, tangent_share: 1.0 };

    fn contact(damping: f64) -> Impact<f64, ThreeHalves<f64>> {
        Impact::new(ThreeHalves::new(STIFFNESS).unwrap(), damping, 1e-4).unwrap()
    }

    fn force<F: Friction<f64>>(
        friction: F,
        memory: F::Memory,
        at: [f64; 2],
        u: [f64; 2],
    ) -> JointForce<f64, F::Memory> {
        let journal = Journal::new(CLEARANCE).unwrap();
        journal.force((&contact(1000.0), &friction), &memory, Vector2::from(at), Vector2::from(u), WAY)
    }

    fn slopes_are_derivatives<F: Friction<f64>>(friction: F, memory: F::Memory) {
        let (at, u) = ([2.1e-5, -1.3e-5], [3e-4, 7e-4]);
        let JointForce { impedance, stiffness, .. } = force(friction, memory, at, u);
        for column in 0..2 {
            let moved = |x: [f64; 2], by: f64| {
                let mut x = x;
                x[column] += by;
                x
            };
            let by_u = |h: f64| force(friction, memory, at, moved(u, h)).force;
            // The body's displacement moves the pin the other way, as seen from it.
            let by_x = |h: f64| force(friction, memory, moved(at, -h), u).force;
            let (hu, hx) = (1e-8, 1e-11);
            let (slope_u, slope_x) = ((by_u(-hu) - by_u(hu)) / (2.0 * hu), (by_x(-hx) - by_x(hx)) / (2.0 * hx));
            for row in 0..2 {
                let (found, slope) = (impedance[(row, column)], slope_u[row]);
                assert!(
                    libm::fabs(found - slope) < 1e-5 * (1.0 + libm::fabs(slope)),
                    "u {row} {column}: {found} {slope}"
                );
                let (found, slope) = (stiffness[(row, column)], slope_x[row]);
                assert!(
                    libm::fabs(found - slope) < 1e-5 * (1.0 + libm::fabs(slope)),
                    "x {row} {column}: {found} {slope}"
                );
            }
        }
    }

    #[test]
    fn slopes_are_derivatives_of_force() {
        slopes_are_derivatives(Frictionless, ());
        slopes_are_derivatives(Regularised::new(0.3, 2e-3).unwrap(), ());
        slopes_are_derivatives(Regularised::new(0.3, 1e-5).unwrap(), ());
        slopes_are_derivatives(Exact::new(0.3).unwrap(), [0.02, 0.0]);
    }

    #[test]
    fn is_the_same_all_round_and_nothing_inside() {
        let friction = Regularised::new(0.3, 1e-4).unwrap();
        let first = force(friction, (), [3e-5, 0.0], [1e-3, 2e-4]).force;
        for step in 1..12 {
            let (sine, cosine) = libm::sincos(f64::from(step) * core::f64::consts::FRAC_PI_6);
            let turn = |[x, z]: [f64; 2]| [cosine * x - sine * z, sine * x + cosine * z];
            let turned = force(friction, (), turn([3e-5, 0.0]), turn([1e-3, 2e-4])).force;
            assert!((turned - Vector2::from(turn([first.x, first.y]))).norm() < 1e-12 * first.norm());
        }
        for at in [[0.0, 0.0], [1e-20, 0.0], [0.0, -CLEARANCE], [1.4e-5, 1.4e-5]] {
            let inside = force(friction, (), at, [0.1, -0.2]);
            assert_eq!((inside.force.x, inside.force.y), (0.0, 0.0));
            assert!(inside.impedance.iter().chain(&inside.stiffness).all(|slope| *slope == 0.0), "{at:?}");
        }
        assert_eq!(Journal::new(0.0).map(|_| ()).unwrap_err().parameter, "journal.clearance");
        assert!(Journal::new(f64::NAN).is_err());
    }

    const MASS: f64 = 0.08;
    const INERTIA: f64 = 3e-4;
    const LEVER: f64 = 0.05;
    const GRAVITY: f64 = 9.81;

    /// A body that hangs from one pin.
    fn pendulum<F: Friction<f64>>(damping: f64, friction: F) -> Planar<f64, Journal<f64>, ThreeHalves<f64>, F, 1> {
        let body = PlanarBody {
            mass: MASS,
            inertia: INERTIA,
            gravity_w: Vector2::new(0.0, -GRAVITY),
            pins_w: [Vector2::new(0.0, LEVER)],
            joints: [Journal::new(CLEARANCE).unwrap()],
        };
        let drive = Drive { gain: 0.0, ramp_start: 0.0, ramp_end: 1.0, speed: 0.0, point_b: Vector3::zeros() };
        Planar::new(body, contact(damping), friction, drive).unwrap()
    }

    #[test]
    fn hangs_as_deep_as_its_weight_presses() {
        let kernel = Kernel::<_, _, ImplicitEuler<4>>::new(pendulum(1000.0, Frictionless), 1e-3).unwrap();
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
        let kernel = Kernel::<_, _, Extrapolated<2, 4>>::new(pendulum(1000.0, Frictionless), 1e-4).unwrap();
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

    /// The motion by the definition of the joint, in the frame's axes, of (x, z, angle) and their rates.
    fn rates(friction: f64, stick_band: f64, [x, z, angle, vx, vz, w]: [f64; 6]) -> [f64; 6] {
        // A turn by the angle about y = z × x takes (0, 1) towards x.
        let (sine, cosine) = libm::sincos(angle);
        let (pin, middle) = ([0.0, LEVER], [x + sine * LEVER, z + cosine * LEVER]);
        let off = [pin[0] - middle[0], pin[1] - middle[1]];
        let radius = libm::hypot(off[0], off[1]);
        let (mut fx, mut fz) = (0.0, 0.0);
        let lever = [pin[0] - x, pin[1] - z];
        if radius > CLEARANCE {
            let normal = off.map(|part| part / radius);
            let tangent = [-normal[1], normal[0]];
            let u = [vx + w * lever[1], vz - w * lever[0]];
            let depth = radius - CLEARANCE;
            let s = (depth / 1e-4).min(1.0);
            let damper = 1000.0 * s * s * (3.0 - 2.0 * s);
            let press = STIFFNESS * depth * libm::sqrt(depth) - damper * (u[0] * normal[0] + u[1] * normal[1]);
            let press = press.max(0.0);
            let slide = u[0] * tangent[0] + u[1] * tangent[1];
            let share = (libm::fabs(slide) / stick_band).min(1.0);
            let rub = -friction * press * (share * (3.0 - share * share) / 2.0).copysign(slide);
            fx = press * normal[0] + rub * tangent[0];
            fz = press * normal[1] + rub * tangent[1];
        }
        let torque = lever[1] * fx - lever[0] * fz;
        [vx, vz, w, fx / MASS, fz / MASS - GRAVITY, torque / INERTIA]
    }

    #[test]
    #[cfg_attr(miri, ignore = "an interpreter has no time for so many steps")]
    fn moves_as_its_definition_says() {
        let (friction, stick_band) = (0.3, 1e-2);
        let pendulum = pendulum(1000.0, Regularised::new(friction, stick_band).unwrap());
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
            touched += u32::from(libm::hypot(other[0] + LEVER * other[2], other[1]) > CLEARANCE);
            let PlanarPose { displacement_w, half_turn } = state.motion.pose;
            let miss =
                [displacement_w.x - other[0], displacement_w.y - other[1], 2.0 * libm::asin(half_turn[1]) - other[2]];
            assert!(miss.iter().all(|miss| libm::fabs(*miss) < 1e-7), "{miss:?} at {}", state.steps);
        }
        assert!(touched > 1000, "it meets its pin: {touched}");
    }
}
