//! A table of measured parts: a row per part, a column per characteristic.

use std::collections::HashMap;

use serde::Serialize;

use crate::unit::Unit;

/// A characteristic of the parts.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Column {
    /// Its name, which no other column of the table has.
    pub name: String,
    /// Unit of all its numbers.
    pub unit: Unit,
    /// Nominal value.
    pub nominal: Option<f64>,
    /// Lower and upper limit of a conforming part, not offsets from the nominal value.
    pub limits: [Option<f64>; 2],
    /// Measured values in the order of the parts; `None` where a part was not measured.
    pub values: Vec<Option<f64>>,
}

impl Column {
    /// The values of the measured parts.
    pub fn measured(&self) -> Vec<f64> {
        self.values.iter().copied().flatten().collect()
    }

    /// The number of parts that were not measured.
    pub fn missing(&self) -> usize {
        self.values.iter().filter(|value| value.is_none()).count()
    }
}

/// What divides the parts into subgroups, such as cavity, machine or batch.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Grouping {
    /// Its name, which no other grouping or column of the table has.
    pub name: String,
    /// Names of the subgroups, in the order of their first part.
    pub groups: Vec<String>,
    /// Index into `groups` for each part; `None` where it is not known.
    pub group_of: Vec<Option<u32>>,
}

impl Grouping {
    /// The grouping by a text per part; parts with an empty text belong to no subgroup.
    pub fn new<'a>(name: &str, texts: impl IntoIterator<Item = &'a str>) -> Self {
        let mut builder = GroupingBuilder::new(name);
        texts.into_iter().for_each(|text| builder.push(text));
        builder.finish()
    }

    /// The measured values of a `column` by subgroup, parts without a subgroup last.
    pub fn divide(&self, column: &Column) -> Vec<Vec<f64>> {
        let mut divided = vec![Vec::new(); self.groups.len() + 1];
        for (value, group) in column.values.iter().zip(&self.group_of) {
            let group = group.map_or(self.groups.len(), |group| group as usize);
            if let (Some(value), Some(values)) = (value, divided.get_mut(group)) {
                values.push(*value);
            }
        }
        divided.retain(|values| !values.is_empty());
        divided
    }
}

/// A grouping part by part, which keeps each text once.
pub struct GroupingBuilder {
    grouping: Grouping,
    index: HashMap<String, u32>,
}

impl GroupingBuilder {
    /// Without parts.
    pub fn new(name: &str) -> Self {
        Self { grouping: Grouping { name: name.to_owned(), ..Grouping::default() }, index: HashMap::new() }
    }

    /// Adds a part; with an empty text it belongs to no subgroup.
    pub fn push(&mut self, text: &str) {
        let group = (!text.is_empty()).then(|| match self.index.get(text) {
            Some(group) => *group,
            None => {
                let group = self.grouping.groups.len() as u32;
                self.grouping.groups.push(text.to_owned());
                self.index.insert(text.to_owned(), group);
                group
            }
        });
        self.grouping.group_of.push(group);
    }

    /// The grouping of all parts.
    pub fn finish(self) -> Grouping {
        self.grouping
    }
}

/// A measured table that contradicts itself.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// No characteristic.
    #[error("there is no column with measured values")]
    NoColumns,
    /// No part.
    #[error("there is no measured part")]
    NoParts,
    /// Two columns or groupings of the same name.
    #[error("there are two columns \"{0}\"; each needs a name that no other has")]
    Repeated(String),
    /// A column without a name.
    #[error("column {0} has no name")]
    Unnamed(usize),
    /// A column, a grouping or labels with another number of parts than the first column.
    #[error("\"{name}\" has {found} parts, but the first column has {expected}")]
    Parts {
        /// Name of the column or grouping.
        name: String,
        /// Its parts.
        found: usize,
        /// Parts of the first column.
        expected: usize,
    },
    /// An infinite value, or one that is not a number.
    #[error("\"{column}\" has {value} as its {place}, but values must be finite")]
    NotFinite {
        /// Name of the column.
        column: String,
        /// Where, such as "value of part 3".
        place: String,
        /// The value.
        value: f64,
    },
    /// A lower limit above the upper one.
    #[error("\"{column}\" has the lower limit {lower}, which is not below its upper limit {upper}")]
    Limits {
        /// Name of the column.
        column: String,
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
    },
}

/// Measured parts: at least one, with at least one characteristic; all columns have a value or a gap for each part, names
/// differ, and all numbers are finite.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeasuredTable {
    columns: Vec<Column>,
    groupings: Vec<Grouping>,
    labels: Option<Vec<String>>,
}

impl MeasuredTable {
    /// Checks that the columns agree with each other.
    pub fn new(columns: Vec<Column>) -> Result<Self, TableError> {
        let first = columns.first().ok_or(TableError::NoColumns)?;
        let expected = first.values.len();
        if expected == 0 {
            return Err(TableError::NoParts);
        }
        for column in &columns {
            same_parts(&column.name, column.values.len(), expected)?;
            check_numbers(column)?;
        }
        let table = Self { columns, groupings: Vec::new(), labels: None };
        table.check_names()?;
        Ok(table)
    }

