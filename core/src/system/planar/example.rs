//! A tree with every kind of coordinate, for tests.

use super::{Coordinate, Point, Rigid};
use crate::Vector2;

/// Its coordinates, its bodies, of which two move as one, and points on the rod, the slider and the lift.
pub(crate) struct Linkage {
    pub coordinates: [Coordinate<f64>; 6],
    pub bodies: [Rigid<f64, 6>; 6],
    pub points: [Point<f64, 6>; 3],
}

/// A crank, a rod on it, a slider that moves on the rod along two axes, and a lift that turns at its end.
pub(crate) fn linkage() -> Linkage {
    let slide = |on, x: f64, y: f64| Coordinate::Slide { on, axis: Vector2::new(x, y) };
    let coordinates = [
        Coordinate::Turn,
        Coordinate::Turn,
        slide(Some(1), 0.6, 0.8),
        slide(None, 0.0, 1.0),
        Coordinate::Turn,
        slide(Some(1), -0.8, 0.6),
    ];
    let on = |point: Point<f64, 6>, k: usize| point.on(k, &coordinates[k]);
    let crank = on(Point::fixed(Vector2::new(0.1, 0.0)), 0);
    let rod = on(crank.plus(Vector2::new(0.3, 0.1)), 1);
    let carriage = on(rod.plus(Vector2::new(0.2, 0.0)), 2);
    let slider = on(carriage.plus(Vector2::new(0.05, 0.0)), 5);
    let lift = on(on(Point::fixed(Vector2::new(0.5, 0.2)), 3), 4);
    let body = |mass, centre| Rigid { mass, inertia: 0.02, centre };
    let bodies = [
        body(0.5, crank.plus(Vector2::new(0.1, 0.0))),
        body(0.7, rod.plus(Vector2::new(0.1, 0.02))),
        body(0.3, carriage.plus(Vector2::new(0.0, 0.05))),
        body(0.2, slider.plus(Vector2::new(0.0, 0.05))),
        body(0.25, lift.plus(Vector2::new(0.03, 0.05))),
        body(0.15, lift.plus(Vector2::new(-0.05, 0.02))),
    ];
    Linkage { coordinates, bodies, points: [rod, slider, lift] }
}
