//! The cubic between two knots of a motion, its slopes taken from their neighbours.
//!
//! Accelerations are no use as slopes: a stiff contact turns a velocity's last digits into large ones.

use crate::Scalar;

/// Neighbouring steps whose lengths differ by more than this factor meet at an event, such as a contact that closes: there
/// values bend, and the slope on one side is no guide to the other.
const EVENT: f64 = 4.0;

/// Weights of the changes of a value over three steps of the given `lengths`, which sum up to its change at the share `s` of the middle one.
/// The first and the last step may be missing: their length is 0, and so is their weight. The slope at either end is that of the
/// parabola through it and its neighbours; at an event, and at the end of all steps, of that through three knots on its own
/// side; of the chord where there are no such, or an event among them.
#[inline(always)]
pub(super) fn weights<S: Scalar>([before, own, after]: [S; 3], s: S) -> [S; 3] {
    let (one, zero) = (S::one(), S::zero());
    let start = slope([before, own, after]);
    let end = slope([after, own, before]);
    let rest = one - s;
    let (from_start, from_end) = (s * rest * rest, -(s * s * rest));
    let value = s * s * (one + rest + rest);
    let weight = |k: usize| start[k] * from_start + end[2 - k] * from_end;
    [before.select_gt(zero, weight(0), zero), value + weight(1), after.select_gt(zero, weight(2), zero)]
}

/// The slope at the end of a step that the step `other` meets, times its length: weights of the changes over the other step, the own
/// one, and the one at its other end.
#[inline(always)]
fn slope<S: Scalar>([other, own, further]: [S; 3]) -> [S; 3] {
    let (one, zero, event) = (S::one(), S::zero(), S::from_f64(EVENT));
    let either = |near: S, yes, no| (event * own).select_gt(near, (event * near).select_gt(own, yes, no), no);
    let both = own / (other + own);
    let share = own / (own + further);
    let own_side = [either(further, one + share, one), either(further, -(share * own / further), zero)];
    [either(other, both * own / other, zero), either(other, one - both, own_side[0]), either(other, zero, own_side[1])]
}

#[cfg(test)]
mod tests {
    use super::weights;

    fn value(y: impl Fn(f64) -> f64, knots: [f64; 4], t: f64) -> f64 {
        let [a, b, c, d] = knots;
        let [p, q, r] = weights([b - a, c - b, d - c], (t - b) / (c - b));
        y(b) + p * (y(b) - y(a)) + q * (y(c) - y(b)) + r * (y(d) - y(c))
    }

    #[test]
    fn parabolas_are_met_exactly() {
        let y = |t: f64| 1.0 + t * (2.0 - 3.0 * t);
        for knots in [
            [0.0, 0.1, 0.2, 0.3],
            [0.0, 0.1, 0.4, 0.5],
            [0.0, 0.1, 0.9, 1.0],
            [0.1, 0.1, 0.4, 0.5],
            [0.0, 0.1, 0.4, 0.4],
        ] {
            for s in [0.0, 0.1, 0.5, 0.9, 1.0] {
                let t = knots[1] + s * (knots[2] - knots[1]);
                // An event at either end leaves a chord there.
                if knots != [0.0, 0.1, 0.9, 1.0] {
                    assert!(libm::fabs(value(y, knots, t) - y(t)) < 1e-14, "{knots:?} {t}");
                }
            }
        }
        // The only step there is.
        assert_eq!(value(y, [0.1, 0.1, 0.5, 0.5], 0.3), 0.5 * (y(0.1) + y(0.5)));
    }

    #[test]
    fn a_bend_after_a_long_step_does_not_reach_into_it() {
        let y = |t: f64| if t < 0.4 { t * t } else { 0.16 + 7.0 * (t - 0.4) };
        assert!(libm::fabs(value(y, [0.0, 0.2, 0.4, 0.41], 0.3) - y(0.3)) < 1e-14);
        assert!(libm::fabs(value(y, [0.2, 0.4, 0.41, 0.42], 0.405) - y(0.405)) < 1e-14);
    }
}
