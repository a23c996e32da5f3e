//! Tables of measured parts as CSV.
//!
//! The first row names the columns, with their units in brackets; each further row is a part:
//!
//! ```csv
//! part,cavity,length [mm],angle [°]
//! nominal,,208,90
//! lower,,207.964,
//! upper,,208.036,90.5
//! 1,A,208.011,90.12
//! 2,B,207.998,-
//! ```
//!
//! - The rows `nominal`, `lower` and `upper` directly after the head, each of which may be absent, state the nominal
//!   values and the limits. If there is one, the first column labels the parts.
//! - The first column also labels the parts if its name is `part`; another one if [`Options::labels`] names it.
//! - Text columns that [`Options::groups`] names divide the parts into subgroups. All others hold numbers.
//! - A missing value is empty, `-`, `NA` or `NaN`. Rows whose cells are all empty are skipped.
//! - Cells are divided by semicolons or tabulators if the first row has any, otherwise by commas. Unless it divides
//!   cells, a comma may be the decimal mark, but then of all numbers.
//! - The text is UTF-8, with or without a byte order mark; cells in quotation marks may hold anything.

mod cells;
mod error;
mod options;
mod read;
pub mod series;
#[cfg(test)]
mod tests;
mod write;

use std::{
    fs::File as Source,
    io::{self, Read},
    path::Path,
};

use self::cells::delimiter;
pub use self::error::{CsvError, Place, Problem, Shown};
pub use self::options::{LARGEST, Options};
use self::read::File;
pub use self::write::write;
use crate::table::MeasuredTable;

/// A CSV file that could not be read.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The system does not give the file.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The file is wrong.
    #[error(transparent)]
    Csv(#[from] CsvError),
}

/// Reads a file; one that is too large is refused before it is read, and a pipe after as many bytes.
pub fn read_file(path: &Path, options: &Options) -> Result<MeasuredTable, FileError> {
    Ok(read(&bytes_of(path, options.largest)?, options)?)
}

/// The bytes of a file, or of a pipe that ends, of which there may be at most `limit`.
fn bytes_of(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let source = Source::open(path)?;
    check_size(source.metadata()?.len(), limit)?;
    let mut bytes = Vec::new();
    source.take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
    check_size(bytes.len() as u64, limit)?;
    Ok(bytes)
}

fn check_size(bytes: u64, limit: u64) -> Result<(), CsvError> {
    if bytes <= limit {
        return Ok(());
    }
    Err(CsvError { place: Place { line: 1, column: 1, span: 0..0 }, problem: Problem::TooLarge { bytes, limit } })
}

/// Reads the bytes of a file.
pub fn read(bytes: &[u8], options: &Options) -> Result<MeasuredTable, CsvError> {
    check_size(bytes.len() as u64, options.largest)?;
    let (text, start) = text_of(bytes)?;
    File { text, start, delimiter: delimiter(&text[start..]) }.read(options)
}

/// The text of a file, and the first byte after a byte order mark.
fn text_of(bytes: &[u8]) -> Result<(&str, usize), CsvError> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let at = error.valid_up_to();
        CsvError { place: Place::new(bytes, at..at + 1), problem: Problem::NotUtf8 }
    })?;
    Ok((text, if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 }))
}
