//! The scene file's part of the reference. What a key takes is asked of the reader itself: given a value of no type, it says what
//! is allowed.

mod meaning;
mod probe;
mod schema;

use std::fmt::Write;

use slipfit_tolerance::unit::{self, Unit};

use super::keys::{Key, ROOT, join};
use meaning::{DISTRIBUTIONS, MEANINGS};

/// Kinds of quantities with their units.
const QUANTITIES: [(&str, &[Unit]); 25] = [
    ("length", unit::LENGTH),
    ("angle", unit::ANGLE),
    ("mass", unit::MASS),
    ("force", unit::FORCE),
    ("stiffness", unit::STIFFNESS),
    ("moment", unit::MOMENT),
    ("pressure", unit::PRESSURE),
    ("time of a drive's ramp, of a dimension", unit::SECONDS),
    ("duration of a run, `--every`", unit::MILLISECONDS),
    ("step of the controller", unit::MICROSECONDS),
    ("speed", unit::SPEED),
    ("acceleration", unit::ACCELERATION),
    ("moment of inertia", unit::INERTIA),
    ("angular velocity", unit::ROTATION),
    ("damping, gain of a force", unit::DAMPING),
    ("damping, gain of a torque", unit::TORQUE_GAIN),
    ("stiffness about an axis", unit::TORSION),
    ("frequency", unit::FREQUENCY),
    ("torque of a drive", unit::TORQUE),
    ("angular acceleration", unit::ANGULAR_ACCELERATION),
    ("jerk", unit::JERK),
    ("angular jerk", unit::ANGULAR_JERK),
    ("slope of a wall", unit::SLOPE),
    ("growth of friction with speed", unit::PER_SPEED),
    ("gain of a position loop", unit::PER_SECOND),
];

/// Stands for what a key takes where the parser's message about a wrong value does not say it.
const UNREAD: &str = "see the meaning";

/// Every key by its table; a table that stands in several places is told once.
pub(crate) fn keys() -> String {
    let mut all = vec![(String::new(), ROOT)];
    collect("", ROOT, &mut all);
    let mut page = String::new();
    let mut used = vec![false; MEANINGS.len()];
    for (i, (path, keys)) in all.iter().enumerate() {
        if all[..i].iter().all(|(_, other)| names(other) != names(keys)) {
            let others = || all.iter().filter(|(_, other)| names(other) == names(keys)).map(|(path, _)| path.as_str());
            section(path, keys, &others().collect::<Vec<_>>(), &all, &mut used, &mut page);
        }
    }
    let unused: Vec<_> = MEANINGS.iter().zip(used).filter(|(_, used)| !used).map(|((path, _), _)| path).collect();
    assert!(unused.is_empty(), "described, but no such key: {unused:?}");
    page
}

/// Every table below `path`, with its keys.
fn collect(path: &str, keys: &'static [Key], all: &mut Vec<(String, &'static [Key])>) {
    let tables = || keys.iter().filter(|key| !key.below.is_empty()).map(|key| (join(path, key.name), key.below));
    all.extend(tables());
    tables().for_each(|(path, keys)| collect(&path, keys, all));
}

fn names(keys: &[Key]) -> Vec<&str> {
    keys.iter().map(|key| key.name).collect()
}

/// The table at `path`, which has the same keys as those at `others`.
fn section(path: &str, keys: &[Key], others: &[&str], all: &[(String, &[Key])], used: &mut [bool], page: &mut String) {
    let heading = if path.is_empty() { "The file".to_owned() } else { format!("`{path}`") };
    let mut same = same_keys(path, others);
    // A table that goes on where another one ends.
    let before = all.iter().take_while(|(other, _)| other != path);
    let begins =
        |other: &[Key]| other.len() > 1 && other.len() < keys.len() && names(&keys[..other.len()]) == names(other);
    let first = before.filter(|(_, other)| begins(other)).max_by_key(|(_, other)| other.len());
    if let Some((other, _)) = first {
        same = format!("Besides these it has the keys of [`{other}`](#{}).\n\n", other.replace('.', ""));
    }
    let _ = writeln!(page, "\n### {heading}\n\n{same}| key | takes | meaning |\n|---|---|---|");
    for key in &keys[first.map_or(0, |(_, other)| other.len())..] {
        let path = join(path, key.name);
        let (at, meaning) = meaning_of(&path);
        used[at] = true;
        let takes = others.iter().find_map(|other| probe::takes(&join(other, key.name)));
        let mut takes = takes.unwrap_or_else(|| UNREAD.to_owned());
        if !key.below.is_empty() {
            let first = all.iter().find(|(_, other)| names(other) == names(key.below));
            let first = first.map_or(path.as_str(), |(path, _)| path);
            let _ = write!(takes, "; keys of [`{first}`](#{})", first.replace('.', ""));
        }
        let _ = writeln!(page, "| `{}` | {} | {} |", key.name, takes.replace('|', "\\|"), meaning);
    }
}

/// A sentence about the tables at `others` that have the keys of the one at `path` and another name; empty if there are none.
fn same_keys(path: &str, others: &[&str]) -> String {
    let name = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
    let mut names: Vec<String> = Vec::new();
    for other in others.iter().map(|other| name(other)).filter(|other| *other != name(path)) {
        if !names.contains(&other) {
            names.push(other);
        }
    }
    match names.is_empty() {
        true => String::new(),
        false => format!("These are also the keys of `{}`.\n\n", names.join("`, `")),
    }
}

/// What the key at `path` means, and which of the meanings that is. Parameters mean in `[uncertain]` and `[identify]` what they do in `[vary]`.
fn meaning_of(path: &str) -> (usize, &'static str) {
    let find = |path: &str| MEANINGS.iter().position(|(pattern, _)| covers(pattern, path));
    let of_vary = || {
        let rest = ["uncertain.", "identify."].iter().find_map(|table| path.strip_prefix(table))?;
        find(&format!("vary.{rest}"))
    };
    let at = find(path).or_else(of_vary);
    let at = at.unwrap_or_else(|| panic!("no description of `{path}`: add one to scene/reference/meaning"));
    (at, MEANINGS[at].1)
}

/// Whether `pattern`, in which a star stands for any part, means the key `path`.
fn covers(pattern: &str, path: &str) -> bool {
    pattern.split('.').count() == path.split('.').count()
        && pattern.split('.').zip(path.split('.')).all(|(one, other)| one == "*" || one == other)
}

/// Every unit.
pub(crate) fn units() -> String {
    let row = |(name, units): (&str, &[Unit])| {
        let symbols: Vec<_> = units.iter().map(|unit| format!("`{}`", unit.symbol)).collect();
        format!("| {name} | {} |\n", symbols.join(", "))
    };
    format!("| quantity | units; a bare number is in the first one |\n|---|---|\n{}", QUANTITIES.map(row).concat())
}

/// Every distribution.
pub(crate) fn distributions() -> String {
    let row = |name: &str| {
        let known = DISTRIBUTIONS.iter().find(|(known, _)| *known == name);
        let (_, meaning) = known.unwrap_or_else(|| panic!("no description of the distribution {name}"));
        format!("| `{name}` | {meaning} |\n")
    };
    let rows: String = super::product::SHAPES.split(", ").map(row).collect();
    format!("| kind | what it is |\n|---|---|\n{rows}")
}
