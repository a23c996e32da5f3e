//! Writes what was decided as the text of a part.

use std::fmt::Write;

use super::{
    decide::Decided,
    entry::{DatumRef, Diameter, Entry},
    names,
};
use crate::{
    drawing::{Drawing, Material, Shape, Tolerance},
    words::one_line,
};

/// The text of the features, each with comments for what of it is not in the part.
pub fn features(drawing: &Drawing, decided: &Decided, part: &str, names: &[String]) -> String {
    let mut text = String::new();
    for &index in &decided.order {
        let feature = &drawing.features[index];
        let Ok(shape) = &feature.shape else { continue };
        let (table, keys) = place(shape);
        // Writing to a text cannot fail.
        let _ = writeln!(text, "\n[[part.{table}]]");
        let letters = drawing.datums.iter().filter(|datum| datum.features.contains(&index)).map(|datum| &datum.label);
        let letters: Vec<_> = letters.map(|label| format!(", datum {label}")).collect();
        let whose = format!("{} {}{}", feature.kind, feature.name, letters.concat());
        line(&mut text, &format!("name = {}", quoted(&names[index])), &whose);
        for (key, value) in keys {
            let _ = writeln!(text, "{key} = {value}");
        }
        size(&mut text, shape, &decided.entries[index]);
        let patterns = Patterns { drawing };
        for entry in &decided.entries[index] {
            let value = value(entry, part, names, &patterns);
            line(&mut text, &format!("{} = {value}", entry.key), &said(&drawing.tolerances[entry.tolerance]));
        }
        comments(&mut text, drawing, decided, index);
    }
    for (index, feature) in drawing.features.iter().enumerate() {
        let Err(reason) = &feature.shape else { continue };
        let _ = writeln!(
            text,
            "\n# not a feature of the part: {} {}: {}",
            feature.kind,
            one_line(&feature.name),
            one_line(reason)
        );
        comments(&mut text, drawing, decided, index);
    }
    text
}

/// The list of all tolerances that are not, or not for all of their features, in the part.
pub fn list(drawing: &Drawing, decided: &Decided) -> String {
    let refused = drawing.tolerances.iter().zip(&decided.refused).filter(|(_, reasons)| !reasons.is_empty());
    let refused: Vec<_> = refused.collect();
    let total = drawing.tolerances.len();
    let mut text = format!("\n# Not in the part: {} of {total} tolerances and dimensions of the file\n", refused.len());
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
        let _ = writeln!(text, "# {:3}. {}{some}: {reasons}", number + 1, said(tolerance));
    }
    for remark in &drawing.remarks {
        let _ = writeln!(text, "# {}", one_line(remark));
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
    let _ = writeln!(text, "{key} # {}", one_line(comment));
}

/// What of the feature with this index is not in the part.
fn comments(text: &mut String, drawing: &Drawing, decided: &Decided, index: usize) {
    for (tolerance, reasons) in drawing.tolerances.iter().zip(&decided.refused) {
        for (_, reason) in reasons.iter().filter(|(feature, _)| *feature == Some(index)) {
            let _ = writeln!(text, "# not in the part: {}: {}", said(tolerance), one_line(reason));
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

/// What is known of the size of a feature beside its tolerances.
fn size(text: &mut String, shape: &Shape, entries: &[Entry]) {
    let is_sized = entries.iter().any(|entry| entry.diameter.is_some());
    match shape {
        Shape::Plane(plane) => {
            if let Some(width) = plane.width {
                let _ = writeln!(text, "# the middle plane of two faces that are {width} mm apart");
            }
        }
        Shape::Axis(axis) => {
            let kind = axis.is_hole.map(|is_hole| if is_hole { "hole" } else { "pin" });
            match kind {
                Some(kind) if is_sized => {
                    let _ = writeln!(text, "kind = \"{kind}\"");
                }
                _ if is_sized => {}
                kind => {
                    let kind = kind.map(|kind| format!(" of a {kind}")).unwrap_or_default();
                    let _ = writeln!(
                        text,
                        "# diameter{kind} {} mm, without limits that the part could state",
                        axis.diameter
                    );
                }
            }
        }
        Shape::Point(_) => {}
    }
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
