//! `slipfit capability`: what measured parts tell of a production.

use std::{fmt::Write, path::PathBuf};

use clap::Args;
use serde::Serialize;
use slipfit_measured::{
    capability::{Capability, Estimate, LEAST_PARTS, Options, capability},
    csv,
    families::Kind,
    table::MeasuredTable,
};
use slipfit_qif::{file, results};
use slipfit_tolerance::number::{fixed, or_dash, percent, three_digits};

use super::{
    failure::Failure,
    terminal::{print, print_json, text_table, warn},
};

/// Probability below which a test speaks against the normal distribution or against equal subgroups.
const DOUBTFUL: f64 = 0.05;

/// Tells performance and capability of measured parts by ISO 22514-2.
///
/// Intervals are of 95 %.
///
/// A CSV file has a row for each part. Its first row names the characteristics with their units, such as "length [mm]"; rows named
/// nominal, lower and upper may follow. A QIF 3.0 file of results (.qif) has all that by itself. Outliers are named and stay in every
/// figure.
#[derive(Args)]
pub(super) struct Arguments {
    /// Measured parts: CSV, or QIF results (.qif).
    file: PathBuf,
    /// Column of the CSV whose texts divide the parts into subgroups, such as a cavity or a machine.
    #[arg(long, value_name = "COLUMN")]
    group: Option<String>,
    /// Column of the CSV that labels the parts; default: "part".
    #[arg(long, value_name = "COLUMN")]
    label: Option<String>,
    /// Leaves out a column of the CSV; may be repeated.
    #[arg(long, value_name = "COLUMN")]
    ignore: Vec<String>,
    /// Prints JSON instead of text.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    parts: usize,
    characteristics: Vec<Capability>,
    refused: Vec<Refused>,
    warnings: Vec<String>,
}

/// A characteristic whose capability cannot be told.
#[derive(Serialize)]
struct Refused {
    name: String,
    why: String,
}

impl Arguments {
    /// Runs the command.
    ///
    /// # Errors
    /// A file that cannot be read, or of which no characteristic can be judged.
    pub(super) fn run(self) -> Result<(), Failure> {
        let table = self.table()?;
        let options = Options { grouping: self.group.as_ref().map(|_| 0), ..Options::default() };
        let (mut characteristics, mut refused) = (Vec::new(), Vec::new());
        for (k, column) in table.columns().iter().enumerate() {
            match capability(&table, k, &options) {
                Ok(found) => characteristics.push(found),
                Err(error) => refused.push(Refused { name: column.name.clone(), why: error.to_string() }),
            }
        }
        if let (true, Some(first)) = (characteristics.is_empty(), refused.first()) {
            return Err(Failure::Input(format!("{}: {}", self.file.display(), first.why)));
        }
        let mut warnings: Vec<String> = unjudged(&refused).into_iter().collect();
        warnings.extend(characteristics.iter().flat_map(warnings_of));
        let report = Report { parts: table.parts(), characteristics, refused, warnings };
        if self.json {
            return print_json(&report);
        }
        print(&described(&report))?;
        warn(&report.warnings);
        Ok(())
    }

    fn table(&self) -> Result<MeasuredTable, Failure> {
        let shown = self.file.display();
        if !self.file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("qif")) {
            let groups = self.group.iter().cloned().collect();
            let options = csv::Options {
                labels: self.label.clone(),
                groups,
                ignored: self.ignore.clone(),
                ..csv::Options::default()
            };
            return csv::read_file(&self.file, &options).map_err(|error| match error {
                csv::FileError::Csv(csv::CsvError { place, problem }) => {
                    let options =
                        if matches!(problem, csv::Problem::NotANumber { .. }) { " (--group, --ignore)" } else { "" };
                    Failure::Input(format!("{shown}:{}:{}: {problem}{options}", place.line, place.column))
                }
                csv::FileError::Io(error) => Failure::Input(format!("{shown}: {error}")),
            });
        }
        let given = [
            ("--group", self.group.is_some()),
            ("--label", self.label.is_some()),
            ("--ignore", !self.ignore.is_empty()),
        ];
        if let Some((option, _)) = given.into_iter().find(|(_, given)| *given) {
            return Err(Failure::Input(format!("{option} names a column of a CSV file, and {shown} is QIF")));
        }
        let text = file::read(&self.file).map_err(|error| Failure::Input(format!("{shown}: {error}")))?;
        results::read(&text).map_err(|error| Failure::Input(format!("{shown}:{error}")))
    }
}

/// That some characteristics cannot be judged, and why the first of them cannot.
fn unjudged(refused: &[Refused]) -> Option<String> {
    let why = &refused.first()?.why;
    Some(match refused.len() {
        1 => why.clone(),
        count => format!("{why}; {} more characteristics cannot be judged, and --json says why", count - 1),
    })
}

/// What to look at in a characteristic.
fn warnings_of(of: &Capability) -> Vec<String> {
    let name = &of.name;
    let digits = digits(of.deviation.value);
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
    if let Some(normality) = of.normality.as_ref().filter(|normality| normality.p < DOUBTFUL) {
        let by_points = match of.points.as_ref().filter(|points| points.family != Kind::Normal) {
            Some(points) => format!(
                ": {} fits better, with Ppk {} by its points",
                points.family.name(),
                or_dash(points.least, |x| fixed(x, 2))
            ),
            None => String::new(),
        };
        warnings.push(format!(
            "\"{name}\" is hardly normal (Anderson–Darling, p = {}){by_points}",
            three_digits(normality.p)
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

/// Decimals with which a value has three digits of its standard `deviation`.
fn digits(deviation: f64) -> usize {
    let magnitude = libm::floor(libm::log10(deviation.max(1e-12)));
    (2.0 - magnitude).clamp(0.0, 12.0) as usize
}

/// An index with its interval.
fn index(estimate: Option<Estimate>) -> String {
    or_dash(estimate, |Estimate { value, interval: [low, high] }| {
        format!("{} [{}, {}]", fixed(value, 2), fixed(low, 2), fixed(high, 2))
    })
}

/// The report as text.
fn described(report: &Report) -> String {
    let mut text = format!("{} parts; intervals of 95 %\n\n", report.parts);
    let row = |of: &Capability| {
        let digits = digits(of.deviation.value);
        let number = |value: f64| fixed(value, digits);
        let [lower, upper] = of.limits.map(|limit| or_dash(limit, number));
        let unit = of.unit.symbol();
        vec![
            if unit.is_empty() { of.name.clone() } else { format!("{} ({unit})", of.name) },
            of.count.to_string(),
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
    let heading = ["characteristic", "parts", "mean", "s", "lower", "upper", "Pp", "Ppk", "outside, %"];
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
        let digits = digits(of.deviation.value);
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
    let few = report.characteristics.iter().filter(|of| of.count < LEAST_PARTS).count();
    if few > 0 {
        let _ = writeln!(text, "\nNo test of normality below {LEAST_PARTS} parts: the normal distribution is assumed.");
    }
    text
}
