//! A command that is not known in advance: what it was says what it will be, for a while.

use crate::Scalar;

/// Periods between the setpoints through which the parabola goes: more would follow a change later, fewer would make more of the
/// last digits of a setpoint.
const SPAN: usize = 4;

/// What was told of a command.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Told<S> {
    /// The last setpoints (m/s), the newest first.
    speeds: [S; 2 * SPAN + 1],
    /// How far (m/s times periods) the motion has strayed, since the command was another one than was reckoned with.
    strayed: S,
    /// Setpoints since the last ones were forgotten, as far as they count.
    count: S,
}

/// The parabola through three of the setpoints told.
#[derive(Clone, Copy)]
pub(super) struct Parabola<S> {
    newest: S,
    first: S,
    second: S,
}

impl<S: Scalar> Told<S> {
    /// Nothing.
    pub fn new() -> Self {
        Self { speeds: [S::zero(); 2 * SPAN + 1], strayed: S::zero(), count: S::zero() }
    }

    /// Forgets the setpoints: until there are enough new ones the command counts as constant.
    #[inline(always)]
    pub fn forget(&mut self) {
        self.count = S::zero();
    }

    /// Takes in the newest setpoint `speed` (m/s). Where the motion was predicted by another one, of which it is the `deviation` (m/s),
    /// that is made up for over four times the `horizon` (periods): a mechanism whose force goes by its place would else drift. What is
    /// not finite counts as what was before, and as no deviation.
    #[inline(always)]
    pub fn tell(&mut self, speed: S, deviation: S, horizon: S) -> Parabola<S> {
        let (zero, one) = (S::zero(), S::one());
        let speed = speed.or_old(one, self.speeds[0]);
        let mut newer = speed;
        for told in &mut self.speeds {
            newer = core::mem::replace(told, newer);
        }
        self.count = (self.count + one).at_most(S::from_f64(2.0 * SPAN as f64 + 1.0));
        self.strayed += deviation.or_old(one, zero);
        let (newest, middle, oldest) = (self.speeds[0], self.speeds[SPAN], self.speeds[2 * SPAN]);
        let known = self.count.select_gt(S::from_f64(2.0 * SPAN as f64), one, zero);
        let first = (newest - middle) * known;
        let second = (first - (middle - oldest) * known) * S::from_f64(0.5);
        Parabola { newest: newest + self.strayed / (horizon * S::from_f64(4.0)), first, second }
    }
}

impl<S: Scalar> Parabola<S> {
    /// The speed (m/s) so many `periods` after the newest setpoint.
    #[inline(always)]
    pub fn after(&self, periods: S) -> S {
        let x = periods * S::from_f64(1.0 / SPAN as f64);
        self.newest + x * (self.first + (x + S::one()) * self.second)
    }
}

#[cfg(test)]
mod tests {
    use super::{Parabola, SPAN, Told};

    #[test]
    fn a_parabola_is_extrapolated_exactly() {
        let y = |k: f64| 0.1 + 0.02 * k - 0.003 * k * k;
        let mut told = Told::new();
        let mut last = None;
        told.tell(77.0, 0.0, 20.0);
        told.forget();
        for k in 0..=2 * SPAN {
            // Constant until enough is known.
            assert!(last.is_none_or(|last: Parabola<f64>| last.after(20.0) == y(k as f64 - 1.0)), "{k}");
            last = Some(told.tell(y(k as f64), 0.0, 20.0));
        }
        for after in [0.0, 1.0, 5.0, 20.0] {
            let found = last.unwrap().after(after);
            assert!(libm::fabs(found - y(2.0 * SPAN as f64 + after)) < 1e-13, "{after}: {found}");
        }
    }

    #[test]
    fn what_is_not_finite_says_nothing() {
        let mut told = Told::new();
        for _ in 0..20 {
            told.tell(0.1, 0.0, 20.0);
        }
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(told.tell(bad, bad, 20.0).after(20.0), 0.1);
        }
    }

    /// With the delay of a horizon, what was strayed goes to zero, and does not swing.
    #[test]
    fn what_has_strayed_is_made_up_for() {
        for horizon in [4, 20, 200] {
            let mut told = Told::new();
            // What was reckoned with, until the horizon.
            let mut reckoned = [0.0; 200];
            let mut strayed = 0.0f64;
            for period in 0..horizon * 40 {
                let deviation = if period == 0 { 0.1 } else { 0.0 } - reckoned[0];
                strayed += deviation;
                let parabola = told.tell(0.0, deviation, horizon as f64);
                reckoned.copy_within(1.., 0);
                reckoned[horizon - 1] = parabola.after(0.0);
                assert!(strayed > -0.01, "{horizon} {period}: {strayed}");
            }
            assert!(libm::fabs(strayed) < 1e-3, "{horizon}: {strayed}");
        }
    }
}
