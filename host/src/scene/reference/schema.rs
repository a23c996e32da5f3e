//! JSON Schema of scene files (draft 7, which editors read), from the keys, their meaning and what the reader says that they take.
//!
//! It refuses less than the program: whatever it marks is wrong, but what depends on other keys is left to `slipfit check`.

use serde_json::{Map, Value, json};

use slipfit_system::parallel;

use super::{collect, meaning_of, probe};
use crate::scene::keys::{Key, ROOT, join};

/// A number with its unit, as a text.
const WITH_UNIT: &str = r"^\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*([^\s0-9.,]\S*)?\s*$";

/// The schema, as text.
pub fn schema() -> String {
    let mut tables: Vec<(String, &'static [Key])> = Vec::new();
    collect("", ROOT, &mut tables);
    let definitions = parallel::map(&first_of_each(&tables), |(path, keys)| {
        let places = tables.iter().filter(|(_, other)| are_alike(other, keys));
        let places: Vec<&str> = places.map(|(path, _)| path.as_str()).collect();
        (definition(path), table(path, keys, &places, &tables))
    });
    let mut root = table("", ROOT, &[""], &tables);
    root["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    root["title"] = json!("Scene of slipfit");
    root["type"] = json!("object");
    root["definitions"] = Value::Object(Map::from_iter(definitions));
    format!("{:#}\n", root)
}

/// Tables with keys that no table before them has.
fn first_of_each<'t>(tables: &'t [(String, &'static [Key])]) -> Vec<(&'t str, &'static [Key])> {
    let is_first = |i: usize| tables[..i].iter().all(|(_, other)| !are_alike(other, tables[i].1));
    (0..tables.len()).filter(|i| is_first(*i)).map(|i| (tables[i].0.as_str(), tables[i].1)).collect()
}

fn definition(path: &str) -> String {
    path.replace('.', "-")
}

/// Whether two tables have the same keys, and these the same keys below.
fn are_alike(one: &[Key], other: &[Key]) -> bool {
    let alike = |(one, other): (&Key, &Key)| one.name == other.name && are_alike(one.below, other.below);
    one.len() == other.len() && one.iter().zip(other).all(alike)
}

/// A table with these `keys`, which stands at `places`.
fn table(path: &str, keys: &[Key], places: &[&str], tables: &[(String, &'static [Key])]) -> Value {
    let mut properties = Map::new();
    for key in keys {
        let own = join(path, key.name);
        let (_, meaning) = meaning_of(&own);
        let mut takes: Vec<String> = Vec::new();
        for found in places.iter().flat_map(|place| probe::all_that_it_takes(&join(place, key.name))) {
            if !takes.contains(&found) {
                takes.push(found);
            }
        }
        let mut schema = if key.below.is_empty() { any_of(&takes) } else { of_tables(key, &takes, tables) };
        let takes = takes.first().filter(|_| key.below.is_empty()).map(|takes| format!("\n\nTakes {takes}."));
        schema.insert("description".into(), json!(format!("{meaning}{}", takes.unwrap_or_default())));
        properties.insert(key.name.to_owned(), Value::Object(schema));
    }
    json!({ "properties": properties, "additionalProperties": false })
}

/// A table, or a list of tables; where it has a short form, that is not looked into.
fn of_tables(key: &Key, takes: &[String], tables: &[(String, &'static [Key])]) -> Map<String, Value> {
    let first = tables.iter().find(|(_, keys)| are_alike(keys, key.below));
    let refer = json!({ "$ref": format!("#/definitions/{}", definition(first.map_or("", |(path, _)| path))) });
    let mut schema = Map::new();
    schema.insert("allOf".into(), json!([refer]));
    schema.insert("items".into(), refer);
    let is_table = |takes: &String| takes == "a table" || takes.contains("tables [[");
    if !takes.is_empty() && takes.iter().all(is_table) {
        schema.insert("type".into(), json!(["object", "array"]));
    }
    schema
}

/// One of several forms; anything where one of them is not understood.
fn any_of(takes: &[String]) -> Map<String, Value> {
    let forms: Option<Vec<Value>> = takes.iter().map(|takes| form(takes)).collect();
    match forms.as_deref() {
        None | Some([]) => Map::new(),
        Some([Value::Object(form)]) => form.clone(),
        Some(forms) => Map::from_iter([("anyOf".to_owned(), json!(forms))]),
    }
}

/// What a key takes by the reader's own words, if they are understood.
fn form(takes: &str) -> Option<Value> {
    let (what, range) = takes.split_once("; ").map_or((takes, None), |(what, range)| (what, Some(range)));
    if let Some((one, list)) = what.split_once(", or a list of ") {
        let one = range.map_or(one.to_owned(), |range| format!("{one}; {range}"));
        return Some(json!({ "anyOf": [form(&one)?, form(&format!("a list of {list}"))?] }));
    }
    if what == "true or false" {
        return Some(json!({ "type": "boolean" }));
    }
    if what == "a text in quotes" {
        return Some(json!({ "type": "string" }));
    }
    if let Some(rest) = what.strip_prefix("a list of ") {
        let (count, each) = rest.split_once(", each ")?;
        let count: usize = count.parse().ok()?;
        // In a plane lists of 3 are lists of 2.
        let least = if count == 3 { 2 } else { count };
        return Some(json!({ "type": "array", "minItems": least, "maxItems": count, "items": form(each)? }));
    }
    if what == "a number without a unit" {
        return Some(bounded(json!({ "type": "number" }), range));
    }
    if let Some((unit, _)) =
        what.strip_prefix("a number in ").and_then(|rest| rest.split_once(", or a text with its unit"))
    {
        let range = range.and_then(|range| range.strip_suffix(unit));
        let number = bounded(json!({ "type": "number" }), range);
        return Some(json!({ "anyOf": [number, { "type": "string", "pattern": WITH_UNIT }] }));
    }
    let choices: Vec<&str> = what.split(", ").collect();
    let is_word = |word: &&str| word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
    (choices.len() > 1 && choices.iter().all(|word| !word.is_empty() && is_word(word)))
        .then(|| json!({ "type": "string", "enum": choices }))
}

/// A number from a least to a greatest one, where a `range` such as "1 to 4" is understood.
fn bounded(mut number: Value, range: Option<&str>) -> Value {
    if let Some((least, most)) = range.and_then(|range| range.trim().split_once(" to "))
        && let (Ok(least), Ok(most)) = (least.parse::<f64>(), most.parse::<f64>())
    {
        number["minimum"] = json!(least);
        number["maximum"] = json!(most);
    }
    number
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    #[test]
    fn the_schema_is_that_of_this_code() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schema.json");
        let schema = super::schema();
        if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
            std::fs::write(&path, &schema).unwrap();
        }
        assert!(std::fs::read_to_string(&path).unwrap() == schema, "INSTA_UPDATE=always writes {}", path.display());
    }
}
