//! A zone that limits place and tilts together: a cylinder around an axis, or a zone whose tilts another tolerance narrows.
//!
//! An axis lies in its cylinder where both of its ends do, and an end is off by place + tilt, the other by place − tilt: each of
//! both sums is a vector of length 1 at most. The ends vary independently of each other.
//!
//! A refinement is narrower in the tilts.
//! The place is one number u (a face) or two, x and y (an axis), over half of the zone's width; two tilts follow, in units of
//! the same zone. With the size |·| of either, |u| and |p| + |r| of a face, the radii of an axis, the zone is
//! |place| + |tilts| ≤ 1 and |tilts| ≤ ρ, ρ ≤ 1 the narrower width over the wider one: no corner leaves the wider zone, no
//! tilt the narrower.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use super::zone::{SIGMA_DISC, SIGMA_ZONE, ZoneRule, along, steepest};
use crate::numeric::{
    gauss::{Node, piece},
    normal::tail,
};

/// What lies in a zone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nest {
    /// A rectangular face: u and two tilts.
    Face,
    /// The axis of a pin or hole in a cylinder that limits both of its ends: x, y and two tilts, ρ = 1.
    Ends,
    /// The same with narrowed tilts; a pattern of axes, whose turn is a tilt.
    Axis,
}

/// A zone with narrowed tilts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nested {
    /// What lies in it.
    pub of: Nest,
    /// How it varies.
    pub rule: ZoneRule,
    /// ρ, more than 0 and up to 1.
    pub tilts: f64,
}

impl Nested {
    /// How many variables it has.
    pub fn variables(&self) -> usize {
        self.places() + 2
    }

    /// How many of them are of the place.
    pub fn places(&self) -> usize {
        match self.of {
            Nest::Face => 1,
            Nest::Ends | Nest::Axis => 2,
        }
    }

    /// Standard deviations of place and tilts where these are normal. Of a face they are those that each tolerance has alone.
    /// An end of an axis is off by place and tilt together, and has the deviation that a place alone has; where tilts are wide,
    /// both have equal parts.
    pub fn deviations(&self) -> [f64; 2] {
        match self.of {
            Nest::Face => [SIGMA_ZONE, SIGMA_ZONE * self.tilts],
            Nest::Ends | Nest::Axis => {
                let tilts = (SIGMA_DISC * self.tilts).min(SIGMA_DISC * FRAC_1_SQRT_2);
                [libm::sqrt(SIGMA_DISC * SIGMA_DISC - tilts * tilts), tilts]
            }
        }
    }

    /// Levels ± of a variable of the place and of a tilt, so that no corner of a factorial design leaves the zone. Tilts that are
    /// not narrowed have as much room as the place.
    pub fn factorial(&self) -> [f64; 2] {
        match self.of {
            Nest::Face => {
                let tilts = self.tilts.min(2.0 / 3.0);
                [1.0 - tilts, 0.5 * tilts]
            }
            Nest::Ends | Nest::Axis => {
                let tilts = self.tilts.min(0.5);
                [1.0 - tilts, tilts].map(|radius| radius * FRAC_1_SQRT_2)
            }
        }
    }

    /// Whether its variables are independent normals: by the rules of sigma-zone and translation.
    pub fn is_normal(&self) -> bool {
        matches!(self.rule, ZoneRule::SigmaZone | ZoneRule::Translation)
    }

    /// How far a point reaches: at most 1 inside of the zone.
    pub fn reach(&self, point: &[f64]) -> f64 {
        let (place, tilts) = point.split_at(self.places());
        if self.of == Nest::Ends {
            return ends(place, tilts).map(|end| radius(&end)).into_iter().fold(0.0, f64::max);
        }
        let tilt = self.tilt(tilts);
        (radius(place) + tilt).max(tilt / self.tilts)
    }

    fn tilt(&self, tilts: &[f64]) -> f64 {
        match self.of {
            Nest::Face => tilts.iter().map(|tilt| tilt.abs()).sum(),
            Nest::Ends | Nest::Axis => radius(tilts),
        }
    }

