//! What a scene needs beside a part, with the names of its features.

use super::write::quoted;
use crate::drawing::{Drawing, Shape};

/// A mate of the part as comments, its datums first, and a measure between two of its features; empty for a part of less than two
/// features. `order` has the features of the part.
pub fn skeleton(drawing: &Drawing, order: &[usize], part: &str, names: &[String]) -> String {
    let mut datums: Vec<_> = drawing.datums.iter().filter(|datum| !datum.label.is_empty()).collect();
    datums.sort_by_key(|datum| (datum.label.chars().count(), &datum.label));
    let mut features: Vec<usize> = Vec::new();
    let all = datums.iter().flat_map(|datum| &datum.features).filter(|feature| order.contains(feature)).chain(order);
    for feature in all {
        if !features.contains(feature) {
            features.push(*feature);
        }
    }
    let [one, two, ..] = features[..] else { return String::new() };
    let name = |feature: usize| quoted(&format!("{part}.{}", names[feature]));
    let other = |feature: &usize| match drawing.features[*feature].shape {
        Ok(Shape::Axis(_)) => "other.axis",
        Ok(Shape::Point(_)) => "other.point",
        _ => "other.face",
    };
    let contacts: Vec<_> =
        features.iter().take(3).map(|feature| format!("[{}, \"{}\"]", name(*feature), other(feature))).collect();
    format!(
        "\n# Mates, measures and limits are yours to state. In a scene of several parts each but the first has a mate, such as\n# \
         [[mate]]\n# part = {}\n# contacts = [{}]\n\n# An example of a measure.\n[[measure]]\nname = \"example\"\ndistance = [{}, \
         {}]\n",
        quoted(part),
        contacts.join(", "),
        name(one),
        name(two)
    )
}
