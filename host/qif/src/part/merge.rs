//! What of one feature is renewed, and what stays.

use toml_edit::{Decor, InlineTable, Item, Key, Table, Value};

use super::write::MARK;

/// Keys that say where a feature is; they have no comment.
const PLACE: [&str; 6] = ["at", "normal", "along", "extents", "length", "kind"];
/// Keys of a tolerance that come from a model; others, such as a distribution or a cost, are the user's.
const FROM_MODEL: [&str; 8] = ["zone", "material", "datum", "within", "within_datum", "pattern", "value", "tolerance"];

/// The comment of an import beside a value, without its mark.
pub fn comment(item: &Item) -> Option<&str> {
    let suffix = item.as_value()?.decor().suffix()?.as_str()?;
    Some(suffix.trim().strip_prefix(MARK)?.trim())
}

/// Gives `old` the comment of `new`, if it has one of an import.
pub fn remark(old: &mut Item, new: &Item) {
    if comment(old).is_none() {
        return;
    }
    let (Some(old), Some(new)) = (old.as_value_mut(), new.as_value()) else { return };
    if let Some(suffix) = new.decor().suffix().and_then(|suffix| suffix.as_str()) {
        old.decor_mut().set_suffix(suffix);
    }
}

/// Gives `old` the comments of an import in lines of their own that `new` has: above its header and above its keys.
pub fn comments(old: &mut Table, new: &Table) {
    let lines = renewed(above(old.decor()), above(new.decor()));
    old.decor_mut().set_prefix(lines);
    let of_new: String = new.iter().filter_map(|(key, _)| new.key(key)).map(above_key).flat_map(marked).collect();
    let mut of_new = Some(of_new);
    let keys: Vec<String> = old.iter().map(|(key, _)| key.to_owned()).collect();
    for key in keys {
        let Some(mut key) = old.key_mut(&key) else { continue };
        let own = unmarked(above(key.leaf_decor()));
        key.leaf_decor_mut().set_prefix(of_new.take().unwrap_or_default() + &own);
    }
}

/// The lines above a header or a key.
pub fn above(decor: &Decor) -> &str {
    decor.prefix().and_then(|prefix| prefix.as_str()).unwrap_or_default()
}

fn above_key(key: &Key) -> &str {
    above(key.leaf_decor())
}

/// The lines above the header of a table and above its keys, without those of an import.
pub fn own_lines(table: &Table) -> String {
    let of_keys: String = table.iter().filter_map(|(key, _)| table.key(key)).map(above_key).map(unmarked).collect();
    unmarked(above(table.decor())) + &of_keys
}

/// Keys of an imported feature that the user added.
pub fn own_keys(table: &Table) -> Vec<&str> {
    let is_own = |(key, item): &(&str, &Item)| *key != "name" && !PLACE.contains(key) && comment(item).is_none();
    table.iter().filter(is_own).map(|(key, _)| key).collect()
}

/// Makes an imported feature the user's: its comments are no more those of an import.
pub fn give_away(table: &mut Table) {
    for (_, item) in table.iter_mut() {
        let Some(comment) = comment(item).map(|comment| format!(" # {comment}")) else { continue };
        if let Some(value) = item.as_value_mut() {
            value.decor_mut().set_suffix(comment);
        }
    }
}

/// Lines of an import.
fn marked(lines: &str) -> impl Iterator<Item = &str> {
    lines.split_inclusive('\n').filter(|line| line.trim_start().starts_with(MARK))
}

/// All other lines.
fn unmarked(lines: &str) -> String {
    lines.split_inclusive('\n').filter(|line| !line.trim_start().starts_with(MARK)).collect()
}

/// The lines `old` with those of an import in `new`, where the first one of `old` was, or at the end.
fn renewed(old: &str, new: &str) -> String {
    let lines: Vec<&str> = old.split_inclusive('\n').collect();
    let is_marked = |line: &&str| line.trim_start().starts_with(MARK);
    let first = lines.iter().position(is_marked).unwrap_or(lines.len());
    let before = lines[..first].iter().copied();
    let after = lines[first..].iter().copied().filter(|line| !is_marked(line));
    before.chain(marked(new)).chain(after).collect()
}

