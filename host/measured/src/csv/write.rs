//! A table as CSV.

use ::csv::{QuoteStyle, WriterBuilder};

use super::read::{LABELS, LIMIT_ROWS, name_and_unit};
use crate::{table::MeasuredTable, unit::Unit};

/// A table as CSV with commas, which reads as the same table when its groupings are named: labels (numbers if there are
/// none, but limits), groupings, then the columns. Numbers have as many digits as it takes to be the same when read; a
/// missing value is `-`.
pub fn write(table: &MeasuredTable) -> String {
    let limit_rows: Vec<usize> = (0..LIMIT_ROWS.len())
        .filter(|row| (0..table.columns().len()).any(|column| stated(table, column, *row).is_some()))
        .collect();
    let has_labels = table.labels().is_some() || !limit_rows.is_empty();
    let number = |value: Option<f64>| value.map_or("-".to_owned(), |value| value.to_string());
    let groupings = table.groupings();

    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut head: Vec<String> = has_labels.then(|| labels_name(table)).into_iter().collect();
    head.extend(groupings.iter().map(|grouping| grouping.name.clone()));
    head.extend(table.columns().iter().map(|column| match column.unit {
        // Brackets of the name would be read as a unit.
        Unit::None if name_and_unit(&column.name).0 == column.name => column.name.clone(),
        unit => format!("{} [{unit}]", column.name),
    }));
    // Unquoted, these would be read as what divides the cells.
    let quotes =
        if head.iter().any(|name| name.contains([';', '\t'])) { QuoteStyle::NonNumeric } else { QuoteStyle::Necessary };
    let mut writer = WriterBuilder::new().quote_style(quotes).from_writer(Vec::new());
    rows.push(head);
    for row in limit_rows {
        let mut cells = vec![LIMIT_ROWS[row].to_owned()];
        cells.extend(groupings.iter().map(|_| String::new()));
        cells.extend((0..table.columns().len()).map(|column| number(stated(table, column, row))));
        rows.push(cells);
    }
    for row in rows {
        // Writing into memory does not fail.
        let _ = writer.write_record(row);
    }
    for part in 0..table.parts() {
        let mut cells: Vec<String> = has_labels.then(|| table.label(part)).into_iter().collect();
        cells.extend(groupings.iter().map(|grouping| {
            let group = grouping.group_of.get(part).copied().flatten();
            group.and_then(|group| grouping.groups.get(group as usize)).cloned().unwrap_or_default()
        }));
        cells.extend(table.columns().iter().map(|column| number(column.values.get(part).copied().flatten())));
        let _ = writer.write_record(cells);
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// What a row of limits says of a column.
fn stated(table: &MeasuredTable, column: usize, row: usize) -> Option<f64> {
    let column = table.columns().get(column)?;
    [column.nominal, column.limits[0], column.limits[1]].get(row).copied().flatten()
}

/// A name for the column of labels that no other column has.
fn labels_name(table: &MeasuredTable) -> String {
    let mut name = LABELS.to_owned();
    while table.column(&name).is_some() || table.groupings().iter().any(|grouping| grouping.name == name) {
        name.push('_');
    }
    name
}
