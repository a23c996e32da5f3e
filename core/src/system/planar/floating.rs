//! One body in a plane that no ideal joint holds, among pins of the frame.
//!
//! Its elements add up in its own axes, in which holes and slots stand still: a step takes less than that of the same body as a
//! tree of coordinates.

mod hole;
mod pin;
mod pull;
mod turn;

use crate::{
    ParameterError, SMatrix, SVector, Scalar, Vector2,
    error::bounded,
    system::{Axes, Bodies, half_turn, jacobian::Own},
};

pub use hole::Hole;
pub use pin::Pin;
pub use pull::Pull;
pub use turn::Turn;

use super::left;

/// A body with its inertia and gravity.
///
/// Its generalised velocities are the velocity of the centre of mass in the frame (m/s) and the angular velocity (rad/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floating<S> {
    mass: S,
    inertia: S,
    gravity: Vector2<S>,
    /// 1/m.
    per_lever: S,
}

impl<S: Scalar + PartialOrd> Floating<S> {
    /// A body of `mass` (kg) and moment of `inertia` about the centre of mass (kg·m²) under `gravity` (m/s²). Its
    /// angles are compared with displacements by the distance of the farthest of its `pins`, which are told from the centre of mass at
    /// the nominal pose (m).
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn new(mass: S, inertia: S, gravity: Vector2<S>, pins: &[Vector2<S>]) -> Result<Self, ParameterError<S>> {
        for component in gravity.iter() {
            bounded("gravity", *component, [-1e4, 1e4])?;
        }
        let mut farthest = S::from_f64(1e-6);
        for pin in pins {
            for component in pin.iter() {
                bounded("pin.position", *component, [-1e3, 1e3])?;
            }
            farthest = farthest.max_of(pin.dot(pin).sqrt());
        }
        Ok(Self {
            mass: bounded("mass", mass, [1e-6, 1e6])?,
            inertia: bounded("inertia", inertia, [1e-12, 1e9])?,
            gravity,
            per_lever: S::one() / farthest,
        })
    }
}

/// Displacement from the nominal pose. The body has turned by twice the angle whose cosine and sine `half_turn` holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarPose<S> {
    /// Displacement of the centre of mass (m).
    pub displacement: Vector2<S>,
    /// Cosine and sine of half the angle. Kept near unit length, never assumed to have it exactly.
    pub half_turn: [S; 2],
}

impl<S: Scalar> PlanarPose<S> {
    /// The nominal pose.
    pub fn nominal() -> Self {
        Self { displacement: Vector2::zeros(), half_turn: [S::one(), S::zero()] }
    }
}

/// Where the body is and how it moves, in its axes.
#[derive(Clone, Copy, Debug)]
pub struct Placed<S> {
    turn: Turn<S>,
    displacement: Vector2<S>,
    velocity: Vector2<S>,
    rotation: S,
}

impl<S: Scalar> Placed<S> {
    /// The velocity of the body's material at `lever` from the centre of mass.
    #[inline(always)]
    fn velocity_at(&self, lever: &Vector2<S>) -> Vector2<S> {
        self.velocity + left(lever) * self.rotation
    }
}

/// Adds the force `f` at `lever` from the centre of mass.
#[inline(always)]
fn add_at<S: Scalar>(lever: &Vector2<S>, f: &Vector2<S>, sum: &mut SVector<S, 3>) {
    sum.x += f.x;
    sum.y += f.y;
    sum.z += left(lever).dot(f);
}

impl<S: Scalar> Bodies<S, 3> for Floating<S> {
    type Pose = PlanarPose<S>;
    type Placed = Placed<S>;
    type Mass = ();
    type Axes = Turn<S>;
    type Jacobian = Own<S, 3>;

    const MASS_IS_CONSTANT: bool = true;

    const MATRIX_IS_LEAN: bool = true;

    #[inline(always)]
    fn implicit_update(&self, pose: &PlanarPose<S>, velocity: &SVector<S, 3>, dt: S) -> PlanarPose<S> {
        let PlanarPose { displacement, half_turn } = self.explicit_update(pose, velocity, dt);
        PlanarPose { displacement, half_turn: half_turn::shortened(half_turn, velocity.z * dt * S::from_f64(0.5)) }
    }

