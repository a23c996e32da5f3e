//! Files of measured parts: CSV, or QIF results.

use std::path::Path;

use slipfit_measured::{
    csv::{self, CsvError, FileError, Options},
    table::MeasuredTable,
};
use slipfit_qif::{file, results};

/// A file of measured parts that cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum PartsError {
    /// A mistake in a CSV file.
    #[error("{name}:{}:{}: {}", error.place.line, error.place.column, error.problem)]
    Csv {
        /// The file.
        name: String,
        /// What is wrong, and where.
        error: Box<CsvError>,
    },
    /// A file that the system does not give, or a mistake in QIF results: all of it in words.
    #[error("{0}")]
    Other(String),
}

/// Whether a file holds QIF results by its name.
pub fn is_qif(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("qif"))
}

/// Reads the file at `path`: QIF results, or CSV with these `options`.
///
/// # Errors
/// [`PartsError`] with the file's name, and line and column where it was read.
pub fn load(path: &Path, options: &Options) -> Result<MeasuredTable, PartsError> {
    let shown = path.display();
    if is_qif(path) {
        let text = file::read(path).map_err(|error| PartsError::Other(format!("{shown}: {error}")))?;
        return results::read(&text).map_err(|error| PartsError::Other(format!("{shown}:{error}")));
    }
    csv::read_file(path, options).map_err(|error| match error {
        FileError::Csv(error) => PartsError::Csv { name: shown.to_string(), error: Box::new(error) },
        FileError::Io(error) => PartsError::Other(format!("{shown}: {error}")),
    })
}
