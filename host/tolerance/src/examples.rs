//! Models with known answers.

use std::sync::Arc;

use super::model::{Contributor, Distribution, Function, Measure, Model, Quantity, Sum, Variation, linear::Linear};
use crate::numeric::lanes::Lanes;

pub const MM: f64 = 1e-3;

/// A scalar contributor.
pub fn scalar(name: &str, distribution: Distribution, limits: [f64; 2]) -> Contributor {
    Contributor { name: name.into(), variation: Variation::Scalar { distribution, limits } }
}

/// A normal of which `tolerance` is three standard deviations.
pub fn normal(name: &str, mean: f64, tolerance: f64) -> Contributor {
    let distribution = Distribution::Normal { mean, deviation: tolerance / 3.0 };
    scalar(name, distribution, [mean - tolerance, mean + tolerance])
}

/// One ratio without limits a row of `coefficients`.
pub fn linear(contributors: Vec<Contributor>, coefficients: Vec<Vec<f64>>) -> Model {
    let measures = (1..=coefficients.len()).map(|i| Measure {
        name: format!("m{i}"),
        quantity: Quantity::Ratio,
        limits: [None; 2],
    });
    Model {
        measures: measures.collect(),
        contributors,
        correlations: Vec::new(),
        sums: Vec::new(),
        function: Arc::new(Linear::new(&vec![0.0; coefficients.len()], &coefficients)),
    }
}

/// 208 − 1.75 − 23 + 20 − 200 + 20 − 23 mm: nominal 0.25, centred 0.4, worst case ±0.383, RSS ±0.17825.
pub fn chain() -> Model {
    let about = |name, mean, tolerance| normal(name, mean * MM, tolerance * MM);
    let contributors = vec![
        about("housing", 208.0, 0.036),
        about("ring", 1.72, 0.03),
        about("bearing", 22.94, 0.06),
        about("sleeve", 20.0, 0.026),
        about("shaft", 200.0, 0.145),
        about("second sleeve", 20.0, 0.026),
        about("second bearing", 22.94, 0.06),
    ];
    let mut model = linear(contributors, vec![vec![1.0, -1.0, -1.0, 1.0, -1.0, 1.0, -1.0]]);
    let limits = [Some(0.0), Some(0.8 * MM)];
    model.measures[0] = Measure { name: "gap".into(), quantity: Quantity::Length, limits };
    model
}

/// cos φ = (a + c)/(e − c).
struct Clutch;

impl Function for Clutch {
    fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
        let [a, c, e] = [variables[0], variables[1], variables[2]];
        measures[0] = ((a + c) / (e - c)).map(libm::acos);
    }
}

/// A one-way clutch: the pressure angle of its rollers.
pub fn clutch() -> Model {
    let limits = [6.0184, 8.0184].map(|degrees: f64| Some(degrees.to_radians()));
    Model {
        contributors: vec![
            normal("hub", 27.645 * MM, 0.05 * MM),
            normal("roller", 11.43 * MM, 0.01 * MM),
            normal("cage", 50.8 * MM, 0.0125 * MM),
        ],
        correlations: Vec::new(),
        measures: vec![Measure { name: "pressure angle".into(), quantity: Quantity::Angle, limits }],
        sums: Vec::new(),
        function: Arc::new(Clutch),
    }
}

/// Sum of rectangulars with the given standard deviations.
pub fn rectangulars(deviations: &[f64]) -> Model {
    let contributors = deviations.iter().map(|deviation| {
        let half = deviation * libm::sqrt(3.0);
        scalar("x", Distribution::Uniform { limits: [-half, half] }, [-half, half])
    });
    linear(contributors.collect(), vec![vec![1.0; deviations.len()]])
}

/// Standard normals with the given coefficients.
pub fn normals(coefficients: &[f64]) -> Model {
    linear(coefficients.iter().map(|_| normal("x", 0.0, 3.0)).collect(), vec![coefficients.to_vec()])
}

/// Two gaps with means and standard deviations (mm) of the paper's left front pin and a correlation, and their sum.
pub fn left_front(correlation: f64) -> Model {
    let gap = |name, mean: f64, deviation: f64| normal(name, mean * MM, 3.0 * deviation * MM);
    let mut model =
        linear(vec![gap("left", -0.0223, 0.0624), gap("right", 0.4037, 0.0488)], vec![vec![1.0, 0.0], vec![0.0, 1.0]]);
    if correlation != 0.0 {
        model.correlations.push((0, 1, correlation));
    }
    for measure in &mut model.measures {
        measure.quantity = Quantity::Length;
    }
    model.sums.push(Sum { name: "left front across".into(), measures: vec![0, 1] });
    model
}
