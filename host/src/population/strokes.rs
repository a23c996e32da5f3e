//! Strokes of the units of a production: force and speed over time, several strokes of each unit, whose friction differs from one to the
//! next.

use slipfit_core::sampling::{
    normal::score,
    stream::{Rng as _, derived, unit_stream},
};
use slipfit_system::{interrupt, parallel};

use super::{production::Production, stroke::Stroke, subject::Subject};
use crate::dynamics::simulate::SimulateError;

/// What seeds of the friction of strokes are derived with.
const STREAM: u64 = 5 << 32;

/// Units that one thread simulates in a row; they are drawn together.
const TOGETHER: u64 = 64;

/// Which strokes of each unit are simulated, and how.
#[derive(Clone, Debug)]
pub struct Strokes {
    /// Seed of the friction.
    pub seed: u64,
    /// Their numbers.
    pub numbers: std::ops::Range<u64>,
    /// Standard deviation of the friction of a unit from stroke to stroke, as a share of it.
    pub friction: f64,
    /// Interval of the samples (s).
    pub every: f64,
}

impl Strokes {
    /// By what share the friction of a stroke differs from that of its unit. Within four standard deviations, and never to less than a
    /// tenth.
    pub fn friction_of(&self, unit: u64, stroke: u64) -> f64 {
        let mut stream = unit_stream(derived(derived(self.seed, STREAM), unit), stroke);
        (self.friction * score::<f64>(stream.next_u64()).clamp(-4.0, 4.0)).max(-0.9)
    }

    /// What `keep` makes of the strokes of each of the `units`, in order, with the share that its friction differs by. A unit without a run
    /// has fewer strokes. `done` is called after each unit.
    ///
    /// # Errors
    /// [`SimulateError::Interrupted`].
    pub fn simulate<T: Send>(
        &self,
        subject: &dyn Subject,
        production: &Production,
        units: &[u64],
        keep: impl Fn(u64, Vec<(f64, Stroke)>) -> T + Sync,
        done: impl Fn() + Sync,
    ) -> Result<Vec<T>, SimulateError> {
        // Those that are drawn together.
        let groups: Vec<&[u64]> = units.chunk_by(|one, other| one / TOGETHER == other / TOGETHER).collect();
        let group = |group: &&[u64]| {
            let (Some(first), Some(last)) = (group.first(), group.last()) else { return Ok(Vec::new()) };
            let start = first - first % TOGETHER;
            let drawn = production.draw(start..last + 1);
            let unit = |unit: &u64| {
                let mut strokes = Vec::new();
                for number in self.numbers.clone() {
                    if interrupt::requested() {
                        return Err(SimulateError::Interrupted);
                    }
                    let friction = self.friction_of(*unit, number);
                    match subject.stroke(&drawn, (unit - start) as usize, friction, self.every) {
                        Ok(stroke) => strokes.push((friction, stroke)),
                        Err(SimulateError::Interrupted) => return Err(SimulateError::Interrupted),
                        Err(_) => break,
                    }
                }
                done();
                Ok(keep(*unit, strokes))
            };
            group.iter().map(unit).collect::<Result<Vec<T>, _>>()
        };
        Ok(parallel::try_map(&groups, group)?.into_iter().flatten().collect())
    }
}
