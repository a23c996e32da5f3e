//! Places and directions.

use roxmltree::Node;

use crate::{
    error::{Problem, QifError},
    format::{rounded_direction, unit},
    units::Units,
    xml::{error_at, triple},
};

/// A place (PointType) in mm.
pub fn place(node: Node, units: &Units) -> Result<[f64; 3], QifError> {
    let scale = units.scale(node)?;
    Ok(triple(node)?.map(|x| x * scale))
}

/// A direction (UnitVectorType).
pub fn direction(node: Node) -> Result<[f64; 3], QifError> {
    let wrong = || error_at(node, Problem::Number(node.text().unwrap_or_default().chars().take(40).collect()));
    unit(triple(node)?).map(rounded_direction).ok_or_else(wrong)
}
