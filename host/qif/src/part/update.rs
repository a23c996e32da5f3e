//! Renews an imported part in a scene that already uses it.
//!
//! What the import wrote is known by its comments, which begin with `#|`, and by the place of its features. Everything else is the user's and
//! stays, to the last blank. A tolerance whose comment is still that of the model, but not its value, was changed by hand and stays, too.

use std::collections::HashMap;

use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TomlError};

use super::{
    Part, merge, names, part_of,
    positions::{last_position, place, prepend_after, spread},
    write::{DATUM, MARK, in_file, left_out_of},
};
use crate::drawing::Drawing;

/// Tables of a part that hold features.
const KINDS: [&str; 3] = ["plane", "axis", "point"];

/// A scene with a renewed part.
#[derive(Clone, Debug, PartialEq)]
pub struct Updated {
    /// The scene's text.
    pub text: String,
    /// The part as the model has it.
    pub part: Part,
    /// What is another than before, and what stays although the model has it otherwise: a sentence each.
    pub changes: Vec<String>,
}

/// Why a part of a scene cannot be renewed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UpdateError {
    /// The scene is no TOML.
    #[error("{line}:{column}: {message}")]
    Toml {
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// What is wrong there.
        message: String,
    },
    /// No `[[part]]` has the name.
    #[error("it has no [[part]] named {name:?}; parts that it has: {parts}")]
    NoPart {
        /// The name.
        name: String,
        /// The parts that there are.
        parts: String,
    },
    /// The part has no feature that was imported.
    #[error(
        "no feature of the part {0:?} was imported: a comment that begins with `{MARK}` beside its name would say so"
    )]
    NotImported(String),
}

/// Renews the part called `name`, or as the file names it, in the text of a `scene` from a `drawing`; `source` is named in its first
/// comment.
///
/// # Errors
/// [`UpdateError`], if the scene is no TOML, or has no such part that was imported.
pub fn update(scene: &str, drawing: &Drawing, name: Option<&str>, source: &str) -> Result<Updated, UpdateError> {
    let name = name.map_or_else(|| names::valid(&drawing.name), str::to_owned);
    let has_returns = scene.contains("\r\n");
    let scene = scene.replace("\r\n", "\n");
    let (scene, has_list) = without_left_out(&scene, &name);
    let mut document: DocumentMut = scene.parse().map_err(|error| at(&scene, &error))?;
    spread(document.as_table_mut());
    let mut tables: Vec<&mut Table> = parts(&mut document).collect();
    let Some(index) = tables.iter().position(|table| text(table, "name") == Some(&name)) else {
        let parts: Vec<_> = tables.iter().filter_map(|table| text(table, "name")).collect();
        let parts = if parts.is_empty() { "none".to_owned() } else { parts.join(", ") };
        return Err(UpdateError::NoPart { name, parts });
    };
    let table = tables.swap_remove(index);
    let part = part_of(drawing, &name, source, feature_names(table, drawing));
    let renewed: DocumentMut = format!("{}{}", part.head, part.text).parse().map_err(|error| at(&part.text, &error))?;
    let renewed = renewed["part"][0].as_table().cloned().unwrap_or_default();
    if imported(table).next().is_none() {
        return Err(UpdateError::NotImported(name));
    }
    let mut changes = Vec::new();
    let comments = renew(table, &renewed, &name, &mut changes);
    let end = last_position(table);
    for (position, lines) in comments {
        prepend_after(&mut document, position, &lines);
    }
    if !has_list {
        let head = left_out_of(&name);
        prepend_after(&mut document, end, &format!("\n{head}\n"));
    }
    let text = document.to_string();
    let text = text.replacen(&format!("{}\n", left_out_of(&name)), &part.left_out, 1);
    for change in &mut changes {
        let Some(feature) = change.strip_suffix(" is not in the model, and was removed") else { continue };
        let is_named = |line: &str| !line.trim_start().starts_with('#') && refers_to(line, feature);
        if let Some(line) = text.lines().position(is_named) {
            *change += &format!("; line {} refers to it", line + 1);
        }
    }
    let text = if has_returns { text.replace('\n', "\r\n") } else { text };
    Ok(Updated { text, part, changes })
}

/// An error of TOML with its place in a `text`.
fn at(text: &str, error: &TomlError) -> UpdateError {
    let before = text.get(..error.span().map_or(0, |span| span.start)).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
    UpdateError::Toml { line, column, message: error.message().trim_end().to_owned() }
}

/// Whether a line has the name of a `feature`, and not as the beginning of another.
fn refers_to(line: &str, feature: &str) -> bool {
    let ends = |(at, _): (usize, &str)| {
        let rest = &line[at + feature.len()..];
        rest.starts_with(['"', '\'', '.', '-', ')']) || rest.starts_with(" (")
    };
    line.match_indices(feature).any(ends)
}

/// The `[[part]]` tables.
fn parts(document: &mut DocumentMut) -> impl Iterator<Item = &mut Table> {
    document.get_mut("part").and_then(Item::as_array_of_tables_mut).into_iter().flat_map(ArrayOfTables::iter_mut)
}

/// A `scene` in which what is left out of a part is its first line alone, and whether it had one.
fn without_left_out(scene: &str, part: &str) -> (String, bool) {
    let head = left_out_of(part);
    let (mut text, mut is_in_list, mut has_list) = (String::new(), false, false);
    for line in scene.split_inclusive('\n') {
        is_in_list &= line.starts_with(MARK);
        if is_in_list {
            continue;
        }
        is_in_list = !has_list && line.trim_end() == head;
        has_list |= is_in_list;
        text += line;
    }
    (text, has_list)
}

