//! Estimates, and where their errors come from.

use serde::Serialize;

use super::plain::Plain;
use crate::statistics::interval;

/// A number found from a sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its standard error, where one is known.
    pub error: Option<f64>,
    /// Lower and upper end of its 95 % confidence interval; `None` where the sample does not bound it.
    pub interval: [Option<f64>; 2],
}

impl Estimate {
    pub(super) fn between(value: f64, error: Option<f64>, ends: [f64; 2]) -> Self {
        Self { value, error, interval: ends.map(Some) }
    }

    /// The same in another unit.
    pub fn scaled(self, factor: f64) -> Self {
        let scale = |value: f64| value * factor;
        Self {
            value: scale(self.value),
            error: self.error.map(scale),
            interval: self.interval.map(|end| end.map(scale)),
        }
    }
}

/// Independent units, or independent designs.
pub(super) enum Errors<'a> {
    Independent,
    Replicates(&'a [Plain<'a>]),
}

impl Errors<'_> {
    /// The estimate `value`; `of` gives that of one design, `independent` the errors of independent units.
    pub fn estimate(&self, value: f64, of: &dyn Fn(&Plain) -> f64, independent: &dyn Fn(f64) -> Estimate) -> Estimate {
        match self {
            Self::Independent => independent(value),
            Self::Replicates(parts) => self.of_values(value, parts.iter().map(of), independent),
        }
    }

    /// The same with the `values` of all designs.
    pub fn of_values(
        &self,
        value: f64,
        values: impl ExactSizeIterator<Item = f64> + Clone,
        independent: &dyn Fn(f64) -> Estimate,
    ) -> Estimate {
        match self {
            Self::Independent => independent(value),
            Self::Replicates(_) if values.len() < 2 => Estimate { value, error: None, interval: [None; 2] },
            Self::Replicates(_) => {
                let count = values.len();
                let mean = values.clone().sum::<f64>() / count as f64;
                let square: f64 = values.map(|value| (value - mean) * (value - mean)).sum();
                let error = libm::sqrt(square / (count * (count - 1)) as f64);
                let half = interval::student_factor(count) * error;
                Estimate::between(value, Some(error), [value - half, value + half])
            }
        }
    }

    /// The share of `hits` of all units, (hits, units).
    pub fn share(&self, all: &Plain, hits: &dyn Fn(&Plain) -> (u64, u64)) -> Estimate {
        let share = |plain: &Plain| {
            let (hits, units) = hits(plain);
            hits as f64 / units as f64
        };
        let independent = |value: f64| {
            let (hits, units) = hits(all);
            let error = libm::sqrt(value * (1.0 - value) / units as f64);
            Estimate::between(value, Some(error), interval::proportion(hits, units))
        };
        let found = self.estimate(share(all), &share, &independent);
        // Replicates that all count the same, such as nothing, have no spread to learn from. A design's counts spread less
        // than those of independent units, so that these are on the safe side.
        let found = if found.error == Some(0.0) { independent(found.value) } else { found };
        Estimate { interval: found.interval.map(|end| end.map(|end| end.clamp(0.0, 1.0))), ..found }
    }
}
