//! Where failures lie: one region behind a nearly flat border, or several, or a whole ring.

use slipfit_core::sampling::stream::{Rng, derived, unit_stream};

use super::{DesignPoint, LimitState, Margins, dot, importance::Mixture, norm};
use crate::numeric::normal::{Scores, density, tail};

/// How far a nearly linear margin may leave its tangent (scores of the steepest direction).
const STRAIGHT: f64 = 0.1;
/// How far the steepest direction may turn (cosine).
const TURN: f64 = 0.9;
/// The most design points of a mixture.
const MOST_POINTS: usize = 96;
/// Units that show where failures lie.
const WITNESSES: usize = 512;
/// Design points nearer to each other than this (scores) are one.
const NEAR: f64 = 0.3;
/// How much more probable than in the mixture a unit may be, against the most that a flat border or a corner has: what is
/// aimed at, and what is enough for nearly all.
const EXCESS: [f64; 2] = [1.5, 5.0];
/// The share of units for which it need not be enough.
const BARE: f64 = 0.02;
/// Passes that find the weights of a mixture.
const PASSES: usize = 4;
/// The least weight of a point, in equal shares.
const LEAST: f64 = 0.1;

/// Whether the margin goes one way: nearly linear, or at least steepest in nearly the same direction everywhere. Then a
/// failure has one region, and the border of it one design point.
pub fn is_straight(state: &mut LimitState, seed: u64) -> bool {
    let dimensions = state.dimensions();
    let (value, slopes) = state.expansion(&vec![0.0; dimensions]);
    let steepness = norm(&slopes);
    if !(value.is_finite() && steepness.is_finite() && steepness > 0.0) {
        return false;
    }
    let direction: Vec<f64> = slopes.iter().map(|slope| slope / steepness).collect();
    let along = |length: f64| direction.iter().map(|x| x * length).collect::<Vec<_>>();
    let random = |number: u64, scale: f64| {
        let mut stream = unit_stream(seed, number);
        (0..dimensions).map(|_| scale * Scores::table().score(stream.next_u64())).collect::<Vec<_>>()
    };
    let lengths = (1..=8).flat_map(|length| [-f64::from(length), f64::from(length)]);
    let points: Vec<Vec<f64>> = lengths.map(along).chain((0..48).map(|number| random(number, 3.0))).collect();
    let linear =
        |(point, margin): (&Vec<f64>, f64)| (margin - value - dot(&slopes, point)).abs() <= STRAIGHT * steepness;
    if points.iter().zip(state.at(&points)).all(linear) {
        return true;
    }
    let points = [-6.0, -3.0, 3.0, 6.0].into_iter().map(along).chain((0..12).map(|number| random(number, 2.0)));
    points.collect::<Vec<_>>().iter().all(|point| {
        let here = state.expansion(point).1;
        dot(&here, &direction) >= TURN * norm(&here)
    })
}

/// Units that fail as they do over the production, some of them around design points of their own.
pub struct Cover {
    witnesses: Vec<Vec<f64>>,
    points: Vec<DesignPoint>,
    /// Of each point, the density of its normal over the production's at every witness.
    densities: Vec<Vec<f64>>,
    weights: Vec<f64>,
}

impl Cover {
    /// Of some of the `failing` units, each from somewhere else.
    pub fn new(failing: Vec<Vec<f64>>) -> Self {
        let step = failing.len().div_ceil(WITNESSES).max(1);
        let witnesses = failing.into_iter().step_by(step).collect();
        Self { witnesses, points: Vec::new(), densities: Vec::new(), weights: Vec::new() }
    }

    /// Adds a point, unless another is near.
    pub fn add(&mut self, point: DesignPoint) -> bool {
        let near = |other: &DesignPoint| {
            let apart: Vec<f64> = other.point.iter().zip(&point.point).map(|(a, b)| a - b).collect();
            norm(&apart) < NEAR
        };
        if self.points.iter().any(near) {
            return false;
        }
        let half = 0.5 * point.distance * point.distance;
        self.densities.push(self.witnesses.iter().map(|unit| libm::exp(dot(unit, &point.point) - half)).collect());
        self.points.push(point);
        self.weights = vec![1.0 / self.points.len() as f64; self.points.len()];
        (0..PASSES).for_each(|_| self.weigh());
        true
    }

    /// A pass of expectation and maximisation: every witness counts for the points as these explain it.
    fn weigh(&mut self) {
        let mut sums = vec![LEAST * self.witnesses.len() as f64 / self.points.len() as f64; self.points.len()];
        for witness in 0..self.witnesses.len() {
            let of = |point: usize| self.weights[point] * self.densities[point][witness];
            let all: f64 = (0..self.points.len()).map(of).sum();
            if all > 0.0 && all.is_finite() {
                sums.iter_mut().enumerate().for_each(|(point, sum)| *sum += of(point) / all);
            }
        }
        let all: f64 = sums.iter().sum();
        self.weights = sums.into_iter().map(|sum| sum / all).collect();
    }

    /// The density of the mixture over the production's at a witness.
    fn density(&self, witness: usize) -> f64 {
        self.densities.iter().zip(&self.weights).map(|(densities, weight)| weight * densities[witness]).sum()
    }

    /// Adds design points until none of the witnesses, which fail with `probability`, is much less probable in the mixture
    /// than over the production; gives whether that is so.
    pub fn complete(&mut self, state: &mut LimitState, probability: f64) -> bool {
        let mut lost = vec![false; self.witnesses.len()];
        // Behind a flat border or in a corner at β, the density over that of a normal there is φ(β)/φ(0) at most; many
        // design points at β are as probable as a nearer one.
        let reliability = reliability(probability);
        let scarce = |cover: &Self, excess: f64, witness: usize| {
            let nearest = cover.points.iter().map(|point| point.distance).fold(reliability, f64::min);
            cover.density(witness) * excess * density(nearest) < density(0.0)
        };
        while self.points.len() < MOST_POINTS {
            let open = (0..self.witnesses.len()).filter(|witness| !lost[*witness]);
            let worst = open.map(|witness| (witness, self.density(witness))).min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((witness, _)) = worst.filter(|(witness, _)| scarce(self, EXCESS[0], *witness)) else { break };
            let found = state.design_point(&self.witnesses[witness]);
            if !found.is_some_and(|point| self.add(point)) {
                lost[witness] = true;
            }
        }
        let bare = (0..self.witnesses.len()).filter(|witness| scarce(self, EXCESS[1], *witness)).count();
        bare as f64 <= BARE * self.witnesses.len() as f64
    }

    /// The mixture, if there is a point.
    pub fn mixture(self) -> Option<Mixture> {
        (!self.points.is_empty()).then(|| Mixture::new(self.points, self.weights))
    }
}

/// β with P(Z > β) = `probability`, at least 0.
fn reliability(probability: f64) -> f64 {
    let (mut low, mut high) = (0.0, 40.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if tail(middle) > probability { low = middle } else { high = middle }
    }
    low
}

/// A seed of its own for each of `count` runs.
pub fn seeds(seed: u64, count: u64) -> impl Iterator<Item = u64> {
    (0..count).map(move |number| derived(seed, number))
}
