//! `slipfit capability`: what measured parts tell of a production.

mod report;
mod words;

use std::path::PathBuf;

use clap::Args;
use slipfit_measured::{
    capability::{Options, capability},
    csv,
    families::Kind,
    table::MeasuredTable,
};
use slipfit_system::{files, parallel};

use self::report::{Refused, Report};
use super::{
    endings,
    failure::{Failure, refused},
    terminal::{print, print_json, warn},
};
use crate::{
    scene::{PartsError, is_qif, load_parts},
    show::report::measured_page,
};

/// Tells performance and capability of measured parts by ISO 22514-2.
///
/// Intervals are of 95 %. They are of the distribution that the parts choose, from 30 parts on, or of the one that --family states.
///
/// A CSV file has a row for each part. Its first row names the characteristics with their units, such as "length [mm]"; rows named
/// nominal, lower and upper (or target, LSL and USL) state limits. A QIF 3.0 file of results (.qif) has all that by itself. Outliers are
/// named and stay in every figure.
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
    /// Family of the distribution; default: chosen from the parts, of which that takes 30.
    #[arg(long, value_name = "NAME", value_parser = family)]
    family: Option<Kind>,
    /// Writes a page with pictures of every characteristic.
    #[arg(long, value_name = "FILE")]
    page: Option<PathBuf>,
    /// Prints JSON instead of text.
    #[arg(long)]
    json: bool,
}

fn family(name: &str) -> Result<Kind, String> {
    let names = Kind::ALL.map(Kind::name);
    let known = Kind::ALL.into_iter().find(|kind| kind.name() == name);
    known.ok_or_else(|| format!("allowed are {}", names.join(", ")))
}

impl Arguments {
    /// Runs the command.
    ///
    /// # Errors
    /// A file that cannot be read, or of which no characteristic can be judged.
    pub(super) fn run(self) -> Result<(), Failure> {
        if let Some(page) = &self.page {
            let outputs = [("--page", page.as_path())];
            endings::check(&outputs)?;
            files::check_distinct(&[("the measured parts", &self.file)], &outputs)?;
            files::check_writable(page).map_err(refused)?;
        }
        let table = self.table()?;
        let grouping = self.group.as_ref().map(|_| 0);
        let options = Options { family: self.family, grouping, ..Options::default() };
        let (mut characteristics, mut unjudged, mut errors) = (Vec::new(), Vec::new(), Vec::new());
        let found = parallel::each(table.columns().len(), |k| capability(&table, k, &options));
        for (column, found) in table.columns().iter().zip(found) {
            match found {
                Ok(found) => characteristics.push(found),
                Err(error) => {
                    unjudged.push(Refused { name: column.name.clone(), why: error.to_string() });
                    errors.push(error);
                }
            }
        }
        if let (true, Some(first)) = (characteristics.is_empty(), errors.first()) {
            return Err(Failure::Input(format!("{}: {}", self.file.display(), words::advised(first))));
        }
        let mut warnings: Vec<String> = words::unjudged(&errors).into_iter().collect();
        warnings.extend(characteristics.iter().flat_map(words::warnings_of));
        if let Some(group) = self.group.as_ref().filter(|_| characteristics.iter().all(|of| of.within.is_none())) {
            warnings.push(format!("no two subgroups by {group} have parts that differ, so there are no Cp and Cpk"));
        }
        let report = Report { parts: table.parts(), characteristics, refused: unjudged, warnings };
        if let Some(path) = &self.page {
            let source = self.file.file_name().unwrap_or_default().to_string_lossy();
            let page = measured_page(&source, &table, &report.characteristics, grouping, &report.warnings);
            files::write(path, page.map_err(anyhow::Error::from)?.into_string().as_bytes())?;
        }
        if self.json {
            return print_json(&report);
        }
        print(&words::described(&report))?;
        warn(&report.warnings);
        Ok(())
    }

    fn table(&self) -> Result<MeasuredTable, Failure> {
        let given = [
            ("--group", self.group.is_some()),
            ("--label", self.label.is_some()),
            ("--ignore", !self.ignore.is_empty()),
        ];
        if let Some((option, _)) = given.into_iter().find(|(_, given)| *given && is_qif(&self.file)) {
            let shown = self.file.display();
            return Err(Failure::Input(format!("{option} names a column of a CSV file, and {shown} is QIF")));
        }
        let options = csv::Options {
            labels: self.label.clone(),
            groups: self.group.iter().cloned().collect(),
            ignored: self.ignore.clone(),
            ..csv::Options::default()
        };
        load_parts(&self.file, &options).map_err(|error| {
            let is_text =
                matches!(&error, PartsError::Csv { error, .. } if matches!(error.problem, csv::Problem::NotANumber { .. }));
            Failure::Input(format!("{error}{}", if is_text { " (--group, --ignore)" } else { "" }))
        })
    }
}
