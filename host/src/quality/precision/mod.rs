//! Error against run time: every solver at every setting, measured against a far finer run.

mod solver;

use std::time::{Duration, Instant};

use serde::Serialize;

pub use solver::{EVERY, Knob, Problem, Solver, Timed, solvers, solvers_of};

use crate::{
    dynamics::{
        deviation::Deviation,
        simulate::{ScalarKind, Settings, SimulateError},
    },
    mechanism::{ByDrive, run},
    setup::Scene,
};
use solver::{run_of, to, whole};

/// Error of force (N) that a step of the finest run may make.
const FINEST: f64 = 1e-9;
/// The same of a mechanism, as a share of its own speed.
const FINEST_SHARE: f64 = 1e-9;

/// The paper's first 200 ms.
pub const OPENING: Problem = Problem { name: "opening", duration: 0.2 };
/// Until the full speed is reached.
pub const STROKE: Problem = Problem { name: "stroke", duration: 1.5 };

/// What every run of a problem is compared with.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Drive force (N), or torque (N·m), every millisecond.
    pub force: Vec<f64>,
    /// How far a run at ten times the tolerance is off: errors below are not known.
    pub floor: Deviation,
}

/// One solver at one setting on one problem.
#[derive(Clone, Debug, Serialize)]
pub struct Point {
    /// The problem's name.
    pub problem: &'static str,
    /// The solver's name.
    pub solver: &'static str,
    /// Number type.
    pub scalar: ScalarKind,
    /// What `setting` is.
    pub knob: Knob,
    /// The solver's setting, in the knob's unit.
    pub setting: f64,
    /// The least run time of the integration alone (ms); `None` for a run that blew up.
    pub run_ms: Option<f64>,
    /// Greatest error (% of the peak force).
    pub max_percent: Option<f64>,
    /// Root mean square of the error (%).
    pub rms_percent: Option<f64>,
    /// Greatest error for t ≥ 50 ms (%).
    pub late_max_percent: Option<f64>,
    /// Root mean square of the error for t ≥ 50 ms (%).
    pub late_rms_percent: Option<f64>,
    /// When the motion left the finite range (s); `None` if it did not.
    pub blew_up_at_s: Option<f64>,
}

/// The motion that ever finer runs of the desk tend to, and how well it is known.
///
/// # Errors
/// See [`SimulateError`].
pub fn truth(scene: &Scene, gaps: &[f64], problem: Problem) -> Result<Truth, SimulateError> {
    let force = |tolerance| {
        let settings = Settings::desk(scene, EVERY).to(tolerance);
        run_of(scene, gaps, problem.duration, settings).map(|run| run.trajectory.force)
    };
    let (fine, finest) = (force(10.0 * FINEST)?, force(FINEST)?);
    let floor = Deviation::between(&fine, &finest);
    Ok(Truth { force: finest, floor })
}

/// The same of the unit of a mechanism with these `gaps` (m), over its whole duration.
///
/// # Errors
/// See [`SimulateError`].
pub fn truth_of(driven: &ByDrive, gaps: &[f64]) -> Result<(Problem, Truth), SimulateError> {
    let mechanism = whole(driven);
    let force = |share| -> Result<Vec<f64>, SimulateError> {
        Ok(run(&to(&mechanism, share), gaps, EVERY)?.trajectories.swap_remove(driven.index()).force)
    };
    let (fine, finest) = (force(10.0 * FINEST_SHARE)?, force(FINEST_SHARE)?);
    let floor = Deviation::between(&fine, &finest);
    Ok((Problem { name: "run", duration: mechanism.run.duration }, Truth { force: finest, floor }))
}

