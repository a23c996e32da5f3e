//! A watch over the strokes of a unit, with a stated rate of false alarms.

use super::{GAP_NODES, MODES_MOST, Production, ProductionError, RATES, Stroke, Unit, drift::Change};
use crate::{error::bounded, monitor::Verdict, table::Nodes};

/// The least rate of false alarms in a stroke.
pub const RATE_LEAST: f32 = RATES[RATES.len() - 1];
/// The greatest.
pub const RATE_MOST: f32 = RATES[0];

/// Everything about the watch over a unit that does not change: the production, and the limits for a rate of false alarms.
#[derive(Clone, Copy, Debug)]
pub struct Watch<'a, V> {
    pub(super) production: Production<'a, V>,
    /// Widths by which the smoothed force of a unit that is not taught may exceed the mean.
    pub(super) untaught: f32,
    /// The same of a taught one and its own force.
    pub(super) taught: f32,
    /// Standard deviations by which its friction may rise.
    drift: f32,
}

/// What a whole stroke says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[must_use = "the verdict has to be acted on"]
pub struct StrokeEnd {
    /// [`Verdict::Jam`] or [`Verdict::Tight`] if a sample said so; [`Verdict::Tight`] if the friction has risen; [`Verdict::NoData`] if
    /// pieces of the stroke are missing; else [`Verdict::Free`].
    pub verdict: Verdict,
    /// Whether the unit was learned from it.
    pub is_learned: bool,
    /// By what share the friction is above that of the unit's first strokes; 0 before the fourth.
    pub rise: f32,
    /// The standard deviation of that; infinite before the fourth.
    pub deviation: f32,
}

impl<'a, V: Nodes> Watch<'a, V> {
    /// A watch by a `production` that gives a false alarm in a share `rate` of the strokes of units that complete them, 10⁻⁶ to
    /// 10⁻². Before a unit is taught all alarms are those of its samples; then three tenths of them, and the rest those of its friction.
    ///
    /// # Errors
    /// [`ProductionError::Parameter`] if the rate is out of bounds.
    pub fn new(production: Production<'a, V>, rate: f32) -> Result<Self, ProductionError> {
        let rate = bounded("production.rate", rate, [f64::from(RATE_LEAST), f64::from(RATE_MOST)])?;
        let record = production.record();
        let [untaught, taught, drift] = [&record.untaught, &record.taught, &record.drift].map(|all| at(all, rate));
        Ok(Self { production, untaught, taught, drift })
    }

    /// The production.
    pub fn production(&self) -> &Production<'a, V> {
        &self.production
    }

    /// A stroke that begins.
    pub fn start(&self) -> Stroke {
        Stroke::from(self.production.places().first())
    }

    /// What the `stroke` says as a whole, and what `unit` learns from it: its coefficients and the reference of its friction from the first
    /// twenty whole strokes without an alarm.
    pub fn finish(&self, unit: &mut Unit, stroke: &Stroke) -> StrokeEnd {
        let record = self.production.record();
        let places = self.production.places();
        let is_whole = stroke.is_whole && stroke.at >= places.last() - GAP_NODES * places.step();
        let worst = match stroke.worst() {
            Verdict::Jam | Verdict::Tight => stroke.worst(),
            _ if !is_whole => Verdict::NoData,
            _ => Verdict::Free,
        };
        let none = StrokeEnd { verdict: worst, is_learned: false, rise: 0.0, deviation: f32::INFINITY };
        if !is_whole {
            return none;
        }
        let coefficients = unit.coefficients(&record.variances);
        let is_suspect = worst != Verdict::Free;
        let change = record
            .response_of(&coefficients)
            .and_then(|response| unit.drift.add(stroke.weighted, [response, record.deviation], self.drift, is_suspect));
        let Change { rise, deviation } = change.unwrap_or(Change { rise: 0.0, deviation: f32::INFINITY });
        let has_risen = rise > self.drift * deviation;
        let is_learned = !is_suspect && !has_risen && unit.strokes() < super::drift::REFERENCE;
        if is_learned {
            unit.learn(&self.coefficients(stroke));
        }
        let verdict = if worst == Verdict::Free && has_risen { Verdict::Tight } else { worst };
        StrokeEnd { verdict, is_learned, rise, deviation }
    }

    /// The coefficients of the modes that a whole `stroke` has.
    pub fn coefficients(&self, stroke: &Stroke) -> [f32; MODES_MOST] {
        let pairs = || stroke.sums.iter().zip(self.production.record().norms);
        core::array::from_fn(|k| pairs().nth(k).map_or(0.0, |(sum, norm)| if norm > 0.0 { sum / norm } else { 0.0 }))
    }

    /// The weighted force of a `stroke`, which rises with its friction by the response of the record.
    pub fn weighted(&self, stroke: &Stroke) -> f32 {
        stroke.weighted
    }
}

/// The limit for `rate` among those for 10⁻² to 10⁻⁶, straight in between over the rate's logarithm.
fn at(limits: &[f32; RATES.len()], rate: f32) -> f32 {
    let place = -libm::log10f(rate) - 2.0;
    let pairs = limits.windows(2).zip(0u8..);
    pairs.fold(limits[0], |limit, (pair, k)| {
        let part = place - f32::from(k);
        let part = if part > 0.0 { part } else { 0.0 };
        let part = if part < 1.0 { part } else { 1.0 };
        let [low, high] = pair else { return limit };
        limit + part * (high - low)
    })
}
