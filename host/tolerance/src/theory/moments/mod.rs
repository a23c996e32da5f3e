//! Moments of second order: of the quadratic that touches a measure at the means of its variables.
//!
//! The cumulants of a quadratic b·z + ½ zᵀAz of independent standard normals are known in closed form. A contributor that is
//! not normal then has the cumulants of its own part of the quadratic exchanged for those by quadrature. So they are exact
//! for normal variables, and for a linear measure whatever its variables are. Only variables whose effects depend on each
//! other go into a matrix; all others add cumulants of their own.
//!
//! A quadratic knows nothing of a kink or a fold, such as that of a radius or an angle at 0. Where it does not describe units
//! drawn at random, their own moments are taken.

mod cumulants;
mod drawn;

use nalgebra::{DMatrix, DVector};

use self::{
    cumulants::{Cumulants, Group, add, gaussian, is_normal, of_one},
    drawn::{DRAWN, measures_of, of_values, units},
};
use super::derivative::{Expansion, evaluate, expansion, interacting, mixed};
use crate::distribution::quadrature::mean_and_deviation;
use crate::{
    model::Model,
    numeric::shape::{ORDER, Shape},
};

pub use self::drawn::drawn;

/// Moments of one measure (SI).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Mean.
    pub mean: f64,
    /// How far the mean lies from the value at the means of the variables.
    pub shift: f64,
    /// Standard deviation.
    pub deviation: f64,
    /// Skewness.
    pub skewness: f64,
    /// Kurtosis; 3 for a normal.
    pub kurtosis: f64,
    /// The same with the higher moments.
    pub shape: Shape,
    /// Share of the curvature in the variance, or by which share the variance by slopes is off, if that is more: 0 for a linear measure.
    pub curved: f64,
    /// Whether the quadratic describes units drawn at random: not where the measure has a kink or a fold.
    pub described: bool,
}

/// Share of the curvature in the variance up to which slopes describe a measure: RSS is then off by 5 % at most.
pub const BENT: f64 = 0.1;

impl Moments {
    /// Whether slopes describe the measure: it has no kink and no fold, and hardly curves.
    pub fn by_slopes(&self) -> bool {
        self.described && self.curved <= BENT
    }
}

/// Means and standard deviations of all variables.
pub fn spreads(model: &Model) -> (Vec<f64>, Vec<f64>) {
    let spreads = model.contributors.iter().flat_map(|contributor| mean_and_deviation(&contributor.variation));
    spreads.map(|[mean, deviation]| (mean, deviation)).unzip()
}

/// Of every measure; drawn where the quadratic does not describe it.
pub fn of_measures(model: &Model) -> Vec<Moments> {
    let (means, deviations) = spreads(model);
    moments(model, &expansion(model, &means, &deviations), &means, &deviations)
}

/// Units that show whether the quadratic describes a measure.
const WITNESSES: u64 = 128;
/// How far the quadratic may be off, root mean square over the spread of the measure.
const OFF: f64 = 0.05;
/// Share of the curvature in the variance up to which correlated variables count as normal ones: the standard deviation is then off by
/// some 0.1 %.
const CURVED: f64 = 1e-3;
/// The most variables that go into a matrix; beyond, moments are drawn.
const MOST_INTERACTING: usize = 256;

