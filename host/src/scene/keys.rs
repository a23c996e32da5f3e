//! The keys of a scene file.

use super::{
    Problem, SceneError,
    tree::{Node, Value},
};

/// Every key, with its table.
const KEYS: [&str; 27] = [
    "title",
    "slide.mass",
    "slide.inertia_box",
    "slide.gravity",
    "contact.stiffness",
    "contact.exponent",
    "contact.damping",
    "contact.depth",
    "friction.law",
    "friction.coefficient",
    "friction.stick_band",
    "drive.gain",
    "drive.ramp_start",
    "drive.ramp_end",
    "drive.speed",
    "drive.point",
    "run.duration",
    "run.step",
    "run.integrator",
    "sweep.n",
    "drawing.clearance",
    "pin.name",
    "pin.position",
    "pin.left",
    "pin.right",
    "pin.rail",
    "pin.wall",
];

/// Refuses a key below `node`, itself at the key `path`, that is not one of [`KEYS`].
pub fn refuse_unknown(node: &Node<'_>, path: &str) -> Result<(), SceneError> {
    match &node.value {
        Value::Table(entries) => entries.iter().try_for_each(|entry| {
            let key = if path.is_empty() { entry.key.to_string() } else { format!("{path}.{}", entry.key) };
            if KEYS.contains(&key.as_str()) {
                Ok(())
            } else if tables().any(|table| table == key) {
                refuse_unknown(&entry.node, &key)
            } else {
                let similar = similar(&key);
                Err(entry.place.error(Problem::UnknownKey { key, similar }, siblings(path)))
            }
        }),
        Value::List(nodes) => nodes.iter().try_for_each(|node| refuse_unknown(node, path)),
        // Reading the table says that it is none.
        _ => Ok(()),
    }
}

/// The tables that keys are in, each as often as it has keys.
fn tables() -> impl Iterator<Item = &'static str> {
    KEYS.iter().filter_map(|key| key.split_once('.')).map(|(table, _)| table)
}

/// The key that is spelt most like `unknown`, or has its last part in another table.
fn similar(unknown: &str) -> Option<&'static str> {
    let last = |key: &str| key.rsplit('.').next().map(str::to_owned);
    let distance = |key| if last(key) == last(unknown) { 1 } else { strsim::osa_distance(key, unknown) };
    let candidates = KEYS.into_iter().chain(tables()).map(|key| (distance(key), key));
    candidates.min().filter(|(distance, _)| *distance <= 2).map(|(_, key)| key)
}

/// The keys of a `table`, the root's if it is empty, for a message.
fn siblings(table: &str) -> String {
    let mut keys: Vec<_> = if table.is_empty() {
        KEYS.iter().map(|key| key.split_once('.').map_or(*key, |(table, _)| table)).collect()
    } else {
        KEYS.iter().filter_map(|key| key.split_once('.')).filter(|(of, _)| *of == table).map(|(_, key)| key).collect()
    };
    keys.dedup();
    keys.join(", ")
}

#[cfg(test)]
mod tests {
    use super::{siblings, similar};

    #[test]
    fn misspelt_and_misplaced_keys_are_recognised() {
        assert_eq!(similar("slide.mas"), Some("slide.mass"));
        assert_eq!(similar("slied"), Some("slide"));
        assert_eq!(similar("mass"), Some("slide.mass"));
        assert_eq!(similar("slide.stiffness"), Some("contact.stiffness"));
        assert_eq!(similar("colour"), None);
        assert_eq!(siblings("sweep"), "n");
        assert_eq!(siblings(""), "title, slide, contact, friction, drive, run, sweep, drawing, pin");
    }
}
