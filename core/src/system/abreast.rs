//! Elements side by side: where a number is a lane of four, four of them take the time of one.
//!
//! For desks, whose processors have such lanes.

use super::{Assembly, Bodies, Derivatives, Elements, Jacobian, JacobiansOf, Sum, System};
use crate::{
    SVector, Scalar,
    mechanism::{Differentiated, Way},
};

/// How many numbers are side by side.
pub const LANES: usize = 4;

/// Numbers `S` side by side.
pub trait Lanes<S: Scalar>: Scalar {
    /// The `numbers`, each in its lane.
    fn of(numbers: [S; LANES]) -> Self;

    /// The number in each lane.
    fn each(self) -> [S; LANES];

    /// The sum over the lanes, from the first to the last.
    #[inline(always)]
    fn sum(self) -> S {
        let [a, b, c, d] = self.each();
        a + b + c + d
    }
}

/// `number` in every lane.
#[inline(always)]
pub fn everywhere<S: Scalar, L: Lanes<S>>(number: S) -> L {
    L::of([number; LANES])
}

/// Bodies of constant mass, elements of which may stand side by side.
pub trait AbreastBodies<S: Scalar, L: Lanes<S>, const D: usize>: Bodies<S, D> {
    /// The same bodies in every lane.
    type Lanes: Bodies<L, D>;

    /// What is `placed`, in every lane.
    fn everywhere(placed: &Self::Placed) -> <Self::Lanes as Bodies<L, D>>::Placed;

    /// The sum of a `jacobian` over the lanes.
    fn summed(jacobian: &<Self::Lanes as Bodies<L, D>>::Jacobian) -> Self::Jacobian;
}

/// There is no step, and no friction that remembers.
#[inline(always)]
fn still<S: Scalar>() -> Way<S> {
    Way { over: None, mass_rate: S::zero(), tangent_share: S::one() }
}

impl<B, E> System<B, E> {
    /// [`Mechanism::forces`](crate::mechanism::Mechanism::forces) (N, N·m) at time `t` (s), with some of the elements in `lanes`, the
    /// same bodies in each, and the `rest` of them in turn. None has internal variables.
    #[inline(always)]
    pub fn forces_abreast<S: Scalar, L: Lanes<S>, EL, R, const D: usize>(
        &self,
        lanes: &System<B::Lanes, EL>,
        rest: &R,
        t: S,
        pose: &B::Pose,
        velocity: &SVector<S, D>,
    ) -> SVector<S, D>
    where
        B: AbreastBodies<S, L, D>,
        EL: Elements<L, B::Lanes, D>,
        R: Elements<S, B, D>,
    {
        let placed = self.bodies.placed(pose, velocity);
        let mut each = Sum(SVector::zeros());
        lanes.add_still(&B::everywhere(&placed), &mut each);
        let mut sum = Sum(self.bodies.own_force(&placed) + summed(&each.0));
        rest.act((t, still()), (&self.bodies, &placed), &rest.fresh(), None, &mut sum);
        self.bodies.total(&placed, &sum.0)
    }

    /// [`Mechanism::differentiated`](crate::mechanism::Mechanism::differentiated) at time `t` (s), likewise.
    #[inline(always)]
    pub fn differentiated_abreast<S: Scalar, L: Lanes<S>, EL, R, const D: usize>(
        &self,
        lanes: &System<B::Lanes, EL>,
        rest: &R,
        t: S,
        pose: &B::Pose,
        velocity: &SVector<S, D>,
    ) -> Differentiated<S, JacobiansOf<S, B, D>, D>
    where
        B: AbreastBodies<S, L, D>,
        EL: Elements<L, B::Lanes, D>,
        R: Elements<S, B, D>,
    {
        let placed = self.bodies.placed(pose, velocity);
        let (zero, none) = (SVector::zeros(), <B::Lanes as Bodies<L, D>>::Jacobian::zero());
        let mut each = Derivatives { force: zero, per_time: zero, damping: none, stiffness: none };
        lanes.add_still(&B::everywhere(&placed), &mut each);
        let (mass, own) = self.bodies.mass_and_own_force(&placed);
        let mut sum = Derivatives {
            force: own + summed(&each.force),
            per_time: SVector::zeros(),
            damping: B::summed(&each.damping),
            stiffness: B::summed(&each.stiffness),
        };
        rest.act((t, still()), (&self.bodies, &placed), &rest.fresh(), None, &mut sum);
        self.completed(&placed, mass, sum)
    }

