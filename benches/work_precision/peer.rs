//! The slide as diffsol's solvers see it: thirteen first-order equations with the kernel's forces.

use std::cell::RefCell;

use diffsol::{MatrixCommon, NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod};
use slipfit_core::{
    SVector, Vector3,
    mechanism::Mechanism,
    pose::{Orientation, Pose},
};
use slipfit_problems::cd_rom::CdRomSlide;

use crate::Entry;

/// The name of diffsol's backward differentiation formulas.
pub const BDF: &str = "diffsol BDF";
const ESDIRK34: &str = "diffsol ESDIRK34";

/// Displacement (m), quaternion, velocity (m/s), angular velocity (rad/s).
const EQUATIONS: usize = 13;

/// Relative tolerances tried.
const RELATIVE: [f64; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];
/// Absolute tolerances of velocities tried (m/s, rad/s), and those of poses in their proportion (s).
const ABSOLUTE: [f64; 8] = [1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 1e-8];
const PROPORTION: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// How a column of the Jacobian is made.
#[derive(Clone, Copy, Debug)]
enum Difference {
    /// One evaluation, beside one for all columns.
    Forward,
    /// Two evaluations.
    Central,
}

/// Every solver with every tolerance and Jacobian.
pub fn entries(slide: &CdRomSlide<f64>, duration: f64) -> Vec<Entry> {
    let mut entries = Vec::new();
    for solver in [BDF, ESDIRK34] {
        for (relative, absolute) in RELATIVE.into_iter().flat_map(|r| ABSOLUTE.map(|a| (r, a))) {
            for (proportion, difference) in
                PROPORTION.into_iter().flat_map(|p| [Difference::Forward, Difference::Central].map(|d| (p, d)))
            {
                let tolerances = (relative, absolute, proportion);
                let slide = *slide;
                entries.push(Entry {
                    solver,
                    setting: format!("{relative:.0e} {absolute:.0e} {proportion:.0e} {difference:?}"),
                    work: Box::new(move || force(&slide, duration, solver, tolerances, difference)),
                });
            }
        }
    }
    entries
}

/// The drive force (N) every millisecond; `None` if the solver gives up.
fn force(
    slide: &CdRomSlide<f64>,
    duration: f64,
    solver: &str,
    (relative, absolute, proportion): (f64, f64, f64),
    difference: Difference,
) -> Option<Vec<f64>> {
    let mut tolerances = [absolute * proportion; EQUATIONS];
    tolerances[7..].fill(absolute);
    // The last state that was asked for and its rates: all columns of one Jacobian share them.
    let base = RefCell::new((f64::NAN, [0.0; EQUATIONS], [0.0; EQUATIONS]));
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(relative)
        .atol(tolerances)
        .h0(1e-5)
        .rhs_implicit(
            |y, _, t, dy| dy.copy_from_slice(&rates(slide, t, y)),
            |y, _, t, v, jv| match difference {
                Difference::Forward => {
                    let mut base = base.borrow_mut();
                    if base.0 != t || base.1 != *y {
                        base.0 = t;
                        base.1.copy_from_slice(y);
                        base.2 = rates(slide, t, y);
                    }
                    let h = increment(v);
                    let up = rates(slide, t, &moved(y, v, h));
                    jv.iter_mut().zip(up).zip(base.2).for_each(|((j, up), at)| *j = (up - at) / h);
                }
                Difference::Central => {
                    let h = increment(v);
                    let [up, down] = [h, -h].map(|h| rates(slide, t, &moved(y, v, h)));
                    jv.iter_mut().zip(up).zip(down).for_each(|((j, up), down)| *j = (up - down) / (2.0 * h));
                }
            },
        )
        .init(|_, _, y| y.copy_from_slice(&AT_REST), EQUATIONS)
        .build()
        .ok()?;
    let times: Vec<f64> = (1..=(duration * 1e3).round() as u32).map(|i| f64::from(i) * 1e-3).collect();
    let states = match solver {
        BDF => problem.bdf::<NalgebraLU<f64>>().ok()?.solve_dense(&times).ok()?.0,
        _ => problem.esdirk34::<NalgebraLU<f64>>().ok()?.solve_dense(&times).ok()?.0,
    };
    let drive = slide.drive();
    let at = |(i, t): (usize, &f64)| drive.force(*t, states.inner()[(9, i)]);
    Some(std::iter::once(drive.force(0.0, 0.0)).chain(times.iter().enumerate().map(at)).collect())
}

/// The nominal pose, without motion.
const AT_REST: [f64; EQUATIONS] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

/// A length along the direction `v` that keeps half of the digits: columns are asked for by unit vectors, states are of the
/// order of 1e-3 and the friction law bends at 1e-4.
fn increment(v: &[f64]) -> f64 {
    let length = libm::sqrt(v.iter().map(|x| x * x).sum());
    1e-9 / length.max(1e-300)
}

fn moved(y: &[f64], v: &[f64], h: f64) -> [f64; EQUATIONS] {
    std::array::from_fn(|i| y[i] + h * v[i])
}

/// The right-hand side: q̇ = ½ q∘ω, M·v̇ = force.
fn rates(slide: &CdRomSlide<f64>, t: f64, y: &[f64]) -> [f64; EQUATIONS] {
    let vector = |i: usize| Vector3::new(y[i], y[i + 1], y[i + 2]);
    let orientation = Orientation { w: y[3], v: vector(4) };
    let pose = Pose { displacement_w: vector(0), orientation };
    let velocity = SVector::<f64, 6>::from_fn(|i, _| y[7 + i]);
    // So far along the slope that nothing of it is lost beside the orientation itself.
    let far = 1024.0 * 1024.0 * 1024.0;
    let turned = slide.moved(&pose, &velocity, far).orientation;
    let force = slide.evaluated(t, &pose, &slide.fresh(), &velocity, 1.0, 1.0).force;
    let acceleration = slide.velocity(&force);
    let mut rates = [0.0; EQUATIONS];
    rates[..3].copy_from_slice(&[y[7], y[8], y[9]]);
    rates[3] = (turned.w - orientation.w) / far;
    rates[4..7].copy_from_slice(((turned.v - orientation.v) / far).as_slice());
    rates[7..].copy_from_slice(acceleration.as_slice());
    rates
}
