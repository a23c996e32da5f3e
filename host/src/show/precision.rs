//! The work-precision plot.

use slipfit_tolerance::number::{level, typeset};

use crate::quality::precision::{Point, Problem, Truth};
use crate::{
    dynamics::simulate::ScalarKind,
    show::{
        layout::extent,
        plot::{Chart, Look, Panel, PlotError, Scale, Series, line_chart},
    },
};

/// Errors (%) above this are as good as a run that blew up: they are named, not drawn.
const LOST: f64 = 100.0;

/// Greatest error over run time as SVG: a panel for each problem, a line for each solver with a mark for each setting,
/// thin in single precision. A grey line shows how well the truth is known.
///
/// # Errors
/// [`PlotError`], if there is nothing to plot.
pub fn work_precision(
    title: &str,
    n: f64,
    problems: &[(Problem, Truth)],
    points: &[Point],
) -> Result<String, PlotError> {
    let mut names: Vec<&str> = Vec::new();
    for point in points {
        if !names.contains(&point.solver) {
            names.push(point.solver);
        }
    }
    let panels = problems.iter().map(|(problem, truth)| {
        let here: Vec<&Point> = points.iter().filter(|point| point.problem == problem.name).collect();
        panel(problem, truth, &names, &here)
    });
    line_chart(&Chart {
        title: title.into(),
        subtitle: format!(
            "error against run time, n = {}: a mark for each setting; thick f64, thin f32; grey: how well the truth is known",
            typeset(&level(n))
        ),
        x_label: "run time of the integration (ms)".to_owned(),
        scale: Scale::Log,
        panels: panels.collect(),
    })
}

fn panel(problem: &Problem, truth: &Truth, names: &[&str], points: &[&Point]) -> Panel {
    let floor = truth.floor.max.max(f64::MIN_POSITIVE);
    let mut series = Vec::new();
    let mut lost = Vec::new();
    for (number, name) in names.iter().enumerate() {
        for (scalar, look) in [(ScalarKind::F32, Look::Variant(number)), (ScalarKind::F64, Look::Kind(number))] {
            let own = || points.iter().filter(|point| point.solver == *name && point.scalar == scalar);
            let drawn: Vec<(f64, f64)> = own().filter_map(|point| place(point, floor)).collect();
            let missing = own().filter(|point| place(point, floor).is_none()).map(|point| point.setting);
            if let (ScalarKind::F64, Some(least)) = (scalar, missing.reduce(f64::min)) {
                let knob = own().next().map(|point| point.knob.typeset(least));
                lost.push(format!("{name} ≥ {}", knob.unwrap_or_default()));
            }
            if !drawn.is_empty() {
                series.push(Series { label: (*name).to_owned(), look, points: drawn });
            }
        }
    }
    let ends = extent(series.iter().flat_map(|series| &series.points).map(|(x, _)| *x));
    if let Some((first, last)) = ends {
        series.push(Series { label: String::new(), look: Look::Guide, points: vec![(first, floor), (last, floor)] });
    }
    let note = if lost.is_empty() { String::new() } else { format!("off by more than {LOST} %: {}", lost.join(", ")) };
    Panel { y_label: format!("{}, max error (% of the peak force)", problem.name), note, series, ..Panel::default() }
}

/// Where a point is drawn; `None` for one that is lost.
fn place(point: &Point, floor: f64) -> Option<(f64, f64)> {
    let error = point.max_percent.filter(|error| *error <= LOST)?;
    Some((point.run_ms?, error.max(floor * 1e-3)))
}
