//! Mechanisms as general solvers want them: systems of first-order equations, with the kernel's forces.

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

/// A pose as numbers.
pub trait Numbers: Sized {
    /// How many.
    const COUNT: usize;

    /// The pose of the first [`Numbers::COUNT`] of `numbers`.
    ///
    /// # Panics
    /// If there are fewer.
    fn read(numbers: &[f64]) -> Self;

    /// Writes the numbers of `self` to the first of `numbers`.
    ///
    /// # Panics
    /// If there are fewer.
    fn write(&self, numbers: &mut [f64]);
}

impl Numbers for Pose<f64> {
    const COUNT: usize = VELOCITY;

    #[inline]
    fn read(numbers: &[f64]) -> Self {
        let [x, y, z, w, a, b, c, ..] = *numbers else { panic!("{} numbers", numbers.len()) };
        Self { displacement_w: Vector3::new(x, y, z), orientation: Orientation { w, v: Vector3::new(a, b, c) } }
    }

    #[inline]
    fn write(&self, numbers: &mut [f64]) {
        numbers[..3].copy_from_slice(self.displacement_w.as_slice());
        numbers[3] = self.orientation.w;
        numbers[4..VELOCITY].copy_from_slice(self.orientation.v.as_slice());
    }
}

impl<const D: usize> Numbers for [[f64; 2]; D] {
    const COUNT: usize = 2 * D;

    #[inline]
    fn read(numbers: &[f64]) -> Self {
        core::array::from_fn(|k| [numbers[2 * k], numbers[2 * k + 1]])
    }

    #[inline]
    fn write(&self, numbers: &mut [f64]) {
        numbers[..Self::COUNT].copy_from_slice(self.as_flattened());
    }
}

impl<const N: usize> Numbers for [Pose<f64>; N] {
    const COUNT: usize = VELOCITY * N;

    #[inline]
    fn read(numbers: &[f64]) -> Self {
        core::array::from_fn(|k| Pose::read(&numbers[VELOCITY * k..]))
    }

    #[inline]
    fn write(&self, numbers: &mut [f64]) {
        self.iter().enumerate().for_each(|(k, pose)| pose.write(&mut numbers[VELOCITY * k..]));
    }
}

/// Writes the `rates` of `state`, numbers of the pose and then velocities, at time `t` (s): Q̇ by the velocities, M·V̇ = force.
/// For laws without internal variables.
///
/// # Panics
/// If there are too few numbers.
#[inline]
pub fn rates_of<M: Mechanism<f64, D, Pose: Numbers>, const D: usize>(
    mechanism: &M,
    t: f64,
    state: &[f64],
    rates: &mut [f64],
) {
    let (of_pose, velocity) = state.split_at(M::Pose::COUNT);
    let (pose, velocity) = (M::Pose::read(of_pose), SVector::<f64, D>::from_column_slice(velocity));
    let force = mechanism.forces(t, &pose, &mechanism.fresh(), &velocity, 1.0, None);
    // So far along the slope that nothing of it is lost beside the pose itself.
    let far = 1024.0 * 1024.0 * 1024.0;
    let (place_rates, accelerations) = rates.split_at_mut(M::Pose::COUNT);
    mechanism.explicit_update(&pose, &velocity, far).write(place_rates);
    place_rates.iter_mut().zip(of_pose).for_each(|(rate, at)| *rate = (*rate - at) / far);
    accelerations.copy_from_slice(mechanism.velocity(&pose, &force).as_slice());
}

/// The rates of a slide's `state` at time `t` (s).
///
/// # Panics
/// If `state` has not [`EQUATIONS`] components.
#[inline]
pub fn rates<E: Elastic<f64>, F: Friction<f64>>(slide: &Slide<f64, E, F>, t: f64, state: &[f64]) -> [f64; EQUATIONS] {
    let mut rates = [0.0; EQUATIONS];
    rates_of(slide, t, state, &mut rates);
    rates
}
