//! Results as named columns: what a CSV file or a data frame holds.

use std::{borrow::Cow, io, io::Write};

use slipfit_tolerance::number::ten_digits;

/// Columns of equal length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns(pub Vec<Column>);

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name, as the first line of a CSV file has it.
    pub name: String,
    /// Unit, empty if there is none.
    pub unit: String,
    /// A value for each row.
    pub values: Values,
}

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// NaN where there is none.
    Numbers(Vec<f64>),
    /// Whole numbers; none is missing.
    Counts(Vec<u64>),
    /// None is missing.
    Flags(Vec<bool>),
    /// Words of few kinds.
    Words(Words),
}

/// Words, each kept once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Words {
    /// All different words, in the order in which they first occur.
    pub kinds: Vec<String>,
    /// The index of each row's word; `None` if there is none.
    pub rows: Vec<Option<i32>>,
}

impl FromIterator<Option<String>> for Words {
    fn from_iter<I: IntoIterator<Item = Option<String>>>(words: I) -> Self {
        let mut all = Self::default();
        for word in words {
            let index = word.map(|word| all.index(&word));
            all.rows.push(index);
        }
        all
    }
}

impl Words {
    /// The index of a kind, which is added if it is new.
    fn index(&mut self, kind: &str) -> i32 {
        let known = self.kinds.iter().position(|known| known == kind);
        known.unwrap_or_else(|| {
            self.kinds.push(kind.to_owned());
            self.kinds.len() - 1
        }) as i32
    }

    fn append(&mut self, more: &Self) {
        let indices: Vec<_> = more.kinds.iter().map(|kind| self.index(kind)).collect();
        self.rows.extend(more.rows.iter().map(|row| row.map(|row| indices[row as usize])));
    }
}

impl Column {
    /// Of this name, which may end in its unit in parentheses.
    pub fn new(name: impl Into<String>, values: Values) -> Self {
        let name = name.into();
        let unit = name.strip_suffix(')').and_then(|start| Some(start.rsplit_once(" (")?.1.to_owned()));
        Self { name, unit: unit.unwrap_or_default(), values }
    }

    /// Numbers, NaN where there is none.
    pub fn numbers(name: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        Self::new(name, Values::Numbers(values.into_iter().collect()))
    }

    /// Numbers, some of which may be missing.
    pub fn optional(name: impl Into<String>, values: impl IntoIterator<Item = Option<f64>>) -> Self {
        Self::numbers(name, values.into_iter().map(|value| value.unwrap_or(f64::NAN)))
    }

    /// Words, each of few kinds.
    pub fn words(name: impl Into<String>, values: impl IntoIterator<Item = Option<String>>) -> Self {
        Self::new(name, Values::Words(values.into_iter().collect()))
    }

    /// The same column in this `unit`, which its name does not state.
    #[must_use]
    pub fn in_unit(self, unit: &str) -> Self {
        Self { unit: unit.to_owned(), ..self }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        match &self.values {
            Values::Numbers(values) => values.len(),
            Values::Counts(values) => values.len(),
            Values::Flags(values) => values.len(),
            Values::Words(words) => words.rows.len(),
        }
    }

    /// The value of `row` as CSV has it: ten digits, empty where there is none.
    fn field(&self, row: usize) -> Cow<'_, str> {
        match &self.values {
            Values::Numbers(values) if values[row].is_nan() => "".into(),
            Values::Numbers(values) => ten_digits(values[row]).into(),
            Values::Counts(values) => values[row].to_string().into(),
            Values::Flags(values) => values[row].to_string().into(),
            Values::Words(words) => words.rows[row].map_or("", |kind| &words.kinds[kind as usize]).into(),
        }
    }
}

