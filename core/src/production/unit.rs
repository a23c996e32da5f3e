//! What is known of one unit.

use super::{Drift, MODES_MOST};

/// Strokes after which a unit is taught: from then on its own force is expected of it.
pub const TAUGHT: u32 = 3;

/// What the strokes of a unit have told: by what multiples of the modes it differs from the mean, and its friction. A unit that has
/// made no stroke is the mean of the production. [`Unit::to_bytes`] saves it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Unit {
    /// Strokes that were learned from.
    pub(super) strokes: u32,
    /// Mean of their coefficients.
    pub(super) means: [f32; MODES_MOST],
    /// Its friction.
    pub(super) drift: Drift,
}

impl Unit {
    /// Strokes that were learned from.
    pub fn strokes(&self) -> u32 {
        self.strokes
    }

    /// Whether its own force is expected of it.
    pub fn is_taught(&self) -> bool {
        self.strokes >= TAUGHT
    }

    /// How its friction changes.
    pub fn drift(&self) -> &Drift {
        &self.drift
    }

    /// The coefficient of each mode, in standard deviations of the production. All are 0 until the unit is taught.
    ///
    /// By recursive least squares, with the production as what is known beforehand: of the variance 1 of all strokes `variances` are
    /// those from stroke to stroke of a unit, and the rest is from unit to unit. Modes are orthogonal, so that each is by itself.
    #[inline(always)]
    pub fn coefficients(&self, variances: &[f32; MODES_MOST]) -> [f32; MODES_MOST] {
        let strokes = if self.is_taught() { self.strokes as f32 } else { 0.0 };
        core::array::from_fn(|k| {
            let within = variances[k];
            let between = if within < 1.0 { 1.0 - within } else { 0.0 };
            let known = strokes * between;
            self.means[k] * known / (known + within + f32::MIN_POSITIVE)
        })
    }

    /// Learns the coefficients that a stroke has.
    pub(super) fn learn(&mut self, coefficients: &[f32; MODES_MOST]) {
        self.strokes = self.strokes.saturating_add(1);
        let share = 1.0 / self.strokes as f32;
        for (mean, coefficient) in self.means.iter_mut().zip(coefficients) {
            *mean += (coefficient - *mean) * share;
        }
    }
}
