//! What every unit of a production does: the dynamics of whole populations.
//!
//! A level n moves all gaps together, and no unit of a production is like that. Here each unit gets gaps of its own, drawn
//! from the product's joint model or from means and deviations, and parameters that vary, and runs by itself.

pub mod drivers;
mod explained;
pub mod finding;
pub mod hypothesis;
pub mod kept;
pub mod limit_state;
pub mod malfunction;
pub mod mechanism;
pub mod part;
pub mod production;
pub mod ranked;
pub mod rare;
pub mod simulation;
pub mod slide;
mod source;
pub mod statistics;
pub mod stroke;
pub mod strokes;
pub mod study;
pub mod subject;
pub mod tally;
pub mod telling;
pub mod uncertain;
pub mod unit;

pub use slipfit_desk::population::{Course, Figures, simulate, simulate_in};
use slipfit_system::{interrupt, parallel};

use crate::dynamics::simulate::SimulateError;

#[cfg(test)]
mod tests;

use production::{Drawn, Production};
use subject::Subject;
pub use unit::{Unit, UnitOutcome};

/// Units that are simulated together; they share nothing but the work.
const PIECE: usize = 128;

/// Simulates the units `numbers` of a `production` of `subject` on all threads of the current pool; `done` is called with how
/// many are. `see` gets the units of each piece in order, with what they were drawn as. The result does not depend on the
/// number of threads.
///
/// # Errors
/// [`SimulateError::Interrupted`].
pub fn simulate_units(
    subject: &dyn Subject,
    production: &Production,
    numbers: std::ops::Range<u64>,
    done: impl Fn(u64) + Sync,
    mut see: impl FnMut(&Drawn, &[Unit]),
) -> Result<(), SimulateError> {
    let starts: Vec<u64> = numbers.clone().step_by(PIECE).collect();
    // As many pieces at a time as keep all threads at work, so that memory does not grow with the population.
    for starts in starts.chunks(32 * rayon::current_num_threads()) {
        let pieces = parallel::map(starts, |start| {
            if interrupt::requested() {
                return Err(SimulateError::Interrupted);
            }
            let piece = *start..(start + PIECE as u64).min(numbers.end);
            let count = piece.end - piece.start;
            let drawn = production.draw(piece);
            let units = subject.units(&drawn)?;
            done(count);
            Ok((drawn, units))
        });
        for piece in pieces {
            let (drawn, units) = piece?;
            see(&drawn, &units);
        }
    }
    Ok(())
}