impl Columns {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.0.first().map_or(0, Column::rows)
    }

    /// Adds the rows of `more`, which has the same columns.
    ///
    /// # Panics
    /// If it has others.
    pub fn append(&mut self, more: &Self) {
        assert_eq!(self.0.len(), more.0.len(), "as many columns");
        for (own, more) in self.0.iter_mut().zip(&more.0) {
            match (&mut own.values, &more.values) {
                (Values::Numbers(own), Values::Numbers(more)) => own.extend(more),
                (Values::Counts(own), Values::Counts(more)) => own.extend(more),
                (Values::Flags(own), Values::Flags(more)) => own.extend(more),
                (Values::Words(own), Values::Words(more)) => own.append(more),
                _ => panic!("{} is a column of another kind", own.name),
            }
        }
    }

    /// Whether memory has space for so many `rows` of `count` columns, before it is filled for hours.
    ///
    /// # Errors
    /// If it has not.
    pub fn check_space(rows: u64, count: usize) -> anyhow::Result<()> {
        let numbers = usize::try_from(rows).ok().and_then(|rows| rows.checked_mul(count));
        let has = numbers.is_some_and(|numbers| Vec::<f64>::new().try_reserve_exact(numbers).is_ok());
        anyhow::ensure!(has, "{rows} rows of {count} columns do not fit into memory");
        Ok(())
    }

    /// Has space for `rows` more rows.
    pub fn reserve(&mut self, rows: usize) {
        for column in &mut self.0 {
            match &mut column.values {
                Values::Numbers(values) => values.reserve_exact(rows),
                Values::Counts(values) => values.reserve_exact(rows),
                Values::Flags(values) => values.reserve_exact(rows),
                Values::Words(words) => words.rows.reserve_exact(rows),
            }
        }
    }

    /// Writes the names as a line of CSV.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_names<W: Write>(&self, writer: &mut csv::Writer<W>) -> io::Result<()> {
        writer.write_record(self.0.iter().map(|column| &column.name)).map_err(of_system)
    }

    /// Writes the rows as lines of CSV.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_rows<W: Write>(&self, writer: &mut csv::Writer<W>) -> io::Result<()> {
        for row in 0..self.rows() {
            for column in &self.0 {
                writer.write_field(&*column.field(row)).map_err(of_system)?;
            }
            writer.write_record(None::<&[u8]>).map_err(of_system)?;
        }
        Ok(())
    }

    /// All of it as CSV.
    ///
    /// # Errors
    /// Those of the writer, none in memory.
    pub fn to_csv(&self) -> anyhow::Result<Vec<u8>> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        self.write_names(&mut writer)?;
        self.write_rows(&mut writer)?;
        Ok(writer.into_inner()?)
    }
}

/// The system's own error of what writes CSV.
fn of_system(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}

#[cfg(test)]
mod tests {
    use super::{Column, Columns, Values, Words};

    #[test]
    fn a_unit_in_a_name_is_the_columns() {
        let units =
            ["t (s)", "front (left) (m)", "n", "peak_force_N", "(m)"].map(|name| Column::numbers(name, []).unit);
        assert_eq!(units, ["s", "m", "", "", ""]);
        assert_eq!(Column::numbers("peak_force_N", []).in_unit("N").unit, "N");
    }

    #[test]
    fn parts_in_a_row_are_the_whole() {
        let all = |rows: std::ops::Range<u64>| {
            let word = |row: u64| (!row.is_multiple_of(5)).then(|| format!("kind {}", row % 3));
            Columns(vec![
                Column::new("row", Values::Counts(rows.clone().collect())),
                Column::optional("half (m)", rows.clone().map(|row| (row != 4).then_some(row as f64 / 2.0))),
                Column::new("odd", Values::Flags(rows.clone().map(|row| row % 2 == 1).collect())),
                Column::words("word", rows.map(word)),
            ])
        };
        let mut parts = all(0..0);
        parts.reserve(12);
        for [first, end] in [[0, 1], [1, 5], [5, 5], [5, 12]] {
            parts.append(&all(first..end));
        }
        let csv = parts.to_csv().unwrap();
        assert_eq!(csv, all(0..12).to_csv().unwrap());
        let lines: Vec<_> = std::str::from_utf8(&csv).unwrap().lines().collect();
        assert_eq!(
            lines[..6],
            [
                "row,half (m),odd,word",
                "0,0,false,",
                "1,0.5,true,kind 1",
                "2,1,false,kind 2",
                "3,1.5,true,kind 0",
                "4,,false,kind 1"
            ]
        );
        let Values::Words(Words { kinds, .. }) = &parts.0[3].values else { panic!() };
        assert_eq!(kinds.len(), 3);
    }
}
