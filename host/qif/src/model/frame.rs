//! Datums and datum reference frames of a QIF model (DatumDefinitionType, DatumReferenceFrameType).

use std::collections::HashMap;

use roxmltree::Node;

use crate::{
    drawing::{Datum, Material, Reference},
    error::{Problem, QifError},
    words,
    xml::{child, children, error_at, ids, name, require, text, text_of},
};

/// A frame: its datums, or why it is not understood.
pub type Frame = Result<Vec<Reference>, String>;

/// Reads the datums of a document; `features` are indices by their id.
pub fn datums(document: Node, features: &HashMap<&str, usize>) -> Result<Vec<Datum>, QifError> {
    let list = child(document, "DatumDefinitions").into_iter().flat_map(children);
    let read = |node: Node| {
        let index = |id: &&str| {
            let problem = || Problem::Reference { element: name(node).to_owned(), id: (*id).to_owned() };
            features.get(id).copied().ok_or_else(|| error_at(node, problem()))
        };
        Ok(Datum {
            id: node.attribute("id").unwrap_or_default().to_owned(),
            label: words::one_line(text_of(node, "DatumLabel").unwrap_or_default()),
            features: ids(node, "FeatureNominalIds").iter().map(index).collect::<Result<_, QifError>>()?,
            targets: ids(node, "DatumTargetIds").len(),
        })
    };
    list.map(read).collect()
}

/// Reads the frames of a document by their id.
pub fn frames<'a>(document: Node<'a, '_>, datums: &[Datum]) -> Result<HashMap<&'a str, Frame>, QifError> {
    let index: HashMap<_, _> = datums.iter().enumerate().map(|(i, datum)| (datum.id.as_str(), i)).collect();
    let list = child(document, "DatumReferenceFrames").into_iter().flat_map(children);
    list.map(|node| Ok((node.attribute("id").unwrap_or_default(), frame(node, &index)?))).collect()
}

fn frame(node: Node, datums: &HashMap<&str, usize>) -> Result<Frame, QifError> {
    let mut found: Vec<(usize, Reference)> = Vec::new();
    for datum in child(node, "Datums").into_iter().flat_map(children) {
        let precedence = child(datum, "Precedence").and_then(|node| text_of(node, "PrecedenceEnum"));
        let rank = match precedence {
            Some("PRIMARY") => 0,
            Some("SECONDARY") => 1,
            Some("TERTIARY") => 2,
            _ => return Ok(Err("a datum that is neither primary, secondary nor tertiary".into())),
        };
        let read = match (child(datum, "SimpleDatum"), child(datum, "CompoundDatum")) {
            (Some(simple), _) => reference(simple, datums)?,
            (None, Some(compound)) => common(compound, datums)?,
            (None, None) => Err("a datum that is a measured or nominal feature".into()),
        };
        match read {
            Ok(reference) => found.push((rank, reference)),
            Err(reason) => return Ok(Err(reason)),
        }
    }
    found.sort_by_key(|(rank, _)| *rank);
    if found.iter().enumerate().any(|(i, (rank, _))| i != *rank) {
        return Ok(Err("a frame whose datums are not one primary, one secondary and one tertiary".into()));
    }
    Ok(Ok(found.into_iter().map(|(_, reference)| reference).collect()))
}

/// Reads a SimpleDatum (DatumType).
fn reference(node: Node, datums: &HashMap<&str, usize>) -> Result<Result<Reference, String>, QifError> {
    let id = text(require(node, "DatumDefinitionId")?);
    let problem = || Problem::Reference { element: name(node).to_owned(), id: id.to_owned() };
    let datum = *datums.get(id).ok_or_else(|| error_at(node, problem()))?;
    for element in children(node) {
        match name(element) {
            // The size that a condition of material refers to does not matter where the datum has only one.
            "DatumDefinitionId"
            | "MaterialModifier"
            | "ReferencedComponent"
            | "SizeCharacteristicDefinitionId"
            | "Attributes" => {}
            _ if text(element) == "false" => {}
            other => return Ok(Err(format!("a datum with {other}"))),
        }
    }
    Ok(material(text_of(node, "MaterialModifier")).map(|material| Reference { datums: vec![datum], material }))
}

/// Reads a CompoundDatum: a common datum of two.
fn common(node: Node, datums: &HashMap<&str, usize>) -> Result<Result<Reference, String>, QifError> {
    let mut all = Vec::new();
    for datum in children(node) {
        let Some(simple) = child(datum, "SimpleDatum").filter(|_| name(datum) == "Datum") else {
            return Ok(Err(format!("a common datum with {}", name(datum))));
        };
        match reference(simple, datums)? {
            Ok(Reference { datums, material: Material::None }) => all.extend(datums),
            Ok(_) => return Ok(Err("a common datum at a condition of material".into())),
            Err(reason) => return Ok(Err(reason)),
        }
    }
    Ok(Ok(Reference { datums: all, material: Material::None }))
}

/// A condition of material (MaterialModifierEnumType).
pub fn material(text: Option<&str>) -> Result<Material, String> {
    match text {
        None | Some("NONE" | "REGARDLESS") => Ok(Material::None),
        Some("MAXIMUM") => Ok(Material::Maximum),
        Some("LEAST") => Ok(Material::Least),
        Some(other) => Err(format!("the condition of material {}", words::one_line(other))),
    }
}
