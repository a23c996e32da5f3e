//! The figures of a sweep, velocity and force over time (the paper's Figs. 8 and 9) and verdict and force over n, and those
//! of one unit.

use slipfit_tolerance::number::{level, ten_digits, typeset};

use super::plot::{Chart, Look, Markers, Panel, PlotError, Scale, Series, Shape, line_chart};
use crate::{
    dynamics::{
        driven::DriveKind,
        outcome::{Outcome, Verdict},
        sweep::{Level, Sweep},
        trajectory::Trajectory,
    },
    mechanism::Samples,
};

/// Velocity over time at every level as SVG.
///
/// # Errors
/// [`PlotError`], if the sweep is empty or not finite.
pub fn velocities(sweep: &Sweep, title: &str) -> Result<String, PlotError> {
    let kind = sweep.kind;
    let speeds = |run: &Trajectory| run.vz.iter().map(|v| kind.speed(*v)).collect();
    over_time(sweep, title, kind.choose("speed", "angular velocity"), kind.speed_unit(), speeds)
}

/// Drive force or torque over time at every level as SVG.
///
/// # Errors
/// [`PlotError`], if the sweep is empty or not finite.
pub fn forces(sweep: &Sweep, title: &str) -> Result<String, PlotError> {
    let quantity = format!("drive {}", sweep.kind.effort());
    over_time(sweep, title, &quantity, sweep.kind.effort_unit(), |run| run.force.clone())
}

/// Velocity and drive force of one unit over time as SVG.
///
/// # Errors
/// [`PlotError`], if the run has no sample or is not finite.
pub fn unit_over_time(run: &Trajectory, title: &str, n: &[f64]) -> Result<String, PlotError> {
    let panel = |y_label: &str, values: Vec<f64>| Panel {
        y_label: y_label.to_owned(),
        series: vec![Series {
            label: String::new(),
            look: Look::Level(n.first().copied().unwrap_or_default()),
            points: run.t.iter().map(|t| t * 1e3).zip(values).collect(),
        }],
        ..Panel::default()
    };
    let n = match n {
        [one] => level(*one),
        _ => "one for each gap".to_owned(),
    };
    line_chart(&Chart {
        title: title.to_owned(),
        subtitle: format!("one unit, n = {}", typeset(&n)),
        x_label: "time (ms)".to_owned(),
        scale: Scale::Linear,
        panels: vec![
            panel("speed (mm/s)", run.vz.iter().map(|v| v * 1e3).collect()),
            panel("drive force (N)", run.force.clone()),
        ],
    })
}

/// The named columns of a mechanism's run over time as SVG, a panel each; `n` is told.
///
/// # Errors
/// [`PlotError`], if the run has no sample or is not finite.
pub fn columns_over_time(samples: &Samples, columns: &[String], title: &str, of: &str) -> Result<String, PlotError> {
    let panel = |name: &String| {
        let column = samples.columns.iter().position(|one| one == name).unwrap_or_default();
        let points = samples.rows.iter().map(|row| (row[0] * 1e3, row[column])).collect();
        let series = vec![Series { label: String::new(), look: Look::Level(0.0), points }];
        Panel { y_label: name.clone(), series, ..Panel::default() }
    };
    line_chart(&Chart {
        title: title.to_owned(),
        subtitle: format!("one unit, {}", typeset(of)),
        x_label: "time (ms)".to_owned(),
        scale: Scale::Linear,
        panels: columns.iter().map(panel).collect(),
    })
}

fn over_time(
    sweep: &Sweep,
    title: &str,
    quantity: &str,
    unit: &str,
    values: impl Fn(&Trajectory) -> Vec<f64>,
) -> Result<String, PlotError> {
    let line = |of: &Level| Series {
        label: format!("n = {}", typeset(&level(of.n))),
        look: Look::Level(of.n),
        points: of.trajectory.t.iter().map(|t| t * 1e3).zip(values(&of.trajectory)).collect(),
    };
    let series = sweep.levels.iter().map(line).collect();
    line_chart(&Chart {
        title: title.to_owned(),
        subtitle: format!("{quantity} over time, {}", levels(sweep)),
        x_label: "time (ms)".to_owned(),
        scale: Scale::Linear,
        panels: vec![Panel { y_label: format!("{quantity} ({unit})"), series, ..Panel::default() }],
    })
}

