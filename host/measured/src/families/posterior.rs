//! What a sample leaves open of a distribution within its family.

use slipfit_core::sampling::{
    normal::score,
    stream::{Rng, Xoshiro256PlusPlus, unit_stream},
};
use slipfit_tolerance::numeric::normal::SIDE;

use super::{
    family::Family, fit::Fit, johnson_sb::JohnsonSb, johnson_su::JohnsonSu, kind::Kind, lognormal::Lognormal,
    mixture::TwoNormals, normal::Normal, sample::Sample, weibull::Weibull,
};

/// Distributions drawn.
const DRAWS: usize = 4000;
/// Of the sum of equal weights, the part below which the draws do not stand for the posterior.
const LEAST_EFFECTIVE: f64 = 200.0;
/// Parts from which on the likelihood is close enough to a normal one to take draws as they are.
const MANY: usize = 1000;
/// Degrees of freedom of the drawn Student's t: its tails enclose those of the likelihood.
const FREEDOM: usize = 5;
/// Relative weight of families that are left out.
const NEGLIGIBLE: f64 = 1e-3;
const SEED: u64 = 0x5eed;

/// Distributions of a family, drawn with the probability that a sample leaves them.
///
/// The prior is flat in places and logarithms of scales, with which the intervals of a normal, a lognormal or a Weibull
/// distribution's quantiles hold in exactly 95 %. Draws are of Student's t around the likeliest one, weighted by the
/// likelihood.
#[derive(Debug)]
pub struct Posterior {
    draws: Vec<(f64, Box<dyn Family>)>,
}

impl Posterior {
    /// Of a `fit` to `values`; `None` if the likelihood is too far from a normal one to draw from.
    pub fn new(fit: &Fit, values: &[f64]) -> Option<Self> {
        let sample = Sample::new(values).ok()?;
        let frame = Frame { kind: fit.kind, least: sample.least(), greatest: sample.greatest() };
        let middle = frame.free(fit.family.as_ref());
        let cost = |free: &[f64]| -frame.family(free).ln_likelihood(&sample.sorted);
        let units = frame.units(sample.deviation);
        let root = inverse_root(&hessian(&middle, &units, &cost)?)?;
        let lowest = cost(&middle);
        let mut stream = unit_stream(SEED, 0);
        let mut draws: Vec<(f64, Box<dyn Family>)> = Vec::with_capacity(DRAWS);
        let is_many = sample.sorted.len() > MANY;
        let size = middle.len() as f64;
        for _ in 0..DRAWS {
            let scores: Vec<f64> = middle.iter().map(|_| draw(&mut stream)).collect();
            let length: f64 = scores.iter().map(|z| z * z).sum();
            let chi: f64 = (0..FREEDOM).map(|_| draw(&mut stream)).map(|z| z * z).sum();
            let stretch = if is_many { 1.0 } else { libm::sqrt(FREEDOM as f64 / chi) };
            let free: Vec<f64> = (root.iter().zip(&middle))
                .map(|(row, middle)| middle + stretch * row.iter().zip(&scores).map(|(a, z)| a * z).sum::<f64>())
                .collect();
            let weight = if is_many {
                1.0
            } else {
                // The density of Student's t up to a constant factor.
                let inside = 1.0 + stretch * stretch * length / FREEDOM as f64;
                libm::exp(lowest - cost(&free) + 0.5 * (FREEDOM as f64 + size) * libm::log(inside))
            };
            if weight > 0.0 && weight.is_finite() {
                draws.push((weight, frame.family(&free)));
            }
        }
        let [sum, squares] =
            draws.iter().fold([0.0; 2], |[sum, squares], (weight, _)| [sum + weight, squares + weight * weight]);
        (sum * sum / squares >= LEAST_EFFECTIVE).then_some(Self { draws })
    }

