//! Indices by points of any distribution.

use serde::Serialize;

use crate::families::{Family, Fit, Kind};

/// Indices by ISO 22514-2's points: those of a normal production are the usual ones.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Points {
    /// Family of the distribution.
    pub family: Kind,
    /// Its parameters.
    pub parameters: Vec<(&'static str, f64)>,
    /// Akaike's information criterion for small samples; infinite where there are too few parts for it.
    pub aicc: f64,
    /// Correlation of the sorted values and the distribution's quantiles.
    pub qq_correlation: f64,
    /// The values below which 0.135 %, 50 % and 99.865 % lie.
    pub points: [f64; 3],
    /// Tolerance by the distance of the outer points.
    pub spread: Option<f64>,
    /// Distance of the lower limit from the middle point by that of the lower point.
    pub lower: Option<f64>,
    /// Distance of the upper limit from the middle point by that of the upper point.
    pub upper: Option<f64>,
    /// The lesser of the two, or the only one.
    pub least: Option<f64>,
    /// Expected share outside the limits.
    pub failing: Option<f64>,
}

/// Scores of the points: Φ(±3) is 0.135 % and 99.865 %.
pub const SCORES: [f64; 3] = [-3.0, 0.0, 3.0];

impl Points {
    /// Of a fitted distribution.
    pub fn new(fit: &Fit, limits: [Option<f64>; 2]) -> Self {
        let family = fit.family.as_ref();
        let points = SCORES.map(|score| family.value(score));
        let [low, middle, high] = points;
        let [lower, upper] = limits;
        let spread = lower.zip(upper).map(|(lower, upper)| (upper - lower) / (high - low));
        let lower_index = lower.map(|limit| (middle - limit) / (middle - low));
        let upper_index = upper.map(|limit| (limit - middle) / (high - middle));
        let least = match (lower_index, upper_index) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (one, other) => one.or(other),
        };
        Self {
            family: fit.kind,
            parameters: family.parameters(),
            aicc: fit.aicc,
            qq_correlation: fit.qq_correlation,
            points,
            spread,
            lower: lower_index,
            upper: upper_index,
            least,
            failing: failing(family, limits),
        }
    }
}

/// The expected share outside limits.
fn failing(family: &dyn Family, [lower, upper]: [Option<f64>; 2]) -> Option<f64> {
    let below = lower.map(|limit| family.tails(limit)[0]);
    let above = upper.map(|limit| family.tails(limit)[1]);
    (below.is_some() || above.is_some()).then(|| below.unwrap_or_default() + above.unwrap_or_default())
}
