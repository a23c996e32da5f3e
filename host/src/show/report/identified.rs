//! The page of an identification: measured and computed, residuals, profiles, correlations.

use maud::{Markup, html};
use slipfit_identify::{
    compare::Compared,
    estimate::{Estimate, Estimated},
};
use slipfit_tolerance::number::typeset;

use super::{Figure, figures, html as parts, notes, page, verdict};
use crate::show::{
    chart::{Chart, Look, Markers, Panel, Series, Shape},
    plot::{PlotError, line_chart, small_chart},
};

/// What was compared, run after run.
pub struct Course<'a> {
    /// Name of the record.
    pub name: &'a str,
    /// Times (s) of its samples.
    pub times: &'a [f64],
    /// What was measured (SI).
    pub measured: &'a [f64],
    /// Measured minus computed (SI).
    pub residuals: &'a [f64],
}

/// What is found of one unit.
pub struct Identified<'a> {
    /// The estimate that counts.
    pub chosen: &'a Compared,
    /// Its runs.
    pub courses: Vec<Course<'a>>,
}

/// Most points of a line: more than there are pixels.
const POINTS: usize = 1500;

/// The page of what was `found` of one or several units, with the `answer` as plain lines; the quantity that was compared is called
/// `compared`, with its unit.
///
/// # Errors
/// [`PlotError`], if a number is not finite.
pub fn identified_page(
    title: &str,
    answer: &str,
    found: &[Identified],
    compared: &str,
    remarks: &[String],
) -> Result<Markup, PlotError> {
    let sections = found.iter().map(|one| section(title, one, compared)).collect::<Result<Vec<_>, _>>()?;
    Ok(page(title, &html! { (verdict(answer)) (notes(remarks)) @for section in sections { (section) } }, None))
}

fn section(title: &str, found: &Identified, compared: &str) -> Result<Markup, PlotError> {
    let estimate = &found.chosen.estimate;
    let mut pictures = Vec::new();
    for course in &found.courses {
        pictures.push(Figure {
            caption: format!("{}: {compared} as measured and as computed, and what is left between them.", course.name),
            svg: line_chart(&over_time(title, course, compared))?,
        });
    }
    let curves = estimate.parameters.iter().filter(|own| own.profile.points.len() > 2);
    let curves = curves.map(|own| profile(title, own)).collect::<Result<Vec<_>, _>>()?;
    Ok(html! {
        h2 { (found.courses.iter().map(|course| course.name).collect::<Vec<_>>().join(", ")) }
        (figures(&pictures))
        @if !curves.is_empty() { h3 { "Profiles" } (figures(&curves)) }
        @if estimate.parameters.len() > 1 { (correlations(estimate)) }
    })
}

/// Every so many-th point.
fn thinned<'a>(times: &'a [f64], values: impl Fn(usize) -> f64 + 'a) -> Vec<(f64, f64)> {
    let stride = times.len().div_ceil(POINTS).max(1);
    (0..times.len()).step_by(stride).map(|i| (times[i], values(i))).collect()
}

fn over_time(title: &str, course: &Course, compared: &str) -> Chart {
    let line = |label: &str, n: f64, points| Series { label: label.into(), look: Look::Level(n), points };
    let Course { name, times, measured, residuals } = *course;
    let computed = |i: usize| measured[i] - residuals[i];
    Chart {
        title: title.into(),
        subtitle: name.into(),
        x_label: "time (s)".into(),
        panels: vec![
            Panel {
                y_label: compared.into(),
                series: vec![
                    line("measured", -3.0, thinned(times, |i| measured[i])),
                    line("computed", 3.0, thinned(times, computed)),
                ],
                ..Panel::default()
            },
            Panel {
                y_label: "residual, in the same unit".into(),
                series: vec![line("", 0.0, thinned(times, |i| residuals[i]))],
                ..Panel::default()
            },
        ],
        ..Chart::default()
    }
}

fn profile(title: &str, own: &Estimated) -> Result<Figure, PlotError> {
    let unit = if own.unit.is_empty() { String::new() } else { format!(" ({})", own.unit) };
    let points: Vec<(f64, f64)> = own.profile.points.iter().map(|[value, rise]| (*value, *rise)).collect();
    let ends = [points.first(), points.last()].into_iter().flatten().map(|(value, _)| (*value, 1.0)).collect();
    let svg = small_chart(&Chart {
        title: title.into(),
        subtitle: own.name.clone(),
        x_label: format!("{}{unit}", own.name),
        panels: vec![Panel {
            y_label: "rise of the loss; 1 ends the interval of 95 %".into(),
            series: vec![
                Series { label: String::new(), look: Look::Guide, points: ends },
                Series { label: String::new(), look: Look::Level(0.0), points: curve(&points) },
            ],
            markers: vec![Markers { label: String::new(), shape: Shape::Dot, points }],
            ..Panel::default()
        }],
        ..Chart::default()
    })?;
    Ok(Figure { caption: format!("How much worse the record is explained with another {}.", own.name), svg })
}

/// A smooth line through the `points` of a profile: its root is nearly straight to either side of the estimate.
fn curve(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    const PIECES: u32 = 12;
    let between = |two: &[(f64, f64)]| {
        let [(from, low), (to, high)] = [two[0], two[1]];
        let [low, high] = [low, high].map(|rise| libm::sqrt(rise.max(0.0)));
        (0..PIECES).map(move |k| {
            let share = f64::from(k) / f64::from(PIECES);
            let root = low + share * (high - low);
            (from + share * (to - from), root * root)
        })
    };
    points.windows(2).flat_map(between).chain(points.last().copied()).collect()
}

fn correlations(estimate: &Estimate) -> Markup {
    let names: Vec<&str> = estimate.parameters.iter().map(|own| own.name.as_str()).collect();
    let head = html! { tr { th scope="col" { "" } (parts::columns(&names)) } };
    let rows = names
        .iter()
        .zip(&estimate.correlation)
        .map(|(name, row)| parts::row(name, row.iter().map(|value| typeset(&format!("{value:.2}")))));
    parts::table("Correlations of the estimates", head, rows)
}
