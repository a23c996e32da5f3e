//! The numbers of a scene's text: what a slider may change, and where each is written.

use std::{collections::BTreeMap, ops::Range};

use serde::Serialize;
use toml_edit::{Document, Item, TableLike, Value};

use crate::cli::schema::SCHEMA;

/// A number that is written in a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Knob {
    /// The key as `--set` takes it, and behind a `#` which element of a list it is.
    pub name: String,
    /// The number as written.
    pub value: f64,
    /// The unit behind the number, or that of the key.
    pub unit: String,
    /// Bounds that the schema states.
    pub bounds: [Option<f64>; 2],
    /// Whether it is the mean of a gap of a pin or a joint.
    pub is_gap: bool,
    /// Where the digits are, in bytes of the text.
    #[serde(skip)]
    digits: Range<usize>,
    /// Where the whole value of the key is.
    #[serde(skip)]
    whole: Range<usize>,
}

/// The numbers of a scene's `text`, in its order; none if it is not TOML.
pub fn knobs(text: &str) -> Vec<Knob> {
    let Ok(document) = Document::parse(text) else { return Vec::new() };
    let schema: serde_json::Value = serde_json::from_str(SCHEMA).unwrap_or_default();
    let mut collected = Collected { text, schema: &schema, knobs: Vec::new() };
    collected.table("", document.as_table(), &schema);
    collected.knobs.sort_by_key(|knob| knob.digits.start);
    collected.knobs
}

/// `text` with the `knob` at another `value`; everything else stays, byte for byte.
pub fn with_value(text: &str, knob: &Knob, value: f64) -> String {
    format!("{}{value}{}", &text[..knob.digits.start], &text[knob.digits.end..])
}

/// What `--set` takes for these `values` of knobs, by name. A name that no knob has is left out.
pub fn settings(text: &str, knobs: &[Knob], values: &BTreeMap<String, f64>) -> Vec<String> {
    // The elements of a list are one value, and follow each other.
    let of_keys = knobs.chunk_by(|one, next| one.whole == next.whole);
    let assignment = |of_key: &[Knob]| {
        let whole = of_key[0].whole.clone();
        let key = of_key[0].name.split('#').next().unwrap_or_default();
        let mut written = text[whole.clone()].to_owned();
        let changed = of_key.iter().filter_map(|knob| Some((knob, values.get(&knob.name)?)));
        // From the last to the first, so that the places of the others hold.
        let changed: Vec<_> = changed.rev().collect();
        for (Knob { digits, .. }, value) in &changed {
            written.replace_range(digits.start - whole.start..digits.end - whole.start, &value.to_string());
        }
        (!changed.is_empty()).then(|| format!("{key}={written}"))
    };
    of_keys.filter_map(assignment).collect()
}

struct Collected<'a> {
    text: &'a str,
    schema: &'a serde_json::Value,
    knobs: Vec<Knob>,
}

impl Collected<'_> {
    fn table(&mut self, path: &str, table: &dyn TableLike, schema: &serde_json::Value) {
        for (key, item) in table.iter() {
            // Such keys `--set` does not know.
            if key.contains(['.', '=', '#']) {
                continue;
            }
            let path = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            let property = self.resolved(&schema["properties"][key]);
            match item {
                Item::Value(Value::InlineTable(inline)) => self.table(&path, inline, &property),
                Item::Value(value) => self.value(&path, value, &property),
                Item::Table(table) => self.table(&path, table, &property),
                Item::ArrayOfTables(tables) => {
                    for table in tables {
                        let name = table.get("name").and_then(Item::as_str);
                        if let Some(name) = name.filter(|name| !name.contains(['.', '=', '#'])) {
                            self.table(&format!("{path}.{name}"), table, &property);
                        }
                    }
                }
                Item::None => {}
            }
        }
    }

    fn value(&mut self, path: &str, value: &Value, property: &serde_json::Value) {
        let Some(whole) = value.span() else { return };
        match value {
            Value::Array(array) => {
                for (i, element) in array.iter().enumerate() {
                    if let Some(span) = element.span() {
                        self.number(format!("{path}#{i}"), element, span, whole.clone(), property);
                    }
                }
            }
            one => self.number(path.to_owned(), one, whole.clone(), whole, property),
        }
    }

    fn number(
        &mut self,
        name: String,
        value: &Value,
        span: Range<usize>,
        whole: Range<usize>,
        property: &serde_json::Value,
    ) {
        let written = &self.text[span.clone()];
        let of_key = unit_of(property);
        let (offset, digits, unit) = match value {
            Value::Integer(_) | Value::Float(_) => (0, written, of_key.clone()),
            Value::String(_) => {
                let inner = written.trim_matches(['"', '\'']);
                let (offset, length) = ((written.len() - inner.len()) / 2, number_length(inner));
                (offset, &inner[..length], inner[length..].trim().to_owned())
            }
            _ => return,
        };
        let Ok(number) = digits.parse::<f64>() else { return };
        if !number.is_finite() {
            return;
        }
        // Bounds are in the key's unit.
        let bound = |end| bound(property, end).filter(|_| unit == of_key);
        let bounds = [bound("minimum"), bound("maximum")];
        let start = span.start + offset;
        let is_gap = is_gap(&name);
        self.knobs.push(Knob { name, value: number, unit, bounds, is_gap, digits: start..start + digits.len(), whole });
    }

    /// The `schema` itself, or the definition that it refers to.
    fn resolved(&self, schema: &serde_json::Value) -> serde_json::Value {
        let reference = [&schema["$ref"], &schema["allOf"][0]["$ref"], &schema["items"]["$ref"]];
        let name = reference.into_iter().find_map(|one| one.as_str()?.strip_prefix("#/definitions/"));
        name.map_or_else(|| schema.clone(), |name| self.schema["definitions"][name].clone())
    }
}

