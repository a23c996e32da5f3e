//! One body in space among pins of the frame.
//!
//! Its elements add up in its own axes, in which its walls stand still and run along these axes: a step takes a small part of that
//! of free bodies. Seen from the body, small displacements are differences of small numbers, so that f32 keeps its digits.

mod pin;
mod pull;

use nalgebra::Matrix3;

use crate::{
    ParameterError, SVector, Scalar, Vector3,
    error::bounded,
    linear::{Blocks, Factors},
    pose::{Pose, ToBody, turn_rate},
    product::{cross, dot, mapped},
    system::{AbreastBodies, Axes, Bodies, Jacobian, Lanes, everywhere},
};

pub use pin::PinOfFrame;
pub use pull::Pull;

/// A body with its inertia and gravity. Errors name its parameters as the keys of a slide's scene.
///
/// Its generalised velocities are the velocity of the centre of mass in the frame (m/s) and the angular velocity in the body
/// (rad/s), so that the mass matrix is constant and free flight is exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floating<S> {
    mass: S,
    inertia_b: Vector3<S>,
    gravity_w: Vector3<S>,
    /// 1/m.
    per_lever: S,
}

impl<S: Scalar + PartialOrd> Floating<S> {
    /// A body of `mass` (kg) and principal moments of inertia about the centre of mass (kg·m²), along its axes, under `gravity_w`
    /// (m/s²). Its angles are compared with displacements by the distance of the farthest of its pins, which are at `pins_w` (m)
    /// from the centre of mass at the nominal pose.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn new(
        mass: S,
        inertia_b: Vector3<S>,
        gravity_w: Vector3<S>,
        pins_w: &[Vector3<S>],
    ) -> Result<Self, ParameterError<S>> {
        bounded("slide.mass", mass, [1e-6, 1e6])?;
        for moment in inertia_b.iter() {
            bounded("slide.inertia", *moment, [1e-12, 1e9])?;
        }
        for component in gravity_w.iter() {
            bounded("slide.gravity", *component, [-1e4, 1e4])?;
        }
        let mut farthest = S::from_f64(1e-6);
        for pin in pins_w {
            farthest = farthest.max_of(distance(pin)?);
        }
        Ok(Self { mass, inertia_b, gravity_w, per_lever: S::one() / farthest })
    }
}

/// How far a pin is from the centre of mass (m).
#[inline(never)] // For size: the loop over pins is unrolled, and takes half a kilobyte more with this in it.
fn distance<S: Scalar + PartialOrd>(pin: &Vector3<S>) -> Result<S, ParameterError<S>> {
    for component in pin.iter() {
        bounded("pin.position", *component, [-1e3, 1e3])?;
    }
    Ok(pin.dot(pin).sqrt())
}

impl<S> Floating<S> {
    /// Gravity (m/s²).
    pub fn gravity_w(&self) -> &Vector3<S> {
        &self.gravity_w
    }
}

/// Where the body is and how it moves, in its axes.
#[derive(Clone, Copy, Debug)]
pub struct Placed<S> {
    /// From the frame into the body.
    to_body: ToBody<S>,
    /// Displacement of the centre of mass (m).
    displacement_b: Vector3<S>,
    /// Velocity of the centre of mass (m/s).
    velocity_b: Vector3<S>,
    /// The same in the frame, along z.
    velocity_z: S,
    /// Angular velocity (rad/s).
    rotation_b: Vector3<S>,
}

impl<S: Scalar> Placed<S> {
    /// The same in numbers of another type.
    #[inline(always)]
    fn cast<T: Scalar>(&self, number: impl Fn(S) -> T) -> Placed<T> {
        Placed {
            to_body: self.to_body.cast(&number),
            displacement_b: mapped(&self.displacement_b, &number),
            velocity_b: mapped(&self.velocity_b, &number),
            velocity_z: number(self.velocity_z),
            rotation_b: mapped(&self.rotation_b, &number),
        }
    }
}

