//! Features of a QIF model (FeatureNominalType, FeatureDefinitionType).

use std::collections::HashMap;

use roxmltree::Node;

use super::{
    face,
    place::{direction, place},
};
use crate::{
    drawing::{Axis, Feature, Plane, Point, Shape},
    error::{Problem, QifError},
    format::{dot, plus, rounded, rounded_direction, unit},
    units::Units,
    words,
    xml::{child, children, error_at, name, numbers, require, text_of},
};

/// Elements by their id.
pub type ById<'a, 'i> = HashMap<&'a str, Node<'a, 'i>>;

/// The child elements of a list by their id.
pub fn by_id<'a, 'i>(list: Option<Node<'a, 'i>>) -> ById<'a, 'i> {
    list.into_iter().flat_map(children).filter_map(|node| Some((node.attribute("id")?, node))).collect()
}

/// Reads a `…FeatureNominal`.
pub fn feature(node: Node, definitions: &ById, units: &Units) -> Result<Feature, QifError> {
    let id = node.attribute("id").unwrap_or_default().to_owned();
    let named = text_of(node, "Name").map(words::one_line);
    let kind = words::kind(name(node)).to_owned();
    let definition = text_of(node, "FeatureDefinitionId").map(|id| {
        let found = definitions.get(id).copied();
        let problem = || Problem::Reference { element: name(node).to_owned(), id: id.to_owned() };
        found.ok_or_else(|| error_at(node, problem()))
    });
    let definition = definition.transpose()?;
    let shape = match name(node) {
        "PlaneFeatureNominal" => plane(node, units),
        "CylinderFeatureNominal" => cylinder(node, definition, units),
        "OppositeParallelPlanesFeatureNominal" => slot(node, definition, units),
        "PointFeatureNominal" => point(node, units),
        _ => Ok(Err(format!("a feature of the kind {kind}, which a part of a scene does not have"))),
    };
    // A feature that the file describes by other means than these has no shape here, and is no error.
    let shape = match shape {
        Err(QifError { problem: Problem::Missing { element, missing: what }, .. }) => {
            missing(&format!("{what} in {element}"))?
        }
        shape => shape?,
    };
    Ok(Feature { name: named.unwrap_or_else(|| format!("{kind} {id}")), id, kind, shape })
}

/// What is read of a feature: its shape, or why it has none here.
type Found = Result<Result<Shape, String>, QifError>;

fn missing(what: &str) -> Found {
    Ok(Err(format!("the file states no {what} of it")))
}

/// PlaneFeatureNominalType. Its Location is any point on the plane, so the middle is that of the boundary.
fn plane(node: Node, units: &Units) -> Found {
    let normal = direction(require(node, "Normal")?)?;
    let location = place(require(node, "Location")?, units)?;
    let boundary = face::boundary(node, units)?;
    let Some(rectangle) = boundary.and_then(|points| face::rectangle(&points, normal)) else {
        return missing("boundary");
    };
    // The boundary is in the plane, but may be stated with less accuracy than the location.
    let off = dot(rectangle.middle, normal) - dot(location, normal);
    if off.abs() > 1e-3 * (1.0 + rectangle.extents[0].max(rectangle.extents[1])) {
        return Ok(Err("its boundary does not lie in its plane".into()));
    }
    let at = plus(rectangle.middle, -off, normal).map(rounded);
    Ok(Ok(Shape::Plane(Plane { at, normal, along: rectangle.along, extents: rectangle.extents, width: None })))
}

/// CylinderFeatureNominalType. Its axis runs from AxisPoint over Length in Direction.
fn cylinder(node: Node, definition: Option<Node>, units: &Units) -> Found {
    let axis = require(node, "Axis")?;
    let start = place(require(axis, "AxisPoint")?, units)?;
    let along = direction(require(axis, "Direction")?)?;
    let Some(definition) = definition else { return missing("diameter") };
    let diameter = rounded(units.length(require(definition, "Diameter")?)?);
    let Some(length) = child(definition, "Length").map(|length| units.length(length)).transpose()? else {
        return missing("length");
    };
    let length = rounded(length);
    if !(length > 0.0 && diameter > 0.0) {
        return missing("length and diameter above 0");
    }
    // A feature of size holds its axis if it goes around more than half.
    if let Some(sweep) = child(node, "Sweep").and_then(|sweep| child(sweep, "DomainAngle")) {
        let swept = numbers(sweep)?;
        if let [from, to] = swept[..]
            && (to - from).abs() <= std::f64::consts::PI
        {
            return Ok(Err("it is half a cylinder or less".into()));
        }
    }
    let is_hole = is_internal(definition);
    let at = plus(start, 0.5 * length, along).map(rounded);
    Ok(Ok(Shape::Axis(Axis { at, along, length, diameter, is_hole })))
}

/// OppositeParallelPlanesFeatureNominalType: its middle plane, by CenterPlane, Length and Depth.
fn slot(node: Node, definition: Option<Node>, units: &Units) -> Found {
    let middle = require(node, "CenterPlane")?;
    let at = place(require(middle, "Point")?, units)?.map(rounded);
    let normal = direction(require(middle, "Normal")?)?;
    let Some(definition) = definition else { return missing("width") };
    let width = rounded(units.length(require(definition, "Width")?)?);
    let size = |of: &str| child(definition, of).map(|node| units.length(node)).transpose();
    let (Some(length), Some(depth)) = (size("Length")?, size("Depth")?) else { return missing("length and depth") };
    let Some(along) = child(node, "LengthVector").map(direction).transpose()? else {
        return missing("direction of its length");
    };
    if length <= 0.0 || depth <= 0.0 || width <= 0.0 {
        return missing("length, depth and width above 0");
    }
    // A length vector that leans out of the plane by rounding is brought back.
    let Some(along) = unit(plus(along, -dot(along, normal), normal)).map(rounded_direction) else {
        return missing("direction of its length in its middle plane");
    };
    let extents = [length, depth].map(rounded);
    Ok(Ok(Shape::Plane(Plane { at, normal, along, extents, width: Some(width) })))
}

/// PointFeatureNominalType.
fn point(node: Node, units: &Units) -> Found {
    let at = place(require(node, "Location")?, units)?.map(rounded);
    match child(node, "Normal") {
        Some(normal) => Ok(Ok(Shape::Point(Point { at, normal: direction(normal)? }))),
        None => missing("normal"),
    }
}

/// Whether a feature is internal (InternalExternalEnumType).
fn is_internal(definition: Node) -> Option<bool> {
    match text_of(definition, "InternalExternal") {
        Some("INTERNAL") => Some(true),
        Some("EXTERNAL") => Some(false),
        _ => None,
    }
}
