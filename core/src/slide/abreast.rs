//! The four pins side by side: where a number is a lane of four, contacts take the time of one pin.
//!
//! For desks, whose processors have such lanes. The bits are those of one pin after the other.

use super::{PINS, Slide};
use crate::{
    SVector, Scalar, Vector3,
    law::{Elastic, Friction},
    linear::Blocks,
    mechanism::{Differentiated, Way},
    menu::SlideData,
    pose::Pose,
    system::{
        Assembly, Bodies, Derivatives, Elements, Jacobian, JacobiansOf, Sum,
        spatial::{Floating, FloatingPlaced as Placed},
    },
};

/// Numbers `S` side by side, one for each pin.
pub trait Lanes<S>: Scalar {
    /// The `numbers`, each in its lane.
    fn of(numbers: [S; PINS]) -> Self;

    /// The sum over the lanes, from the first to the last.
    fn sum(self) -> S;
}

/// `number` in every lane.
#[inline(always)]
fn everywhere<S: Copy, L: Lanes<S>>(number: S) -> L {
    L::of([number; PINS])
}

/// The pins of a slide side by side, with its contact laws.
#[derive(Clone, Copy, Debug)]
pub struct Abreast<L, E, F> {
    /// Each of its pins stands for all of them.
    lanes: Slide<L, E, F>,
}

/// What a slide of lanes is to be made of for [`Abreast::new`]: the parameters of `slide` in every lane, and in place of each
/// pin all of them, each in its lane.
pub fn abreast<S: Scalar, L: Lanes<S>>(slide: &SlideData<S>) -> SlideData<L> {
    let mut lanes = slide.cast(everywhere);
    let [a, b, c, d] = slide.body.pins_w;
    let place = Vector3::new(L::of([a.x, b.x, c.x, d.x]), L::of([a.y, b.y, c.y, d.y]), L::of([a.z, b.z, c.z, d.z]));
    lanes.body.pins_w = [place; PINS];
    #[rustfmt::skip]
    let [
        left_a, right_a, rail_a, wall_a,
        left_b, right_b, rail_b, wall_b,
        left_c, right_c, rail_c, wall_c,
        left_d, right_d, rail_d, wall_d,
    ] = slide.body.gaps;
    let [left, right, rail, wall] = [
        [left_a, left_b, left_c, left_d],
        [right_a, right_b, right_c, right_d],
        [rail_a, rail_b, rail_c, rail_d],
        [wall_a, wall_b, wall_c, wall_d],
    ]
    .map(L::of);
    lanes.body.gaps =
        [left, right, rail, wall, left, right, rail, wall, left, right, rail, wall, left, right, rail, wall];
    lanes
}

impl<L, E: Elastic<L>, F: Friction<L, Internal = ()>> Abreast<L, E, F> {
    /// From the slide whose parameters are those of [`abreast`].
    pub fn new(lanes: Slide<L, E, F>) -> Self {
        Self { lanes }
    }

    /// Adds what happens at each pin, in its lane, of a slide that is and moves as `at`.
    #[inline(always)]
    fn act<S: Scalar>(&self, at: &Placed<S>, sum: &mut impl Assembly<L, Floating<L>, 6>)
    where
        L: Lanes<S>,
    {
        for pin in self.lanes.elements().0.iter().take(1) {
            pin.act((L::zero(), still()), (self.lanes.bodies(), &at.cast(everywhere)), &[(); 2], None, sum);
        }
    }
}

/// There is no step, and no friction that remembers.
#[inline(always)]
fn still<S: Scalar>() -> Way<S> {
    Way { over: None, mass_rate: S::zero(), tangent_share: S::one() }
}

impl<S: Scalar, E: Elastic<S>, F: Friction<S>> Slide<S, E, F> {
    /// [`Mechanism::forces`](crate::mechanism::Mechanism::forces) (N, N·m) at time `t` (s) with its `pins` side by side.
    #[inline(always)]
    pub fn forces_abreast<L: Lanes<S>, EL: Elastic<L>, FL: Friction<L, Internal = ()>>(
        &self,
        pins: &Abreast<L, EL, FL>,
        t: S,
        pose: &Pose<S>,
        velocity: &SVector<S, 6>,
    ) -> SVector<S, 6> {
        let at = self.bodies().placed(pose, velocity);
        let mut lanes = Sum(SVector::zeros());
        pins.act(&at, &mut lanes);
        let mut sum = Sum(summed(&lanes.0));
        self.elements().1.act((t, still()), (self.bodies(), &at), &(), None, &mut sum);
        self.bodies().total(&at, &sum.0)
    }

    /// [`Mechanism::differentiated`](crate::mechanism::Mechanism::differentiated) at time `t` (s) with its `pins` side by side.
    #[inline(always)]
    pub fn differentiated_abreast<L: Lanes<S>, EL: Elastic<L>, FL: Friction<L, Internal = ()>>(
        &self,
        pins: &Abreast<L, EL, FL>,
        t: S,
        pose: &Pose<S>,
        velocity: &SVector<S, 6>,
    ) -> Differentiated<S, JacobiansOf<S, Floating<S>, 6>, 6> {
        let at = self.bodies().placed(pose, velocity);
        let (zero, none) = (SVector::zeros(), Blocks::zero());
        let mut lanes = Derivatives { force: zero, per_time: zero, damping: none, stiffness: none };
        pins.act(&at, &mut lanes);
        let mut sum = Derivatives {
            force: summed(&lanes.force),
            per_time: SVector::zeros(),
            damping: lanes.damping.cast(L::sum),
            stiffness: lanes.stiffness.cast(L::sum),
        };
        self.elements().1.act((t, still()), (self.bodies(), &at), &(), None, &mut sum);
        self.completed(&at, (), sum)
    }
}

/// The sum over the lanes, number by number.
#[inline(always)]
fn summed<S: Scalar, L: Lanes<S>>(lanes: &SVector<L, 6>) -> SVector<S, 6> {
    let [a, b, c, d, e, f] = lanes.data.0[0];
    SVector::<S, 6>::new(a.sum(), b.sum(), c.sum(), d.sum(), e.sum(), f.sum())
}
