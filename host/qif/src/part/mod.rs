//! From features with tolerances to the text of a `[[part]]`.
//!
//! What a part of a scene can state is stated; everything else stands as a comment with its feature, in the words of the file and
//! with the reason, and again in a counted list at the end. Nothing is guessed: of two readings neither is taken.

mod decide;
mod entry;
mod geometry;
mod names;
mod rules;
mod write;

use crate::{drawing::Drawing, words::one_line};

/// A part as text.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name in the scene.
    pub name: String,
    /// The `[[part]]` with its features and comments.
    pub text: String,
    /// The tolerances and dimensions left out of the part, as comments.
    pub list: String,
    /// A measure between two features as an example, without which a scene of the part alone has nothing to compute; empty for
    /// a part of less than two features.
    pub example: String,
    /// For each tolerance of the drawing the features, by name, in which the part states it, and the key.
    pub stated: Vec<Stated>,
}

/// Where a part states a tolerance of the drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Stated {
    /// Id of the tolerance in the file.
    pub id: String,
    /// Names of the features in which the part states it.
    pub features: Vec<String>,
    /// Reasons why the part does not state it, each once; empty if it states it for all features.
    pub refused: Vec<String>,
}

impl Part {
    /// The whole text of a file that holds the part alone.
    pub fn file(&self) -> String {
        format!("{}{}{}", self.text, self.list, self.example)
    }
}

/// Writes a `drawing` as a part called `name`, or as the file names it; `source` is named in the first comment.
pub fn write(drawing: &Drawing, name: Option<&str>, source: &str) -> Part {
    let part = names::valid(name.unwrap_or(&drawing.name));
    let features = names::features(drawing);
    let decided = decide::decide(drawing);
    let head = format!(
        "# From {}. Lengths in mm, in the frame of the part.\n[[part]]\nname = {} # {}\n",
        one_line(source),
        write::quoted(&part),
        one_line(&drawing.name)
    );
    let text = head + &write::features(drawing, &decided, &part, &features);
    let stated = drawing.tolerances.iter().enumerate().map(|(i, tolerance)| {
        let has = |feature: &&usize| decided.entries[**feature].iter().any(|entry| entry.tolerance == i);
        let mut refused: Vec<String> = decided.refused[i].iter().map(|(_, reason)| reason.clone()).collect();
        refused.sort();
        refused.dedup();
        Stated {
            id: tolerance.id.clone(),
            features: tolerance.features.iter().filter(has).map(|feature| features[*feature].clone()).collect(),
            refused,
        }
    });
    let stated = stated.collect();
    let example = match decided.order[..] {
        [one, two, ..] => format!(
            "\n# An example of a measure; mates, measures and limits of the product are yours to state.\n[[measure]]\nname = \
             \"example\"\ndistance = [{}, {}]\n",
            write::quoted(&format!("{part}.{}", features[one])),
            write::quoted(&format!("{part}.{}", features[two]))
        ),
        _ => String::new(),
    };
    Part { list: write::list(drawing, &decided), name: part, text, example, stated }
}
