//! Reads the product model of a QIF document (QIFDocumentType).

mod face;
mod frame;
mod notes;
mod place;
mod shape;
mod tolerance;

use std::collections::HashMap;

use roxmltree::Node;

use crate::{
    drawing::{Drawing, Feature},
    error::{Problem, QifError},
    units::Units,
    words,
    xml::{self, child, children, error_at, ids, path, text_of},
};

/// Reads the features, datums and tolerances of the part in a QIF 3.0 product model.
///
/// # Errors
/// Text that is not QIF, values that are no numbers, references that lead nowhere, features of several parts. What the file
/// states well but has no counterpart here is no error: it comes back as [`crate::drawing::Limits::NotRead`] and the like.
pub fn read(text: &str) -> Result<Drawing, QifError> {
    let document = xml::parse(text)?;
    let root = document.root_element();
    if xml::name(root) != "QIFDocument" {
        return Err(error_at(root, Problem::Root(words::one_line(xml::name(root)))));
    }
    let units = Units::read(root)?;
    let part = part(root)?;
    let features = features(root, part, &units)?;
    let index: HashMap<&str, usize> =
        features.iter().enumerate().map(|(i, feature)| (feature.id.as_str(), i)).collect();
    let datums = frame::datums(root, &index)?;
    let frames = frame::frames(root, &datums)?;
    let (tolerances, remarks) = tolerance::tolerances(root, &units, &index, &datums, &frames)?;
    if features.is_empty() && tolerances.is_empty() {
        return Err(error_at(root, Problem::Nothing("features and tolerances")));
    }
    drop(index);
    Ok(Drawing { name: part_name(part), features, datums, tolerances, remarks })
}

/// The part that has the features; `None` if the file names no part.
fn part<'a, 'i>(root: Node<'a, 'i>) -> Result<Option<Node<'a, 'i>>, QifError> {
    let set = path(root, &["Product", "PartSet"]);
    let parts: Vec<_> = set.into_iter().flat_map(children).collect();
    let with_features: Vec<_> =
        parts.iter().copied().filter(|part| child(*part, "FeatureNominalIds").is_some()).collect();
    match with_features[..] {
        [_, second, ..] => Err(error_at(second, Problem::Parts(with_features.len()))),
        [only] => Ok(Some(only)),
        [] => Ok(parts.first().copied()),
    }
}

fn part_name(part: Option<Node>) -> String {
    let named = part.and_then(|part| {
        let label = part.attribute("label").filter(|label| !label.trim().is_empty());
        text_of(part, "Name").or(label).or(text_of(part, "ModelNumber"))
    });
    words::one_line(named.unwrap_or("part"))
}

/// The features of the part, or all of the file where the part lists none.
fn features(root: Node, part: Option<Node>, units: &Units) -> Result<Vec<Feature>, QifError> {
    let definitions = shape::by_id(path(root, &["Features", "FeatureDefinitions"]));
    let nominals = path(root, &["Features", "FeatureNominals"]);
    let mut features = nominals.into_iter().flat_map(children).map(|node| shape::feature(node, &definitions, units));
    let features = features.by_ref().collect::<Result<Vec<_>, _>>()?;
    // Parts of several frames are refused above, so that a feature that no part lists can only be this one's.
    if let Some(part) = part {
        for id in ids(part, "FeatureNominalIds") {
            if !features.iter().any(|feature| feature.id == id) {
                let problem = Problem::Reference { element: "FeatureNominalIds".into(), id: words::one_line(id) };
                return Err(error_at(part, problem));
            }
        }
    }
    Ok(features)
}
