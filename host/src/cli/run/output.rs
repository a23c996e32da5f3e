//! Where the files of a run go.

use std::path::PathBuf;

use slipfit_system::files;

use crate::show::measures_csv::measures_csv;

use crate::{
    cli::{
        arguments::SceneArguments,
        failure::{Failure, refused},
    },
    show::{
        plot::PlotError,
        report::{Figure, Production},
    },
};

/// The page.
pub const PAGE: &str = "report.html";
/// The flash table.
pub const TABLE: &str = "table.bin";
/// The pictures: of one run, of a run that is the opening of a stroke, and of the stroke.
pub const FIGURES: [&str; 11] = [
    "verdict.svg",
    "velocity.svg",
    "force.svg",
    "torque.svg",
    "opening-velocity.svg",
    "opening-force.svg",
    "opening-torque.svg",
    "stroke-velocity.svg",
    "stroke-force.svg",
    "stroke-torque.svg",
    "mechanism.svg",
];
/// Figures over n.
pub const SWEEP: &str = "sweep.csv";
/// The statistics of the product's measures.
const MEASURES: &str = "tolerance.csv";

/// Files of others that are named.
const STRANGERS: usize = 3;

/// Files by name.
pub type Files = Vec<(String, Vec<u8>)>;

/// The folder that a run writes into.
pub struct Output {
    folder: PathBuf,
    made: bool,
}

impl Output {
    /// The `folder`, made if it is not there, with room for the files of these names and those of the `production`.
    ///
    /// # Errors
    /// If one of them cannot be written or is the scene itself.
    pub fn prepare(
        folder: PathBuf,
        scene: &SceneArguments,
        names: &[&str],
        production: Option<&Production>,
    ) -> Result<Self, Failure> {
        let made = !folder.exists();
        files::prepare_folder(&folder).map_err(refused)?;
        let pictures = production.iter().flat_map(|production| &production.pictures);
        let names = names.iter().copied().chain([PAGE, TABLE, SWEEP, MEASURES]);
        let paths: Vec<_> =
            names.chain(pictures.map(|picture| picture.file.as_str())).map(|name| folder.join(name)).collect();
        let named: Vec<_> = paths.iter().map(|path| ("--out", path.as_path())).collect();
        scene.check_outputs(&named)?;
        Ok(Self { folder, made })
    }

    /// The page's path.
    pub fn page(&self) -> PathBuf {
        self.folder.join(PAGE)
    }

    /// Writes `files`, and gives their paths.
    pub fn write(&self, files: &Files) -> Result<Vec<String>, Failure> {
        let paths: Vec<_> = files.iter().map(|(name, _)| self.folder.join(name)).collect();
        for (path, (_, bytes)) in paths.iter().zip(files) {
            files::write(path, bytes)?;
        }
        Ok(paths.iter().map(|path| path.display().to_string()).collect())
    }

    /// A warning of files in the folder that this run does not write.
    pub fn strangers(&self, files: &Files) -> Option<String> {
        let mut names: Vec<String> = std::fs::read_dir(&self.folder)
            .ok()?
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .filter(|name| !files.iter().any(|(own, _)| own == name))
            .collect();
        names.sort();
        let left = names.len().saturating_sub(STRANGERS);
        names.truncate(STRANGERS);
        let more = if left > 0 { format!(" and {left} more") } else { String::new() };
        let (folder, names) = (self.folder.display(), names.join(", "));
        (!names.is_empty()).then(|| format!("{folder} also holds what this run did not write: {names}{more}"))
    }

    /// Gives back what was `done`; after a failure, the folder goes if this run made it and wrote nothing.
    pub fn close(self, done: Result<(), Failure>) -> Result<(), Failure> {
        if self.made && done.is_err() {
            // Only if nothing was written.
            let _ = std::fs::remove_dir(&self.folder);
        }
        done
    }
}

/// A figure with its caption.
pub fn captioned(caption: &str, svg: Result<String, PlotError>) -> Result<Figure, Failure> {
    Ok(Figure { caption: caption.into(), svg: svg.map_err(anyhow::Error::from)? })
}

/// The files of the product's analysis.
pub fn of_production(production: Option<&Production>) -> Result<Files, Failure> {
    let Some(Production { report, pictures }) = production else { return Ok(Vec::new()) };
    let mut files = vec![(MEASURES.to_owned(), measures_csv(report)?)];
    files.extend(pictures.iter().map(|picture| (picture.file.clone(), picture.svg.clone().into_bytes())));
    Ok(files)
}
