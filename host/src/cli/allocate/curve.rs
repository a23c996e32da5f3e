//! Cost against defects, as CSV and as a picture.

use slipfit_tolerance::number::{ten_digits, three_digits};

use super::report::Report;
use crate::show::{
    chart::{Chart, Look, Panel, Scale, Series},
    plot::{PlotError, line_chart},
};

/// The curve as CSV: ppm, cost, and every tolerance with its unit.
pub fn csv(report: &Report) -> anyhow::Result<Vec<u8>> {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    let names = report.tolerances.iter().map(|chosen| format!("{}, {}", chosen.name, chosen.unit));
    writer.write_record(["ppm".to_owned(), "cost".to_owned()].into_iter().chain(names))?;
    for point in &report.curve {
        let numbers = [point.ppm, point.cost].into_iter().chain(point.tolerances.iter().copied());
        writer.write_record(numbers.map(ten_digits))?;
    }
    Ok(writer.into_inner()?)
}

/// The curve as SVG.
///
/// # Errors
/// [`PlotError`], if it has no point.
pub fn svg(report: &Report) -> Result<String, PlotError> {
    let mut points: Vec<_> = report.curve.iter().map(|point| (point.ppm, point.cost)).collect();
    points.reverse();
    let ends = [points.first(), points.last()].into_iter().flatten();
    let chosen = ends.map(|(ppm, _)| (*ppm, report.cost)).collect();
    let line = |look, points| Series { label: String::new(), look, points };
    line_chart(&Chart {
        title: report.title.clone(),
        subtitle: format!("cost of the cheapest tolerances against defects; chosen: {}", three_digits(report.cost)),
        x_label: "units with a measure outside of its limits (ppm)".into(),
        scale: Scale::LogAcross,
        panels: vec![Panel {
            y_label: "cost".into(),
            note: "grey: what is chosen costs".into(),
            series: vec![line(Look::Guide, chosen), line(Look::Kind(0), points)],
            ..Panel::default()
        }],
    })
}
