//! Slopes and curvatures of the measures by central differences of fourth order.

use super::{
    lanes::{LANES, Lanes},
    model::Model,
};

/// Distance of the inner points (standard deviations of a variable): where cutting off and rounding are both small.
const STEP: f64 = 0.02;
/// The same for mixed derivatives, which divide by its square.
const MIXED_STEP: f64 = 0.05;

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

fn moved(centre: &[f64], moves: &[(usize, f64)]) -> Vec<f64> {
    let mut point = centre.to_vec();
    moves.iter().for_each(|(k, by)| point[*k] += by);
    point
}

/// Around `centre`, for variables that spread by `deviations`; those that do not spread have no derivatives.
pub fn expansion(model: &Model, centre: &[f64], deviations: &[f64]) -> Expansion {
    let mut points = vec![centre.to_vec()];
    for (k, deviation) in deviations.iter().enumerate() {
        points.extend([-2.0, -1.0, 1.0, 2.0].map(|times| moved(centre, &[(k, times * STEP * deviation)])));
    }
    let values = evaluate(model, &points);
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

/// ∂²measure/∂j∂k for all j < k, as (j, k, one a measure); around the same point.
pub fn mixed(model: &Model, centre: &[f64], deviations: &[f64]) -> Vec<(usize, usize, Vec<f64>)> {
    let varying: Vec<usize> = (0..deviations.len()).filter(|k| deviations[*k] > 0.0).collect();
    let pairs = varying.iter().enumerate().flat_map(|(n, k)| varying[..n].iter().map(move |j| (*j, *k)));
    pairs
        .map(|(j, k)| {
            let (a, b) = (MIXED_STEP * deviations[j], MIXED_STEP * deviations[k]);
            let corners = [1.0, 2.0].map(|times| {
                [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]]
                    .map(|[s, t]: [f64; 2]| moved(centre, &[(j, s * times * a), (k, t * times * b)]))
            });
            let values = evaluate(model, corners.as_flattened());
            let derivative = |i: usize| {
                let difference = |from: usize, times: f64| {
                    let [pp, pm, mp, mm] = [0, 1, 2, 3].map(|corner| values[from + corner][i]);
                    (pp - pm - mp + mm) / (4.0 * times * times * a * b)
                };
                // The wider one has four times the error.
                (4.0 * difference(0, 1.0) - difference(4, 2.0)) / 3.0
            };
            (j, k, (0..model.measures.len()).map(derivative).collect())
        })
        .collect()
}
