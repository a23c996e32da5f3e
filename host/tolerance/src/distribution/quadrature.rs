//! Weighted points that stand for how a contributor varies: averages over them are its moments.

use super::Marginal;
use crate::{
    model::{Distribution, SIGMA_DISC, SIGMA_ZONE, Variation, ZoneRule},
    numeric::{
        gauss::{Node, POINTS, piece},
        normal::density,
    },
};

/// Where the tails of a normal are cut off (standard deviations): beyond lie 2e-19.
const REACH: f64 = 9.0;

/// Nodes of a contributor: exact for polynomials up to degree 8 but for the accuracy of normal and skewed
/// distributions, 1e-12, and of truncated zones, 1e-8.
pub fn nodes(variation: &Variation) -> Vec<Node> {
    normalised(match variation {
        Variation::Scalar { distribution, .. } => scalar(distribution),
        Variation::Zone(ZoneRule::Translation) => line(&normal_pieces(-REACH, REACH), |z| (z / 3.0, density(z))),
        Variation::Zone(ZoneRule::SigmaZone) => Vec::new(),
        Variation::Zone(ZoneRule::UniformInZone) => octahedron(|_| 1.0),
        Variation::Disc(ZoneRule::SigmaZone | ZoneRule::Translation) => Vec::new(),
        Variation::Disc(ZoneRule::UniformInZone) => disc(|_| 1.0),
        Variation::Nested(zone) if zone.is_normal() => Vec::new(),
        Variation::Nested(zone) => zone.nodes(),
        Variation::Disc(ZoneRule::Truncated) => disc(|square| libm::exp(-4.5 * square)),
        Variation::Zone(ZoneRule::Truncated) => {
            octahedron(|at| libm::exp(-13.5 * at.iter().map(|x| x * x).sum::<f64>()))
        }
    })
}

/// Nodes of a standard normal score, with this many pieces a standard deviation: for values of it that jump or have kinks.
pub fn scores(pieces: u32) -> Vec<Node> {
    let count = REACH * f64::from(pieces);
    let borders: Vec<f64> = normal_pieces(-count, count).iter().map(|border| border / f64::from(pieces)).collect();
    normalised(line(&borders, |z| (z, density(z))))
}

/// With weights that add up to 1.
fn normalised(mut nodes: Vec<Node>) -> Vec<Node> {
    let total: f64 = nodes.iter().map(|node| node.weight).sum();
    nodes.iter_mut().for_each(|node| node.weight /= total);
    nodes
}

fn scalar(distribution: &Distribution) -> Vec<Node> {
    let straight = |x: f64| (x, 1.0);
    match distribution {
        Distribution::Constant(value) => vec![Node { weight: 1.0, at: [*value, 0.0, 0.0, 0.0] }],
        Distribution::Normal { mean, deviation } => {
            line(&normal_pieces(-REACH, REACH), |z| (mean + deviation * z, density(z)))
        }
        Distribution::TruncatedNormal { mean, deviation, limits } => {
            let [low, high] = limits.map(|limit| (limit - mean) / deviation);
            // Where the density has fallen to nothing seen from its largest value within the limits.
            let top = 0.0f64.clamp(low, high);
            let (from, to) = (low.max(top - REACH), high.min(top + REACH));
            line(&normal_pieces(from, to), |z| (mean + deviation * z, libm::exp(-0.5 * (z - top) * (z + top))))
        }
        Distribution::Uniform { limits } => line(limits, straight),
        Distribution::Triangular { limits: [low, high], mode } => trapezoid([*low, *high], [*mode, *mode]),
        Distribution::Trapezoidal { limits, shoulders } => trapezoid(*limits, *shoulders),
        Distribution::Skewed { .. }
        | Distribution::Weibull { .. }
        | Distribution::Gumbel { .. }
        | Distribution::Beta { .. } => {
            let marginal = Marginal::new(distribution);
            line(&normal_pieces(-REACH, REACH), |z| (marginal.value(z), density(z)))
        }
        Distribution::Mixture(parts) => {
            let part = |(share, part): &(f64, Distribution)| {
                let mut nodes = normalised(scalar(part));
                nodes.iter_mut().for_each(|node| node.weight *= share);
                nodes
            };
            parts.iter().flat_map(part).collect()
        }
        Distribution::Table(values) => {
            // Every piece has the same probability, however wide it is.
            values
                .windows(2)
                .flat_map(|ends| {
                    piece(ends[0], ends[1]).map(move |(x, weight)| {
                        let width = ends[1] - ends[0];
                        Node {
                            weight: if width > 0.0 { weight / width } else { 1.0 / POINTS as f64 },
                            at: [x, 0.0, 0.0, 0.0],
                        }
                    })
                })
                .collect()
        }
    }
}

