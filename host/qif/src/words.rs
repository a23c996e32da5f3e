//! A tolerance in the words of its file.

use std::collections::HashMap;

use roxmltree::Node;

use crate::xml::{child, children, name, path, text};

/// Symbols that texts of a drawing name in braces.
const SYMBOLS: [(&str, &str); 26] = [
    ("POSITION", "⌖"),
    ("FLATNESS", "⏥"),
    ("STRAIGHTNESS", "⏤"),
    ("CIRCULARITY", "○"),
    ("CYLINDRICITY", "⌭"),
    ("PARALLELISM", "∥"),
    ("PERPENDICULARITY", "⟂"),
    ("ANGULARITY", "∠"),
    ("PROFILE_SURFACE", "⌓"),
    ("PROFILE_LINE", "⌒"),
    ("CONCENTRICITY", "◎"),
    ("SYMMETRY", "⌯"),
    ("CIRCULAR_RUNOUT", "↗"),
    ("TOTAL_RUNOUT", "⌰"),
    ("DIAMETER_SPHERICAL", "S⌀"),
    ("DIAMETER", "⌀"),
    ("PLUS_MINUS", "±"),
    ("DEGREE", "°"),
    ("BR", " / "),
    ("M", "Ⓜ"),
    ("L", "Ⓛ"),
    ("P", "Ⓟ"),
    ("T", "Ⓣ"),
    ("F", "Ⓕ"),
    ("U", "Ⓤ"),
    ("ST", "⟨ST⟩"),
];

/// Longest text that is kept, in characters.
const LONGEST: usize = 400;

/// The texts that the drawing shows, by the id of what they belong to (PMIDisplayType).
pub fn displayed<'a>(document: Node<'a, '_>) -> HashMap<&'a str, String> {
    let displays = path(document, &["Product", "VisualizationSet", "PMIDisplaySet"]);
    let mut found: HashMap<&str, String> = HashMap::new();
    for display in displays.into_iter().flat_map(children) {
        let Some(id) = path(display, &["Reference", "Id"]).map(text) else { continue };
        let texts = child(display, "Texts").into_iter().flat_map(children);
        let texts = texts.filter_map(|line| child(line, "Data")).map(|data| symbols(text(data)));
        let shown: Vec<_> = texts.filter(|text| !text.is_empty()).collect();
        if !shown.is_empty() {
            let all = found.entry(id).or_default();
            if !all.is_empty() {
                all.push_str("; ");
            }
            all.push_str(&shown.join(" "));
        }
    }
    found
}

/// `text` with symbols for what it names in braces.
fn symbols(text: &str) -> String {
    let mut text = text.to_owned();
    for (token, symbol) in SYMBOLS {
        text = text.replace(&format!("{{{token}}}"), symbol);
    }
    one_line(&text)
}

/// `text` in one line of limited length, without characters that a comment cannot hold.
pub fn one_line(text: &str) -> String {
    let printable = |c: char| if c.is_control() { ' ' } else { c };
    let line: String = text.chars().map(printable).collect();
    let line = line.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line,
    }
}

/// The elements of a characteristic that hold values, such as `ToleranceValue 0.1 mm`; its `hidden` ones left out.
pub fn values(node: Node, hidden: &[&str]) -> String {
    let mut words = Vec::new();
    collect(node, hidden, &mut words);
    one_line(&words.join(", "))
}

fn collect(node: Node, hidden: &[&str], words: &mut Vec<String>) {
    for element in children(node).filter(|element| !hidden.contains(&name(*element))) {
        // A longer text would be cut anyway.
        if words.len() > LONGEST {
            return;
        }
        if children(element).next().is_some() {
            collect(element, hidden, words);
            continue;
        }
        let unit = element.attribute("linearUnit").or(element.attribute("angularUnit"));
        let parts = [name(element), text(element), unit.unwrap_or_default()];
        words.push(parts.iter().filter(|part| !part.is_empty()).copied().collect::<Vec<_>>().join(" "));
    }
}

/// `PerpendicularityCharacteristicDefinition` as `Perpendicularity`.
pub fn kind(element: &str) -> &str {
    let end = ["Characteristic", "Feature"].iter().filter_map(|word| element.rfind(word)).max();
    end.filter(|end| *end > 0).map_or(element, |end| &element[..end])
}

#[cfg(test)]
mod tests {
    use super::{kind, one_line, symbols};

    #[test]
    fn texts_are_shown_as_on_the_drawing() {
        assert_eq!(symbols("{DIAMETER}0.050{M}"), "⌀0.050Ⓜ");
        assert_eq!(symbols("+0.2{BR}  0"), "+0.2 / 0");
        assert_eq!(one_line("a\n\u{7}b"), "a b");
        assert_eq!(one_line(&"é".repeat(500)).chars().count(), 401);
        assert_eq!(kind("CylinderFeatureNominal"), "Cylinder");
        assert_eq!(kind("Feature"), "Feature");
    }
}
