//! `slipfit precision`: error against run time.

use std::{fmt::Write, path::PathBuf};

use clap::Args;
use serde::Serialize;
use slipfit_core::slide::CONTACTS;
use slipfit_system::files;
use slipfit_tolerance::number::{level, or_dash, three_digits};

use super::{
    arguments::{DriveArguments, Moving, SceneArguments},
    call,
    failure::Failure,
    stability::MapArguments,
    terminal::{given, print, print_json, progress, text_table},
};
use crate::{
    dynamics::deviation::Deviation,
    mechanism::ByDrive,
    quality::precision::{
        OPENING, Point, Problem, STROKE, Solver, Truth, measure, quickest_within, solvers, solvers_of, truth, truth_of,
    },
    setup::Scene,
    show::{export::precision_csv, precision::work_precision},
};

/// Measures error against run time of every integration scheme, step and number type.
///
/// For slides, and mechanisms with a drive. The error is that of the drive's force or torque every millisecond, in % of its peak, against
/// a far finer run. Explicit schemes are tried at finer steps, too, because they are stable only there. Of a mechanism the implicit
/// schemes are tried, in double precision.
///
/// For slides only: `--stability`.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    drive: DriveArguments,
    /// Tolerance level of the unit; positive is tighter.
    #[arg(long, default_value_t = 2.5, allow_hyphen_values = true)]
    n: f64,
    /// Writes every measured point as CSV.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draws error over run time as SVG.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    map: MapArguments,
}

#[derive(Serialize)]
struct Report<'a> {
    title: &'a str,
    n: f64,
    /// How well the truth is known, by problem (%).
    floors: Vec<Floor>,
    points: &'a [Point],
}

#[derive(Serialize)]
struct Floor {
    problem: &'static str,
    #[serde(flatten)]
    percent: Deviation,
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        if !self.n.is_finite() {
            return Err(Failure::Input(format!("--n is {}, allowed is any finite number", self.n)));
        }
        self.scene.check_outputs(&given([("--csv", &self.csv), ("--plot", &self.plot)]))?;
        let (title, Study { problems, points }) = match self.scene.load_moving(&[])? {
            Moving::Slide(scene) => {
                self.drive.refuse()?;
                if self.map.stability {
                    return self.map.run(&scene, self.scene.json, self.csv.as_deref(), self.plot.as_deref());
                }
                (scene.title.clone(), study(&scene, self.n)?)
            }
            Moving::Mechanism(mechanism) => {
                if self.map.stability {
                    return Err(Failure::Input("--stability is for slides on pins".into()));
                }
                let gaps = mechanism.gaps_at(&[self.n])?;
                (mechanism.title.clone(), study_of(&self.drive.of(&mechanism)?, &gaps)?)
            }
        };
        if let Some(path) = &self.csv {
            files::write(path, &precision_csv(&points)?)?;
        }
        call::picture(self.plot.as_deref(), "precision", || work_precision(&title, self.n, &problems, &points))?;
        if self.scene.json {
            let floor = |(problem, truth): &(Problem, Truth)| Floor { problem: problem.name, percent: truth.floor };
            let floors = problems.iter().map(floor).collect();
            print_json(&Report { title: &title, n: self.n, floors, points: &points })
        } else {
            print(&describe(&title, self.n, &problems, &points))
        }
    }
}

/// All that was measured.
struct Study {
    problems: Vec<(Problem, Truth)>,
    points: Vec<Point>,
}

/// One run after the other, so that they do not disturb each other's time.
fn study(scene: &Scene, n: f64) -> Result<Study, Failure> {
    let gaps = scene.gaps_at(&[n; CONTACTS]);
    let (mut problems, mut points) = (Vec::new(), Vec::new());
    for problem in [OPENING, STROKE] {
        let truth = truth(scene, &gaps, problem)?;
        points.extend(measured((problem, &truth), &solvers(scene, &gaps, problem))?);
        problems.push((problem, truth));
    }
    Ok(Study { problems, points })
}

/// The same of the unit of a mechanism with these `gaps` (m).
fn study_of(driven: &ByDrive, gaps: &[f64]) -> Result<Study, Failure> {
    let (problem, truth) = truth_of(driven, gaps)?;
    let points = measured((problem, &truth), &solvers_of(driven, gaps))?;
    Ok(Study { problems: vec![(problem, truth)], points })
}

