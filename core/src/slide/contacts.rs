//! The sixteen contacts of the slide: forces at its pins, in body axes, and how they change.

use nalgebra::Matrix3;

use super::{SLOTS, Slide};
use crate::{
    Scalar, Vector3,
    law::{Elastic, Friction, Normal},
    linear::{Blocks, cross_rows},
    mechanism::Way,
    pose::ToBody,
    product::{cross, mapped, mapped_entries, outer},
};

/// Where the slide is and how it moves, in body axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed<S> {
    /// From the frame into the body.
    pub to_body: ToBody<S>,
    /// Displacement of the centre of mass (m).
    pub displacement_b: Vector3<S>,
    /// Velocity of the centre of mass (m/s).
    pub velocity_b: Vector3<S>,
    /// Angular velocity (rad/s).
    pub rotation_b: Vector3<S>,
}

impl<S: Scalar> Placed<S> {
    /// The same in numbers of another type.
    #[inline(always)]
    pub fn cast<T: Scalar>(&self, number: impl Fn(S) -> T) -> Placed<T> {
        Placed {
            to_body: self.to_body.cast(&number),
            displacement_b: mapped(&self.displacement_b, &number),
            velocity_b: mapped(&self.velocity_b, &number),
            rotation_b: mapped(&self.rotation_b, &number),
        }
    }
}

/// A pin's gaps (m), its place from the centre of mass (m), and what friction remembers at it.
type Pin<'a, S, M> = ((&'a [S; 4], &'a Vector3<S>), &'a [M; 2]);

/// The force on the slide at one pin and its changes. Axes of the body; of the matrices rows are forces.
pub(super) struct PinForce<S, M> {
    /// Where it acts, from the centre of mass (m).
    pub lever: Vector3<S>,
    /// Force on the slide (N).
    pub force: Vector3<S>,
    /// −∂force/∂u (N·s/m) by the velocity of the slide's material at the pin, which also moves it over the time `a`.
    pub impedance: Matrix3<S>,
    /// −∂force/∂x (N/m) by the displacement of the slide's material at the pin, if `impedance` leaves it in place.
    pub stiffness: Matrix3<S>,
    /// What friction in its slots remembers if the motion is accepted.
    pub memory: [M; 2],
}

impl<S: Scalar, M> PinForce<S, M> {
    /// Adds the force and its torque about the centre of mass (N·m) to those of other contacts.
    #[inline(always)]
    pub fn add_to(&self, (force, torque): &mut (Vector3<S>, Vector3<S>)) {
        *force += self.force;
        *torque += cross(&self.lever, &self.force);
    }
}

/// What contacts do to the slide and how that changes with its motion and place, in body axes.
pub(super) struct Response<S> {
    /// Force (N), and torque about the centre of mass (N·m).
    pub wrench: (Vector3<S>, Vector3<S>),
    /// Sum of lever·forceᵀ (N·m).
    pub moments: Matrix3<S>,
    /// −∂force/∂velocity.
    pub damping: Blocks<S>,
    /// −∂force/∂displacement, as far as contacts change: that their forces move and turn with the slide is left out.
    pub stiffness: Blocks<S>,
}

impl<S: Scalar> Response<S> {
    /// Of no contacts.
    #[inline(always)]
    pub fn none() -> Self {
        let (zero, none) = (Vector3::zeros(), Matrix3::zeros());
        let [damping, stiffness] = [Blocks { a: none, b: none, c: none, d: none }; 2];
        Self { wrench: (zero, zero), moments: none, damping, stiffness }
    }

    /// Adds what happens at a pin.
    #[inline(always)]
    pub fn add<M>(&mut self, pin: &PinForce<S, M>) {
        let PinForce { lever, force, impedance, stiffness, .. } = pin;
        pin.add_to(&mut self.wrench);
        self.moments += outer(lever, force);
        self.damping.add_at(lever, impedance);
        self.stiffness.add_at(lever, stiffness);
    }

    /// The same in numbers of another type.
    #[inline(always)]
    pub fn cast<T: Scalar>(&self, number: impl Fn(S) -> T) -> Response<T> {
        Response {
            wrench: (mapped(&self.wrench.0, &number), mapped(&self.wrench.1, &number)),
            moments: mapped_entries(&self.moments, &number),
            damping: self.damping.cast(&number),
            stiffness: self.stiffness.cast(&number),
        }
    }
}

