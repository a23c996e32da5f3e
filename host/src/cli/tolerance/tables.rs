//! An analysis as text.

use std::fmt::Write;

use slipfit_tolerance::{
    number::{fixed, or_dash, per_million, three_digits},
    report::{MeasureReport, Report, SumReport},
    statistics::estimate::Estimate,
    theory::rss::{BENDER, GILSON},
};

use crate::cli::terminal::text_table;

/// All that a person is shown of `report`.
pub(super) fn tables(report: &Report) -> String {
    let replicates =
        if report.replicates > 1 { format!(" in {} replicates", report.replicates) } else { String::new() };
    let mut text = format!("{}\n{} units{replicates}, seed {}\n\n", report.title, report.samples, report.seed);
    for table in [drawn(report), losses(report), by_formula(report), contributors(report), sums(report)] {
        if !table.is_empty() {
            let _ = writeln!(text, "{table}");
        }
    }
    if let Some(good) = report.yield_of_all {
        let [low, high] = good.interval.map(|end| or_dash(end.map(|end| end * 100.0), |x| fixed(x, 4)));
        let _ = writeln!(text, "yield {} % ({low} … {high})", fixed(good.value * 100.0, 4));
    }
    for note in &report.notes {
        let _ = writeln!(text, "note: {note}");
    }
    text
}

fn real(x: f64) -> String {
    fixed(x, 4)
}

/// What the units say.
fn drawn(report: &Report) -> String {
    let by_points = report.measures.iter().any(|m| m.pp_by_points.or(m.ppk_by_points).is_some());
    let row = |m: &MeasureReport| {
        let unit = if m.unit.is_empty() { String::new() } else { format!(", {}", m.unit) };
        let mut row = vec![format!("{}{unit}", m.name)];
        row.extend([m.mean, m.sd].map(real));
        row.extend([m.skew, m.kurtosis].map(|x| or_dash(x, |x| fixed(x, 3))));
        row.extend([m.min, m.q00135, m.median, m.q99865, m.max].map(real));
        if report.limited() {
            row.extend([m.pp, m.ppk].map(|x| or_dash(x, |x| fixed(x, 3))));
            if by_points {
                row.extend([m.pp_by_points, m.ppk_by_points].map(|x| or_dash(x, |x| fixed(x, 3))));
            }
            row.extend(m.dpm.map(|side| or_dash(side.map(|side| side.dpm), per_million)));
        }
        row
    };
    let mut heading = vec!["measure", "mean", "σ", "skew", "kurt", "min", "0.135 %", "50 %", "99.865 %", "max"];
    if report.limited() {
        heading.extend(["Pp", "Ppk"]);
        if by_points {
            heading.extend(["Pp by points", "Ppk by points"]);
        }
        heading.extend(["ppm below", "ppm above"]);
    }
    let table = text_table(&heading, &report.measures.iter().map(row).collect::<Vec<_>>());
    let told = "Pp, Ppk: by 6σ, as if normal; by points: what is not normal, by its 0.135, 50 and 99.865 % points\n";
    if by_points { table + told } else { table }
}

/// What it costs to be off target.
fn losses(report: &Report) -> String {
    let row = |m: &MeasureReport| {
        let loss = m.loss?;
        let error = or_dash(loss.mean.error, |error| format!("±{}", three_digits(error)));
        let unit = if m.unit.is_empty() { String::new() } else { format!(", {}", m.unit) };
        let numbers = [loss.signal_to_noise, loss.balanced_tolerance].map(|x| or_dash(x, real));
        let named = [format!("{}{unit}", m.name), real(loss.target), real(loss.mean.value), error];
        Some(named.into_iter().chain(numbers).collect::<Vec<_>>())
    };
    let rows: Vec<_> = report.measures.iter().filter_map(row).collect();
    let heading = ["measure", "target", "mean loss", "error", "signal to noise, dB", "balanced tolerance ±"];
    if rows.is_empty() { String::new() } else { text_table(&heading, &rows) }
}

