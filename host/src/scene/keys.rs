//! The keys of a scene file.

use super::{
    Problem, SceneError,
    tree::{Node, Value},
};

/// A key, and the keys of the table (or the tables of the list) that it may hold.
struct Key {
    name: &'static str,
    below: &'static [Key],
}

const fn key(name: &'static str) -> Key {
    Key { name, below: &[] }
}

const fn table(name: &'static str, below: &'static [Key]) -> Key {
    Key { name, below }
}

const DISTRIBUTION: Key = table(
    "distribution",
    &[key("kind"), key("sigma"), key("mode"), key("shoulders"), key("skewness"), key("deviations")],
);

/// Every key of a scene.
const ROOT: &[Key] = &[
    key("title"),
    table("slide", &[key("mass"), key("inertia_box"), key("gravity")]),
    table("contact", &[key("stiffness"), key("exponent"), key("damping"), key("depth")]),
    table("friction", &[key("law"), key("coefficient"), key("stick_band")]),
    table("drive", &[key("gain"), key("ramp_start"), key("ramp_end"), key("speed"), key("point")]),
    table("run", &[key("duration"), key("step"), key("integrator")]),
    table("sweep", &[key("n")]),
    table("drawing", &[key("clearance")]),
    table("pin", &[key("name"), key("position"), key("left"), key("right"), key("rail"), key("wall")]),
    table("tolerance", &[key("general"), key("rule"), key("sigma")]),
    table(
        "dimension",
        &[key("name"), key("value"), key("tolerance"), key("sigma"), DISTRIBUTION, key("side"), key("edge")],
    ),
    table("measure", &[key("name"), key("is"), key("lower"), key("upper")]),
    table("sum", &[key("name"), key("of")]),
    table("correlation", &[key("of"), key("coefficient")]),
];

/// Refuses a key below the root `node` that no scene has.
pub fn refuse_unknown(node: &Node<'_>) -> Result<(), SceneError> {
    refuse(node, "", ROOT)
}

/// Refuses a key below `node`, itself at the key `path`, that is not one of `keys`.
fn refuse(node: &Node<'_>, path: &str, keys: &[Key]) -> Result<(), SceneError> {
    match &node.value {
        Value::Table(entries) => entries.iter().try_for_each(|entry| {
            let name = join(path, &entry.key);
            match keys.iter().find(|key| key.name == entry.key) {
                Some(key) => refuse(&entry.node, &name, key.below),
                None => {
                    let similar = similar(&name);
                    let allowed = keys.iter().map(|key| key.name).collect::<Vec<_>>().join(", ");
                    Err(entry.place.error(Problem::UnknownKey { key: name, similar }, allowed))
                }
            }
        }),
        Value::List(nodes) => nodes.iter().try_for_each(|node| refuse(node, path, keys)),
        // Reading the value says that it is no table.
        _ => Ok(()),
    }
}

fn join(path: &str, name: &str) -> String {
    if path.is_empty() { name.into() } else { format!("{path}.{name}") }
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
