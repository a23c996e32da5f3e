//! Capability by the standard deviation, and by points for what is not normal (ISO 22514-2).

use super::{errors::Estimate, plain::PlainMeasure};

/// The probabilities of the natural limits ±3σ and of the median.
pub const POINTS: [f64; 3] = [0.001_35, 0.5, 0.998_65];

/// A capability from the three points and the limits, where these suffice for it.
type ByPoints = fn([f64; 3], [Option<f64>; 2]) -> Option<f64>;

/// Places on the way to the end of a point's interval.
const PARTS: u8 = 8;

/// Pp: the width between both limits over that between the outer points.
pub(super) const WIDTH: ByPoints = |[low, _, high], limits| Some((limits[1]? - limits[0]?) / (high - low));

/// Ppk: the nearer limit from the median over the outer point on its side.
pub(super) const NEARER: ByPoints = |[low, median, high], limits| {
    let below = limits[0].map(|limit| (median - limit) / (median - low));
    let above = limits[1].map(|limit| (limit - median) / (high - median));
    [below, above].into_iter().flatten().reduce(f64::min)
};

/// Ppk: the nearer limit from the mean over 3σ; infinite without limits.
pub(super) fn by_deviation(plain: &PlainMeasure, limits: [Option<f64>; 2]) -> f64 {
    let [below, above] = room(plain, limits);
    below.min(above) / (3.0 * plain.deviation)
}

/// Whether the upper limit is the nearer one.
pub(super) fn is_upper(plain: &PlainMeasure, limits: [Option<f64>; 2]) -> bool {
    let [below, above] = room(plain, limits);
    above < below
}

fn room(plain: &PlainMeasure, [lower, upper]: [Option<f64>; 2]) -> [f64; 2] {
    [lower.map_or(f64::INFINITY, |lower| plain.mean - lower), upper.map_or(f64::INFINITY, |upper| upper - plain.mean)]
}

/// A capability with its interval from those of its points, which are nearly independent: to either side the root of the sum
/// of squares of what each of them moves it (the method of variance estimates recovery, Zou and Donner 2008).
pub(super) fn with_interval(of: ByPoints, plain: &PlainMeasure, limits: [Option<f64>; 2]) -> Estimate {
    let points = POINTS.map(|p| plain.quantile(p));
    let value = of(points, limits).unwrap_or(f64::NAN);
    let ends = POINTS.map(|p| plain.enclosed(p));
    let side = |sign: f64| {
        let mut square = 0.0;
        for (k, ends) in ends.iter().enumerate() {
            let mut most: f64 = 0.0;
            for (end, outwards) in ends.iter().zip([-1.0, 1.0]) {
                let end_at = end.unwrap_or(points[k] + outwards * (points[2] - points[0]));
                // Between both ends, too: the nearer limit changes sides on the way.
                for part in 1..=PARTS {
                    let mut moved = points;
                    moved[k] += (end_at - points[k]) * f64::from(part) / f64::from(PARTS);
                    let change = sign * (of(moved, limits)? - value);
                    // Where the sample does not bound the point, it does not bound what that moves this way.
                    if end.is_none() && change > 0.0 {
                        return None;
                    }
                    most = most.max(change);
                }
            }
            square += most * most;
        }
        Some(value + sign * libm::sqrt(square))
    };
    Estimate { value, error: None, interval: [side(-1.0), side(1.0)] }
}
