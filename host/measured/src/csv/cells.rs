//! Cells of a CSV file: what divides them, where they are, and the numbers in them.

use std::ops::Range;

use super::error::{Problem, Shown};

/// The mark between cells: a semicolon or else a tabulator if the first row has one outside quotation marks, otherwise a
/// comma.
pub fn delimiter(text: &str) -> u8 {
    let mut quoted = false;
    let mut tabulator = false;
    for byte in text.trim_start_matches(['\r', '\n']).bytes() {
        match byte {
            b'"' => quoted = !quoted,
            b'\n' | b'\r' if !quoted => break,
            b';' if !quoted => return b';',
            b'\t' if !quoted => tabulator = true,
            _ => {}
        }
    }
    if tabulator { b'\t' } else { b',' }
}

/// The bytes of cell `index` in the row that starts at a byte of the text; the end of the row where it has fewer cells.
pub fn cell_span(text: &str, row: usize, delimiter: u8, index: usize) -> Range<usize> {
    let bytes = text.as_bytes();
    // A row follows the line end of the one before, which the reader counts to it.
    let mut at = row;
    while matches!(bytes.get(at), Some(b'\r' | b'\n')) {
        at += 1;
    }
    let (mut start, mut cell, mut quoted) = (at, 0, false);
    while let Some(byte) = bytes.get(at) {
        match byte {
            b'"' => quoted = !quoted,
            b'\n' | b'\r' if !quoted => break,
            byte if *byte == delimiter && !quoted => {
                if cell == index {
                    break;
                }
                cell += 1;
                start = at + 1;
            }
            _ => {}
        }
        at += 1;
    }
    if cell < index { at..at } else { start..at }
}

/// Reads numbers and remembers the decimal mark of the file.
pub struct Numbers {
    /// Whether a comma may be a decimal mark, that is, does not divide cells.
    pub comma_allowed: bool,
    /// The mark of the numbers so far.
    pub mark: Option<char>,
}

impl Numbers {
    /// The number in a cell of a `column`; `None` where it is missing.
    pub fn read(&mut self, cell: &str, column: &str) -> Result<Option<f64>, Problem> {
        let cell = cell.trim();
        if is_missing(cell) {
            return Ok(None);
        }
        let not_a_number = || Problem::NotANumber { column: Shown::new(column), value: Shown::new(cell) };
        let mark = cell.chars().find(|character| [',', '.'].contains(character));
        if mark == Some(',') && !self.comma_allowed {
            return Err(not_a_number());
        }
        let value: f64 = match mark {
            Some(',') => cell.replacen(',', ".", 1).parse(),
            _ => cell.parse(),
        }
        .map_err(|_| not_a_number())?;
        // The words for infinity parse as well, as do numbers that are too large.
        if !value.is_finite() {
            return Err(Problem::NotFinite { column: Shown::new(column), value: Shown::new(cell) });
        }
        match (mark, self.mark) {
            (Some(mark), Some(before)) if mark != before => {
                let (column, value) = (Shown::new(column), Shown::new(cell));
                return Err(Problem::TwoMarks { column, value, mark, before });
            }
            (Some(_), None) => self.mark = mark,
            _ => {}
        }
        Ok(Some(value))
    }
}

/// Whether a cell says that the value is missing.
fn is_missing(cell: &str) -> bool {
    cell.is_empty() || cell == "-" || cell.eq_ignore_ascii_case("nan") || cell.eq_ignore_ascii_case("na")
}

#[cfg(test)]
mod tests {
    use super::{Numbers, Problem, cell_span, delimiter};

    #[test]
    fn the_first_row_shows_the_delimiter() {
        assert_eq!(delimiter("a,b\n1;2"), b',');
        assert_eq!(delimiter("a,b;c\n"), b';');
        assert_eq!(delimiter("\r\na\tb,c"), b'\t');
        assert_eq!(delimiter("\"a;b\",c\n"), b',');
    }

    #[test]
    fn cells_are_found() {
        let text = "a,\"b,\nc\",d\r\ne,f";
        assert_eq!(&text[cell_span(text, 0, b',', 1)], "\"b,\nc\"");
        assert_eq!(&text[cell_span(text, 0, b',', 2)], "d");
        assert_eq!(&text[cell_span(text, 10, b',', 1)], "f");
        assert_eq!(cell_span(text, 10, b',', 5), 15..15);
    }

    #[test]
    fn numbers_have_one_decimal_mark() {
        let mut numbers = Numbers { comma_allowed: true, mark: None };
        assert_eq!(numbers.read(" 1,25 ", "a"), Ok(Some(1.25)));
        assert_eq!(numbers.read("-2e-3", "a"), Ok(Some(-0.002)));
        assert!(matches!(numbers.read("1.5", "a"), Err(Problem::TwoMarks { mark: '.', before: ',', .. })));
        assert!(matches!(numbers.read("1,2,3", "a"), Err(Problem::NotANumber { .. })));
        assert!(matches!(numbers.read("inf", "a"), Err(Problem::NotFinite { .. })));
        assert!(matches!(numbers.read("1e999", "a"), Err(Problem::NotFinite { .. })));
        for missing in ["", " ", "-", "NaN", "na"] {
            assert_eq!(numbers.read(missing, "a"), Ok(None));
        }
        let mut numbers = Numbers { comma_allowed: false, mark: None };
        assert!(matches!(numbers.read("1,5", "a"), Err(Problem::NotANumber { .. })));
    }
}
