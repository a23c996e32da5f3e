//! Pictures of a population.

use super::{
    Unit,
    hypothesis::{AtDistance, Hypothesis},
    statistics::{Share, malfunctions},
    subject::Subject,
};
use crate::{
    dynamics::{driven::DriveKind, outcome::Verdict},
    show::{
        number::fixed,
        plot::{Chart, Look, Markers, Panel, PlotError, Series, Shape, line_chart},
    },
};

/// The most units that a picture marks.
const MARKED: usize = 1500;
/// Classes of tightness.
const CLASSES: usize = 16;
/// Units that a class needs to be shown.
const LEAST: usize = 20;

/// The `units` of `subject`, each with its tightness.
pub fn placed<'u, S: Subject>(
    subject: &S,
    units: impl IntoIterator<Item = &'u Unit<S::Gaps>>,
) -> Vec<(f64, &'u Unit<S::Gaps>)>
where
    S::Gaps: 'u,
{
    units.into_iter().map(|unit| (subject.tightness(&unit.gaps), unit)).collect()
}

/// What pictures call the greatest force or torque of a drive of this `kind`.
pub fn effort(kind: DriveKind) -> String {
    format!("greatest drive {} ({})", kind.effort(), kind.effort_unit())
}

/// The greatest force or torque of a drive of this `kind` over the tightness that each unit is `placed` at, with the units that
/// malfunction marked; and the share of these. `limit` (N, N·m) is the motor's greatest.
///
/// # Errors
/// [`PlotError`], if there is nothing to show.
pub fn forces<G>(
    title: &str,
    kind: DriveKind,
    placed: &[(f64, &Unit<G>)],
    limit: Option<f64>,
) -> Result<String, PlotError> {
    let every = placed.len().div_ceil(MARKED).max(1);
    let marked = |verdict: Verdict, label: &str, shape| Markers {
        label: label.into(),
        shape,
        points: placed
            .iter()
            .step_by(every)
            .filter(|(_, unit)| unit.outcome.verdict == verdict)
            .filter_map(|(n, unit)| Some((*n, unit.outcome.peak_force?)))
            .collect(),
    };
    let [low, high] =
        placed.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (n, _)| [low.min(*n), high.max(*n)]);
    let limits = limit.map(|limit| Series {
        label: String::new(),
        look: Look::Guide,
        points: vec![(low, limit), (high, limit)],
    });
    let class = |k: usize| [k, k + 1].map(|k| low + (high - low) * k as f64 / CLASSES as f64);
    let shares: Vec<(f64, Share)> = (0..CLASSES)
        .filter_map(|k| {
            let [from, to] = class(k);
            let own: Vec<_> = placed.iter().filter(|(n, _)| from <= *n && *n < to).collect();
            let failed = own.iter().filter(|(_, unit)| malfunctions(unit, limit)).count();
            (own.len() >= LEAST).then(|| ((from + to) / 2.0, Share::new(failed as u64, own.len() as u64)))
        })
        .collect();
    let failed = placed.iter().filter(|(_, unit)| malfunctions(unit, limit)).count() as u64;
    let failed = Share::new(failed, placed.len().max(1) as u64);
    let remark = if every > 1 { format!("; one unit in {every} is marked") } else { String::new() };
    line_chart(&Chart {
        title: title.into(),
        subtitle: format!("{} units, {} % malfunction{remark}", placed.len(), fixed(failed.share * 100.0, 1)),
        x_label: "tightness (σ, mean over the gaps; positive is tighter)".into(),
        panels: vec![
            Panel {
                y_label: effort(kind),
                series: limits.into_iter().collect(),
                markers: vec![
                    marked(Verdict::Runs, "runs", Shape::Ring),
                    marked(Verdict::Crawls, "crawls", Shape::Triangle),
                    marked(Verdict::Jammed, "jammed", Shape::Cross),
                ],
                ..Panel::default()
            },
            Panel {
                y_label: "share that malfunctions (%)".into(),
                note: "grey: 95 % interval".into(),
                series: with_interval(&shares, "units"),
                ..Panel::default()
            },
        ],
        ..Chart::default()
    })
}

/// Shares (%) over a place, with the ends of their intervals as guides.
fn with_interval(shares: &[(f64, Share)], label: &str) -> Vec<Series> {
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
        subtitle: "random combinations of gaps against the tightest and the loosest, as far from the mean unit".into(),
        x_label: "distance from the mean unit (root mean square of the gaps, σ)".into(),
        panels: vec![Panel {
            y_label: "share that malfunctions (%)".into(),
            series: with_interval(&shares, "random"),
            markers: vec![
                side("tightest", Shape::Triangle, 0.03, |at| at.tight_malfunctions),
                side("loosest", Shape::Square, -0.03, |at| at.loose_malfunctions),
            ],
            ..Panel::default()
        }],
        ..Chart::default()
    })
}
