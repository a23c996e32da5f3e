//! How features lie to each other.

use crate::{
    drawing::{Axis, Plane, Shape},
    format::{cross, dot, plus},
};

/// How far (mm) features may lie off each other that the drawing has on one line or in one plane.
const OFF: f64 = 1e-6;
/// Sine of the angle by which parallel directions may differ.
const LEAN: f64 = 1e-9;

fn norm(vector: [f64; 3]) -> f64 {
    libm::sqrt(dot(vector, vector))
}

fn are_parallel(one: [f64; 3], two: [f64; 3]) -> bool {
    norm(cross(one, two)) <= LEAN
}

/// Place and direction of a plane or an axis.
fn line(shape: &Shape) -> ([f64; 3], [f64; 3]) {
    match shape {
        Shape::Plane(Plane { at, normal, .. }) => (*at, *normal),
        Shape::Axis(Axis { at, along, .. }) => (*at, *along),
        Shape::Point(point) => (point.at, point.normal),
    }
}

/// Whether two features can be one datum: coaxial axes, or faces in one plane that face the same way.
pub fn are_common(one: &Shape, two: &Shape) -> bool {
    let ((at, direction), (other, second)) = (line(one), line(two));
    let between = plus(other, -1.0, at);
    are_parallel(direction, second)
        && match (one, two) {
            (Shape::Plane(_), Shape::Plane(_)) => dot(between, direction).abs() <= OFF && dot(direction, second) > 0.0,
            (Shape::Axis(_), Shape::Axis(_)) => norm(cross(between, direction)) <= OFF,
            _ => false,
        }
}

/// Whether a feature lies to the first datum of a run-out, coaxiality or concentricity as it has to: an axis on the line of the
/// datum axis, a face at a right angle to it.
pub fn turns_about(shape: &Shape, datum: &Shape) -> bool {
    let Shape::Axis(axis) = datum else { return false };
    match shape {
        Shape::Axis(_) => are_common(shape, datum),
        Shape::Plane(plane) => are_parallel(plane.normal, axis.along),
        Shape::Point(_) => true,
    }
}

/// Whether a feature lies in the datum plane that it is symmetric to.
pub fn is_in_middle(shape: &Shape, datum: &Shape) -> bool {
    let Shape::Plane(middle) = datum else { return false };
    let (at, direction) = line(shape);
    let is_on = dot(plus(at, -1.0, middle.at), middle.normal).abs() <= OFF;
    is_on
        && match shape {
            Shape::Plane(_) => are_parallel(direction, middle.normal),
            Shape::Axis(_) => dot(direction, middle.normal).abs() <= LEAN,
            Shape::Point(_) => false,
        }
}

/// Whether the normal of a zone between two planes, if stated, is that of a plane.
pub fn is_normal(zone: Option<[f64; 3]>, normal: [f64; 3]) -> bool {
    zone.is_none_or(|zone| norm(cross(zone, normal)) <= 1e-6)
}

/// Whether each datum of a frame holds something that those before it leave free.
pub fn each_holds(frame: &[Shape]) -> bool {
    let Some(centre) = frame.first().map(|first| line(first).0) else { return true };
    let reach = frame.iter().map(|shape| norm(plus(line(shape).0, -1.0, centre))).fold(1.0, f64::max);
    let mut held: Vec<[f64; 6]> = Vec::new();
    frame.iter().all(|shape| {
        let before = held.len();
        for motion in motions(shape, centre, reach) {
            hold(motion, &mut held);
        }
        held.len() > before
    })
}

