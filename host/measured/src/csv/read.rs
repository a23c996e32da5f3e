//! The rows of a CSV file as a table.

use std::collections::HashSet;

use ::csv::{Reader, ReaderBuilder, StringRecord};

use super::{
    cells::{Numbers, cell_span},
    error::{CsvError, Place, Problem, Shown},
    options::Options,
};
use crate::{
    table::{Column, GroupingBuilder, MeasuredTable, TableError},
    unit::Unit,
};

/// First cells of the rows that state limits.
pub const LIMIT_ROWS: [&str; 3] = ["nominal", "lower", "upper"];
/// What measuring programs write for them.
const ALSO: [&str; 3] = ["target", "lsl", "usl"];
/// Name of the column that labels the parts.
pub const LABELS: &str = "part";

/// The text of a file.
pub struct File<'t> {
    pub text: &'t str,
    /// The first byte after a byte order mark.
    pub start: usize,
    pub delimiter: u8,
}

/// Where the cells of a column are collected.
enum Target {
    Labels(Vec<String>),
    Grouping(GroupingBuilder),
    Ignored,
    Values(Column),
}

/// Rows of a file one by one.
struct Rows<'t> {
    reader: Reader<&'t [u8]>,
    start: usize,
    row: StringRecord,
    /// The byte of the text at which the row starts.
    at: usize,
}

impl Rows<'_> {
    /// Goes on to the next row; `false` at the end of the file.
    fn next(&mut self) -> bool {
        // The text is UTF-8 and rows may have any length, so the reader has nothing to complain of.
        let is_row = self.reader.read_record(&mut self.row).unwrap_or(false);
        self.at = self.start + self.row.position().map_or(0, |position| position.byte() as usize);
        is_row
    }

    /// Which limit the row states by its cell of this `column`, if any.
    fn limit(&self, column: usize) -> Option<usize> {
        let cell = self.row.get(column)?.trim();
        let is = |name: &str| cell.eq_ignore_ascii_case(name);
        (0..LIMIT_ROWS.len()).find(|k| is(LIMIT_ROWS[*k]) || is(ALSO[*k]))
    }

    fn is_empty(&self) -> bool {
        self.row.iter().all(|cell| cell.trim().is_empty())
    }
}

impl File<'_> {
    /// An error at cell `index` of the row at a byte.
    fn error(&self, row: usize, index: usize, problem: impl Into<Problem>) -> CsvError {
        let span = cell_span(self.text, row, self.delimiter, index);
        CsvError { place: Place::new(self.text.as_bytes(), span), problem: problem.into() }
    }

    /// Reads all rows.
    pub fn read(&self, options: &Options) -> Result<MeasuredTable, CsvError> {
        let body = &self.text.as_bytes()[self.start..];
        let reader = ReaderBuilder::new().delimiter(self.delimiter).has_headers(false).flexible(true).from_reader(body);
        let mut rows = Rows { reader, start: self.start, row: StringRecord::new(), at: self.start };
        if !rows.next() {
            return Err(self.error(self.start, 0, Problem::Empty));
        }
        let (head, head_at) = (rows.row.clone(), rows.at);
        let mut is_row = rows.next();
        // A column that is not named as labels is one if limits stand in it.
        let states_limits = is_row && rows.limit(0).is_some();
        let labels = labels_of(&head, states_limits, options);
        let mut targets = self.targets(&head, head_at, (labels, states_limits), options)?;

        let mut numbers = Numbers { comma_allowed: self.delimiter != b',', mark: None };
        let (mut limits_seen, mut parts) = ([false; LIMIT_ROWS.len()], 0);
        while is_row {
            if rows.is_empty() {
                is_row = rows.next();
                continue;
            }
            let (found, expected) = (rows.row.len(), targets.len());
            if found != expected {
                // The first cell too many, or the end of the row.
                return Err(self.error(rows.at, expected.min(found), Problem::Cells { found, expected }));
            }
            let limit = rows.limit(0).filter(|_| states_limits).or(labels.and_then(|labels| rows.limit(labels)));
            match limit {
                Some(limit) if std::mem::replace(&mut limits_seen[limit], true) => {
                    return Err(self.error(rows.at, 0, Problem::RepeatedRow(LIMIT_ROWS[limit])));
                }
                Some(_) => {}
                None => parts += 1,
            }
            for (index, (cell, target)) in rows.row.iter().zip(&mut targets).enumerate() {
                target.take(cell, limit, &mut numbers).map_err(|problem| self.error(rows.at, index, problem))?;
            }
            is_row = rows.next();
        }
        let end = self.text.len();
        if parts == 0 {
            return Err(self.error(end, 0, Problem::NoParts));
        }
        table(targets).map_err(|error| self.error(end, 0, error))
    }

    /// What each column of the head is for.
    fn targets(
        &self,
        head: &StringRecord,
        at: usize,
        (labels, states_limits): (Option<usize>, bool),
        options: &Options,
    ) -> Result<Vec<Target>, CsvError> {
        let mut names = Vec::new();
        let mut seen = HashSet::new();
        for (index, cell) in head.iter().enumerate() {
            let (name, unit) = name_and_unit(cell);
            if name.is_empty() {
                return Err(self.error(at, index, Problem::Unnamed(index + 1)));
            }
            if !seen.insert(name) {
                return Err(self.error(at, index, Problem::Repeated(Shown::new(name))));
            }
            names.push((name, unit));
        }
        let wanted = [
            (options.labels.as_slice(), "the labels of the parts"),
            (&options.groups, "subgroups"),
            (&options.ignored, "leaving it out"),
            (options.values.as_deref().unwrap_or_default(), "measured values"),
        ];
        for (wanted, role) in wanted {
            if let Some(name) = wanted.iter().find(|name| !seen.contains(name.as_str())) {
                let columns: Vec<String> = names.iter().map(|(name, _)| Shown::new(name).to_string()).collect();
                let (name, columns) = (Shown::new(name), columns.join(", "));
                return Err(self.error(at, 0, Problem::NoColumn { name, role, columns }));
            }
        }
        let mut targets = Vec::new();
        for (index, (name, unit)) in names.into_iter().enumerate() {
            let is_in = |list: &[String]| list.iter().any(|other| other == name);
            let is_wanted =
                |name: &str| options.values.as_ref().is_none_or(|values| values.iter().any(|other| other == name));
            targets.push(if labels == Some(index) {
                Target::Labels(Vec::new())
            } else if is_in(&options.groups) {
                Target::Grouping(GroupingBuilder::new(name))
            } else if is_in(&options.ignored) || (index == 0 && states_limits) || !is_wanted(name) {
                Target::Ignored
            } else {
                let unit = unit
                    .parse::<Unit>()
                    .map_err(|error| self.error(at, index, Problem::Unit { name: Shown::new(name), error }))?;
                Target::Values(Column { name: name.to_owned(), unit, ..Column::default() })
            });
        }
        if !targets.iter().any(|target| matches!(target, Target::Values(_))) {
            return Err(self.error(at, 0, Problem::NoColumns));
        }
        self.reserve(&mut targets);
        Ok(targets)
    }

    /// Reserves memory for as many values as the file can have, so that it does not grow in steps to twice as much.
    fn reserve(&self, targets: &mut [Target]) {
        let lines = self.text.bytes().filter(|byte| *byte == b'\n').count() + 1;
        // A row has at least as many bytes as cells.
        let most = lines.min(self.text.len() / targets.len().max(1) + 1);
        for target in targets {
            match target {
                Target::Labels(labels) => labels.reserve_exact(most),
                Target::Values(column) => column.values.reserve_exact(most),
                Target::Grouping(_) | Target::Ignored => {}
            }
        }
    }
}

