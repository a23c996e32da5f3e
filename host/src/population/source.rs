//! What the units of a production are drawn from: a product's model, or gaps and parameters that vary by themselves.

use std::{
    ops::{Deref, Range},
    sync::Arc,
};

use slipfit_core::clearance::GapStatistics;
use slipfit_tolerance::{
    failure::gathered,
    model::{Contributor, Distribution, Measure, Model, Quantity, Variation, linear::Linear},
    numeric::lanes::{LANES, Lanes},
    sampling::{
        draw::{Draw, DrawError},
        sampler::{Method, Sampler},
    },
};

use crate::setup::MeasuredGaps;

/// The most units of a production.
pub const MOST_UNITS: u64 = 1 << 40;

/// What a scene says of a gap.
#[derive(Clone)]
pub struct Stated {
    /// Its name.
    pub name: String,
    /// Mean and standard deviation (m).
    pub statistics: GapStatistics<f64>,
    /// The measure of the product that it is, if it is one.
    pub measure: Option<usize>,
}

/// A model whose units are drawn.
pub struct Source<'a> {
    pub model: Held<'a>,
    pub draw: Draw,
    pub sampler: Sampler,
}

pub enum Held<'a> {
    Shared(&'a Model),
    Own(Box<Model>),
}

impl Deref for Held<'_> {
    type Target = Model;

    fn deref(&self) -> &Model {
        match self {
            Self::Shared(model) => model,
            Self::Own(model) => model,
        }
    }
}

/// Values of some units, a column for each variable and for each measure.
pub struct Columns {
    pub variables: Vec<Vec<f64>>,
    pub measures: Vec<Vec<f64>>,
}

impl<'a> Source<'a> {
    pub fn new(model: Held<'a>, seed: u64) -> Result<Self, DrawError> {
        let draw = Draw::new(&model, seed)?;
        let sampler = Sampler::new(Method::PseudoRandom, seed, draw.dimensions(), 1, MOST_UNITS);
        Ok(Self { model, draw, sampler })
    }

    /// Of the units `numbers`.
    pub fn draw(&self, numbers: &Range<u64>) -> Columns {
        let mut bits = vec![[0; LANES]; self.draw.dimensions()];
        self.columns((numbers.end - numbers.start) as usize, |start, variables| {
            let first = numbers.start + start as u64;
            self.sampler.fill(first, &mut bits);
            self.draw.variables(first, &bits, variables);
        })
    }

    /// Of the units at `points`, whose scores `own` are this source's; those that it does not make are not `made`.
    pub fn at(&self, points: &[Vec<f64>], own: Range<usize>, made: &mut [bool]) -> Columns {
        self.columns(points.len(), |start, variables| {
            let group = &points[start..points.len().min(start + LANES)];
            let scores: Vec<Vec<f64>> = group.iter().map(|point| point[own.clone()].to_vec()).collect();
            variables.copy_from_slice(&gathered(&scores));
            self.draw.transform(variables);
            let (inside, _) = self.draw.is_inside(variables);
            made[start..].iter_mut().zip(inside).for_each(|(made, inside)| *made &= inside);
        })
    }

    /// Of `count` units, some at a time, for which `fill` is given the first and writes variables.
    fn columns(&self, count: usize, mut fill: impl FnMut(usize, &mut [Lanes])) -> Columns {
        let mut variables = vec![Lanes::ZERO; self.draw.dimensions()];
        let mut measures = vec![Lanes::ZERO; self.model.measures.len()];
        let mut columns = [vec![Vec::new(); variables.len()], vec![Vec::new(); measures.len()]];
        for start in (0..count).step_by(LANES) {
            fill(start, &mut variables);
            self.model.function.evaluate(&variables, &mut measures);
            let here = (count - start).min(LANES);
            for (columns, values) in columns.iter_mut().zip([&variables, &measures]) {
                columns.iter_mut().zip(values.iter()).for_each(|(column, lanes)| column.extend(&lanes.0[..here]));
            }
        }
        let [variables, measures] = columns;
        Columns { variables, measures }
    }
}

/// Gaps by their numbers: distributed and correlated as they were `measured`, else normal with the given statistics, any two
/// with the same correlation.
pub fn of_statistics(gaps: &[(usize, &Stated)], correlation: f64, measured: &MeasuredGaps) -> Model {
    let place = |gap: usize| measured.distributions.iter().position(|(number, _)| *number == gap);
    let normal = |(number, gap): &(usize, &Stated)| {
        let GapStatistics { mean, deviation } = gap.statistics;
        let distribution = match place(*number) {
            Some(place) => measured.distributions[place].1.clone(),
            None if deviation > 0.0 => Distribution::Normal { mean, deviation },
            None => Distribution::Constant(mean),
        };
        let limits = [mean - 3.0 * deviation, mean + 3.0 * deviation];
        Contributor { name: format!("{} gap", gap.name), variation: Variation::Scalar { distribution, limits } }
    };
    let varying: Vec<usize> = (0..gaps.len()).filter(|i| gaps[*i].1.statistics.deviation > 0.0).collect();
    let of_pair = |i: usize, j: usize| match [i, j].map(|at| place(gaps[at].0)) {
        [Some(one), Some(other)] => measured.correlation(one, other),
        _ => correlation,
    };
    let pairs = varying.iter().flat_map(|i| varying.iter().filter(move |j| *j > i).map(move |j| (*i, *j)));
    let correlations = pairs.map(|(i, j)| (i, j, of_pair(i, j))).filter(|(.., r)| *r != 0.0).collect();
    Model { correlations, ..each_itself(gaps.iter().map(normal).collect()) }
}

/// Every contributor, a scalar, as a measure.
pub fn each_itself(contributors: Vec<Contributor>) -> Model {
    let count = contributors.len();
    let row = |i: usize| (0..count).map(|k| if k == i { 1.0 } else { 0.0 }).collect();
    let measures = contributors
        .iter()
        .map(|contributor| Measure { name: contributor.name.clone(), quantity: Quantity::Length, limits: [None; 2] })
        .collect();
    Model {
        contributors,
        correlations: Vec::new(),
        measures,
        sums: Vec::new(),
        function: Arc::new(Linear::new(&vec![0.0; count], &(0..count).map(row).collect::<Vec<_>>())),
    }
}
