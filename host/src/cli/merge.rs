//! `slipfit merge`: the shards of a study as if it had been one run.

use std::{
    io::Read,
    path::{Path, PathBuf},
};

use clap::Args;
use slipfit_core::slide::CONTACTS;
use slipfit_system::files;
use slipfit_tolerance::counting::{
    file::{Found, Part},
    run::{RunError, check, merge},
    study::Study,
};

use super::{endings, failure::Failure, population, tolerance::OutputArguments};
use crate::{
    mechanism::ByDrive,
    population::{part::StoredGaps, tally::Tally},
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
        if self.files.first().is_some_and(|path| is_of::<Tally<[f64; CONTACTS]>>(path)) {
            return self.population();
        }
        if self.files.first().is_some_and(|path| is_of::<Tally<Vec<f64>>>(path)) {
            return self.population_of_mechanism();
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

    /// All shards of a population, written as one if that is asked for.
    fn tally<G: StoredGaps>(&self) -> Result<Part<Tally<G>>, Failure> {
        if let Some(option) = self.outputs.asked() {
            return Err(Failure::Input(format!("{option}: these are shards of a population, which has no measures")));
        }
        let part: Part<Tally<G>> = merge(&self.files)?;
        let shards: Vec<_> = self.files.iter().map(|path| ("one of the shards", path.as_path())).collect();
        endings::check_part("--out", self.out.as_deref())?;
        let own: Vec<_> = self.out.iter().map(|path| ("--out", path.as_path())).collect();
        files::check_distinct(&shards, &own)?;
        if let Some(path) = &self.out {
            files::write(path, &part.encode().map_err(RunError::from)?)?;
        }
        Ok(part)
    }

    /// The shards of a mechanism's population.
    fn population_of_mechanism(&self) -> Result<(), Failure> {
        let part = self.tally::<Vec<f64>>()?;
        let (source, settings) = (&part.header.source, &part.header.settings);
        let set: Vec<_> = source.set.iter().map(|assignment| Override::set(assignment)).collect();
        let file = SceneFile::parse(&source.name, &source.text, &set)?;
        let driven = file.mechanism.as_ref().and_then(|mechanism| ByDrive::new(mechanism, settings.drive()));
        let driven = driven.ok_or_else(|| Failure::Input(format!("{}: the scene has no such drive", source.name)))?;
        population::Arguments::of_parts(settings, self.json).conclude_mechanism(
            &driven,
            part.tallies,
            file.product.as_ref(),
        )
    }

    /// The shards of a slide's population.
    fn population(&self) -> Result<(), Failure> {
        let part = self.tally()?;
        let source = &part.header.source;
        let set: Vec<_> = source.set.iter().map(|assignment| Override::set(assignment)).collect();
        let (mut scene, product) = SceneFile::parse_with_slide(&source.name, &source.text, &set)?;
        let asked = population::Arguments::of_parts(&part.header.settings, self.json);
        let production = asked.prepare(&mut scene, product.as_ref())?;
        asked.conclude(&scene, &production, part.tallies, None, product.as_ref())
    }
}

/// Whether a file begins as those of `F` do.
fn is_of<F: Found>(path: &Path) -> bool {
    let mut magic = [0; 8];
    std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut magic)).is_ok_and(|()| magic == *F::MAGIC)
}
