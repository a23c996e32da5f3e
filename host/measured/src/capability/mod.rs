//! What measured parts tell of a production: performance and capability by ISO 22514-2.
//!
//! Intervals are of 95 %. Those of a production that is stated to be normal are exact, whatever the number of parts; those of
//! other stated families hold in 92 to 99 % of simulated samples. Those of a family that the data choose allow for the others
//! that fit; from fewer than 100 parts they do not allow for Johnson's system with two ends, of which they hold too rarely.
//! Outliers are named and stay in every figure.

#[cfg(test)]
mod coverage;
mod error;
mod estimate;
mod failing;
mod indices;
mod normality;
mod outliers;
pub(crate) mod points;
mod sample;
#[cfg(test)]
mod tests;
mod tolerance_interval;
mod within;

use serde::Serialize;
use slipfit_tolerance::statistics::interval;

pub use self::{
    error::CapabilityError,
    estimate::Estimate,
    failing::{Counted, Failing},
    indices::{Indices, Known},
    normality::{LEAST_PARTS, Normality},
    outliers::{Outlier, SIGNIFICANCE, outliers},
    points::{Distribution, SCORES},
    sample::Sample,
    tolerance_interval::{ToleranceInterval, one_sided_factor, parts_for_any, two_sided_factor},
    within::{Group, Within},
};
use crate::{families::Kind, table::MeasuredTable, unit::Unit};

/// How capability is found.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Family of the distribution; `None` chooses one from the data.
    pub family: Option<Kind>,
    /// Index of the grouping by whose subgroups the parts are divided.
    pub grouping: Option<usize>,
    /// Shares of the production for which tolerance intervals are computed.
    pub shares: Vec<f64>,
}

impl Default for Options {
    fn default() -> Self {
        Self { family: None, grouping: None, shares: vec![0.95, 0.99, 0.9973] }
    }
}

/// What a column of measured parts tells.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Capability {
    /// Name of the column.
    pub name: String,
    /// Unit of all figures of length or angle.
    pub unit: Unit,
    /// Nominal value.
    pub nominal: Option<f64>,
    /// Lower and upper limit.
    pub limits: [Option<f64>; 2],
    /// Measured parts.
    pub count: usize,
    /// Parts that were not measured.
    pub missing: usize,
    /// Mean.
    pub mean: Estimate,
    /// Standard deviation.
    pub deviation: Estimate,
    /// Least value.
    pub least: f64,
    /// Median.
    pub median: f64,
    /// Greatest value.
    pub greatest: f64,
    /// The distribution that all intervals and the figures of the limits are of.
    pub distribution: Distribution,
    /// Pp and Ppk.
    pub performance: Indices,
    /// Expected shares outside the limits.
    pub failing: Failing,
    /// Measured parts outside the limits, whatever the distribution; `None` without limits.
    pub counted: Option<Counted>,
    /// Figures of subgroups, with Cp and Cpk.
    pub within: Option<Within>,
    /// Test of normality; `None` of too few parts.
    pub normality: Option<Normality>,
    /// Values too far away for a normal production.
    pub outliers: Vec<Outlier>,
    /// Tolerance intervals.
    pub tolerance_intervals: Vec<ToleranceInterval>,
}

/// What a `column` of a table tells.
pub fn capability(table: &MeasuredTable, column: usize, options: &Options) -> Result<Capability, CapabilityError> {
    let measured = table.columns().get(column).ok_or(CapabilityError::NoColumn(column))?;
    let grouping = match options.grouping {
        Some(index) => Some(table.groupings().get(index).ok_or(CapabilityError::NoColumn(index))?),
        None => None,
    };
    let limits = measured.limits;
    let sample = Sample::new(&measured.name, &measured.values)?;
    let known = Known::of(&sample);
    let has_limits = limits.iter().any(Option::is_some);
    let (distribution, figures) = points::figures(&sample, options.family, limits)
        .map_err(|why| CapabilityError::NoFigures { column: measured.name.clone(), why })?;
    let shares = options.shares.iter().filter(|share| 0.0 < **share && **share < 1.0);
    Ok(Capability {
        name: measured.name.clone(),
        unit: measured.unit,
        nominal: measured.nominal,
        limits,
        count: sample.sorted.len(),
        missing: measured.missing(),
        mean: figures.mean,
        deviation: figures.deviation,
        least: sample.sorted.first().copied().unwrap_or_default(),
        median: sample.median(),
        greatest: sample.sorted.last().copied().unwrap_or_default(),
        distribution,
        performance: figures.performance,
        failing: figures.failing,
        counted: has_limits.then(|| Counted::new(&sample.sorted, limits)),
        within: grouping.and_then(|grouping| Within::new(measured, grouping, &sample)),
        normality: Normality::new(&sample),
        outliers: outliers(&sample, |part| table.label(part)),
        tolerance_intervals: shares.map(|share| ToleranceInterval::new(*share, &known, &sample.sorted)).collect(),
    })
}

impl Known {
    /// What a sample tells.
    pub fn of(sample: &Sample) -> Self {
        let parts = sample.count();
        Self { parts, mean: sample.mean, deviation: sample.deviation, freedom: parts - 1.0 }
    }

    /// The mean with its interval by W. Gosset's t.
    pub fn mean_estimate(&self) -> Estimate {
        let half = interval::student_factor(self.parts as usize) * self.deviation / libm::sqrt(self.parts);
        Estimate { value: self.mean, interval: [self.mean - half, self.mean + half] }
    }

    /// The standard deviation with its interval by χ².
    pub fn deviation_estimate(&self) -> Estimate {
        Estimate { value: self.deviation, interval: interval::deviation(self.deviation, self.freedom) }
    }
}