fn text<'t>(table: &'t Table, key: &str) -> Option<&'t str> {
    table.get(key).and_then(Item::as_str)
}

/// The imported features of a part: kind, name, and its kind and name in the file.
fn imported(part: &Table) -> impl Iterator<Item = (&'static str, &str, &str)> {
    tables_of(part).filter_map(|(kind, table)| {
        let comment = merge::comment(table.get("name")?)?;
        Some((kind, text(table, "name")?, comment.split(DATUM).next().unwrap_or(comment)))
    })
}

/// Names of the features of a `drawing`: what the scene's `part` calls those that are in it.
fn feature_names(part: &Table, drawing: &Drawing) -> Vec<String> {
    let mut found = names::features(drawing);
    let known: Vec<_> = imported(part).map(|(_, name, in_file)| (name, in_file)).collect();
    let mut of_files: HashMap<String, Vec<usize>> = HashMap::new();
    for (index, feature) in drawing.features.iter().enumerate() {
        of_files.entry(in_file(feature)).or_default().push(index);
    }
    for (name, in_file) in &known {
        let is_only = known.iter().filter(|(_, other)| other == in_file).count() == 1;
        if let (false, true, Some(&[index])) =
            (found.iter().any(|taken| taken == name), is_only, of_files.get(*in_file).map(Vec::as_slice))
            && !known.iter().any(|(taken, _)| *taken == found[index])
        {
            found[index] = (*name).to_owned();
        }
    }
    found
}

/// Renews what was imported in `part`. What is returned are the user's comments above features that are no more, with their positions.
fn renew(part: &mut Table, renewed: &Table, name: &str, changes: &mut Vec<String>) -> Vec<(isize, String)> {
    merge::comments(part, renewed);
    if let (Some(old), Some(new)) = (part.get_mut("name"), renewed.get("name")) {
        merge::remark(old, new);
    }
    let old: Vec<_> = imported(part).map(|(kind, name, _)| (kind, name.to_owned())).collect();
    let mut new: Vec<_> = tables_of(renewed).collect();
    new.sort_by_key(|(_, table)| table.position());
    let is_new = |kind: &str, name: &str| new.iter().any(|(k, t)| *k == kind && text(t, "name") == Some(name));
    let mut comments = Vec::new();
    for (kind, feature) in old.iter().filter(|(kind, feature)| !is_new(kind, feature)) {
        match remove(part, kind, feature) {
            Removed::Kept(keys) => {
                changes.push(format!("{name}.{feature} is not in the model, and is yours now, as you added {keys}"));
            }
            Removed::Gone(lines) => {
                comments.extend(lines);
                changes.push(format!("{name}.{feature} is not in the model, and was removed"));
            }
        }
    }
    // A datum stands above what refers to it.
    let mut last = part.position().unwrap_or_default();
    for (kind, table) in new {
        let feature = text(table, "name").unwrap_or_default();
        let tables = part.entry(kind).or_insert_with(|| Item::ArrayOfTables(ArrayOfTables::new()));
        // Features that are written as a list in one line are the user's.
        let Some(tables) = tables.as_array_of_tables_mut() else { continue };
        let found = tables.iter().position(|old| text(old, "name") == Some(feature));
        match found.and_then(|index| tables.get_mut(index)) {
            Some(old) if old.get("name").and_then(merge::comment).is_some() => {
                merge::feature(old, table, &format!("{name}.{feature}"), changes);
                if old.position().is_none_or(|position| position <= last) {
                    place(old, &mut last);
                }
                last = last.max(last_position(old));
            }
            Some(_) => {
                changes.push(format!("{name}.{feature} stays as you wrote it; the model has a feature of this name"))
            }
            None => {
                let mut table = table.clone();
                place(&mut table, &mut last);
                tables.push(table);
                changes.push(format!("{name}.{feature} is new"));
            }
        }
    }
    comments
}

/// The features of a part, each with its kind.
fn tables_of(part: &Table) -> impl Iterator<Item = (&'static str, &Table)> {
    let of = |kind| part.get(kind).and_then(Item::as_array_of_tables).into_iter().flat_map(ArrayOfTables::iter);
    KINDS.into_iter().flat_map(move |kind| of(kind).map(move |table| (kind, table)))
}

/// What became of a feature that the model has no more.
enum Removed {
    /// It stays, as the user added these keys to it.
    Kept(String),
    /// It is gone; the user's comments at it, with their position, are not.
    Gone(Option<(isize, String)>),
}

/// Takes a feature out of a part, unless the user added keys to it.
fn remove(part: &mut Table, kind: &str, name: &str) -> Removed {
    let tables = part.get_mut(kind).and_then(Item::as_array_of_tables_mut);
    let Some(tables) = tables else { return Removed::Gone(None) };
    let index = tables.iter().position(|table| text(table, "name") == Some(name));
    let Some((index, table)) = index.and_then(|index| Some((index, tables.get_mut(index)?))) else {
        return Removed::Gone(None);
    };
    let keys = merge::own_keys(table).join(", ");
    if !keys.is_empty() {
        merge::give_away(table);
        return Removed::Kept(keys);
    }
    let lines = merge::own_lines(table);
    let place = table.position().unwrap_or_default();
    tables.remove(index);
    if tables.is_empty() {
        part.remove(kind);
    }
    Removed::Gone(lines.contains('#').then_some((place, lines)))
}
