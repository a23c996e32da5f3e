//! The keys of a scene file.

use slipfit_tolerance::product::feature::Shape;

use super::{
    Problem, drawing,
    tree::{Entry, Node, Value},
    value::Field,
};

/// A key, and the keys of the table (or the tables of the list) that it may hold.
#[derive(Clone, Copy)]
pub(super) struct Key {
    pub name: &'static str,
    pub below: &'static [Key],
}

const fn key(name: &'static str) -> Key {
    Key { name, below: &[] }
}

const fn table(name: &'static str, below: &'static [Key]) -> Key {
    Key { name, below }
}

/// Keys of a distribution alone.
const SHAPE: [Key; 13] = [
    key("kind"),
    key("mode"),
    key("shoulders"),
    key("skewness"),
    key("deviations"),
    key("shape"),
    key("shapes"),
    key("scale"),
    key("location"),
    key("mean"),
    key("shift"),
    key("deviation"),
    key("cpk"),
];
/// The same, and the parts of a mixture.
const MIXTURE: [Key; SHAPE.len() + 1] = {
    const PART: &[Key] = &[key("weight"), key("tolerance"), key("sigma"), table("distribution", &SHAPE)];
    let mut keys = [table("of", PART); SHAPE.len() + 1];
    let mut i = 0;
    while i < SHAPE.len() {
        keys[i] = SHAPE[i];
        i += 1;
    }
    keys
};
const DISTRIBUTION: Key = table("distribution", &MIXTURE);

const COST: Key = table(
    "cost",
    &[
        key("name"),
        key("fixed"),
        key("reciprocal"),
        key("exponential"),
        key("at"),
        key("power"),
        key("range"),
        key("step"),
        key("grades"),
    ],
);
const TOLERANCED: &[Key] = &[key("value"), key("tolerance"), key("sigma"), DISTRIBUTION, key("edge"), COST];
const DEVIATION: &[Key] = &[key("tolerance"), key("sigma"), DISTRIBUTION];
const BELIEF: &[Key] = &[key("mean"), key("deviation"), key("median"), key("factor")];
/// Parameters of what moves, each with the keys `below` it.
macro_rules! parameters {
    ($below:expr) => {
        &[
            table("friction", &[table("coefficient", $below), table("stick_band", $below)]),
            table("contact", &[table("stiffness", $below), table("damping", $below), table("depth", $below)]),
            table("slide", &[table("mass", $below), table("tilt_x", $below), table("tilt_z", $below)]),
            table("mechanism", &[table("tilt_x", $below), table("tilt_z", $below)]),
            table("body", &[key("name"), table("mass", $below)]),
            table("drive", &[key("name"), table("gain", $below), table("ramp_end", $below)]),
        ]
    };
}
const VECTORIAL: Key = table("vectorial", &[table("position", VECTOR), table("orientation", VECTOR)]);
const VECTOR: &[Key] = &[table("x", DEVIATION), table("y", DEVIATION), table("z", DEVIATION)];
const ZONE: &[Key] = &[
    key("zone"),
    key("datum"),
    key("material"),
    key("within"),
    key("within_datum"),
    key("pattern"),
    key("rule"),
    COST,
];

const PLANE: &[Key] = &[
    key("name"),
    key("at"),
    key("normal"),
    key("along"),
    key("extents"),
    table("offset", TOLERANCED),
    table("flatness", ZONE),
    table("straightness", ZONE),
    table("parallelism", ZONE),
    table("perpendicularity", ZONE),
    table("angularity", ZONE),
    table("position", ZONE),
    table("profile", ZONE),
    table("symmetry", ZONE),
    table("run_out", ZONE),
    table("total_run_out", ZONE),
    VECTORIAL,
];
const POINT: &[Key] = &[
    key("name"),
    key("at"),
    key("normal"),
    key("extents"),
    table("offset", TOLERANCED),
    table("flatness", ZONE),
    table("position", ZONE),
    table("profile", ZONE),
    table("run_out", ZONE),
    table("total_run_out", ZONE),
    VECTORIAL,
];
const AXIS: &[Key] = &[
    key("name"),
    key("at"),
    key("along"),
    key("length"),
    table("diameter", TOLERANCED),
    key("kind"),
    table("straightness", ZONE),
    table("parallelism", ZONE),
    table("perpendicularity", ZONE),
    table("angularity", ZONE),
    table("position", ZONE),
    table("roundness", ZONE),
    table("cylindricity", ZONE),
    table("coaxiality", ZONE),
    table("concentricity", ZONE),
    table("symmetry", ZONE),
    table("run_out", ZONE),
    table("total_run_out", ZONE),
    VECTORIAL,
];

