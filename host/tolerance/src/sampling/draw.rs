//! From random numbers to the variables of a model.
//!
//! Independent standard normal scores come first; a Gaussian copula correlates them, and every contributor makes its
//! variables of its own. All that needs a probability works on these scores.

use slipfit_core::sampling::stream::{Rng, derived, unit_stream};

pub use super::error::DrawError;

use super::correlation::{Row, cholesky};
use crate::{
    distribution::Marginal,
    model::{Model, SIGMA_DISC, SIGMA_ZONE, Variation, ZoneRule, nested::Nested},
    numeric::{
        lanes::{LANES, Lanes, widest},
        normal::{Scores, tail},
    },
};

/// Draws the variables of a model's units.
pub struct Draw {
    seed: u64,
    rules: Vec<Rule>,
    correlated: Vec<Row>,
    dimensions: usize,
}

enum Rule {
    Scalar(Marginal),
    Zone(ZoneRule),
    Disc(ZoneRule),
    /// With the share of the normal rule that stays.
    Nested(Nested, f64),
}

/// The most variables of a contributor.
const MOST: usize = 4;

/// How far a point of a zone reaches; at most 1 inside.
type Reach<'a> = &'a dyn Fn(&[f64]) -> f64;

/// P(|u| + |p| + |r| ≤ 1) of three normals with the standard deviation of [`SIGMA_ZONE`].
pub const INSIDE: f64 = 0.989_559_252_225_155;
/// P(x² + y² ≤ 1) of two normals with a standard deviation of a third: 1 − exp(−9/2).
pub const INSIDE_DISC: f64 = 0.988_891_003_461_758;

impl Draw {
    /// Of the units of `model` in a production `seed`.
    ///
    /// # Errors
    /// [`DrawError`], if its correlations are impossible or there is nothing to draw.
    pub fn new(model: &Model, seed: u64) -> Result<Self, DrawError> {
        if model.contributors.is_empty() {
            return Err(DrawError::Empty("contributors"));
        }
        if model.measures.is_empty() {
            return Err(DrawError::Empty("measures"));
        }
        let rules = model.contributors.iter().map(|contributor| match &contributor.variation {
            Variation::Scalar { distribution, .. } => Rule::Scalar(Marginal::new(distribution)),
            Variation::Zone(rule) => Rule::Zone(*rule),
            Variation::Disc(rule) => Rule::Disc(*rule),
            Variation::Nested(zone) => {
                let inside = if zone.rule == ZoneRule::Truncated { zone.inside() } else { 1.0 };
                Rule::Nested(*zone, inside)
            }
        });
        let dimensions = model.variables();
        Ok(Self { seed, rules: rules.collect(), correlated: cholesky(model)?, dimensions })
    }

    /// How many variables, and so random numbers, a unit has.
    pub fn dimensions(&self) -> usize {
        self.dimensions
    }

    /// Variables of the units from `first` on, from their random `bits`.
    pub fn variables(&self, first: u64, bits: &[[u64; LANES]], variables: &mut [Lanes]) {
        let table = Scores::table();
        widest(
            #[inline(always)]
            || {
                for (variable, bits) in variables.iter_mut().zip(bits) {
                    *variable = table.lanes(*bits);
                }
            },
        );
        self.transform(variables);
        let mut at = 0;
        for (number, rule) in self.rules.iter().enumerate() {
            let own = &mut variables[at..at + rule.variables()];
            match rule {
                Rule::Zone(ZoneRule::Truncated) => {
                    self.draw_again(first, number as u64, own, &[SIGMA_ZONE; 3], octahedral);
                }
                Rule::Disc(ZoneRule::Truncated) => {
                    self.draw_again(first, number as u64, own, &[SIGMA_DISC; 2], circular);
                }
                Rule::Nested(zone, _) if zone.rule == ZoneRule::Truncated => {
                    let [place, tilts] = zone.deviations();
                    let deviations = [place, if zone.places() > 1 { place } else { tilts }, tilts, tilts];
                    self.draw_again(first, number as u64, own, &deviations, |point| zone.reach(point));
                }
                _ => (),
            }
            at += rule.variables();
        }
    }

