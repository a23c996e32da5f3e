//! `slipfit merge`: the shards of a study as if it had been one run.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{Failure, tolerance::OutputArguments};
use crate::{
    files,
    scene::{Override, SceneFile},
    tolerance::{
        run::{RunError, check, merge},
        study::Study,
    },
};

/// Joins the shards of a tolerance analysis, in any order: the same bytes as one run.
#[derive(Args)]
pub(super) struct Arguments {
    /// Files that `slipfit tolerance --shard` wrote.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Writes the whole study as one file.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Prints JSON for machines.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    outputs: OutputArguments,
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let part = merge(&self.files)?;
        let source = &part.header.source;
        let set: Vec<_> = source.set.iter().map(|assignment| Override::set(assignment)).collect();
        let file = SceneFile::parse(&source.name, &source.text, &set)?;
        let nothing = || Failure::Input(format!("{}: the scene describes no product", source.name));
        let model = &file.product.as_ref().ok_or_else(nothing)?.model;
        check(&part, self.files.first().map_or(Path::new(""), |path| path), model)?;
        let shards: Vec<_> = self.files.iter().map(|path| ("one of the shards", path.as_path())).collect();
        let own: Vec<_> = self.out.iter().map(|path| ("--out", path.as_path())).collect();
        self.outputs.prepare(&shards, &own, model.measures.len())?;
        let study = Study::new(model, part.header.settings).map_err(RunError::from)?;
        if let Some(path) = &self.out {
            files::write(path, &part.encode().map_err(RunError::from)?)?;
        }
        self.outputs.show(&file.title, file.slide.as_ref(), &study, &part.tallies, self.json)
    }
}