/// Whether the number `name` is the mean of a gap: the first one of such a key of a pin or a joint.
fn is_gap(name: &str) -> bool {
    let mut words = name.split('.');
    let of = words.next();
    let key = words.nth(1).and_then(|key| key.strip_suffix("#0"));
    matches!(of, Some("pin" | "joint")) && matches!(key, Some("clearance" | "left" | "right" | "rail" | "wall"))
}

/// How many bytes of `text` are a number at its start.
fn number_length(text: &str) -> usize {
    let ends = text.char_indices().map(|(at, letter)| at + letter.len_utf8());
    ends.take_while(|end| text[..*end].trim_end() == &text[..*end])
        .filter(|end| text[..*end].parse::<f64>().is_ok_and(f64::is_finite))
        .last()
        .unwrap_or(0)
}

/// The unit in which the description of a key says that it takes bare numbers.
fn unit_of(property: &serde_json::Value) -> String {
    let description = property["description"].as_str().unwrap_or_default();
    let unit = description.split_once("number in ").and_then(|(_, rest)| rest.split([',', ';', ' ']).next());
    unit.unwrap_or_default().trim_end_matches('.').to_owned()
}

fn bound(property: &serde_json::Value, end: &str) -> Option<f64> {
    [&property[end], &property["anyOf"][0][end], &property["items"][end], &property["items"]["anyOf"][0][end]]
        .into_iter()
        .find_map(serde_json::Value::as_f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "title = \"x\"\r\n[slide]\r\nmass = \"81.8 g\" # weighed\r\ngravity = [0, -9.81, 0]\r\n[friction]\r\n\
                        coefficient = 0.3\r\n[[pin]]\r\nname = \"front left\"\r\nleft = [0.01, 0.05]\r\n";

    fn knob(name: &str) -> Knob {
        knobs(TEXT).into_iter().find(|knob| knob.name == name).unwrap_or_else(|| panic!("{name}"))
    }

    #[test]
    fn numbers_are_found_with_units_and_bounds() {
        let names: Vec<_> = knobs(TEXT).into_iter().map(|knob| knob.name).collect();
        assert_eq!(
            names,
            [
                "slide.mass",
                "slide.gravity#0",
                "slide.gravity#1",
                "slide.gravity#2",
                "friction.coefficient",
                "pin.front left.left#0",
                "pin.front left.left#1"
            ]
        );
        let gaps: Vec<_> = knobs(TEXT).into_iter().filter(|knob| knob.is_gap).map(|knob| knob.name).collect();
        assert_eq!(gaps, ["pin.front left.left#0"]);
        let crank = knobs(crate::scene::shipped("slider-crank").unwrap());
        let gaps: Vec<_> = crank.into_iter().filter(|knob| knob.is_gap).map(|knob| knob.name).collect();
        assert_eq!(gaps, ["joint.big end.clearance#0"]);
        assert_eq!((knob("slide.mass").value, knob("slide.mass").unit.as_str()), (81.8, "g"));
        assert_eq!(knob("friction.coefficient").bounds, [Some(0.0), Some(100.0)]);
    }

    #[test]
    fn writing_back_changes_nothing_but_the_number() {
        let changed = with_value(TEXT, &knob("slide.mass"), 90.5);
        assert_eq!(changed, TEXT.replace("81.8", "90.5"));
        let changed = with_value(TEXT, &knob("slide.gravity#1"), -1.5);
        assert_eq!(changed, TEXT.replace("-9.81", "-1.5"));
    }

    #[test]
    fn changed_elements_of_a_list_are_one_setting() {
        let values =
            [("pin.front left.left#0", 0.02), ("pin.front left.left#1", 0.1), ("slide.mass", 90.0), ("x", 1.0)];
        let values = values.map(|(name, value)| (name.to_owned(), value)).into();
        assert_eq!(settings(TEXT, &knobs(TEXT), &values), ["slide.mass=\"90 g\"", "pin.front left.left=[0.02, 0.1]"]);
        assert!(knobs("title = ").is_empty());
    }
}
