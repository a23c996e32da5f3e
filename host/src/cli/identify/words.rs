//! An identification in words.

use std::fmt::Write;

use slipfit_identify::{
    compare::{Compared, best},
    doubt::profile::{Profile, Shape},
    estimate::{Estimate, Estimated},
    fit::By,
};
use slipfit_tolerance::number::{decimals, fixed, or_dash, percent};

use super::report::Report;
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
pub fn described(report: &Report, chosen: &Compared, duration: f64) -> String {
    let estimate = &chosen.estimate;
    let mut text = String::new();
    if let Some(verdict) = &estimate.lack.verdict {
        let _ = writeln!(
            text,
            "Lack of fit: the model does not explain the record: {verdict}. Intervals below mean little.\n"
        );
    }
    let law = if report.model == "slide" { String::new() } else { format!(", law {}", chosen.name) };
    let _ = writeln!(
        text,
        "{}: {}{law}; {} samples of {} s, which know as much as {} independent ones\n",
        report.title,
        report.model,
        estimate.samples,
        fixed(duration, 1),
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
    if let (Some(spikes), Some(cutoff)) = (report.spikes, report.cutoff_hz) {
        let _ =
            writeln!(text, "Filter          {} Hz forwards and backwards; {spikes} spikes replaced", fixed(cutoff, 0));
    }
    if report.compared.len() > 1 {
        let _ = writeln!(text, "\nLaws compared; one that is more than {DECISIVE} behind is decisively worse\n");
        text += &comparison(report.compared);
    }
    text
}

/// A table of the parameters.
fn parameters(estimate: &Estimate) -> String {
    let row = |parameter: &Estimated| {
        let digits = decimals(parameter.deviation.unwrap_or_else(|| 0.01 * parameter.value.abs()), 2);
        let number =
            |value: f64| if digits > 9 || value.abs() > 1e7 { format!("{value:.3e}") } else { fixed(value, digits) };
        let range = |[low, high]: [f64; 2]| format!("{} to {}", number(low), number(high));
        let name = match parameter.unit {
            "" => parameter.name.clone(),
            unit => format!("{} ({unit})", parameter.name),
        };
        vec![
            name,
            if parameter.deviation.is_some() { number(parameter.value) } else { "-".into() },
            or_dash(parameter.deviation, number),
            or_dash(parameter.interval, range),
            or_dash(parameter.bootstrap, range),
            profile(&parameter.profile, number),
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
