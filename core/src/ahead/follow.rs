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
    /// 1 where what was told says nothing of what comes, else 0.
    is_past: S,
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
        Self { speeds: [S::zero(); 2 * SPAN + 1], strayed: S::zero(), is_past: S::one() }
    }

    /// Forgets the setpoints: until there are new ones the command stays what it is.
    #[inline(always)]
    pub fn forget(&mut self) {
        self.is_past = S::one();
    }

    /// Takes in the newest setpoint `speed` (m/s). Where the motion was predicted by another one, of which it is the `deviation` (m/s),
    /// that is made up for over four times the `horizon` (periods): a mechanism whose force goes by its place would else drift.
    #[inline(always)]
    pub fn tell(&mut self, speed: S, deviation: S, horizon: S) -> Parabola<S> {
        let (zero, is_past) = (S::zero(), self.is_past);
        let mut newer = speed;
        for told in &mut self.speeds {
            newer = core::mem::replace(told, is_past.select_gt(zero, speed, newer));
        }
        self.is_past = zero;
        self.strayed += deviation;
        let (newest, middle, oldest) = (self.speeds[0], self.speeds[SPAN], self.speeds[2 * SPAN]);
        let first = newest - middle;
        let second = (first - (middle - oldest)) * S::from_f64(0.5);
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
    use super::{SPAN, Told};

    #[test]
    fn a_parabola_is_extrapolated_exactly() {
        let y = |k: f64| 0.1 + 0.02 * k - 0.003 * k * k;
        let mut told = Told::new();
        let mut last = None;
        told.tell(77.0, 0.0, 20.0);
        told.forget();
        assert_eq!(told.tell(0.3, 0.0, 20.0).after(10.0), 0.3);
        for k in 0..=2 * SPAN {
            last = Some(told.tell(y(k as f64), 0.0, 20.0));
        }
        for after in [0.0, 1.0, 5.0, 20.0] {
            let found = last.unwrap().after(after);
            assert!(libm::fabs(found - y(2.0 * SPAN as f64 + after)) < 1e-13, "{after}: {found}");
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
