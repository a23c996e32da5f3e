//! All limits of a product as one measure: how far the nearest of them is.

use std::sync::Arc;

use crate::{
    model::{Function, Measure, Model, Quantity},
    numeric::lanes::Lanes,
};

/// Measures, and behind them the least distance of any to its limit, in parts of the distance of its limits; negative outside,
/// not a number where any of them cannot be computed.
struct Nearest {
    function: Arc<dyn Function>,
    limits: Vec<Limit>,
}

/// One limit of a measure.
struct Limit {
    measure: usize,
    value: f64,
    /// Times the distance from it: 1 or −1 over the measure's scale.
    factor: f64,
}

impl Function for Nearest {
    fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
        let Some((nearest, measures)) = measures.split_last_mut() else { return };
        self.function.evaluate(variables, measures);
        for lane in 0..nearest.0.len() {
            let of = |limit: &Limit| limit.factor * (measures[limit.measure].0[lane] - limit.value);
            // Far from all limits where none has any.
            let least = self.limits.iter().map(of).fold(1.0, f64::min);
            let undefined: f64 = measures.iter().map(|measure| measure.0[lane] * 0.0).sum();
            nearest.0[lane] = least + undefined;
        }
    }
}

/// `model` with one more measure, which is below its lower limit, 0, where any other is outside of its own.
pub fn with_nearest(model: Model) -> Model {
    let of = |(measure, of): (usize, &Measure)| {
        let [lower, upper] = of.limits;
        let scale = match (lower, upper) {
            (Some(lower), Some(upper)) => upper - lower,
            _ => 1.0,
        };
        let limit = move |value, sign: f64| Limit { measure, value, factor: sign / scale };
        [lower.map(|value| limit(value, 1.0)), upper.map(|value| limit(value, -1.0))].into_iter().flatten()
    };
    let limits = model.measures.iter().enumerate().flat_map(of).collect();
    let mut measures = model.measures;
    measures.push(Measure { name: "nearest limit".into(), quantity: Quantity::Ratio, limits: [Some(0.0), None] });
    Model { measures, sums: Vec::new(), function: Arc::new(Nearest { function: model.function, limits }), ..model }
}
