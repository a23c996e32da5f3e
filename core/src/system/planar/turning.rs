//! How much a body has turned against another.

use super::{
    Placed, PlanarTree,
    topology::{Topology, Turns},
    tree::turned,
};
use crate::{
    SMatrix, SVector, Scalar, Vector2,
    system::{GradientLink, Seen},
};

/// How much (rad) a body has turned against another, or against the frame where there is none; and how fast (rad/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning<A = Option<usize>, B = Option<usize>> {
    /// What turns the body.
    pub body: A,
    /// What turns the other.
    pub against: B,
}

impl<S: Scalar, J: Topology<D>, A: Turns, B: Turns, const D: usize> GradientLink<S, PlanarTree<S, D, J>, D, 1>
    for Turning<A, B>
{
    type View = ();

    #[inline(always)]
    fn view(&self, _: &PlanarTree<S, D, J>, _: &Placed<S, D>) {}

    #[inline(always)]
    fn moves(&self, k: usize) -> bool {
        self.body.turn() == Some(k) || self.against.turn() == Some(k)
    }

    #[inline(always)]
    fn seen(&self, (_, placed): (&PlanarTree<S, D, J>, &Placed<S, D>), (): &()) -> Seen<S, 1> {
        let mut axis = Vector2::new(S::one(), S::zero());
        let mut rate = S::zero();
        if let Some(body) = self.body.turn() {
            axis = placed.axes[body];
            rate = placed.rates[body];
        }
        if let Some(against) = self.against.turn() {
            let back = placed.axes[against];
            axis = turned(&Vector2::new(back.x, -back.y), &axis);
            rate -= placed.rates[against];
        }
        Seen { place: SVector::<S, 1>::new(angle(&axis)), rate: SVector::<S, 1>::new(rate) }
    }

    #[inline(always)]
    fn gradient(&self, _: (&PlanarTree<S, D, J>, &Placed<S, D>), (): &()) -> SMatrix<S, 1, D> {
        let mut gradient = SMatrix::<S, 1, D>::zeros();
        if let Some(body) = self.body.turn() {
            gradient[(0, body)] = S::one();
        }
        if let Some(against) = self.against.turn() {
            gradient[(0, against)] = -S::one();
        }
        gradient
    }

    #[inline(always)]
    fn add_force(
        &self,
        _: (&PlanarTree<S, D, J>, &Placed<S, D>),
        (): &(),
        force: &SVector<S, 1>,
        sum: &mut SVector<S, D>,
    ) {
        if let Some(body) = self.body.turn() {
            sum[body] += force[0];
        }
        if let Some(against) = self.against.turn() {
            sum[against] -= force[0];
        }
    }

    #[inline(always)]
    fn add_carried(
        &self,
        _: (&PlanarTree<S, D, J>, &Placed<S, D>),
        (): &(),
        _: &SMatrix<S, 1, D>,
        _: &SVector<S, 1>,
        _: &mut SMatrix<S, D, D>,
    ) {
    }

    #[inline(always)]
    fn swept(&self, _: (&PlanarTree<S, D, J>, &Placed<S, D>), (): &(), _: &SMatrix<S, 1, D>) -> SMatrix<S, 1, D> {
        SMatrix::zeros()
    }
}

/// The angle (rad), −π to π, of a direction of unit length, without branches: a half angle thrice, then a series.
#[inline(always)]
fn angle<S: Scalar>(direction: &Vector2<S>) -> S {
    let (one, quarter) = (S::one(), S::from_f64(1e-30));
    // tan(θ/2) = sin/(1 + cos); near ±π the divisor vanishes.
    let mut t = direction.y / (one + direction.x).max_of(quarter);
    let huge = S::from_f64(1e9);
    t = t.within(-huge, huge);
    for _ in 0..3 {
        t /= one + (one + t * t).sqrt();
    }
    let square = t * t;
    // arctan: |t| ≤ tan(π/16) = 0.199.
    let mut series = S::zero();
    for k in (0..12u32).rev() {
        let term = one / S::from_count(2 * k + 1);
        series = (if k % 2 == 0 { term } else { -term }) + series * square;
    }
    S::from_f64(16.0) * t * series
}
