//! The planar body as integrators see it.

use nalgebra::{Matrix3, Vector2, Vector3};

use super::{
    Joint, Planar, PlanarPose,
    contacts::Placed,
    turn::{Turn, at, turned},
};
use crate::{
    SVector, Scalar,
    law::{Elastic, Friction},
    linear::inverse,
    mechanism::{Differentiated, Linearised, Mechanism, Way, settled, settling},
};

#[inline(always)]
fn split<S: Scalar>(v: &SVector<S, 3>) -> (Vector2<S>, S) {
    (Vector2::new(v.x, v.y), v.z)
}

#[inline(always)]
fn join<S: Scalar>(v: Vector2<S>, w: S) -> SVector<S, 3> {
    SVector::<S, 3>::new(v.x, v.y, w)
}

/// The inverse of the linearised balance of forces in body axes, and the turn that leads there.
#[derive(Clone, Copy, Debug)]
pub struct Linearisation<S> {
    inverse: Matrix3<S>,
    turn: Turn<S>,
}

impl<S: Scalar> Default for Linearisation<S> {
    #[inline(always)]
    fn default() -> Self {
        Self { inverse: Matrix3::zeros(), turn: Turn::default() }
    }
}

/// −∂force/∂velocity and −∂force/∂displacement in body axes, and the turn that leads there.
#[derive(Clone, Copy, Debug)]
pub struct Slopes<S> {
    damping: Matrix3<S>,
    stiffness: Matrix3<S>,
    turn: Turn<S>,
}

impl<S: Scalar, C: Joint<S>, E: Elastic<S>, F: Friction<S>, const PINS: usize> Planar<S, C, E, F, PINS> {
    #[inline(always)]
    fn placed(&self, pose: &PlanarPose<S>, velocity: &SVector<S, 3>) -> Placed<S> {
        let (v_w, rotation) = split(velocity);
        let turn = Turn::of(pose.half_turn);
        Placed { displacement_b: turn.to_body(pose.displacement_w), velocity_b: turn.to_body(v_w), rotation, turn }
    }

    /// Force and torque of a drive force of 1 N, in body axes.
    #[inline(always)]
    fn pull(&self, turn: Turn<S>) -> Vector3<S> {
        let z_b = turn.to_body(Vector2::new(S::zero(), S::one()));
        at(self.point_b(), z_b)
    }

    #[inline(always)]
    fn point_b(&self) -> Vector2<S> {
        Vector2::new(self.drive.point_b.x, self.drive.point_b.z)
    }

    /// Force in the frame and torque of `body`, given in body axes, with gravity.
    #[inline(always)]
    fn total(&self, turn: Turn<S>, body: Vector3<S>) -> SVector<S, 3> {
        let (f_b, torque) = split(&body);
        join(turn.to_frame(f_b) + self.body.gravity_w * self.body.mass, torque)
    }

    /// The mass matrix times `rate` (1/s).
    #[inline(always)]
    fn inertia(&self, rate: S) -> Matrix3<S> {
        let mass = self.body.mass * rate;
        Matrix3::from_diagonal(&Vector3::new(mass, mass, self.body.inertia * rate))
    }

    /// That the drive gives way by its gain to the speed along itself.
    #[inline(always)]
    fn give(&self, pull: &Vector3<S>) -> Matrix3<S> {
        let along = *pull * self.drive.gain;
        Matrix3::from_columns(&[along * pull.x, along * pull.y, Vector3::zeros()])
    }
}