    /// Of several fits to the same `values`: each family counts as much as its information criterion says, exp(−½·AICc) of
    /// H. Akaike's weights, so that not knowing the family widens intervals too. `None` if none of the fits has one.
    pub fn averaged(fits: &[Fit], values: &[f64]) -> Option<Self> {
        let lowest = fits.iter().map(|fit| fit.aicc).fold(f64::INFINITY, f64::min);
        let mut draws = Vec::new();
        for fit in fits {
            let share = libm::exp(0.5 * (lowest - fit.aicc));
            if share < NEGLIGIBLE {
                continue;
            }
            let Some(of_fit) = Self::new(fit, values) else { continue };
            let sum: f64 = of_fit.draws.iter().map(|(weight, _)| weight).sum();
            draws.extend(of_fit.draws.into_iter().map(|(weight, family)| (weight / sum * share, family)));
        }
        (!draws.is_empty()).then_some(Self { draws })
    }

    /// The drawn distributions, each with its weight.
    pub fn draws(&self) -> impl Iterator<Item = (f64, &dyn Family)> {
        self.draws.iter().map(|(weight, family)| (*weight, family.as_ref()))
    }

    /// The interval of 95 % of a `figure` of the distribution.
    pub fn interval(&self, figure: impl Fn(&dyn Family) -> f64) -> [f64; 2] {
        let mut figures: Vec<(f64, f64)> =
            self.draws.iter().map(|(weight, family)| (figure(family.as_ref()), *weight)).collect();
        figures.sort_by(|a, b| a.0.total_cmp(&b.0));
        let sum: f64 = figures.iter().map(|(_, weight)| weight).sum();
        [SIDE, 1.0 - SIDE].map(|wanted| {
            let mut below = 0.0;
            let at = figures.iter().find(|(_, weight)| {
                below += weight;
                below >= wanted * sum
            });
            at.or(figures.last()).map_or(f64::NAN, |(figure, _)| *figure)
        })
    }
}

fn draw(stream: &mut Xoshiro256PlusPlus) -> f64 {
    score(stream.next_u64())
}

/// Parameters of a family without bounds: places as they are, logarithms of scales and of an end's distance from the
/// values.
struct Frame {
    kind: Kind,
    least: f64,
    greatest: f64,
}

impl Frame {
    /// The free parameters of a distribution.
    fn free(&self, family: &dyn Family) -> Vec<f64> {
        let parameters: Vec<f64> = family.parameters().into_iter().map(|(_, value)| value).collect();
        let ln = libm::log;
        match (self.kind, parameters.as_slice()) {
            (Kind::Normal, [mean, sd]) => vec![*mean, ln(*sd)],
            (Kind::Lognormal, [_, mean, sd]) => vec![*mean, ln(*sd)],
            (Kind::Weibull, [_, scale, shape]) => vec![ln(*scale), ln(*shape)],
            (Kind::ShiftedLognormal, [shift, mean, sd]) => vec![ln(self.least - shift), *mean, ln(*sd)],
            (Kind::ShiftedWeibull, [shift, scale, shape]) => vec![ln(self.least - shift), ln(*scale), ln(*shape)],
            (Kind::JohnsonSu, [gamma, delta, xi, lambda]) => vec![*gamma, ln(*delta), *xi, ln(*lambda)],
            (Kind::JohnsonSb, [gamma, delta, xi, lambda]) => {
                vec![*gamma, ln(*delta), ln(self.least - xi), ln(xi + lambda - self.greatest)]
            }
            (Kind::TwoNormals, [share, mean_1, sd_1, mean_2, sd_2]) => {
                vec![ln(share / (1.0 - share)), *mean_1, ln(*sd_1), *mean_2, ln(*sd_2)]
            }
            _ => Vec::new(),
        }
    }

    /// A first step of each of them, for values of a standard deviation.
    fn units(&self, deviation: f64) -> Vec<f64> {
        match self.kind {
            Kind::Normal => vec![deviation, 1.0],
            Kind::JohnsonSu => vec![1.0, 1.0, deviation, 1.0],
            Kind::TwoNormals => vec![1.0, deviation, 1.0, deviation, 1.0],
            kind => vec![1.0; kind.parameters()],
        }
    }