/// Runs `solver` at `setting` again and again until the least run time can be trusted.
///
/// # Errors
/// See [`SimulateError`]; a motion that leaves the finite range is a finding, not an error.
pub fn measure(
    (problem, truth): (Problem, &Truth),
    (solver, setting): (&Solver, f64),
    scalar: ScalarKind,
) -> Result<Point, SimulateError> {
    let blank = Point {
        problem: problem.name,
        solver: solver.name,
        scalar,
        knob: solver.knob,
        setting,
        run_ms: None,
        max_percent: None,
        rms_percent: None,
        late_max_percent: None,
        late_rms_percent: None,
        blew_up_at_s: None,
    };
    match quickest(|| solver.run(setting, scalar)) {
        Ok(run) => {
            let error = Deviation::between(&run.force, &truth.force);
            Ok(Point {
                run_ms: Some(run.integration.as_secs_f64() * 1e3),
                max_percent: Some(error.max),
                rms_percent: Some(error.rms),
                late_max_percent: Some(error.late_max),
                late_rms_percent: Some(error.late_rms),
                ..blank
            })
        }
        Err(SimulateError::NotFinite { time, .. }) => Ok(Point { blew_up_at_s: Some(time), ..blank }),
        Err(error) => Err(error),
    }
}

/// The quickest of at least 5 runs and 50 ms, unless these take more than a second.
fn quickest(run: impl Fn() -> Result<Timed, SimulateError>) -> Result<Timed, SimulateError> {
    let start = Instant::now();
    let mut best = run()?;
    let mut count = 1;
    loop {
        let spent = start.elapsed();
        if spent >= Duration::from_secs(1) || (count >= 5 && spent >= Duration::from_millis(50)) {
            return Ok(best);
        }
        best.integration = best.integration.min(run()?.integration);
        count += 1;
    }
}

/// The quickest point of `points` whose greatest error is at most `percent`.
pub fn quickest_within<'a>(points: impl IntoIterator<Item = &'a Point>, percent: f64) -> Option<&'a Point> {
    let within = points.into_iter().filter(|point| point.max_percent.is_some_and(|error| error <= percent));
    within.min_by(|a, b| a.run_ms.unwrap_or(f64::INFINITY).total_cmp(&b.run_ms.unwrap_or(f64::INFINITY)))
}

#[cfg(test)]
mod tests {
    use slipfit_core::{menu::FrictionData, slide::CONTACTS};

    use super::*;
    use crate::dynamics::{example, scheme::IntegratorKind};
    use crate::show::precision::work_precision;

    const SHORT: Problem = Problem { name: "opening", duration: 0.06 };

    #[test]
    fn errors_fall_with_the_step_and_stay_above_the_floor() {
        let scene = example::cd_rom();
        let gaps = scene.gaps_at(&[2.5; CONTACTS]);
        let truth = truth(&scene, &gaps, SHORT).unwrap();
        assert!(truth.force.len() == 61 && truth.floor.max < 0.01, "{:?}", truth.floor);
        let solvers = solvers(&scene, &gaps, SHORT);
        let of = |name: &str, setting| {
            let solver = solvers.iter().find(|solver| solver.name == name).unwrap();
            measure((SHORT, &truth), (solver, setting), ScalarKind::F64).unwrap()
        };
        let points = [1e-3, 1e-4, 1e-5].map(|step| of("extrapolated", step));
        assert!(points.windows(2).all(|pair| pair[1].max_percent < pair[0].max_percent), "{points:?}");
        assert!(points.windows(2).all(|pair| pair[1].run_ms > pair[0].run_ms), "{points:?}");
        assert_eq!(quickest_within(&points, points[1].max_percent.unwrap()).unwrap().setting, 1e-4);
        assert!(quickest_within(&points, 0.0).is_none());
        // An explicit scheme far beyond its stable step.
        let lost = of("rk4", 1e-3);
        assert!(lost.blew_up_at_s.is_some() || lost.max_percent.unwrap() > 10.0, "{lost:?}");
        let svg = work_precision(&scene.title, 2.5, &[(SHORT, truth)], &points).unwrap();
        assert!(svg.contains("extrapolated") && svg.contains("opening"));
    }

    #[test]
    fn exact_friction_is_for_implicit_solvers() {
        let mut scene = example::cd_rom();
        let gaps = scene.gaps_at(&[0.0; CONTACTS]);
        assert_eq!(solvers(&scene, &gaps, SHORT).len(), IntegratorKind::ALL.len() + 1, "and error control");
        scene.friction = FrictionData::Exact { coefficient: 0.3 };
        let names: Vec<_> = solvers(&scene, &gaps, SHORT).iter().map(|solver| solver.name).collect();
        assert!(names.contains(&"sdirk2") && !names.contains(&"rk4"), "{names:?}");
    }
}