/// Of every measure, drawn where the quadratic does not describe it; `around` is expanded around `means`.
pub fn moments(model: &Model, around: &Expansion, means: &[f64], deviations: &[f64]) -> Vec<Moments> {
    let basis = Basis::new(model, around, means, deviations);
    let witnesses = units(model, WITNESSES);
    let witnessed = evaluate(model, &witnesses);
    let measure = |i: usize| {
        let quadratic = Quadratic::new(&basis, around, i);
        let error = |unit: usize| witnessed[unit][i] - around.values[i] - quadratic.at(&basis, &witnesses[unit], means);
        let square = (0..witnesses.len()).map(|unit| error(unit) * error(unit)).sum::<f64>() / WITNESSES as f64;
        let [_, spread] = of_values(witnessed.iter().map(|unit| unit[i])).0;
        // What varies by rounding alone is described well enough.
        let least = 1e-12 * around.values[i].abs();
        let described = witnesses.is_empty() || libm::sqrt(square) <= (OFF * spread).max(least);
        let (cumulants, [linear, curved]) = quadratic.cumulants(&basis, deviations);
        let shape = Shape::of_cumulants(&cumulants);
        let [shift, variance] = [cumulants[0], cumulants[1]];
        let found = Moments {
            mean: around.values[i] + shift,
            shift,
            deviation: libm::sqrt(variance),
            skewness: shape.skewness(),
            kurtosis: shape.kurtosis(),
            shape,
            curved: if variance > 0.0 { curved.max((variance - linear).abs()) / variance } else { 0.0 },
            described,
        };
        let known = if !described || basis.left_out[i] {
            Known::Nothing
        } else if quadratic.curves_mixing(&basis) && curved > CURVED * variance {
            Known::Mean
        } else if quadratic.mixes(&basis) {
            Known::Spread
        } else {
            Known::All
        };
        (found, known, linear)
    };
    let mut measures: Vec<(Moments, Known, f64)> = (0..model.measures.len()).map(measure).collect();
    if measures.iter().any(|(_, known, _)| *known != Known::All) {
        let values = measures_of(model, DRAWN);
        let unknown = measures.iter_mut().enumerate().filter(|(_, (_, known, _))| *known != Known::All);
        for (i, (found, known, linear)) in unknown {
            let ([mean, deviation], shape) = of_values(values.iter().map(|unit| unit[i]));
            if *known == Known::Nothing {
                *found = Moments { mean, shift: mean - around.values[i], ..*found };
            }
            if matches!(known, Known::Nothing | Known::Mean) {
                let off = if deviation > 0.0 { (1.0 - *linear / (deviation * deviation)).abs() } else { 0.0 };
                *found = Moments { deviation, curved: found.curved.max(off), ..*found };
            }
            *found = Moments { skewness: shape.skewness(), kurtosis: shape.kurtosis(), shape, ..*found };
        }
    }
    measures.into_iter().map(|(found, ..)| found).collect()
}

/// What a quadratic knows of a measure.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Known {
    All,
    /// Mean and standard deviation: variables that are not normal are correlated.
    Spread,
    /// The mean: along such variables it curves, so that its variance depends on their fourth moments.
    Mean,
    Nothing,
}

/// What all measures have in common.
struct Basis {
    /// Variables that go into a matrix, ascending.
    block: Vec<usize>,
    /// Place in the block of every variable.
    place: Vec<Option<usize>>,
    /// Mixed derivatives, by places in the block.
    mixed: Vec<(usize, usize, Vec<f64>)>,
    /// Measures whose mixed derivatives were left out, because there would be too many.
    left_out: Vec<bool>,
    /// The Cholesky factor of the correlations in the block, if there are any.
    factor: Option<DMatrix<f64>>,
    /// Contributors that are not normal, and correlated with nothing.
    groups: Vec<Group>,
    /// Whether a variable is of such a group.
    grouped: Vec<bool>,
    /// Correlated variables that are not normal.
    mixing: Vec<usize>,
}

impl Basis {
    fn new(model: &Model, around: &Expansion, means: &[f64], deviations: &[f64]) -> Self {
        let offsets = model.offsets();
        let (interacting, concerned) = interacting(model, around, means, deviations);
        let too_many = interacting.len() > MOST_INTERACTING;
        let left_out = concerned.into_iter().map(|concerned| concerned && too_many).collect();
        let mut is_correlated = vec![false; model.contributors.len()];
        for (one, other, _) in &model.correlations {
            is_correlated[*one] = true;
            is_correlated[*other] = true;
        }
        let correlated: Vec<usize> = (0..offsets.len()).filter(|i| is_correlated[*i]).map(|i| offsets[i]).collect();
        let mut block = if too_many { Vec::new() } else { interacting };
        block.extend(&correlated);
        block.sort_unstable();
        block.dedup();
        let mut place = vec![None; means.len()];
        block.iter().enumerate().for_each(|(n, k)| place[*k] = Some(n));
        let mixed = if too_many { Vec::new() } else { mixed(model, means, deviations, &block) };
        let within = |k: usize| place[k].unwrap_or(0);
        let mixed = mixed.into_iter().map(|(j, k, derivatives)| (within(j), within(k), derivatives)).collect();
        let mut factor = None;
        if !correlated.is_empty() {
            let mut matrix = DMatrix::identity(block.len(), block.len());
            for (one, other, coefficient) in model.correlation().pairs() {
                let (j, k) = (within(*one), within(*other));
                matrix[(j, k)] = *coefficient;
                matrix[(k, j)] = *coefficient;
            }
            factor = matrix.cholesky().map(|factor| factor.l());
        }
        let mut grouped = vec![false; means.len()];
        let alone = |i: &usize| !is_correlated[*i];
        let groups: Vec<Group> = (0..offsets.len())
            .filter(alone)
            .filter_map(|i| Group::new(&model.contributors[i].variation, offsets[i], means))
            .collect();
        groups.iter().for_each(|group| grouped[group.at..group.at + group.count].fill(true));
        let mixing = (0..offsets.len()).filter(|i| is_correlated[*i] && !is_normal(&model.contributors[*i].variation));
        let mixing = mixing.map(|i| offsets[i]).collect();
        Self { block, place, mixed, left_out, factor, groups, grouped, mixing }
    }
}

