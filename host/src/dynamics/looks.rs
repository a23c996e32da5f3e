//! When a run ends, and at which instants it is looked at for its figures.

use super::error_control::{Cubics, Knot, Values, between};

/// Instants between two knots at which a run is looked at, the second knot among them: figures are to depend neither on the
/// lengths of steps nor on how often a run is sampled.
const LOOKS: u32 = 4;

/// When (s) the run ends: where it comes to its stroke's end, between the last two knots, or with the last.
pub fn end<V: Values>(knots: &[Knot<V>], mut is_at_end: impl FnMut(&V) -> bool) -> f64 {
    let last = knots.len() - 1;
    if last == 0 || !is_at_end(&knots[last].values) {
        return knots[last].t;
    }
    let [mut before, mut after] = [knots[last - 1].t, knots[last].t];
    for _ in 0..60 {
        let middle = 0.5 * (before + after);
        if is_at_end(&between(knots, last - 1, middle)) { after = middle } else { before = middle }
    }
    after
}

/// Where a run is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// At this knot.
    At(usize),
    /// Before this knot, in the step that ends there.
    Before(usize),
}

/// Shows `look` the run at the times (s) at which it is looked at, up to its `end` (s).
pub fn looks<V: Values>(knots: &[Knot<V>], end: f64, mut look: impl FnMut(f64, V, Place)) {
    look(knots[0].t, knots[0].values, Place::At(0));
    for (i, pair) in knots.windows(2).enumerate() {
        let ([from, to], cubics) = ([pair[0].t, pair[1].t], Cubics::of(knots, i));
        for k in 1..=LOOKS {
            let t = if k == LOOKS { to } else { from + (to - from) * f64::from(k) / f64::from(LOOKS) };
            if t > end {
                return look(end, cubics.at(end), Place::Before(i + 1));
            }
            if k == LOOKS {
                look(t, pair[1].values, Place::At(i + 1));
            } else {
                look(t, cubics.at(t), Place::Before(i + 1));
            }
            if t == end {
                return;
            }
        }
    }
}

/// The times (s) of the samples of a run that ends at `end` (s), `every` (s) of them.
pub fn samples(end: f64, every: f64) -> impl Iterator<Item = f64> + Clone {
    let count = (end / every * (1.0 + 1e-12)).floor() as usize;
    (0..=count).map(move |i| (i as f64 * every).min(end))
}