impl<S: Scalar, C: Joint<S>, E: Elastic<S>, F: Friction<S>, const PINS: usize> Mechanism<S, 3>
    for Planar<S, C, E, F, PINS>
{
    type Pose = PlanarPose<S>;
    type Memory = [F::Memory; PINS];
    type Linearisation = Linearisation<S>;
    type Slopes = Slopes<S>;

    #[inline(always)]
    fn advanced(&self, pose: &PlanarPose<S>, velocity: &SVector<S, 3>, dt: S) -> PlanarPose<S> {
        let PlanarPose { displacement_w, half_turn } = self.moved(pose, velocity, dt);
        let half = velocity.z * dt * S::from_f64(0.5);
        let scale = S::one() / (S::one() + half * half);
        PlanarPose { displacement_w, half_turn: half_turn.map(|x| x * scale) }
    }

    #[inline(always)]
    fn moved(&self, pose: &PlanarPose<S>, velocity: &SVector<S, 3>, dt: S) -> PlanarPose<S> {
        let (v_w, rotation) = split(velocity);
        let [w, v] = pose.half_turn;
        let half = rotation * dt * S::from_f64(0.5);
        PlanarPose { displacement_w: pose.displacement_w + v_w * dt, half_turn: [w - v * half, v + w * half] }
    }

    #[inline(always)]
    fn shifted(&self, base: &PlanarPose<S>, from: &PlanarPose<S>, to: &PlanarPose<S>, weight: S) -> PlanarPose<S> {
        let [w, v] = base.half_turn;
        PlanarPose {
            displacement_w: base.displacement_w + (to.displacement_w - from.displacement_w) * weight,
            half_turn: [
                w + (to.half_turn[0] - from.half_turn[0]) * weight,
                v + (to.half_turn[1] - from.half_turn[1]) * weight,
            ],
        }
    }

    #[inline(always)]
    fn memory_shifted(&self, base: &Self::Memory, from: &Self::Memory, to: &Self::Memory, weight: S) -> Self::Memory {
        let mut memory = *base;
        for ((pin, from), to) in memory.iter_mut().zip(from).zip(to) {
            *pin = F::shifted(pin, from, to, weight);
        }
        memory
    }

    #[inline(always)]
    fn normalised(&self, pose: &PlanarPose<S>) -> PlanarPose<S> {
        let [w, v] = pose.half_turn;
        let scale = S::from_f64(0.5) * (S::from_f64(3.0) - (w * w + v * v));
        PlanarPose { half_turn: [w * scale, v * scale], ..*pose }
    }

    #[inline(always)]
    fn fresh(&self) -> Self::Memory {
        [F::fresh(); PINS]
    }

    #[inline(always)]
    fn accept(
        &self,
        condition: S,
        (next, next_memory): (&PlanarPose<S>, &Self::Memory),
        (kept, memory): (&mut PlanarPose<S>, &mut Self::Memory),
    ) {
        let either = |new: S, old| new.or_old(condition, old);
        *kept = PlanarPose {
            displacement_w: next.displacement_w.zip_map(&kept.displacement_w, either),
            half_turn: [either(next.half_turn[0], kept.half_turn[0]), either(next.half_turn[1], kept.half_turn[1])],
        };
        for (pin, next) in memory.iter_mut().zip(next_memory) {
            *pin = F::or_old(next, condition, pin);
        }
    }

    #[inline(always)]
    fn finiteness_probe(&self, pose: &PlanarPose<S>) -> S {
        let [w, v] = pose.half_turn;
        let zero = S::zero();
        pose.displacement_w.x * zero + pose.displacement_w.y * zero + w * zero + v * zero
    }

    /// As for the slide.
    #[inline(always)]
    fn settled(&self, velocity: &SVector<S, 3>, a: S) -> SVector<S, 3> {
        if !F::STICKS {
            return *velocity;
        }
        let unit = settling(a);
        let (v_w, rotation) = split(velocity);
        join(v_w.map(|x| settled(x, unit)), settled(rotation, unit * self.per_lever))
    }

    #[inline(always)]
    fn momentum(&self, _: &PlanarPose<S>, velocity: &SVector<S, 3>) -> SVector<S, 3> {
        let (v_w, rotation) = split(velocity);
        join(v_w * self.body.mass, rotation * self.body.inertia)
    }

    #[inline(always)]
    fn velocity(&self, _: &PlanarPose<S>, momentum: &SVector<S, 3>) -> SVector<S, 3> {
        let (p_w, l) = split(momentum);
        join(p_w / self.body.mass, l / self.body.inertia)
    }

    #[inline(always)]
    fn forces(
        &self,
        t: S,
        pose: &PlanarPose<S>,
        memory: &Self::Memory,
        velocity: &SVector<S, 3>,
        a: S,
        remembered: Option<&mut Self::Memory>,
    ) -> SVector<S, 3> {
        let placed = self.placed(pose, velocity);
        let mut pins = remembered.into_iter().flatten();
        let way = Way { a, mass_rate: self.body.mass / a, tangent_share: S::one() };
        let contacts = self.contact_forces(&placed, memory, way, |_, joint| {
            if let Some(slot) = pins.next() {
                *slot = joint.memory;
            }
        });
        let push = self.pull(placed.turn) * self.drive.force(t, velocity.y);
        self.total(placed.turn, contacts + push)
    }

    #[inline(always)]
    fn linearised(
        &self,
        t: S,
        pose: &PlanarPose<S>,
        memory: &Self::Memory,
        velocity: &SVector<S, 3>,
        a: S,
        tangent_share: S,
    ) -> Linearised<S, Linearisation<S>, 3> {
        let placed = self.placed(pose, velocity);
        let rate = S::one() / a;
        let pull = self.pull(placed.turn);
        let mut balance = self.inertia(rate) + self.give(&pull);
        let way = Way { a, mass_rate: self.body.mass * rate, tangent_share };
        let contacts = self.contact_forces(&placed, memory, way, |lever, joint| balance += joint.damping(lever));
        Linearised {
            force: self.total(placed.turn, contacts + pull * self.drive.force(t, velocity.y)),
            linearisation: Linearisation { inverse: inverse(&balance), turn: placed.turn },
        }
    }

    #[inline(always)]
    fn solve(&self, linearisation: &Linearisation<S>, residual: &SVector<S, 3>) -> SVector<S, 3> {
        let Linearisation { inverse, turn } = linearisation;
        let (f_w, torque) = split(residual);
        let (v_b, rotation) = split(&(inverse * join(turn.to_body(f_w), torque)));
        join(turn.to_frame(v_b), rotation)
    }

    #[inline(always)]
    fn impulse(&self, imbalance: &SVector<S, 3>) -> S {
        let (p, l) = split(imbalance);
        let at_lever = l * self.per_lever;
        (p.dot(&p) + at_lever * at_lever).sqrt()
    }

    #[inline(always)]
    fn differentiated(
        &self,
        t: S,
        pose: &PlanarPose<S>,
        memory: &Self::Memory,
        velocity: &SVector<S, 3>,
    ) -> Differentiated<S, Slopes<S>, 3> {
        let placed = self.placed(pose, velocity);
        let (mut damping, mut stiffness) = (Matrix3::zeros(), Matrix3::zeros());
        let swirl = turned(placed.velocity_b);
        let way = Way { a: S::zero(), mass_rate: S::zero(), tangent_share: S::one() };
        let contacts = self.contact_forces(&placed, memory, way, |lever, joint| {
            damping += joint.damping(lever);
            stiffness += joint.stiffness(lever, placed.rotation);
            // A turn changes the velocity that the contact sees and takes the force along, which stays at the pin.
            let stays = turned(joint.force);
            let turn = joint.by_velocity(lever, swirl) + at(Vector2::zeros(), stays);
            let (left, right) = (Vector3::zeros(), Vector3::new(-stays.x, -stays.y, -stays.dot(&turned(lever))));
            stiffness -= Matrix3::from_columns(&[left, left, turn]);
            stiffness += Matrix3::from_columns(&[left, left, right]).transpose();
        });
        let pull = self.pull(placed.turn);
        let push = self.drive.force(t, velocity.y);
        damping += self.give(&pull);
        // The drive's force does not turn with the body.
        stiffness[(2, 2)] += turned(self.point_b()).dot(&turned(Vector2::new(pull.x, pull.y))) * push;
        let (per_time, torque_per_time) = split(&(pull * self.drive.force_rate(t)));
        Differentiated {
            force: self.total(placed.turn, contacts + pull * push),
            per_time: join(placed.turn.to_frame(per_time), torque_per_time),
            slopes: Slopes { damping, stiffness, turn: placed.turn },
        }
    }

    #[inline(always)]
    fn linearisation(&self, slopes: &Slopes<S>, a: S) -> Linearisation<S> {
        let balance = self.inertia(S::one() / a) + slopes.damping + slopes.stiffness * a;
        Linearisation { inverse: inverse(&balance), turn: slopes.turn }
    }

    #[inline(always)]
    fn pushed(&self, slopes: &Slopes<S>, displacement: &SVector<S, 3>) -> SVector<S, 3> {
        let (x_w, turn) = split(displacement);
        let (force_b, torque) = split(&(slopes.stiffness * join(slopes.turn.to_body(x_w), turn)));
        join(-slopes.turn.to_frame(force_b), -torque)
    }

    /// With the angle θ of [`PlanarPose`] moved explicitly, tan(θ/2) is what `moved` adds, so that θ̇ = ω·(1 + θ²/4).
    #[inline(always)]
    fn rate(&self, displacement: &SVector<S, 3>, velocity: &SVector<S, 3>) -> SVector<S, 3> {
        let (v_w, rotation) = split(velocity);
        let half = displacement.z * S::from_f64(0.5);
        join(v_w, rotation + half * half * rotation)
    }
}