    /// The greatest value of slopes · variables in the zone whose place and tilts have grown by the factors `grown`. It lies on
    /// the border of either part.
    pub fn most(&self, slopes: &[f64], grown: [f64; 2]) -> f64 {
        let (place, tilts) = slopes.split_at(self.places());
        if self.of == Nest::Ends {
            // place and tilts are half of the sum and of the difference of both ends.
            return grown[0] * ends(place, tilts).map(|slope| 0.5 * radius(&slope)).iter().sum::<f64>();
        }
        let place = radius(place);
        let tilts = match self.of {
            Nest::Face => tilts.iter().fold(0.0, |most: f64, slope| most.max(slope.abs())),
            Nest::Ends | Nest::Axis => radius(tilts),
        };
        let [width, tilted] = [grown[0], (self.tilts * grown[1]).min(grown[0])];
        (width * place).max((width - tilted) * place + tilted * tilts)
    }

    /// The point at which slopes · variables is greatest.
    pub fn farthest(&self, slopes: &[f64]) -> Vec<f64> {
        let (place, tilts) = slopes.split_at(self.places());
        if self.of == Nest::Ends {
            let [one, other] = ends(place, tilts).map(|slope| along(&slope));
            return between([one[0], one[1]], [other[0], other[1]]).to_vec();
        }
        let tilts = match self.of {
            Nest::Face => steepest(tilts),
            Nest::Ends | Nest::Axis => along(tilts),
        };
        let joined = |part: f64| -> Vec<f64> {
            along(place).iter().map(|x| x * (1.0 - part)).chain(tilts.iter().map(|x| x * part)).collect()
        };
        let value = |point: &Vec<f64>| slopes.iter().zip(point).map(|(slope, x)| slope * x).sum::<f64>();
        let [flat, tilted] = [joined(0.0), joined(self.tilts)];
        if value(&tilted) > value(&flat) { tilted } else { flat }
    }

    /// Corners of the zone, or `count` points on its rims.
    pub fn corners(&self, count: usize) -> Vec<Vec<f64>> {
        let angles = || (0..count).map(|k| TAU * k as f64 / count as f64);
        let rim = || angles().map(|angle| [libm::cos(angle), libm::sin(angle)]);
        if self.of == Nest::Ends {
            return rim().flat_map(|one| rim().map(move |other| between(one, other).to_vec())).collect();
        }
        let places: Vec<Vec<f64>> = match self.of {
            Nest::Face => vec![vec![1.0], vec![-1.0]],
            Nest::Ends | Nest::Axis => rim().map(Vec::from).collect(),
        };
        let tilts: Vec<[f64; 2]> = match self.of {
            Nest::Face => vec![[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]],
            Nest::Ends | Nest::Axis => rim().collect(),
        };
        let joined = |place: &[f64], part: f64, tilts: [f64; 2]| -> Vec<f64> {
            place.iter().map(|x| x * (1.0 - part)).chain(tilts.map(|x| x * part)).collect()
        };
        let mut corners: Vec<Vec<f64>> = places.iter().map(|place| joined(place, 0.0, [0.0; 2])).collect();
        let with = |place: &Vec<f64>| tilts.iter().map(|tilts| joined(place, self.tilts, *tilts)).collect::<Vec<_>>();
        corners.extend(places.iter().flat_map(with));
        corners
    }

    /// A point uniform in the zone from independent scores: Rosenblatt's transformation.
    pub fn uniform(&self, scores: &[f64]) -> Vec<f64> {
        let (place, tilts) = scores.split_at(self.places());
        let outside = |score: f64| 2.0 * tail(score.abs());
        let rho = self.tilts;
        match self.of {
            Nest::Face => {
                // What is left of ρ beyond |p| has a share (1 − ρ)·y² + y³/3 of the volume beyond it.
                let beyond = |y: f64| y * y * ((1.0 - rho) + y / 3.0);
                let p = rho - inverse(beyond, rho, outside(tilts[0]) * beyond(rho));
                let (width, most) = (1.0 - p, rho - p);
                let r = width - libm::sqrt(width * width - (1.0 - outside(tilts[1])) * most * (2.0 * width - most));
                let u = (1.0 - p - r).max(0.0) * (1.0 - outside(place[0]));
                vec![u.copysign(place[0]), p.copysign(tilts[0]), r.copysign(tilts[1])]
            }
            Nest::Ends => {
                let in_disc = |scores: &[f64]| {
                    let radius = radius(scores);
                    let reach = libm::sqrt(-libm::expm1(-0.5 * radius * radius));
                    let scale = if radius > 0.0 { reach / radius } else { 0.0 };
                    [scores[0] * scale, scores[1] * scale]
                };
                between(in_disc(place), in_disc(tilts)).to_vec()
            }
            Nest::Axis => {
                // The volume up to a tilt t: t²·(1/2 − 2t/3 + t²/4).
                let up_to = |t: f64| t * t * (0.5 - t * (2.0 / 3.0 - 0.25 * t));
                let share = |scores: &[f64]| -libm::expm1(-0.5 * (scores[0] * scores[0] + scores[1] * scores[1]));
                let tilt = inverse(up_to, rho, share(tilts) * up_to(rho));
                let off = (1.0 - tilt) * libm::sqrt(share(place));
                let along = |scores: &[f64], length: f64| {
                    let radius = radius(scores);
                    let scale = if radius > 0.0 { length / radius } else { 0.0 };
                    [scores[0] * scale, scores[1] * scale]
                };
                along(place, off).into_iter().chain(along(tilts, tilt)).collect()
            }
        }
    }