fn trapezoid([low, high]: [f64; 2], [left, right]: [f64; 2]) -> Vec<Node> {
    let density = |x: f64| {
        if x < left {
            (x - low) / (left - low)
        } else if x > right {
            (high - x) / (high - right)
        } else {
            1.0
        }
    };
    line(&[low, left, right, high], |x| (x, density(x)))
}

/// Borders of pieces at most one standard deviation wide.
fn normal_pieces(from: f64, to: f64) -> Vec<f64> {
    let count = (to - from).ceil().max(1.0);
    (0..=count as usize).map(|i| from + (to - from) * i as f64 / count).collect()
}

/// Nodes between `borders`, each at the place and with the density that `map` gives.
fn line(borders: &[f64], map: impl Fn(f64) -> (f64, f64)) -> Vec<Node> {
    let node = |(x, weight): (f64, f64)| {
        let (place, density) = map(x);
        Node { weight: weight * density, at: [place, 0.0, 0.0, 0.0] }
    };
    borders.windows(2).flat_map(|ends| piece(ends[0], ends[1])).map(node).collect()
}

/// The octahedron |u| + |p| + |r| ≤ 1 with the given `density`, by the Duffy transformation of each of its octants.
fn octahedron(density: impl Fn([f64; 3]) -> f64) -> Vec<Node> {
    let points: Vec<(f64, f64)> = piece(0.0, 1.0).collect();
    let mut nodes = Vec::with_capacity(8 * points.len() * points.len() * points.len());
    for (a, wa) in &points {
        for (b, wb) in &points {
            for (c, wc) in &points {
                let (u, p) = (*a, (1.0 - a) * b);
                let r = (1.0 - u - p) * c;
                let weight = wa * wb * wc * (1.0 - u) * (1.0 - u - p) * density([u, p, r]);
                for octant in 0..8 {
                    let sign = |bit: u32| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
                    nodes.push(Node { weight, at: [u * sign(0), p * sign(1), r * sign(2), 0.0] });
                }
            }
        }
    }
    nodes
}

/// The disc x² + y² ≤ 1 with the given `density` of the squared radius: Gauss's points along it, equal angles.
fn disc(density: impl Fn(f64) -> f64) -> Vec<Node> {
    const ANGLES: usize = 16;
    let mut nodes = Vec::new();
    for (radius, weight) in [0.0, 0.5].into_iter().flat_map(|from| piece(from, from + 0.5)) {
        for angle in 0..ANGLES {
            let angle = std::f64::consts::TAU * (angle as f64 + 0.5) / ANGLES as f64;
            let at = [radius * libm::cos(angle), radius * libm::sin(angle), 0.0, 0.0];
            nodes.push(Node { weight: weight * radius * density(radius * radius), at });
        }
    }
    nodes
}

