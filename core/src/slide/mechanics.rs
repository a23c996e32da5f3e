//! The slide as integrators see it.

use nalgebra::Matrix3;

use super::{
    SLOTS, Slide,
    contacts::{Placed, Response},
    join, split,
};
use crate::{
    SVector, Scalar, Vector3,
    drive::Drive,
    law::{Elastic, Friction},
    linear::{Blocks, Factors, cross_matrix, cross_rows, twice_crossed},
    mechanism::{Differentiated, Driven, Linearised, Mechanism, Way, settled, settling},
    pose::{Pose, ToBody},
    product::{cross, dot, outer},
};

/// The balance of forces linearised in body axes, and the rotation that leads there.
#[derive(Clone, Copy, Debug)]
pub struct Linearisation<S> {
    factors: Factors<S>,
    to_body: ToBody<S>,
}

impl<S: Scalar> Default for Linearisation<S> {
    #[inline(always)]
    fn default() -> Self {
        let zero = Matrix3::zeros();
        let factors = Factors { inverse_a: zero, b: zero, c_over_a: zero, inverse_rest: zero };
        Self { factors, to_body: Pose::nominal().to_body() }
    }
}

/// How the force changes with motion and place, in body axes, and the rotation that leads there. Only
/// the gyroscopic torque's change is left out.
#[derive(Clone, Copy, Debug)]
pub struct Slopes<S> {
    /// −∂force/∂velocity.
    damping: Blocks<S>,
    /// −∂force/∂displacement.
    stiffness: Blocks<S>,
    to_body: ToBody<S>,
}

impl<S: Scalar, E: Elastic<S>, F: Friction<S>> Mechanism<S, 6> for Slide<S, E, F> {
    type Pose = Pose<S>;
    type Memory = [F::Memory; SLOTS];
    type Linearisation = Linearisation<S>;
    type Slopes = Slopes<S>;

    #[inline(always)]
    fn advanced(&self, pose: &Pose<S>, velocity: &SVector<S, 6>, dt: S) -> Pose<S> {
        let (v_w, w_b) = split(velocity);
        pose.advanced(v_w, w_b, dt)
    }

    #[inline(always)]
    fn moved(&self, pose: &Pose<S>, velocity: &SVector<S, 6>, dt: S) -> Pose<S> {
        let (v_w, w_b) = split(velocity);
        pose.moved(v_w, w_b, dt)
    }

    #[inline(always)]
    fn shifted(&self, base: &Pose<S>, from: &Pose<S>, to: &Pose<S>, weight: S) -> Pose<S> {
        base.shifted(from, to, weight)
    }

    #[inline(always)]
    fn memory_shifted(
        &self,
        base: &[F::Memory; SLOTS],
        from: &[F::Memory; SLOTS],
        to: &[F::Memory; SLOTS],
        weight: S,
    ) -> [F::Memory; SLOTS] {
        let mut memory = *base;
        for ((slot, from), to) in memory.iter_mut().zip(from).zip(to) {
            *slot = F::shifted(slot, from, to, weight);
        }
        memory
    }

    #[inline(always)]
    fn normalised(&self, pose: &Pose<S>) -> Pose<S> {
        pose.normalised()
    }

    #[inline(always)]
    fn fresh(&self) -> [F::Memory; SLOTS] {
        [F::fresh(); SLOTS]
    }

    #[inline(always)]
    fn accept(
        &self,
        condition: S,
        (next, next_memory): (&Pose<S>, &[F::Memory; SLOTS]),
        (kept, memory): (&mut Pose<S>, &mut [F::Memory; SLOTS]),
    ) {
        *kept = next.or_old(condition, kept);
        for (slot, next) in memory.iter_mut().zip(next_memory) {
            *slot = F::or_old(next, condition, slot);
        }
    }

    #[inline(always)]
    fn finiteness_probe(&self, pose: &Pose<S>) -> S {
        let zero = S::zero();
        let Pose { displacement_w: r, orientation: q } = pose;
        (r.x + r.y + r.z + q.w + q.v.x + q.v.y + q.v.z) * zero
    }

    /// Velocities are rounded to the last place of what an acceleration of 4000 m/s² makes of them, of 4 m/s at most: a body
    /// that sticks comes to rest to the last bit.
    #[inline(always)]
    fn settled(&self, velocity: &SVector<S, 6>, a: S) -> SVector<S, 6> {
        if !F::STICKS {
            return *velocity;
        }
        let (v_w, w_b) = split(velocity);
        let unit = settling(a);
        join(v_w.map(|x| settled(x, unit)), w_b.map(|x| settled(x, unit * self.per_lever)))
    }

    #[inline(always)]
    fn momentum(&self, _: &Pose<S>, velocity: &SVector<S, 6>) -> SVector<S, 6> {
        let (v_w, w_b) = split(velocity);
        join(v_w * self.body.mass, w_b.component_mul(&self.body.inertia_b))
    }