    /// [`forces_abreast`](Self::forces_abreast) where the machine has no lanes: the elements of each lane one after the other. The same
    /// bits, except for signs of zeros.
    pub fn forces_by_lane<S: Scalar, EL, R, const D: usize>(
        &self,
        lanes: &[EL; LANES],
        rest: &R,
        t: S,
        pose: &B::Pose,
        velocity: &SVector<S, D>,
    ) -> SVector<S, D>
    where
        B: Bodies<S, D>,
        EL: Elements<S, B, D>,
        R: Elements<S, B, D>,
    {
        let placed = self.bodies.placed(pose, velocity);
        let [first, second, third, fourth] = lanes.each_ref().map(|lane| {
            let mut sum = Sum(SVector::zeros());
            lane.act((S::zero(), still()), (&self.bodies, &placed), &lane.fresh(), None, &mut sum);
            sum.0
        });
        let mut sum = Sum(self.bodies.own_force(&placed) + (first + second + third + fourth));
        rest.act((t, still()), (&self.bodies, &placed), &rest.fresh(), None, &mut sum);
        self.bodies.total(&placed, &sum.0)
    }

    /// [`differentiated_abreast`](Self::differentiated_abreast), likewise.
    pub fn differentiated_by_lane<S: Scalar, EL, R, const D: usize>(
        &self,
        lanes: &[EL; LANES],
        rest: &R,
        t: S,
        pose: &B::Pose,
        velocity: &SVector<S, D>,
    ) -> Differentiated<S, JacobiansOf<S, B, D>, D>
    where
        B: Bodies<S, D>,
        EL: Elements<S, B, D>,
        R: Elements<S, B, D>,
    {
        let placed = self.bodies.placed(pose, velocity);
        let (zero, none) = (SVector::zeros(), B::Jacobian::zero());
        let [first, second, third, fourth] = lanes.each_ref().map(|lane| {
            let mut sum = Derivatives { force: zero, per_time: zero, damping: none, stiffness: none };
            lane.act((S::zero(), still()), (&self.bodies, &placed), &lane.fresh(), None, &mut sum);
            sum
        });
        let (mass, own) = self.bodies.mass_and_own_force(&placed);
        let mut sum = Derivatives {
            force: own + (first.force + second.force + third.force + fourth.force),
            per_time: zero,
            damping: [second.damping, third.damping, fourth.damping]
                .iter()
                .fold(first.damping, |sum, one| sum.plus(one, S::one())),
            stiffness: [second.stiffness, third.stiffness, fourth.stiffness]
                .iter()
                .fold(first.stiffness, |sum, one| sum.plus(one, S::one())),
        };
        rest.act((t, still()), (&self.bodies, &placed), &rest.fresh(), None, &mut sum);
        self.completed(&placed, mass, sum)
    }

    /// Adds what the elements do to bodies that are `placed`, of which none is a drive.
    #[inline(always)]
    fn add_still<L: Scalar, const D: usize>(&self, placed: &B::Placed, sum: &mut impl Assembly<L, B, D>)
    where
        B: Bodies<L, D>,
        E: Elements<L, B, D>,
    {
        self.elements.act((L::zero(), still()), (&self.bodies, placed), &self.elements.fresh(), None, sum);
    }
}

/// The sum over the lanes, number by number.
#[inline(always)]
fn summed<S: Scalar, L: Lanes<S>, const D: usize>(lanes: &SVector<L, D>) -> SVector<S, D> {
    let mut sums = SVector::<S, D>::zeros();
    for (sum, lanes) in sums.iter_mut().zip(lanes) {
        *sum = lanes.sum();
    }
    sums
}
