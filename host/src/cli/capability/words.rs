//! What was found, for people.

use std::fmt::Write;

use slipfit_measured::{
    capability::{Capability, CapabilityError, LEAST_PARTS},
    families::{FitError, Kind},
};
use slipfit_tolerance::number::{decimals, fixed, or_dash, percent, three_digits};

use super::report::Report;
use crate::{cli::terminal::text_table, show::capability::index};

/// Probability below which a test speaks against the normal distribution or against equal subgroups.
const DOUBTFUL: f64 = 0.05;

/// Why a characteristic cannot be judged, and what to do where a distribution cannot be chosen.
pub fn advised(error: &CapabilityError) -> String {
    let advice = match error {
        CapabilityError::NoFigures { why: FitError::FewToChoose { .. }, .. } => {
            "; state its family if you know it: --family normal"
        }
        _ => "",
    };
    format!("{error}{advice}")
}

/// That some characteristics cannot be judged, and why the first of them cannot.
pub fn unjudged(errors: &[CapabilityError]) -> Option<String> {
    let why = advised(errors.first()?);
    Some(match errors.len() {
        1 => why,
        count => format!("{why}; {} more characteristics cannot be judged, and --json says why", count - 1),
    })
}

/// What to look at in a characteristic.
pub fn warnings_of(of: &Capability) -> Vec<String> {
    let name = &of.name;
    let digits = decimals(of.deviation.value, 3);
    let mut warnings = Vec::new();
    for outlier in &of.outliers {
        warnings.push(format!(
            "\"{name}\": {} of part {} lies {} standard deviations from the mean, farther than a normal production reaches; it \
             stays in every figure",
            fixed(outlier.value, digits),
            outlier.label,
            fixed(outlier.distance, 1)
        ));
    }
    let is_normal = of.distribution.family == Kind::Normal;
    if let Some(normality) = of.normality.as_ref().filter(|normality| is_normal && normality.p < DOUBTFUL) {
        warnings.push(format!("\"{name}\" is hardly normal (Anderson–Darling, p = {})", three_digits(normality.p)));
    }
    if of.within.is_some() && !is_normal {
        warnings.push(format!(
            "\"{name}\": Cp and Cpk are those of a normal distribution within the subgroups, which these parts do not have"
        ));
    }
    if let Some(within) = of.within.as_ref().filter(|within| within.p < DOUBTFUL) {
        warnings.push(format!(
            "\"{name}\": the subgroups by {} differ (p = {}), which makes {} % of the variance; Cpk is {} within them",
            within.grouping,
            three_digits(within.p),
            percent(within.between, 0),
            or_dash(within.indices.least, |index| fixed(index.value, 2))
        ));
    }
    warnings
}

/// The report as text.
pub fn described(report: &Report) -> String {
    let mut text = format!("{} parts; intervals of 95 %\n\n", report.parts);
    let row = |of: &Capability| {
        let digits = decimals(of.deviation.value, 3);
        let number = |value: f64| fixed(value, digits);
        let [lower, upper] = of.limits.map(|limit| or_dash(limit, number));
        let unit = of.unit.symbol();
        vec![
            if unit.is_empty() { of.name.clone() } else { format!("{} ({unit})", of.name) },
            of.count.to_string(),
            of.distribution.family.name().to_owned(),
            number(of.mean.value),
            number(of.deviation.value),
            lower,
            upper,
            or_dash(of.performance.spread, |index| fixed(index.value, 2)),
            index(of.performance.least),
            or_dash(of.failing.both, |share| percent(share.value, 3)),
        ]
    };
    let rows: Vec<_> = report.characteristics.iter().map(row).collect();
    let heading = ["characteristic", "parts", "family", "mean", "s", "lower", "upper", "Pp", "Ppk", "outside, %"];
    text += &text_table(&heading, &rows);
    for of in report.characteristics.iter().filter(|of| of.within.is_some()) {
        let Some(within) = &of.within else { continue };
        let _ = writeln!(
            text,
            "\n{} by {}: Cp {}, Cpk {}\n",
            of.name,
            within.grouping,
            index(within.indices.spread),
            index(within.indices.least)
        );
        let digits = decimals(of.deviation.value, 3);
        let rows: Vec<_> = within
            .groups
            .iter()
            .map(|group| {
                let deviation = or_dash(group.deviation, |deviation| fixed(deviation, digits));
                vec![group.name.clone(), group.count.to_string(), fixed(group.mean, digits), deviation]
            })
            .collect();
        text += &text_table(&["subgroup", "parts", "mean", "s"], &rows);
    }
    let is_untested = |of: &Capability| of.distribution.family == Kind::Normal && of.count < LEAST_PARTS;
    if report.characteristics.iter().any(is_untested) {
        let _ =
            writeln!(text, "\nNo test of normality below {LEAST_PARTS} parts: the normal distribution is as stated.");
    }
    text
}
