//! Reading how the walls of a joint slope and bow.

use slipfit_tolerance::unit::{self, Quantity};

use crate::{
    mechanism::{Contour, JointKind},
    scene::{
        Problem, SceneError,
        tree::Value,
        value::{Field, OneOrEach},
    },
};

pub(super) const SLOPE: Quantity = Quantity { units: unit::SLOPE, range: [-0.5, 0.5] };
const BOW: Quantity = Quantity { units: unit::LENGTH, range: [-1e3, 1e3] };
const OVER: Quantity = Quantity { units: unit::LENGTH, range: [0.1, 1e5] };

/// Reads the contours of the walls of a joint of this `kind` at the `table`; empty where all are straight and parallel.
pub(super) fn contours(table: &Field, kind: &JointKind) -> Result<Vec<Contour<f64>>, SceneError> {
    match kind {
        JointKind::Guide { .. } => of_walls(table, [true; 2]),
        JointKind::Track { gaps } => of_walls(table, gaps.map(|gap| gap.is_some())),
        _ => match ["slope", "bow"].iter().find_map(|key| table.get(key)) {
            None => Ok(Vec::new()),
            Some(field) => {
                let what = format!("`{}` of a joint of kind \"{}\"", field.key, kind.name());
                let allowed =
                    "a track, or in a plane a prismatic joint with a clearance; a stop's normal may lean in a plane";
                Err(field.error(Problem::Unsupported { what }, allowed))
            }
        },
    }
}

/// Those of `N` walls, of which some may not be there.
fn of_walls<const N: usize>(table: &Field, is_there: [bool; N]) -> Result<Vec<Contour<f64>>, SceneError> {
    let slope = table.get("slope").map(|field| field.one_or_each(&SLOPE).map(|values| (field, values))).transpose()?;
    let bow = table.get("bow").map(|field| bows(&field).map(|values| (field, values))).transpose()?;
    let spread = |stated: Option<(Field, OneOrEach<N>)>| -> Result<[f64; N], SceneError> {
        let Some((field, values)) = stated else { return Ok([0.0; N]) };
        match values {
            OneOrEach::One(one) => Ok(is_there.map(|is| if is { one } else { 0.0 })),
            OneOrEach::Each(each) if each.iter().zip(is_there).any(|(value, is)| *value != 0.0 && !is) => {
                Err(field.no_effect("where the track has no such wall", "0 there"))
            }
            OneOrEach::Each(each) => Ok(each),
        }
    };
    let contours = spread(slope)?.into_iter().zip(spread(bow)?);
    let contours: Vec<_> = contours.map(|(slope, curvature)| Contour { slope, curvature }).collect();
    let is_flat = contours.iter().all(|contour| contour.slope == 0.0 && contour.curvature == 0.0);
    Ok(if is_flat { Vec::new() } else { contours })
}

/// What a bow may be.
const BOWED: &str = "[height, over a length] in mm, or a list of such for each wall";

/// Curvatures (1/m) of walls that bow: one pair for all, or a list of a pair for each.
fn bows<const N: usize>(field: &Field) -> Result<OneOrEach<N>, SceneError> {
    let Value::List(nodes) = &field.node.value else { return Err(field.wrong_type(BOWED)) };
    if !nodes.iter().all(|node| matches!(node.value, Value::List(_))) {
        return curvature(field).map(OneOrEach::One);
    }
    if nodes.len() != N {
        let problem = Problem::Length { key: field.key.clone(), found: nodes.len() };
        return Err(field.error(problem, format!("[height, over a length] in mm, or a list of {N} such")));
    }
    let mut each = [0.0; N];
    for (value, node) in each.iter_mut().zip(nodes) {
        *value = curvature(&Field { key: field.key.clone(), node })?;
    }
    Ok(OneOrEach::Each(each))
}

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
