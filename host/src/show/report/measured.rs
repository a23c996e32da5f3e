//! Measured parts, as sections of a page.

use maud::{Markup, html};
use slipfit_measured::{
    capability::{Capability, Estimate},
    families::Kind,
    table::MeasuredTable,
};
use slipfit_tolerance::number::{decimals, fixed, or_dash, percent, three_digits, typeset};

use super::html::{columns, figure, list, optional, real, row, table};
use crate::show::{
    capability::{Measured, index},
    plot::PlotError,
};

/// The main figures of all characteristics.
pub fn summary(of: &[Capability]) -> Markup {
    let head = html! { tr { (columns(&["characteristic", "parts", "distribution", "Pp", "Ppk", "outside, %"])) } };
    let rows = of.iter().map(|of| {
        let cells = [
            of.count.to_string(),
            of.distribution.family.name().to_owned(),
            optional(of.performance.spread.map(|index| index.value), 2),
            typeset(&index(of.performance.least)),
            or_dash(of.failing.both, |share| percent(share.value, 3)),
        ];
        row(&of.name, cells)
    });
    table("Intervals of 95 % in brackets.", head, rows)
}

/// Pictures and figures of every characteristic.
///
/// # Errors
/// [`PlotError`], if a number is not finite.
pub fn sections(of: &MeasuredTable, found: &[Capability], grouping: Option<usize>) -> Result<Markup, PlotError> {
    found
        .iter()
        .map(|found| section(of, found, grouping))
        .collect::<Result<Vec<_>, _>>()
        .map(|all| html! { @for one in all { (one) } })
}

fn section(of: &MeasuredTable, found: &Capability, grouping: Option<usize>) -> Result<Markup, PlotError> {
    let column = of.column(&found.name).map(|column| column.values.as_slice()).unwrap_or_default();
    let values: Vec<_> = column.iter().enumerate().filter_map(|(part, value)| Some((part, (*value)?))).collect();
    let measured = Measured { of: found, values: &values };
    let mut figures = vec![
        ("How the parts vary, and the distribution that the figures are of.", measured.histogram()?),
        ("Parts on the curve follow the distribution; its ends show the tails.", measured.probability_plot()?),
        ("A drift or a step over time makes all figures doubtful.", measured.in_order()?),
    ];
    if let Some(grouping) = grouping.and_then(|index| of.groupings().get(index)) {
        figures.push(("Subgroups that differ can be set apart.", measured.by_subgroup(grouping)?));
    }
    Ok(html! {
        h2 { (found.name) }
        div.multiples { @for (caption, svg) in &figures { (figure(caption, svg)) } }
        (indices(found))
        (list(&remarks(found)))
    })
}

/// Name of a figure, its estimate, and how it is shown.
type Row<'a> = (String, Option<Estimate>, &'a dyn Fn(f64) -> String);

/// Every figure with its interval.
fn indices(of: &Capability) -> Markup {
    let digits = decimals(of.deviation.value, 3);
    let length = |x: f64| real(x, digits);
    let ratio = |x: f64| real(x, 2);
    let share = |x: f64| percent(x, 4);
    let unit = |name: &str| match of.unit.symbol() {
        "" => name.to_owned(),
        unit => format!("{name}, {unit}"),
    };
    let [below, above, both] = [of.failing.below, of.failing.above, of.failing.both];
    let counted = of.counted.map(|counted| counted.share);
    let within = of.within.as_ref();
    let mut rows: Vec<Row> = vec![
        (unit("mean"), Some(of.mean), &length),
        (unit("standard deviation"), Some(of.deviation), &length),
        ("Pp".into(), of.performance.spread, &ratio),
        ("Ppk".into(), of.performance.least, &ratio),
        ("Ppk of the lower limit".into(), of.performance.lower, &ratio),
        ("Ppk of the upper limit".into(), of.performance.upper, &ratio),
        ("expected below the lower limit, %".into(), below, &share),
        ("expected above the upper limit, %".into(), above, &share),
        ("expected outside, %".into(), both, &share),
        ("counted outside, %".into(), counted, &share),
    ];
    if let Some(within) = within {
        rows.push((format!("Cp within {}", within.grouping), within.indices.spread, &ratio));
        rows.push((format!("Cpk within {}", within.grouping), within.indices.least, &ratio));
    }
    let rows = rows.into_iter().filter_map(|(name, estimate, shown)| {
        let Estimate { value, interval: [low, high] } = estimate?;
        Some(row(&name, [shown(value), format!("{} … {}", shown(low), shown(high))]))
    });
    let [lower, upper] = of.limits.map(|limit| optional(limit, digits));
    let caption = format!(
        "{} parts, {} not measured; limits {lower} and {upper}, nominal {}.",
        of.count,
        of.missing,
        optional(of.nominal, digits)
    );
    table(&caption, html! { tr { (columns(&["figure", "value", "interval of 95 %"])) } }, rows)
}

/// What was assumed, and what is far off.
fn remarks(of: &Capability) -> Vec<String> {
    let distribution = &of.distribution;
    let name = distribution.family.name();
    let parameters: Vec<_> = distribution
        .parameters
        .iter()
        .map(|(name, value)| format!("{name} {}", typeset(&three_digits(*value))))
        .collect();
    let mut remarks = vec![format!(
        "Assumed: a {name} distribution ({}), {}. Parts are taken as drawn at random from a production that does not drift.",
        parameters.join(", "),
        if distribution.stated { "as stated" } else { "chosen from the parts by Akaike's information criterion" }
    )];
    if !distribution.stated {
        let names: Vec<_> = distribution.allowed.iter().map(|kind| kind.name()).collect();
        remarks.push(format!("The intervals allow for every family that fits about as well: {}.", names.join(", ")));
    }
    match &of.normality {
        Some(normality) => remarks.push(format!(
            "Anderson–Darling test of normality: A² = {}, p = {}{}.",
            fixed(normality.statistic, 3),
            three_digits(normality.p),
            if distribution.family == Kind::Normal || normality.p < 0.05 { "" } else { "; a normal is not refuted" }
        )),
        None => remarks.push("Too few parts for a test of normality.".into()),
    }
    let digits = decimals(of.deviation.value, 3);
    for outlier in &of.outliers {
        remarks.push(format!(
            "Outlier: part {} with {}, {} standard deviations from the mean. It stays in every figure.",
            outlier.label,
            real(outlier.value, digits),
            fixed(outlier.distance, 1)
        ));
    }
    if of.outliers.is_empty() {
        remarks.push("No outlier.".into());
    }
    remarks
}
