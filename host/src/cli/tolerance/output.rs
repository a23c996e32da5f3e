//! What an analysis prints and writes.

use std::{fmt::Write, path::PathBuf};

use clap::Args;
use serde::Serialize;

use super::gaps::Columns;
use crate::{
    cli::{Failure, print, print_json, refused, text_table},
    files,
    number::{fixed, or_dash, three_digits},
    scene::Scene,
    tolerance::{
        analysis::conclude,
        picture::pictures,
        report::{self, measures_csv},
        run::RunError,
        study::{Study, Tally},
    },
};

/// The paper's tolerance level, which just closes its tightest pair.
pub(in crate::cli) const PAPER_LEVEL: f64 = 3.43;

fn finite(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|n: &f64| n.is_finite()).ok_or_else(|| "allowed is any finite number".into())
}

/// What is written of an analysis.
#[derive(Args)]
pub(in crate::cli) struct OutputArguments {
    /// Tolerance level of Table 2's derived columns; positive is tighter. The paper's is 3.43.
    #[arg(long, default_value_t = PAPER_LEVEL, allow_hyphen_values = true, value_parser = finite)]
    pub n: f64,
    /// Writes the measures' statistics as CSV.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draws histograms, contributors and correlations as SVG into a folder.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
}

impl OutputArguments {
    /// The files to be written.
    pub fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.csv.iter()
    }

    /// Makes the folder for pictures.
    pub fn prepare(&self) -> Result<(), Failure> {
        self.plots.as_deref().map_or(Ok(()), |folder| files::prepare_folder(folder).map_err(refused))
    }

    /// The option given that asks for a file, if any does.
    pub fn asked(&self) -> Option<&'static str> {
        self.csv.as_ref().map(|_| "--csv").or(self.plots.as_ref().map(|_| "--plots"))
    }

    /// Shows and writes what was found of `study`, with Table 2's derived columns if the scene has a `slide`.
    pub fn show(
        &self,
        title: &str,
        slide: Option<&Scene>,
        study: &Study,
        tallies: &[Tally],
        json: bool,
    ) -> Result<(), Failure> {
        let analysis = conclude(study, tallies).map_err(RunError::from)?;
        let report = report::report(title, study.model, &analysis);
        if let Some(path) = &self.csv {
            files::write(path, &measures_csv(&report)?)?;
        }
        if let Some(folder) = &self.plots {
            for picture in pictures(&report, study, tallies).map_err(anyhow::Error::from)? {
                files::write(&folder.join(picture.file), picture.svg.as_bytes())?;
            }
        }
        let columns = slide.map(|slide| Columns::new(slide, self.n));
        if json {
            return print_json(&Shown { report: &report, columns });
        }
        let columns = columns.map(|columns| format!("\n{columns}")).unwrap_or_default();
        print(&(for_people(&report) + &columns))
    }
}

/// An analysis for machines.
#[derive(Serialize)]
struct Shown<'a> {
    #[serde(flatten)]
    report: &'a report::Report,
    #[serde(flatten)]
    columns: Option<Columns>,
}

/// An analysis as tables.
fn for_people(report: &report::Report) -> String {
    let mut text = format!("{}\n", report.title);
    let replicates =
        if report.replicates > 1 { format!(" in {} replicates", report.replicates) } else { String::new() };
    let _ = writeln!(text, "{} units{replicates}, seed {}\n", report.samples, report.seed);
    let measure = |m: &report::MeasureReport| {
        let digits = |x: f64| fixed(x, 4);
        let dpm = |side: Option<report::Defects>| or_dash(side.map(|side| side.dpm), three_digits);
        let mut row =
            vec![format!("{}{}", m.name, if m.unit.is_empty() { String::new() } else { format!(", {}", m.unit) })];
        row.extend([m.mean, m.sd].map(digits));
        row.extend([m.skew, m.kurtosis].map(|x| fixed(x, 3)));
        row.extend([m.min, m.q00135, m.median, m.q99865, m.max].map(digits));
        row.extend([m.pp, m.ppk].map(|x| or_dash(x, |x| fixed(x, 3))));
        row.extend(m.dpm.map(dpm));
        row
    };
    let heading = [
        "measure",
        "mean",
        "σ",
        "skew",
        "kurt",
        "min",
        "0.135 %",
        "50 %",
        "99.865 %",
        "max",
        "Pp",
        "Ppk",
        "ppm below",
        "ppm above",
    ];
    let _ = writeln!(text, "{}", text_table(&heading, &report.measures.iter().map(measure).collect::<Vec<_>>()));
    let theory = |m: &report::MeasureReport| {
        let [low, high] = m.worst_case;
        let half = |error: &crate::tolerance::estimate::Estimate| {
            or_dash(error.error, |error| format!("±{}", three_digits(error)))
        };
        vec![
            m.name.clone(),
            half(&m.estimates.mean),
            half(&m.estimates.sd),
            format!("{} … {}", fixed(low, 4), fixed(high, 4)),
            format!("{} ± {}", fixed(m.rss.middle, 4), fixed(m.rss.tolerance, 4)),
            fixed(m.rss.sd, 4),
            fixed(m.second_order.mean, 4),
            fixed(m.second_order.sd, 4),
        ]
    };
    let heading =
        ["measure", "error of mean", "of σ", "worst case", "RSS", "σ linear", "mean 2nd order", "σ 2nd order"];
    let _ = writeln!(text, "{}", text_table(&heading, &report.measures.iter().map(theory).collect::<Vec<_>>()));
    let _ = writeln!(text, "Contributors, % of variance");
    for m in &report.measures {
        let most = m.contributors.iter().filter(|share| share.percent.abs() >= 1.0).take(6);
        let most: Vec<String> = most.map(|share| format!("{} {}", share.name, fixed(share.percent, 1))).collect();
        let _ = writeln!(text, "  {}: {}", m.name, most.join(", "));
    }
    if !report.sums.is_empty() {
        let sum = |s: &report::SumReport| {
            vec![
                s.name.clone(),
                fixed(s.mean, 4),
                fixed(s.sd, 4),
                or_dash(s.correlation, |rho| fixed(rho, 3)),
                three_digits(s.model.dpm),
                or_dash(s.model.error, |error| format!("±{}", three_digits(error))),
                three_digits(s.eq9_ppm),
                three_digits(s.independent_ppm),
            ]
        };
        let heading = ["sum < 0", "mean", "σ", "ρ", "ppm", "error", "eq. 9 (ρ = 1)", "ρ = 0"];
        let rows: Vec<_> = report.sums.iter().map(sum).collect();
        let _ = writeln!(text, "\n{}", text_table(&heading, &rows));
        text += "ppm: with the model's own correlation; eq. 9 and ρ = 0: read from means and σ alone\n";
    }
    if let Some(good) = report.yield_of_all {
        let [low, high] = good.interval.map(|end| or_dash(end.map(|end| end * 100.0), |x| fixed(x, 4)));
        let _ = writeln!(text, "\nyield {} % ({low} … {high})", fixed(good.value * 100.0, 4));
    }
    for note in &report.notes {
        let _ = writeln!(text, "note: {note}");
    }
    text
}
