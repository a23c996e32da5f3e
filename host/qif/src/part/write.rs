//! Writes what was decided as the text of a part.

use std::fmt::Write;

use super::{
    decide::Decided,
    entry::{DatumRef, Diameter, Entry},
    names,
};
use crate::{
    drawing::{Drawing, Feature, Material, Plane, Shape, Tolerance},
    words::one_line,
};

/// What begins every comment of an import, by which an update knows what is its own.
pub const MARK: &str = "#|";

/// The text of the features, each with comments for what of it is not in the part.
pub fn features(drawing: &Drawing, decided: &Decided, part: &str, names: &[String]) -> String {
    let mut text = String::new();
    for &index in &decided.order {
        let feature = &drawing.features[index];
        let Ok(shape) = &feature.shape else { continue };
        let (table, keys) = place(shape);
        // Writing to a text cannot fail.
        let _ = writeln!(text, "\n[[part.{table}]]");
        size_comment(&mut text, shape, &decided.entries[index]);
        not_in_part(&mut text, drawing, decided, index);
        let letters = drawing.datums.iter().filter(|datum| datum.features.contains(&index)).map(|datum| &datum.label);
        let letters: Vec<_> = letters.map(|label| format!("{DATUM}{label}")).collect();
        let whose = format!("{}{}", in_file(feature), letters.concat());
        line(&mut text, &format!("name = {}", quoted(&names[index])), &whose);
        for (key, value) in keys {
            let _ = writeln!(text, "{key} = {value}");
        }
        if let Some(kind) = sized_kind(shape, &decided.entries[index]) {
            let _ = writeln!(text, "kind = \"{kind}\"");
        }
        let patterns = Patterns { drawing };
        for entry in &decided.entries[index] {
            let value = value(entry, part, names, &patterns);
            line(&mut text, &format!("{} = {value}", entry.key), &said(&drawing.tolerances[entry.tolerance]));
        }
    }
    text
}

/// What stands between the words of a feature and the letter of its datum.
pub const DATUM: &str = ", datum ";

/// A feature by its kind and name in the file.
pub fn in_file(feature: &Feature) -> String {
    one_line(&format!("{} {}", feature.kind, feature.name))
}

/// First line of what is left out of a part.
pub fn left_out_of(part: &str) -> String {
    format!("{MARK} Left out of the part {}:", quoted(part))
}

/// What is left out of the `part`: features that a part cannot have, and a list of all tolerances that are not, or not for all of their
/// features, in it.
pub fn left_out(drawing: &Drawing, decided: &Decided, part: &str) -> String {
    let refused = drawing.tolerances.iter().zip(&decided.refused).filter(|(_, reasons)| !reasons.is_empty());
    let refused: Vec<_> = refused.collect();
    let total = drawing.tolerances.len();
    let mut text = format!("{}\n", left_out_of(part));
    for (index, feature) in drawing.features.iter().enumerate() {
        let Err(reason) = &feature.shape else { continue };
        let _ = writeln!(text, "{MARK} not a feature of the part: {}: {}", in_file(feature), one_line(reason));
        not_in_part(&mut text, drawing, decided, index);
    }
    let _ = writeln!(text, "{MARK} {} of {total} tolerances and dimensions of the file", refused.len());
    for (number, (tolerance, reasons)) in refused.iter().enumerate() {
        let mut distinct: Vec<&str> = Vec::new();
        for (_, reason) in reasons.iter() {
            if !distinct.contains(&reason.as_str()) {
                distinct.push(reason);
            }
        }
        let count = tolerance.features.len();
        let some = if reasons.len() < count {
            format!(" for {} of its {count} features", reasons.len())
        } else {
            String::new()
        };
        let reasons = one_line(&distinct.join("; "));
        let _ = writeln!(text, "{MARK} {:3}. {}{some}: {reasons}", number + 1, said(tolerance));
    }
    for remark in &drawing.remarks {
        let _ = writeln!(text, "{MARK} {}", one_line(remark));
    }
    text
}

/// A tolerance by its name and in its words.
fn said(tolerance: &Tolerance) -> String {
    match tolerance.name.as_str() {
        "" => format!("[{}] {}", tolerance.id, tolerance.words),
        name => format!("{name} [{}] {}", tolerance.id, tolerance.words),
    }
}

fn line(text: &mut String, key: &str, comment: &str) {
    let _ = writeln!(text, "{key} {MARK} {}", one_line(comment));
}

/// What of the feature with this index is not in the part.
fn not_in_part(text: &mut String, drawing: &Drawing, decided: &Decided, index: usize) {
    for (tolerance, reasons) in drawing.tolerances.iter().zip(&decided.refused) {
        for (_, reason) in reasons.iter().filter(|(feature, _)| *feature == Some(index)) {
            let _ = writeln!(text, "{MARK} not in the part: {}: {}", said(tolerance), one_line(reason));
        }
    }
}

