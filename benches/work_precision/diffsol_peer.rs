//! diffsol's stiff solvers.

use std::{cell::RefCell, time::Instant};

use diffsol::{MatrixCommon, NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod};
use slipfit_problems::{
    cd_rom::CdRomSlide,
    first_order::{AT_REST, EQUATIONS, V_Z, VELOCITY, rates},
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
pub fn solve(
    slide: &CdRomSlide<f64>,
    milliseconds: u32,
    solver: &str,
    Tolerances { relative, absolute, proportion }: Tolerances,
) -> Option<Achieved> {
    let mut tolerances = [absolute * proportion; EQUATIONS];
    tolerances[VELOCITY..].fill(absolute);
    // The last state that was asked for and its rates: all columns of one Jacobian share them.
    let base = RefCell::new((f64::NAN, [0.0; EQUATIONS], [0.0; EQUATIONS]));
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(relative)
        .atol(tolerances)
        .h0(1e-5)
        .rhs_implicit(
            |y, _, t, dy| dy.copy_from_slice(&rates(slide, t, y)),
            // Forward differences; central ones cost twice as much and were never quicker to the same error.
            |y, _, t, v, jv| {
                let mut base = base.borrow_mut();
                if base.0 != t || base.1 != *y {
                    base.0 = t;
                    base.1.copy_from_slice(y);
                    base.2 = rates(slide, t, y);
                }
                let h = increment(v);
                let moved: [f64; EQUATIONS] = std::array::from_fn(|i| y[i] + h * v[i]);
                let up = rates(slide, t, &moved);
                jv.iter_mut().zip(up).zip(base.2).for_each(|((j, up), at)| *j = (up - at) / h);
            },
        )
        .init(|_, _, y| y.copy_from_slice(&AT_REST), EQUATIONS)
        .build()
        .ok()?;
    let times: Vec<f64> = (1..=milliseconds).map(|i| f64::from(i) * 1e-3).collect();
    let start = Instant::now();
    let states = match solver {
        BDF => problem.bdf::<NalgebraLU<f64>>().ok()?.solve_dense(&times).ok()?.0,
        _ => problem.esdirk34::<NalgebraLU<f64>>().ok()?.solve_dense(&times).ok()?.0,
    };
    let time = start.elapsed();
    let drive = slide.drive();
    let at = |(i, t): (usize, &f64)| drive.force(*t, states.inner()[(V_Z, i)]);
    let force = std::iter::once(drive.force(0.0, 0.0)).chain(times.iter().enumerate().map(at)).collect();
    Some(Achieved { force, time })
}

/// A length along the direction `v` that keeps half of the digits: columns are asked for by unit vectors, states are of the
/// order of 1e-3 and the friction law bends at 1e-4.
fn increment(v: &[f64]) -> f64 {
    let length = libm::sqrt(v.iter().map(|x| x * x).sum());
    1e-9 / length.max(1e-300)
}
