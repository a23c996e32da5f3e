//! Gauss's points and their weights.

/// A weighted point of up to four variables, such as those of a contributor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Its weight; all together add up to 1.
    pub weight: f64,
    /// Its place.
    pub at: [f64; 4],
}

/// Points of a piece.
pub const POINTS: usize = 10;

/// Gauss–Legendre points between `from` and `to`, with weights that add up to its length.
pub fn piece(from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    (0..POINTS).map(move |i| {
        let mut x = libm::cos(std::f64::consts::PI * (i as f64 + 0.75) / (POINTS as f64 + 0.5));
        let mut slope = 1.0;
        // Newton's method on the Legendre polynomial; quadratic from this start.
        for _ in 0..6 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=POINTS {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = POINTS as f64 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (middle - half * x, half * 2.0 / ((1.0 - x * x) * slope * slope))
    })
}
