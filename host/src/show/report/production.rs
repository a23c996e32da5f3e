//! How the product's measures vary, as a section of the page.

use maud::{Markup, html};
use slipfit_tolerance::{
    number::{per_million, typeset},
    report::{MeasureReport, Report, SumReport},
};

use super::html::{columns, figure, list, optional, real, row, table};
use crate::show::tolerances::Picture;

/// The analysis of a product.
pub struct Production {
    /// What was found.
    pub report: Report,
    /// Its pictures.
    pub pictures: Vec<Picture>,
}

/// Tables and pictures.
pub fn section(Production { report, pictures }: &Production) -> Markup {
    let figures = |small| {
        let shown = pictures.iter().filter(move |picture| picture.small == small);
        html! { @for Picture { caption, svg, .. } in shown { (figure(caption, svg)) } }
    };
    html! {
        h2 { "Tolerance analysis" }
        (measures(report))
        (beside(report))
        (sums(report))
        (list(&report.notes))
        (figures(false))
        div.multiples { (figures(true)) }
    }
}

fn measures(report: &Report) -> Markup {
    let mut names = vec!["measure", "mean", "σ", "skew", "kurtosis", "0.135 %", "50 %", "99.865 %"];
    if report.limited() {
        names.extend(["Pp", "Ppk", "ppm below", "ppm above"]);
    }
    let of = |m: &MeasureReport| {
        let mut cells = Vec::new();
        cells.extend([m.mean, m.sd].map(|x| real(x, 4)));
        cells.extend([m.skew, m.kurtosis].map(|x| optional(x, 3)));
        cells.extend([m.q00135, m.median, m.q99865].map(|x| real(x, 4)));
        if report.limited() {
            cells.extend([m.pp, m.ppk].map(|x| optional(x, 3)));
            cells.extend(m.dpm.map(|side| side.map_or_else(|| "–".to_owned(), |side| ppm(side.dpm))));
        }
        row(&named(&m.name, m.unit), cells)
    };
    let caption =
        format!("{} units drawn, seed {}: mean, standard deviation, points, capability.", report.samples, report.seed);
    table(&caption, head(&names), report.measures.iter().map(of))
}

fn beside(report: &Report) -> Markup {
    let names = ["measure", "worst case", "RSS", "mean, 2nd order", "σ, 2nd order"];
    let of = |m: &MeasureReport| {
        let [low, high] = m.worst_case.map(|x| real(x, 4));
        let rss =
            m.rss.map_or_else(|| "–".to_owned(), |rss| format!("{} ± {}", real(rss.middle, 4), real(rss.tolerance, 4)));
        let second = m.second_order;
        let [mean, deviation] = [second.map(|s| s.mean), second.map(|s| s.sd)].map(|x| optional(x, 4));
        row(&named(&m.name, m.unit), [format!("{low} … {high}"), rss, mean, deviation])
    };
    let caption = "Without random numbers: worst case, root sum of squares, moments of second order.";
    table(caption, head(&names), report.measures.iter().map(of))
}

fn sums(report: &Report) -> Markup {
    let names = ["sum", "mean", "σ", "ρ", "ppm below 0", "eq. 9 (ρ = 1)", "ρ = 0"];
    let of = |sum: &SumReport| {
        let cells = [
            real(sum.mean, 4),
            real(sum.sd, 4),
            optional(sum.correlation, 3),
            ppm(sum.model.dpm),
            ppm(sum.eq9_ppm),
            ppm(sum.independent_ppm),
        ];
        row(&named(&sum.name, sum.unit), cells)
    };
    let caption = "Sums that must not close: defects per million with the model's own correlation, and as mean and σ alone \
                   would have it, both gaps moving together as in eq. 9, or independently.";
    html! { @if !report.sums.is_empty() { (table(caption, head(&names), report.sums.iter().map(of))) } }
}

/// One row of headings.
fn head(names: &[&str]) -> Markup {
    html! { tr { (columns(names)) } }
}

fn ppm(number: f64) -> String {
    typeset(&per_million(number))
}

/// The name of a measure or a sum with its unit.
fn named(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name}, {unit}") }
}