    /// With a label per part, such as a serial number.
    pub fn with_labels(mut self, labels: Vec<String>) -> Result<Self, TableError> {
        same_parts("labels", labels.len(), self.parts())?;
        self.labels = Some(labels);
        Ok(self)
    }

    /// With what divides the parts into subgroups.
    pub fn with_grouping(mut self, grouping: Grouping) -> Result<Self, TableError> {
        same_parts(&grouping.name, grouping.group_of.len(), self.parts())?;
        self.groupings.push(grouping);
        self.check_names()?;
        Ok(self)
    }

    /// The characteristics.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The characteristic of a name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// What divides the parts into subgroups.
    pub fn groupings(&self) -> &[Grouping] {
        &self.groupings
    }

    /// Labels of the parts, where they have any.
    pub fn labels(&self) -> Option<&[String]> {
        self.labels.as_deref()
    }

    /// The label of a part, its number (from 1) where it has none.
    pub fn label(&self, part: usize) -> String {
        let label = self.labels.as_ref().and_then(|labels| labels.get(part)).filter(|label| !label.is_empty());
        label.cloned().unwrap_or_else(|| (part + 1).to_string())
    }

    /// Number of parts.
    pub fn parts(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    fn check_names(&self) -> Result<(), TableError> {
        let names = self.columns.iter().map(|column| &column.name);
        let mut seen = std::collections::HashSet::new();
        for (i, name) in names.chain(self.groupings.iter().map(|grouping| &grouping.name)).enumerate() {
            if name.is_empty() {
                return Err(TableError::Unnamed(i + 1));
            }
            if !seen.insert(name) {
                return Err(TableError::Repeated(name.clone()));
            }
        }
        Ok(())
    }
}

fn same_parts(name: &str, found: usize, expected: usize) -> Result<(), TableError> {
    if found == expected { Ok(()) } else { Err(TableError::Parts { name: name.to_owned(), found, expected }) }
}

fn check_numbers(column: &Column) -> Result<(), TableError> {
    let Column { name, nominal, limits, values, .. } = column;
    let stated = [(*nominal, "nominal value"), (limits[0], "lower limit"), (limits[1], "upper limit")];
    let mut stated = stated.into_iter().map(|(value, place)| (value, place.to_owned()));
    let measured = values.iter().enumerate().map(|(i, value)| (*value, i));
    let is_wrong = |value: &Option<f64>| value.is_some_and(|value| !value.is_finite());
    let wrong = stated.find(|(value, _)| is_wrong(value)).or_else(|| {
        let mut measured = measured;
        measured.find(|(value, _)| is_wrong(value)).map(|(value, i)| (value, format!("value of part {}", i + 1)))
    });
    if let Some((Some(value), place)) = wrong {
        return Err(TableError::NotFinite { column: name.clone(), place, value });
    }
    match *limits {
        [Some(lower), Some(upper)] if lower >= upper => Err(TableError::Limits { column: name.clone(), lower, upper }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::{Column, Grouping, MeasuredTable, TableError};

    fn column(name: &str, values: &[Option<f64>]) -> Column {
        Column { name: name.into(), values: values.to_vec(), ..Column::default() }
    }

    #[test]
    fn values_are_divided_by_subgroup() {
        let column = column("a", &[Some(1.0), Some(2.0), None, Some(4.0), Some(5.0)]);
        let grouping = Grouping::new("cavity", ["x", "y", "x", "", "x"]);
        assert_eq!(grouping.groups, ["x", "y"]);
        assert_eq!(grouping.divide(&column), [vec![1.0, 5.0], vec![2.0], vec![4.0]]);
        assert_eq!((column.missing(), column.measured().len()), (1, 4));
    }

    #[test]
    fn contradictions_are_refused() {
        assert_eq!(MeasuredTable::new(vec![]), Err(TableError::NoColumns));
        assert_eq!(MeasuredTable::new(vec![column("a", &[])]), Err(TableError::NoParts));
        let a = column("a", &[Some(1.0), None]);
        assert_eq!(MeasuredTable::new(vec![a.clone(), a.clone()]), Err(TableError::Repeated("a".into())));
        let b = column("b", &[Some(1.0)]);
        assert!(matches!(MeasuredTable::new(vec![a.clone(), b]), Err(TableError::Parts { found: 1, expected: 2, .. })));
        let infinite = column("b", &[Some(1.0), Some(f64::INFINITY)]);
        assert!(matches!(MeasuredTable::new(vec![infinite]), Err(TableError::NotFinite { .. })));
        let limits = Column { limits: [Some(2.0), Some(1.0)], ..a.clone() };
        assert!(matches!(MeasuredTable::new(vec![limits]), Err(TableError::Limits { .. })));
        let table = MeasuredTable::new(vec![a]).and_then(|table| table.with_labels(vec!["7".into(), String::new()]));
        let table = table.expect("a table");
        assert_eq!([table.label(0), table.label(1), table.label(9)], ["7", "2", "10"]);
    }
}
