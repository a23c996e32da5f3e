//! Moments of measures that bend, by quadrature over all their variables: where these are few, as good as exact.
//!
//! Every variable has the Gauss rule of its own distribution, from the recurrence of its orthogonal polynomials
//! (Stieltjes' procedure) and the eigenvalues of their Jacobi matrix: Golub and Welsch, "Calculation of Gauss quadrature
//! rules", Math. Comp. 23 (1969).

use nalgebra::DMatrix;

use super::derivative::evaluate;
use crate::model::{Distribution, Model, Variation, ZoneRule};
use crate::{
    distribution::quadrature::nodes,
    model::{SIGMA_DISC, SIGMA_ZONE},
    numeric::gauss::Node,
};

/// Points a variable; the rule is exact for polynomials of degree 17.
const POINTS: usize = 9;
/// Points of the rule that it is compared with.
const FEWER: usize = 7;
/// The most variables: 59,049 evaluations.
const MOST_VARIABLES: usize = 5;
/// How far both rules may lie apart, in standard deviations: beyond, a measure has a kink that no polynomial follows.
const AGREEMENT: f64 = 1e-6;

/// Moments of one measure (SI).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exact {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
    /// Skewness.
    pub skewness: f64,
    /// Kurtosis; 3 for a normal.
    pub kurtosis: f64,
}

/// Of every measure, good to a millionth of its standard deviation; `None` where that cannot be had: more than five
/// variables, variables that depend on each other, a measure with a kink or without a value at one of the points.
pub fn of_measures(model: &Model) -> Vec<Option<Exact>> {
    let nothing = || vec![None; model.measures.len()];
    if model.variables() > MOST_VARIABLES || !model.correlations.is_empty() {
        return nothing();
    }
    let rules =
        |points| model.contributors.iter().map(|c| of_variables(&c.variation, points)).collect::<Option<Vec<_>>>();
    let Some((rules, fewer)) = rules(POINTS).zip(rules(FEWER)) else { return nothing() };
    let [found, coarser] = [rules, fewer].map(|rules| moments(model, &rules.concat()));
    let checked = |(found, coarser): (Exact, Exact)| {
        let apart = (found.mean - coarser.mean).abs().max((found.deviation - coarser.deviation).abs());
        (apart <= AGREEMENT * found.deviation).then_some(found)
    };
    found.into_iter().zip(coarser).map(checked).collect()
}

/// A point of a Gauss rule and its weight; the weights of a rule add up to 1.
#[derive(Clone, Copy)]
struct Point {
    at: f64,
    weight: f64,
}

/// Rules of the variables of a contributor, if they are independent of each other.
fn of_variables(variation: &Variation, points: usize) -> Option<Vec<Vec<Point>>> {
    let of_normal = |deviation| {
        let normal = Distribution::Normal { mean: 0.0, deviation };
        rule(&nodes(&Variation::Scalar { distribution: normal, limits: [0.0; 2] }), points)
    };
    match variation {
        Variation::Scalar { .. } | Variation::Zone(ZoneRule::Translation) => {
            Some(vec![rule(&nodes(variation), points)])
        }
        Variation::Zone(ZoneRule::SigmaZone) => Some(vec![of_normal(SIGMA_ZONE); 3]),
        Variation::Disc(ZoneRule::SigmaZone | ZoneRule::Translation) => Some(vec![of_normal(SIGMA_DISC); 2]),
        Variation::Nested(zone) if zone.is_normal() => {
            let [place, tilts] = zone.deviations();
            let mut rules = vec![of_normal(place); zone.places()];
            rules.extend(vec![of_normal(tilts); 2]);
            Some(rules)
        }
        Variation::Nested(_)
        | Variation::Zone(ZoneRule::Truncated | ZoneRule::UniformInZone)
        | Variation::Disc(ZoneRule::Truncated | ZoneRule::UniformInZone) => None,
    }
}

/// The Gauss rule for the distribution that `nodes` stand for.
fn rule(nodes: &[Node], count: usize) -> Vec<Point> {
    let average = |of: &dyn Fn(usize) -> f64| (0..nodes.len()).map(|i| nodes[i].weight * of(i)).sum::<f64>();
    let mean = average(&|i| nodes[i].at[0]);
    let deviation = libm::sqrt(average(&|i| (nodes[i].at[0] - mean) * (nodes[i].at[0] - mean)));
    if deviation == 0.0 {
        return vec![Point { at: mean, weight: 1.0 }];
    }
    let x: Vec<f64> = nodes.iter().map(|node| (node.at[0] - mean) / deviation).collect();
    // Two successive polynomials of norm 1, by their values at the nodes.
    let (mut before, mut current) = (vec![0.0; x.len()], vec![1.0; x.len()]);
    let mut jacobi = DMatrix::zeros(count, count);
    let mut beta = 0.0;
    for k in 0..count {
        let alpha = average(&|i| x[i] * current[i] * current[i]);
        jacobi[(k, k)] = alpha;
        if k + 1 < count {
            let mut next: Vec<f64> = (0..x.len()).map(|i| (x[i] - alpha) * current[i] - beta * before[i]).collect();
            beta = libm::sqrt(average(&|i| next[i] * next[i]));
            next.iter_mut().for_each(|value| *value /= beta);
            jacobi[(k, k + 1)] = beta;
            jacobi[(k + 1, k)] = beta;
            (before, current) = (current, next);
        }
    }
    let eigen = jacobi.symmetric_eigen();
    let first = eigen.eigenvectors.row(0);
    let point = |(x, v): (&f64, &f64)| Point { at: mean + deviation * x, weight: v * v };
    eigen.eigenvalues.iter().zip(first.iter()).map(point).collect()
}

