//! Coloured noise as an autoregression: how residuals depend on those before.

/// Autocovariances of noise, lag by lag from 0 on, until they no longer matter.
#[derive(Clone, Debug, PartialEq)]
pub struct Noise {
    /// Autocovariances.
    pub covariances: Vec<f64>,
}

/// The share of the variance below which an autocovariance does not matter.
const SMALL: f64 = 1e-3;
/// The highest order of the autoregression.
const HIGHEST: usize = 24;

impl Noise {
    /// The noise of `residuals`, in runs of these lengths: the autoregression by J. P. Burg's recursion (1975) whose order has the least
    /// criterion of G. Schwarz (1978).
    pub fn of(residuals: &[f64], runs: &[usize]) -> Self {
        let n = residuals.len();
        let variance = residuals.iter().map(|residual| residual * residual).sum::<f64>() / n.max(1) as f64;
        if variance == 0.0 {
            return Self { covariances: vec![0.0] };
        }
        let mut runs: Vec<[Vec<f64>; 2]> = split(residuals, runs).map(|run| [run.to_vec(), run.to_vec()]).collect();
        let (mut coefficients, mut innovation): (Vec<f64>, f64) = (Vec::new(), variance);
        let criterion = |innovation: f64, order: usize| {
            n as f64 * libm::log(innovation / variance) + order as f64 * libm::log(n as f64)
        };
        let mut best = (criterion(innovation, 0), Vec::new(), innovation);
        for order in 1..=HIGHEST.min(n / 10) {
            let (mut product, mut squares) = (0.0, 0.0);
            for [forward, backward] in &runs {
                for t in order..forward.len() {
                    product += forward[t] * backward[t - 1];
                    squares += forward[t] * forward[t] + backward[t - 1] * backward[t - 1];
                }
            }
            if squares <= 0.0 {
                break;
            }
            let reflection = (2.0 * product / squares).clamp(-0.9999, 0.9999);
            for [forward, backward] in &mut runs {
                for t in (order..forward.len()).rev() {
                    let (ahead, behind) = (forward[t], backward[t - 1]);
                    forward[t] = ahead - reflection * behind;
                    backward[t] = behind - reflection * ahead;
                }
            }
            let before = coefficients.clone();
            let mirrored = before.iter().rev();
            coefficients.iter_mut().zip(mirrored).for_each(|(one, other)| *one -= reflection * other);
            coefficients.push(reflection);
            innovation *= 1.0 - reflection * reflection;
            let found = criterion(innovation, order);
            if found < best.0 {
                best = (found, coefficients.clone(), innovation);
            }
        }
        Self { covariances: covariances(&best.1, best.2, variance, n / 3 + 1) }
    }

    /// The lag-1 correlation.
    pub fn lag_1(&self) -> f64 {
        self.covariances.get(1).map_or(0.0, |one| one / self.covariances[0].max(f64::MIN_POSITIVE))
    }

    /// The number of independent samples that know the mean as well as `count` of this noise.
    pub fn effective(&self, count: usize) -> f64 {
        let variance = self.covariances[0].max(f64::MIN_POSITIVE);
        let sum: f64 = self.covariances[1..].iter().map(|covariance| covariance / variance).sum();
        count as f64 / (1.0 + 2.0 * sum).max(1.0)
    }

    /// The same noise with all covariances `factor` times as large.
    pub fn scaled(&self, factor: f64) -> Self {
        Self { covariances: self.covariances.iter().map(|covariance| factor * covariance).collect() }
    }
}

/// The slices of `values` that belong to runs of these lengths.
pub fn split<'v>(values: &'v [f64], runs: &'v [usize]) -> impl Iterator<Item = &'v [f64]> {
    let mut at = 0;
    runs.iter().map(move |length| {
        at += length;
        &values[at - length..at]
    })
}

/// Autocovariances of an autoregression, by its impulse response: at most `most` lags, scaled to the `variance`.
fn covariances(coefficients: &[f64], innovation: f64, variance: f64, most: usize) -> Vec<f64> {
    if coefficients.is_empty() {
        return vec![variance];
    }
    // Long enough for correlations of some thousand samples.
    let length = (20 * most).clamp(200, 20_000);
    let mut response = vec![1.0];
    for t in 1..length {
        let next = coefficients.iter().zip((0..t).rev()).map(|(a, before)| a * response[before]).sum::<f64>();
        response.push(next);
        let recent = &response[response.len().saturating_sub(HIGHEST)..];
        if recent.len() == HIGHEST && recent.iter().all(|value| value.abs() < 1e-7) {
            break;
        }
    }
    let product =
        |lag: usize| response.iter().zip(&response[lag.min(response.len())..]).map(|(a, b)| a * b).sum::<f64>();
    let zero = product(0);
    let mut found = Vec::new();
    let mut small = 0;
    for lag in 0..most {
        let covariance = innovation * product(lag);
        found.push(covariance * variance / (innovation * zero));
        // Several lags in a row, as an oscillating covariance passes through zero.
        small = if covariance.abs() < SMALL * innovation * zero { small + 1 } else { 0 };
        if small >= HIGHEST {
            break;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use slipfit_core::sampling::stream::unit_stream;
    use slipfit_tolerance::failure::subset::normals;

    use super::Noise;

    #[test]
    fn white_noise_has_no_correlation() {
        let white = normals(&mut unit_stream(5, 0), 4000);
        let noise = Noise::of(&white, &[2000, 2000]);
        assert!(noise.lag_1().abs() < 0.05 && noise.effective(4000) > 3500.0, "{noise:?}");
    }

    #[test]
    fn a_first_order_autoregression_is_recognised() {
        let mut x = 0.0;
        let coloured: Vec<f64> = normals(&mut unit_stream(6, 0), 20_000)
            .into_iter()
            .map(|score| {
                x = 0.9 * x + score;
                x
            })
            .collect();
        let noise = Noise::of(&coloured, &[20_000]);
        assert!((noise.lag_1() - 0.9).abs() < 0.02, "{}", noise.lag_1());
        // (1 − ρ)/(1 + ρ) of the samples count.
        let share = noise.effective(20_000) / 20_000.0;
        assert!((share / (0.1 / 1.9) - 1.0).abs() < 0.2, "{share}");
    }
}