/// How good that is, and what needs no units.
fn by_formula(report: &Report) -> String {
    let by_quadrature = report.measures.iter().any(|m| m.quadrature.is_some());
    let range = |[low, high]: [f64; 2]| format!("{} … {}", real(low), real(high));
    let curved = report.measures.iter().any(|m| m.worst_case_linear.map(range) != Some(range(m.worst_case)));
    let plus_minus = |estimate: &Estimate| or_dash(estimate.error, |error| format!("±{}", three_digits(error)));
    let row = |m: &MeasureReport| {
        let mut row = vec![m.name.clone(), plus_minus(&m.estimates.mean), plus_minus(&m.estimates.sd)];
        let rss = m.rss.map_or_else(|| "-".into(), |rss| format!("{} ± {}", real(rss.middle), real(rss.tolerance)));
        row.extend([or_dash(m.nominal, real), range(m.worst_case)]);
        row.extend(curved.then(|| or_dash(m.worst_case_linear, range)));
        row.push(rss);
        let modified = [m.rss.map(|rss| rss.bender), m.rss.map(|rss| rss.gilson)];
        row.extend(modified.map(|tolerance| or_dash(tolerance, |tolerance| format!("± {}", real(tolerance)))));
        let second = m.second_order;
        row.extend([m.rss.map(|r| r.sd), second.map(|s| s.mean), second.map(|s| s.sd)].map(|x| or_dash(x, real)));
        if by_quadrature {
            row.extend([m.quadrature.map(|q| q.mean), m.quadrature.map(|q| q.sd)].map(|x| or_dash(x, real)));
        }
        row
    };
    let mut heading = vec!["measure", "error of mean", "of σ", "nominal", "worst case"];
    heading.extend(curved.then_some("by slopes alone"));
    heading.extend(["RSS", "Bender", "Gilson", "σ linear", "mean 2nd order", "σ 2nd order"]);
    if by_quadrature {
        heading.extend(["mean exact", "σ exact"]);
    }
    text_table(&heading, &report.measures.iter().map(row).collect::<Vec<_>>())
        + &format!(
            "RSS: taken where every dimension is in the middle of its limits; Bender: {BENDER} times it, Gilson: {GILSON} times, for means that shift\n"
        )
}

fn contributors(report: &Report) -> String {
    let mut text = "Largest contributors, % of variance\n".to_owned();
    for m in &report.measures {
        let shares = m.contributors.iter().filter_map(|share| Some((&share.name, share.percent?)));
        let most = shares.filter(|(_, percent)| percent.abs() >= 1.0).take(6);
        let most: Vec<String> = most.map(|(name, percent)| format!("{name} {}", fixed(percent, 1))).collect();
        let by = if m.by_indices { " (Sobol')" } else { "" };
        let most = if most.is_empty() { "-".to_owned() } else { most.join(", ") };
        let _ = writeln!(text, "  {}{by}: {most}", m.name);
    }
    text
}

fn sums(report: &Report) -> String {
    if report.sums.is_empty() {
        return String::new();
    }
    let row = |s: &SumReport| {
        vec![
            s.name.clone(),
            real(s.mean),
            real(s.sd),
            or_dash(s.correlation, |rho| fixed(rho, 3)),
            per_million(s.model.dpm),
            or_dash(s.model.error.filter(|_| s.model.dpm >= 1e-6), |error| format!("±{}", three_digits(error))),
            per_million(s.eq9_ppm),
            per_million(s.independent_ppm),
        ]
    };
    let heading = ["sum < 0", "mean", "σ", "ρ", "ppm", "error", "eq. 9 (ρ = 1)", "ρ = 0"];
    text_table(&heading, &report.sums.iter().map(row).collect::<Vec<_>>())
        + "ppm: with the model's own correlation; eq. 9 and ρ = 0: read from means and σ alone\n"
}
