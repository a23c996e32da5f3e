//! What a report holds, in its units: of all measures together, of each measure, of each contributor and of each sum.

use serde::Serialize;

use crate::{failure::tail::Source, model::Quantity, sampling::sampler::Method, statistics::estimate::Estimate};

/// All of an analysis.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The scene's title.
    pub title: String,
    /// How units were drawn.
    pub method: Method,
    /// Units in all.
    pub samples: u64,
    /// Independent designs they were split into.
    pub replicates: u64,
    /// Seed of the production.
    pub seed: u64,
    /// Share of units with all measures within their limits, if any has limits.
    pub yield_of_all: Option<Estimate>,
    /// Measures in the model's order.
    pub measures: Vec<MeasureReport>,
    /// Correlation matrix of the measures, row by row.
    pub correlation: Vec<Vec<f64>>,
    /// The 95 % intervals of its entries; none where a measure does not vary.
    pub correlation_intervals: Vec<Vec<[Option<f64>; 2]>>,
    /// Sums that must stay positive.
    pub sums: Vec<SumReport>,
    /// What a reader has to know.
    pub notes: Vec<String>,
}

impl Report {
    /// Whether any measure has limits.
    pub fn limited(&self) -> bool {
        self.measures.iter().any(|measure| measure.limits != [None; 2])
    }
}

/// One measure.
#[derive(Clone, Debug, Serialize)]
pub struct MeasureReport {
    /// Name.
    pub name: String,
    /// mm, °, N, N/mm, g, N·mm, MPa, s or empty.
    pub unit: &'static str,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
    /// Skewness, if it varies.
    pub skew: Option<f64>,
    /// Kurtosis, if it varies; 3 for a normal.
    pub kurtosis: Option<f64>,
    /// Least value.
    pub min: f64,
    /// Greatest value.
    pub max: f64,
    /// The 0.135 % point.
    pub q00135: f64,
    /// The median.
    pub median: f64,
    /// The 99.865 % point.
    pub q99865: f64,
    /// Units in which it could not be computed.
    pub undefined: u64,
    /// Value at the nominal values of the drawing.
    pub nominal: Option<f64>,
    /// Specification limits.
    pub limits: [Option<f64>; 2],
    /// Width between both limits over 6σ: as if normal.
    pub pp: Option<f64>,
    /// Nearer limit over 3σ: as if normal.
    pub ppk: Option<f64>,
    /// Whether the measure is near enough to normal for these two.
    pub normal: bool,
    /// Pp by the 0.135 % and 99.865 % points (ISO 22514-2), where the measure is not normal.
    pub pp_by_points: Option<f64>,
    /// Ppk by these and the median, where the measure is not normal.
    pub ppk_by_points: Option<f64>,
    /// Defects per million below and above, the better known of both sources.
    pub dpm: [Option<Defects>; 2],
    /// Share within the limits.
    #[serde(rename = "yield")]
    pub good: Option<f64>,
    /// Taguchi's loss, where the scene states one.
    pub loss: Option<LossReport>,
    /// The same numbers with standard errors and 95 % intervals.
    pub estimates: Estimates,
    /// Worst case: least and greatest value within all limits and zones, by corners and a search; exact for a linear measure.
    pub worst_case: [f64; 2],
    /// The same by slopes in the middle of all limits: no bound for a measure that is not linear; none where there are no slopes.
    pub worst_case_linear: Option<[f64; 2]>,
    /// Root sum of squares: value at the middle of the limits, half the tolerance, standard deviation of first order; none
    /// where slopes do not describe the measure.
    pub rss: Option<Rss>,
    /// Moments of second order; none where a quadratic does not describe the measure.
    pub second_order: Option<SecondOrder>,
    /// Moments by quadrature, where the measure is not linear and its variables are few: as good as exact.
    pub quadrature: Option<Quadrature>,
    /// Whether the contributors' percentages are total Sobol' indices, scaled to a sum of 100 %.
    pub by_indices: bool,
    /// By contributor, largest share first.
    pub contributors: Vec<Share>,
}

/// Numbers with their errors.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs, reason = "named as in the measure")]
pub struct Estimates {
    pub mean: Estimate,
    pub sd: Estimate,
    pub skew: Option<Estimate>,
    pub kurtosis: Option<Estimate>,
    pub q00135: Estimate,
    pub median: Estimate,
    pub q99865: Estimate,
    pub pp: Option<Estimate>,
    pub ppk: Option<Estimate>,
    pub pp_by_points: Option<Estimate>,
    pub ppk_by_points: Option<Estimate>,
    pub dpm_below: Option<Estimate>,
    pub dpm_above: Option<Estimate>,
    #[serde(rename = "yield")]
    pub good: Option<Estimate>,
}