    #[inline(always)]
    fn explicit_update(&self, pose: &PlanarPose<S>, velocity: &SVector<S, 3>, dt: S) -> PlanarPose<S> {
        PlanarPose {
            displacement: pose.displacement + Vector2::new(velocity.x, velocity.y) * dt,
            half_turn: half_turn::turned_on(pose.half_turn, velocity.z * dt * S::from_f64(0.5)),
        }
    }

    #[inline(always)]
    fn shifted(&self, base: &PlanarPose<S>, from: &PlanarPose<S>, to: &PlanarPose<S>, weight: S) -> PlanarPose<S> {
        let turned = |i: usize| base.half_turn[i] + (to.half_turn[i] - from.half_turn[i]) * weight;
        PlanarPose {
            displacement: base.displacement + (to.displacement - from.displacement) * weight,
            half_turn: [turned(0), turned(1)],
        }
    }

    #[inline(always)]
    fn normalised(&self, pose: &PlanarPose<S>) -> PlanarPose<S> {
        PlanarPose { half_turn: half_turn::normalised(pose.half_turn), ..*pose }
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &PlanarPose<S>, kept: &mut PlanarPose<S>) {
        let either = |new: S, old| new.or_old(condition, old);
        *kept = PlanarPose {
            displacement: next.displacement.zip_map(&kept.displacement, either),
            half_turn: [either(next.half_turn[0], kept.half_turn[0]), either(next.half_turn[1], kept.half_turn[1])],
        };
    }

    #[inline(always)]
    fn finiteness_probe(&self, PlanarPose { displacement, half_turn: [w, v] }: &PlanarPose<S>) -> S {
        let zero = S::zero();
        displacement.x * zero + displacement.y * zero + *w * zero + *v * zero
    }

    #[inline(always)]
    fn rate(&self, displacement: &SVector<S, 3>, velocity: &SVector<S, 3>) -> SVector<S, 3> {
        SVector::<S, 3>::new(velocity.x, velocity.y, half_turn::angle_rate(displacement.z, velocity.z))
    }

    #[inline(always)]
    fn placed(&self, pose: &PlanarPose<S>, velocity: &SVector<S, 3>) -> Placed<S> {
        let turn = Turn::of(pose.half_turn);
        Placed {
            turn,
            displacement: turn.to_body(&pose.displacement),
            velocity: turn.to_body(&Vector2::new(velocity.x, velocity.y)),
            rotation: velocity.z,
        }
    }

    #[inline(always)]
    fn axes(&self, placed: &Placed<S>) -> Turn<S> {
        placed.turn
    }

    #[inline(always)]
    fn mass(&self, _: &Placed<S>) {}

    #[inline(always)]
    fn inertia(&self, (): &(), rate: S) -> Own<S, 3> {
        let mass = self.mass * rate;
        Own(SMatrix::<S, 3, 3>::from_diagonal(&SVector::<S, 3>::new(mass, mass, self.inertia * rate)))
    }

    #[inline(always)]
    fn momentum(&self, (): &(), v: &SVector<S, 3>) -> SVector<S, 3> {
        SVector::<S, 3>::new(v.x * self.mass, v.y * self.mass, v.z * self.inertia)
    }

    #[inline(always)]
    fn velocity(&self, (): &(), p: &SVector<S, 3>) -> SVector<S, 3> {
        SVector::<S, 3>::new(p.x / self.mass, p.y / self.mass, p.z / self.inertia)
    }

    #[inline(always)]
    fn own_force(&self, _: &Placed<S>) -> SVector<S, 3> {
        SVector::zeros()
    }

    #[inline(always)]
    fn total(&self, placed: &Placed<S>, sum: &SVector<S, 3>) -> SVector<S, 3> {
        let weight = self.gravity * self.mass;
        placed.turn.to_velocities(sum) + SVector::<S, 3>::new(weight.x, weight.y, S::zero())
    }

    #[inline(always)]
    fn own_jacobians(&self, _: &Placed<S>, (): &(), _: &SVector<S, 3>, _: &mut Own<S, 3>, _: &mut Own<S, 3>) {}

    #[inline(always)]
    fn least_mass(&self) -> S {
        self.mass
    }

    #[inline(always)]
    fn per_lever(&self) -> SVector<S, 3> {
        SVector::<S, 3>::new(S::one(), S::one(), self.per_lever)
    }

    #[inline(always)]
    fn weighed(&self, change: &SVector<S, 3>) -> S {
        self.impulse(&self.momentum(&(), change))
    }
}

#[cfg(test)]
mod tests;
