//! Reading how the walls of a joint slope and bow.

use slipfit_tolerance::unit::{self, Quantity};

use crate::{
    mechanism::{Contour, JointKind},
    scene::{Problem, SceneError, tree::Value, value::Field},
};

pub(super) const SLOPE: Quantity = Quantity { units: unit::SLOPE, range: [-0.5, 0.5] };
const BOW: Quantity = Quantity { units: unit::LENGTH, range: [-1e3, 1e3] };
const OVER: Quantity = Quantity { units: unit::LENGTH, range: [0.1, 1e5] };

/// Reads the contours of the walls of a joint of this `kind` at the `table`; empty where all are straight and parallel.
pub(super) fn contours(table: &Field, kind: &JointKind) -> Result<Vec<Contour<f64>>, SceneError> {
    let stated = [table.get("slope"), table.get("bow")];
    let Some(first) = stated.iter().flatten().next() else { return Ok(Vec::new()) };
    let has_wall = match kind {
        JointKind::Guide { .. } => vec![true; 2],
        JointKind::Track { gaps } => gaps.iter().map(Option::is_some).collect(),
        _ => {
            let what = format!("`{}` of a joint of kind \"{}\"", first.key, kind.name());
            let allowed =
                "a track, or in a plane a prismatic joint with a clearance; a stop's normal may lean in a plane";
            return Err(first.error(Problem::Unsupported { what }, allowed));
        }
    };
    let [slope, bow] = &stated;
    let slopes =
        each(slope.as_ref(), &has_wall, "a number, or a list of one for each wall", &|field| field.to_number(&SLOPE))?;
    let curvatures = each(bow.as_ref(), &has_wall, BOWED, &curvature)?;
    let contour = |(slope, curvature): (f64, f64)| Contour { slope, curvature };
    let contours: Vec<_> = slopes.into_iter().zip(curvatures).map(contour).collect();
    let is_flat = contours.iter().all(|contour| contour.slope == 0.0 && contour.curvature == 0.0);
    Ok(if is_flat { Vec::new() } else { contours })
}

/// What a bow may be.
const BOWED: &str = "[height, over a length] in mm, or a list of such for each wall";

/// Curvature (1/m) of a wall that bows by a height in the middle of a length, towards the gap where that is positive.
fn curvature(field: &Field) -> Result<f64, SceneError> {
    let Value::List(nodes) = &field.node.value else { return Err(field.wrong_type(BOWED)) };
    let [height, over] = &nodes[..] else {
        return Err(field.error(Problem::Length { key: field.key.clone(), found: nodes.len() }, BOWED));
    };
    let number = |node, quantity| Field { key: field.key.clone(), node }.to_number(quantity);
    let (height, over): (f64, f64) = (number(height, &BOW)?, number(over, &OVER)?);
    Ok(-8.0 * height / (over * over))
}

/// What `read` makes of `field` for each wall: of the value itself for all that there are, or of those that are listed.
fn each(
    field: Option<&Field>,
    has_wall: &[bool],
    allowed: &str,
    read: &dyn Fn(&Field) -> Result<f64, SceneError>,
) -> Result<Vec<f64>, SceneError> {
    let Some(field) = field else { return Ok(vec![0.0; has_wall.len()]) };
    let listed = match &field.node.value {
        // The value itself may be a list, of two numbers.
        Value::List(nodes) if nodes.len() == has_wall.len() && nodes.iter().all(|node| is_one(node, allowed)) => nodes,
        Value::List(nodes) if !allowed.starts_with('[') => {
            let problem = Problem::Length { key: field.key.clone(), found: nodes.len() };
            return Err(field.error(problem, format!("a number, or a list of {}", has_wall.len())));
        }
        _ => {
            let value = read(field)?;
            return Ok(has_wall.iter().map(|is| if *is { value } else { 0.0 }).collect());
        }
    };
    let mut values = Vec::new();
    for (node, is_there) in listed.iter().zip(has_wall) {
        let field = Field { key: field.key.clone(), node };
        let value = read(&field)?;
        if !is_there && value != 0.0 {
            return Err(field.no_effect("where the track has no such wall", "0"));
        }
        values.push(value);
    }
    Ok(values)
}

/// Whether a node of a list is the value of one wall.
fn is_one(node: &crate::scene::tree::Node, allowed: &str) -> bool {
    matches!(node.value, Value::List(_)) == allowed.starts_with('[')
}
