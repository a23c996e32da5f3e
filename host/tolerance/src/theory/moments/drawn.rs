//! Moments of units that are drawn, where no formula has them.

use crate::{
    model::Model,
    numeric::{
        lanes::{LANES, Lanes},
        shape::{Shape, weighted},
    },
    sampling::{
        draw::Draw,
        sampler::{Method, Sampler},
        sobol::MOST_DIMENSIONS,
    },
};

/// Units whose moments are taken where there is no formula.
pub const DRAWN: u64 = 1 << 16;
/// The most random numbers for that: wide models have fewer units.
const MOST_NUMBERS: u64 = 1 << 25;
/// The fewest units.
const FEWEST: u64 = 1 << 10;
/// What they are drawn with.
const SEED: u64 = 1;

/// Calls `each` with the variables of `count` units, some at a time, by scrambled Sobol' points where these have coordinates
/// enough; never if none can be drawn.
pub fn drawn(model: &Model, count: u64, mut each: impl FnMut(&[Lanes])) {
    let Ok(draw) = Draw::new(model, SEED) else { return };
    let dimensions = draw.dimensions();
    let method = if dimensions > MOST_DIMENSIONS { Method::PseudoRandom } else { Method::ScrambledSobol };
    let sampler = Sampler::new(method, SEED, dimensions, 1, count);
    let mut bits = vec![[0; LANES]; dimensions];
    let mut variables = vec![Lanes::ZERO; dimensions];
    for first in (0..count).step_by(LANES) {
        sampler.fill(first, &mut bits);
        draw.variables(first, &bits, &mut variables);
        each(&variables);
    }
}

/// The variables of `count` units.
pub fn units(model: &Model, count: u64) -> Vec<Vec<f64>> {
    let mut units = Vec::with_capacity(count as usize);
    drawn(model, count, |variables| {
        units.extend((0..LANES).map(|lane| variables.iter().map(|variable| variable.0[lane]).collect()));
    });
    units
}

/// The measures of `count` units, or of fewer of a wide model.
pub fn measures_of(model: &Model, count: u64) -> Vec<Vec<f64>> {
    let most = MOST_NUMBERS / (model.variables() as u64).max(1);
    let count = if count <= most { count } else { (1 << most.max(FEWEST).ilog2()).min(count) };
    let mut values = Vec::with_capacity(count as usize);
    let mut measures = vec![Lanes::ZERO; model.measures.len()];
    drawn(model, count, |variables| {
        model.function.evaluate(variables, &mut measures);
        values.extend((0..LANES).map(|lane| measures.iter().map(|measure| measure.0[lane]).collect()));
    });
    values
}

/// Mean, standard deviation and shape of the values that are numbers.
pub fn of_values(values: impl Iterator<Item = f64> + Clone) -> ([f64; 2], Shape) {
    let values = values.filter(|value| value.is_finite());
    let weight = 1.0 / values.clone().count() as f64;
    let (mean, moments) = weighted(values.map(|value| (weight, value)));
    ([mean, libm::sqrt(moments[2])], Shape::of_moments(moments))
}
