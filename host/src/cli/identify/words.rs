//! An identification in words.

use std::fmt::Write;

use slipfit_identify::{
    between::Between,
    compare::{Compared, best},
    doubt::profile::{Profile, Shape},
    estimate::{Estimate, Estimated},
    fit::By,
};
use slipfit_tolerance::number::{decimals, fixed, or_dash, percent};

use super::report::{Report, UnitReport};
use crate::cli::terminal::text_table;

/// Difference of the criterion from which on a law is decisively better.
const DECISIVE: f64 = 10.0;

/// That another law is decisively better than the `chosen` one.
pub fn better(chosen: &Compared, compared: &[Compared]) -> Option<String> {
    let best = best(compared).filter(|_| chosen.behind > DECISIVE)?;
    let error = |one: &Compared| percent(one.estimate.lack.relative_error, 1);
    Some(format!(
        "the law {} explains the record decisively better than {}: its residuals are {} % of the force instead of {} %",
        best.name,
        chosen.name,
        error(best),
        error(chosen)
    ))
}

/// The report as text.
pub fn described(report: &Report, unit: &UnitReport, chosen: &Compared) -> String {
    let estimate = &chosen.estimate;
    let mut text = String::new();
    if let Some(verdict) = &estimate.lack.verdict {
        let _ = writeln!(
            text,
            "Lack of fit: the model does not explain the record: {verdict}. Intervals below mean little.\n"
        );
    }
    let law = if report.model == "drive-train" { format!(", law {}", chosen.name) } else { String::new() };
    let _ = writeln!(
        text,
        "{}: {}{law}; {} samples of {} s, which know as much as {} independent ones\n",
        report.title,
        report.model,
        estimate.samples,
        fixed(unit.duration, 1),
        fixed(estimate.effective_samples, 0)
    );
    text += &parameters(estimate);
    let lack = &estimate.lack;
    let held_out = or_dash(lack.held_out_error, |error| percent(error, 1) + " %");
    let _ = writeln!(
        text,
        "\nResiduals       {} % of the force, lag-1 correlation {}; {held_out} in the quarter held out",
        percent(lack.relative_error, 1),
        fixed(lack.lag_1_correlation, 2)
    );
    let undetermined =
        if estimate.undetermined.is_empty() { "nothing".into() } else { estimate.undetermined.join("; ") };
    let _ = writeln!(text, "Not determined  {undetermined}");
    if let Some(correlated) = most_correlated(estimate) {
        let _ = writeln!(text, "Correlation     {correlated}");
    }
    if estimate.by == By::Grid {
        let _ = writeln!(
            text,
            "Search          by a grid: intervals suppose a smooth output and mean little where it jumps"
        );
    }
    if let (Some(spikes), Some(cutoff)) = (unit.spikes, unit.cutoff_hz) {
        let _ =
            writeln!(text, "Filter          {} Hz forwards and backwards; {spikes} spikes replaced", fixed(cutoff, 0));
    }
    if unit.compared.len() > 1 {
        let _ = writeln!(text, "\nLaws compared; one that is more than {DECISIVE} behind is decisively worse\n");
        text += &comparison(unit.compared);
    }
    text
}

/// Parameters that the table of units has columns for.
const COLUMNS: usize = 6;

