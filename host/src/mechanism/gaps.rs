//! Gaps at a tolerance level.

use slipfit_core::clearance::GapStatistics;
use slipfit_tolerance::number::{level, ten_digits};

use super::{Gap, Joint, JointKind, Mechanism};
use crate::setup::{GAP_MOST, SURFACES};

/// How far (m) a stop may be.
pub const STOP_MOST: f64 = 10.0;

/// All gaps (m) of one unit, in the mechanism's order.
pub type Gaps = Vec<f64>;

/// A tolerance level at which a gap is out of bounds.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "at n = {} the gap \"{name}\" is {} mm, allowed is {} to {} mm",
    level(*n),
    ten_digits(gap * 1e3),
    allowed[0] * 1e3,
    allowed[1] * 1e3
)]
pub struct GapError {
    /// Tolerance level.
    pub n: f64,
    /// The gap's name.
    pub name: String,
    /// The gap (m).
    pub gap: f64,
    /// The least and the greatest that its joint allows (m): none is negative where a pin would have to be wider than its hole.
    pub allowed: [f64; 2],
}

impl Gap {
    /// The tolerance level that closes it; `None` where it does not vary.
    pub fn closes_at(&self) -> Option<f64> {
        let GapStatistics { mean, deviation } = self.statistics;
        Some(mean / deviation).filter(|n| n.is_finite())
    }

    /// The widest (m) that it usually is.
    fn widest(&self) -> f64 {
        self.statistics.mean.abs() + 3.0 * self.statistics.deviation
    }
}

impl Mechanism {
    /// Whether a value or distribution of the whole production is unknown.
    pub fn has_unknowns(&self) -> bool {
        !self.uncertain.is_empty() || self.measured.is_some()
    }

    /// The widest gap (m) of its production. The distance to a stop is no play, unless there is nothing else.
    pub fn widest_gap(&self) -> f64 {
        let with_play = || self.joints.iter().filter(|joint| !joint.kind.is_ideal());
        let all_stop = with_play().all(|joint| joint.kind.is_stop());
        let counts = with_play().filter(|joint| all_stop || !joint.kind.is_stop());
        counts.map(|joint| self.widest_of(joint)).fold(0.0, f64::max)
    }

    /// The widest gap (m) of a `joint` at its own place over the production.
    pub(super) fn widest_of(&self, joint: &Joint) -> f64 {
        joint.kind.gaps().map(|gap| self.gaps[gap].widest()).fold(0.0, f64::max)
    }

    /// The joint that loses its play at the lowest level, and that level, of those that have some by their mean. A track loses it
    /// where two opposite gaps together are nothing, any other joint where its gap is.
    pub fn first_to_close(&self) -> Option<(String, f64)> {
        let of_joint = |joint: &Joint| -> Vec<(String, Vec<usize>)> {
            match joint.kind {
                JointKind::Track { gaps } => {
                    let pair = |place: usize, walls: [usize; 2], name: &str| {
                        let [one, other] = walls.map(|wall| Some(joint.walls.gap_at(wall, place, gaps[wall]?)));
                        // What its name has after joint and surface says where it is.
                        let own = format!("{} {}", joint.name, SURFACES[walls[0]]);
                        let place = self.gaps[one?].name.strip_prefix(&own).unwrap_or_default();
                        Some((format!("{} {name}{place}", joint.name), vec![one?, other?]))
                    };
                    let pairs = |place| [pair(place, [0, 1], "across"), pair(place, [2, 3], "up-down")];
                    (0..joint.walls.places()).flat_map(pairs).flatten().collect()
                }
                _ => joint.gaps().map(|gap| (self.gaps[gap].name.clone(), vec![gap])).collect(),
            }
        };
        let level = |(name, gaps): (String, Vec<usize>)| {
            let sum = |of: fn(&GapStatistics<f64>) -> f64| {
                gaps.iter().map(|gap| of(&self.gaps[*gap].statistics)).sum::<f64>()
            };
            Some((name, sum(|gap| gap.mean) / sum(|gap| gap.deviation))).filter(|(_, n)| n.is_finite() && *n > 0.0)
        };
        let levels = self.joints.iter().flat_map(of_joint).filter_map(level);
        levels.min_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// The gaps at the tolerance levels `n`: one for all, or one a gap.
    ///
    /// # Errors
    /// [`GapError`] names the first gap that is out of bounds.
    pub fn gaps_at(&self, n: &[f64]) -> Result<Gaps, GapError> {
        let gaps = self.stated_gaps_at(n);
        match self.misfit(&gaps) {
            None => Ok(gaps),
            Some(i) => {
                let (name, allowed) = (self.gaps[i].name.clone(), self.allowed_gap(i));
                Err(GapError { n: level_of(n, i), name, gap: gaps[i], allowed })
            }
        }
    }

    /// The same, whether the joints allow such gaps or not.
    pub fn stated_gaps_at(&self, n: &[f64]) -> Gaps {
        self.gaps.iter().enumerate().map(|(i, gap)| gap.statistics.at(level_of(n, i))).collect()
    }

    /// The first of a unit's `gaps` (m) that its joint does not allow: such a unit cannot be assembled.
    pub fn misfit(&self, gaps: &[f64]) -> Option<usize> {
        (0..gaps.len()).find(|i| {
            let [least, greatest] = self.allowed_gap(*i);
            !(least..=greatest).contains(&gaps[*i])
        })
    }

    /// The tolerance levels at which the gaps are `gaps` (m); `None` for one that does not vary.
    pub fn levels_of(&self, gaps: &[f64]) -> Vec<Option<f64>> {
        let level = |(of, gap): (&Gap, &f64)| (of.statistics.deviation > 0.0).then(|| of.statistics.level(*gap));
        self.gaps.iter().zip(gaps).map(level).collect()
    }

    /// The least and the greatest value (m) of gap `i`: a pin in a hole has at least 0, a stop may be as far as a stroke is long.
    pub fn allowed_gap(&self, i: usize) -> [f64; 2] {
        use super::JointKind::{Bearing, Journal, Stop};
        match self.joints.iter().map(|joint| &joint.kind).find(|kind| kind.gaps().any(|gap| gap == i)) {
            Some(Journal { .. } | Bearing { .. }) => [0.0, GAP_MOST],
            Some(Stop { .. }) => [-STOP_MOST, STOP_MOST],
            _ => [-GAP_MOST, GAP_MOST],
        }
    }
}

/// The level of gap `i` among the levels `n`, the last of which holds for all that follow.
pub fn level_of(n: &[f64], i: usize) -> f64 {
    n.get(i).or(n.last()).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use crate::scene::{SceneFile, shipped};

    /// A track has play as long as two opposite gaps together are more than nothing, whatever one of them is.
    #[test]
    fn tracks_lose_their_play_in_pairs() {
        let first = |name: &str| {
            let scene = SceneFile::parse(name, shipped(name).unwrap(), &[]).unwrap_or_else(|error| panic!("{error}"));
            scene.mechanism.unwrap().first_to_close().unwrap()
        };
        // (0.05 + 0.3)/(0.02 + 0.02) at the inner pins; 0.2/0.02 at the big end.
        let (joint, n) = first("telescopic-drawer");
        assert!(joint == "inner left back across" && (n - 8.75).abs() < 1e-9, "{joint} {n}");
        let (joint, n) = first("slider-crank");
        assert!(joint == "big end" && (n - 10.0).abs() < 1e-9, "{joint} {n}");
    }
}
