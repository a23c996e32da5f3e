//! How the product's measures vary, as a section of the page.

use super::html::{figure, list, optional, real, table, tr};
use crate::{
    show::{
        markup::escape,
        number::{per_million, typeset},
    },
    tolerance::report::{MeasureReport, Report, SumReport, picture::Picture},
};

/// The analysis of a product.
pub struct Production {
    /// What was found.
    pub report: Report,
    /// Its pictures.
    pub pictures: Vec<Picture>,
}

/// Headings of a table's columns.
fn head(columns: &[&str]) -> String {
    let cells: String = columns.iter().map(|column| format!("<th scope=\"col\">{column}</th>")).collect();
    format!("<tr>{cells}</tr>\n")
}

fn ppm(number: f64) -> String {
    typeset(&per_million(number))
}

/// Tables and pictures.
pub fn section(Production { report, pictures }: &Production) -> String {
    let figures = |small| -> String {
        let shown = pictures.iter().filter(|picture| picture.small == small);
        shown.map(|Picture { caption, svg, .. }| figure(caption, svg)).collect()
    };
    format!(
        "<h2>Tolerance analysis</h2>\n{}{}{}{}{}<div class=\"multiples\">\n{}</div>\n",
        measures(report),
        beside(report),
        sums(report),
        list(&report.notes),
        figures(false),
        figures(true),
    )
}

fn measures(report: &Report) -> String {
    let mut columns = vec!["measure", "mean", "σ", "skew", "kurtosis", "0.135 %", "50 %", "99.865 %"];
    if report.limited() {
        columns.extend(["Pp", "Ppk", "ppm below", "ppm above"]);
    }
    let row = |m: &MeasureReport| {
        let mut cells = vec![named(m)];
        cells.extend([m.mean, m.sd].map(|x| real(x, 4)));
        cells.extend([m.skew, m.kurtosis].map(|x| optional(x, 3)));
        cells.extend([m.q00135, m.median, m.q99865].map(|x| real(x, 4)));
        if report.limited() {
            cells.extend([m.pp, m.ppk].map(|x| optional(x, 3)));
            cells.extend(m.dpm.map(|side| side.map_or_else(|| "–".to_owned(), |side| ppm(side.dpm))));
        }
        tr("", &cells)
    };
    let caption =
        format!("{} units drawn, seed {}: mean, standard deviation, points, capability.", report.samples, report.seed);
    table(&caption, &head(&columns), &report.measures.iter().map(row).collect::<String>())
}

fn beside(report: &Report) -> String {
    let columns = ["measure", "worst case", "RSS", "mean, 2nd order", "σ, 2nd order"];
    let row = |m: &MeasureReport| {
        let [low, high] = m.worst_case.map(|x| real(x, 4));
        let rss =
            m.rss.map_or_else(|| "–".to_owned(), |rss| format!("{} ± {}", real(rss.middle, 4), real(rss.tolerance, 4)));
        let second = m.second_order;
        let [mean, deviation] = [second.map(|s| s.mean), second.map(|s| s.sd)].map(|x| optional(x, 4));
        let cells = [named(m), format!("{low} … {high}"), rss, mean, deviation];
        tr("", &cells)
    };
    let caption = "Without random numbers: worst case, root sum of squares, moments of second order.";
    table(caption, &head(&columns), &report.measures.iter().map(row).collect::<String>())
}

fn sums(report: &Report) -> String {
    if report.sums.is_empty() {
        return String::new();
    }
    let columns = ["sum", "mean", "σ", "ρ", "ppm below 0", "eq. 9 (ρ = 1)", "ρ = 0"];
    let row = |sum: &SumReport| {
        let cells = [
            escape(&sum.name),
            real(sum.mean, 4),
            real(sum.sd, 4),
            optional(sum.correlation, 3),
            ppm(sum.model.dpm),
            ppm(sum.eq9_ppm),
            ppm(sum.independent_ppm),
        ];
        tr("", &cells)
    };
    let caption = "Sums that must not close: defects per million with the model's own correlation, and as mean and σ alone \
                   would have it, both gaps moving together as in eq. 9, or independently.";
    table(caption, &head(&columns), &report.sums.iter().map(row).collect::<String>())
}

/// A measure with its unit.
fn named(measure: &MeasureReport) -> String {
    let unit = if measure.unit.is_empty() { String::new() } else { format!(", {}", measure.unit) };
    escape(&measure.name) + &unit
}
