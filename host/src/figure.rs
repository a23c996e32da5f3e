//! The figures of a sweep: the paper's Figs. 8 and 9, and the force that a level needs.

use crate::{
    number::{level, typeset},
    outcome::{Outcome, Trajectory, Verdict},
    plot::{Chart, Look, Markers, Panel, PlotError, Scale, Series, Shape, line_chart},
    sweep::{Level, Sweep},
};

/// Velocity over time at every level (Fig. 8) as SVG.
///
/// # Errors
/// [`PlotError`], if the sweep is empty or not finite.
pub fn figure_8(sweep: &Sweep, title: &str) -> Result<String, PlotError> {
    over_time(sweep, title, "velocity of the slide", "mm/s", |run| run.vz.iter().map(|v| v * 1e3).collect())
}

/// Drive force over time at every level (Fig. 9) as SVG.
///
/// # Errors
/// [`PlotError`], if the sweep is empty or not finite.
pub fn figure_9(sweep: &Sweep, title: &str) -> Result<String, PlotError> {
    over_time(sweep, title, "drive force", "N", |run| run.force.clone())
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

/// Peak force and breakaway time over the levels as SVG, the marks telling the verdicts.
///
/// # Errors
/// [`PlotError`], if the sweep is empty or not finite.
pub fn required_force(sweep: &Sweep, title: &str) -> Result<String, PlotError> {
    let force = over_n(sweep, "peak drive force (N)", |outcome| outcome.peak_force);
    let mut breakaway = over_n(sweep, "breakaway (ms)", |outcome| outcome.breakaway.map(|t| t * 1e3));
    // The legend above the forces serves both panels.
    breakaway.markers.iter_mut().for_each(|markers| markers.label.clear());
    line_chart(&Chart {
        title: title.to_owned(),
        subtitle: format!("required force and breakaway, {}", levels(sweep)),
        x_label: "tolerance level n".to_owned(),
        scale: Scale::Linear,
        panels: vec![force, breakaway],
    })
}

/// A guide line broken where a level has no value, and the values marked by verdict.
fn over_n(sweep: &Sweep, y_label: &str, value: impl Fn(&Outcome) -> Option<f64>) -> Panel {
    let values: Vec<Option<(f64, f64)>> =
        sweep.levels.iter().map(|level| value(&level.outcome).map(|value| (level.n, value))).collect();
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
        points: sweep
            .levels
            .iter()
            .zip(&values)
            .filter(|(level, _)| level.outcome.verdict == verdict)
            .filter_map(|(_, value)| *value)
            .collect(),
    };
    let shapes = [
        (Verdict::Runs, Shape::Dot),
        (Verdict::Crawls, Shape::Triangle),
        (Verdict::Jammed, Shape::Cross),
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
        Verdict::Undecided => "undecided",
    }
}

#[cfg(test)]
mod tests {
    use super::{figure_8, figure_9, required_force};
    use crate::{example, outcome::Verdict, scene::LevelRange};

    #[test]
    fn figures_of_a_sweep() {
        let mut sweep = example::sweep(LevelRange { first: -1.0, step: 1.75, count: 3 }, 0.1, 0.1);
        sweep.levels[0].outcome.verdict = Verdict::Jammed;
        sweep.levels[0].outcome.breakaway = None;
        for (svg, words) in [
            (figure_8(&sweep, "a slide"), ["velocity of the slide (mm/s)", "n = +2.5"]),
            (figure_9(&sweep, "a slide"), ["drive force (N)", "n = \u{2212}1"]),
            (required_force(&sweep, "a slide"), ["peak drive force (N)", "jammed"]),
        ] {
            let svg = svg.unwrap();
            let document = roxmltree::Document::parse(&svg).unwrap();
            for word in words {
                let found = document.descendants().filter_map(|node| node.text()).any(|text| text.trim() == word);
                assert!(found, "{word}");
            }
        }
        sweep.levels.truncate(1);
        assert!(required_force(&sweep, "a slide").is_ok());
        sweep.levels.clear();
        assert!(figure_8(&sweep, "a slide").is_err());
    }
}
