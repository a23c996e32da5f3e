//! What a sample says of a stroke.

use super::{
    GAP_NODES, Row, Unit, Watch,
    stroke::{Report, Sample, Stroke},
};
use crate::{
    Scalar,
    monitor::{FORCE_MOST, STANDING, Verdict},
    table::Nodes,
};

/// Periods over which a force is smoothed.
const SMOOTHING: f32 = 20.0;

/// What smoothing leaves of the variance of white noise.
const LEFT: f32 = 1.0 / (2.0 * SMOOTHING - 1.0);

/// The square of the three standard deviations of the noise that count beside a width.
const NOISES: f32 = 9.0;

/// Widths, and standard deviations of the noise, that a sample may differ by before it counts as an event.
const EVENT_WIDTHS: f32 = 2.0;
const EVENT_NOISES: f32 = 3.0;

/// Samples that a sign of a jam, or of a dead sensor, lasts before it is reported.
pub const HOLD: u32 = 10;

impl<V: Nodes> Watch<'_, V> {
    /// What `sample` says of a stroke of `unit`, after those before it. A sample that is not whole is passed over: after ten
    /// of them there is [`Verdict::NoData`].
    ///
    /// [`Verdict::Jam`]: for ten samples slower than a tenth of the command where units that complete their stroke move.
    /// [`Verdict::Tight`]: the smoothed force exceeds the expected one by more than the false-alarm rate allows.
    /// [`Verdict::Ended`]: beyond the table.
    #[inline]
    pub fn step(&self, unit: &Unit, stroke: &mut Stroke, sample: &Sample) -> Report {
        let (production, record) = (&self.production, self.production.record());
        let place = production.places().locate(sample.at);
        let is_valid = sample.is_valid();
        let is_inside = is_valid & (place.outside == 0);

        // By how far the stroke has come, so that neither the rate of samples nor a stop weighs.
        let length = sample.at - stroke.at;
        let length = if is_inside & (length > 0.0) { length } else { 0.0 };
        stroke.at += length;
        stroke.is_whole &= length <= GAP_NODES * production.places().step();

        let [mean, mean_speed] = production.table.of_row(Row::Mean as usize, &place);
        let above = if is_inside { sample.force - mean } else { 0.0 };
        let by_length = length * above;
        let (mut own, mut speed, mut in_range) = (mean, mean_speed, production.table.is_in_range(mean));
        let coefficients = unit.coefficients(&record.variances);
        for ((sum, coefficient), k) in stroke.sums.iter_mut().zip(coefficients).take(production.modes).zip(0usize..) {
            let [force, velocity] = production.table.of_row(Row::Mode as usize + k, &place);
            *sum += by_length * force;
            own += coefficient * force;
            speed += coefficient * velocity;
            in_range &= production.table.is_in_range(force);
        }
        let is_taught = unit.is_taught();
        let untaught = if sample.command < 0.0 { Row::Below } else { Row::Above };
        let (row, factor) = if is_taught { (Row::Taught, self.taught) } else { (untaught, self.untaught) };
        let width = production.force(row as usize, &place);

        // A rise of the friction is a little more force all along. What differs by more than strokes do is an event that comes at
        // another time, and counts as no more than that.
        let beyond = if is_inside { sample.force - own } else { 0.0 };
        let most = if is_taught { EVENT_WIDTHS * width + EVENT_NOISES * record.noise } else { FORCE_MOST };
        let part = if beyond > most { most } else { beyond };
        let part = if part < -most { -most } else { part };
        let weight = production.force(Row::Weight as usize, &place);
        stroke.weighted += length * weight * (part + (own - mean));

        // What this stroke has told of its friction before this sample, by least squares; none of a unit that is not taught.
        let rise = stroke.above / (stroke.squared + record.doubt);
        let expected = own + if is_taught { rise * weight } else { 0.0 };
        stroke.above += length * weight * part;
        stroke.squared += length * weight * weight;

        let difference = if is_inside { sample.force - expected - stroke.smoothed } else { 0.0 };
        stroke.smoothed += difference * (1.0 / SMOOTHING);
        let limit = factor * Scalar::sqrt(width * width + NOISES * LEFT * record.noise * record.noise);
        let excess = sample.along(stroke.smoothed);

        let least = STANDING * sample.command.abs();
        let stands = is_inside & (sample.at >= record.moving) & (least > 0.0) & (sample.along(sample.speed) < least);
        // A sample that is not whole neither counts nor starts anew.
        let standing = if stands { stroke.standing.saturating_add(1) } else { 0 };
        stroke.standing = if is_valid { standing } else { stroke.standing };
        stroke.missing = if is_valid { 0 } else { stroke.missing.saturating_add(1) };

        let is_tight = is_inside & in_range & (excess > limit);
        let verdict = if stroke.standing > HOLD {
            Verdict::Jam
        } else if stroke.missing > HOLD {
            Verdict::NoData
        } else if is_valid & (sample.at > production.places().last()) {
            Verdict::Ended
        } else if sample.at < production.places().first() || sample.at.is_nan() {
            Verdict::Blind
        } else if is_tight {
            Verdict::Tight
        } else {
            Verdict::Free
        };
        stroke.worst = match (stroke.worst, verdict) {
            (Verdict::Jam, _) | (_, Verdict::Jam) => Verdict::Jam,
            (Verdict::Tight, _) | (_, Verdict::Tight) => Verdict::Tight,
            _ => Verdict::Free,
        };
        Report { verdict, expected, own, speed, excess, limit, damaged: !in_range }
    }
}
