//! `slipfit import`: the tolerances of a model as a part of a scene.

use std::path::PathBuf;

use clap::Args;
use slipfit_qif::{file, model, part};
use slipfit_system::files;

use super::{
    failure::Failure,
    terminal::{tell, write_out},
};

/// Turns the features, datums and tolerances of a QIF 3.0 product model into a `[[part]]`.
///
/// Every tolerance of the model is in the part, or stands as a comment with its feature and in a counted list at the end. One
/// measure is added as an example, so that `slipfit check` accepts the file.
#[derive(Args)]
pub(super) struct Arguments {
    /// QIF 3.0 file of the model (.qif).
    model: PathBuf,
    /// Writes the part to this file instead of the terminal.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Name of the part; default: the one in the model.
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
}

impl Arguments {
    /// Runs the command.
    ///
    /// # Errors
    /// A file that cannot be read or is no QIF model; a part that cannot be written.
    pub(super) fn run(self) -> Result<(), Failure> {
        let shown = self.model.display();
        let text = file::read(&self.model).map_err(|error| Failure::Input(format!("{shown}: {error}")))?;
        let drawing = model::read(&text).map_err(|error| Failure::Input(format!("{shown}:{error}")))?;
        let source = self.model.file_name().unwrap_or_default().to_string_lossy();
        let part = part::write(&drawing, self.name.as_deref(), &source);
        let listed = part.stated.iter().filter(|stated| !stated.refused.is_empty()).count();
        match &self.output {
            Some(path) => files::write(path, part.file().as_bytes())?,
            None => write_out(&[&part.file()]).map_err(anyhow::Error::from)?,
        }
        let total = part.stated.len();
        tell(&format!("{} of {total} tolerances and dimensions are in the part, {listed} are listed", total - listed));
        Ok(())
    }
}