/// Kind of a feature in a part, and the keys that say where it is.
fn place(shape: &Shape) -> (&'static str, Vec<(&'static str, String)>) {
    match shape {
        Shape::Plane(plane) => {
            let [a, b] = plane.extents;
            let keys = vec![
                ("at", vector(plane.at)),
                ("normal", direction(plane.normal)),
                ("along", direction(plane.along)),
                ("extents", format!("[{a}, {b}]")),
            ];
            ("plane", keys)
        }
        Shape::Axis(axis) => {
            let length = axis.length.to_string();
            ("axis", vec![("at", vector(axis.at)), ("along", direction(axis.along)), ("length", length)])
        }
        Shape::Point(point) => ("point", vec![("at", vector(point.at)), ("normal", direction(point.normal))]),
    }
}

/// Whether an axis with a diameter in the part is a hole or a pin, where that is known.
fn sized_kind(shape: &Shape, entries: &[Entry]) -> Option<&'static str> {
    let Shape::Axis(axis) = shape else { return None };
    let is_hole = axis.is_hole.filter(|_| is_sized(entries))?;
    Some(if is_hole { "hole" } else { "pin" })
}

fn is_sized(entries: &[Entry]) -> bool {
    entries.iter().any(|entry| entry.diameter.is_some())
}

/// What is known of the size of a feature beside its tolerances.
fn size_comment(text: &mut String, shape: &Shape, entries: &[Entry]) {
    let _ = match shape {
        Shape::Plane(Plane { width: Some(width), .. }) => {
            writeln!(text, "{MARK} the middle plane of two faces that are {width} mm apart")
        }
        Shape::Axis(axis) if !is_sized(entries) => {
            let kind = axis.is_hole.map(|is_hole| if is_hole { " of a hole" } else { " of a pin" }).unwrap_or_default();
            writeln!(text, "{MARK} diameter{kind} {} mm, without limits that the part could state", axis.diameter)
        }
        _ => Ok(()),
    };
}

/// Names of patterns.
struct Patterns<'a> {
    drawing: &'a Drawing,
}

impl Patterns<'_> {
    /// The name of the pattern of a composite tolerance, which has the id of the tolerance, and so is no other's.
    fn name(&self, tolerance: usize) -> String {
        let Tolerance { name, id, .. } = &self.drawing.tolerances[tolerance];
        names::valid(&format!("{name} {id}"))
    }
}

/// The value of a tolerance's key.
fn value(entry: &Entry, part: &str, names: &[String], patterns: &Patterns) -> String {
    if let Some(Diameter { nominal, deviations: [lower, upper], class }) = &entry.diameter {
        return match class {
            Some(class) => format!("{{ value = {nominal}, tolerance = {} }}", quoted(class)),
            None => format!("{{ value = {nominal}, tolerance = [{lower}, {upper}] }}"),
        };
    }
    if entry.datums.is_empty() && entry.material == Material::None && entry.within.is_none() {
        return entry.width.to_string();
    }
    let mut keys = vec![format!("zone = {}", entry.width)];
    match entry.material {
        Material::None => {}
        Material::Maximum => keys.push("material = \"maximum\"".into()),
        Material::Least => keys.push("material = \"least\"".into()),
    }
    let datums: Vec<_> = entry.datums.iter().map(|datum| reference(datum, part, names)).collect();
    if !datums.is_empty() {
        keys.push(format!("datum = [{}]", datums.join(", ")));
    }
    if let Some((width, count)) = entry.within {
        keys.push(format!("within = {width}"));
        if count > 0 {
            keys.push(format!("within_datum = [{}]", datums[..count].join(", ")));
        }
        keys.push(format!("pattern = {}", quoted(&patterns.name(entry.tolerance))));
    }
    format!("{{ {} }}", keys.join(", "))
}

fn reference(datum: &DatumRef, part: &str, names: &[String]) -> String {
    let features: Vec<_> = datum.features.iter().map(|feature| format!("{part}.{}", names[*feature])).collect();
    let condition = match datum.material {
        Material::None => "",
        Material::Maximum => " (M)",
        Material::Least => " (L)",
    };
    quoted(&format!("{}{condition}", features.join("-")))
}

fn vector([x, y, z]: [f64; 3]) -> String {
    format!("[{x}, {y}, {z}]")
}

/// A unit vector, by the name of its axis where it has one.
fn direction(vector: [f64; 3]) -> String {
    let axes = ["x", "y", "z"];
    let along = (0..3).find(|i| vector[*i].abs() == 1.0 && (0..3).all(|j| j == *i || vector[j] == 0.0));
    match along {
        Some(i) => format!("\"{}{}\"", if vector[i] > 0.0 { '+' } else { '-' }, axes[i]),
        None => self::vector(vector),
    }
}

/// A text of TOML. Names have no quotes, backslashes or control characters.
pub fn quoted(text: &str) -> String {
    format!("\"{text}\"")
}
