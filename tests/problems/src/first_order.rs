//! A slide as general solvers want it: a system of first-order equations, with the kernel's forces.

use slipfit_core::{
    SVector, Vector3,
    law::{Elastic, Friction},
    mechanism::Mechanism,
    pose::{Orientation, Pose},
    slide::Slide,
};

/// Displacement (m), quaternion (real part first), velocity (m/s), angular velocity in the body (rad/s).
pub const EQUATIONS: usize = 13;
/// Index of the first velocity.
pub const VELOCITY: usize = 7;
/// Index of the velocity along z.
pub const V_Z: usize = 9;

/// The nominal pose, without motion.
pub const AT_REST: [f64; EQUATIONS] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

/// The rates of `state` at time `t` (s): ṙ = v, q̇ = ½ q∘ω, M·V̇ = force. For laws without memory.
///
/// # Panics
/// If `state` has not [`EQUATIONS`] components.
#[inline]
pub fn rates<E: Elastic<f64>, F: Friction<f64>>(slide: &Slide<f64, E, F>, t: f64, state: &[f64]) -> [f64; EQUATIONS] {
    let [x, y, z, w, a, b, c, ref velocity @ ..] = *state else { panic!("{} components", state.len()) };
    let pose = Pose { displacement_w: Vector3::new(x, y, z), orientation: Orientation { w, v: Vector3::new(a, b, c) } };
    let velocity = SVector::<f64, 6>::from_column_slice(velocity);
    let force = slide.forces(t, &pose, &slide.fresh(), &velocity, 1.0, None);
    let acceleration = slide.velocity(&pose, &force);
    // So far along the slope that nothing of it is lost beside the orientation itself.
    let far = 1024.0 * 1024.0 * 1024.0;
    let turned = slide.moved(&pose, &velocity, far).orientation;
    let mut rates = [0.0; EQUATIONS];
    rates[..3].copy_from_slice(&velocity.as_slice()[..3]);
    rates[3] = (turned.w - w) / far;
    rates[4..VELOCITY].copy_from_slice(((turned.v - pose.orientation.v) / far).as_slice());
    rates[VELOCITY..].copy_from_slice(acceleration.as_slice());
    rates
}
