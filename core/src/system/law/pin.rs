//! A pin between the walls of two slots, as the slide of the paper has them.

use super::{Contact, Law, Response, steady};
use crate::{
    SMatrix, SVector, Scalar,
    law::{Fit, Friction, Normal, fit::SlotForce},
    mechanism::Way,
    system::Shape,
};

/// A pin between two walls across (the x axis of the walls' body) and two walls up and down (its y axis); it slides along z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitted<G, N, F> {
    /// Gaps (m) at the nominal poses, left, right, rail and wall, and how they [fit](Fit).
    pub gaps: G,
    /// Their laws.
    pub contact: Contact<N, F>,
}

/// A pin that fits with clearance or interference.
pub type Pin<S, N, F> = Fitted<[S; 4], N, F>;

/// The gaps of a pin.
impl<G: Fit, N: Normal<G::Number>, F: Friction<G::Number>> Shape<Contact<N, F>> for G {
    type Law = Fitted<G, N, F>;

    #[inline(always)]
    fn with(&self, contact: &Contact<N, F>) -> Fitted<G, N, F> {
        Fitted { gaps: *self, contact: *contact }
    }
}

/// What a slot does to its walls' body, its axis first, then the tangents.
struct Slotted<S, M> {
    force: [S; 3],
    /// Column of the axis.
    impedance: [S; 3],
    /// Between the tangents: first, mixed, second.
    tangential: [S; 3],
    /// The only column there is, that of the axis.
    stiffness: [S; 3],
    internal: M,
}

impl<S: Scalar, G: Fit<Number = S>, N: Normal<S>, F: Friction<S>> Fitted<G, N, F> {
    /// A slot whose pin is off by `offset` while the walls' body moves against it with `u` along its axis, `v` and `w` along its
    /// tangents.
    #[inline(always)]
    fn slot(
        &self,
        internal: &F::Internal,
        gaps: [S; 2],
        offset: S,
        [u, v, w]: [S; 3],
        way: Way<S>,
    ) -> Slotted<S, F::Internal> {
        let slot = G::slot(&self.contact.normal, gaps, offset, u);
        let (traction, internal) = self.contact.friction.traction(internal, &way.sliding([v, w], slot.normal()));
        let [first, second] = traction.per_normal;
        let column = |[own, normal]: [S; 2]| [own, first * normal, second * normal];
        Slotted {
            force: [slot.force(), traction.force[0], traction.force[1]],
            impedance: column(slot.impedances(way.over)),
            tangential: traction.impedance,
            stiffness: column(slot.stiffnesses()),
            internal,
        }
    }
}

impl<S: Scalar, G: Fit<Number = S>, N: Normal<S>, F: Friction<S>> Law<S, 3> for Fitted<G, N, F> {
    type Internal = [F::Internal; 2];

    const STICKS: bool = F::STICKS;

    const PLACES: usize = 2;

    #[inline(always)]
    fn fresh(&self) -> [F::Internal; 2] {
        [F::fresh(); 2]
    }

    #[inline(always)]
    fn gap(&self, place: &SVector<S, 3>) -> S {
        let [left, right, rail, wall] = self.gaps.gaps();
        let [x, y, _] = place.data.0[0];
        let deepest = (-(left + x)).max_of(x - right).max_of(-(wall + y)).max_of(y - rail);
        -deepest
    }

    #[inline(always)]
    fn each_gap(&self, place: &SVector<S, 3>, rate: &SVector<S, 3>, mut see: impl FnMut(S, S)) {
        let [left, right, rail, wall] = self.gaps.gaps();
        let ([x, y, _], [u, v, _]) = (place.data.0[0], rate.data.0[0]);
        [(left + x, u), (right - x, -u), (wall + y, v), (rail - y, -v)]
            .into_iter()
            .for_each(|(gap, rate)| see(gap, rate));
    }

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 3>,
        rate: &SVector<S, 3>,
        internal: &[F::Internal; 2],
        way: Way<S>,
    ) -> (Response<S, 3>, [F::Internal; 2]) {
        let [left, right, rail, wall] = self.gaps.gaps();
        let [x, y, _] = place.data.0[0];
        // The walls' body moves against the pin the other way.
        let [u, v, w] = rate.data.0[0];
        let (u, v, w) = (-u, -v, -w);
        let up = self.slot(&internal[1], [wall, rail], y, [v, u, w], way);
        let across = self.slot(&internal[0], [left, right], x, [u, v, w], way);
        let (f, g) = (across.force, up.force);
        let ([xx, yx, zx], [yy, xy, zy]) = (across.impedance, up.impedance);
        let ([a_yy, a_yz, a_zz], [u_xx, u_xz, u_zz]) = (across.tangential, up.tangential);
        let ([k_xx, k_yx, k_zx], [k_yy, k_xy, k_zy]) = (across.stiffness, up.stiffness);
        let zero = S::zero();
        #[rustfmt::skip]
        let (impedance, stiffness) = (
            SMatrix::<S, 3, 3>::new(
                xx + u_xx, xy, u_xz,
                yx, yy + a_yy, a_yz,
                zx + u_xz, zy + a_yz, a_zz + u_zz,
            ),
            SMatrix::<S, 3, 3>::new(
                k_xx, k_xy, zero,
                k_yx, k_yy, zero,
                k_zx, k_zy, zero,
            ),
        );
        let force = SVector::<S, 3>::new(-(f[0] + g[1]), -(f[1] + g[0]), -(f[2] + g[2]));
        (steady(force, impedance, stiffness), [across.internal, up.internal])
    }

    #[inline(always)]
    fn shifted(base: &[F::Internal; 2], from: &[F::Internal; 2], to: &[F::Internal; 2], weight: S) -> [F::Internal; 2] {
        let at = |i: usize| F::shifted(&base[i], &from[i], &to[i], weight);
        [at(0), at(1)]
    }

    #[inline(always)]
    fn or_old(new: &[F::Internal; 2], condition: S, old: &[F::Internal; 2]) -> [F::Internal; 2] {
        [F::or_old(&new[0], condition, &old[0]), F::or_old(&new[1], condition, &old[1])]
    }
}
