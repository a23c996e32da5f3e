//! Outliers are named, and stay in every figure.

use serde::Serialize;

use super::sample::{Sample, mean_and_deviation};
use crate::numeric::tails::student_quantile_above;

/// The probability to name one or more of a normal sample.
pub const SIGNIFICANCE: f64 = 0.05;
/// Parts from which on more than one outlier is looked for, as the test's level holds from there on.
const SEVERAL: usize = 25;
/// The most outliers that are looked for.
const MOST: usize = 50;

/// A value too far away for a normal production.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outlier {
    /// Index of the part, from 0.
    pub part: usize,
    /// Label of the part.
    pub label: String,
    /// Its value.
    pub value: f64,
    /// Its distance from the mean, in standard deviations, without the outliers farther out.
    pub distance: f64,
}

/// A step of the test.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    part: usize,
    value: f64,
    statistic: f64,
    critical: f64,
}

/// The values that the generalised extreme studentised deviate test names (B. Rosner, "Percentage points for a generalized
/// ESD many-outlier procedure", Technometrics 25, 1983), of up to a tenth of the parts; below 25 parts the farthest
/// value alone, which is F. Grubbs' test.
pub fn outliers(sample: &Sample, label: impl Fn(usize) -> String) -> Vec<Outlier> {
    let n = sample.sorted.len();
    let most = if n < SEVERAL { 1 } else { (n / 10).min(MOST) };
    let steps = steps(sample, most);
    let named = steps.iter().rposition(|step| step.statistic > step.critical).map_or(0, |last| last + 1);
    let outlier = |step: &Step| {
        let Step { part, value, statistic, .. } = *step;
        Outlier { part, label: label(part), value, distance: statistic }
    };
    steps[..named].iter().map(outlier).collect()
}

/// The test for up to `most` outliers: the farthest value, then that of the others, and so on.
fn steps(sample: &Sample, most: usize) -> Vec<Step> {
    let mut rising = sample.values.clone();
    rising.sort_by(|a, b| a.1.total_cmp(&b.1));
    let values: Vec<f64> = rising.iter().map(|(_, value)| *value).collect();
    let (mut from, mut to) = (0, values.len());
    let mut steps = Vec::new();
    while steps.len() < most && to - from >= 3 {
        let left = &values[from..to];
        let (mean, deviation) = mean_and_deviation(left);
        let [below, above] = [mean - left[0], left[left.len() - 1] - mean];
        if deviation <= 0.0 {
            break;
        }
        let (place, distance) = if below > above { (from, below) } else { (to - 1, above) };
        if below > above {
            from += 1;
        } else {
            to -= 1;
        }
        let (part, value) = rising[place];
        let critical = critical(left.len() as f64);
        steps.push(Step { part, value, statistic: distance / deviation, critical });
    }
    steps
}

/// The distance that the farthest of `n` values has with the test's level.
fn critical(n: f64) -> f64 {
    let freedom = n - 2.0;
    let t = student_quantile_above(SIGNIFICANCE / (2.0 * n), freedom);
    (n - 1.0) * t / libm::sqrt((freedom + t * t) * n)
}

#[cfg(test)]
mod tests {
    use super::{critical, outliers, steps};
    use crate::{capability::sample::Sample, examples::ROSNER};

    fn sample(values: &[f64]) -> Sample {
        let values: Vec<_> = values.iter().copied().map(Some).collect();
        Sample::new("a", &values).expect("a sample")
    }

    #[test]
    fn generalised_test_as_in_the_nist_handbook() {
        // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.5.17.3, which cuts after three decimals.
        let published = [
            (3.118, 3.158),
            (2.942, 3.151),
            (3.179, 3.143),
            (2.810, 3.136),
            (2.815, 3.128),
            (2.848, 3.120),
            (2.279, 3.111),
            (2.310, 3.103),
            (2.101, 3.094),
            (2.067, 3.085),
        ];
        let cut = |x: f64| libm::floor(x * 1e3) / 1e3;
        for (step, expected) in steps(&sample(&ROSNER), 10).iter().zip(published) {
            assert_eq!((cut(step.statistic), cut(step.critical)), expected);
        }
        // Five are looked for among 54 parts.
        let found: Vec<f64> = outliers(&sample(&ROSNER), |part| part.to_string()).iter().map(|o| o.value).collect();
        assert_eq!(found, [6.01, 5.42, 5.34]);
    }

    #[test]
    fn one_outlier_of_few_as_in_the_nist_handbook() {
        // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.5.17.1: G = 2.4687 (cut); the critical value of the test of both
        // sides with eight values is 2.1266.
        let isotope = [199.31, 199.53, 200.19, 200.82, 201.92, 201.95, 202.18, 245.57];
        let found = outliers(&sample(&isotope), |part| format!("no {part}"));
        let [outlier] = &found[..] else { panic!("{found:?}") };
        assert_eq!((outlier.value, outlier.part, outlier.label.as_str()), (245.57, 7, "no 7"));
        assert_eq!(libm::floor(outlier.distance * 1e4), 24687.0);
        assert!((critical(8.0) - 2.1266).abs() < 5e-5);
        assert!(outliers(&sample(&isotope[..7]), |_| String::new()).is_empty());
    }
}