const CONTACT: &[Key] =
    &[key("law"), key("stiffness"), key("exponent"), key("damping"), key("depth"), key("restitution"), key("speed")];
const FRICTION: &[Key] = &[key("law"), key("coefficient"), key("stick_band")];

/// The keys of a feature of this shape.
pub(super) fn of_feature(shape: Shape) -> &'static [Key] {
    match shape {
        Shape::Plane => PLANE,
        Shape::Point => POINT,
        Shape::Axis => AXIS,
    }
}

/// Every key of a scene.
pub(super) const ROOT: &[Key] = &[
    key("title"),
    table("slide", &[key("mass"), key("inertia_box"), key("gravity")]),
    table("contact", CONTACT),
    table("friction", FRICTION),
    table(
        "drive",
        &[
            key("gain"),
            key("ramp_start"),
            key("ramp_end"),
            key("speed"),
            key("point"),
            key("name"),
            key("pushes"),
            key("turns"),
            key("axis"),
        ],
    ),
    table("mechanism", &[key("space"), key("gravity")]),
    table("body", &[key("name"), key("mass"), key("inertia"), key("centre"), key("angle"), key("spin"), key("speed")]),
    table(
        "joint",
        &[
            key("name"),
            key("kind"),
            key("between"),
            key("at"),
            key("axis"),
            key("normal"),
            key("clearance"),
            key("radius"),
            key("length"),
            key("width"),
            key("left"),
            key("right"),
            key("rail"),
            key("wall"),
            table("contact", CONTACT),
            table("friction", FRICTION),
        ],
    ),
    table("spring", &[key("name"), key("between"), key("stiffness"), key("damping")]),
    table("run", &[key("duration"), key("stroke"), key("error")]),
    table("controller", &[key("step"), key("integrator"), key("scalar")]),
    table("sweep", &[key("n")]),
    table("drawing", &[key("clearance")]),
    table("pin", &[key("name"), key("position"), key("left"), key("right"), key("rail"), key("wall")]),
    table("tolerance", &[key("general"), key("rule"), key("sigma"), key("datums"), key("correlation")]),
    table(
        "dimension",
        &[
            key("name"),
            key("value"),
            key("quantity"),
            key("tolerance"),
            key("sigma"),
            DISTRIBUTION,
            key("side"),
            key("edge"),
            COST,
        ],
    ),
    table(
        "part",
        &[key("name"), key("at"), key("turned"), table("plane", PLANE), table("point", POINT), table("axis", AXIS)],
    ),
    table(
        "mate",
        &[
            key("part"),
            key("contacts"),
            key("float"),
            table("move", &[key("along"), key("by")]),
            table("turn", &[key("about"), key("at"), key("by")]),
        ],
    ),
    table(
        "measure",
        &[
            key("name"),
            key("is"),
            key("distance"),
            key("angle"),
            key("lower"),
            key("upper"),
            table("require", &[key("ppm"), key("ppk")]),
            table("loss", &[key("cost"), key("at"), key("target"), key("repair")]),
        ],
    ),
    table("allocate", &[key("yield"), key("malfunction"), key("force_limit")]),
    table("sum", &[key("name"), key("of")]),
    table(
        "identify",
        &[
            key("model"),
            key("law"),
            key("cutoff"),
            key("time"),
            key("position"),
            key("speed"),
            key("force"),
            key("current"),
            key("force_constant"),
            key("loss"),
            key("search"),
            table("friction", &[key("coefficient")]),
            table("contact", &[key("stiffness")]),
            table("slide", &[key("mass")]),
            table("gaps", &[key("of"), key("n")]),
        ],
    ),
    table(
        "measured",
        &[
            key("file"),
            key("group"),
            key("only"),
            key("distribution"),
            table("column", &[key("of"), key("heading"), key("distribution"), key("least"), key("most")]),
        ],
    ),
    table("correlation", &[key("of"), key("coefficient")]),
    table("vary", parameters!(DEVIATION)),
    table("uncertain", parameters!(BELIEF)),
];

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

pub(super) fn join(path: &str, name: &str) -> String {
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
