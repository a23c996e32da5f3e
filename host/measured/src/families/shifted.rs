//! The lower end of a family that has one.

use super::{
    family::Family,
    kind::{FitError, Kind},
    sample::Sample,
};

/// Distances of the lower end from the least value that are tried first, in standard deviations; the nearest is divided by
/// the number of parts, as the least value of many is nearer to the end.
const NEAREST: f64 = 0.1;
const FARTHEST: f64 = 200.0;
const STEPS: usize = 60;

/// The likeliest distribution with a lower end. The likelihood of such families is infinite with the end at the least
/// value and estimates nothing there (B. Hill, "The three-parameter lognormal distribution and Bayesian analysis of a
/// point-source epidemic", 1963); meant is its highest local maximum. If it grows on towards ends far away, the values
/// are not skewed to the right, and there is none.
pub fn fit<F: Family>(sample: &Sample, kind: Kind, of_logarithms: impl Fn(&[f64], f64) -> F) -> Result<F, FitError> {
    let at = |ln_distance: f64| {
        let shift = sample.least() - sample.deviation * libm::exp(ln_distance);
        let logarithms: Vec<f64> = sample.sorted.iter().map(|x| libm::log(x - shift)).collect();
        of_logarithms(&logarithms, shift)
    };
    let likelihood = |ln_distance: f64| at(ln_distance).ln_likelihood(&sample.sorted);
    let (from, to) = (libm::log(NEAREST / sample.sorted.len() as f64), libm::log(FARTHEST));
    let step = (to - from) / STEPS as f64;
    let place = |i: usize| from + i as f64 * step;
    let tried: Vec<f64> = (0..=STEPS).map(|i| likelihood(place(i))).collect();
    let best = (1..STEPS)
        .filter(|i| tried[*i] > tried[i - 1] && tried[*i] >= tried[i + 1])
        .max_by(|a, b| tried[*a].total_cmp(&tried[*b]));
    let best = best.ok_or(FitError::NoMaximum(kind))?;
    Ok(at(golden(place(best - 1), place(best + 1), likelihood)))
}

/// The highest point of a function with one maximum between two places, by the golden section.
fn golden(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
    const PART: f64 = 0.618_033_988_749_894_9;
    let (mut a, mut b) = (high - PART * (high - low), low + PART * (high - low));
    let (mut fa, mut fb) = (function(a), function(b));
    while high - low > 1e-8 {
        if fa > fb {
            (high, b, fb) = (b, a, fa);
            a = high - PART * (high - low);
            fa = function(a);
        } else {
            (low, a, fa) = (a, b, fb);
            b = low + PART * (high - low);
            fb = function(b);
        }
    }
    0.5 * (low + high)
}
