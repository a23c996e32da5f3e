//! Where a contributor can lie within its limits or its zone: the set that a worst case is taken over.

use std::f64::consts::TAU;

use super::{
    Distribution, Variation,
    zone::{along, steepest},
};

/// Points on the rim of a disc where corners are asked for.
const RIM: usize = 8;

impl Variation {
    /// The middle of the limits or of the zone.
    pub fn middle(&self) -> Vec<f64> {
        match self {
            Self::Scalar { limits: [low, high], .. } => vec![0.5 * (low + high)],
            zone @ (Self::Zone(_) | Self::Disc(_) | Self::Nested(_)) => vec![0.0; zone.variables()],
        }
    }

    /// Whether it stays in the middle.
    pub fn is_fixed(&self) -> bool {
        match self {
            Self::Scalar { distribution: Distribution::Constant(_), .. } => true,
            Self::Scalar { limits: [low, high], .. } => low == high,
            Self::Zone(_) | Self::Disc(_) | Self::Nested(_) => false,
        }
    }

    /// Both limits, the corners of a zone, or points on the rim of a round one; the value of a constant.
    pub fn corners(&self) -> Vec<Vec<f64>> {
        match self {
            Self::Scalar { distribution: Distribution::Constant(value), .. } => vec![vec![*value]],
            Self::Scalar { limits: [low, high], .. } if low == high => vec![vec![*low]],
            Self::Scalar { limits, .. } => limits.iter().map(|limit| vec![*limit]).collect(),
            Self::Disc(_) => {
                let angles = (0..RIM).map(|k| TAU * k as f64 / RIM as f64);
                angles.map(|angle| vec![libm::cos(angle), libm::sin(angle)]).collect()
            }
            Self::Nested(zone) => zone.corners(RIM / 2),
            zone @ Self::Zone(_) => {
                let count = zone.variables();
                let corner = |k: usize, sign: f64| (0..count).map(|j| if j == k { sign } else { 0.0 }).collect();
                (0..count).flat_map(|k| [corner(k, -1.0), corner(k, 1.0)]).collect()
            }
        }
    }

    /// The point at which `slopes` times the variables is greatest; the middle where no slope is other than 0.
    pub fn farthest(&self, slopes: &[f64]) -> Vec<f64> {
        match self {
            Self::Scalar { limits: [low, high], .. } => vec![match slopes[0].partial_cmp(&0.0) {
                Some(std::cmp::Ordering::Less) => *low,
                Some(std::cmp::Ordering::Greater) => *high,
                _ => 0.5 * (low + high),
            }],
            Self::Zone(_) => steepest(slopes),
            Self::Disc(_) => along(slopes),
            Self::Nested(zone) => zone.farthest(slopes),
        }
    }

    /// How far it moves a linear measure from the middle, at most, with `slopes` in its variables. In a zone
    /// |u| + |p| + |r| ≤ 1 that is at one of its corners, in a disc on its rim. Place and tilts of a zone have `grown` by factors.
    pub(crate) fn reach(&self, slopes: &[f64], grown: [f64; 2]) -> f64 {
        let most = slopes.iter().fold(0.0, |most: f64, slope| most.max(slope.abs()));
        match self {
            Self::Scalar { limits: [low, high], .. } => 0.5 * (high - low) * most,
            Self::Zone(_) => grown[0] * most,
            Self::Disc(_) => grown[0] * libm::sqrt(slopes.iter().map(|slope| slope * slope).sum()),
            Self::Nested(zone) => zone.most(slopes, grown),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Variation;
    use crate::model::{
        Distribution, ZoneRule,
        nested::{Nest, Nested},
    };

    /// The farthest point lies in its set and reaches as far as the reach says, and no corner farther.
    #[test]
    fn farthest_points_reach_the_most() {
        let limits = [-1.0, 3.0];
        let nested = |of, tilts| Variation::Nested(Nested { of, rule: ZoneRule::SigmaZone, tilts });
        for variation in [
            Variation::Scalar { distribution: Distribution::Uniform { limits }, limits },
            Variation::Zone(ZoneRule::SigmaZone),
            Variation::Zone(ZoneRule::Translation),
            Variation::Disc(ZoneRule::Truncated),
            nested(Nest::Face, 0.3),
            nested(Nest::Face, 1.0),
            nested(Nest::Axis, 0.3),
            nested(Nest::Axis, 1.0),
        ] {
            for slopes in [[1.0, 0.5, 2.0, 0.0], [-0.1, 3.0, 0.0, 0.4], [2.0, 0.0, 0.1, -0.1], [0.0; 4]] {
                let slopes = &slopes[..variation.variables()];
                let value = |point: &[f64]| slopes.iter().zip(point).map(|(a, b)| a * b).sum::<f64>();
                let point = variation.farthest(slopes);
                let reached = value(&point) - value(&variation.middle());
                assert!((reached - variation.reach(slopes, [1.0; 2])).abs() < 1e-12, "{variation:?} {slopes:?}");
                assert!(variation.corners().iter().all(|corner| value(corner) <= value(&point) + 1e-12));
                if let Variation::Nested(zone) = &variation {
                    assert!(zone.reach(&point) <= 1.0 + 1e-12);
                }
            }
        }
    }
}
