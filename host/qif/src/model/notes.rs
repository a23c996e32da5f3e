//! Notes of a drawing.

use roxmltree::Node;

use crate::{
    words,
    xml::{child, children, path, text},
};

/// The notes of a drawing that say something (NoteSetType).
pub fn notes(root: Node) -> Vec<String> {
    let notes = path(root, &["Product", "NoteSet"]).into_iter().flat_map(children);
    let flagged = path(root, &["Product", "NoteFlagSet"]).into_iter().flat_map(children);
    let texts = notes.chain(flagged).filter_map(|note| child(note, "Text")).map(|note| words::one_line(text(note)));
    texts.filter(|text| !text.is_empty()).collect()
}