impl Target {
    /// Adds a cell of a part, or of a row that states limits.
    fn take(&mut self, cell: &str, limit: Option<usize>, numbers: &mut Numbers) -> Result<(), Problem> {
        match (self, limit) {
            (Self::Labels(labels), None) => labels.push(cell.trim().to_owned()),
            (Self::Grouping(grouping), None) => grouping.push(cell.trim()),
            (Self::Values(column), None) => column.values.push(numbers.read(cell, &column.name)?),
            (Self::Values(column), Some(0)) => column.nominal = numbers.read(cell, &column.name)?,
            (Self::Values(column), Some(row)) => {
                column.limits[row - 1] = numbers.read(cell, &column.name)?;
                if let [Some(lower), Some(upper)] = column.limits
                    && lower >= upper
                {
                    return Err(Problem::Limits { column: Shown::new(&column.name), lower, upper });
                }
            }
            (Self::Labels(_) | Self::Grouping(_) | Self::Ignored, _) => {}
        }
        Ok(())
    }
}

/// The column that labels the parts: the stated one, the one of that name, or the first one if limits stand in it.
fn labels_of(head: &StringRecord, states_limits: bool, options: &Options) -> Option<usize> {
    let named = |is: &dyn Fn(&str) -> bool| head.iter().position(|cell| is(name_and_unit(cell).0));
    match &options.labels {
        Some(name) => named(&|other| other == name),
        None if states_limits => Some(0),
        None => named(&|other| {
            let is_other = |list: &[String]| list.iter().any(|name| name == other);
            let is_taken = is_other(&options.groups) || options.values.as_deref().is_some_and(is_other);
            other.eq_ignore_ascii_case(LABELS) && !is_taken
        }),
    }
}

/// The table of what was collected.
fn table(targets: Vec<Target>) -> Result<MeasuredTable, TableError> {
    let (mut columns, mut groupings, mut labels) = (Vec::new(), Vec::new(), None);
    for target in targets {
        match target {
            Target::Labels(texts) => labels = Some(texts),
            Target::Grouping(grouping) => groupings.push(grouping.finish()),
            Target::Ignored => {}
            Target::Values(column) => columns.push(column),
        }
    }
    let mut table = MeasuredTable::new(columns)?;
    if let Some(labels) = labels {
        table = table.with_labels(labels)?;
    }
    for grouping in groupings {
        table = table.with_grouping(grouping)?;
    }
    Ok(table)
}

/// Name and unit of a head such as `length [mm]`: brackets at the end, after a space.
pub fn name_and_unit(cell: &str) -> (&str, &str) {
    let cell = cell.trim();
    let unit = cell.strip_suffix(']').and_then(|cell| cell.rsplit_once('['));
    match unit {
        Some((name, unit)) if name.ends_with(char::is_whitespace) => (name.trim(), unit.trim()),
        _ => (cell, ""),
    }
}
