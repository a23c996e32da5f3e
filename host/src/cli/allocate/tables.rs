//! What was found, for people.

use slipfit_tolerance::{
    allocate::{figures::MET, requirement::Row},
    model::Model,
    number::{fixed, or_dash, per_million, percent, three_digits},
};

use super::report::{Chosen, Confirmation, Measured, Report, Required, Unknown};
use crate::cli::{
    population::uncertain::{decided, share},
    terminal::text_table,
};

/// A number with six digits at most.
fn digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-4..1e9).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}

/// Whether the requirement on malfunction holds over all unknowns.
fn over_unknown(Unknown { allowed, holds, answer }: &Unknown) -> String {
    let holds = if *holds { "holds over the whole interval" } else { "does not hold over the whole interval" };
    format!(
        "Over all unknowns: {} (95 %) malfunction; the requirement, {} %, {holds}. Decided by {}\n",
        share(&answer.malfunctions),
        percent(*allowed, 2),
        decided(answer)
    )
}

/// The answer first, then what it rests on.
pub fn tables(report: &Report) -> String {
    let before = report.cost_before.map(|cost| format!(", {} before", digits(cost))).unwrap_or_default();
    let mut text = format!("{}\n\nCheapest tolerances: cost {}{before}\n\n", report.title, digits(report.cost));
    let rows: Vec<_> = report
        .tolerances
        .iter()
        .map(|chosen| {
            vec![
                chosen.name.clone(),
                chosen.written.clone(),
                format!("{} {}", digits(chosen.before), chosen.unit),
                chosen.process.clone().unwrap_or_else(|| "-".into()),
                fixed(chosen.cost, 4),
            ]
        })
        .collect();
    text += &text_table(&["tolerance of", "new line", "before", "process", "cost"], &rows);
    text += &on_the_drawing(&report.tolerances);
    let rows: Vec<_> = report.requirements.iter().map(requirement).collect();
    text += "\n";
    text += &text_table(&["requirement", "found", "allowed", "price", "of"], &rows);
    text += "price: what the cost falls by\n";
    if let Some(price) = report.price_together {
        text += &format!("all that bind, loosened together: {}\n", three_digits(price));
    }
    text += "\n";
    let rows: Vec<_> = report.check.iter().map(measure).collect();
    if let Some(Confirmation { units, share, at_most, target, rounds, .. }) = report.malfunctions {
        let [share, at_most] = [share, at_most].map(|share| percent(share, 2));
        let of = match rounds {
            1 => String::new(),
            _ => format!("; choice {rounds}, aimed at {} % of the units of the search", three_digits(100.0 * target)),
        };
        text += &format!(
            "Confirmed by {units} other simulated units: {share} % malfunction, with 95 % confidence at most {at_most} %{of}\n"
        );
    }
    text += &report.uncertain.as_ref().map(over_unknown).unwrap_or_default();
    if !rows.is_empty() {
        text += &format!("Check by the full model, {} units drawn\n", report.samples);
        text += &text_table(
            &["measure", "worst case", "RSS ±", "ppm by RSS", "ppm", "error", "ppm counted", "95 %", "Ppk"],
            &rows,
        );
    }
    if let Some(good) = report.good.filter(|_| report.check.len() > 1) {
        text += &format!("any measure outside of its limits: {} ppm counted\n", per_million((1.0 - good) * 1e6));
    }
    for of in &report.check {
        let Some((promised, found)) = of.rss_ppm.zip(of.ppm) else { continue };
        if found > 1.1 * promised && found > 1e-6 {
            let [promised, found] = [promised, found].map(per_million);
            text +=
                &format!("{}: {found} ppm fail by the full model; RSS alone would promise {promised} ppm\n", of.name);
        }
    }
    if let Some([first, .., last]) = report.curve.get(..) {
        let of =
            |point: &super::report::CurvePoint| format!("{} at {} ppm", digits(point.cost), per_million(point.ppm));
        text += &format!("Cost against defects: {} … {}\n", of(first), of(last));
    }
    text
}

/// The tolerances by part and feature.
fn on_the_drawing(tolerances: &[Chosen]) -> String {
    let mut text = "\nOn the drawing, by feature\n".to_owned();
    let width = tolerances.iter().map(|chosen| chosen.feature.chars().count()).max().unwrap_or_default();
    let parts = tolerances.chunk_by(|one, two| one.part == two.part);
    for part in parts {
        let indent = match part.first().and_then(|chosen| chosen.part.as_ref()) {
            Some(name) => {
                text += &format!("  {name}\n");
                "    "
            }
            None => "  ",
        };
        for feature in part.chunk_by(|one, two| one.feature == two.feature) {
            for (k, chosen) in feature.iter().enumerate() {
                let name = if k == 0 { chosen.feature.as_str() } else { "" };
                text += &format!("{indent}{name:width$}  {}\n", chosen.callout);
            }
        }
    }
    text
}

fn requirement(of: &Required) -> Vec<String> {
    let side = of.side.map(|side| format!(", {side}")).unwrap_or_default();
    let number = |value: f64| format!("{} {}", digits(value), of.unit).trim_end().to_owned();
    vec![
        format!(
            "{}: {}{side}",
            of.measure.as_deref().unwrap_or(if of.unit == "%" { "all units" } else { "all measures" }),
            of.requirement
        ),
        number(of.found),
        number(of.allowed),
        if of.price > 0.0 { three_digits(of.price) } else { "0".into() },
        of.price_of.into(),
    ]
}

fn measure(of: &Measured) -> Vec<String> {
    let unit = if of.unit.is_empty() { String::new() } else { format!(", {}", of.unit) };
    let [low, high] = of.worst_case.map(|value| fixed(value, 4));
    let [least, most] = of.counted_interval.map(per_million);
    vec![
        format!("{}{unit}", of.name),
        format!("{low} … {high}"),
        or_dash(of.rss, |value| fixed(value, 4)),
        or_dash(of.rss_ppm, per_million),
        or_dash(of.ppm, per_million),
        or_dash(of.ppm_error, |error| format!("±{}", three_digits(error))),
        per_million(of.counted_ppm),
        format!("{least} … {most}"),
        or_dash(of.ppk, |value| fixed(value, 3)),
    ]
}

/// What is missing where the tightest tolerances do not meet the requirements.
pub fn missing(model: &Model, rows: &[Row], figures: &[f64]) -> String {
    let failed = rows.iter().zip(figures).filter(|(_, figure)| figure.is_nan() || **figure > 1.0 + MET);
    let line = |(row, figure): (&Row, &f64)| {
        let of = Required::new(model, row, *figure, 0.0);
        let [name, found, allowed, ..] = &requirement(&of)[..] else { return String::new() };
        let number = |value: f64| format!("{} {}", digits(value), of.unit).trim_end().to_owned();
        if figure.is_finite() {
            format!("\n  {name}: {found}, allowed is {allowed}: {} missing", number((of.found - of.allowed).abs()))
        } else {
            format!("\n  {name}: out of reach, allowed is {allowed}")
        }
    };
    let lines: String = failed.map(line).collect();
    format!("the tightest tolerances that the processes hold do not meet the requirements{lines}")
}
