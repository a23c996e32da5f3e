//! Slopes and curvatures of the measures by central differences of fourth order.

use slipfit_core::sampling::stream::mix;

use crate::{
    model::Model,
    numeric::lanes::{LANES, Lanes},
};

/// Distance of the inner points (standard deviations of a variable): where cutting off and rounding are both small.
const STEP: f64 = 0.02;
/// The same for mixed derivatives, which divide by its square.
const MIXED_STEP: f64 = 0.05;
/// How much (standard deviations of a measure) the effect of half a deviation of a variable may change with the others.
const INTERACTION: f64 = 1e-6;
/// The same for rounding, in parts of the measure itself.
const ROUNDING: f64 = 1e-13;
/// Pairs whose mixed derivatives are found in one go.
const PAIRS: usize = 256;
/// Makes fractions from 0 to ½ of 53 bits.
const IRREGULAR: f64 = 0.5 / (1u64 << 53) as f64;

/// The measures around a point.
#[derive(Clone, Debug)]
pub struct Expansion {
    /// Measures at the point.
    pub values: Vec<f64>,
    /// ∂measure/∂variable, a row a measure.
    pub slopes: Vec<Vec<f64>>,
    /// ∂²measure/∂variable², a row a measure.
    pub curvatures: Vec<Vec<f64>>,
}

/// The measures at every point of `points`.
pub fn evaluate(model: &Model, points: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut variables = vec![Lanes::ZERO; model.variables()];
    let mut measures = vec![Lanes::ZERO; model.measures.len()];
    let mut values = Vec::with_capacity(points.len());
    for group in points.chunks(LANES) {
        for (k, variable) in variables.iter_mut().enumerate() {
            // Lanes without a point repeat the last.
            *variable = Lanes(std::array::from_fn(|lane| group[lane.min(group.len() - 1)][k]));
        }
        model.function.evaluate(&variables, &mut measures);
        values.extend((0..group.len()).map(|lane| measures.iter().map(|measure| measure.0[lane]).collect::<Vec<_>>()));
    }
    values
}

/// The measures where some variables of `centre` are moved, each of `moves` a point of its own.
fn moved(model: &Model, centre: &[f64], moves: &[Vec<(usize, f64)>]) -> Vec<Vec<f64>> {
    let mut variables: Vec<Lanes> = centre.iter().map(|x| Lanes::splat(*x)).collect();
    let mut measures = vec![Lanes::ZERO; model.measures.len()];
    let mut values = Vec::with_capacity(moves.len());
    for group in moves.chunks(LANES) {
        for (lane, moves) in group.iter().enumerate() {
            moves.iter().for_each(|(k, by)| variables[*k].0[lane] += by);
        }
        model.function.evaluate(&variables, &mut measures);
        values.extend((0..group.len()).map(|lane| measures.iter().map(|measure| measure.0[lane]).collect::<Vec<_>>()));
        for (k, _) in group.iter().flatten() {
            variables[*k] = Lanes::splat(centre[*k]);
        }
    }
    values
}

/// Around `centre`, for variables that spread by `deviations`; those that do not spread have no derivatives.
pub fn expansion(model: &Model, centre: &[f64], deviations: &[f64]) -> Expansion {
    let mut points = vec![Vec::new()];
    for (k, deviation) in deviations.iter().enumerate() {
        points.extend([-2.0, -1.0, 1.0, 2.0].map(|times| vec![(k, times * STEP * deviation)]));
    }
    let values = moved(model, centre, &points);
    let derivatives = |of: &dyn Fn(f64, [f64; 4], f64) -> f64| -> Vec<Vec<f64>> {
        let at = |i: usize, k: usize| {
            let step = STEP * deviations[k];
            if step > 0.0 { of(values[0][i], [1, 2, 3, 4].map(|j| values[4 * k + j][i]), step) } else { 0.0 }
        };
        (0..model.measures.len()).map(|i| (0..deviations.len()).map(|k| at(i, k)).collect()).collect()
    };
    Expansion {
        slopes: derivatives(&|_, [a, b, c, d], h| (8.0 * (c - b) - (d - a)) / (12.0 * h)),
        curvatures: derivatives(&|f, [a, b, c, d], h| (16.0 * (b + c) - (a + d) - 30.0 * f) / (12.0 * h * h)),
        values: values.into_iter().next().unwrap_or_default(),
    }
}

