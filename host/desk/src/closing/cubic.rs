//! The cubic that a gap follows over a step.

/// Where in its contact, from closing to the deepest point, a step ends that was made shorter.
const WITHIN: f64 = 0.2;

/// A gap over the share s of a step.
pub struct Cubic {
    /// Coefficients of 1, s, s² and s³.
    coefficients: [f64; 4],
}

impl Cubic {
    /// With these values and slopes at s = 0 and s = 1.
    pub fn new([y0, y1]: [f64; 2], [d0, d1]: [f64; 2]) -> Self {
        let rise = y1 - y0;
        Self { coefficients: [y0, d0, 3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise] }
    }

    fn at(&self, s: f64) -> f64 {
        let [a, b, c, d] = self.coefficients;
        a + s * (b + s * (c + s * d))
    }

    /// Where in (0, 1) it is least within, and how much it is there; `None` where it has no minimum there.
    pub fn lowest(&self) -> Option<(f64, f64)> {
        let [_, b, c, d] = self.coefficients;
        // b + 2c·s + 3d·s² = 0 where the slope rises, without cancellation.
        let under = c * c - 3.0 * b * d;
        if under < 0.0 {
            return None;
        }
        let root = libm::sqrt(under);
        let s = if c >= 0.0 { -b / (c + root) } else { (root - c) / (3.0 * d) };
        (s > 0.0 && s < 1.0).then(|| (s, self.at(s)))
    }

    /// A share shortly after it first becomes negative, which it is at `lowest` and not at 0.
    pub fn closing(&self, lowest: f64) -> f64 {
        let closed = bisected(lowest, |s| self.at(s) <= 0.0);
        closed + WITHIN * (lowest - closed)
    }

    /// A share where it comes from below `value` at 0, and is beyond at 1.
    pub fn opening(&self, value: f64) -> f64 {
        bisected(1.0, |s| self.at(s) > value)
    }
}

/// Where in (0, `last`) something `happens` that does not at 0 and does at `last`.
fn bisected(last: f64, happens: impl Fn(f64) -> bool) -> f64 {
    let (mut before, mut after) = (0.0, last);
    for _ in 0..40 {
        let middle = 0.5 * (before + after);
        if happens(middle) { after = middle } else { before = middle }
    }
    after
}

#[cfg(test)]
mod tests {
    use super::Cubic;

    #[test]
    fn a_cubic_has_its_minimum_where_it_is() {
        for (y, d) in [([1.0, 1.0], [-4.0, 4.0]), ([1.0, 0.5], [-6.0, 0.1]), ([0.2, 3.0], [-1.0, 9.0])] {
            let cubic = Cubic::new(y, d);
            let least =
                (1..1000).map(|k| f64::from(k) / 1000.0).map(|s| (cubic.at(s), s)).min_by(|a, b| a.0.total_cmp(&b.0));
            let (at, lowest) = cubic.lowest().unwrap();
            assert!((at - least.unwrap().1).abs() < 2e-3 && lowest <= least.unwrap().0);
        }
        assert!(Cubic::new([0.0, 1.0], [1.0, 1.0]).lowest().is_none());
    }
}