/// What happens in a slot, its axis first, then the tangents.
struct SlotForce<S, M> {
    force: [S; 3],
    /// Column of the axis.
    impedance: [S; 3],
    /// Between the tangents: first, mixed, second.
    tangential: [S; 3],
    /// The only column there is, that of the axis.
    stiffness: [S; 3],
    memory: M,
}

impl<S: Scalar, E: Elastic<S>, F: Friction<S>> Slide<S, E, F> {
    /// The pins, with what friction has in `memory`.
    #[inline(always)]
    pub(super) fn pins<'a>(&'a self, memory: &'a [F::Memory; SLOTS]) -> impl Iterator<Item = Pin<'a, S, F::Memory>> {
        self.body.gaps.as_chunks::<4>().0.iter().zip(&self.body.pins_w).zip(memory.as_chunks::<2>().0)
    }

    /// The force at one of the [`pins`](Self::pins).
    #[inline(always)]
    pub(super) fn at_pin(
        &self,
        at: &Placed<S>,
        ((gaps, pin), memory): Pin<S, F::Memory>,
        way: Way<S>,
    ) -> PinForce<S, F::Memory> {
        let offset = at.to_body.change(*pin) - at.displacement_b;
        let lever = *pin + offset;
        let u = at.velocity_b + cross(&at.rotation_b, &lever);
        let mut pin = self.pin(memory, *gaps, (lever, offset), u, way);
        // Where the slide turns, a displacement changes the velocity of its material at the pin by −ω × displacement.
        pin.stiffness += cross_rows(&at.rotation_b, &pin.impedance);
        pin
    }

    /// The force at one pin for its `lever` and `offset` (m) as seen from the slide and the velocity `u` (m/s) of the
    /// slide's material there.
    #[inline(always)]
    fn pin(
        &self,
        [across_memory, up_memory]: &[F::Memory; 2],
        [left, right, rail, wall]: [S; 4],
        (lever, offset): (Vector3<S>, Vector3<S>),
        u: Vector3<S>,
        way: Way<S>,
    ) -> PinForce<S, F::Memory> {
        let across = self.slot(across_memory, [left, right], offset.x, [u.x, u.y, u.z], way);
        let up = self.slot(up_memory, [wall, rail], offset.y, [u.y, u.x, u.z], way);
        let (f, g) = (across.force, up.force);
        let ([xx, yx, zx], [yy, xy, zy]) = (across.impedance, up.impedance);
        let ([a_yy, a_yz, a_zz], [u_xx, u_xz, u_zz]) = (across.tangential, up.tangential);
        let ([k_xx, k_yx, k_zx], [k_yy, k_xy, k_zy]) = (across.stiffness, up.stiffness);
        let zero = S::zero();
        #[rustfmt::skip]
        let (impedance, stiffness) = (
            Matrix3::new(
                xx + u_xx, xy, u_xz,
                yx, yy + a_yy, a_yz,
                zx + u_xz, zy + a_yz, a_zz + u_zz,
            ),
            Matrix3::new(
                k_xx, k_xy, zero,
                k_yx, k_yy, zero,
                k_zx, k_zy, zero,
            ),
        );
        PinForce {
            lever,
            force: Vector3::new(f[0] + g[1], f[1] + g[0], f[2] + g[2]),
            impedance,
            stiffness,
            memory: [across.memory, up.memory],
        }
    }

    #[inline(always)]
    fn slot(
        &self,
        memory: &F::Memory,
        gaps: [S; 2],
        offset: S,
        [u, v, w]: [S; 3],
        way: Way<S>,
    ) -> SlotForce<S, F::Memory> {
        let slot = self.contact.slot(gaps[0], gaps[1], offset, u);
        let (traction, memory) = self.friction.traction(memory, &way.sliding([v, w], slot.normal()));
        let [first, second] = traction.per_normal;
        let column = |[own, normal]: [S; 2]| [own, first * normal, second * normal];
        SlotForce {
            force: [slot.force(), traction.force[0], traction.force[1]],
            impedance: column(slot.impedances(way.over)),
            tangential: traction.impedance,
            stiffness: column(slot.stiffnesses()),
            memory,
        }
    }
}