/// Peak force and breakaway time over the levels as SVG, the marks telling the verdicts, with the share of the production at
/// each level behind the forces: n counts standard deviations, so that it is the standard normal density.
///
/// # Errors
/// [`PlotError`], if the sweep is empty or not finite.
pub fn verdicts(sweep: &Sweep, title: &str) -> Result<String, PlotError> {
    let kind = sweep.kind;
    let peak = format!("peak drive {} ({})", kind.effort(), kind.effort_unit());
    let mut force = over_n(sweep, &peak, |outcome| outcome.peak_force);
    let mut breakaway = over_n(sweep, "breakaway (ms)", |outcome| outcome.breakaway.map(|t| t * 1e3));
    if let (Some(first), Some(last)) = (sweep.levels.first(), sweep.levels.last()) {
        const POINTS: usize = 120;
        let place = |i: usize| first.n + (last.n - first.n) * i as f64 / POINTS as f64;
        force.shade = (0..=POINTS).map(place).map(|n| (n, 0.9 * libm::exp(-0.5 * n * n))).collect();
    }
    // The legend above the forces serves both panels.
    breakaway.markers.iter_mut().for_each(|markers| markers.label.clear());
    // Nothing breaks away where everything jams.
    let panels = if breakaway.points().next().is_some() { vec![force, breakaway] } else { vec![force] };
    line_chart(&Chart {
        title: title.to_owned(),
        subtitle: format!(
            "verdict and {}, {}; behind, how a single gap is distributed over n",
            kind.effort(),
            levels(sweep)
        ),
        x_label: "tolerance level n".to_owned(),
        scale: Scale::Linear,
        panels,
    })
}

/// A key that is swept.
#[derive(Clone, Copy, Debug)]
pub struct OverKey<'a> {
    /// Its name.
    pub name: &'a str,
    /// How many values.
    pub count: usize,
}

/// What happens at some values of the keys.
#[derive(Clone, Debug)]
pub struct Swept {
    /// Of each key.
    pub values: Vec<f64>,
    /// Of the unit.
    pub verdict: Verdict,
    /// Its greatest effort (N, N·m), if it has one.
    pub peak: Option<f64>,
    /// Share of the production that malfunctions (%), if it was asked for.
    pub malfunction: Option<f64>,
}

/// The greatest effort of a unit, and the share of the production that malfunctions where it is known, over one key as SVG; over two, a line
/// for each value of the second.
///
/// # Errors
/// [`PlotError`], if there is nothing to show or it is not finite.
pub fn over_keys(keys: &[OverKey], points: &[Swept], kind: DriveKind, title: &str) -> Result<String, PlotError> {
    let [first, second] =
        [keys.first().ok_or(PlotError::Empty)?, keys.get(1).unwrap_or(&OverKey { name: "", count: 1 })];
    let line = |k: usize, value: &dyn Fn(&Swept) -> Option<f64>| {
        let own = points.iter().skip(k).step_by(second.count.max(1));
        let label = |point: &Swept| format!("{} = {}", second.name, ten_digits(point.values[1]));
        // Colours as of levels, from the first value to the last.
        let place = 6.0 * k as f64 / second.count.saturating_sub(1).max(1) as f64 - 3.0;
        Series {
            label: if keys.len() > 1 { points.get(k).map(label).unwrap_or_default() } else { String::new() },
            look: if keys.len() > 1 { Look::Level(place) } else { Look::Level(0.0) },
            points: own.filter_map(|point| Some((point.values[0], value(point)?))).collect(),
        }
    };
    let lines = |value: &dyn Fn(&Swept) -> Option<f64>| (0..second.count).map(|k| line(k, value)).collect::<Vec<_>>();
    let effort = format!("peak drive {} ({})", kind.effort(), kind.effort_unit());
    let mut force = if keys.len() > 1 {
        Panel { y_label: effort, series: lines(&|point| point.peak), ..Panel::default() }
    } else {
        let judged: Vec<Judged> = points.iter().map(|point| (point.values[0], point.verdict, point.peak)).collect();
        marked(&judged, &effort)
    };
    let mut panels = Vec::new();
    if points.iter().any(|point| point.malfunction.is_some()) {
        let y_label = "units that malfunction (%)".to_owned();
        panels.push(Panel { y_label, series: lines(&|point| point.malfunction), ..Panel::default() });
        // One legend serves both panels.
        force.series.iter_mut().for_each(|series| series.label.clear());
    }
    panels.insert(0, force);
    line_chart(&Chart {
        title: title.to_owned(),
        subtitle: format!("over {}", keys.iter().map(|key| key.name).collect::<Vec<_>>().join(" and ")),
        x_label: first.name.to_owned(),
        scale: Scale::Linear,
        panels,
    })
}