/// The motions (shift, and turn about the centre in units of 1/reach) that a datum does not allow.
fn motions(shape: &Shape, centre: [f64; 3], reach: f64) -> Vec<[f64; 6]> {
    let (at, direction) = line(shape);
    let arm = plus(at, -1.0, centre).map(|x| x / reach);
    let sides = sides(direction);
    // The shift of the datum's place along a direction.
    let shift = |along: [f64; 3]| {
        let turn = cross(arm, along);
        [along[0], along[1], along[2], turn[0], turn[1], turn[2]]
    };
    let turn = |about: [f64; 3]| [0.0, 0.0, 0.0, about[0], about[1], about[2]];
    match shape {
        Shape::Plane(_) => vec![shift(direction), turn(sides[0]), turn(sides[1])],
        Shape::Axis(_) => vec![shift(sides[0]), shift(sides[1]), turn(sides[0]), turn(sides[1])],
        Shape::Point(_) => vec![shift(direction)],
    }
}

fn sides(direction: [f64; 3]) -> [[f64; 3]; 2] {
    let least = (0..3).min_by(|a, b| direction[*a].abs().total_cmp(&direction[*b].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let one = cross(direction, axis);
    let size = norm(one).max(f64::MIN_POSITIVE);
    let one = one.map(|x| x / size);
    [one, cross(direction, one)]
}

/// Adds what of a motion is not held yet (Gram and Schmidt).
fn hold(motion: [f64; 6], held: &mut Vec<[f64; 6]>) {
    let product = |a: &[f64; 6], b: &[f64; 6]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut rest = motion;
    for known in held.iter() {
        let along = product(&rest, known);
        rest.iter_mut().zip(known).for_each(|(x, known)| *x -= along * known);
    }
    let size = libm::sqrt(product(&rest, &rest));
    if size > 1e-6 {
        held.push(rest.map(|x| x / size));
    }
}

/// Whether axes are parallel and not all on one line.
pub fn is_pattern(shapes: &[Shape]) -> bool {
    let Some((Shape::Axis(first), rest)) = shapes.split_first() else { return false };
    let mut apart = false;
    for shape in rest {
        let Shape::Axis(axis) = shape else { return false };
        if !are_parallel(axis.along, first.along) {
            return false;
        }
        apart |= norm(cross(plus(axis.at, -1.0, first.at), first.along)) > 1e-3;
    }
    apart
}

#[cfg(test)]
mod tests {
    use super::{are_common, each_holds, is_pattern};
    use crate::drawing::{Axis, Plane, Shape};

    fn plane(at: [f64; 3], normal: [f64; 3]) -> Shape {
        Shape::Plane(Plane { at, normal, along: [0.0; 3], extents: [1.0; 2], width: None })
    }

    fn axis(at: [f64; 3], along: [f64; 3]) -> Shape {
        Shape::Axis(Axis { at, along, length: 1.0, diameter: 1.0, is_hole: None })
    }

    const X: [f64; 3] = [1.0, 0.0, 0.0];
    const Z: [f64; 3] = [0.0, 0.0, 1.0];

    #[test]
    fn a_datum_has_to_hold_something_more() {
        let top = plane([0.0; 3], Z);
        assert!(each_holds(&[top, axis([10.0, 0.0, 0.0], Z), axis([-10.0, 0.0, 5.0], Z)]));
        assert!(!each_holds(&[top, plane([0.0, 0.0, 9.0], Z)]));
        assert!(!each_holds(&[axis([0.0; 3], Z), axis([0.0, 0.0, 7.0], Z)]));
        assert!(each_holds(&[top, plane([5.0, 0.0, 0.0], X)]) && each_holds(&[]));
    }

    #[test]
    fn common_datums_and_patterns_lie_as_they_must() {
        assert!(are_common(&axis([0.0; 3], Z), &axis([0.0, 0.0, 7.0], Z.map(|z| -z))));
        assert!(!are_common(&plane([0.0; 3], Z), &plane([3.0, 0.0, 0.0], Z.map(|z| -z))));
        let [one, two] = [axis([0.0; 3], Z), axis([3.0, 0.0, 0.0], Z)];
        assert!(is_pattern(&[one, two]) && !is_pattern(&[one, one]) && !is_pattern(&[one, axis([3.0; 3], X)]));
    }
}