/// Every setting of the `solvers`.
fn measured((problem, truth): (Problem, &Truth), solvers: &[Solver]) -> Result<Vec<Point>, Failure> {
    let count: usize = solvers.iter().map(|solver| solver.settings.len() * solver.scalars.len()).sum();
    let bar = progress("measuring", count);
    let mut points = Vec::with_capacity(count);
    for solver in solvers {
        for scalar in solver.scalars {
            for setting in &solver.settings {
                points.push(measure((problem, truth), (solver, *setting), *scalar)?);
                bar.inc(1);
            }
        }
    }
    bar.finish_and_clear();
    Ok(points)
}

fn describe(title: &str, n: f64, problems: &[(Problem, Truth)], points: &[Point]) -> String {
    let mut text = format!("{title}, n = {}, errors in % of the peak force\n", level(n));
    for (problem, truth) in problems {
        let here = || points.iter().filter(|point| point.problem == problem.name);
        let (name, milliseconds) = (problem.name, problem.duration * 1e3);
        let floor = three_digits(truth.floor.max);
        let _ = writeln!(text, "\n{name}, {milliseconds} ms; the truth is known to {floor} %\n");
        let rows: Vec<_> = here().map(row).collect();
        let heading = ["integrator", "scalar", "step", "run time, ms", "max", "rms", "max ≥ 50 ms", "rms ≥ 50 ms"];
        let _ = writeln!(text, "{}", text_table(&heading, &rows));
        for percent in [1.0, 0.1, 0.01] {
            let quickest = quickest_within(here(), percent).map(|point| {
                let time = three_digits(point.run_ms.unwrap_or_default());
                let setting = point.knob.typeset(point.setting);
                format!("{time} ms, {} at {setting}, {}", point.solver, point.scalar.name())
            });
            let _ = writeln!(text, "Quickest within {percent:4} %  {}", quickest.as_deref().unwrap_or("none"));
        }
    }
    text
}

fn row(point: &Point) -> Vec<String> {
    let blown = point.blew_up_at_s.map(|t| format!("blew up at {} ms", three_digits(t * 1e3)));
    let number = |x: Option<f64>| or_dash(x, three_digits);
    vec![
        point.solver.to_owned(),
        point.scalar.name().to_owned(),
        point.knob.typeset(point.setting),
        number(point.run_ms),
        blown.unwrap_or_else(|| number(point.max_percent)),
        number(point.rms_percent),
        number(point.late_max_percent),
        number(point.late_rms_percent),
    ]
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::{Floor, Report};
    use crate::{
        dynamics::{deviation::Deviation, simulate::ScalarKind},
        quality::precision::{Knob, Point},
        reference::json_fields,
    };

    /// Measuring takes minutes.
    #[test]
    fn the_guide_has_the_fields_of_its_json() {
        let percent = Deviation { max: 0.0, rms: 0.0, late_max: 0.0, late_rms: 0.0 };
        let point = Point {
            problem: "opening",
            solver: "rk4",
            scalar: ScalarKind::F32,
            knob: Knob::StepS,
            setting: 1e-3,
            run_ms: None,
            max_percent: None,
            rms_percent: None,
            late_max_percent: None,
            late_rms_percent: None,
            blew_up_at_s: None,
        };
        let report =
            Report { title: "", n: 0.0, floors: vec![Floor { problem: "opening", percent }], points: &[point] };
        let report = serde_json::to_value(&report).unwrap();
        let sorted = |mut fields: Vec<String>| {
            fields.sort();
            fields
        };
        let fields = |value: &Value| sorted(value.as_object().unwrap().keys().cloned().collect());
        // The version comes with printing.
        let documented: Vec<_> =
            json_fields("`precision`").into_iter().filter(|field| field != "json_version").collect();
        assert_eq!(fields(&report), sorted(documented));
        assert_eq!(fields(&report["floors"][0]), sorted(json_fields("floor")));
        assert_eq!(fields(&report["points"][0]), sorted(json_fields("point")));
    }
}