    #[inline(always)]
    fn velocity(&self, _: &Pose<S>, momentum: &SVector<S, 6>) -> SVector<S, 6> {
        let (p_w, l_b) = split(momentum);
        join(p_w / self.body.mass, l_b.component_div(&self.body.inertia_b))
    }

    #[inline(always)]
    fn forces(
        &self,
        t: S,
        pose: &Pose<S>,
        memory: &[F::Memory; SLOTS],
        velocity: &SVector<S, 6>,
        a: S,
        remembered: Option<&mut [F::Memory; SLOTS]>,
    ) -> SVector<S, 6> {
        let at = placed(pose, velocity);
        let mut remembered = remembered.into_iter().flat_map(|slots| slots.as_chunks_mut::<2>().0);
        let way = Way { over: Some(a), mass_rate: self.body.mass / a, tangent_share: S::one() };
        let mut contacts = (Vector3::zeros(), Vector3::zeros());
        for pin in self.pins(memory) {
            let pin = self.at_pin(&at, pin, way);
            pin.add_to(&mut contacts);
            if let Some(slots) = remembered.next() {
                *slots = pin.memory;
            }
        }
        self.balance(t, &at, contacts, velocity.z)
    }

    #[inline(always)]
    fn linearised(
        &self,
        t: S,
        pose: &Pose<S>,
        memory: &[F::Memory; SLOTS],
        velocity: &SVector<S, 6>,
        a: S,
        tangent_share: S,
    ) -> Linearised<S, Linearisation<S>, 6> {
        let at = placed(pose, velocity);
        let rate = S::one() / a;
        let pull = self.pull(&at.to_body);
        let mut blocks = self.inertia(rate);
        pull.add_to(&mut blocks, self.drive.gain);
        let way = Way { over: Some(a), mass_rate: self.body.mass * rate, tangent_share };
        let mut contacts = (Vector3::zeros(), Vector3::zeros());
        for pin in self.pins(memory) {
            let pin = self.at_pin(&at, pin, way);
            pin.add_to(&mut contacts);
            blocks.add_at(&pin.lever, &pin.impedance);
        }
        Linearised {
            force: self.total(&at, contacts, pull.times(self.drive.force(t, velocity.z))),
            linearisation: Linearisation { factors: blocks.factorised(), to_body: at.to_body },
        }
    }

    #[inline(always)]
    fn solve(&self, linearisation: &Linearisation<S>, residual: &SVector<S, 6>) -> SVector<S, 6> {
        let (f_w, g_b) = split(residual);
        let (v_b, w_b) = linearisation.factors.solve(linearisation.to_body.apply(f_w), g_b);
        join(linearisation.to_body.apply_inverse(v_b), w_b)
    }

    #[inline(always)]
    fn impulse(&self, imbalance: &SVector<S, 6>) -> S {
        let (p, l) = split(imbalance);
        (dot(&p, &p) + dot(&l, &l) * self.per_lever * self.per_lever).sqrt()
    }

    #[inline(always)]
    fn differentiated(
        &self,
        t: S,
        pose: &Pose<S>,
        memory: &[F::Memory; SLOTS],
        velocity: &SVector<S, 6>,
    ) -> Differentiated<S, Slopes<S>, 6> {
        let at = placed(pose, velocity);
        let way = Way { over: None, mass_rate: S::zero(), tangent_share: S::one() };
        let mut contacts = Response::none();
        for pin in self.pins(memory) {
            contacts.add(&self.at_pin(&at, pin, way));
        }
        self.completed(t, &at, contacts, velocity.z)
    }

    #[inline(always)]
    fn linearisation(&self, slopes: &Slopes<S>, a: S) -> Linearisation<S> {
        let blocks = self.inertia(S::one() / a).plus(&slopes.damping, S::one()).plus(&slopes.stiffness, a);
        Linearisation { factors: blocks.factorised(), to_body: slopes.to_body }
    }

    #[inline(always)]
    fn pushed(&self, slopes: &Slopes<S>, displacement: &SVector<S, 6>) -> SVector<S, 6> {
        let (x_w, turn_b) = split(displacement);
        let (force_b, torque_b) = slopes.stiffness.times(slopes.to_body.apply(x_w), turn_b);
        join(-slopes.to_body.apply_inverse(force_b), -torque_b)
    }

    /// With the turn θ of [`Pose::moved`], the orientation is that of the quaternion (1, θ/2) after the pose's, so that
    /// θ̇ = ω + ½·θ×ω + ¼·θ(θ·ω).
    #[inline(always)]
    fn rate(&self, displacement: &SVector<S, 6>, velocity: &SVector<S, 6>) -> SVector<S, 6> {
        let ((_, turn_b), (v_w, w_b)) = (split(displacement), split(velocity));
        let half = turn_b * S::from_f64(0.5);
        join(v_w, w_b + cross(&half, &w_b) + half * dot(&half, &w_b))
    }
}