/// Of every measure, by the product of `rules`.
fn moments(model: &Model, rules: &[Vec<Point>]) -> Vec<Exact> {
    let count = rules.iter().map(Vec::len).product();
    let (mut places, mut weights) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for mut number in 0..count {
        let chosen = rules.iter().map(|rule| {
            let point = rule[number % rule.len()];
            number /= rule.len();
            point
        });
        let chosen: Vec<Point> = chosen.collect();
        places.push(chosen.iter().map(|point| point.at).collect());
        weights.push(chosen.iter().map(|point| point.weight).product::<f64>());
    }
    let values = evaluate(model, &places);
    let measure = |i: usize| {
        let average = |of: &dyn Fn(f64) -> f64| weights.iter().zip(&values).map(|(w, v)| w * of(v[i])).sum::<f64>();
        let mean = average(&|x| x);
        let [second, third, fourth] = [2, 3, 4].map(|power| average(&|x| libm::pow(x - mean, f64::from(power))));
        let deviation = libm::sqrt(second);
        Exact { mean, deviation, skewness: third / (second * deviation), kurtosis: fourth / (second * second) }
    };
    (0..model.measures.len()).map(measure).collect()
}

#[cfg(test)]
mod tests {
    use super::{Exact, of_measures, rule};
    use crate::{
        distribution::quadrature::nodes,
        examples::{clutch, linear, normal, rectangulars, scalar},
        model::{Contributor, Distribution, Function, Model, Variation, ZoneRule},
        numeric::lanes::Lanes,
    };

    struct Of(fn(f64) -> f64);

    impl Function for Of {
        fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
            measures[0] = variables[0].map(self.0);
        }
    }

    fn of_normal(function: fn(f64) -> f64) -> Option<Exact> {
        let mut model = linear(vec![normal("x", 0.0, 3.0)], vec![vec![1.0]]);
        model.function = std::sync::Arc::new(Of(function));
        of_measures(&model)[0]
    }

    fn close(found: f64, expected: f64, bound: f64) {
        assert!((found - expected).abs() <= bound, "{found}, not {expected}");
    }

    #[test]
    fn rules_are_those_of_the_classical_polynomials() {
        // Hermite and Legendre rules of three points.
        let normal = Distribution::Normal { mean: 1.0, deviation: 2.0 };
        let uniform = Distribution::Uniform { limits: [0.0, 2.0] };
        for (distribution, [reach, middle, outer]) in [
            (normal, [2.0 * libm::sqrt(3.0), 2.0 / 3.0, 1.0 / 6.0]),
            (uniform, [libm::sqrt(0.6), 8.0 / 18.0, 5.0 / 18.0]),
        ] {
            let mut points = rule(&nodes(&Variation::Scalar { distribution, limits: [0.0, 1.0] }), 3);
            points.sort_by(|one, other| one.at.total_cmp(&other.at));
            for (point, [at, weight]) in points.iter().zip([[1.0 - reach, outer], [1.0, middle], [1.0 + reach, outer]])
            {
                close(point.at, at, 1e-12);
                close(point.weight, weight, 1e-12);
            }
        }
    }

    #[test]
    fn one_way_clutch() {
        let phi = of_measures(&clutch())[0].unwrap();
        close(phi.mean.to_degrees(), 7.014_956, 5e-7);
        close(phi.deviation.to_degrees(), 0.219_670, 5e-7);
        close(phi.skewness, -0.094_39, 5e-6);
        close(phi.kurtosis, 3.023_9, 5e-5);
    }

    #[test]
    fn moments_in_closed_form() {
        // The square of a standard normal; e to the power of a quarter of one: log-normal with σ = 1/4.
        let square = of_normal(|x| x * x).unwrap();
        for (found, expected) in [(square.mean, 1.0), (square.deviation, libm::sqrt(2.0)), (square.kurtosis, 15.0)] {
            close(found, expected, 1e-9);
        }
        close(square.skewness, libm::sqrt(8.0), 1e-9);
        let exponential = of_normal(|x| libm::exp(x / 4.0)).unwrap();
        let growth = libm::exp(1.0 / 16.0);
        close(exponential.mean, libm::sqrt(growth), 1e-9);
        close(exponential.deviation, libm::sqrt(growth * (growth - 1.0)), 1e-9);
        close(exponential.skewness, (growth + 2.0) * libm::sqrt(growth - 1.0), 1e-6);
        // The kurtosis of a sum of n equal rectangulars is 3 − 1.2/n.
        close(of_measures(&rectangulars(&[1.0; 4]))[0].unwrap().kurtosis, 2.7, 1e-9);
    }

    #[test]
    fn gives_nothing_where_it_would_be_wrong() {
        assert_eq!(of_normal(f64::abs), None);
        assert_eq!(of_normal(libm::sqrt), None);
        assert_eq!(of_measures(&rectangulars(&[1.0; 6])), [None]);
        let mut correlated = linear(vec![normal("x", 0.0, 3.0), normal("y", 0.0, 3.0)], vec![vec![1.0, 1.0]]);
        correlated.correlations = vec![(0, 1, 0.5)];
        assert_eq!(of_measures(&correlated), [None]);
        let zone = |rule| Contributor { name: "face".into(), variation: Variation::Zone(rule) };
        let of_face = |rule| -> Model { linear(vec![zone(rule)], vec![vec![1.0; 3]]) };
        assert_eq!(of_measures(&of_face(ZoneRule::Truncated)), [None]);
        close(of_measures(&of_face(ZoneRule::SigmaZone))[0].unwrap().deviation, 1.0 / 3.0, 1e-12);
        let constant = linear(vec![scalar("x", Distribution::Constant(2.0), [2.0, 2.0])], vec![vec![3.0]]);
        close(of_measures(&constant)[0].unwrap().mean, 6.0, 1e-12);
    }
}
