//! Symbols of joints, bodies and drives.

use super::view::View;
use crate::{
    mechanism::{Joint, JointKind},
    show::{
        palette::{Colour, INK, KINDS, PAPER, SOFT},
        svg::{Stroke, Svg, number},
    },
};

/// The colour of drives.
pub const DRIVE: Colour = KINDS[7];

/// The colour of a body, and of the frame.
pub fn colour(body: Option<usize>) -> Colour {
    body.map_or(SOFT, |body| KINDS[body % KINDS.len()])
}

/// Radius of a pin (px), and how much of a gap is shown.
const PIN: f64 = 6.0;
const GAP: f64 = 4.0;
/// Half of a symbol's length along its axis (px).
const HALF: f64 = 16.0;
/// Length of an arrow (px).
const ARROW: f64 = 34.0;

/// Draws symbols.
pub struct Pen<'a> {
    pub svg: &'a mut Svg,
    pub view: &'a View,
}

type Place = [f64; 2];

/// `at` and so far along and across a direction (px).
fn moved([x, y]: Place, [right, down]: Place, along: f64, across: f64) -> Place {
    [x + along * right - across * down, y + along * down + across * right]
}

/// A circle as a path.
fn circle([x, y]: Place, radius: f64) -> String {
    let [left, y, r, d] = [x - radius, y, radius, 2.0 * radius].map(number);
    format!("M{left} {y}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0 -{d} 0z")
}

/// A closed path through `corners`.
fn polygon(corners: &[Place]) -> String {
    let places: Vec<_> = corners.iter().map(|[x, y]| format!("{} {}", number(*x), number(*y))).collect();
    format!("M{}z", places.join("L"))
}

/// A rectangle about `at`: half its sides along and across a direction.
fn rectangle(at: Place, direction: Place, half: [f64; 2]) -> String {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    polygon(&corners.map(|[s, t]| moved(at, direction, s * half[0], t * half[1])))
}

