//! The rectangle around the boundary of a flat face.

use roxmltree::Node;

use super::place::{direction, place};
use crate::{
    error::{Problem, QifError},
    format::{cross, dot, plus, rounded, rounded_direction, unit},
    units::Units,
    xml::{child, error_at, numbers, require},
};

/// A rectangle in a plane.
pub struct Rectangle {
    /// Its middle (mm).
    pub middle: [f64; 3],
    /// Direction of its first side.
    pub along: [f64; 3],
    /// Its sides (mm).
    pub extents: [f64; 2],
}

/// Points (mm) around which the boundary of a face goes: the PolyLine, Rectangle or Circle of a PlaneFeatureNominalType.
pub fn boundary(node: Node, units: &Units) -> Result<Option<Vec<[f64; 3]>>, QifError> {
    if let Some(line) = child(node, "PolyLine") {
        let scale = units.scale(line)?;
        let values = numbers(line)?;
        let (points, rest) = values.as_chunks::<3>();
        if !rest.is_empty() {
            return Err(error_at(line, Problem::Number("a list of points of 3 numbers".into())));
        }
        return Ok(Some(points.iter().map(|point| point.map(|x| x * scale)).collect()));
    }
    if let Some(rectangle) = child(node, "Rectangle") {
        let corner = place(require(rectangle, "CornerPoint")?, units)?;
        let side = |length: &str, towards: &str| -> Result<[f64; 3], QifError> {
            let length = units.length(require(rectangle, length)?)?;
            Ok(direction(require(rectangle, towards)?)?.map(|x| x * length))
        };
        let [one, two] = [side("Length", "LengthDirection")?, side("Width", "WidthDirection")?];
        let along = plus(corner, 1.0, one);
        return Ok(Some(vec![corner, along, plus(along, 1.0, two), plus(corner, 1.0, two)]));
    }
    if let Some(circle) = child(node, "Circle") {
        let centre = place(require(circle, "CenterPoint")?, units)?;
        let radius = 0.5 * units.length(require(circle, "Diameter")?)?;
        let normal = direction(require(circle, "Normal")?)?;
        let [one, two] = across(normal);
        let points = [(one, radius), (one, -radius), (two, radius), (two, -radius)];
        return Ok(Some(points.map(|(side, by)| plus(centre, by, side)).to_vec()));
    }
    Ok(None)
}

/// The smallest rectangle around `points` in the plane of `normal` whose sides go along an axis of the part or along the longest
/// edge; `None` if the points have no area.
pub fn rectangle(points: &[[f64; 3]], normal: [f64; 3]) -> Option<Rectangle> {
    let in_plane = |vector: [f64; 3]| unit(plus(vector, -dot(vector, normal), normal)).map(rounded_direction);
    let edges = points.windows(2).map(|pair| plus(pair[1], -1.0, pair[0]));
    let longest = edges.max_by(|a, b| dot(*a, *a).total_cmp(&dot(*b, *b)));
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let sides = axes.into_iter().chain(longest).filter_map(in_plane);
    let mut best: Option<Rectangle> = None;
    for along in sides {
        let around = around(points, normal, along)?;
        let area = |rectangle: &Rectangle| rectangle.extents[0] * rectangle.extents[1];
        // An axis of the part comes first, and an edge that is parallel to it does not replace it by rounding.
        if best.as_ref().is_none_or(|best| area(&around) < area(best) * (1.0 - 1e-6)) {
            best = Some(around);
        }
    }
    best.filter(|best| best.extents.iter().all(|side| *side > 0.0))
}

/// The rectangle around `points` with a side `along`.
fn around(points: &[[f64; 3]], normal: [f64; 3], along: [f64; 3]) -> Option<Rectangle> {
    let second = unit(cross(normal, along))?;
    let first = points.first()?;
    let range = |side: [f64; 3]| {
        let places = points.iter().map(|point| dot(*point, side));
        places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    };
    let ranges = [range(along), range(second)];
    let height = dot(*first, normal);
    let [u, v] = ranges.map(|[low, high]| 0.5 * (low + high));
    let middle = [0, 1, 2].map(|i| height * normal[i] + u * along[i] + v * second[i]);
    Some(Rectangle { middle, along, extents: ranges.map(|[low, high]| rounded(high - low)) })
}

/// Two directions at right angles to a unit vector and to each other.
fn across(normal: [f64; 3]) -> [[f64; 3]; 2] {
    let least = (0..3).min_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let one = unit(cross(normal, axis)).unwrap_or(axis);
    [one, cross(normal, one)]
}

#[cfg(test)]
mod tests {
    use super::rectangle;

    #[test]
    fn a_rectangle_goes_along_the_part_or_the_longest_edge() {
        let square = [[0.0, 0.0, 5.0], [4.0, 0.0, 5.0], [4.0, 2.0, 5.0], [0.0, 2.0, 5.0]];
        let found = rectangle(&square, [0.0, 0.0, 1.0]).expect("a rectangle");
        assert_eq!((found.middle, found.along, found.extents), ([2.0, 1.0, 5.0], [1.0, 0.0, 0.0], [4.0, 2.0]));
        let turned = [[0.0, 0.0, 0.0], [3.0, 3.0, 0.0], [2.0, 4.0, 0.0], [-1.0, 1.0, 0.0]];
        let found = rectangle(&turned, [0.0, 0.0, 1.0]).expect("a rectangle");
        let [long, short] = found.extents;
        assert!((long * long - 18.0).abs() < 1e-8 && (short * short - 2.0).abs() < 1e-8, "{long} {short}");
        assert!(rectangle(&square[..2], [0.0, 0.0, 1.0]).is_none() && rectangle(&[], [1.0, 0.0, 0.0]).is_none());
    }
}
