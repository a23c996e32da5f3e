//! Asks the reader what a key takes.

use std::cell::Cell;

use crate::scene::{
    Problem, SceneError, SceneFile,
    diagnostic::Found,
    shipped,
    tree::{Entry, Node, Source, Value},
};

/// A value of no type.
const PROBE: &str = "a probe";
/// Scenes with what none of the shipped ones has.
const OTHERS: [&str; 4] = [
    include_str!("dimensions.toml"),
    include_str!("parts.toml"),
    include_str!("rebound.toml"),
    include_str!("motion.toml"),
];
/// How many tables of one of these are asked.
const ALL: usize = 48;

/// Shipped scenes that are read in no time.
const ASKED: [&str; 6] =
    ["cd-rom-slide", "worn-tool", "hatch", "slider-crank-guide", "woodpecker-toy", "telescopic-drawer"];
/// Tables of one of these that are asked.
const TABLES: usize = 4;

/// What the key at `path` takes, with its range or its choices; `None` if no scene comes to read it.
pub fn takes(path: &str) -> Option<String> {
    each_that_it_takes(path).next()
}

/// All that the key at `path` takes, as the scenes come to read it, each once.
pub fn all_that_it_takes(path: &str) -> Vec<String> {
    let mut found = Vec::new();
    for takes in each_that_it_takes(path) {
        if !found.contains(&takes) {
            found.push(takes);
        }
    }
    found
}

fn each_that_it_takes(path: &str) -> impl Iterator<Item = String> {
    let shipped = ASKED.iter().filter_map(|name| shipped(name)).map(|text| (text, TABLES));
    let texts = shipped.chain(OTHERS.map(|text| (text, ALL)));
    texts.flat_map(move |(text, tables)| (0..tables).map_while(move |nth| takes_in(text, path, nth)).flatten())
}

/// The same of the `nth` table of one scene; `None` if it has no such table.
fn takes_in(text: &str, path: &str, nth: usize) -> Option<Option<String>> {
    let parts: Vec<_> = path.split('.').collect();
    let asked =
        |value, kind: &dyn Fn(&Problem) -> bool| {
            let error = in_scene(text, &parts, nth, value)?;
            Some(error.and_then(|error| {
                error.allowed().find_map(|(problem, allowed)| kind(problem).then(|| allowed.to_owned()))
            }))
        };
    let takes = asked(
        Value::Other(PROBE),
        &|problem| matches!(problem, Problem::Type { key, found } if key == path && *found == PROBE),
    )?;
    let Some(takes) = takes else { return Some(None) };
    let more = if takes.starts_with("a number") {
        asked(Value::Number(9.9e299), &|problem| matches!(problem, Problem::OutOfRange { key, .. } if key == path))?
            .filter(|range| *range != takes)
            .map(|range| format!("{takes}; {range}"))
    } else if takes.starts_with("a text in quotes") {
        asked(Value::Text("?".into()), &|problem| matches!(problem, Problem::Choice { key, .. } if key == path))?
    } else {
        None
    };
    Some(Some(more.unwrap_or(takes)))
}

/// What is wrong with the scene `text` once the `nth` table that has or may have the key has this `value` there; `None` if there is no
/// such table.
fn in_scene(text: &str, path: &[&str], nth: usize, value: Value<'static>) -> Option<Option<SceneError>> {
    let found = Found::default();
    let source = Source { name: "reference", text, found: &found };
    let mut tree = source.document().ok()?;
    let (mut left, mut value) = (nth, Some(value));
    put(&mut tree, path, &mut left, &mut value);
    if value.is_some() {
        return None;
    }
    Some(found.conclude(SceneFile::read(&tree, "reference").map(|_| ())).err())
}

/// Puts the `value` at the `path` below `node`, at the place that has `left` more before it.
fn put<'s>(node: &mut Node<'s>, path: &[&str], left: &mut usize, value: &mut Option<Value<'static>>) {
    let place = node.place.clone();
    let Some((key, rest)) = path.split_first() else {
        match left.checked_sub(1) {
            Some(fewer) => *left = fewer,
            None => node.value = value.take().unwrap_or(Value::Other(PROBE)),
        }
        return;
    };
    match &mut node.value {
        Value::List(nodes) => {
            for node in nodes {
                if value.is_some() {
                    put(node, path, left, value);
                }
            }
        }
        Value::Table(entries) => match entries.iter_mut().find(|entry| entry.key == *key) {
            Some(entry) => put(&mut entry.node, rest, left, value),
            None if *left > 0 => *left -= 1,
            None => {
                let mut node = Node { place: place.clone(), value: Value::Table(Vec::new()) };
                put(&mut node, rest, left, value);
                entries.push(Entry { key: (*key).to_owned().into(), place, node, read: Cell::new(false) });
            }
        },
        // A short form, such as a bare tolerance, for which the table can stand.
        _ if *left > 0 => *left -= 1,
        _ => {
            node.value = Value::Table(Vec::new());
            put(node, path, left, value);
        }
    }
}

/// Of a scene that is wrong itself the reader would tell nothing but that.
#[test]
fn the_scenes_that_are_asked_are_sound() {
    for text in OTHERS {
        SceneFile::parse("reference", text, &[]).map(|_| ()).unwrap_or_else(|error| panic!("{error}"));
    }
}