/// The variables whose effect on any measure depends on the others: each is moved once with the others at `centre`, once
/// with all of them moved in a fixed, irregular way. That takes three points a variable, where all pairs would take four
/// times their number squared. Beside them, which measures they do that to.
pub fn interacting(model: &Model, around: &Expansion, centre: &[f64], deviations: &[f64]) -> (Vec<usize>, Vec<bool>) {
    let irregular = |k: usize| (mix(k as u64) >> 11) as f64 * IRREGULAR + 0.25;
    let sign = |k: usize| if mix(!(k as u64)) & 1 == 0 { 1.0 } else { -1.0 };
    let elsewhere: Vec<f64> = (0..centre.len()).map(|k| centre[k] + sign(k) * irregular(k) * deviations[k]).collect();
    // Smaller effects than this do not show in a variance.
    let spread = |slopes: &Vec<f64>| {
        libm::sqrt(slopes.iter().zip(deviations).map(|(slope, deviation)| slope * slope * deviation * deviation).sum())
    };
    let least: Vec<f64> = around.slopes.iter().map(|slopes| INTERACTION * spread(slopes)).collect();
    let varying: Vec<usize> = (0..centre.len()).filter(|k| deviations[*k] > 0.0).collect();
    let here = moved(model, centre, &varying.iter().map(|k| vec![(*k, 0.5 * deviations[*k])]).collect::<Vec<_>>());
    let there = varying.iter().flat_map(|k| {
        let back = centre[*k] - elsewhere[*k];
        [vec![(*k, back)], vec![(*k, back + 0.5 * deviations[*k])]]
    });
    let there = moved(model, &elsewhere, &there.collect::<Vec<_>>());
    let interacts = |n: usize, i: usize| {
        let change = (there[2 * n + 1][i] - there[2 * n][i]) - (here[n][i] - around.values[i]);
        // What cannot be computed is no sign of independence.
        change.is_nan() || change.abs() > least[i].max(ROUNDING * around.values[i].abs())
    };
    let measures = 0..around.values.len();
    let with_others = |n: &usize| measures.clone().any(|i| interacts(*n, i));
    let found: Vec<usize> = (0..varying.len()).filter(with_others).collect();
    let concerned = measures.clone().map(|i| found.iter().any(|n| interacts(*n, i))).collect();
    (found.into_iter().map(|n| varying[n]).collect(), concerned)
}

/// Two variables and their steps.
type Pair = (usize, usize, [f64; 2]);

/// ∂²measure/∂j∂k for all j < k `among` the variables, as (j, k, one a measure); around the same point.
pub fn mixed(model: &Model, centre: &[f64], deviations: &[f64], among: &[usize]) -> Vec<(usize, usize, Vec<f64>)> {
    let pairs = among.iter().enumerate().flat_map(|(n, k)| among[..n].iter().map(move |j| (*j, *k)));
    let pairs: Vec<_> = pairs.map(|(j, k)| (j, k, [j, k].map(|k| MIXED_STEP * deviations[k]))).collect();
    let corners = |(j, k, [a, b]): &Pair| {
        [1.0, 2.0].map(|times| {
            [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]]
                .map(|[s, t]: [f64; 2]| vec![(*j, s * times * a), (*k, t * times * b)])
        })
    };
    let derivatives = |pairs: &[Pair]| {
        let points: Vec<_> = pairs.iter().flat_map(|pair| corners(pair).into_iter().flatten()).collect();
        let values = moved(model, centre, &points);
        let of = |(pair, values): (&Pair, &[Vec<f64>])| {
            let (j, k, [a, b]) = *pair;
            let derivative = |i: usize| {
                let difference = |from: usize, times: f64| {
                    let [pp, pm, mp, mm] = [0, 1, 2, 3].map(|corner| values[from + corner][i]);
                    (pp - pm - mp + mm) / (4.0 * times * times * a * b)
                };
                // The wider one has four times the error.
                (4.0 * difference(0, 1.0) - difference(4, 2.0)) / 3.0
            };
            (j, k, (0..model.measures.len()).map(derivative).collect())
        };
        pairs.iter().zip(values.chunks(8)).map(of).collect::<Vec<_>>()
    };
    pairs.chunks(PAIRS).flat_map(derivatives).collect()
}
