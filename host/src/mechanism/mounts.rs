//! How ideal joints hang bodies in a plane on each other and on the frame: coordinates and points.

use slipfit_core::{
    Vector2,
    system::planar::{Coordinate, Point},
};

use super::{
    Joint, JointKind, Mechanism, MountError, Port,
    hanging::{Hung, hanging},
};

/// Most coordinates of a mechanism in a plane.
pub const MOST: usize = 6;

/// A coordinate and whose it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Owned {
    /// The coordinate.
    pub coordinate: Coordinate<f64>,
    /// The body that it moves first.
    pub body: usize,
}

/// A body's place in the tree.
#[derive(Clone, Debug, PartialEq)]
struct Mount {
    /// A point of the body.
    point: Point<f64, MOST>,
    /// Where that is in the drawn pose (m).
    drawn: Vector2<f64>,
}

/// The tree of a mechanism in a plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Mounts {
    coordinates: Vec<Owned>,
    bodies: Vec<Mount>,
}

impl Mounts {
    /// The tree of `mechanism`, which lies in a plane. A body without ideal joint is free, with three coordinates.
    ///
    /// # Errors
    /// See [`MountError`].
    pub fn of(mechanism: &Mechanism) -> Result<Self, MountError> {
        let mut bodies: Vec<Option<Mount>> = vec![None; mechanism.bodies.len()];
        let mut coordinates = Vec::new();
        for Hung { body, on, by } in hanging(mechanism)? {
            let parent = on.and_then(|on| bodies[on].clone()).unwrap_or_else(frame);
            bodies[body] = Some(match by {
                Some(joint) => hung(&parent, &mechanism.joints[joint], body, &mut coordinates)?,
                None => afloat(mechanism.bodies[body].centre, body, &mut coordinates)?,
            });
        }
        Ok(Self { coordinates, bodies: bodies.into_iter().flatten().collect() })
    }

    /// The coordinates, with whose they are.
    pub fn coordinates(&self) -> &[Owned] {
        &self.coordinates
    }

    /// The point of a body, or of the frame, that is `at` (m) in the drawn pose.
    pub fn point<const D: usize>(&self, port: Port, at: Vector2<f64>) -> Point<f64, D> {
        let point = match port {
            Some(body) => {
                let Mount { point, drawn } = &self.bodies[body];
                point.plus(at - drawn)
            }
            None => Point::fixed(at),
        };
        let mut narrow = Point::fixed(point.base);
        narrow.carrier.turn = point.carrier.turn;
        narrow.carrier.moves.copy_from_slice(&point.carrier.moves[..D]);
        narrow.arms.copy_from_slice(&point.arms[..D]);
        narrow
    }

    /// The coordinate that turns a body; `None` for the frame and what does not turn.
    pub fn turn(&self, port: Port) -> Option<usize> {
        port.and_then(|body| self.bodies[body].point.carrier.turn)
    }
}

fn frame() -> Mount {
    Mount { point: Point::fixed(Vector2::zeros()), drawn: Vector2::zeros() }
}

/// In the plane.
pub fn flat([x, y, _]: [f64; 3]) -> Vector2<f64> {
    Vector2::new(x, y)
}

/// The mount of `child` on `parent` by `joint`.
fn hung(parent: &Mount, joint: &Joint, child: usize, coordinates: &mut Vec<Owned>) -> Result<Mount, MountError> {
    let at = flat(joint.at);
    let mut point = parent.point.plus(at - parent.drawn);
    let slide =
        |point: &Point<f64, MOST>, axis: [f64; 3]| Coordinate::Slide { on: point.carrier.turn, axis: flat(axis) };
    let mut move_by = |point: &mut Point<f64, MOST>, coordinate: Coordinate<f64>| {
        *point = point.on(add(coordinates, coordinate, child)?, &coordinate);
        Ok(())
    };
    match joint.kind {
        JointKind::Revolute { .. } => move_by(&mut point, Coordinate::Turn)?,
        JointKind::Prismatic { axis } => {
            let slide = slide(&point, axis);
            move_by(&mut point, slide)?;
        }
        // The slot belongs to the first body. Where that is the child, its own turn turns the axis along which it slides.
        JointKind::PinSlot { axis } if joint.between[0] == Some(child) => {
            move_by(&mut point, Coordinate::Turn)?;
            let slide = slide(&point, axis);
            move_by(&mut point, slide)?;
        }
        JointKind::PinSlot { axis } => {
            let slide = slide(&point, axis);
            move_by(&mut point, slide)?;
            move_by(&mut point, Coordinate::Turn)?;
        }
        _ => {}
    }
    Ok(Mount { point, drawn: at })
}

/// The mount of a free body.
fn afloat(centre: [f64; 3], body: usize, coordinates: &mut Vec<Owned>) -> Result<Mount, MountError> {
    let drawn = flat(centre);
    let mut point = Point::fixed(drawn);
    let along = |axis| Coordinate::Slide { on: None, axis };
    for coordinate in [along(Vector2::x()), along(Vector2::y()), Coordinate::Turn] {
        point = point.on(add(coordinates, coordinate, body)?, &coordinate);
    }
    Ok(Mount { point, drawn })
}

/// The index of a new `coordinate`.
fn add(coordinates: &mut Vec<Owned>, coordinate: Coordinate<f64>, body: usize) -> Result<usize, MountError> {
    coordinates.push(Owned { coordinate, body });
    if coordinates.len() > MOST {
        Err(MountError::Coordinates { found: coordinates.len(), most: MOST })
    } else {
        Ok(coordinates.len() - 1)
    }
}