impl<S: Scalar, E: Elastic<S>, F: Friction<S, Memory = ()>> Driven<S, 6> for Slide<S, E, F> {
    #[inline(always)]
    fn drive(&self) -> &Drive<S> {
        &self.drive
    }

    #[inline(always)]
    fn mass(&self) -> S {
        self.body.mass
    }

    #[inline(always)]
    fn speed(&self, velocity: &SVector<S, 6>) -> S {
        velocity.z
    }
}

/// What a drive force of 1 N is in body axes: force and torque about the centre of mass.
struct Pull<S> {
    force_b: Vector3<S>,
    torque_b: Vector3<S>,
}

impl<S: Scalar> Pull<S> {
    #[inline(always)]
    fn times(&self, push: S) -> (Vector3<S>, Vector3<S>) {
        (self.force_b * push, self.torque_b * push)
    }

    /// Adds that the drive gives way by `gain` (N·s/m) to the speed along itself.
    #[inline(always)]
    fn add_to(&self, blocks: &mut Blocks<S>, gain: S) {
        let along = self.force_b * gain;
        blocks.a += outer(&self.force_b, &along);
        blocks.c += outer(&self.torque_b, &along);
    }
}

impl<S: Scalar, E: Elastic<S>, F: Friction<S>> Slide<S, E, F> {
    /// The mass matrix times `rate` (1/s).
    #[inline(always)]
    fn inertia(&self, rate: S) -> Blocks<S> {
        let mass = self.body.mass * rate;
        Blocks::diagonal(Vector3::new(mass, mass, mass), self.body.inertia_b * rate)
    }

    /// All forces, from force and torque of the `contacts` in body axes, at time `t` (s) and the speed `vz` (m/s) along the
    /// drive.
    #[inline(always)]
    pub(super) fn balance(&self, t: S, at: &Placed<S>, contacts: (Vector3<S>, Vector3<S>), vz: S) -> SVector<S, 6> {
        self.total(at, contacts, self.pull(&at.to_body).times(self.drive.force(t, vz)))
    }

    /// All forces and their derivatives, from those of the `contacts`, at time `t` (s) and the speed `vz` (m/s) along the drive.
    #[inline(always)]
    pub(super) fn completed(
        &self,
        t: S,
        at: &Placed<S>,
        contacts: Response<S>,
        vz: S,
    ) -> Differentiated<S, Slopes<S>, 6> {
        let Response { wrench, moments, mut damping, mut stiffness } = contacts;
        let pull = self.pull(&at.to_body);
        let push = self.drive.force(t, vz);
        // A turn θ changes the velocity that the contacts see by −θ × v.
        stiffness.b -= cross_rows(&at.velocity_b, &damping.a);
        stiffness.d -= cross_rows(&at.velocity_b, &damping.c);
        pull.add_to(&mut damping, self.drive.gain);
        // The contacts' forces stay at the pins while the slide is displaced, and turn with it. The drive's does not turn.
        stiffness.c -= cross_matrix(&wrench.0);
        stiffness.b += cross_matrix(&wrench.0);
        stiffness.d += twice_crossed(&(moments - outer(&(pull.force_b * push), &self.drive.point_b)));
        let (force_b, torque_b) = pull.times(self.drive.gain * self.drive.command_rate(t));
        Differentiated {
            force: self.total(at, wrench, pull.times(push)),
            per_time: join(at.to_body.apply_inverse(force_b), torque_b),
            slopes: Slopes { damping, stiffness, to_body: at.to_body },
        }
    }

    #[inline(always)]
    fn pull(&self, to_body: &ToBody<S>) -> Pull<S> {
        let z_b = to_body.z_axis();
        Pull { force_b: z_b, torque_b: cross(&self.drive.point_b, &z_b) }
    }

    /// All forces: those of the contacts and the drive, given as force and torque in body axes, gravity, and the torque by
    /// which the turning body resists.
    #[inline(always)]
    fn total(
        &self,
        at: &Placed<S>,
        contacts: (Vector3<S>, Vector3<S>),
        drive: (Vector3<S>, Vector3<S>),
    ) -> SVector<S, 6> {
        let gyroscopic = cross(&at.rotation_b, &at.rotation_b.component_mul(&self.body.inertia_b));
        join(
            at.to_body.apply_inverse(contacts.0 + drive.0) + self.body.gravity_w * self.body.mass,
            contacts.1 + drive.1 - gyroscopic,
        )
    }
}

/// The `pose` and `velocity` in body axes.
#[inline(always)]
pub(super) fn placed<S: Scalar>(pose: &Pose<S>, velocity: &SVector<S, 6>) -> Placed<S> {
    let (v_w, rotation_b) = split(velocity);
    let to_body = pose.to_body();
    Placed { displacement_b: to_body.apply(pose.displacement_w), velocity_b: to_body.apply(v_w), rotation_b, to_body }
}
