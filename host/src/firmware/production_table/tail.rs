//! Limits that are seldom exceeded, from a sample: the tail as a generalised Pareto distribution by probability-weighted moments
//! (Hosking, Wallis, "Parameter and quantile estimation for the generalized Pareto distribution", Technometrics 29, 1987).

/// The greatest share of the sample that the tail is fitted to.
const TAIL: f64 = 0.05;

/// The least, where the sample is large; and how many of it at least.
const TAIL_LEAST: f64 = 0.005;
const COUNT_LEAST: f64 = 150.0;

/// Values beyond a limit with which the sample itself has it.
const COUNT_ENOUGH: f64 = 20.0;

/// The values that shares `rates` of what `all` is a sample of exceed: as the sample has them where it has enough beyond, else by its tail.
pub fn limits<const N: usize>(mut all: Vec<f64>, rates: [f64; N]) -> [f64; N] {
    all.sort_by(f64::total_cmp);
    let whole = all.len() as f64;
    let beyond = COUNT_LEAST.max(TAIL_LEAST * whole).min(TAIL * whole);
    let beyond = (beyond as usize).clamp(1, all.len().saturating_sub(1).max(1));
    let Some(threshold) = all.get(all.len().saturating_sub(beyond + 1)).copied() else { return [0.0; N] };
    let excesses: Vec<f64> = all[all.len() - beyond..].iter().map(|x| x - threshold).collect();
    let count = excesses.len() as f64;
    let mean = excesses.iter().sum::<f64>() / count;
    // Weighted with the share that exceeds each.
    let weighted = excesses.iter().enumerate().map(|(i, x)| x * (1.0 - (i as f64 + 0.65) / count)).sum::<f64>() / count;
    let share = beyond as f64 / all.len() as f64;
    let difference = mean - 2.0 * weighted;
    let is_known = mean > 0.0 && difference > 0.0;
    let (shape, scale) = (2.0 - mean / difference, 2.0 * mean * weighted / difference);
    rates.map(|rate| {
        if rate >= share || rate * whole >= COUNT_ENOUGH || !is_known {
            // Between the two of the sample that it lies between.
            let place = ((1.0 - rate) * whole - 0.5).clamp(0.0, whole - 1.0);
            let (low, high) = (all[place as usize], all[(place.ceil() as usize).min(all.len() - 1)]);
            return low + (place - place.floor()) * (high - low);
        }
        let log = libm::log(share / rate);
        let factor = if shape.abs() < 1e-9 { log } else { libm::expm1(shape * log) / shape };
        threshold + scale * factor
    })
}

#[cfg(test)]
mod tests {
    use super::limits;

    type Quantile = fn(f64) -> f64;

    /// Of distributions whose quantiles are known: exponential, uniform, Pareto with shape ¼, each by its own quantiles.
    #[test]
    fn tails_of_known_distributions_are_continued() {
        let count = 20_000;
        let shares = || (0..count).map(|i| (f64::from(i) + 0.5) / f64::from(count));
        let rates = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];
        let known: [(&str, Quantile); 3] = [
            ("exponential", |exceeding| -libm::log(exceeding)),
            ("uniform", |exceeding| 1.0 - exceeding),
            ("pareto", |exceeding| 4.0 * (libm::pow(exceeding, -0.25) - 1.0)),
        ];
        for (name, quantile) in known {
            let found = limits(shares().map(quantile).collect(), rates);
            for (found, rate) in found.into_iter().zip(rates) {
                let expected = quantile(rate);
                // Four decades beyond the 150 that the tail is fitted to.
                let apart = if rate < 1e-4 { 0.08 } else { 0.03 };
                assert!((found / expected - 1.0).abs() < apart, "{name} {rate}: {found} {expected}");
            }
        }
        // Few are better than none.
        assert_eq!(limits(vec![1.0], rates), [1.0; 5]);
        assert_eq!(limits(Vec::new(), rates), [0.0; 5]);
        assert_eq!(limits(vec![2.0; 1000], rates), [2.0; 5]);
        // A tail that begins within the last twentieth: two in a hundred are ten times as great.
        let all = (0..2000).map(|i| if i < 1960 { 1.0 } else { 10.0 + f64::from(i) * 1e-3 }).collect();
        assert!((limits(all, [0.01])[0] - 11.98).abs() < 0.01);
    }
}
