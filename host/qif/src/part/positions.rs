//! The order of the tables of a scene, by which its text is written.

use toml_edit::{DocumentMut, Item, Table};

use super::merge;

/// Distance between the positions of tables of the scene, so that others fit between them.
const SPACING: isize = 1 << 20;

/// All tables below `table`, and itself, in the order of their keys.
fn for_each_table(table: &mut Table, act: &mut impl FnMut(&mut Table)) {
    act(table);
    for (_, item) in table.iter_mut() {
        match item {
            Item::Table(table) => for_each_table(table, act),
            Item::ArrayOfTables(tables) => tables.iter_mut().for_each(|table| for_each_table(table, act)),
            _ => {}
        }
    }
}

/// Makes room between the positions of all tables.
pub fn spread(root: &mut Table) {
    for_each_table(root, &mut |table| {
        let position = table.position().map(|position| position * SPACING);
        table.set_position(position);
    });
}

/// Puts a table and those below it after the `last` position.
pub fn place(table: &mut Table, last: &mut isize) {
    for_each_table(table, &mut |table| {
        *last += 1;
        table.set_position(Some(*last));
    });
}

/// Position of the last table below `table`, or its own.
pub fn last_position(table: &Table) -> isize {
    let below = table.iter().map(|(_, item)| match item {
        Item::Table(table) => last_position(table),
        Item::ArrayOfTables(tables) => tables.iter().map(last_position).max().unwrap_or(0),
        _ => 0,
    });
    below.max().unwrap_or(0).max(table.position().unwrap_or(0))
}

/// Puts lines before the first table after a `position`, or at the end.
pub fn prepend_after(document: &mut DocumentMut, position: isize, lines: &str) {
    let mut next: Option<isize> = None;
    let is_after = |table: &Table| table.position().filter(|found| *found > position);
    for_each_table(document.as_table_mut(), &mut |table| {
        next = [next, is_after(table)].into_iter().flatten().min();
    });
    let Some(next) = next else {
        let trailing = document.trailing().as_str().unwrap_or_default();
        let trailing = format!("{trailing}{lines}");
        document.set_trailing(trailing);
        return;
    };
    for_each_table(document.as_table_mut(), &mut |table| {
        if table.position() == Some(next) {
            let lines = format!("{lines}{}", merge::above(table.decor()));
            table.decor_mut().set_prefix(lines);
        }
    });
}
