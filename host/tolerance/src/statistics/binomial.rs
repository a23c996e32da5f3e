//! Limits of a probability of which some hits were seen (Clopper and Pearson 1934), for any number of units.
//!
//! A limit is the probability at which as many hits or more, or as few or fewer, have a given chance. That chance is a
//! sum of binomial terms that fall from the first one on, so it has no cancellation and takes some eight standard
//! deviations of terms. The first term is C. Loader's saddle-point form ("Fast and accurate computation of binomial
//! probabilities", 2000), which is accurate for 10¹² units, where differences of log-gamma functions are not.

use std::f64::consts::TAU;

/// Terms below this share of their sum end it.
const NEGLIGIBLE: f64 = 1e-17;
/// Relative accuracy of a limit.
const ACCURACY: f64 = 1e-13;
/// Safeguarded Newton steps; bisection alone would need fewer than twice the digits of a number.
const MOST_STEPS: usize = 128;

/// Lower and upper limit of the probability when `hits` of `units` ≥ 1 were seen, each with the chance `side` beyond it.
pub fn limits(hits: u64, units: u64, side: f64) -> [f64; 2] {
    // The rarer outcome is the accurate one.
    if hits > units / 2 {
        let [lower, upper] = limits(units - hits, units, side);
        return [1.0 - upper, 1.0 - lower];
    }
    let n = units as f64;
    if hits == 0 {
        return [0.0, -libm::expm1(libm::log(side) / n)];
    }
    let (k, share) = (hits as f64, hits as f64 / n);
    // The slopes of both chances are their first terms times k/p and (n − k)/(1 − p).
    let lower = solve([0.0, share], true, side, |p| {
        let [term, sum] = at_least(k, n, p);
        [sum, term * k / p]
    });
    let upper = solve([share, 1.0], false, side, |p| {
        let [term, sum] = at_most(k, n, p);
        [sum, -term * (n - k) / (1.0 - p)]
    });
    [lower, upper]
}

/// Where the chance, which rises or falls all over the `bracket`, is `side`: Newton's steps on its logarithm, a halved
/// bracket where one leaves or the chance is too small for a number.
fn solve(bracket: [f64; 2], rises: bool, side: f64, chance: impl Fn(f64) -> [f64; 2]) -> f64 {
    let [mut low, mut high] = bracket;
    let mut p = 0.5 * (low + high);
    for _ in 0..MOST_STEPS {
        let [sum, slope] = chance(p);
        let excess = libm::log(sum / side);
        if (excess > 0.0) == rises {
            high = p;
        } else {
            low = p;
        }
        let next = p - excess * sum / slope;
        let next = if low < next && next < high { next } else { 0.5 * (low + high) };
        if (next - p).abs() <= ACCURACY * next {
            return next;
        }
        p = next;
    }
    p
}

/// The probability of `k` hits of `n`, and of `k` or more, for n·p ≤ k.
fn at_least(k: f64, n: f64, p: f64) -> [f64; 2] {
    let odds = p / (1.0 - p);
    series(term(k, n, p), |j| (n - k - j) / (k + j + 1.0) * odds)
}

/// The probability of `k` hits of `n`, and of `k` or fewer, for n·p ≥ k.
fn at_most(k: f64, n: f64, p: f64) -> [f64; 2] {
    let odds = (1.0 - p) / p;
    series(term(k, n, p), |j| (k - j) / (n - k + j + 1.0) * odds)
}

/// A first term and the sum of all, the next each `ratio` < 1 times as large.
fn series(first: f64, ratio: impl Fn(f64) -> f64) -> [f64; 2] {
    let (mut term, mut sum, mut j) = (1.0, 1.0, 0.0);
    while term > NEGLIGIBLE * sum {
        term *= ratio(j);
        sum += term;
        j += 1.0;
    }
    [first, first * sum]
}

/// The probability of 0 < `k` < `n` hits of `n`.
fn term(k: f64, n: f64, p: f64) -> f64 {
    let (misses, q) = (n - k, 1.0 - p);
    let exponent = stirling(n) - stirling(k) - stirling(misses) - deviance(k, n * p) - deviance(misses, n * q);
    libm::exp(exponent) * libm::sqrt(n / (TAU * k * misses))
}

/// k·ln(k/m) + m − k.
fn deviance(k: f64, m: f64) -> f64 {
    let d = (k - m) / m;
    m * ((1.0 + d) * libm::log1p(d) - d)
}

/// What Stirling's formula leaves of ln k!, for k ≥ 1.
fn stirling(k: f64) -> f64 {
    if k < 16.0 {
        return libm::lgamma(k + 1.0) - (k + 0.5) * libm::log(k) + k - 0.5 * libm::log(TAU);
    }
    let square = 1.0 / (k * k);
    (1.0 / 12.0 - square * (1.0 / 360.0 - square * (1.0 / 1260.0 - square / 1680.0))) / k
}

#[cfg(test)]
mod tests {
    use super::limits;

    const SIDE: f64 = 0.025;

    #[track_caller]
    fn close(found: f64, expected: f64, relative: f64) {
        assert!((found / expected - 1.0).abs() <= relative, "{found:e}, not {expected:e}");
    }

    #[test]
    fn tabulated_limits() {
        // Clopper and Pearson's limits of 1000 units.
        for (hits, lower, upper) in [
            (1, 2.531_748_749_129_4e-5, 5.558_924_279_826_7e-3),
            (12, 6.215_525_559_595_2e-3, 2.086_767_959_103_6e-2),
            (60, 4.609_503_542_248_4e-2, 7.656_049_040_393_5e-2),
            (500, 0.468_549_172_971_79, 0.531_450_827_028_21),
        ] {
            let found = limits(hits, 1000, SIDE);
            close(found[0], lower, 1e-12);
            close(found[1], upper, 1e-12);
        }
    }

    #[test]
    fn closed_forms_at_the_ends_of_any_number_of_units() {
        for power in 3..=12 {
            let units = 10u64.pow(power);
            let n = units as f64;
            let one_side = |chance: f64| -libm::expm1(libm::log(chance) / n);
            let none = limits(0, units, SIDE);
            assert_eq!(none[0], 0.0);
            close(none[1], one_side(SIDE), 1e-14);
            assert_eq!(limits(units, units, SIDE), [1.0 - none[1], 1.0]);
            let one = limits(1, units, SIDE);
            close(one[0], one_side(1.0 - SIDE), 1e-11);
            let all_but_one = limits(units - 1, units, SIDE);
            assert_eq!(all_but_one, [1.0 - one[1], 1.0 - one[0]]);
            // Poisson's limits for rare hits; the binomial ones are wider by about a part in the number of units.
            for (hits, [lower, upper]) in [
                (1, [0.025_317_807_984, 5.571_643_390_939]),
                (12, [6.200_575_108_722, 20.961_585_048_177]),
                (60, [45.786_320_950_007, 77.231_893_406_643]),
            ] {
                let found = limits(hits, units, SIDE);
                close(found[0] * n, lower, 1e-11 + 20.0 / n);
                close(found[1] * n, upper, 1e-11 + 20.0 / n);
            }
        }
    }

    #[test]
    fn the_middle_is_nearly_normal() {
        for units in [1_000_000u64, 1_000_000_000, 1_000_000_000_000] {
            let [lower, upper] = limits(units / 2, units, SIDE);
            let half = 1.959_963_985 * libm::sqrt(0.25 / units as f64);
            close(0.5 - lower, half, 2e-3);
            close(upper - 0.5, half, 2e-3);
        }
    }
}
