//! Reading how the walls of a joint run: how they slope and bow, or the gaps at other places.

use slipfit_tolerance::{
    number::{ten_digits, three_digits},
    unit::{self, Quantity},
};

use super::contact::Gaps;
use crate::{
    mechanism::{Contour, JointKind, OfGap, Walls, through},
    scene::{
        Problem, SceneError,
        pins::MEAN,
        tree::Value,
        value::{Field, OneOrEach},
    },
    setup::SURFACES,
};

pub(super) const SLOPE: Quantity = Quantity { units: unit::SLOPE, range: [-0.5, 0.5] };
const BOW: Quantity = Quantity { units: unit::LENGTH, range: [-1e3, 1e3] };
const OVER: Quantity = Quantity { units: unit::LENGTH, range: [0.1, 1e5] };

/// The distance to another place along the travel.
const AWAY: Quantity = Quantity { units: unit::LENGTH, range: [-1e5, 1e5] };
/// How far (m) places are apart at least.
const APART: f64 = 1e-4;

/// Reads how the walls of the joint called `name`, of this `kind`, run that the `table` states; the gaps at other places are added to `gaps`.
pub(super) fn walls(name: &str, table: &Field, kind: &JointKind, gaps: &mut Gaps) -> Result<Walls, SceneError> {
    let along = table.get("along");
    if let (Some(along), Some(key)) = (&along, ["slope", "bow"].into_iter().find(|key| table.get(key).is_some())) {
        return Err(along.no_effect(format!("beside `{key}`"), "gaps at other places, or slope and bow"));
    }
    match (kind, &along) {
        (JointKind::Guide { .. }, None) => of_walls(table, [true; 2]),
        (JointKind::Track { gaps }, None) => of_walls(table, gaps.map(|gap| gap.is_some())),
        (JointKind::Guide { gap, .. }, Some(along)) => {
            let line = || Wall { key: "clearance", name: name.into(), gap: Some(*gap) };
            // Both lines have the same gaps.
            let line = others(along, &[line()], gaps)?.swap_remove(0);
            Ok(Walls::OfGaps(vec![line.clone(), line]))
        }
        (JointKind::Track { gaps: own }, Some(along)) => {
            let wall = |(key, gap)| Wall { key, name: format!("{name} {key}"), gap };
            let walls: Vec<Wall> = SURFACES.into_iter().zip(*own).map(wall).collect();
            others(along, &walls, gaps).map(Walls::OfGaps)
        }
        _ => match ["slope", "bow", "along"].iter().find_map(|key| table.get(key)) {
            None => Ok(Walls::Parallel),
            Some(field) => {
                let what = format!("`{}` of a joint of kind \"{}\"", field.key, kind.name());
                let allowed =
                    "a track, or in a plane a prismatic joint with a clearance; a stop's normal may lean in a plane";
                Err(field.error(Problem::Unsupported { what }, allowed))
            }
        },
    }
}

/// A wall that a joint of its kind may have.
struct Wall<'a> {
    /// The key of its gap.
    key: &'a str,
    /// Name of its gap: the joint's, and its surface where there are several.
    name: String,
    /// Its gap where the joint is drawn; `None` where the joint has no such wall.
    gap: Option<usize>,
}

/// What the gaps at one or two other places `along` the travel add to the contours of the `walls`.
fn others(along: &Field, walls: &[Wall], gaps: &mut Gaps) -> Result<Vec<Vec<OfGap>>, SceneError> {
    const PLACES: &str = "a list of one or two tables such as { at = 300, clearance = [0.3, 0.05] }";
    let Value::List(nodes) = &along.node.value else { return Err(along.wrong_type(PLACES)) };
    if !(1..=2).contains(&nodes.len()) {
        return Err(along.error(Problem::Length { key: along.key.clone(), found: nodes.len() }, PLACES));
    }
    let mut found: Vec<Vec<(usize, f64)>> = vec![Vec::new(); walls.len()];
    let mut places = vec![0.0];
    for node in nodes {
        let place = Field { key: along.key.clone(), node };
        place.expect_table()?;
        let at = place.require("at", "a distance in mm from where the joint is drawn")?;
        let away = at.to_number(&AWAY)?;
        if places.iter().any(|other| (away - other).abs() < APART) {
            let allowed = "a place 0.1 mm or more from the others and from where the joint is drawn";
            return Err(at.out_of_range("mm", allowed));
        }
        places.push(away);
        let is_known = |key: &str| walls.iter().any(|wall| wall.key == key);
        let mut keys = ["clearance"].into_iter().chain(SURFACES).filter(|key| !is_known(key));
        if let Some(field) = keys.find_map(|key| place.get(key)) {
            return Err(field.no_effect("at a joint of this kind", "the keys that its own gaps have"));
        }
        for (wall, others) in walls.iter().zip(&mut found) {
            match (wall.gap, place.get(wall.key)) {
                (Some(_), None) => return Err(place.error(Problem::Missing(wall.key.into()), "the gap there")),
                (None, Some(field)) => {
                    return Err(field.no_effect("where the track has no such wall", "the walls it has"));
                }
                (Some(_), Some(field)) => {
                    let name = format!("{} at {} mm", wall.name, ten_digits(away * 1e3));
                    others.push((gaps.add(name, &field, &MEAN)?, away));
                }
                (None, None) => {}
            }
        }
    }
    let walls = walls.iter().zip(&found);
    let found: Vec<Vec<OfGap>> =
        walls.map(|(wall, others)| wall.gap.map_or_else(Vec::new, |own| through(own, others))).collect();
    let mean = |gap: usize| gaps.gaps[gap].statistics.mean;
    let sum = |wall: &[OfGap], k: usize| wall.iter().map(|of| of.adds[k] * mean(of.gap)).sum::<f64>();
    let slopes = found.iter().flat_map(|wall| places.iter().map(|s| sum(wall, 0) + sum(wall, 1) * s));
    let steepest = slopes.fold(0.0f64, |most, slope| most.max(slope.abs()));
    if steepest > SLOPE.range[1] {
        let what = format!("a wall through these gaps has a slope of {}", three_digits(steepest));
        return Err(along.error(Problem::Mechanism(what), "gaps that give a slope of 0.5 at most"));
    }
    Ok(found)
}

/// Those of `N` walls, of which some may not be there.
fn of_walls<const N: usize>(table: &Field, is_there: [bool; N]) -> Result<Walls, SceneError> {
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
    Ok(if is_flat { Walls::Parallel } else { Walls::Stated(contours) })
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
