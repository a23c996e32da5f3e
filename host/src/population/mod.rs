//! What every unit of a production does: the dynamics of whole populations.
//!
//! A level n moves all gaps together, and no unit of a production is like that. Here each unit gets gaps of its own, drawn
//! from the product's joint model or from means and deviations, and parameters that vary, and runs by itself.

pub mod drivers;
mod explained;
mod figures;
pub mod finding;
pub mod hypothesis;
mod integrate;
pub mod kept;
mod lane;
pub mod limit_state;
pub mod mechanism;
pub mod part;
pub mod picture;
pub mod production;
pub mod ranked;
pub mod rare;
pub mod shares;
pub mod simulation;
mod source;
pub mod statistics;
pub mod study;
pub mod subject;
pub mod tally;
pub mod telling;
pub mod unit;

use pulp::{Simd, WithSimd};
use rayon::prelude::*;
use slipfit_core::{menu::SlideData, slide::CONTACTS};

use crate::{
    dynamics::{laws, out_of_line::OutOfLine, pack::Pack, simulate::SimulateError},
    system::interrupt,
};

#[cfg(test)]
mod tests;

pub use figures::Figures;
pub use integrate::Course;
use integrate::integrate;
use production::{Drawn, Production};
use subject::Subject;
pub use unit::UnitOutcome;

/// Units that are simulated together; they share nothing but the work.
const PIECE: usize = 128;

/// The slides of some units, all of the same laws.
#[derive(Clone, Copy)]
struct Work<'a> {
    course: Course,
    slides: &'a [SlideData<f64>],
}

/// As many at a time as a register of the instructions holds.
impl WithSimd for Work<'_> {
    type Output = Vec<Figures>;

    #[inline(always)]
    fn with_simd<V: Simd>(self, instructions: V) -> Vec<Figures> {
        let Self { course, slides } = self;
        let mut figures = vec![Figures::NONE; slides.len()];
        if slides.first().and_then(laws::usual).is_some() {
            integrate(instructions, &course, slides, &mut figures, laws::usual::<Pack<V>>);
        } else {
            integrate(instructions, &course, slides, &mut figures, laws::chosen::<Pack<V>>);
        }
        figures
    }
}

/// Simulates `slides`, all of the same laws, in the widest instructions that the machine has. The bits do not depend on them.
/// A slide that cannot be simulated has no figures.
pub fn simulate(course: Course, slides: &[SlideData<f64>]) -> Vec<Figures> {
    simulate_in(usize::MAX, course, slides)
}

/// The same, as many at a time as the machine's registers have lanes, but at most `lanes`.
pub fn simulate_in(lanes: usize, course: Course, slides: &[SlideData<f64>]) -> Vec<Figures> {
    #[cfg(target_arch = "x86_64")]
    {
        let work = Work { course, slides };
        if let Some(avx512) = pulp::x86::V4::try_new().filter(|_| lanes >= 16) {
            return Simd::vectorize(avx512, work);
        }
        if let Some(avx2) = pulp::x86::V3::try_new().filter(|_| lanes >= 8) {
            return Simd::vectorize(avx2, work);
        }
    }
    one_by_one(course, slides)
}

/// The same, one after the other.
fn one_by_one(course: Course, slides: &[SlideData<f64>]) -> Vec<Figures> {
    let mut figures = vec![Figures::NONE; slides.len()];
    // In one function with their loop the forces would take long to compile.
    if slides.first().and_then(laws::usual).is_some() {
        let load = |data: &_| laws::usual::<Pack<pulp::Scalar>>(data).map(OutOfLine::new);
        integrate(pulp::Scalar, &course, slides, &mut figures, load);
    } else {
        let load = |data: &_| laws::chosen::<Pack<pulp::Scalar>>(data).map(OutOfLine::new);
        integrate(pulp::Scalar, &course, slides, &mut figures, load);
    }
    figures
}

/// One unit of a population.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit<G = [f64; CONTACTS]> {
    /// Its number in the production, from 0 on.
    pub number: u64,
    /// Its gaps (m): of a slide in the order of Table 2, else in the mechanism's order.
    pub gaps: G,
    /// What it did.
    pub outcome: UnitOutcome,
}

/// Simulates the units `numbers` of a `production` of `subject` on all threads of the current pool; `done` is called with how
/// many are. `see` gets the units of each piece in order, with what they were drawn as. The result does not depend on the
/// number of threads.
///
/// # Errors
/// [`SimulateError`] of the first unit whose parameters are out of bounds, or that cannot be solved.
pub fn simulate_units<S: Subject>(
    subject: &S,
    production: &Production<S::Gaps>,
    numbers: std::ops::Range<u64>,
    done: impl Fn(u64) + Sync,
    mut see: impl FnMut(&Drawn<S::Gaps>, &[Unit<S::Gaps>]),
) -> Result<(), SimulateError> {
    let starts: Vec<u64> = numbers.clone().step_by(PIECE).collect();
    // As many pieces at a time as keep all threads at work, so that memory does not grow with the population.
    for starts in starts.chunks(32 * rayon::current_num_threads()) {
        let pieces: Vec<_> = starts
            .par_iter()
            .with_max_len(1)
            .map(|start| {
                if interrupt::requested() {
                    return Err(SimulateError::Interrupted);
                }
                let piece = *start..(start + PIECE as u64).min(numbers.end);
                let count = piece.end - piece.start;
                let drawn = production.draw(piece);
                let units = subject.units(&drawn)?;
                done(count);
                Ok((drawn, units))
            })
            .collect();
        for piece in pieces {
            let (drawn, units) = piece?;
            see(&drawn, &units);
        }
    }
    Ok(())
}