/// Slopes and curvatures of one measure.
struct Quadratic<'a> {
    slopes: &'a [f64],
    curvatures: &'a [f64],
    /// Second derivatives in the block.
    hessian: DMatrix<f64>,
}

impl<'a> Quadratic<'a> {
    fn new(basis: &Basis, around: &'a Expansion, i: usize) -> Self {
        let (slopes, curvatures) = (&around.slopes[i], &around.curvatures[i]);
        let diagonal = DVector::from_iterator(basis.block.len(), basis.block.iter().map(|k| curvatures[*k]));
        let mut hessian = DMatrix::from_diagonal(&diagonal);
        for (j, k, derivatives) in &basis.mixed {
            hessian[(*j, *k)] = derivatives[i];
            hessian[(*k, *j)] = derivatives[i];
        }
        Self { slopes, curvatures, hessian }
    }

    /// What it adds to the value at the `means`.
    fn at(&self, basis: &Basis, variables: &[f64], means: &[f64]) -> f64 {
        let apart = |k: usize| variables[k] - means[k];
        let own = |k: usize| {
            let curvature = if basis.place[k].is_some() { 0.0 } else { self.curvatures[k] };
            apart(k) * (self.slopes[k] + 0.5 * curvature * apart(k))
        };
        let x = DVector::from_iterator(basis.block.len(), basis.block.iter().map(|k| apart(*k)));
        (0..means.len()).map(own).sum::<f64>() + 0.5 * x.dot(&(&self.hessian * &x))
    }

    /// Whether it has a slope along correlated variables that are not normal.
    fn mixes(&self, basis: &Basis) -> bool {
        basis.mixing.iter().any(|k| self.slopes[*k] != 0.0)
    }

    /// Whether it curves along correlated variables that are not normal.
    fn curves_mixing(&self, basis: &Basis) -> bool {
        let places = basis.mixing.iter().filter_map(|k| basis.place[*k]);
        places.into_iter().any(|m| self.hessian.row(m).iter().any(|entry| *entry != 0.0))
    }

    /// Cumulants, and of the variance the part by slopes alone and that of curvature of normal variables.
    fn cumulants(&self, basis: &Basis, deviations: &[f64]) -> (Cumulants, [f64; 2]) {
        let mut cumulants = [0.0; ORDER];
        let (mut linear, mut curved) = (0.0, 0.0);
        for k in (0..deviations.len()).filter(|k| basis.place[*k].is_none()) {
            let (b, a) = (self.slopes[k] * deviations[k], self.curvatures[k] * deviations[k] * deviations[k]);
            linear += b * b;
            curved += 0.5 * a * a;
            if !basis.grouped[k] && (b != 0.0 || a != 0.0) {
                add(&mut cumulants, &of_one(b, a), 1.0);
            }
        }
        let (block, count) = (&basis.block, basis.block.len());
        let b = DVector::from_fn(count, |n, _| self.slopes[block[n]] * deviations[block[n]]);
        let a =
            DMatrix::from_fn(count, count, |m, n| self.hessian[(m, n)] * deviations[block[m]] * deviations[block[n]]);
        let (b, a) = match &basis.factor {
            Some(factor) => (factor.transpose() * b, factor.transpose() * a * factor),
            None => (b, a),
        };
        linear += b.norm_squared();
        curved += 0.5 * a.norm_squared();
        add(&mut cumulants, &gaussian(&b, &a), 1.0);
        let entry = |j: usize, k: usize| match (basis.place[j], basis.place[k]) {
            (Some(m), Some(n)) => self.hessian[(m, n)],
            _ if j == k => self.curvatures[k],
            _ => 0.0,
        };
        for group in &basis.groups {
            let own = group.at..group.at + group.count;
            if own.clone().all(|k| self.slopes[k] == 0.0 && self.curvatures[k] == 0.0 && basis.place[k].is_none()) {
                continue;
            }
            let hessian = |j: usize, k: usize| entry(group.at + j, group.at + k);
            add(&mut cumulants, &group.cumulants(&self.slopes[own.clone()], hessian), 1.0);
            // The block has taken its variables there for normal ones.
            let inside: Vec<usize> = own.filter_map(|k| basis.place[k]).collect();
            if !inside.is_empty() {
                let b = DVector::from_fn(inside.len(), |m, _| b[inside[m]]);
                let a = DMatrix::from_fn(inside.len(), inside.len(), |m, n| a[(inside[m], inside[n])]);
                add(&mut cumulants, &gaussian(&b, &a), -1.0);
            }
        }
        (cumulants, [linear, curved])
    }
}