    /// Weighted points of the zone with a density of the uniform or the truncated rule; the weights add up to what the density
    /// has in the zone.
    pub fn nodes(&self) -> Vec<Node> {
        let [place, tilts] = self.deviations().map(|deviation| 0.5 / (deviation * deviation));
        let uniform = self.rule == ZoneRule::UniformInZone;
        let density = |at: &[f64; 4]| {
            let (own, tilted) = at[..self.variables()].split_at(self.places());
            let square = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
            if uniform { 1.0 } else { libm::exp(-place * square(own) - tilts * square(tilted)) }
        };
        let mut nodes = Vec::new();
        match self.of {
            Nest::Face => {
                for (p, wp) in piece(0.0, self.tilts) {
                    for (r, wr) in piece(0.0, self.tilts - p) {
                        for (u, wu) in piece(0.0, 1.0 - p - r) {
                            for octant in 0..8 {
                                let sign = |bit: u32| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
                                let at = [u * sign(0), p * sign(1), r * sign(2), 0.0];
                                nodes.push(Node { weight: wp * wr * wu * density(&at), at });
                            }
                        }
                    }
                }
            }
            Nest::Ends => {
                let disc = || {
                    piece(0.0, 1.0).flat_map(|(r, weight)| {
                        let at = move |angle| [r * libm::cos(angle), r * libm::sin(angle)];
                        angles().map(move |angle| (at(angle), weight * r * AROUND))
                    })
                };
                for (one, weight) in disc() {
                    for (other, other_weight) in disc() {
                        let at = between(one, other);
                        // A quarter: the volume of place and tilts over that of the ends.
                        nodes.push(Node { weight: 0.25 * weight * other_weight * density(&at), at });
                    }
                }
            }
            Nest::Axis => {
                for (t, wt) in piece(0.0, self.tilts) {
                    for (d, wd) in piece(0.0, 1.0 - t) {
                        for (one, other) in angles().flat_map(|one| angles().map(move |other| (one, other))) {
                            let at =
                                [d * libm::cos(one), d * libm::sin(one), t * libm::cos(other), t * libm::sin(other)];
                            nodes.push(Node { weight: wt * wd * t * d * AROUND * AROUND * density(&at), at });
                        }
                    }
                }
            }
        }
        nodes
    }

    /// The share of the normal rule that the truncated one keeps.
    pub fn inside(&self) -> f64 {
        let truncated = Self { rule: ZoneRule::Truncated, ..*self };
        let [place, tilts] = self.deviations();
        let peak = libm::pow(libm::sqrt(TAU) * place, self.places() as f64) * TAU * tilts * tilts;
        truncated.nodes().iter().map(|node| node.weight).sum::<f64>() / peak
    }
}

/// Angles of the nodes of a disc, and how far one is from the next (rad).
const ANGLES: usize = 8;
const AROUND: f64 = TAU / ANGLES as f64;

fn angles() -> impl Iterator<Item = f64> {
    (0..ANGLES).map(|k| AROUND * (k as f64 + 0.5))
}

/// Both ends of an axis with this place and these tilts.
fn ends(place: &[f64], tilts: &[f64]) -> [[f64; 2]; 2] {
    [1.0, -1.0].map(|sign| [0, 1].map(|k| place[k] + sign * tilts[k]))
}

/// Place and tilts of an axis with these ends.
fn between(one: [f64; 2], other: [f64; 2]) -> [f64; 4] {
    let half = |sign: f64| [0, 1].map(|k| 0.5 * (one[k] + sign * other[k]));
    let ([x, y], [p, r]) = (half(1.0), half(-1.0));
    [x, y, p, r]
}

fn radius(vector: &[f64]) -> f64 {
    libm::sqrt(vector.iter().map(|x| x * x).sum())
}

