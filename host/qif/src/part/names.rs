//! Names that a scene accepts.

use std::collections::HashSet;

use crate::drawing::Drawing;

/// Names of the features of a drawing, each one valid and without a second. A datum has its letter, as on the drawing.
pub fn features(drawing: &Drawing) -> Vec<String> {
    let mut taken = HashSet::new();
    let mut names = vec![String::new(); drawing.features.len()];
    for datum in &drawing.datums {
        if let ([feature], false) = (&datum.features[..], datum.label.is_empty())
            && names[*feature].is_empty()
        {
            names[*feature] = unique(&valid(&datum.label), &mut taken);
        }
    }
    for (name, feature) in names.iter_mut().zip(&drawing.features) {
        if name.is_empty() {
            *name = unique(&valid(&feature.name), &mut taken);
        }
    }
    names
}

/// `name` with underscores for what means something in a scene: dots and quotes, parentheses and circled letters that would be
/// conditions of material.
pub fn valid(name: &str) -> String {
    let is_free = |c: char| {
        let is_circled = ('\u{2460}'..='\u{24ff}').contains(&c);
        c.is_alphanumeric() && !is_circled || " _-+#/".contains(c)
    };
    let name: String = name.trim().chars().take(60).map(|c| if is_free(c) { c } else { '_' }).collect();
    match name.trim() {
        "" => "unnamed".to_owned(),
        name => name.to_owned(),
    }
}

/// `name`, or `name 2` and so on if it is taken.
pub fn unique(name: &str, taken: &mut HashSet<String>) -> String {
    let numbered = (2..).map(|number| format!("{name} {number}"));
    let free = std::iter::once(name.to_owned()).chain(numbered).find(|name| !taken.contains(name));
    let free = free.unwrap_or_else(|| name.to_owned());
    taken.insert(free.clone());
    free
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::{unique, valid};

    #[test]
    fn names_are_valid_and_unique() {
        assert_eq!(valid("bore (M)"), "bore _M_");
        assert_eq!(valid("it's \"1.5\" Ⓜ\n"), "it_s _1_5_ _");
        assert_eq!(valid("  "), "unnamed");
        let mut taken = HashSet::new();
        let found = ["a", "a", "a 2", "a"].map(|name| unique(name, &mut taken));
        assert_eq!(found, ["a", "a 2", "a 2 2", "a 3"]);
    }
}