impl<S: Scalar, L: Lanes<S>> AbreastBodies<S, L, 6> for Floating<S> {
    type Lanes = Floating<L>;

    #[inline(always)]
    fn everywhere(placed: &Placed<S>) -> Placed<L> {
        placed.cast(everywhere)
    }

    #[inline(always)]
    fn summed(jacobian: &Blocks<L>) -> Blocks<S> {
        jacobian.cast(L::sum)
    }
}

#[inline(always)]
pub(crate) fn split<S: Scalar>(v: &SVector<S, 6>) -> (Vector3<S>, Vector3<S>) {
    let [a, b, c, d, e, f] = v.data.0[0];
    (Vector3::new(a, b, c), Vector3::new(d, e, f))
}

#[inline(always)]
fn join<S: Scalar>(a: Vector3<S>, b: Vector3<S>) -> SVector<S, 6> {
    SVector::<S, 6>::new(a.x, a.y, a.z, b.x, b.y, b.z)
}

/// Adds a force and a torque about the centre of mass.
#[inline(always)]
fn add<S: Scalar>(force: &Vector3<S>, torque: &Vector3<S>, sum: &mut SVector<S, 6>) {
    let (f, g) = split(sum);
    *sum = join(f + force, g + torque);
}

impl<S: Scalar> Default for ToBody<S> {
    #[inline(always)]
    fn default() -> Self {
        Pose::nominal().to_body()
    }
}

impl<S: Scalar> Axes<S, 6> for ToBody<S> {
    #[inline(always)]
    fn to_sum(&self, v: &SVector<S, 6>) -> SVector<S, 6> {
        let (a, b) = split(v);
        join(self.apply(a), b)
    }

    #[inline(always)]
    fn to_velocities(&self, v: &SVector<S, 6>) -> SVector<S, 6> {
        let (a, b) = split(v);
        join(self.apply_inverse(a), b)
    }
}

impl<S: Scalar> Default for Factors<S> {
    #[inline(always)]
    fn default() -> Self {
        let zero = Matrix3::zeros();
        Self { inverse_a: zero, b: zero, c_over_a: zero, inverse_rest: zero }
    }
}

impl<S: Scalar> Jacobian<S, 6> for Blocks<S> {
    type Factors = Factors<S>;

    #[inline(always)]
    fn zero() -> Self {
        Self::diagonal(Vector3::zeros(), Vector3::zeros())
    }

    #[inline(always)]
    fn plus(&self, other: &Self, weight: S) -> Self {
        self.plus(other, weight)
    }

    #[inline(always)]
    fn times(&self, v: &SVector<S, 6>) -> SVector<S, 6> {
        let (x, y) = split(v);
        let (f, g) = self.times(x, y);
        join(f, g)
    }

    #[inline(always)]
    fn factorised(&self) -> Factors<S> {
        self.factorised()
    }

    #[inline(always)]
    fn solve(factors: &Factors<S>, b: &SVector<S, 6>) -> SVector<S, 6> {
        let (f, g) = split(b);
        let (x, y) = factors.solve(f, g);
        join(x, y)
    }
}

impl<S: Scalar> Bodies<S, 6> for Floating<S> {
    type Pose = Pose<S>;
    type Placed = Placed<S>;
    type Mass = ();
    type Axes = ToBody<S>;
    type Jacobian = Blocks<S>;

    const MASS_IS_CONSTANT: bool = true;

    const MATRIX_IS_LEAN: bool = true;

    #[inline(always)]
    fn implicit_update(&self, pose: &Pose<S>, velocity: &SVector<S, 6>, dt: S) -> Pose<S> {
        let (v_w, w_b) = split(velocity);
        pose.implicit_update(v_w, w_b, dt)
    }

    #[inline(always)]
    fn explicit_update(&self, pose: &Pose<S>, velocity: &SVector<S, 6>, dt: S) -> Pose<S> {
        let (v_w, w_b) = split(velocity);
        pose.explicit_update(v_w, w_b, dt)
    }