/// Renews the feature `old`, which was imported as `name`, by that of the model, and says what changes.
pub fn feature(old: &mut Table, new: &Table, name: &str, changes: &mut Vec<String>) {
    comments(old, new);
    let gone: Vec<String> = old
        .iter()
        .filter(|(key, item)| !new.contains_key(key) && comment(item).is_some())
        .map(|(key, _)| key.to_owned())
        .collect();
    for key in gone {
        let lines = old.key(&key).map(above_key).map(unmarked).unwrap_or_default();
        let value = old.remove(&key).map(|item| written(&item)).unwrap_or_default();
        if let Some(mut name) = old.key_mut("name").filter(|_| lines.contains('#')) {
            let lines = format!("{}{lines}", above(name.leaf_decor()));
            name.leaf_decor_mut().set_prefix(lines);
        }
        changes.push(format!("{name}: {key} is not in the model, and was removed; it was {value}"));
        // It says whether the diameter is that of a hole or of a pin.
        if key == "diameter" && !new.contains_key("kind") {
            old.remove("kind");
        }
    }
    for (key, item) in new.iter() {
        let is_placed = PLACE.contains(&key);
        match old.get_mut(key) {
            Some(found) if key == "name" => remark(found, item),
            Some(found) => value(found, item, is_placed, &format!("{name}: {key}"), changes),
            None => {
                old.insert(key, item.clone());
                changes.push(format!("{name}: {key} = {} is new", written(item)));
            }
        }
    }
}

/// Renews a value, unless it is the user's.
fn value(old: &mut Item, new: &Item, is_placed: bool, name: &str, changes: &mut Vec<String>) {
    let [before, model] = [&*old, new].map(written);
    let is_same = match (old.as_value(), new.as_value()) {
        (Some(old), Some(new)) => is_same(&stated(old), &stated(new)),
        _ => false,
    };
    let (was, is) = (comment(old), comment(new));
    let is_users = !is_placed && (was.is_none() || was == is) || old.as_value().is_none();
    if !is_same && is_users {
        changes.push(format!("{name} stays {before}, as you wrote it; the model has {model}"));
        return;
    }
    remark(old, new);
    if let (false, Some(old), Some(new)) = (is_same, old.as_value_mut(), new.as_value()) {
        state(old, new);
        changes.push(format!("{name} is {}; it was {before}", written_value(old)));
    }
}

/// What of a value comes from a model, each with its key; a number alone is the width of a zone.
fn stated(value: &Value) -> Vec<(&str, &Value)> {
    match value {
        Value::InlineTable(table) => table.iter().filter(|(key, _)| FROM_MODEL.contains(key)).collect(),
        value => vec![("zone", value)],
    }
}

fn is_same(old: &[(&str, &Value)], new: &[(&str, &Value)]) -> bool {
    let has = |key: &str, value: &Value| new.iter().any(|(k, v)| *k == key && equal(value, v));
    old.len() == new.len() && old.iter().all(|(key, value)| has(key, value))
}

/// Whether two values are the same, however they are written.
fn equal(one: &Value, two: &Value) -> bool {
    let number = |value: &Value| value.as_float().or(value.as_integer().map(|whole| whole as f64));
    match (one, two) {
        (Value::String(one), Value::String(two)) => one.value() == two.value(),
        (Value::Array(one), Value::Array(two)) => {
            one.len() == two.len() && one.iter().zip(two).all(|(one, two)| equal(one, two))
        }
        _ => number(one).is_some() && number(one) == number(two),
    }
}

/// Gives `old` what `new` states; what else the user wrote into its table stays.
fn state(old: &mut Value, new: &Value) {
    let has_own = |table: &InlineTable| table.iter().any(|(key, _)| !FROM_MODEL.contains(&key));
    let Value::InlineTable(table) = old else { return replace(old, new) };
    if !has_own(table) {
        return replace(old, new);
    }
    let stated: Vec<(String, Value)> =
        stated(new).into_iter().map(|(key, value)| (key.to_owned(), value.clone())).collect();
    let gone = FROM_MODEL.into_iter().filter(|key| !stated.iter().any(|(own, _)| own == key));
    for key in gone {
        table.remove(key);
    }
    for (key, value) in stated {
        match table.get_mut(&key) {
            Some(old) => replace(old, &value),
            None => {
                table.insert(&key, value.decorated(" ", ""));
            }
        }
    }
}

/// Puts a value in the place of another, with the spaces and the comment of that place.
fn replace(old: &mut Value, new: &Value) {
    let decor = old.decor().clone();
    *old = new.clone();
    *old.decor_mut() = decor;
}

/// The text of a value, without its comment.
fn written(item: &Item) -> String {
    item.as_value().map_or_else(|| "a table".to_owned(), written_value)
}

fn written_value(value: &Value) -> String {
    let mut value = value.clone();
    value.decor_mut().clear();
    value.to_string()
}