/// What the estimates `chosen` for several units have in common.
pub fn between(report: &Report, chosen: &[&Compared], pooled: &[Between]) -> String {
    let mut text = format!("{}: {} of {} units\n\n", report.title, report.model, chosen.len());
    let name = |name: &str, unit: &str| if unit.is_empty() { name.to_owned() } else { format!("{name} ({unit})") };
    let row = |of: &Between| {
        let number = writer(of.mean, Some(of.deviation));
        let [low, high] = of.interval.map(&number);
        let spread = number(of.spread);
        vec![
            name(&of.name, of.unit),
            of.units.to_string(),
            number(of.mean),
            number(of.deviation),
            format!("{low} to {high}"),
            spread,
        ]
    };
    let rows: Vec<_> = pooled.iter().map(row).collect();
    text +=
        &text_table(&["parameter", "units", "mean", "its deviation", "95 % interval", "spread between units"], &rows);
    let parameters = chosen.first().map_or(&[][..], |one| &one.estimate.parameters);
    let more = parameters.len().saturating_sub(COLUMNS);
    let more = if more > 0 { format!("; --json has {more} more parameters") } else { String::new() };
    let _ = writeln!(text, "\nEach unit: estimate ± deviation{more}\n");
    let of_unit = |(unit, chosen): (&UnitReport, &&Compared)| {
        let estimate = &chosen.estimate;
        let of_parameter = |own: &Estimated| match own.deviation {
            Some(deviation) => {
                let number = writer(own.value, own.deviation);
                format!("{} ± {}", number(own.value), number(deviation))
            }
            None => "-".into(),
        };
        let mut row = vec![unit.records.join(", ")];
        row.extend(estimate.parameters.iter().take(COLUMNS).map(of_parameter));
        row.push(percent(estimate.lack.relative_error, 1));
        row.push(if estimate.lack.verdict.is_some() { "lack of fit" } else { "" }.into());
        row
    };
    let rows: Vec<_> = report.units.iter().zip(chosen).map(of_unit).collect();
    let mut heads = vec!["records".to_owned()];
    heads.extend(parameters.iter().take(COLUMNS).map(|own| name(&own.name, own.unit)));
    heads.extend(["residuals, %", "verdict"].map(str::to_owned));
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    text += &text_table(&heads, &rows);
    text
}

/// Writes numbers with the digits that a `value` with this deviation has.
fn writer(value: f64, deviation: Option<f64>) -> impl Fn(f64) -> String {
    let digits = decimals(deviation.filter(|of| *of > 0.0).unwrap_or(0.01 * value.abs()), 2);
    move |value: f64| if digits > 9 || value.abs() > 1e7 { format!("{value:.3e}") } else { fixed(value, digits) }
}

/// A table of the parameters.
fn parameters(estimate: &Estimate) -> String {
    let row = |parameter: &Estimated| {
        let number = writer(parameter.value, parameter.deviation);
        let range = |[low, high]: [f64; 2]| format!("{} to {}", number(low), number(high));
        let name = match parameter.unit {
            "" => parameter.name.clone(),
            unit => format!("{} ({unit})", parameter.name),
        };
        vec![
            name,
            if parameter.deviation.is_some() { number(parameter.value) } else { "-".into() },
            or_dash(parameter.deviation, &number),
            or_dash(parameter.interval, range),
            or_dash(parameter.bootstrap, range),
            profile(&parameter.profile, &number),
        ]
    };
    let rows: Vec<_> = estimate.parameters.iter().map(row).collect();
    text_table(&["parameter", "estimate", "deviation", "95 % interval", "by bootstrap", "by profile"], &rows)
}

/// An interval by profile likelihood, its shape named unless it is bounded from both sides.
fn profile(profile: &Profile, number: impl Fn(f64) -> String) -> String {
    match (profile.shape, profile.ends) {
        (Shape::Bounded, [Some(low), Some(high)]) => format!("{} to {}", number(low), number(high)),
        (Shape::OneSided, [Some(low), None]) => format!("one-sided, above {}", number(low)),
        (Shape::OneSided, [None, Some(high)]) => format!("one-sided, below {}", number(high)),
        _ => "flat".into(),
    }
}

/// The two parameters that are most correlated, if there are two.
fn most_correlated(estimate: &Estimate) -> Option<String> {
    let count = estimate.parameters.len();
    let pairs = (0..count).flat_map(|i| (0..i).map(move |k| (k, i)));
    let of = |(k, i): (usize, usize)| estimate.correlation[k][i];
    let (k, i) = pairs.max_by(|a, b| of(*a).abs().total_cmp(&of(*b).abs()))?;
    let [one, other] = [k, i].map(|at| &estimate.parameters[at].name);
    Some(format!("{} between {one} and {other}, the greatest", fixed(of((k, i)), 2)))
}

fn comparison(compared: &[Compared]) -> String {
    let row = |one: &Compared| {
        let lack = &one.estimate.lack;
        vec![
            one.name.clone(),
            one.estimate.parameters.len().to_string(),
            percent(lack.relative_error, 1),
            fixed(lack.lag_1_correlation, 2),
            or_dash(lack.held_out_error, |error| percent(error, 1)),
            fixed(one.behind, 0),
            if lack.verdict.is_some() { "lack of fit" } else { "" }.into(),
        ]
    };
    let rows: Vec<_> = compared.iter().map(row).collect();
    text_table(&["law", "parameters", "residuals, %", "lag-1", "held out, %", "behind", "verdict"], &rows)
}