#[cfg(test)]
mod tests {
    use super::of_measures;
    use crate::{
        examples::{linear, normal, scalar},
        model::{Distribution, Function},
        numeric::lanes::Lanes,
    };

    /// The square of the first variable, and that with the second added.
    struct Squares;

    impl Function for Squares {
        fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
            let [x, y] = [variables[0], variables[1]];
            measures[0] = x * x;
            measures[1] = x * x + y;
        }
    }

    /// Of a rectangular x within ± 1 the variance of x² is 4/45, not 2σ⁴ = 10/45, also where x is correlated with something.
    #[test]
    fn curvature_along_a_correlated_variable_that_is_not_normal_is_right() {
        let x = scalar("x", Distribution::Uniform { limits: [-1.0, 1.0] }, [-1.0, 1.0]);
        let mut model = linear(vec![x, normal("y", 0.0, 0.3)], vec![vec![0.0, 1.0]; 2]);
        model.function = std::sync::Arc::new(Squares);
        model.correlations = vec![(0, 1, 0.6)];
        let [square, sum] = &of_measures(&model)[..] else { panic!("two measures") };
        assert!((square.mean - 1.0 / 3.0).abs() < 1e-9, "{square:?}");
        assert!((square.deviation / libm::sqrt(4.0 / 45.0) - 1.0).abs() < 2e-3, "{square:?}");
        assert!((sum.deviation / libm::sqrt(4.0 / 45.0 + 0.01) - 1.0).abs() < 2e-3, "{sum:?}");
    }

    /// x and 0.02·x².
    struct Bent;

    impl Function for Bent {
        fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
            measures[0] = variables[0] + variables[0] * variables[0] * Lanes::splat(0.02);
        }
    }

    /// x is 10 with a probability of 1 %, else 0: the variance is that of 10 + 0.02·10², by the slope in the mean that of 10·1.004.
    #[test]
    fn a_bend_counts_that_a_rare_lot_far_away_feels() {
        let lot = |at: f64| Distribution::Uniform { limits: [at - 1e-4, at + 1e-4] };
        let x = Distribution::Mixture(vec![(0.99, lot(0.0)), (0.01, lot(10.0))]);
        let mut model = linear(vec![scalar("x", x, [-1.0, 11.0])], vec![vec![1.0]]);
        model.function = std::sync::Arc::new(Bent);
        let found = of_measures(&model)[0];
        let off = 1.0 - (10.04 / 12.0) * (10.04 / 12.0);
        assert!((found.curved - off).abs() < 1e-3 && !found.by_slopes(), "{found:?}");
    }

    /// Ten times the dimensions take a hundred times the time, and no matrix.
    #[test]
    fn thousands_of_dimensions_have_moments() {
        let count = 5000;
        let contributors = (0..count).map(|_| normal("x", 1.0, 3e-3)).collect();
        let model = linear(contributors, vec![vec![1.0; count]]);
        let found = of_measures(&model)[0];
        assert!((found.deviation / (1e-3 * libm::sqrt(count as f64)) - 1.0).abs() < 1e-6, "{found:?}");
        assert!((found.kurtosis - 3.0).abs() < 1e-6 && found.described && found.curved < 1e-9);
    }
}
