//! How the walls of a joint run along the travel.

use super::{Contour, Joint};

/// How the walls of a joint run along the travel: one for each line of a guide, left of the axis first, and for each wall of a track, in the
/// order of its gaps.
#[derive(Clone, Debug, PartialEq)]
pub enum Walls {
    /// Straight and parallel.
    Parallel,
    /// They slope and bow as stated.
    Stated(Vec<Contour<f64>>),
    /// They slope and bow as the gaps at several places of the travel have it.
    OfGaps(Vec<Vec<OfGap>>),
}

/// What a gap adds to a wall's contour, for each metre of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OfGap {
    /// The gap.
    pub gap: usize,
    /// Slope and curvature (1/m, 1/m²).
    pub adds: [f64; 2],
}

impl Walls {
    /// Whether they are straight and parallel.
    pub fn is_parallel(&self) -> bool {
        *self == Self::Parallel
    }

    /// The contour of wall `i` of a unit with these `gaps` (m); `None` where it is straight and parallel.
    pub fn contour(&self, i: usize, gaps: &[f64]) -> Option<Contour<f64>> {
        match self {
            Self::Parallel => None,
            Self::Stated(contours) => contours.get(i).copied(),
            Self::OfGaps(walls) => {
                let sum = |k: usize| walls.get(i).map(|all| all.iter().map(|of| of.adds[k] * gaps[of.gap]).sum());
                Some(Contour { slope: sum(0)?, curvature: sum(1)? })
            }
        }
    }

    /// The number of places at which there are gaps.
    pub fn places(&self) -> usize {
        match self {
            Self::OfGaps(walls) => walls.iter().map(Vec::len).max().unwrap_or(1),
            _ => 1,
        }
    }

    /// The gap of wall `i` at a place by its number, of which 0 is the joint's own, where the gap is `own`.
    pub fn gap_at(&self, i: usize, place: usize, own: usize) -> usize {
        match self {
            Self::OfGaps(walls) => walls.get(i).and_then(|wall| wall.get(place)).map_or(own, |of| of.gap),
            _ => own,
        }
    }

    /// The gaps at other places than the joint's own.
    fn others<'a>(&'a self, joint: &'a Joint) -> impl Iterator<Item = usize> + 'a {
        let walls = match self {
            Self::OfGaps(walls) => &walls[..],
            _ => &[],
        };
        let all = walls.iter().flatten().map(|of| of.gap);
        all.filter(|gap| joint.kind.gaps().all(|own| own != *gap))
    }
}

impl Joint {
    /// All gaps of the joint, by their numbers: its own, then those at other places of the travel, some of them more than once.
    pub fn gaps(&self) -> impl Iterator<Item = usize> + '_ {
        self.kind.gaps().chain(self.walls.others(self))
    }
}

/// What the gaps at the joint's own place and at others, so far away (m) along the travel, add to a wall's contour. The wall is the straight
/// line, or with two others the parabola, through them.
pub fn through(own: usize, others: &[(usize, f64)]) -> Vec<OfGap> {
    // The gap at s is g − slope·s − curvature·s²/2.
    match *others {
        [(gap, s)] => vec![OfGap { gap: own, adds: [1.0 / s, 0.0] }, OfGap { gap, adds: [-1.0 / s, 0.0] }],
        [(one, s), (other, t)] => {
            // With the falls p = (g − g₁)/s and q = (g − g₂)/t the curvature is 2·(q − p)/(t − s), and the slope p·t − q·s over t − s.
            let of = |gap, by_p: f64, by_q: f64| OfGap {
                gap,
                adds: [(by_p * t - by_q * s) / (t - s), 2.0 * (by_q - by_p) / (t - s)],
            };
            vec![of(own, 1.0 / s, 1.0 / t), of(one, -1.0 / s, 0.0), of(other, 0.0, -1.0 / t)]
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::{Walls, through};

    /// The gap of a contour at every place that it was made from.
    #[test]
    fn walls_go_through_their_gaps() {
        for places in [vec![0.3], vec![-0.2, 0.3], vec![0.25, 0.1]] {
            let gaps = [0.4e-3, 0.7e-3, -0.1e-3];
            let others: Vec<(usize, f64)> = places.iter().enumerate().map(|(k, s)| (k + 1, *s)).collect();
            let contour = Walls::OfGaps(vec![through(0, &others)]).contour(0, &gaps).expect("a contour");
            for (gap, s) in others {
                let there = gaps[0] - contour.slope * s - 0.5 * contour.curvature * s * s;
                assert!((there - gaps[gap]).abs() < 1e-15, "{places:?}: {there} at {s}");
            }
        }
    }
}
