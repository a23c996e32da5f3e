//! What can be wrong with a CSV file of measured parts or of a record, and where.

use std::{fmt, ops::Range};

use crate::{table::TableError, unit::UnitError};

/// What is wrong with a CSV file, and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {}, column {}: {problem}", place.line, place.column)]
pub struct CsvError {
    /// Where.
    pub place: Place,
    /// What.
    pub problem: Problem,
}

/// A place in a text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Character within its line, from 1.
    pub column: usize,
    /// Bytes of the text that are meant.
    pub span: Range<usize>,
}

impl Place {
    /// The place of a `span` of bytes in a text.
    pub fn new(text: &[u8], span: Range<usize>) -> Self {
        let before = text.get(..span.start).unwrap_or(text);
        let line = before.iter().filter(|byte| **byte == b'\n').count() + 1;
        let start = before.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        // Continuation bytes of UTF-8 are no characters; nor is the mark that some programs put before the text.
        let in_line = before[start..].strip_prefix("\u{feff}".as_bytes()).unwrap_or(&before[start..]);
        let column = in_line.iter().filter(|byte| **byte & 0xc0 != 0x80).count() + 1;
        Self { line, column, span }
    }
}

/// What is wrong with a CSV file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// A file that would need too much memory.
    #[error("the file has {bytes} bytes, of which at most {limit} are read; divide it into several files")]
    TooLarge {
        /// Size of the file.
        bytes: u64,
        /// The greatest size.
        limit: u64,
    },
    /// Bytes that are not UTF-8.
    #[error("not UTF-8; save the file as \"CSV UTF-8\"")]
    NotUtf8,
    /// No row at all.
    #[error("the file is empty; its first row must name the columns, such as `part,length [mm]`")]
    Empty,
    /// A unit that is not known.
    #[error("column {name}: {error}")]
    Unit {
        /// Name of the column.
        name: Shown,
        /// The unit.
        error: UnitError,
    },
    /// Two columns of the same name.
    #[error("there are two columns {0}; each needs a name that no other has")]
    Repeated(Shown),
    /// A column without a name.
    #[error("column {0} has no name")]
    Unnamed(usize),
    /// An option that names a missing column.
    #[error("there is no column {name} for {role}; the columns are {columns}")]
    NoColumn {
        /// The name.
        name: Shown,
        /// What it should be for, such as "the labels of the parts".
        role: &'static str,
        /// Names of the columns.
        columns: String,
    },
    /// A row with another number of cells than the head.
    #[error("this row has {found} cells, but the head has {expected}")]
    Cells {
        /// Cells of the row.
        found: usize,
        /// Cells of the head.
        expected: usize,
    },
    /// A text where a number is due.
    #[error(
        "{value} in column {column} is not a number; missing values are empty, `-`, `NA` or `NaN`, and a column of texts \
         must be named as a grouping or left out"
    )]
    NotANumber {
        /// Name of the column.
        column: Shown,
        /// The text.
        value: Shown,
    },
    /// A number that no f64 holds.
    #[error("{value} in column {column} is not finite; its amount must be below 1.8e308")]
    NotFinite {
        /// Name of the column.
        column: Shown,
        /// The text.
        value: Shown,
    },
    /// A number with a comma in a file that has numbers with a point, or the reverse.
    #[error("{value} in column {column} has the decimal mark `{mark}`, but numbers before it have `{before}`")]
    TwoMarks {
        /// Name of the column.
        column: Shown,
        /// The text.
        value: Shown,
        /// Its mark.
        mark: char,
        /// The mark of earlier numbers.
        before: char,
    },
    /// Two rows of the same limit.
    #[error("there are two rows `{0}`")]
    RepeatedRow(&'static str),
    /// A lower limit that is not below the upper one.
    #[error("column {column} has the lower limit {lower}, which is not below its upper limit {upper}")]
    Limits {
        /// Name of the column.
        column: Shown,
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
    },
    /// A row of a record without a number in a column that needs one.
    #[error("column {0} has no number in this row; a record needs one in each row")]
    NoNumber(Shown),
    /// A column of a record in a unit that does not fit.
    #[error("column {name} is in {unit}, but {role} is in {allowed}")]
    ColumnUnit {
        /// Name of the column.
        name: Shown,
        /// Its unit.
        unit: Shown,
        /// What it is for, such as "the force".
        role: &'static str,
        /// Units that fit.
        allowed: String,
    },
    /// A record without rows.
    #[error("there is no row below the names of the columns")]
    NoRows,
    /// No row with a part.
    #[error("there is no row with a measured part")]
    NoParts,
    /// No column with measured values.
    #[error("there is no column with measured values, only labels and groupings")]
    NoColumns,
    /// A table that contradicts itself in another way.
    #[error(transparent)]
    Table(#[from] TableError),
}

/// A text of a file as messages show it: in quotation marks, control characters escaped, shortened to 40 characters.
#[derive(Clone, PartialEq, Eq)]
pub struct Shown(pub String);

impl Shown {
    const LONGEST: usize = 40;

    /// The text, shortened.
    pub fn new(text: &str) -> Self {
        let short: String = text.chars().take(Self::LONGEST).collect();
        Self(if short.len() < text.len() { short + "…" } else { short })
    }
}

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

impl fmt::Debug for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