    /// The distribution of free parameters.
    fn family(&self, free: &[f64]) -> Box<dyn Family> {
        let exp = libm::exp;
        let lognormal = |shift, mean, ln_sd| Lognormal { shift, mean, deviation: exp(ln_sd) };
        let weibull = |shift, ln_scale, ln_shape| Weibull { shift, scale: exp(ln_scale), shape: exp(ln_shape) };
        match (self.kind, free) {
            (Kind::Lognormal, &[mean, sd]) => Box::new(lognormal(0.0, mean, sd)),
            (Kind::Weibull, &[scale, shape]) => Box::new(weibull(0.0, scale, shape)),
            (Kind::ShiftedLognormal, &[off, mean, sd]) => Box::new(lognormal(self.least - exp(off), mean, sd)),
            (Kind::ShiftedWeibull, &[off, scale, shape]) => Box::new(weibull(self.least - exp(off), scale, shape)),
            (Kind::JohnsonSu, &[gamma, delta, xi, lambda]) => {
                Box::new(JohnsonSu { gamma, delta: exp(delta), xi, lambda: exp(lambda) })
            }
            (Kind::JohnsonSb, &[gamma, delta, below, above]) => {
                let xi = self.least - exp(below);
                Box::new(JohnsonSb { gamma, delta: exp(delta), xi, lambda: self.greatest + exp(above) - xi })
            }
            (Kind::TwoNormals, &[odds, mean_1, sd_1, mean_2, sd_2]) => {
                let normal = |mean, sd| Normal { mean, deviation: exp(sd) };
                let share = 1.0 / (1.0 + exp(-odds));
                Box::new(TwoNormals { share, parts: [normal(mean_1, sd_1), normal(mean_2, sd_2)] })
            }
            (_, free) => {
                let at = |i: usize| free.get(i).copied().unwrap_or_default();
                Box::new(Normal { mean: at(0), deviation: exp(at(1)) })
            }
        }
    }
}

/// Second derivatives of a cost at its lowest point, by differences over a tenth of the width that the first estimate shows.
fn hessian(middle: &[f64], units: &[f64], cost: &impl Fn(&[f64]) -> f64) -> Option<Vec<Vec<f64>>> {
    let n = middle.len();
    let at = |moves: &[(usize, f64)]| {
        let mut point = middle.to_vec();
        moves.iter().for_each(|(i, by)| point[*i] += by);
        cost(&point)
    };
    let lowest = at(&[]);
    let second = |i: usize, step: f64| (at(&[(i, step)]) + at(&[(i, -step)]) - 2.0 * lowest) / (step * step);
    let mut steps = Vec::new();
    for (i, unit) in units.iter().enumerate() {
        let curvature = second(i, 1e-3 * unit);
        if !(curvature > 0.0 && curvature.is_finite()) {
            return None;
        }
        steps.push(0.1 / libm::sqrt(curvature));
    }
    let mut matrix = vec![vec![0.0; n]; n];
    for i in 0..n {
        matrix[i][i] = second(i, steps[i]);
        for j in 0..i {
            let corner = |a: f64, b: f64| at(&[(i, a * steps[i]), (j, b * steps[j])]);
            let mixed = (corner(1.0, 1.0) - corner(1.0, -1.0) - corner(-1.0, 1.0) + corner(-1.0, -1.0))
                / (4.0 * steps[i] * steps[j]);
            (matrix[i][j], matrix[j][i]) = (mixed, mixed);
        }
    }
    Some(matrix)
}

/// A matrix R with R·Rᵀ the inverse of a positive definite one; `None` of another.
fn inverse_root(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let n = matrix.len();
    // Cholesky's factor L.
    let mut lower = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let rest = matrix[i][j] - (0..j).map(|k| lower[i][k] * lower[j][k]).sum::<f64>();
            if i == j {
                // Directions that the sample hardly tells anything of are as good as not determined.
                if rest.is_nan() || rest <= 1e-9 * matrix[i][i] {
                    return None;
                }
                lower[i][i] = libm::sqrt(rest);
            } else {
                lower[i][j] = rest / lower[j][j];
            }
        }
    }
    // The transpose of its inverse.
    let mut root = vec![vec![0.0; n]; n];
    for (column, into) in root.iter_mut().enumerate() {
        let mut solved = vec![0.0; n];
        for i in column..n {
            let unit = if i == column { 1.0 } else { 0.0 };
            solved[i] = (unit - (column..i).map(|k| lower[i][k] * solved[k]).sum::<f64>()) / lower[i][i];
        }
        *into = solved;
    }
    Some(root)
}
