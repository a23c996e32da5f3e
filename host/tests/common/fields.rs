//! The fields of JSON output as the guide's page has them.

use std::{collections::BTreeMap, path::Path};

use serde_json::Value;

/// Field and type, as the guide has them.
pub type Fields = Vec<(String, String)>;

/// The tables of the guide by their headings.
pub fn guide() -> BTreeMap<String, Fields> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("guide/src/json.md");
    let text = std::fs::read_to_string(path).unwrap();
    let mut tables: BTreeMap<String, Fields> = BTreeMap::new();
    let mut heading = String::new();
    for line in text.lines() {
        if let Some(name) = line.strip_prefix("##") {
            heading = name.trim_start_matches('#').trim().replace('`', "");
        } else if let [_, field, kind, _, _] = line.split('|').map(str::trim).collect::<Vec<_>>()[..]
            && !matches!(field, "field" | "---")
        {
            tables.entry(heading.clone()).or_default().push((field.to_owned(), kind.to_owned()));
        }
    }
    tables
}

/// Whether `value` is of the type `kind`; `at` says where.
fn check(tables: &BTreeMap<String, Fields>, value: &Value, kind: &str, at: &str) {
    if let Some(kind) = kind.strip_prefix('(').and_then(|kind| kind.strip_suffix(')')) {
        check(tables, value, kind, at);
    } else if let Some(kind) = kind.strip_suffix(" or null") {
        if !value.is_null() {
            check(tables, value, kind, at);
        }
    } else if let Some(kind) = kind.strip_prefix("list of ") {
        let list = value.as_array().unwrap_or_else(|| panic!("{at} is no list"));
        list.iter().for_each(|value| check(tables, value, kind, &format!("{at}[]")));
    } else if let Some(kind) = kind.strip_prefix("map of ") {
        let map = value.as_object().unwrap_or_else(|| panic!("{at} is no object"));
        map.iter().for_each(|(key, value)| check(tables, value, kind, &format!("{at}.{key}")));
    } else {
        let fits = match kind {
            "number" => value.is_number(),
            "count" => value.is_u64(),
            "text" => value.is_string(),
            "bool" => value.is_boolean(),
            "any" => true,
            _ => {
                check_object(tables, value, kind, at);
                true
            }
        };
        assert!(fits, "{at} is not a {kind}: {value}");
    }
}

/// The fields of a table, those of `*` among them.
fn flat(tables: &BTreeMap<String, Fields>, name: &str) -> Fields {
    let fields = tables.get(name).unwrap_or_else(|| panic!("the guide has no table `{name}`"));
    fields
        .iter()
        .flat_map(|(field, kind)| if field == "*" { flat(tables, kind) } else { vec![(field.clone(), kind.clone())] })
        .collect()
}

/// Whether `value` has the fields of the table `name`, and no others; `at` says where it is from.
pub fn check_object(tables: &BTreeMap<String, Fields>, value: &Value, name: &str, at: &str) {
    let object = value.as_object().unwrap_or_else(|| panic!("{at} is no object"));
    let fields = flat(tables, name);
    for key in object.keys() {
        assert!(fields.iter().any(|(field, _)| field == key), "the guide does not know {at}.{key} of {name}");
    }
    for (field, kind) in &fields {
        let (kind, optional) = kind.strip_suffix(" optional").map_or((kind.as_str(), false), |kind| (kind, true));
        match object.get(field) {
            Some(value) => check(tables, value, kind, &format!("{at}.{field}")),
            None => assert!(optional, "{at}.{field} is missing"),
        }
    }
}