fn over_n(sweep: &Sweep, y_label: &str, value: impl Fn(&Outcome) -> Option<f64>) -> Panel {
    let judged = |level: &Level| (level.n, level.outcome.verdict, value(&level.outcome));
    marked(&sweep.levels.iter().map(judged).collect::<Vec<_>>(), y_label)
}

/// A level, its verdict and what is shown of it.
pub type Judged = (f64, Verdict, Option<f64>);

/// A guide line broken where a level has no value, and the values marked by verdict.
fn marked(levels: &[Judged], y_label: &str) -> Panel {
    let values: Vec<Option<(f64, f64)>> = levels.iter().map(|(n, _, value)| value.map(|value| (*n, value))).collect();
    let series = values
        .split(Option::is_none)
        .map(|part| Series {
            label: String::new(),
            look: Look::Guide,
            points: part.iter().flatten().copied().collect(),
        })
        .collect();
    let marks = |(verdict, shape)| Markers {
        label: word(verdict).to_owned(),
        shape,
        points: levels
            .iter()
            .zip(&values)
            .filter(|(level, _)| level.1 == verdict)
            .filter_map(|(_, value)| *value)
            .collect(),
    };
    let shapes = [
        (Verdict::Runs, Shape::Dot),
        (Verdict::Crawls, Shape::Triangle),
        (Verdict::Jammed, Shape::Cross),
        (Verdict::Overruns, Shape::Square),
        (Verdict::Undecided, Shape::Ring),
    ];
    Panel { y_label: y_label.to_owned(), series, markers: shapes.map(marks).into(), ..Panel::default() }
}

fn levels(sweep: &Sweep) -> String {
    match sweep.levels.as_slice() {
        [one] => format!("n = {}", typeset(&level(one.n))),
        [first, .., last] => format!(
            "{} tolerance levels from n = {} (looser) to {} (tighter)",
            sweep.levels.len(),
            typeset(&level(first.n)),
            typeset(&level(last.n))
        ),
        [] => String::new(),
    }
}

/// A verdict as people read it.
pub(crate) fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Runs => "runs",
        Verdict::Crawls => "crawls",
        Verdict::Jammed => "jammed",
        Verdict::Overruns => "overruns",
        Verdict::Undecided => "undecided",
    }
}

#[cfg(test)]
mod tests {
    use super::{forces, unit_over_time, velocities, verdicts};
    use crate::{
        dynamics::{example, outcome::Verdict},
        setup::LevelRange,
    };

    #[test]
    fn figures_of_a_sweep() {
        let mut sweep = example::sweep(LevelRange { first: -1.0, step: 1.75, count: 3 }, 0.1, 0.1);
        sweep.levels[0].outcome.verdict = Verdict::Jammed;
        sweep.levels[0].outcome.breakaway = None;
        for (svg, words) in [
            (velocities(&sweep, "a slide"), ["speed (mm/s)", "n = +2.5"]),
            (forces(&sweep, "a slide"), ["drive force (N)", "n = \u{2212}1"]),
            (verdicts(&sweep, "a slide"), ["peak drive force (N)", "jammed"]),
        ] {
            let svg = svg.unwrap();
            let document = roxmltree::Document::parse(&svg).unwrap();
            for word in words {
                let found = document.descendants().filter_map(|node| node.text()).any(|text| text.trim() == word);
                assert!(found, "{word}");
            }
        }
        let unit = unit_over_time(&sweep.levels[0].trajectory, "a slide", &[-1.0]).unwrap();
        assert!(unit.contains("n = \u{2212}1") && unit.contains("drive force (N)"));
        sweep.levels.truncate(1);
        assert!(verdicts(&sweep, "a slide").is_ok());
        sweep.levels.clear();
        assert!(velocities(&sweep, "a slide").is_err());
    }
}
