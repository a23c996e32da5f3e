//! What an analysis prints and writes.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use slipfit_system::files;
use slipfit_tolerance::{
    analysis::conclude,
    counting::{
        run::RunError,
        study::{Study, Tally},
    },
    report,
};

use super::{gaps::Columns, tables::tables};
use crate::{
    cli::{
        call, endings,
        failure::{Failure, refused},
        terminal::{print, print_json, progress},
    },
    mechanism::closing::closing_level,
    possible::{self, PRODUCTIONS},
    setup::{Measured, Scene},
    show::{
        measures_csv::measures_csv,
        tolerances::{Picture, file_names, pictures},
    },
};

fn finite(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|n: &f64| n.is_finite()).ok_or_else(|| "allowed is any finite number".into())
}

/// What is written of an analysis.
#[derive(Args)]
pub struct OutputArguments {
    /// Tolerance level at which a slide's clearances are shown; positive is tighter.
    ///
    /// The default is the level that closes the first pair of gaps, to a hundredth: 3.43 for the paper's slide.
    #[arg(long, allow_hyphen_values = true, value_parser = finite)]
    n: Option<f64>,
    /// Writes the measures' statistics as CSV.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draws histograms, contributors and correlations as SVG files in a folder.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
}

impl OutputArguments {
    /// Whether what is written of `measures` measures, and the `files` that other options ask for, can be written, and
    /// none is an input or another output.
    pub fn prepare(
        &self,
        inputs: &[(&str, &Path)],
        files: &[(&'static str, &Path)],
        measures: usize,
    ) -> Result<(), Failure> {
        let files: Vec<_> =
            files.iter().copied().chain(self.csv.iter().map(|path| ("--csv", path.as_path()))).collect();
        let folder = self.plots.as_deref();
        let pictures: Vec<_> =
            folder.map_or_else(Vec::new, |dir| file_names(measures).map(|name| dir.join(name)).collect());
        let plots = folder.into_iter().chain(pictures.iter().map(PathBuf::as_path)).map(|path| ("--plots", path));
        endings::check(&files)?;
        files::check_distinct(inputs, &files.iter().copied().chain(plots).collect::<Vec<_>>())?;
        files.iter().try_for_each(|(_, path)| files::check_writable(path).map_err(refused))?;
        let Some(folder) = folder else { return Ok(()) };
        let made = !folder.exists();
        files::prepare_folder(folder).map_err(refused)?;
        if made {
            // Made when there is something to put into it. Where it cannot be removed it stays, and does no harm.
            let _ = std::fs::remove_dir(folder);
        }
        Ok(())
    }

    /// The level at which the clearances of `slide` are shown.
    pub fn level(&self, slide: &Scene) -> f64 {
        self.n.unwrap_or_else(|| closing_level(slide))
    }

    /// Refuses a level where the scene `has_slide` not.
    ///
    /// # Errors
    /// If a level is given.
    pub fn check_level(&self, has_slide: bool) -> Result<(), Failure> {
        match self.n {
            Some(_) if !has_slide => {
                Err(Failure::Input("--n: the scene has no slide whose clearances a level could change".into()))
            }
            _ => Ok(()),
        }
    }

    /// The option given that asks for a file, if any does.
    pub fn asked(&self) -> Option<&'static str> {
        self.csv.as_ref().map(|_| "--csv").or(self.plots.as_ref().map(|_| "--plots"))
    }

    /// Shows and writes what was found of `study`, with Table 2's derived columns if the scene has a `slide`; intervals
    /// include what the parts that were `measured` leave open.
    pub fn show(
        &self,
        title: &str,
        slide: Option<&Scene>,
        measured: Option<&Measured>,
        study: &Study,
        tallies: &[Tally],
        json: bool,
    ) -> Result<(), Failure> {
        let analysis = conclude(study, tallies).map_err(RunError::from)?;
        let mut report = report::report(title, study.model, &analysis);
        if let Some(measured) = measured.filter(|measured| measured.has_contributors()) {
            let bar = progress("weighing what the parts leave open", PRODUCTIONS);
            let possible =
                possible::reports(study.model, measured, study.settings, || bar.inc(1)).map_err(RunError::from)?;
            bar.finish_and_clear();
            report::widen(&mut report, &possible);
            report.notes.insert(0, possible::note(measured));
        }
        if let Some(path) = &self.csv {
            files::write(path, &measures_csv(&report)?)?;
        }
        if let Some(folder) = &self.plots {
            files::prepare_folder(folder).map_err(refused)?;
        }
        if self.plots.is_some() || call::wants_pictures() {
            for Picture { file, svg, .. } in pictures(&report, study, tallies).map_err(anyhow::Error::from)? {
                let path = self.plots.as_ref().map(|folder| folder.join(&file));
                call::picture(path.as_deref(), file.trim_end_matches(".svg"), || Ok(svg))?;
            }
        }
        let columns = slide.map(|slide| Columns::new(slide, self.level(slide)));
        if json {
            return print_json(&Shown { report: &report, columns });
        }
        let columns = columns.map(|columns| format!("\n{columns}")).unwrap_or_default();
        print(&(tables(&report) + &columns))
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
