//! Gaps at a tolerance level.

use super::Mechanism;
use crate::{number::level, scene::GAP_MOST};

/// All gaps (m) of one unit, in the mechanism's order.
pub type Gaps = Vec<f64>;

/// A tolerance level at which a gap is out of bounds.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("at n = {} the gap \"{name}\" is {} mm, allowed is {} to {} mm", level(*n), gap * 1e3, least * 1e3, GAP_MOST * 1e3)]
pub struct GapError {
    /// Tolerance level.
    pub n: f64,
    /// The gap's name.
    pub name: String,
    /// The gap (m).
    pub gap: f64,
    /// The least that its joint allows (m): none is negative where a pin would have to be wider than its hole.
    pub least: f64,
}

impl Mechanism {
    /// The gaps at the tolerance levels `n`: one for all, or one a gap.
    ///
    /// # Errors
    /// [`GapError`] names the first gap that is out of bounds.
    pub fn gaps_at(&self, n: &[f64]) -> Result<Gaps, GapError> {
        let level = |i: usize| n.get(i).or(n.last()).copied().unwrap_or_default();
        let at = |(i, gap): (usize, &super::Gap)| {
            let value = gap.statistics.at(level(i));
            let least = self.least_gap(i);
            if value >= least && value <= GAP_MOST {
                Ok(value)
            } else {
                Err(GapError { n: level(i), name: gap.name.clone(), gap: value, least })
            }
        };
        self.gaps.iter().enumerate().map(at).collect()
    }

    /// The least value (m) of gap `i`: 0 for a pin in a hole.
    fn least_gap(&self, i: usize) -> f64 {
        use super::JointKind::{Bearing, Journal};
        let round = |kind: &_| matches!(kind, Journal { gap, .. } | Bearing { gap, .. } if *gap == i);
        if self.joints.iter().any(|joint| round(&joint.kind)) { 0.0 } else { -GAP_MOST }
    }
}