/// Taguchi's loss of a measure.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LossReport {
    /// T, in the measure's unit.
    pub target: f64,
    /// k: cost over the square of the measure's unit.
    pub coefficient: f64,
    /// Mean loss of a unit; where a repair has a cost, none costs more than that.
    pub mean: Estimate,
    /// Signal-to-noise ratio, dB.
    pub signal_to_noise: Option<f64>,
    /// The tolerance ± at which the loss is what putting a unit right costs, in the measure's unit.
    pub balanced_tolerance: Option<f64>,
}

/// Defects per million on one side.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Defects {
    /// Defects per million.
    pub dpm: f64,
    /// Standard error.
    pub error: Option<f64>,
    /// Where the number comes from.
    pub source: Source,
    /// Lower and upper end of the 95 % interval.
    pub interval: [Option<f64>; 2],
    /// Reliability index: distance of the most probable defect in standard deviations, if that was reached.
    pub reliability: Option<f64>,
    /// Evaluations that importance sampling and subset simulation took.
    pub evaluations: Option<u64>,
}

/// Root sum of squares.
#[derive(Clone, Copy, Debug, Serialize)]
#[allow(missing_docs, reason = "see the report")]
pub struct Rss {
    pub middle: f64,
    pub tolerance: f64,
    /// Half the tolerance times 1.5.
    pub bender: f64,
    /// Half the tolerance times 1.6.
    pub gilson: f64,
    /// Half the tolerance with a factor by the number of tolerances.
    pub modified: f64,
    pub sd: f64,
}

/// Moments of second order.
#[derive(Clone, Copy, Debug, Serialize)]
#[allow(missing_docs, reason = "named as in the measure")]
pub struct SecondOrder {
    pub mean: f64,
    pub mean_shift: f64,
    pub sd: f64,
    pub skew: Option<f64>,
    pub kurtosis: Option<f64>,
}

/// Moments by quadrature.
#[derive(Clone, Copy, Debug, Serialize)]
#[allow(missing_docs, reason = "named as in the measure")]
pub struct Quadrature {
    pub mean: f64,
    pub sd: f64,
    pub skew: f64,
    pub kurtosis: f64,
}

/// What a contributor has in a measure.
#[derive(Clone, Debug, Serialize)]
pub struct Share {
    /// Name.
    pub name: String,
    /// Share in the variance of first order, in %; where curvature counts, of the total Sobol' indices, if there are any.
    pub percent: Option<f64>,
    /// ∂measure/∂tolerance: in the measure's unit, per `per` that a scalar moves.
    pub slope: Option<f64>,
    /// The unit of what moves: mm, rad, N, N/mm, g, N·mm, MPa, s or empty; none without a slope.
    pub per: Option<&'static str>,
    /// How far the whole tolerance moves the measure to either side.
    pub reach: f64,
    /// Sobol' index of first order, where the measure is not linear.
    pub sobol_first: Option<f64>,
    /// Total Sobol' index, where the measure is not linear.
    pub sobol_total: Option<f64>,
}

/// One sum that must stay positive.
#[derive(Clone, Debug, Serialize)]
pub struct SumReport {
    /// Name.
    pub name: String,
    /// mm, °, N, N/mm, g, N·mm, MPa, s or empty.
    pub unit: &'static str,
    /// Mean of second order.
    pub mean: f64,
    /// Standard deviation with the model's own correlation.
    pub sd: f64,
    /// Correlation of its measures in the sample, if there are two.
    pub correlation: Option<f64>,
    /// Its 95 % interval.
    pub correlation_interval: Option<[Option<f64>; 2]>,
    /// P(sum < 0) with the model's own correlation, ppm, the better known of both sources.
    pub model: Defects,
    /// Counted alone, ppm.
    pub counted: Estimate,
    /// ppm if the sum were normal, with the model's own correlation.
    pub normal_ppm: f64,
    /// ppm as eq. 9 reads it: normal, both measures moving together, ρ = +1.
    pub eq9_ppm: f64,
    /// ppm if normal and independent.
    pub independent_ppm: f64,
}

impl Quantity {
    /// What an SI value is multiplied by for a report.
    pub fn factor(self) -> f64 {
        match self {
            Self::Length | Self::Mass | Self::Moment => 1e3,
            Self::Angle => 180.0 / std::f64::consts::PI,
            Self::Ratio | Self::Force | Self::Time => 1.0,
            Self::Stiffness => 1e-3,
            Self::Pressure => 1e-6,
        }
    }

    /// The unit of a report.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Length => "mm",
            Self::Angle => "°",
            Self::Ratio => "",
            Self::Force => "N",
            Self::Stiffness => "N/mm",
            Self::Mass => "g",
            Self::Moment => "N·mm",
            Self::Pressure => "MPa",
            Self::Time => "s",
        }
    }
}