    /// Turns independent standard normal scores into variables. Truncated zones are not truncated: see
    /// [`Draw::is_inside`].
    pub fn transform(&self, scores: &mut [Lanes]) {
        widest(
            #[inline(always)]
            || self.transform_here(scores),
        );
    }

    #[inline(always)]
    fn transform_here(&self, scores: &mut [Lanes]) {
        // From the last on, so that the scores before are still independent.
        for (variable, weights) in self.correlated.iter().rev() {
            let sum = weights.iter().fold(Lanes::ZERO, |sum, (other, weight)| sum + scores[*other] * *weight);
            scores[*variable] = sum;
        }
        let mut at = 0;
        for rule in &self.rules {
            match rule {
                Rule::Scalar(marginal) => scores[at] = marginal.values(scores[at]),
                Rule::Zone(ZoneRule::Translation) => scores[at] = scores[at] * (1.0 / 3.0),
                Rule::Zone(ZoneRule::SigmaZone | ZoneRule::Truncated) => {
                    for score in &mut scores[at..at + 3] {
                        *score = *score * SIGMA_ZONE;
                    }
                }
                Rule::Nested(zone, _) if zone.rule == ZoneRule::UniformInZone => {
                    let own = &mut scores[at..at + zone.variables()];
                    for lane in 0..LANES {
                        let point = zone.uniform(point(own, lane, &mut [0.0; MOST]));
                        own.iter_mut().zip(point).for_each(|(score, value)| score.0[lane] = value);
                    }
                }
                Rule::Nested(zone, _) => {
                    let [place, tilts] = zone.deviations();
                    for (k, score) in scores[at..at + zone.variables()].iter_mut().enumerate() {
                        *score = *score * if k < zone.places() { place } else { tilts };
                    }
                }
                Rule::Disc(ZoneRule::UniformInZone) => {
                    for lane in 0..LANES {
                        let point = in_disc([0, 1].map(|k| scores[at + k].0[lane]));
                        point.into_iter().enumerate().for_each(|(k, value)| scores[at + k].0[lane] = value);
                    }
                }
                Rule::Disc(_) => {
                    for score in &mut scores[at..at + 2] {
                        *score = *score * SIGMA_DISC;
                    }
                }
                Rule::Zone(ZoneRule::UniformInZone) => {
                    for lane in 0..LANES {
                        let point = in_octahedron([0, 1, 2].map(|k| scores[at + k].0[lane]));
                        point.into_iter().enumerate().for_each(|(k, value)| scores[at + k].0[lane] = value);
                    }
                }
            }
            at += rule.variables();
        }
    }

    /// Which units have all their truncated zones inside, and how much more probable a unit is for it.
    pub fn is_inside(&self, variables: &[Lanes]) -> ([bool; LANES], f64) {
        let (mut inside, mut factor, mut at) = ([true; LANES], 1.0, 0);
        for rule in &self.rules {
            let own = &variables[at..at + rule.variables()];
            let (reach, share): (Reach, f64) = match rule {
                Rule::Zone(ZoneRule::Truncated) => (&octahedral, INSIDE),
                Rule::Disc(ZoneRule::Truncated) => (&circular, INSIDE_DISC),
                Rule::Nested(zone, inside) => (&|point| zone.reach(point), *inside),
                _ => (&|_| 0.0, 1.0),
            };
            if share < 1.0 {
                for (lane, inside) in inside.iter_mut().enumerate() {
                    *inside &= reach(point(own, lane, &mut [0.0; MOST])) <= 1.0;
                }
                factor /= share;
            }
            at += rule.variables();
        }
        (inside, factor)
    }

