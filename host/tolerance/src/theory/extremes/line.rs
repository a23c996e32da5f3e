//! Lines from a point towards corners and middles of zones, the places on them, and the measures there.

use crate::{
    model::{Model, Variation},
    numeric::lanes::Lanes,
};

/// Places on a line that are looked at: of a scalar, of a zone, of all contributors together.
const OF_SCALAR: [f64; 8] = [1.0 / 4096.0, 1.0 / 512.0, 1.0 / 64.0, 0.25, 0.5, 0.75, 63.0 / 64.0, 1.0];
const OF_ZONE: [f64; 2] = [0.5, 1.0];
pub(super) const OF_ALL: [f64; 6] = [1.0 / 1024.0, 1.0 / 64.0, 0.25, 0.5, 0.75, 1.0];
/// Distances for slopes (shares of half a tolerance or zone): a narrow one, and one that sees beyond a kink.
pub(super) const STEPS: [f64; 2] = [1e-3, 0.25];

/// Variables and the values to which they are moved.
pub(super) type Change = Vec<(usize, f64)>;

/// Places on a line of one contributor.
pub(super) fn places(variation: &Variation) -> &'static [f64] {
    match variation {
        Variation::Scalar { .. } => &OF_SCALAR,
        Variation::Zone(_) | Variation::Disc(_) | Variation::Nested(_) => &OF_ZONE,
    }
}

/// Points towards which a contributor is moved: its corners, and the middle of a zone.
pub(super) fn targets(variation: &Variation) -> Vec<Vec<f64>> {
    let mut targets = variation.corners();
    if !matches!(variation, Variation::Scalar { .. }) {
        targets.push(variation.middle());
    }
    targets
}

/// The change of the variables from `at` on to a point.
pub(super) fn moved_to(at: usize, point: &[f64]) -> Change {
    point.iter().enumerate().map(|(k, value)| (at + k, *value)).collect()
}

/// The change to a place on the line from `point` to the end of `line`, which the part 1 hits exactly.
pub(super) fn on_line(point: &[f64], line: &Change, part: f64) -> Change {
    let place = |end: f64, start: f64| if part == 1.0 { end } else { start + part * (end - start) };
    line.iter().map(|(k, end)| (*k, place(*end, point[*k]))).collect()
}

/// Numbers of some units at work.
pub(super) struct Room {
    variables: Vec<Lanes>,
    measures: Vec<Lanes>,
}

impl Room {
    /// For the units of a model.
    pub fn new(model: &Model) -> Self {
        Self { variables: vec![Lanes::ZERO; model.variables()], measures: vec![Lanes::ZERO; model.measures.len()] }
    }

    /// Calls `each` with lane and measures of every change of `base`, up to one a lane.
    pub fn evaluate(&mut self, model: &Model, base: &[f64], changes: &[Change], mut each: impl FnMut(usize, &[Lanes])) {
        self.variables.iter_mut().zip(base).for_each(|(variable, value)| *variable = Lanes::splat(*value));
        for (lane, change) in changes.iter().enumerate() {
            change.iter().for_each(|(k, value)| self.variables[*k].0[lane] = *value);
        }
        model.function.evaluate(&self.variables, &mut self.measures);
        (0..changes.len()).for_each(|lane| each(lane, &self.measures));
    }
}
