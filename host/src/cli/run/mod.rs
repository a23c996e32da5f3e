//! `slipfit run`: the main job, from tolerances to a flash table and a report. Its first lines are the answer.

mod advice;
mod output;
mod simulated;
mod told;

use std::path::{Path, PathBuf};

use clap::Args;
use slipfit_tolerance::{
    analysis::conclude,
    counting::{run::RunError, study::Study},
    number::fixed,
    product::Product,
    report::report,
};

use super::{
    arguments::{DRAWING, DriveArguments, SceneArguments, ThreadArguments},
    by_one_drive::ByOneDrive,
    failure::Failure,
    population::page::{self, UNKNOWN_FIGURE},
    sweep::LevelArguments,
    terminal::progress,
    tolerance::DEFAULT,
};
use output::{FIGURES, Output};

use crate::{
    dynamics::{answer::ranges, driven::Driven, sweep::Sweep},
    firmware::force_table::{self, Demand},
    show::{report::Production, tolerances::pictures},
};

/// The main job: says at which tolerance levels the product works and what force it takes.
///
/// For slides and mechanisms. Analyses the tolerances, where the scene has a product. Simulates the opening and the whole stroke of
/// a slide, or the run of a mechanism, at every level, and units of the production. Writes the flash table over time, and a
/// page with all pictures.
#[derive(Args)]
#[command(mut_arg("scene", |arg| arg.default_value(DRAWING)))]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Folder for the report and the other files; if not given, slipfit-out with a folder named after the scene.
    ///
    /// It gets report.html, table.bin, sweep.csv and the figures; for a product also tolerance.csv and pictures of its measures.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    drive: DriveArguments,
    #[command(flatten)]
    levels: LevelArguments,
    /// Units of the production to simulate one by one; 512 if not given.
    ///
    /// `slipfit population` simulates more units and tells more about them. With `[uncertain]` in the scene four times as many more are
    /// simulated.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    units: Option<u64>,
    #[command(flatten)]
    threads: ThreadArguments,
}

impl Arguments {
    /// Looks whether there can be a table, analyses the product and fills the folder.
    pub fn run(&self) -> Result<(), Failure> {
        let overrides: Vec<_> = self.levels.overrides().into_iter().collect();
        let (moving, product) = self.scene.load_moving_with_product(&overrides)?;
        let of = ByOneDrive::new(&moving, &self.drive)?;
        force_table::check(of.subject(), Demand::Full).map_err(|error| Failure::Input(error.to_string()))?;
        let analysed = product.as_ref().map(|product| self.analyse(of.subject().title(), product)).transpose()?;
        let folder = self.out.clone().unwrap_or_else(|| Path::new(OUT).join(self.scene.stem()));
        let figures = [FIGURES.as_slice(), &page::FIGURES, &[UNKNOWN_FIGURE]].concat();
        let output = Output::prepare(folder, &self.scene, &figures, analysed.as_ref())?;
        let done = self.fill(&output, &of, product.as_ref(), analysed);
        output.close(done)
    }

    /// Draws and analyses as `slipfit tolerance` does unless it is asked for something else.
    fn analyse(&self, title: &str, product: &Product) -> Result<Production, Failure> {
        let study = Study::new(&product.model, DEFAULT).map_err(RunError::from)?;
        let mut tallies = study.empty();
        let bar = progress("drawing", DEFAULT.samples as usize);
        let found = self.threads.install(|| {
            study.add(0..DEFAULT.blocks(), &mut tallies, |units| bar.inc(units));
            conclude(&study, &tallies)
        })?;
        bar.finish_and_clear();
        let report = report(title, &product.model, &found.map_err(RunError::from)?);
        let pictures = pictures(&report, &study, &tallies).map_err(anyhow::Error::from)?;
        Ok(Production { report, pictures })
    }
}

/// Where runs go that name no folder, each scene into one of its own: the next scene's run leaves this one's files alone.
const OUT: &str = "slipfit-out";

/// Units of the production that are simulated where no number is given.
const UNITS: u64 = 512;

/// The most ranges of levels on the first screen.
const RANGES: usize = 6;

/// From which level to which the sweep runs, crawls or jams, a line each: all ranges, or the widest if there are many.
fn answer(sweep: &Sweep) -> String {
    let ranges = ranges(sweep);
    let mut widest: Vec<usize> = (0..ranges.len()).collect();
    let width = |k: &usize| ranges[*k].last - ranges[*k].first;
    widest.sort_by(|one, other| width(other).total_cmp(&width(one)).then(one.cmp(other)));
    let most = if ranges.len() > RANGES { RANGES - 1 } else { RANGES };
    widest.truncate(most);
    widest.sort_unstable();
    let mut text: String = widest.iter().map(|k| ranges[*k].describe() + "\n").collect();
    let left = ranges.len() - widest.len();
    if left > 0 {
        text += &format!("{left} narrower ranges are not shown here: sweep.csv has every level\n");
    }
    text
}

/// The table's size and error, in words.
fn table_line(driven: &dyn Driven, table: &force_table::ForceTable) -> String {
    let kind = driven.kind();
    format!(
        "{} bytes, {} ms, {} within {} {} from the ramp's start on",
        table.bytes.len(),
        fixed(driven.run().duration * 1e3, 0),
        kind.effort(),
        fixed(table.worst_error_in_use[0], 5),
        kind.effort_unit()
    )
}
