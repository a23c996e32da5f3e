//! Checks of a scene's keys before and after it is read: keys that no scene has, keys without effect, texts unfit to be printed.

use super::{
    Problem, drawing,
    keys::{Key, ROOT, join},
    tree::{Entry, Node, Value},
    value::Field,
};

/// Notes every key below the root `node` that no scene has, and every text that is not fit to be printed.
pub fn note_unfit(node: &Node<'_>) {
    note(node, "", ROOT);
}

/// Tables of what moves and of its run. Which of their keys count depends on the scene: on the kind of a joint, the law of a contact,
/// whether it is a slide or a mechanism.
const OF_MOTION: [&str; 16] = [
    "slide",
    "contact",
    "friction",
    "drive",
    "mechanism",
    "body",
    "joint",
    "spring",
    "run",
    "controller",
    "sweep",
    "drawing",
    "pin",
    "vary",
    "uncertain",
    "identify",
];

/// Notes every key of the tables of motion below the `root` that nothing has read: it has no effect.
pub fn note_unread(root: &Node<'_>) {
    let Value::Table(entries) = &root.value else { return };
    entries.iter().filter(|entry| OF_MOTION.contains(&&*entry.key)).for_each(|entry| unread(entry, "", entries));
}

/// Notes the `entry` of a table at the key `path` with these `entries` if nothing has read it, else what is below it.
fn unread(entry: &Entry<'_>, path: &str, entries: &[Entry<'_>]) {
    let name = join(path, &entry.key);
    if !entry.read.get() {
        let read: Vec<_> = entries.iter().filter(|other| other.read.get()).map(|other| &*other.key).collect();
        let allowed = format!("to leave it out; what counts here: {}", read.join(", "));
        let problem = Problem::NoEffect { key: name, place: "here: nothing in this scene depends on it".into() };
        return entry.place.found().note(entry.place.error(problem, allowed));
    }
    let below = |node: &Node<'_>| {
        if let Value::Table(entries) = &node.value {
            entries.iter().for_each(|entry| unread(entry, &name, entries));
        }
    };
    match &entry.node.value {
        Value::List(nodes) => nodes.iter().for_each(below),
        _ => below(&entry.node),
    }
}

/// An expression may go over several lines; it is not printed.
const EXPRESSION: &str = "measure.is";

/// Whether `letter` of the text at the key `path` would steer a terminal or a page.
fn is_unfit(path: &str, letter: char) -> bool {
    letter.is_control() && !(path == EXPRESSION && matches!(letter, '\n' | '\r' | '\t'))
}

/// Notes every key below `node`, itself at the key `path`, that is not one of `keys`, and every unfit text.
fn note(node: &Node<'_>, path: &str, keys: &[Key]) {
    let found = node.place.found();
    match &node.value {
        Value::Table(entries) => entries.iter().for_each(|entry| {
            let name = join(path, &entry.key);
            match keys.iter().find(|key| key.name == entry.key) {
                Some(key) => note(&entry.node, &name, key.below),
                None => {
                    let allowed = keys.iter().map(|key| key.name).collect::<Vec<_>>().join(", ");
                    let problem = match drawing::meaning(&entry.key) {
                        Some(known) if keys.iter().any(|key| key.name == known) => {
                            Problem::UnknownKey { key: name, similar: Some(join(path, known)) }
                        }
                        Some(meaning) => Problem::Unsupported { what: named(&entry.key, meaning) },
                        None => {
                            let similar = similar(&name);
                            Problem::UnknownKey { key: name, similar }
                        }
                    };
                    found.note(entry.place.error(problem, allowed));
                }
            }
        }),
        Value::List(nodes) => nodes.iter().for_each(|node| note(node, path, keys)),
        Value::Text(text) if text.chars().any(|letter| is_unfit(path, letter)) => {
            let field = Field { key: path.into(), node };
            let problem = Problem::ControlCharacter { key: path.into(), written: field.written("") };
            found.note(field.error(problem, "a text of one line, without tabs and other control characters"));
        }
        // Reading the value says that it is no table.
        _ => {}
    }
}

/// What a `key` means, and how it is written if that is something else.
fn named(key: &str, meaning: &str) -> String {
    if key == meaning { key.into() } else { format!("{key}, {meaning},") }
}

/// The full names of `keys` below `path` and of all that is below them.
fn flat(keys: &[Key], path: &str, names: &mut Vec<String>) {
    for key in keys {
        let name = join(path, key.name);
        flat(key.below, &name, names);
        names.push(name);
    }
}

/// The key that is spelt most like `unknown`, or has its last part in another table.
fn similar(unknown: &str) -> Option<String> {
    let last = |key: &str| key.rsplit('.').next().map(str::to_owned);
    let distance = |key: &str| if last(key) == last(unknown) { 1 } else { strsim::osa_distance(key, unknown) };
    let mut names = Vec::new();
    flat(ROOT, "", &mut names);
    let nearest = names.into_iter().map(|name| (distance(&name), name)).min_by_key(|(distance, _)| *distance);
    nearest.filter(|(distance, _)| *distance <= 2).map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::similar;

    #[test]
    fn misspelt_and_misplaced_keys_are_recognised() {
        for (unknown, known) in [
            ("slide.mas", Some("slide.mass")),
            ("slied", Some("slide")),
            ("mass", Some("slide.mass")),
            ("slide.stiffness", Some("contact.stiffness")),
            ("dimension.tolerence", Some("dimension.tolerance")),
            ("skewness", Some("dimension.distribution.skewness")),
            ("colour", None),
        ] {
            assert_eq!(similar(unknown).as_deref(), known);
        }
    }
}
