//! How slots fit their pin: whether both ends of one can push at once.
//!
//! A pin that fits with interference is pressed from both ends. One that fits with clearance meets one end at most, so that a step
//! need only compute the nearer one. Where gaps have a clearance, both ways compute the same force.

pub use super::bistop::SlotForce;
use super::{Normal, NormalResponse, bistop::SlotResponse};
use crate::{ParameterError, Scalar, error::bounded};

/// Gaps (m) of a pin at the nominal poses, left, right, rail and wall, and how the two slots between them fit. Four numbers are a fit
/// of any kind.
pub trait Fit: Copy {
    /// What gaps are told in.
    type Number: Scalar;

    /// What one of the slots does.
    type Slot: SlotForce<Self::Number>;

    /// Left, right, rail, wall.
    fn gaps(&self) -> [Self::Number; 4];

    /// What a slot of the law `normal` does, see [`Normal::slot`].
    fn slot<N: Normal<Self::Number>>(
        normal: &N,
        gaps: [Self::Number; 2],
        offset: Self::Number,
        speed: Self::Number,
    ) -> Self::Slot;
}

impl<S: Scalar> Fit for [S; 4] {
    type Number = S;
    type Slot = SlotResponse<S>;

    #[inline(always)]
    fn gaps(&self) -> [S; 4] {
        *self
    }

    #[inline(always)]
    fn slot<N: Normal<S>>(normal: &N, [lower, upper]: [S; 2], offset: S, speed: S) -> SlotResponse<S> {
        normal.slot(lower, upper, offset, speed)
    }
}

/// Gaps (m) of a pin whose slots are both at least as wide as it: the sum of left and right, and that of rail and wall, is not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClearanceFit<S> {
    gaps: [S; 4],
}

impl<S: Scalar + PartialOrd> ClearanceFit<S> {
    /// The same `gaps` (m): left, right, rail, wall.
    ///
    /// # Errors
    /// If a slot has no clearance, or a gap is not finite.
    pub fn new(gaps: [S; 4]) -> Result<Self, ParameterError<S>> {
        let [left, right, rail, wall] = gaps;
        for sum in [left + right, rail + wall] {
            bounded("clearance", sum, [0.0, f64::from(f32::MAX)])?;
        }
        Ok(Self { gaps })
    }
}

/// The end of a slot that the pin is nearer to, where it meets one at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearerEnd<S> {
    /// 1 for the end whose gap shrinks with the offset, −1 for the other.
    side: S,
    end: NormalResponse<S>,
}

impl<S: Scalar> Fit for ClearanceFit<S> {
    type Number = S;
    type Slot = NearerEnd<S>;

    #[inline(always)]
    fn gaps(&self) -> [S; 4] {
        self.gaps
    }

    #[inline(always)]
    fn slot<N: Normal<S>>(normal: &N, [lower, upper]: [S; 2], offset: S, speed: S) -> NearerEnd<S> {
        let (low, high) = (-(lower + offset), offset - upper);
        let side = high.select_gt(low, S::one(), -S::one());
        NearerEnd { side, end: normal.response(high.select_gt(low, high, low), -(side * speed)) }
    }
}

impl<S: Scalar> SlotForce<S> for NearerEnd<S> {
    #[inline(always)]
    fn force(&self) -> S {
        self.side * self.end.force
    }

    #[inline(always)]
    fn normal(&self) -> S {
        self.end.force
    }

    #[inline(always)]
    fn impedances(&self, over: Option<S>) -> [S; 2] {
        let own = self.end.impedance(over);
        [own, -(self.side * own)]
    }

    #[inline(always)]
    fn stiffnesses(&self) -> [S; 2] {
        let own = self.end.stiffness();
        [own, -(self.side * own)]
    }
}

#[cfg(test)]
mod tests {
    use super::{ClearanceFit, Fit, SlotForce};
    use crate::law::{Impact, ThreeHalves};

    #[test]
    fn one_end_does_what_both_do_where_there_is_a_clearance() {
        let law = Impact::new(ThreeHalves::new(3e6f32).unwrap(), 1000.0, 1e-4).unwrap();
        for gaps in [[0.0, 0.0], [1e-5, 3e-5], [-2e-5, 2e-5], [4e-5, -1e-5], [-1e-5, 1e6]] {
            for k in -120i8..=120 {
                for speed in [0.0, 0.003, -0.02] {
                    let offset = f32::from(k) * 1e-6;
                    let both = <[f32; 4]>::slot(&law, gaps, offset, speed);
                    let one = ClearanceFit::slot(&law, gaps, offset, speed);
                    assert_eq!((one.force(), one.normal()), (both.force(), both.normal()));
                    assert_eq!(one.stiffnesses(), both.stiffnesses());
                    for over in [None, Some(1e-3)] {
                        assert_eq!(one.impedances(over), both.impedances(over));
                    }
                }
            }
        }
    }

    #[test]
    fn refuses_interference() {
        assert_eq!(ClearanceFit::new([-1e-5f32, 1e-5, 0.0, 0.0]).map(|fit| fit.gaps()), Ok([-1e-5, 1e-5, 0.0, 0.0]));
        for gaps in [[0.0, -1e-9, 0.0, 0.0], [0.0, 0.0, 1.0, -1.5], [0.0, 0.0, f32::NAN, 0.0]] {
            assert!(ClearanceFit::new(gaps).is_err(), "{gaps:?}");
        }
    }
}
