//! From features with tolerances to the text of a `[[part]]`.
//!
//! What a part of a scene can state is stated; everything else stands as a comment with its feature, in the words of the file and
//! with the reason, and again in a counted list at the end. Nothing is guessed: of two readings neither is taken.

mod decide;
mod entry;
mod geometry;
mod merge;
mod names;
mod positions;
mod rules;
mod skeleton;
pub mod update;
mod write;

use crate::{drawing::Drawing, words::one_line};

/// A part as text.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name in the scene.
    pub name: String,
    /// The `[[part]]` and its name.
    pub head: String,
    /// Its features, with comments for what of them is not in the part.
    pub text: String,
    /// What is left out of the part, as comments.
    pub left_out: String,
    /// What the user states beside the part: mates as comments, and a measure between two features as an example, without which a scene
    /// of the part alone has nothing to compute.
    pub skeleton: String,
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
        let Self { head, text, left_out, skeleton, .. } = self;
        format!("{head}{text}\n{left_out}{skeleton}")
    }

    /// How many tolerances and dimensions of the drawing are not, or not for all of their features, in the part.
    pub fn listed(&self) -> usize {
        self.stated.iter().filter(|stated| !stated.refused.is_empty()).count()
    }
}

/// Writes a `drawing` as a part called `name`, or as the file names it; `source` is named in the first comment.
pub fn write(drawing: &Drawing, name: Option<&str>, source: &str) -> Part {
    let name = names::valid(name.unwrap_or(&drawing.name));
    part_of(drawing, &name, source, names::features(drawing))
}

/// A `drawing` as the part `name`, whose features have these names.
fn part_of(drawing: &Drawing, name: &str, source: &str, features: Vec<String>) -> Part {
    let decided = decide::decide(drawing);
    let mark = write::MARK;
    let head = format!(
        "{mark} From {}. Lengths in mm, in the frame of the part.\n[[part]]\nname = {} {mark} {}\n",
        one_line(source),
        write::quoted(name),
        one_line(&drawing.name)
    );
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
    Part {
        stated: stated.collect(),
        text: write::features(drawing, &decided, name, &features),
        left_out: write::left_out(drawing, &decided, name),
        skeleton: skeleton::skeleton(drawing, &decided.order, name, &features),
        name: name.to_owned(),
        head,
    }
}
