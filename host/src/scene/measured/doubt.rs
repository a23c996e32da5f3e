//! Warnings about measured values: outliers, a drift, a shifted mean.

use slipfit_measured::{
    capability::{Sample, outliers},
    numeric::tails::student_quantile_above,
    production::Characteristic,
};
use slipfit_tolerance::number::{fixed, percent};

use crate::scene::value::Field;

/// Parts without which a drift is not looked for.
const LEAST_PARTS: usize = 10;
/// The probability to name a drift where there is none.
const SIGNIFICANCE: f64 = 0.001;
/// Share of half the tolerance from which on a shift is reported.
const SHIFTED: f64 = 0.1;

/// Warns of outliers and of a drift in the values measured for `of`, which is written in `field`.
pub fn warn(field: &Field, of: &str, characteristic: &Characteristic) {
    // Too few parts, or parts without a variation, are refused where a distribution is made of them.
    let sample = Sample::new(of, &characteristic.values).ok();
    for outlier in sample.iter().flat_map(|sample| outliers(sample, |part| (part + 1).to_string())) {
        field.warn(&format!(
            "`{of}`: part {} lies {} standard deviations from the mean, farther than a normal production reaches; it stays in the \
             distribution",
            outlier.label,
            fixed(outlier.distance, 1)
        ));
    }
    if let Some(drift) = drift(&characteristic.values) {
        field.warn(&format!(
            "`{of}` drifts by {} standard deviations from the first measured part to the last: later parts may have another \
             distribution",
            fixed(drift, 1)
        ));
    }
}

/// Warns of a measured mean off the middle of the `limits`, and of parts outside of them.
pub fn warn_of_shift(field: &Field, of: &str, values: &[Option<f64>], limits: [f64; 2]) {
    let measured: Vec<f64> = values.iter().copied().flatten().collect();
    let count = measured.len() as f64;
    let mean = measured.iter().sum::<f64>() / count;
    let half = 0.5 * (limits[1] - limits[0]);
    let shift = (mean - 0.5 * (limits[0] + limits[1])) / half;
    let outside = measured.iter().filter(|value| **value < limits[0] || **value > limits[1]).count();
    if shift.abs() < SHIFTED && outside == 0 {
        return;
    }
    let side = if shift < 0.0 { "below" } else { "above" };
    let beyond = match outside {
        0 => String::new(),
        parts => format!(", and {parts} of {} parts lie outside of it", measured.len()),
    };
    let by = percent(shift.abs(), 0);
    field.warn(&format!("`{of}`: the measured mean lies {by} % of half the tolerance {side} its middle{beyond}"));
}

/// How far (standard deviations) a straight line through the values moves from the first part to the last; none where chance
/// explains it.
fn drift(values: &[Option<f64>]) -> Option<f64> {
    let points: Vec<(f64, f64)> =
        values.iter().enumerate().filter_map(|(part, value)| Some((part as f64, (*value)?))).collect();
    if points.len() < LEAST_PARTS {
        return None;
    }
    let n = points.len() as f64;
    let [x, y] = [0, 1].map(|i| points.iter().map(|p| [p.0, p.1][i]).sum::<f64>() / n);
    let sum = |of: &dyn Fn(f64, f64) -> f64| points.iter().map(|p| of(p.0 - x, p.1 - y)).sum::<f64>();
    let (xx, xy, yy) = (sum(&|x, _| x * x), sum(&|x, y| x * y), sum(&|_, y| y * y));
    let slope = xy / xx;
    let rest = (yy - slope * xy).max(0.0) / (n - 2.0);
    let is_chance = slope.abs() <= student_quantile_above(0.5 * SIGNIFICANCE, n - 2.0) * libm::sqrt(rest / xx);
    let reach = slope * points.last().zip(points.first()).map_or(0.0, |(last, first)| last.0 - first.0);
    (!is_chance && yy > 0.0).then(|| reach.abs() / libm::sqrt(yy / (n - 1.0)))
}

#[cfg(test)]
mod tests {
    use super::drift;

    #[test]
    fn a_drift_is_told_from_chance() {
        let noise = |i: usize| ((i * 7919 + 13) % 101) as f64 / 101.0;
        let still: Vec<Option<f64>> = (0..200).map(|i| Some(noise(i))).collect();
        assert_eq!(drift(&still), None);
        let moving: Vec<Option<f64>> = (0..200).map(|i| Some(noise(i) + 0.005 * i as f64)).collect();
        let found = drift(&moving).expect("a drift");
        // One unit over all, beside a uniform noise of 1/√12 and the line's own 1/√12.
        assert!((found - 199.0 * 0.005 / libm::sqrt(2.0 / 12.0)).abs() < 0.1, "{found}");
        assert_eq!(drift(&moving[..9]), None);
    }
}