    /// Draws zones that came out too wide again until they `reach` no further than 1, from a stream of their unit and
    /// contributor.
    fn draw_again(
        &self,
        first: u64,
        contributor: u64,
        zone: &mut [Lanes],
        deviations: &[f64],
        reach: impl Fn(&[f64]) -> f64,
    ) {
        for lane in 0..LANES {
            let mut room = [0.0; MOST];
            let value = point(zone, lane, &mut room);
            if reach(value) <= 1.0 {
                continue;
            }
            let mut stream = unit_stream(derived(self.seed, u64::MAX - contributor), first + lane as u64);
            while reach(value) > 1.0 {
                for (x, deviation) in value.iter_mut().zip(deviations) {
                    *x = deviation * Scores::table().score(stream.next_u64());
                }
            }
            zone.iter_mut().zip(value).for_each(|(variable, x)| variable.0[lane] = *x);
        }
    }
}

impl Rule {
    fn variables(&self) -> usize {
        match self {
            Self::Scalar(_) | Self::Zone(ZoneRule::Translation) => 1,
            Self::Disc(_) => 2,
            Self::Nested(zone, _) => zone.variables(),
            Self::Zone(_) => 3,
        }
    }
}

/// One unit's variables of a contributor.
fn point<'a>(own: &[Lanes], lane: usize, room: &'a mut [f64; MOST]) -> &'a mut [f64] {
    room.iter_mut().zip(own).for_each(|(x, variable)| *x = variable.0[lane]);
    &mut room[..own.len()]
}

fn octahedral(zone: &[f64]) -> f64 {
    zone.iter().map(|x| x.abs()).sum()
}

fn circular(disc: &[f64]) -> f64 {
    libm::sqrt(disc.iter().map(|x| x * x).sum())
}

/// A point uniform in the disc from two independent scores: in their direction, at the radius of the same probability.
fn in_disc([x, y]: [f64; 2]) -> [f64; 2] {
    let square = x * x + y * y;
    let scale = if square > 0.0 { libm::sqrt(-libm::expm1(-0.5 * square) / square) } else { 0.0 };
    [x * scale, y * scale]
}

/// A point uniform in the octahedron from three independent scores: Rosenblatt's transformation, in closed form.
fn in_octahedron([u, p, r]: [f64; 3]) -> [f64; 3] {
    let outside = |score: f64| 2.0 * tail(score.abs());
    let left = libm::cbrt(outside(u));
    let left_then = left * libm::sqrt(outside(p));
    [(1.0 - left).copysign(u), (left - left_then).copysign(p), (left_then * (1.0 - outside(r))).copysign(r)]
}

#[cfg(test)]
mod tests {
    use super::{Draw, DrawError, INSIDE, octahedral};
    use crate::{
        examples::{linear, normal},
        model::{Contributor, Model, Variation, ZoneRule},
        numeric::lanes::LANES,
        sampling::sampler::{Method, Sampler},
    };

    fn units(model: &Model, count: u64) -> Vec<Vec<f64>> {
        let draw = Draw::new(model, 5).unwrap();
        let sampler = Sampler::new(Method::PseudoRandom, 5, draw.dimensions(), 1, count);
        let mut bits = vec![[0; LANES]; draw.dimensions()];
        let mut variables = vec![super::Lanes::ZERO; draw.dimensions()];
        let mut units = Vec::new();
        for first in (0..count).step_by(LANES) {
            sampler.fill(first, &mut bits);
            draw.variables(first, &bits, &mut variables);
            units.extend((0..LANES).map(|lane| variables.iter().map(|variable| variable.0[lane]).collect::<Vec<_>>()));
        }
        units
    }

    fn zone(rule: ZoneRule) -> Model {
        linear(vec![Contributor { name: "face".into(), variation: Variation::Zone(rule) }], vec![vec![1.0; 3]])
    }

