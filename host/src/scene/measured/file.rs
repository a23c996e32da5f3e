//! Files of measured parts: CSV, or QIF results.

use std::path::Path;

use slipfit_measured::{csv, table::MeasuredTable};
use slipfit_qif::{file, results};

/// Reads the columns `headings` of the file at `path`, whose parts a column of a CSV file may divide into groups.
///
/// # Errors
/// What is wrong, with the file's name, line and column.
pub fn load(path: &Path, group: Option<&str>, headings: &[String]) -> Result<MeasuredTable, String> {
    let shown = path.display();
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("qif")) {
        let text = file::read(path).map_err(|error| format!("{shown}: {error}"))?;
        return results::read(&text).map_err(|error| format!("{shown}:{error}"));
    }
    let groups = group.into_iter().map(str::to_owned).collect();
    let options = csv::Options { groups, values: Some(headings.to_vec()), ..csv::Options::default() };
    csv::read_file(path, &options).map_err(|error| match error {
        csv::FileError::Csv(csv::CsvError { place, problem }) => {
            format!("{shown}:{}:{}: {problem}", place.line, place.column)
        }
        csv::FileError::Io(error) => format!("{shown}: {error}"),
    })
}
