//! `slipfit merge`: the shards of a study as if it had been one run.

use std::{
    io::Read,
    path::{Path, PathBuf},
};

use clap::Args;
use slipfit_system::files;
use slipfit_tolerance::counting::{
    file::{Found, Part},
    run::{RunError, check, merge},
    study::Study,
};

use super::{
    arguments::Moving, by_one_drive::ByOneDrive, endings, failure::Failure, population, tolerance::OutputArguments,
};
use crate::{
    population::tally::Tally,
    scene::{Override, SceneFile},
    setup::Measured,
};

/// Joins the parts that `tolerance --shard` or `population --shard` wrote.
///
/// The result has the same bytes as that of one run without `--shard`.
#[derive(Args)]
pub(super) struct Arguments {
    /// Files that `slipfit tolerance --shard` or `slipfit population --shard` wrote.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Writes all parts as one file.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Prints JSON instead of text.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    outputs: OutputArguments,
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        if self.files.first().is_some_and(|path| is_of::<Tally>(path)) {
            return self.population();
        }
        let part: Part = merge(&self.files)?;
        let source = &part.header.source;
        let set: Vec<_> = source.set.iter().map(|assignment| Override::set(assignment)).collect();
        let file = SceneFile::parse(&source.name, &source.text, &set)?;
        if file.measured.as_deref().map(Measured::hash) != source.measured {
            let name = &source.name;
            return Err(Failure::Input(format!(
                "{name}: its measured parts are others than when the shards were drawn"
            )));
        }
        let nothing = || Failure::Input(format!("{}: the scene describes no product", source.name));
        let model = &file.product.as_ref().ok_or_else(nothing)?.model;
        check(&part, self.files.first().map_or(Path::new(""), |path| path), model)?;
        let shards: Vec<_> = self.files.iter().map(|path| ("one of the shards", path.as_path())).collect();
        endings::check_part("--out", self.out.as_deref())?;
        let own: Vec<_> = self.out.iter().map(|path| ("--out", path.as_path())).collect();
        self.outputs.prepare(&shards, &own, model.measures.len())?;
        let study = Study::new(model, part.header.settings).map_err(RunError::from)?;
        if let Some(path) = &self.out {
            files::write(path, &part.encode().map_err(RunError::from)?)?;
        }
        self.outputs.check_level(file.slide.is_some())?;
        self.outputs.show(&file.title, file.slide.as_ref(), file.measured.as_deref(), &study, &part.tallies, self.json)
    }

    /// The shards of a population, written as one if that is asked for.
    fn population(&self) -> Result<(), Failure> {
        if let Some(option) = self.outputs.asked() {
            return Err(Failure::Input(format!("{option}: these are shards of a population, which has no measures")));
        }
        let part: Part<Tally> = merge(&self.files)?;
        let shards: Vec<_> = self.files.iter().map(|path| ("one of the shards", path.as_path())).collect();
        endings::check_part("--out", self.out.as_deref())?;
        let own: Vec<_> = self.out.iter().map(|path| ("--out", path.as_path())).collect();
        files::check_distinct(&shards, &own)?;
        if let Some(path) = &self.out {
            files::write(path, &part.encode().map_err(RunError::from)?)?;
        }
        let (source, settings) = (&part.header.source, &part.header.settings);
        let set: Vec<_> = source.set.iter().map(|assignment| Override::set(assignment)).collect();
        let (mut moving, product) = Moving::parse(&source.name, &source.text, &set)?;
        let asked = population::Arguments::of_parts(settings, self.json);
        asked.set_length(&mut moving)?;
        let nothing = || Failure::Input(format!("{}: the scene has no such drive", source.name));
        let of = ByOneDrive::numbered(&moving, settings.drive()).ok_or_else(nothing)?;
        let production = of.production(product.as_ref(), settings.correlation(), settings.seed)?;
        asked.conclude(&of, &production, part.tallies, None, product.as_ref())
    }
}

/// Whether a file begins as those of `F` do.
fn is_of<F: Found>(path: &Path) -> bool {
    let mut magic = [0; 8];
    std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut magic)).is_ok_and(|()| magic == *F::MAGIC)
}
