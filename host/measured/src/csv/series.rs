//! Records over time as CSV: the first row names the columns, with units in brackets or parentheses; every other row is a sample.

use std::path::Path;

use ::csv::{ReaderBuilder, StringRecord};

use super::{
    FileError, bytes_of,
    cells::{Numbers, cell_span, delimiter},
    error::{CsvError, Place, Problem, Shown},
    text_of,
};

/// The largest file of a record (bytes): a million samples of six columns.
pub const LARGEST: u64 = 1 << 26;

/// Name and unit of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Head {
    /// Its name, which no other column has.
    pub name: String,
    /// Its unit as it is written; empty where there is none.
    pub unit: String,
}

/// Columns of a record with a number in each row, and where these numbers stand.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Numbers of each wanted column, in their unit.
    pub columns: Vec<Vec<f64>>,
    /// Index of each wanted column in the file.
    indices: Vec<usize>,
    /// The byte of the text at which each row starts, that of the names first.
    rows: Vec<usize>,
    bytes: Vec<u8>,
    delimiter: u8,
}

impl Series {
    /// Reads the columns that `choose` finds among the names; the others may hold anything.
    ///
    /// # Errors
    /// [`FileError`] names line and column; `choose` may refuse a column by its index.
    pub fn read_file(
        path: &Path,
        choose: impl FnOnce(&[Head]) -> Result<Vec<usize>, (usize, Problem)>,
    ) -> Result<Self, FileError> {
        Ok(Self::read(bytes_of(path, LARGEST)?, choose)?)
    }

    /// The same from the bytes of a file.
    ///
    /// # Errors
    /// As [`read_file`](Self::read_file).
    pub fn read(
        bytes: Vec<u8>,
        choose: impl FnOnce(&[Head]) -> Result<Vec<usize>, (usize, Problem)>,
    ) -> Result<Self, CsvError> {
        let (text, start) = text_of(&bytes)?;
        let delimiter = delimiter(&text[start..]);
        let at_cell = |row: usize, index: usize, problem: Problem| CsvError {
            place: Place::new(text.as_bytes(), cell_span(text, row, delimiter, index)),
            problem,
        };
        let body = &text.as_bytes()[start..];
        let mut reader = ReaderBuilder::new().delimiter(delimiter).has_headers(false).flexible(true).from_reader(body);
        let mut row = StringRecord::new();
        // The text is UTF-8 and rows may have any length, so the reader has nothing to complain of.
        if !reader.read_record(&mut row).unwrap_or(false) {
            return Err(at_cell(start, 0, Problem::Empty));
        }
        let heads = heads(&row).map_err(|(index, problem)| at_cell(start, index, problem))?;
        let indices = choose(&heads).map_err(|(index, problem)| at_cell(start, index, problem))?;
        let mut columns = vec![Vec::new(); indices.len()];
        let mut rows = vec![start];
        let mut numbers = Numbers { comma_allowed: delimiter != b',', mark: None };
        while reader.read_record(&mut row).unwrap_or(false) {
            if row.iter().all(|cell| cell.trim().is_empty()) {
                continue;
            }
            let at = start + row.position().map_or(0, |position| position.byte() as usize);
            let (found, expected) = (row.len(), heads.len());
            if found != expected {
                return Err(at_cell(at, expected.min(found), Problem::Cells { found, expected }));
            }
            for (column, index) in columns.iter_mut().zip(&indices) {
                let name = &heads[*index].name;
                let number = numbers
                    .read(&row[*index], name)
                    .and_then(|number| number.ok_or_else(|| Problem::NoNumber(Shown::new(name))));
                column.push(number.map_err(|problem| at_cell(at, *index, problem))?);
            }
            rows.push(at);
        }
        if rows.len() == 1 {
            return Err(at_cell(text.len(), 0, Problem::NoRows));
        }
        Ok(Self { columns, indices, rows, bytes, delimiter })
    }