    #[inline(always)]
    fn shifted(&self, base: &Pose<S>, from: &Pose<S>, to: &Pose<S>, weight: S) -> Pose<S> {
        base.shifted(from, to, weight)
    }

    #[inline(always)]
    fn normalised(&self, pose: &Pose<S>) -> Pose<S> {
        pose.normalised()
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &Pose<S>, kept: &mut Pose<S>) {
        *kept = next.or_old(condition, kept);
    }

    #[inline(always)]
    fn finiteness_probe(&self, pose: &Pose<S>) -> S {
        pose.finiteness_probe()
    }

    /// How it goes by the turn itself is left out of the derivatives, see [`Bodies::displacement`]: among its pins the body turns too
    /// slowly for it to count, and a controller would pay for it.
    #[inline(always)]
    fn rate(&self, displacement: &SVector<S, 6>, velocity: &SVector<S, 6>) -> SVector<S, 6> {
        let ((_, turn_b), (v_w, w_b)) = (split(displacement), split(velocity));
        join(v_w, turn_rate(&turn_b, &w_b))
    }

    #[inline(always)]
    fn placed(&self, pose: &Pose<S>, velocity: &SVector<S, 6>) -> Placed<S> {
        let (v_w, rotation_b) = split(velocity);
        let to_body = pose.to_body();
        Placed {
            displacement_b: to_body.apply(pose.displacement_w),
            velocity_b: to_body.apply(v_w),
            velocity_z: v_w.z,
            rotation_b,
            to_body,
        }
    }

    #[inline(always)]
    fn axes(&self, placed: &Placed<S>) -> ToBody<S> {
        placed.to_body
    }

    #[inline(always)]
    fn mass(&self, _: &Placed<S>) {}

    #[inline(always)]
    fn inertia(&self, (): &(), rate: S) -> Blocks<S> {
        let mass = self.mass * rate;
        Blocks::diagonal(Vector3::new(mass, mass, mass), self.inertia_b * rate)
    }

    #[inline(always)]
    fn momentum(&self, (): &(), velocity: &SVector<S, 6>) -> SVector<S, 6> {
        let (v_w, w_b) = split(velocity);
        join(v_w * self.mass, w_b.component_mul(&self.inertia_b))
    }

    #[inline(always)]
    fn velocity(&self, (): &(), momentum: &SVector<S, 6>) -> SVector<S, 6> {
        let (p_w, l_b) = split(momentum);
        join(p_w / self.mass, l_b.component_div(&self.inertia_b))
    }

    #[inline(always)]
    fn own_force(&self, _: &Placed<S>) -> SVector<S, 6> {
        SVector::zeros()
    }

    #[inline(always)]
    fn total(&self, placed: &Placed<S>, sum: &SVector<S, 6>) -> SVector<S, 6> {
        let gyroscopic = cross(&placed.rotation_b, &placed.rotation_b.component_mul(&self.inertia_b));
        let (force_b, torque_b) = split(sum);
        join(placed.to_body.apply_inverse(force_b) + self.gravity_w * self.mass, torque_b - gyroscopic)
    }

    /// How the gyroscopic torque changes is left out.
    #[inline(always)]
    fn own_jacobians(&self, _: &Placed<S>, (): &(), _: &SVector<S, 6>, _: &mut Blocks<S>, _: &mut Blocks<S>) {}

    #[inline(always)]
    fn least_mass(&self) -> S {
        self.mass
    }

    #[inline(always)]
    fn per_lever(&self) -> SVector<S, 6> {
        let one = S::one();
        join(Vector3::new(one, one, one), Vector3::new(self.per_lever, self.per_lever, self.per_lever))
    }

    #[inline(always)]
    fn impulse(&self, imbalance: &SVector<S, 6>) -> S {
        let (p, l) = split(imbalance);
        (dot(&p, &p) + dot(&l, &l) * self.per_lever * self.per_lever).sqrt()
    }

    #[inline(always)]
    fn weighed(&self, change: &SVector<S, 6>) -> S {
        self.impulse(&self.momentum(&(), change))
    }
}
