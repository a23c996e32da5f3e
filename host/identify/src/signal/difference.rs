//! Derivatives of sampled signals.

/// The first derivative by central differences, one-sided at both ends; `step` is the interval of the samples.
pub fn central(signal: &[f64], step: f64) -> Vec<f64> {
    let n = signal.len();
    let slope = |i: usize| {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(n - 1));
        (signal[after] - signal[before]) / ((after - before).max(1) as f64 * step)
    };
    (0..n).map(slope).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn parabolas_have_exact_slopes_within() {
        let parabola: Vec<f64> = (0..10).map(|i| 0.25 * f64::from(i * i)).collect();
        let slopes = super::central(&parabola, 0.5);
        for (i, slope) in slopes.iter().enumerate().take(9).skip(1) {
            assert!((slope - i as f64).abs() < 1e-12, "{slope}");
        }
        assert_eq!(slopes[0], 0.5);
    }
}
