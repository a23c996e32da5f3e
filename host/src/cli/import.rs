//! `slipfit import`: the tolerances of a model as a part of a scene.

use std::path::{Path, PathBuf};

use clap::Args;
use slipfit_qif::{
    drawing::Drawing,
    file, model,
    part::{
        self,
        update::{UpdateError, Updated, update},
    },
};
use slipfit_system::files;

use super::{
    arguments::text_of,
    endings,
    failure::{Failure, refused},
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
    /// Renews the part in a scene that has it, and says what changed.
    ///
    /// Everything that was not imported stays: mates, measures, features and keys of your own, and tolerances that you changed while the
    /// model did not. The scene itself is written unless `--output` names another file.
    #[arg(long, value_name = "SCENE")]
    update: Option<PathBuf>,
}

impl Arguments {
    /// Runs the command.
    ///
    /// # Errors
    /// A file that cannot be read or is no QIF model; a part that cannot be written; a scene that does not have it.
    pub(super) fn run(self) -> Result<(), Failure> {
        let output = self.output.as_ref().map(|path| ("--output", path));
        let output = output.or(self.update.as_ref().map(|path| ("--update", path)));
        if let Some((option, path)) = output {
            let outputs = [(option, path.as_path())];
            endings::check_one(option, path, &["toml"])?;
            files::check_distinct(&[("the model", &self.model)], &outputs)?;
            files::check_writable(path).map_err(refused)?;
        }
        let shown = self.model.display();
        let text = file::read(&self.model).map_err(|error| Failure::Input(format!("{shown}: {error}")))?;
        let drawing = model::read(&text).map_err(|error| Failure::Input(format!("{shown}:{error}")))?;
        let source = self.model.file_name().unwrap_or_default().to_string_lossy();
        let (part, text) = match &self.update {
            None => {
                let part = part::write(&drawing, self.name.as_deref(), &source);
                let text = part.file();
                (part, text)
            }
            Some(scene) => {
                let Updated { text, part, changes } = self.updated(scene, &drawing, &source)?;
                let none = changes.is_empty().then(|| format!("nothing of the part {} changes", part.name));
                none.iter().chain(&changes).for_each(|change| tell(change));
                (part, text)
            }
        };
        match output {
            Some((_, path)) => files::write(path, text.as_bytes())?,
            None => write_out(&[&text]).map_err(anyhow::Error::from)?,
        }
        let (total, listed) = (part.stated.len(), part.listed());
        tell(&format!("{} of {total} tolerances and dimensions are in the part, {listed} are listed", total - listed));
        Ok(())
    }

    fn updated(&self, scene: &Path, drawing: &Drawing, source: &str) -> Result<Updated, Failure> {
        let text = text_of(scene)?;
        update(&text, drawing, self.name.as_deref(), source).map_err(|error| {
            let place = if matches!(error, UpdateError::Toml { .. }) { ":" } else { ": " };
            let option = if matches!(error, UpdateError::NoPart { .. }) { " (--name)" } else { "" };
            Failure::Input(format!("{}{place}{error}{option}", scene.display()))
        })
    }
}
