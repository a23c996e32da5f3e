//! How much a body has turned against another.

use super::{
    Placed, PlanarTree,
    topology::{Topology, Turns},
    turned,
};
use crate::{
    Cast, SMatrix, SVector, Scalar, Vector2,
    system::{GradientLink, Seen},
};

/// How much (rad, −π to π) a body has turned against another, or against the frame where there is none; and how fast (rad/s). Whole
/// turns are not in it: a law for which they count keeps them, like [`Spring`](crate::system::law::Spring).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning<A = Option<usize>, B = Option<usize>> {
    /// What turns the body.
    pub body: A,
    /// What turns the other.
    pub against: B,
}

/// It has no numbers.
impl Cast for Turning {
    type Of<T: Scalar> = Self;

    fn cast<T: Scalar>(&self, _: &mut impl FnMut(f64) -> T) -> Self {
        *self
    }
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

/// The arctangent as t·(1 + u·P(u)) with u = t²: the coefficients of P, fitted at Chebyshev's points to a relative error of 4e-17 for
/// |t| ≤ tan(π/16).
const ARCTANGENT: [f64; 7] = [
    -0.333_333_333_333_332_37,
    0.199_999_999_997_608_48,
    -0.142_857_141_888_354_44,
    0.111_110_963_672_385_24,
    -0.090_898_375_909_099_9,
    0.076_521_232_939_573_18,
    -0.059_097_869_797_455_585,
];

/// The angle (rad), −π to π, of a direction of unit length, without branches: the tangent of half the angle, halved three times more,
/// then a polynomial.
#[inline(always)]
fn angle<S: Scalar>(direction: &Vector2<S>) -> S {
    let (zero, one, huge) = (S::zero(), S::one(), S::from_f64(1e18));
    let (cosine, sine) = (direction.x, direction.y);
    // tan(θ/2) = sin/(1 + cos) = (1 − cos)/sin: each where it does not cancel.
    let over = cosine.select_gt(zero, sine, one - cosine);
    let under = cosine.select_gt(zero, one + cosine, sine);
    // The square of 1e18 is finite in f32.
    let mut t = (over / under).within(-huge, huge);
    for _ in 0..3 {
        t /= one + (one + t * t).sqrt();
    }
    let square = t * t;
    let mut series = zero;
    for coefficient in ARCTANGENT.iter().rev() {
        series = S::from_f64(*coefficient) + series * square;
    }
    S::from_f64(16.0) * (t + t * (series * square))
}

#[cfg(test)]
mod tests {
    use super::angle;
    use crate::{Scalar, Vector2};

    fn worst<S: Scalar>(unit: f64) {
        let mut worst = 0.0f64;
        for k in -20_000..=20_000 {
            // Everywhere, and ever closer to ±π and to 0.
            let far = core::f64::consts::PI * f64::from(k) / 20_000.0;
            for theta in [far, far * far * far * 1e-6, core::f64::consts::PI - libm::fabs(far * far * far) * 1e-6] {
                let direction = Vector2::new(S::from_f64(libm::cos(theta)), S::from_f64(libm::sin(theta)));
                let found = angle(&direction).to_f64();
                worst = worst.max(libm::fabs(found - theta) / libm::fabs(theta).max(1e-12));
            }
        }
        assert!(worst < unit, "{worst:e}");
    }

    #[test]
    #[cfg_attr(miri, ignore = "an interpreter has no time for so many angles")]
    fn an_angle_has_as_many_digits_as_its_direction_up_to_half_a_turn() {
        worst::<f64>(1e-15);
        worst::<f32>(6e-7);
    }
}
