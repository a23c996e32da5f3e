//! Pictures of a population.

use slipfit_core::slide::CONTACTS;

use super::{
    Unit,
    hypothesis::{AtDistance, Hypothesis},
    statistics::{Share, malfunctions},
};
use crate::{
    dynamics::outcome::Verdict,
    scene::Scene,
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

/// How much tighter than the mean unit this one is: the mean over its gaps, each in its standard deviations, signed like
/// the level n of eq. 9.
pub fn tightness(scene: &Scene, gaps: &[f64; CONTACTS]) -> f64 {
    joint_tightness(scene.levels_of(gaps))
}

/// The mean of the `levels` at which gaps are, of those that vary.
pub fn joint_tightness(levels: impl IntoIterator<Item = Option<f64>>) -> f64 {
    let levels: Vec<f64> = levels.into_iter().flatten().collect();
    levels.iter().sum::<f64>() / levels.len().max(1) as f64
}

/// The `units` of a slide, each with its tightness.
pub fn placed<'u>(scene: &Scene, units: &'u [Unit]) -> Vec<(f64, &'u Unit)> {
    units.iter().map(|unit| (tightness(scene, &unit.gaps), unit)).collect()
}

/// What [`forces`] calls the force of a slide's drive.
pub const FORCE: &str = "greatest drive force (N)";

/// `effort`, the greatest force with its unit, over the tightness that each unit is `placed` at, with the units that malfunction
/// marked; and the share of these.
///
/// # Errors
/// [`PlotError`], if there is nothing to show.
pub fn forces<G>(
    title: &str,
    effort: &str,
    placed: &[(f64, &Unit<G>)],
    limit: Option<f64>,
) -> Result<String, PlotError> {
    let every = placed.len().div_ceil(MARKED).max(1);
    let kind = |verdict: Verdict, label: &str, shape| Markers {
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
        x_label: "joint tightness n (mean over the gaps, σ; positive is tighter)".into(),
        panels: vec![
            Panel {
                y_label: effort.into(),
                series: limits.into_iter().collect(),
                markers: vec![
                    kind(Verdict::Runs, "runs", Shape::Ring),
                    kind(Verdict::Crawls, "crawls", Shape::Triangle),
                    kind(Verdict::Jammed, "jammed", Shape::Cross),
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
pub fn hypothesis(scene: &Scene, tested: &Hypothesis) -> Result<String, PlotError> {
    let shares: Vec<(f64, Share)> = tested.distances.iter().map(|at| (at.distance, at.random)).collect();
    // Apart, so that neither hides the other.
    let side = |label: &str, shape, apart: f64, failed: fn(&AtDistance) -> bool| Markers {
        label: label.into(),
        shape,
        points: tested.distances.iter().map(|at| (at.distance + apart, if failed(at) { 100.0 } else { 0.0 })).collect(),
    };
    line_chart(&Chart {
        title: scene.title.clone(),
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
