//! The friction of a unit from stroke to stroke: whether it rises, and how fast.
//!
//! What a stroke tells is its weighted force. The mean over the unit's first strokes is the reference; the mean of the last
//! one, two or three strokes is compared with it, because one stroke alone shows a great rise soonest and three together a small one.

use crate::Scalar;

/// Strokes of the reference.
pub const REFERENCE: u32 = 20;

/// Strokes before which nothing is compared.
const COMPARED: u32 = 3;

/// The most strokes that are compared together.
pub const TOGETHER: usize = 3;

/// What the trend keeps of the stroke before, for each new one: it reaches back some hundred strokes.
const KEPT: f32 = 0.99;

/// Friction of a unit over its strokes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drift {
    /// Mean weighted force of the reference.
    pub(super) reference: f32,
    /// Strokes in it.
    pub(super) strokes: u32,
    /// Weighted forces after it, the last first.
    pub(super) recent: [f32; TOGETHER],
    /// How many of them there are.
    pub(super) count: u32,
    /// Of the frictions since.
    pub(super) trend: Trend,
}

/// What a stroke says of the friction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Change {
    /// By what share of itself the friction is above the reference, from as many of the last strokes as show it best.
    pub rise: f32,
    /// The standard deviation of that.
    pub deviation: f32,
}

impl Drift {
    /// Adds the `weighted` force of a stroke of a unit whose weighted force rises by `response` with its friction; `deviation` is that of
    /// one stroke. What it says of the friction; none before there is a reference, which a stroke that is `suspect`, or whose friction
    /// has risen by more than `limit` standard deviations, never becomes part of.
    pub(super) fn add(
        &mut self,
        weighted: f32,
        [response, deviation]: [f32; 2],
        limit: f32,
        is_suspect: bool,
    ) -> Option<Change> {
        let is_growing = self.strokes < REFERENCE;
        let rise_of = |weighted: f32| (weighted - self.reference) / response;
        let rise = rise_of(weighted);
        let before = 1.0 / self.strokes.max(1) as f32;
        let [first, second] = [self.recent[0], self.recent[1]];
        let recent = [weighted, first, second];
        let together = if is_growing { 1 } else { (self.count + 1).min(TOGETHER as u32) };
        let mut best = Change::default();
        let (mut sum, mut most) = (0.0, f32::NEG_INFINITY);
        for (weighted, count) in recent.into_iter().zip(1..=together) {
            sum += rise_of(weighted);
            let mean = sum / count as f32;
            let of_mean = deviation * Scalar::sqrt(before + 1.0 / count as f32);
            if mean / of_mean > most {
                most = mean / of_mean;
                best = Change { rise: mean, deviation: of_mean };
            }
        }
        let compared = (self.strokes >= COMPARED).then_some(best);
        if !is_growing {
            self.recent = recent;
            self.count = together;
            self.trend.add(rise);
        } else if !is_suspect && compared.is_none_or(|change| change.rise <= limit * change.deviation) {
            self.strokes += 1;
            self.reference += (weighted - self.reference) / self.strokes as f32;
        }
        compared
    }

    /// How the friction has changed since the reference.
    pub fn trend(&self) -> &Trend {
        &self.trend
    }
}

/// A straight line through the frictions of past strokes, by least squares; older ones weigh less.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trend {
    /// Sums of weights times 1, age, age².
    pub(super) weights: [f32; 3],
    /// The same of squared weights.
    pub(super) squares: [f32; 3],
    /// Sums of weights times the rise, and times rise and age.
    pub(super) rises: [f32; 2],
}

/// A line and how well it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Line {
    /// Rise of the friction now, as a share of the reference.
    pub rise: f32,
    /// Rise a stroke.
    pub slope: f32,
    /// Standard deviation of the slope.
    pub deviation: f32,
}

impl Line {
    /// Strokes until the rise is `margin` (a share of the friction): by the slope, and by the steepest one that is as likely
    /// as 1 in 20. Infinite where it does not rise.
    pub fn strokes_until(&self, margin: f32) -> [f32; 2] {
        let until = |slope: f32| {
            let left = margin - self.rise;
            if left <= 0.0 {
                0.0
            } else if slope > 0.0 {
                left / slope
            } else {
                f32::INFINITY
            }
        };
        [until(self.slope), until(self.slope + 1.645 * self.deviation)]
    }
}

impl Trend {
    fn add(&mut self, rise: f32) {
        let older = |[zero, one, two]: [f32; 3], kept: f32| {
            [kept * zero + 1.0, kept * (one + zero), kept * (two + 2.0 * one + zero)]
        };
        let [zero, one] = self.rises;
        self.rises = [KEPT * zero + rise, KEPT * (one + zero)];
        self.weights = older(self.weights, KEPT);
        self.squares = older(self.squares, KEPT * KEPT);
    }

    /// The line, where a single stroke has the standard `deviation`; none before the third stroke.
    pub fn line(&self, deviation: f32) -> Option<Line> {
        let [zero, one, two] = self.weights;
        let [square, by_age, by_age_squared] = self.squares;
        // The weights of three strokes.
        if zero < 1.0 + KEPT + 0.5 * KEPT * KEPT {
            return None;
        }
        let age = one / zero;
        let scatter = two - age * one;
        let [rises, rises_by_age] = self.rises;
        let slope = -(rises_by_age - age * rises) / scatter;
        let squares = by_age_squared - 2.0 * age * by_age + age * age * square;
        let squares = if squares > 0.0 { squares } else { 0.0 };
        let deviation = deviation * Scalar::sqrt(squares) / scatter;
        Some(Line { rise: rises / zero + slope * age, slope, deviation })
    }
}
