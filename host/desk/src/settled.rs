//! When a unit has broken away, and when its force is steady.

/// Speed (m/s) whose last upward crossing is the breakaway. Bursts of released compression stay below it.
pub const BREAKAWAY_SPEED: f64 = 0.2e-3;

/// Length (s) of the end of a run over which a force must be steady to count as settled.
pub const SETTLED_WINDOW: f64 = 0.020;

/// Share of its mean by which a force may vary over that time and count as settled.
pub const SETTLED_SHARE: f64 = 0.01;

/// The least and the greatest of `values`; none of nothing.
pub fn extremes(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let each = values.map(|value| [value; 2]);
    each.reduce(|[least, greatest], [value, _]| [least.min(value), greatest.max(value)])
}

/// The mean force (N) over ascending times (s), each with its force, if it varies by less than 1 %.
pub fn settled(window: impl Iterator<Item = (f64, f64)> + Clone) -> Option<f64> {
    let [least, greatest] = extremes(window.clone().map(|(_, force)| force))?;
    let pairs = || window.clone().zip(window.clone().skip(1));
    let duration: f64 = pairs().map(|(one, next)| next.0 - one.0).sum();
    let sum: f64 = pairs().map(|(one, next)| (next.0 - one.0) * (one.1 + next.1) / 2.0).sum();
    let mean = if duration > 0.0 { sum / duration } else { least };
    (greatest - least < SETTLED_SHARE * mean.abs()).then_some(mean)
}
