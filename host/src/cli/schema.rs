//! `slipfit schema`: JSON Schema of scene files, for editors.

use std::path::PathBuf;

use clap::Args;
use slipfit_system::files;

use super::{
    endings,
    failure::{Failure, refused},
    terminal::write_out,
};

/// Prints the JSON Schema of scene files, for completion and checks in an editor.
///
/// Editors that use Taplo, such as VS Code with Even Better TOML, read it where the first line of a scene is
/// `#:schema ./slipfit.schema.json`.
#[derive(Args)]
pub(super) struct Arguments {
    /// Writes the schema to this file instead of the terminal.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// The schema, which the tests write from the keys that the program reads.
pub(super) const SCHEMA: &str = include_str!("../../schema.json");

impl Arguments {
    /// Runs the command.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub(super) fn run(self) -> Result<(), Failure> {
        let Some(path) = self.output else { return Ok(write_out(&[SCHEMA]).map_err(anyhow::Error::from)?) };
        endings::check_one("--output", &path, &["json"])?;
        files::check_writable(&path).map_err(refused)?;
        Ok(files::write(&path, SCHEMA.as_bytes())?)
    }
}