/// Mean and standard deviation of every variable of a contributor.
pub fn mean_and_deviation(variation: &Variation) -> Vec<[f64; 2]> {
    if let Variation::Zone(ZoneRule::SigmaZone) = variation {
        return vec![[0.0, SIGMA_ZONE]; 3];
    }
    if let Variation::Nested(zone) = variation
        && zone.is_normal()
    {
        let [place, tilts] = zone.deviations();
        return (0..zone.variables()).map(|k| [0.0, if k < zone.places() { place } else { tilts }]).collect();
    }
    if let Variation::Disc(ZoneRule::SigmaZone | ZoneRule::Translation) = variation {
        return vec![[0.0, SIGMA_DISC]; 2];
    }
    if let Variation::Scalar { distribution: Distribution::Normal { mean, deviation }, .. } = variation {
        return vec![[*mean, *deviation]];
    }
    let nodes = nodes(variation);
    (0..variation.variables())
        .map(|k| {
            let mean: f64 = nodes.iter().map(|node| node.weight * node.at[k]).sum();
            let square: f64 = nodes.iter().map(|node| node.weight * (node.at[k] - mean) * (node.at[k] - mean)).sum();
            [mean, libm::sqrt(square)]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{mean_and_deviation, nodes};
    use crate::model::{Distribution, Variation, ZoneRule};

    fn scalar(distribution: Distribution) -> Variation {
        Variation::Scalar { distribution, limits: [0.0, 1.0] }
    }

    #[test]
    fn moments_of_scalars() {
        let limits = [-1.0, 3.0];
        let third = libm::sqrt(1.0 / 3.0);
        // A normal cut at one standard deviation on both sides keeps the variance 1 − 2φ(1)/(2Φ(1) − 1).
        let cut = 1.0 - 2.0 * 0.241_970_724_519_143_37 / 0.682_689_492_137_085_9;
        for (distribution, [mean, deviation]) in [
            (Distribution::Constant(2.0), [2.0, 0.0]),
            (Distribution::Normal { mean: 1.0, deviation: 0.5 }, [1.0, 0.5]),
            (Distribution::TruncatedNormal { mean: 1.0, deviation: 2.0, limits }, [1.0, 2.0 * libm::sqrt(cut)]),
            (Distribution::Uniform { limits }, [1.0, 2.0 * third]),
            (Distribution::Triangular { limits, mode: 0.0 }, [2.0 / 3.0, libm::sqrt(13.0 / 18.0)]),
            // The sum of two rectangulars of widths 3 and 1.
            (Distribution::Trapezoidal { limits, shoulders: [0.0, 2.0] }, [1.0, libm::sqrt(10.0 / 12.0)]),
            (Distribution::Skewed { mean: 4.0, deviation: 0.3, skewness: -0.7 }, [4.0, 0.3]),
            (Distribution::Skewed { mean: 4.0, deviation: 0.3, skewness: 1e-6 }, [4.0, 0.3]),
            (Distribution::Table(vec![0.0, 1.0, 1.0, 3.0]), [7.0 / 6.0, libm::sqrt(17.0 / 9.0 - 49.0 / 36.0 + 0.0)]),
        ] {
            let expected = scalar(distribution.clone());
            let found = mean_and_deviation(&expected)[0];
            // The table's second moment is (1/3 + 1 + 13/3)/3.
            assert!(
                (found[0] - mean).abs() < 1e-12 && (found[1] - deviation).abs() < 1e-12,
                "{distribution:?} {found:?}"
            );
        }
    }

    #[test]
    fn skewness_is_the_one_asked_for() {
        for skewness in [-0.7, 0.2, 2.0] {
            let variation = scalar(Distribution::Skewed { mean: 1.0, deviation: 0.1, skewness });
            let cube = |x: f64| x * x * x;
            let third: f64 = nodes(&variation).iter().map(|node| node.weight * cube((node.at[0] - 1.0) / 0.1)).sum();
            assert!((third - skewness).abs() < 1e-9, "{third}");
        }
    }

    /// Numbers of a zone of width t = 2: centre √0.1, edge middle √0.2, corner √0.3 of t/2 for the uniform rule.
    #[test]
    fn deviations_in_zones() {
        let of = |rule| mean_and_deviation(&Variation::Zone(rule));
        let uniform = of(ZoneRule::UniformInZone)[0][1];
        assert!((uniform / 2.0 - 0.158_11).abs() < 5e-6);
        assert!((uniform - libm::sqrt(0.1)).abs() < 1e-12);
        let nodes = nodes(&Variation::Zone(ZoneRule::UniformInZone));
        let deviation = |g: [f64; 3]| {
            let value = |at: [f64; 4]| g[0] * at[0] + g[1] * at[1] + g[2] * at[2];
            libm::sqrt(nodes.iter().map(|node| node.weight * value(node.at) * value(node.at)).sum::<f64>())
        };
        assert!((deviation([1.0, 1.0, 0.0]) - libm::sqrt(0.2)).abs() < 1e-12);
        assert!((deviation([1.0, 1.0, 1.0]) / 2.0 - 0.273_86).abs() < 5e-6);
        let corner = of(ZoneRule::SigmaZone).iter().map(|[_, deviation]| deviation * deviation).sum::<f64>();
        assert!((libm::sqrt(corner) - 1.0 / 3.0).abs() < 1e-15);
        assert!((of(ZoneRule::Translation)[0][1] - 1.0 / 3.0).abs() < 1e-12);
        let truncated = of(ZoneRule::Truncated)[0][1];
        assert!(truncated < crate::model::SIGMA_ZONE && truncated > 0.97 * crate::model::SIGMA_ZONE);
    }

    /// Of a `sigma-zone`, 98.956 % lies inside: the integral of its density over the octahedron.
    #[test]
    fn share_inside_a_zone() {
        let variance = 2.0 * crate::model::SIGMA_ZONE * crate::model::SIGMA_ZONE;
        let exponential = |at: [f64; 3]| libm::exp(-at.iter().map(|x| x * x).sum::<f64>() / variance);
        let integral: f64 = super::octahedron(exponential).iter().map(|node| node.weight).sum();
        let inside = integral / libm::pow(std::f64::consts::PI * variance, 1.5);
        assert!((inside - crate::sampling::draw::INSIDE).abs() < 1e-8, "{inside}");
        assert!((inside - 0.989_56).abs() < 5e-6);
    }
}
