//! A command that is not known in advance, extrapolated from its last setpoints.

use crate::Scalar;

/// Periods between the setpoints through which the parabola goes: more would follow a change later, fewer would make more of the
/// last digits of a setpoint.
const SPAN: usize = 4;

/// The last setpoints of a command.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct History<S> {
    /// The last setpoints (m/s), the newest first.
    speeds: [S; 2 * SPAN + 1],
    /// Sum of all deviations (m/s times periods): position error of the prediction over the period.
    position_error: S,
    /// Setpoints since the history was cleared, up to as many as the parabola needs.
    count: S,
}

/// The parabola through three of the setpoints.
#[derive(Clone, Copy)]
pub(super) struct Parabola<S> {
    newest: S,
    first: S,
    second: S,
}

impl<S: Scalar> History<S> {
    /// Empty.
    pub fn new() -> Self {
        Self { speeds: [S::zero(); 2 * SPAN + 1], position_error: S::zero(), count: S::zero() }
    }

    /// Drops the setpoints: the command is extrapolated as constant until there are enough new ones.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.count = S::zero();
    }

    /// Adds the newest setpoint `speed` (m/s). Its `deviation` (m/s) from the setpoint by which the motion was predicted is summed up and
    /// fed back with a time constant of four times the `horizon` (periods), because the position would drift otherwise. A speed that is
    /// not finite repeats the last one, such a deviation counts as zero.
    #[inline(always)]
    pub fn update(&mut self, speed: S, deviation: S, horizon: S) -> Parabola<S> {
        let (zero, one) = (S::zero(), S::one());
        let speed = speed.or_old(one, self.speeds[0]);
        let mut newer = speed;
        for older in &mut self.speeds {
            newer = core::mem::replace(older, newer);
        }
        self.count = (self.count + one).at_most(S::from_f64(2.0 * SPAN as f64 + 1.0));
        self.position_error += deviation.or_old(one, zero);
        let (newest, middle, oldest) = (self.speeds[0], self.speeds[SPAN], self.speeds[2 * SPAN]);
        let known = self.count.select_gt(S::from_f64(2.0 * SPAN as f64), one, zero);
        let first = (newest - middle) * known;
        let second = (first - (middle - oldest) * known) * S::from_f64(0.5);
        Parabola { newest: newest + self.position_error / (horizon * S::from_f64(4.0)), first, second }
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
    use super::{History, Parabola, SPAN};

    #[test]
    fn a_parabola_is_extrapolated_exactly() {
        let y = |k: f64| 0.1 + 0.02 * k - 0.003 * k * k;
        let mut history = History::new();
        let mut last = None;
        history.update(77.0, 0.0, 20.0);
        history.clear();
        for k in 0..=2 * SPAN {
            // Constant until enough is known.
            assert!(last.is_none_or(|last: Parabola<f64>| last.after(20.0) == y(k as f64 - 1.0)), "{k}");
            last = Some(history.update(y(k as f64), 0.0, 20.0));
        }
        for after in [0.0, 1.0, 5.0, 20.0] {
            let found = last.unwrap().after(after);
            assert!(libm::fabs(found - y(2.0 * SPAN as f64 + after)) < 1e-13, "{after}: {found}");
        }
    }

    #[test]
    fn what_is_not_finite_says_nothing() {
        let mut history = History::new();
        for _ in 0..20 {
            history.update(0.1, 0.0, 20.0);
        }
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(history.update(bad, bad, 20.0).after(20.0), 0.1);
        }
    }

    /// Despite the delay of a horizon, the position error decays to zero without oscillation.
    #[test]
    fn position_errors_decay() {
        for horizon in [4, 20, 200] {
            let mut history = History::new();
            // Setpoints by which the motion is predicted, up to the horizon.
            let mut assumed = [0.0; 200];
            let mut position_error = 0.0f64;
            for period in 0..horizon * 40 {
                let deviation = if period == 0 { 0.1 } else { 0.0 } - assumed[0];
                position_error += deviation;
                let parabola = history.update(0.0, deviation, horizon as f64);
                assumed.copy_within(1.., 0);
                assumed[horizon - 1] = parabola.after(0.0);
                assert!(position_error > -0.01, "{horizon} {period}: {position_error}");
            }
            assert!(libm::fabs(position_error) < 1e-3, "{horizon}: {position_error}");
        }
    }
}