/// Where a function that rises from 0 to `most` has a `value`: halvings, then Newton's steps would not matter any more.
fn inverse(function: impl Fn(f64) -> f64, most: f64, value: f64) -> f64 {
    let (mut low, mut high) = (0.0, most);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if function(middle) < value { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::{Nest, Nested};
    use crate::model::ZoneRule;

    const ALL: [(Nest, f64); 5] =
        [(Nest::Face, 0.3), (Nest::Face, 1.0), (Nest::Ends, 1.0), (Nest::Axis, 0.3), (Nest::Axis, 1.0)];

    #[test]
    fn corners_are_the_farthest_points() {
        for (of, tilts) in ALL {
            let zone = Nested { of, rule: ZoneRule::SigmaZone, tilts };
            let corners = zone.corners(24);
            assert!(corners.iter().all(|corner| (zone.reach(corner) - 1.0).abs() < 1e-12), "{zone:?}");
            for slopes in [[1.0, 0.5, 2.0, 0.0], [0.1, 3.0, 0.0, 0.4], [2.0, 0.0, 0.1, 0.1]] {
                let slopes = &slopes[..zone.variables()];
                let value = |corner: &Vec<f64>| corner.iter().zip(slopes).map(|(x, s)| x * s).sum::<f64>();
                let greatest = corners.iter().map(value).fold(0.0, f64::max);
                // A rim of 24 points has all directions within 7.5°.
                assert!(
                    greatest <= zone.most(slopes, [1.0; 2]) + 1e-12 && greatest > 0.99 * zone.most(slopes, [1.0; 2]),
                    "{zone:?}"
                );
            }
        }
    }

    #[test]
    fn the_uniform_rule_fills_the_zone_evenly() {
        for (of, tilts) in ALL {
            let zone = Nested { of, rule: ZoneRule::UniformInZone, tilts };
            let nodes = zone.nodes();
            let total: f64 = nodes.iter().map(|node| node.weight).sum();
            let count = zone.variables();
            // A lattice of probabilities, by Weyl's sequences.
            let units = 20_000;
            let root = |k: usize| libm::sqrt([2.0, 3.0, 5.0, 7.0][k]);
            let points = (1..=units).map(|n| {
                let score = |k| crate::numeric::normal::quantile((f64::from(n) * root(k)).fract());
                zone.uniform(&(0..count).map(score).collect::<Vec<_>>())
            });
            let points: Vec<Vec<f64>> = points.collect();
            assert!(points.iter().all(|point| zone.reach(point) <= 1.0 + 1e-12), "{zone:?}");
            for k in 0..count {
                let found = points.iter().map(|point| point[k] * point[k]).sum::<f64>() / f64::from(units);
                let expected = nodes.iter().map(|node| node.weight * node.at[k] * node.at[k]).sum::<f64>() / total;
                assert!((found / expected - 1.0).abs() < 0.01, "{zone:?} {k}: {found} {expected}");
            }
        }
    }

    /// Ends of an axis lie in their zone as often as that of an axis that only shifts, whatever its tilts may be.
    #[test]
    fn an_end_of_an_axis_has_a_sixth_of_the_zone() {
        for tilts in [0.1, 0.5, 0.8, 1.0] {
            let [place, tilts] = Nested { of: Nest::Axis, rule: ZoneRule::SigmaZone, tilts }.deviations();
            assert!(
                (9.0 * (place * place + tilts * tilts) - 1.0).abs() < 1e-12 && tilts <= place + 1e-12,
                "{place} {tilts}"
            );
        }
    }

    #[test]
    fn both_ends_of_an_axis_are_inside_independently() {
        let inside = crate::sampling::draw::INSIDE_DISC;
        let zone = Nested { of: Nest::Ends, rule: ZoneRule::Truncated, tilts: 1.0 };
        assert!((zone.inside() - inside * inside).abs() < 1e-8, "{}", zone.inside());
        // Shifted to one side and leaning to another, an axis may have √½ of each.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        assert!((zone.reach(&[half, 0.0, 0.0, half]) - 1.0).abs() < 1e-15);
        assert!((zone.most(&[1.0, 0.0, 0.0, 1.0], [1.0; 2]) - 2.0 * half).abs() < 1e-15);
    }

    #[test]
    fn an_unrefined_face_is_the_octahedron() {
        let zone = Nested { of: Nest::Face, rule: ZoneRule::Truncated, tilts: 1.0 };
        assert!((zone.inside() - crate::sampling::draw::INSIDE).abs() < 1e-6, "{}", zone.inside());
    }
}
