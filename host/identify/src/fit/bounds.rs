//! Bounds by transformation: a parameter with two bounds is a sine of what is searched, one without is searched itself.

use crate::model::Parameter;

/// The value of a `parameter` for the searched number `u`, and its derivative.
pub fn value(parameter: &Parameter, u: f64) -> [f64; 2] {
    let [low, high] = parameter.bounds;
    if !parameter.is_bounded() {
        return [u, 1.0];
    }
    let half = 0.5 * (high - low);
    [low + half * (1.0 + libm::sin(u)), half * libm::cos(u)]
}

/// The searched number for a `value`. One at a bound is moved off it, where the derivative would be 0.
pub fn searched(parameter: &Parameter, value: f64) -> f64 {
    let [low, high] = parameter.bounds;
    if !parameter.is_bounded() {
        return value;
    }
    const INSIDE: f64 = 0.999;
    libm::asin((2.0 * (value - low) / (high - low) - 1.0).clamp(-INSIDE, INSIDE))
}

#[cfg(test)]
mod tests {
    use super::{Parameter, searched, value};

    #[test]
    fn values_come_back() {
        let parameter = Parameter { name: "a".into(), unit: "", bounds: [2.0, 5.0], start: 3.0, prior: None };
        for at in [2.1, 3.0, 4.9] {
            assert!((value(&parameter, searched(&parameter, at))[0] - at).abs() < 1e-12);
        }
        assert!(value(&parameter, 40.0)[0] <= 5.0 && value(&parameter, searched(&parameter, 5.0))[1] > 0.0);
    }
}