    /// Where the number of a wanted column in a sample (from 0) stands, or with no sample the column's name.
    pub fn place(&self, column: usize, sample: Option<usize>) -> Place {
        let text = std::str::from_utf8(&self.bytes).unwrap_or_default();
        let row = self.rows.get(sample.map_or(0, |sample| sample + 1)).copied().unwrap_or_default();
        let index = self.indices.get(column).copied().unwrap_or_default();
        Place::new(&self.bytes, cell_span(text, row, self.delimiter, index))
    }
}

/// Names and units of the columns, which all have a name that no other has.
fn heads(row: &StringRecord) -> Result<Vec<Head>, (usize, Problem)> {
    let mut heads: Vec<Head> = Vec::new();
    let mut seen = std::collections::HashSet::new();
    for (index, cell) in row.iter().enumerate() {
        let (name, unit) = name_and_unit(cell);
        if name.is_empty() {
            return Err((index, Problem::Unnamed(index + 1)));
        }
        if !seen.insert(name.to_owned()) {
            return Err((index, Problem::Repeated(Shown::new(name))));
        }
        heads.push(Head { name: name.to_owned(), unit: unit.to_owned() });
    }
    Ok(heads)
}

/// Name and unit of a head such as `force (N)` or `force [N]`.
fn name_and_unit(cell: &str) -> (&str, &str) {
    let cell = cell.trim();
    let within = |open: char, close: char| {
        let (name, unit) = cell.strip_suffix(close)?.rsplit_once(open)?;
        name.ends_with(char::is_whitespace).then(|| (name.trim(), unit.trim()))
    };
    within('(', ')').or_else(|| within('[', ']')).unwrap_or((cell, ""))
}

#[cfg(test)]
mod tests {
    use super::{Problem, Series};

    fn read(text: &str, wanted: &[usize]) -> Result<Series, String> {
        let wanted = wanted.to_vec();
        Series::read(text.as_bytes().to_vec(), |_| Ok(wanted)).map_err(|error| error.to_string())
    }

    #[test]
    fn wanted_columns_are_read_and_found_again() {
        let text = "t (s),note,force [N]\n0,a,1.5\n\n0.001,b,-2\n";
        let series = read(text, &[0, 2]).expect("a record");
        assert_eq!(series.columns, [vec![0.0, 0.001], vec![1.5, -2.0]]);
        let place = series.place(1, Some(1));
        assert_eq!((place.line, place.column, &text[place.span]), (4, 9, "-2"));
        assert_eq!((series.place(1, None).line, series.place(1, None).column), (1, 12));
    }

    #[test]
    fn units_stand_in_brackets_or_parentheses() {
        let heads = |text: &str| {
            let mut found = Vec::new();
            let _ = Series::read(text.as_bytes().to_vec(), |heads| {
                found = heads.iter().map(|head| (head.name.clone(), head.unit.clone())).collect();
                Ok(Vec::new())
            });
            found
        };
        let expected = [("t", "s"), ("v", "mm/s"), ("f(x)", "")].map(|(name, unit)| (name.into(), unit.into()));
        assert_eq!(heads("t (s),v [mm/s],f(x)\n1,2,3\n"), expected);
    }

    #[test]
    fn errors_name_line_and_column() {
        for (text, message) in [
            ("", "line 1, column 1: the file is empty"),
            ("t,t\n1,2\n", "line 1, column 3: there are two columns"),
            ("t,\n1,2\n", "line 1, column 3: column 2 has no name"),
            ("t,f\n", "line 2, column 1: there is no row"),
            ("t,f\n1,2\n3,NaN\n", "line 3, column 3: column \"f\" has no number"),
            ("t,f\n1,inf\n", "line 2, column 3: \"inf\" in column \"f\" is not finite"),
            ("t,f\n1,x\n", "line 2, column 3: \"x\" in column \"f\" is not a number"),
            ("t,f\n1,2,3\n", "line 2, column 5: this row has 3 cells"),
        ] {
            let error = read(text, &[0, 1]).expect_err(text);
            assert!(error.starts_with(message), "{error}");
        }
        let refused = Series::read(b"t,f\n1,2\n".to_vec(), |_| Err((1, Problem::NoColumns))).expect_err("refused");
        assert_eq!((refused.place.line, refused.place.column), (1, 3));
    }
}
