//! Zeros of a rising function between two points.

/// Evaluations after which the bracket is as narrow as halving alone would make it.
const MOST_STEPS: usize = 200;

/// Where `function`, which rises from a value of 0 or less at `low` to one of 0 or more at `high`, has its zero, or jumps over
/// it: to the last digits; not a number where an end is not finite. Inverse quadratic interpolation where it is safe, halves of the bracket elsewhere (Chandrupatla,
/// "A new hybrid quadratic/bisection algorithm", Advances in Engineering Software 28, 1997).
pub fn zero(low: f64, high: f64, function: impl Fn(f64) -> f64) -> f64 {
    // The newest point, one on the other side of the zero, and the one before.
    let [mut a, mut b] = [high, low];
    if !(a.is_finite() && b.is_finite()) {
        return f64::NAN;
    }
    let [mut fa, mut fb] = [function(a), function(b)];
    if fa <= 0.0 {
        return high;
    }
    if fb >= 0.0 {
        return low;
    }
    let mut part = 0.5;
    for _ in 0..MOST_STEPS {
        let x = a + part * (b - a);
        let fx = function(x);
        let (c, fc);
        if (fx > 0.0) == (fa > 0.0) {
            (c, fc) = (a, fa);
        } else {
            (c, fc) = (b, fb);
            (b, fb) = (a, fa);
        }
        (a, fa) = (x, fx);
        let nearest = if fa.abs() < fb.abs() { a } else { b };
        let least = (2.0 * f64::EPSILON * nearest.abs() + f64::MIN_POSITIVE) / (b - a).abs();
        if fa == 0.0 || least >= 0.5 {
            return nearest;
        }
        let (place, height) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
        let curved = height * height < place && (1.0 - height) * (1.0 - height) < 1.0 - place;
        part = if curved {
            fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        } else {
            0.5
        };
        part = part.clamp(least, 1.0 - least);
    }
    a
}

/// How far a probability `found` lies above the `wanted` one, from −1 to 1: nearly a straight line of its logarithm.
pub fn excess(found: f64, wanted: f64) -> f64 {
    (found - wanted) / (found + wanted)
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use crate::numeric::root::zero;

    #[test]
    fn without_finite_ends_there_is_no_zero() {
        for [low, high] in [[f64::NAN, 1.0], [0.0, f64::INFINITY], [f64::INFINITY, f64::NEG_INFINITY]] {
            assert!(zero(low, high, |x| x - 0.5).is_nan(), "{low} {high}");
        }
    }

    #[test]
    fn zeros_are_found_to_the_last_digits() {
        let count = Cell::new(0);
        let counted = |x: f64| {
            count.set(count.get() + 1);
            x * x * x - 2.0
        };
        assert!((zero(0.0, 10.0, counted) - libm::cbrt(2.0)).abs() < 1e-15);
        assert!(count.get() < 20, "{}", count.get());
        // Flat nearly everywhere, and a jump.
        assert!((zero(-1.0, 1e3, |x| libm::tanh(50.0 * (x - 0.3))) - 0.3).abs() < 1e-15);
        assert!((zero(0.0, 4.0, |x| if x < 3.0 { -1.0 } else { 1.0 }) - 3.0).abs() < 1e-14);
        assert_eq!([zero(1.0, 2.0, |x| x), zero(1.0, 2.0, |x| x - 2.0)], [1.0, 2.0]);
    }
}
