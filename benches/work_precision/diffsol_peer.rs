//! diffsol's stiff solvers.

use std::{
    cell::RefCell,
    time::{Duration, Instant},
};

use diffsol::{MatrixCommon, NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod};
use slipfit_problems::{
    cd_rom::CdRomSlide,
    first_order::{AT_REST, V_Z, VELOCITY, rates_of},
};

use crate::entry::{Achieved, Entry, Tolerances};

/// The name of diffsol's backward differentiation formulas.
pub const BDF: &str = "diffsol BDF";
const ESDIRK34: &str = "diffsol ESDIRK34";

/// Every solver with every tolerance.
pub fn entries(slide: &CdRomSlide<f64>, milliseconds: u32) -> Vec<Entry> {
    let mut entries = Vec::new();
    for solver in [BDF, ESDIRK34] {
        for tolerances in Tolerances::all() {
            let slide = *slide;
            entries.push(Entry {
                solver,
                setting: tolerances.to_string(),
                work: Box::new(move || solve(&slide, milliseconds, solver, tolerances)),
            });
        }
    }
    entries
}

/// The drive force every millisecond; `None` if the solver gives up.
pub fn solve(slide: &CdRomSlide<f64>, milliseconds: u32, solver: &str, tolerances: Tolerances) -> Option<Achieved> {
    let rates = |t: f64, y: &[f64], dy: &mut [f64]| rates_of(slide, t, y, dy);
    let problem = FirstOrder { rates, start: &AT_REST, velocity: VELOCITY };
    let (speeds, time) = problem.solve(milliseconds, solver, tolerances, |state| state[V_Z])?;
    let force = speeds.iter().enumerate().map(|(k, v)| slide.drive().force(k as f64 * 1e-3, *v)).collect();
    Some(Achieved { force, time })
}

/// Equations of first order with their start, whose velocities begin at number `velocity`.
pub struct FirstOrder<'a, R> {
    /// Writes the rates at a time (s) and state.
    pub rates: R,
    /// The state at time 0.
    pub start: &'a [f64],
    /// Where velocities begin.
    pub velocity: usize,
}

impl<R: Fn(f64, &[f64], &mut [f64])> FirstOrder<'_, R> {
    /// What `asked` finds in the states at every millisecond from 0 on, and the time that it took; `None` if the `solver` gives up.
    pub fn solve(
        &self,
        milliseconds: u32,
        solver: &str,
        Tolerances { relative, absolute, proportion }: Tolerances,
        asked: impl Fn(&[f64]) -> f64,
    ) -> Option<(Vec<f64>, Duration)> {
        let count = self.start.len();
        let mut tolerances = vec![absolute * proportion; count];
        tolerances[self.velocity..].fill(absolute);
        // The last state that was asked for and its rates: all columns of one Jacobian share them.
        let base = RefCell::new(Base {
            t: f64::NAN,
            state: vec![0.0; count],
            rates: vec![0.0; count],
            moved: vec![0.0; count],
        });
        let problem = OdeBuilder::<NalgebraMat<f64>>::new()
            .rtol(relative)
            .atol(tolerances)
            .h0(1e-5)
            .rhs_implicit(
                |y, _, t, dy| (self.rates)(t, y, dy),
                // Forward differences; central ones cost twice as much and were never quicker to the same error.
                |y, _, t, v, jv| {
                    let mut base = base.borrow_mut();
                    let Base { t: at, state, rates, moved } = &mut *base;
                    if *at != t || state[..] != y[..] {
                        *at = t;
                        state.copy_from_slice(y);
                        (self.rates)(t, y, rates);
                    }
                    let h = increment(v);
                    moved.iter_mut().zip(y.iter().zip(v.iter())).for_each(|(moved, (y, v))| *moved = y + h * v);
                    (self.rates)(t, moved, jv);
                    jv.iter_mut().zip(rates.iter()).for_each(|(j, at)| *j = (*j - at) / h);
                },
            )
            .init(|_, _, y| y.copy_from_slice(self.start), count)
            .build()
            .ok()?;
        let times: Vec<f64> = (1..=milliseconds).map(|i| f64::from(i) * 1e-3).collect();
        let start = Instant::now();
        let states = match solver {
            BDF => problem.bdf::<NalgebraLU<f64>>().ok()?.solve_dense(&times).ok()?.0,
            _ => problem.esdirk34::<NalgebraLU<f64>>().ok()?.solve_dense(&times).ok()?.0,
        };
        let time = start.elapsed();
        let columns = states.inner().column_iter().map(|column| asked(column.as_slice()));
        Some((std::iter::once(asked(self.start)).chain(columns).collect(), time))
    }
}

struct Base {
    t: f64,
    state: Vec<f64>,
    rates: Vec<f64>,
    moved: Vec<f64>,
}

/// A length along the direction `v` that keeps half of the digits: columns are asked for by unit vectors, states are of the
/// order of 1e-3 and the friction law bends at 1e-4.
fn increment(v: &[f64]) -> f64 {
    let length = libm::sqrt(v.iter().map(|x| x * x).sum());
    1e-9 / length.max(1e-300)
}
