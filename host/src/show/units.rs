//! Pictures of a population.

use slipfit_tolerance::number::percent;

use crate::population::{
    hypothesis::{AtDistance, Hypothesis},
    statistics::Share,
    subject::Subject,
    tally::Tally,
};
use crate::{
    dynamics::{driven::DriveKind, outcome::Verdict},
    show::plot::{Chart, Look, Markers, Panel, PlotError, Series, Shape, line_chart},
};

/// The most units that a picture marks.
const MARKED: usize = 1500;
/// Classes of tightness.
const CLASSES: usize = 16;
/// Units that a class needs to be shown.
const LEAST: u64 = 20;

/// What pictures call the greatest force or torque of a drive of this `kind`.
pub fn effort(kind: DriveKind) -> String {
    format!("greatest drive {} ({})", kind.effort(), kind.effort_unit())
}

/// The greatest force or torque of the units of `subject`, counted in `tally`, over their tightness, with those that malfunction
/// marked; and the share of these. `limit` (N, N·m) is the motor's greatest.
///
/// # Errors
/// [`PlotError`], if there is nothing to show.
pub fn forces(subject: &dyn Subject, tally: &Tally, limit: Option<f64>) -> Result<String, PlotError> {
    let first = tally.first_units();
    let marks = first.iter().take(MARKED);
    let marks: Vec<_> = marks.map(|unit| (subject.tightness(&unit.gaps), unit.outcome)).collect();
    let marked = |verdict: Verdict, label: &str, shape| {
        let own = marks.iter().filter(|(_, outcome)| outcome.verdict == verdict);
        let points = own.filter_map(|(n, outcome)| Some((*n, outcome.peak_force?))).collect();
        Markers { label: label.into(), shape, points }
    };
    let (all, failing) = (&tally.figures.tightness, &tally.figures.failing_tightness);
    let [low, high] = all.ends().ok_or(PlotError::Empty)?;
    let limits = limit.map(|limit| Series {
        label: String::new(),
        look: Look::Guide,
        points: vec![(low, limit), (high, limit)],
    });
    let class = |k: usize| [k, k + 1].map(|k| low + (high - low) * k as f64 / CLASSES as f64);
    let shares: Vec<(f64, Share)> = (0..CLASSES)
        .filter_map(|k| {
            let [from, to] = class(k);
            let [own, failed] = [all, failing].map(|units| units.below(to) - units.below(from));
            (own >= LEAST).then(|| ((from + to) / 2.0, Share::new(failed, own)))
        })
        .collect();
    let units = tally.counts.units;
    let failed = Share::new(tally.counts.malfunctions, units.max(1));
    let left = marks.len() as u64 != units;
    let remark = if left { format!("; the first {} are marked", marks.len()) } else { String::new() };
    line_chart(&Chart {
        title: subject.title().into(),
        subtitle: format!("{units} units, {} % malfunction{remark}", percent(failed.share, 1)),
        x_label: "tightness (σ, mean over the gaps; positive is tighter)".into(),
        panels: [
            Some(Panel {
                y_label: effort(subject.kind()),
                series: limits.into_iter().collect(),
                markers: vec![
                    marked(Verdict::Runs, "runs", Shape::Ring),
                    marked(Verdict::Crawls, "crawls", Shape::Triangle),
                    marked(Verdict::Jammed, "jammed", Shape::Cross),
                    marked(Verdict::Overruns, "overruns", Shape::Dot),
                ],
                ..Panel::default()
            }),
            // Of few units no class has enough.
            (!shares.is_empty()).then(|| Panel {
                y_label: "share that malfunctions (%)".into(),
                note: "grey: 95 % interval".into(),
                series: with_interval(&shares, "units"),
                ..Panel::default()
            }),
        ]
        .into_iter()
        .flatten()
        .collect(),
        ..Chart::default()
    })
}

/// Shares (%) over a place, with the ends of their intervals as guides.
pub(super) fn with_interval(shares: &[(f64, Share)], label: &str) -> Vec<Series> {
    let line = |label: &str, look, of: &dyn Fn(&Share) -> f64| Series {
        label: label.into(),
        look,
        points: shares.iter().map(|(x, share)| (*x, 100.0 * of(share))).collect(),
    };
    vec![
        line("", Look::Guide, &|share| share.interval[0]),
        line("", Look::Guide, &|share| share.interval[1]),
        line(label, Look::Kind(0), &|share| share.share),
    ]
}

/// Malfunction by distance from the mean unit: of random combinations, of the tightest and of the loosest.
///
/// # Errors
/// [`PlotError`], if there is nothing to show.
pub fn hypothesis(title: &str, tested: &Hypothesis) -> Result<String, PlotError> {
    let shares: Vec<(f64, Share)> = tested.distances.iter().map(|at| (at.distance, at.random)).collect();
    // Apart, so that neither hides the other.
    let side = |label: &str, shape, apart: f64, failed: fn(&AtDistance) -> bool| Markers {
        label: label.into(),
        shape,
        points: tested.distances.iter().map(|at| (at.distance + apart, if failed(at) { 100.0 } else { 0.0 })).collect(),
    };
    line_chart(&Chart {
        title: title.into(),
        subtitle: "random units against the tightest and the loosest one as far from the mean unit".into(),
        x_label: "distance from the mean unit (root mean square of the gaps, σ)".into(),
        panels: vec![Panel {
            y_label: "share that malfunctions (%)".into(),
            series: with_interval(&shares, "random"),
            markers: vec![
                side("tightest unit", Shape::Triangle, 0.03, |at| at.tight_malfunctions),
                side("loosest unit", Shape::Square, -0.03, |at| at.loose_malfunctions),
            ],
            ..Panel::default()
        }],
        ..Chart::default()
    })
}