impl Pen<'_> {
    fn outline(&mut self, path: &str, inside: Colour, of: Colour) {
        self.svg.path(path, Some(inside), Some(Stroke::new(of, 2.0)));
    }

    /// Two lines on either side of `at`.
    fn rails(&mut self, at: Place, direction: Place, [half, apart]: [f64; 2], of: Colour) {
        for side in [-apart, apart] {
            let ends = [-half, half].map(|along| moved(at, direction, along, side));
            self.svg.line(&ends, Stroke::new(of, 2.0));
        }
    }

    /// Strokes that say that something stands still, on the far side of a line across `normal`.
    fn hatching(&mut self, at: Place, normal: Place, of: Colour) {
        for across in [-8.0, 0.0, 8.0] {
            let ends = [moved(at, normal, 0.0, across), moved(at, normal, -6.0, across - 4.0)];
            self.svg.line(&ends, Stroke::new(of, 1.2));
        }
    }

    /// A spring along the line between its ends: straight at either, a zigzag between.
    pub fn spring(&mut self, ends: [[f64; 3]; 2]) {
        const WINDINGS: usize = 6;
        let [from, to] = ends.map(|end| self.view.at(end));
        let [right, down] = [to[0] - from[0], to[1] - from[1]];
        let length = right.hypot(down);
        if length < 1.0 {
            return;
        }
        let direction = [right / length, down / length];
        let (start, each) = (0.2 * length, 0.6 * length / WINDINGS as f64);
        let turns = (0..WINDINGS).flat_map(|k| {
            let at = start + each * k as f64;
            [(at + 0.25 * each, 5.0), (at + 0.75 * each, -5.0)]
        });
        let all = [(0.0, 0.0), (start, 0.0)].into_iter().chain(turns).chain([(0.8 * length, 0.0), (length, 0.0)]);
        let places: Vec<_> = all.map(|(along, across)| moved(from, direction, along, across)).collect();
        self.svg.line(&places, Stroke::new(SOFT, 1.5));
    }

    /// A joint, in the colours of the bodies that it joins.
    pub fn joint(&mut self, joint: &Joint) {
        let at = self.view.at(joint.at);
        let [first, second] = joint.between.map(colour);
        let fixed = joint.between.iter().position(Option::is_none);
        match &joint.kind {
            JointKind::Fixed => self.outline(&rectangle(at, [1.0, 0.0], [PIN, PIN]), second, first),
            JointKind::Revolute { axis } if self.view.direction(*axis).is_some() => {
                self.hinge(at, *axis, [first, second])
            }
            JointKind::Revolute { .. } => {
                if fixed.is_some() {
                    let foot = [at, [at[0] - 9.0, at[1] + 16.0], [at[0] + 9.0, at[1] + 16.0]];
                    self.outline(&polygon(&foot), PAPER, colour(None));
                    self.hatching([at[0], at[1] + 16.0], [0.0, -1.0], colour(None));
                }
                self.outline(&circle(at, PIN), PAPER, INK);
            }
            JointKind::Prismatic { axis } => self.slider(at, *axis, [first, second], 0.0),
            JointKind::PinSlot { axis } => {
                if let Some(direction) = self.view.direction(*axis) {
                    self.rails(at, direction, [2.0 * HALF, PIN + 1.0], first);
                }
                self.outline(&circle(at, PIN), PAPER, second);
            }
            JointKind::Cylindrical { axis } if self.view.direction(*axis).is_some() => {
                self.slider(at, *axis, [first, second], 0.0);
            }
            JointKind::Cylindrical { .. } => self.outline(&circle(at, PIN), PAPER, second),
            JointKind::Spherical => {
                self.outline(&circle(at, PIN + 3.0), PAPER, first);
                self.outline(&circle(at, PIN), second, second);
            }
            JointKind::Journal { .. } => self.journal(at, [first, second]),
            JointKind::Guide { axis, edges, .. } => {
                let Some(direction) = self.view.direction(*axis) else { return };
                let half = edges.map(|edge| (0.5 * self.view.length(edge)).max(PIN));
                self.outline(&rectangle(at, direction, half), PAPER, first);
                self.rails(at, direction, [half[0] + HALF, half[1] + GAP], second);
            }
            JointKind::Bearing { axis, length, .. } => match self.view.direction(*axis) {
                Some(direction) => {
                    let half = (0.5 * self.view.length(*length)).max(PIN);
                    self.rails(at, direction, [half + HALF, PIN - 1.0], second);
                    for side in [-1.0, 1.0] {
                        let bush = moved(at, direction, 0.0, side * (PIN - 1.0 + GAP + 3.0));
                        self.outline(&rectangle(bush, direction, [half, 3.0]), PAPER, first);
                    }
                }
                None => self.journal(at, [first, second]),
            },
            JointKind::Track { gaps } => {
                let walls = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
                for (_, normal) in gaps.iter().zip(walls).filter(|(gap, _)| gap.is_some()) {
                    self.wall(at, normal, second, fixed == Some(1));
                }
                self.outline(&circle(at, PIN), first, first);
            }
            JointKind::Stop { normal, .. } => {
                self.wall(at, normal.map(|x| -x), second, fixed == Some(1));
                self.outline(&circle(at, 3.0), first, first);
            }
        }
    }

    /// A hinge seen from the side: three barrels on its axis, the middle one of the second body.
    fn hinge(&mut self, at: Place, axis: [f64; 3], [outer, middle]: [Colour; 2]) {
        let Some(direction) = self.view.direction(axis) else { return };
        for (along, of) in [(-12.0, outer), (0.0, middle), (12.0, outer)] {
            self.outline(&rectangle(moved(at, direction, along, 0.0), direction, [6.0, 4.0]), PAPER, of);
        }
    }

    /// A hole around a pin.
    fn journal(&mut self, at: Place, [hole, pin]: [Colour; 2]) {
        self.outline(&circle(at, PIN + GAP), PAPER, hole);
        self.outline(&circle(at, PIN), pin, pin);
    }

    /// A wall at a gap from a pin, on the side where `direction` points; hatched if it stands still.
    fn wall(&mut self, at: Place, direction: [f64; 3], of: Colour, still: bool) {
        let Some(direction) = self.view.direction(direction) else { return };
        let foot = moved(at, direction, PIN + GAP, 0.0);
        let ends = [-12.0, 12.0].map(|across| moved(foot, direction, 0.0, across));
        self.svg.line(&ends, Stroke::new(of, 2.0));
        if still {
            self.hatching(foot, [-direction[0], -direction[1]], of);
        }
    }

    /// A block between two lines; a circle where the axis points at the viewer.
    fn slider(&mut self, at: Place, axis: [f64; 3], [line, block]: [Colour; 2], gap: f64) {
        let Some(direction) = self.view.direction(axis) else {
            return self.outline(&circle(at, PIN), PAPER, block);
        };
        self.rails(at, direction, [2.0 * HALF, 9.0 + gap], line);
        self.outline(&rectangle(at, direction, [HALF, 9.0]), PAPER, block);
    }

    /// The centre of mass: a circle with two dark quarters.
    pub fn centre(&mut self, at: [f64; 3], of: Colour) {
        let at = self.view.at(at);
        self.outline(&circle(at, 5.0), PAPER, of);
        let [x, y] = at.map(number);
        self.svg.path(&format!("M{x} {y}v-5a5 5 0 0 1 5 5zM{x} {y}v5a5 5 0 0 1 -5 -5z"), Some(of), None);
    }

    /// A force, from its point on.
    pub fn arrow(&mut self, at: [f64; 3], axis: [f64; 3]) {
        let at = self.view.at(at);
        match self.view.direction(axis) {
            Some(direction) => {
                let end = moved(at, direction, ARROW, 0.0);
                self.svg.line(&[at, end], Stroke::new(DRIVE, 2.5));
                self.head(end, direction);
            }
            // Seen from its end or from its start.
            None => {
                self.outline(&circle(at, 7.0), PAPER, DRIVE);
                if self.view.towards(axis) > 0.0 {
                    self.svg.path(&circle(at, 2.5), Some(DRIVE), None);
                } else {
                    for direction in [[0.7, 0.7], [0.7, -0.7]] {
                        let ends = [-7.0, 7.0].map(|along| moved(at, direction, along, 0.0));
                        self.svg.line(&ends, Stroke::new(DRIVE, 2.0));
                    }
                }
            }
        }
    }

    /// A torque about an axis: an arc where the axis points at the viewer, else a double arrow along it.
    pub fn turn(&mut self, at: [f64; 3], axis: [f64; 3], speed: f64) {
        let sense = if speed < 0.0 { -1.0 } else { 1.0 };
        let towards = self.view.towards(axis) * sense;
        if towards == 0.0 {
            self.arrow(at, axis.map(|x| x * sense));
            if let Some(direction) = self.view.direction(axis.map(|x| x * sense)) {
                let end = moved(self.view.at(at), direction, ARROW + 9.0, 0.0);
                self.head(end, direction);
            }
            return;
        }
        const RADIUS: f64 = 22.0;
        let [x, y] = self.view.at(at);
        // Three quarters of a circle, against the clock where the axis points at the viewer.
        let (start, end) = ([x + RADIUS, y], [x, y + RADIUS * towards]);
        let (clock, radius) = (if towards > 0.0 { 0 } else { 1 }, number(RADIUS));
        let [sx, sy, ex, ey] = [start[0], start[1], end[0], end[1]].map(number);
        let arc = format!("M{sx} {sy}A{radius} {radius} 0 1 {clock} {ex} {ey}");
        self.svg.path(&arc, None, Some(Stroke::new(DRIVE, 2.5)));
        self.head([end[0] + 6.0, end[1]], [1.0, 0.0]);
    }

    /// The head of an arrow that ends there.
    fn head(&mut self, end: Place, direction: Place) {
        let corners =
            [moved(end, direction, 3.0, 0.0), moved(end, direction, -8.0, 5.0), moved(end, direction, -8.0, -5.0)];
        self.svg.area(&corners, DRIVE);
    }
}
