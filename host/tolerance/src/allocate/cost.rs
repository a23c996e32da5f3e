//! What a tolerance costs: by a law, within what a process can make.

/// Cost of a part over its tolerance t (SI: m or rad). Both laws fall and are convex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// A + B·(u/t)^k.
    Reciprocal {
        /// A.
        fixed: f64,
        /// B ≥ 0: what a tolerance of u costs beyond A.
        factor: f64,
        /// u (SI), positive.
        unit: f64,
        /// k, positive.
        power: f64,
    },
    /// A + B·exp(−t/u).
    Exponential {
        /// A.
        fixed: f64,
        /// B ≥ 0.
        factor: f64,
        /// u (SI), positive.
        unit: f64,
    },
}

/// Tolerances (SI, positive, ascending) that a process can hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Anything from the first to the second.
    Range([f64; 2]),
    /// One of these, at least one.
    List(Vec<f64>),
}

/// A way to make a part.
#[derive(Clone, Debug, PartialEq)]
pub struct Process {
    /// Name; may be empty.
    pub name: String,
    /// What it costs.
    pub law: Law,
    /// What it can hold.
    pub values: Values,
}

/// Steps of the search for a least cost.
const STEPS: usize = 100;

impl Law {
    /// Cost of a tolerance.
    pub fn cost(&self, t: f64) -> f64 {
        match *self {
            Self::Reciprocal { fixed, factor, unit, power } => fixed + factor * libm::pow(unit / t, power),
            Self::Exponential { fixed, factor, unit } => fixed + factor * libm::exp(-t / unit),
        }
    }

    /// First and second derivative of the cost (1/SI, 1/SI²).
    pub fn derivatives(&self, t: f64) -> [f64; 2] {
        match *self {
            Self::Reciprocal { factor, unit, power, .. } => {
                let slope = -factor * power * libm::pow(unit / t, power) / t;
                [slope, -slope * (power + 1.0) / t]
            }
            Self::Exponential { factor, unit, .. } => {
                let slope = -factor * libm::exp(-t / unit) / unit;
                [slope, -slope / unit]
            }
        }
    }

    /// The tolerance in `range` at which cost + a·t + b·t² is least; a and b are not negative.
    pub fn best(&self, [a, b]: [f64; 2], range: [f64; 2]) -> f64 {
        let [low, high] = range;
        if a == 0.0 && b == 0.0 {
            return high;
        }
        if let Self::Reciprocal { factor, unit, power, .. } = *self {
            let numerator = factor * power * libm::pow(unit, power);
            if b == 0.0 {
                return libm::pow(numerator / a, 1.0 / (power + 1.0)).clamp(low, high);
            }
            if a == 0.0 {
                return libm::pow(numerator / (2.0 * b), 1.0 / (power + 2.0)).clamp(low, high);
            }
        }
        let slope = |t: f64| {
            let [first, second] = self.derivatives(t);
            (first + a + 2.0 * b * t, second + 2.0 * b)
        };
        if slope(high).0 <= 0.0 {
            return high;
        }
        if slope(low).0 >= 0.0 {
            return low;
        }
        // Newton's steps, by halves of the bracket where they leave it.
        let ([mut left, mut right], mut t) = (range, libm::sqrt(low * high));
        for _ in 0..STEPS {
            let (value, curvature) = slope(t);
            if value > 0.0 {
                right = t
            } else {
                left = t
            }
            let newton = t - value / curvature;
            let next = if newton > left && newton < right { newton } else { 0.5 * (left + right) };
            if (next - t).abs() <= 1e-15 * t {
                break;
            }
            t = next;
        }
        t
    }
}

impl Values {
    /// The tightest and the widest.
    pub fn ends(&self) -> [f64; 2] {
        match self {
            Self::Range(range) => *range,
            Self::List(values) => [values[0], values[values.len() - 1]],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Law;

    const LAWS: [Law; 3] = [
        Law::Reciprocal { fixed: 2.0, factor: 3.0, unit: 0.5, power: 1.0 },
        Law::Reciprocal { fixed: 1.0, factor: 0.1, unit: 1.0, power: 0.45 },
        Law::Exponential { fixed: 1.0, factor: 4.0, unit: 0.2 },
    ];

    #[test]
    fn derivatives_are_those_of_the_cost() {
        for law in LAWS {
            for t in [0.01, 0.1, 0.7] {
                let h = 1e-5 * t;
                let [first, second] = law.derivatives(t);
                let [left, middle, right] = [t - h, t, t + h].map(|t| law.cost(t));
                assert!(((right - left) / (2.0 * h) / first - 1.0).abs() < 1e-7, "{law:?} {t}");
                assert!(((right + left - 2.0 * middle) / (h * h) / second - 1.0).abs() < 1e-3, "{law:?} {t}");
            }
        }
    }

    #[test]
    fn nothing_in_the_range_is_cheaper_than_the_best() {
        let range = [0.01, 1.0];
        for law in LAWS {
            for prices in [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0], [2.0, 5.0], [1e6, 1.0], [0.0, 1e-9]] {
                let total = |t: f64| law.cost(t) + prices[0] * t + prices[1] * t * t;
                let best = law.best(prices, range);
                assert!((range[0]..=range[1]).contains(&best));
                let grid = (0..=1000).map(|i| range[0] + (range[1] - range[0]) * f64::from(i) / 1000.0);
                let least = grid.map(total).fold(f64::INFINITY, f64::min);
                assert!(total(best) <= least * (1.0 + 1e-12), "{law:?} {prices:?} {best}");
            }
        }
    }
}