    #[test]
    fn zones_are_kept_and_filled_as_their_rule_says() {
        let count = 40_000;
        let inside =
            |units: &[Vec<f64>]| units.iter().filter(|unit| octahedral(unit) <= 1.0).count() as f64 / count as f64;
        let share = inside(&units(&zone(ZoneRule::SigmaZone), count));
        let error = libm::sqrt(INSIDE * (1.0 - INSIDE) / count as f64);
        assert!((share - INSIDE).abs() < 4.0 * error, "{share}");
        for rule in [ZoneRule::Truncated, ZoneRule::UniformInZone] {
            let units = units(&zone(rule), count);
            assert_eq!(inside(&units), 1.0);
            let expected = crate::distribution::quadrature::mean_and_deviation(&Variation::Zone(rule));
            for k in 0..3 {
                let square: f64 = units.iter().map(|unit| unit[k] * unit[k]).sum::<f64>() / count as f64;
                assert!((square / expected[k][1] / expected[k][1] - 1.0).abs() < 0.04, "{rule:?} {k} {square}");
            }
        }
        let nodes = crate::distribution::quadrature::nodes(&Variation::Zone(ZoneRule::Truncated));
        assert!((nodes.iter().map(|node| node.weight).sum::<f64>() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn discs_are_kept_and_filled_as_their_rule_says() {
        let count = 40_000;
        let of = |rule| {
            linear(vec![Contributor { name: "axis".into(), variation: Variation::Disc(rule) }], vec![vec![1.0; 2]])
        };
        for (rule, deviation) in [
            (ZoneRule::SigmaZone, 1.0 / 3.0),
            (ZoneRule::Translation, 1.0 / 3.0),
            // σ² = (1 − 4.5·e^−4.5/(1 − e^−4.5))/9.
            (ZoneRule::Truncated, libm::sqrt((1.0 - 4.5 * libm::exp(-4.5) / super::INSIDE_DISC) / 9.0)),
            (ZoneRule::UniformInZone, 0.5),
        ] {
            let units = units(&of(rule), count);
            let inside = units.iter().filter(|unit| super::circular(unit) <= 1.0).count() as f64 / count as f64;
            let expected = if deviation * 3.0 == 1.0 { super::INSIDE_DISC } else { 1.0 };
            assert!((inside - expected).abs() < 4.0 * libm::sqrt(0.011 / count as f64), "{rule:?} {inside}");
            for (k, known) in
                crate::distribution::quadrature::mean_and_deviation(&Variation::Disc(rule)).iter().enumerate()
            {
                let square: f64 = units.iter().map(|unit| unit[k] * unit[k]).sum::<f64>() / count as f64;
                assert!((libm::sqrt(square) / deviation - 1.0).abs() < 0.02, "{rule:?} {k} {square}");
                assert!(known[0].abs() < 1e-12 && (known[1] / deviation - 1.0).abs() < 1e-9, "{rule:?} {known:?}");
            }
        }
    }

    #[test]
    fn correlations_are_those_asked_for() {
        let mut model = linear((0..4).map(|_| normal("x", 0.0, 3.0)).collect(), vec![vec![1.0; 4]]);
        model.correlations = vec![(0, 2, 0.8), (3, 2, -0.5), (0, 3, -0.3)];
        let count = 40_000;
        let units = units(&model, count);
        for (i, j, expected) in [(0, 2, 0.8), (2, 3, -0.5), (0, 3, -0.3), (0, 1, 0.0), (2, 2, 1.0)] {
            let product = units.iter().map(|unit| unit[i] * unit[j]).sum::<f64>() / count as f64;
            assert!((product - expected).abs() < 4.0 * libm::sqrt((1.0 + expected * expected) / count as f64));
        }
        model.correlations = vec![(0, 2, 0.9), (3, 2, 0.9), (0, 3, -0.9)];
        assert_eq!(Draw::new(&model, 0).err(), Some(DrawError::NotPositiveDefinite("x".into())));
    }
}
