//! The drawer effect: whether a body that is driven beside its guide locks.
//!
//! A moment that is carried by two contacts a length L apart along the travel, at a distance b from the line of the drive, locks
//! at μ ≥ L/(2b): each contact carries N = F·b/L and rubs with μN. With the other resistances acting at distance b0, it locks only if
//! the drive passes beyond their line; on it, the body is on the edge; short of it, the body turns the other way and never locks.
//!
//! Which two contacts carry follows from the way the drive turns the body: of all pairs that oppose that turn, the pair that closes at
//! the least angle. Both may be on one side of the body, or one on either side; b counts from the middle between them, because their
//! friction does. Pairs that close at one angle share the load. A drive beside its guide and above it uses both directions at once:
//! separate contacts rub with the sum of their forces, so that it locks at 2μ·Σ b/L ≥ 1; a round rod carries both at one contact,
//! with the root of the sum of squares.

use serde::Serialize;

use nalgebra::Vector3;
use slipfit_core::slide::ABSENT;

use super::{Action, JointKind, Mechanism, Port, mobility::SURFACE_NORMALS};
use crate::setup::{PinSpec, Scene};

/// Lengths (m) that differ by rounding alone.
const SAME: f64 = 1e-9;
/// Turns (rad) at which contacts close together: less than any contact yields.
const SAME_TURN: f64 = 1e-6;

/// Where the drive passes, seen from the guide line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum DriveSide {
    /// Beyond the line of the other resistances: locks above the critical friction.
    Beyond,
    /// On that line: nothing turns the body, the least disturbance does.
    Edge,
    /// Short of it: never locks.
    Short,
}

/// The guide of a scene and what it means for its drive. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Guide {
    /// Distance L of the two guiding contacts along the travel (m).
    pub length: f64,
    /// x of the guide line, in the middle between the two contacts (m).
    pub line_x: f64,
    /// Distance b of the drive from the guide line (m).
    pub drive_distance: f64,
    /// Distance b0 of the other resistances, which act at the centre of mass, from the guide line (m).
    pub resistance_distance: f64,
    /// The same up and down; `None` where the drive is at the height of the contacts.
    pub height: Option<Lever>,
    /// Which of the three cases it is.
    pub side: DriveSide,
    /// Critical coefficient of friction 1/(2·Σ b/L); `None` where the drive is on the guide line.
    pub critical_friction: Option<f64>,
    /// The scene's coefficient of friction.
    pub friction: f64,
    /// Whether the scene should be warned about: friction at or above the critical one, and not short.
    pub warn: bool,
}

/// A drive beside the two contacts that carry its moment, in one direction across the travel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Lever {
    /// Distance L of the contacts along the travel (m).
    pub length: f64,
    /// Distance b of the drive from the middle between them (m): negative where the drive, seen from the other resistances, is on
    /// its side.
    pub distance: f64,
    /// Coordinate of the middle between the contacts (m).
    #[serde(skip)]
    middle: f64,
    /// Whether the drive is on the line of the other resistances.
    #[serde(skip)]
    on_edge: bool,
}

impl Lever {
    /// b/L.
    fn ratio(&self) -> f64 {
        self.distance / self.length
    }
}

/// A contact that guides a body: where (m), the direction in which it pushes the body, and its gap (m).
#[derive(Clone, Copy, Debug)]
struct Contact {
    at: Vector3<f64>,
    push: Vector3<f64>,
    gap: f64,
}

/// A body, or several that move as one, on its contacts, pushed through a point along an axis in the direction of travel.
struct Guided<'a> {
    contacts: &'a [Contact],
    axis: Vector3<f64>,
    point: Vector3<f64>,
    centre: Vector3<f64>,
    gravity: Vector3<f64>,
    planar: bool,
}

impl Guided<'_> {
    /// The lever in the direction `across`, a unit vector; `None` where no pair of contacts carries a moment in it.
    fn lever(&self, across: Vector3<f64>) -> Option<Lever> {
        let drive = self.point.dot(&across);
        let off = drive - self.resistance(across);
        if off.abs() > SAME {
            return self.carried(across, off.signum(), drive);
        }
        // On the edge either turn is possible, and the one that locks sooner counts.
        let turns = [1.0, -1.0].into_iter().filter_map(|turn| self.carried(across, turn, drive));
        let worst = turns.max_by(|one, other| one.ratio().total_cmp(&other.ratio()))?;
        Some(Lever { on_edge: true, ..worst })
    }

    /// Where the other resistances act: at the contacts that the weight lies on where it presses in this direction, else at the centre
    /// of mass.
    fn resistance(&self, across: Vector3<f64>) -> f64 {
        let weight = self.gravity.dot(&across);
        let carry = self.contacts.iter().filter(|contact| contact.push.dot(&across) * weight < 0.0);
        let (sum, count) = carry.fold((0.0, 0.0), |(sum, count), contact| (sum + contact.at.dot(&across), count + 1.0));
        if count > 0.0 { sum / count } else { self.centre.dot(&across) }
    }

    /// The lever of the contacts that carry where the drive is on the positive side of the resistances (`turn` 1) or on the negative
    /// one (−1): the one ahead pushes to the drive's side, the one behind away from it.
    fn carried(&self, across: Vector3<f64>, turn: f64, drive: f64) -> Option<Lever> {
        let pushing =
            |sign: f64| self.contacts.iter().filter(move |contact| contact.push.dot(&across) * sign * turn > 0.5);
        let pairs: Vec<_> = pushing(1.0)
            .flat_map(|ahead| pushing(-1.0).map(move |behind| (ahead, behind)))
            .map(|(ahead, behind)| {
                let length = (ahead.at - behind.at).dot(&self.axis);
                let middle = (ahead.at + behind.at).dot(&across) / 2.0;
                ((ahead.gap + behind.gap) / length, length, middle)
            })
            .filter(|(_, length, _)| *length > SAME)
            .collect();
        let least = pairs.iter().map(|(angle, ..)| *angle).fold(f64::INFINITY, f64::min);
        let closed = pairs.iter().filter(|(angle, ..)| *angle <= least + SAME_TURN);
        let (length, middle, count) =
            closed.fold((0.0, 0.0, 0.0), |(l, m, count), (_, length, middle)| (l + length, m + middle, count + 1.0));
        (count > 0.0).then(|| {
            let middle = middle / count;
            Lever { length: length / count, distance: turn * (drive - middle), middle, on_edge: false }
        })
    }
}

/// Where the drive passes, and the critical coefficient of friction, of `levers` across each other. Forces add up in two contacts, or at
/// right angles in one that is `round`.
fn locking(levers: [Option<Lever>; 2], round: bool) -> (DriveSide, Option<f64>) {
    let levers = || levers.iter().flatten();
    let sum: f64 = levers().map(Lever::ratio).sum();
    let ratio = if round { libm::sqrt(levers().map(|lever| lever.ratio().max(0.0)).map(|r| r * r).sum()) } else { sum };
    let edge = levers().any(|lever| lever.on_edge && lever.ratio() > 0.0);
    let side = match () {
        () if sum <= 0.0 && ratio <= 0.0 => DriveSide::Short,
        () if edge => DriveSide::Edge,
        () => DriveSide::Beyond,
    };
    let size = if ratio == 0.0 { sum } else { ratio };
    (side, (size.abs() > 1e-9).then(|| 0.5 / size.abs()))
}

/// Finds the guide of `scene` at tolerance level `n`. `None` if no two pins, apart along the travel, guide it across.
pub fn guide(scene: &Scene, n: f64) -> Option<Guide> {
    let of_pin = |pin: &PinSpec| {
        let at = Vector3::from(pin.position);
        let gaps = pin.gaps.map(|gap| gap.map(|gap| gap.at(n)).filter(|gap| *gap < ABSENT));
        let surfaces = SURFACE_NORMALS.into_iter().zip(gaps);
        surfaces.filter_map(move |(normal, gap)| Some(Contact { at, push: -Vector3::from(normal), gap: gap? }))
    };
    let contacts: Vec<_> = scene.pins.iter().flat_map(of_pin).collect();
    let guided = Guided {
        contacts: &contacts,
        axis: Vector3::z() * direction(scene.drive.speed),
        point: scene.drive.point_b,
        centre: Vector3::zeros(),
        gravity: scene.slide.gravity.into(),
        planar: false,
    };
    let levers @ [across, height] = [Vector3::x(), Vector3::y()].map(|across| guided.lever(across));
    let across = across?;
    let (side, critical_friction) = locking(levers, false);
    let friction = scene.friction.coefficient();
    Some(Guide {
        length: across.length,
        line_x: across.middle,
        drive_distance: across.distance.abs(),
        resistance_distance: across.middle.abs(),
        height: height.filter(|lever| lever.distance.abs() > SAME),
        side,
        critical_friction,
        friction,
        warn: side != DriveSide::Short && critical_friction.is_some_and(|critical| friction >= critical),
    })
}

/// The direction of travel at a `speed` of the command.
fn direction(speed: f64) -> f64 {
    if speed < 0.0 { -1.0 } else { 1.0 }
}

/// A drive that pushes bodies along joints with play, but beside them, and locks them.
#[derive(Clone, Debug, PartialEq)]
pub struct Locked<'a> {
    /// The drive.
    pub drive: &'a str,
    /// The body that the joints hold.
    pub body: &'a str,
    /// What the joints join it to.
    pub on: &'a str,
    /// The angle (rad) of its push to the travel.
    pub angle: f64,
    /// How far the drive passes beside the contacts that carry its moment, in the directions in which it does, and how long they guide.
    pub levers: Vec<Lever>,
    /// Whether the drive is beyond the other resistances, or on the edge.
    pub side: DriveSide,
    /// Critical coefficient of friction.
    pub critical_friction: f64,
    /// The least coefficient of friction of the joints.
    pub friction: f64,
}

/// The drives of `mechanism` that lock a body in joints with play, all of which let it slide one way: the driven body, with all that is
/// fixed to it, on what carries it, and that, where it has such joints too, on what carries it in turn.
pub fn locked(mechanism: &Mechanism) -> Vec<Locked<'_>> {
    let mut all = Vec::new();
    for driven in &mechanism.drives {
        let Action::Pushes { axis } = driven.action else { continue };
        let push = Vector3::from(axis) * direction(driven.drive.speed);
        let point = Vector3::from(mechanism.bodies[driven.body].centre) + driven.drive.point_b;
        let (mut moving, mut last) = (mechanism.fixed_to(driven.body), driven.body);
        while let Some(travel) = travel(mechanism, &moving, push) {
            let Some(stage) = Stage::of(mechanism, &moving, travel) else { break };
            if let Some(levers) = stage.locks(mechanism, &moving, (travel, push), point) {
                let (side, critical) = levers.1;
                all.push(Locked {
                    drive: &driven.name,
                    body: mechanism.name_of(Some(last)),
                    on: mechanism.name_of(stage.on),
                    angle: push.cross(&travel).norm().atan2(push.dot(&travel)),
                    levers: levers.0,
                    side,
                    critical_friction: critical,
                    friction: stage.friction,
                });
            }
            let Some(next) = stage.on else { break };
            moving.extend(mechanism.fixed_to(next));
            last = next;
        }
    }
    all
}

impl Mechanism {
    /// The `body` and all that is fixed to it.
    fn fixed_to(&self, body: usize) -> Vec<usize> {
        let mut all = vec![body];
        let fixed = || self.joints.iter().filter(|joint| joint.kind == JointKind::Fixed);
        while let Some(next) = fixed().find_map(|joint| match joint.between {
            [Some(a), Some(b)] if all.contains(&a) != all.contains(&b) => Some(if all.contains(&a) { b } else { a }),
            _ => None,
        }) {
            all.push(next);
        }
        all
    }
}

/// Where the bodies `moving` go on their first joint with play that lets them slide, as far as a `push` moves them there.
fn travel(mechanism: &Mechanism, moving: &[usize], push: Vector3<f64>) -> Option<Vector3<f64>> {
    let is_moving = |port: Port| port.is_some_and(|body| moving.contains(&body));
    let guiding = mechanism.joints.iter().filter(|joint| is_moving(joint.between[0]) != is_moving(joint.between[1]));
    let axis = guiding.clone().find_map(|joint| match joint.kind {
        JointKind::Track { .. } => Some(Vector3::z()),
        JointKind::Bearing { axis, .. } | JointKind::Guide { axis, .. } => Some(Vector3::from(axis)),
        _ => None,
    })?;
    let along = axis.dot(&push);
    // What stands across the travel to within rounding moves nothing.
    (along.abs() > 1e-6).then(|| axis * along.signum())
}

/// What guides bodies that move as one.
struct Stage {
    /// What guides them.
    on: Port,
    contacts: Vec<Contact>,
    /// The least coefficient of friction of the joints.
    friction: f64,
    /// Whether all contacts are round.
    round: bool,
}

impl Stage {
    /// The joints that guide the bodies `moving` along the `axis` on one body or on the frame; `None` where there are none, or others.
    fn of(mechanism: &Mechanism, moving: &[usize], axis: Vector3<f64>) -> Option<Self> {
        let is_moving = |port: Port| port.is_some_and(|body| moving.contains(&body));
        let mut stage = Self { on: None, contacts: Vec::new(), friction: f64::INFINITY, round: true };
        let mut on = None;
        for joint in &mechanism.joints {
            let [first, second] = joint.between;
            if is_moving(first) == is_moving(second) {
                continue;
            }
            // What a contact does to its first body it does to the second the other way.
            let (sign, other) = if is_moving(first) { (1.0, second) } else { (-1.0, first) };
            let at = Vector3::from(joint.at);
            let gap = |gap: usize| mechanism.gaps[gap].statistics.mean;
            let before = stage.contacts.len();
            let mut add = |at, push: Vector3<f64>, gap| stage.contacts.push(Contact { at, push: push * sign, gap });
            match joint.kind {
                // It ends the travel, or the way back.
                JointKind::Stop { normal, .. } if Vector3::from(normal).cross(&axis).norm() < SAME => continue,
                JointKind::Stop { gap: of, normal } => add(at, normal.into(), gap(of)),
                JointKind::Track { gaps } if Vector3::z().cross(&axis).norm() < SAME => {
                    for (normal, of) in SURFACE_NORMALS.into_iter().zip(gaps) {
                        of.into_iter().for_each(|of| add(at, normal.into(), gap(of)));
                    }
                }
                JointKind::Bearing { gap: of, axis: along, length, .. }
                    if Vector3::from(along).cross(&axis).norm() < SAME =>
                {
                    for end in [-0.5, 0.5] {
                        for across in sideways(mechanism.planar, axis) {
                            for push in [across, -across] {
                                add(at + axis * (length * end), push, gap(of));
                            }
                        }
                    }
                }
                JointKind::Guide { gap: of, axis: along, edges: [length, width] }
                    if Vector3::from(along).cross(&axis).norm() < SAME =>
                {
                    for end in [-0.5, 0.5] {
                        for across in sideways(mechanism.planar, axis) {
                            for side in [0.5, -0.5] {
                                let corner = at + axis * (length * end) + across * (width * side);
                                add(corner, -across * side.signum(), gap(of));
                            }
                        }
                    }
                }
                _ => return None,
            }
            if *on.get_or_insert(other) != other {
                return None;
            }
            stage.round &= matches!(joint.kind, JointKind::Bearing { .. });
            if stage.contacts.len() > before {
                stage.friction = stage.friction.min(joint.laws.friction.coefficient());
            }
        }
        stage.on = on?;
        Some(stage)
    }

    /// The levers of a drive through `point` along `push`, and its case, if it locks the bodies `moving` on their travel along `axis`.
    fn locks(
        &self,
        mechanism: &Mechanism,
        moving: &[usize],
        (axis, push): (Vector3<f64>, Vector3<f64>),
        point: Vector3<f64>,
    ) -> Option<(Vec<Lever>, (DriveSide, f64))> {
        let bodies = || moving.iter().map(|body| &mechanism.bodies[*body]);
        let mass: f64 = bodies().map(|body| body.mass).sum();
        let centre = bodies().map(|body| Vector3::from(body.centre) * body.mass).sum::<Vector3<f64>>() / mass;
        let (gravity, planar) = (mechanism.gravity.into(), mechanism.planar);
        let guided = Guided { contacts: &self.contacts, axis, point, centre, gravity, planar };
        let mut levers = [None; 2];
        for (lever, across) in levers.iter_mut().zip(sideways(mechanism.planar, axis)) {
            *lever = guided.lever(across);
        }
        let (side, critical) = match push.cross(&axis).norm() > SAME {
            true => (DriveSide::Beyond, self.oblique(&guided, push, levers)),
            false => locking(levers, self.round),
        };
        let critical = critical.filter(|critical| side != DriveSide::Short && self.friction >= *critical)?;
        let beside = levers.into_iter().flatten().filter(|lever| lever.distance.abs() > SAME);
        Some((beside.collect(), (side, critical)))
    }
}

impl Stage {
    /// The critical friction of a body that is pushed at an angle to its travel. In each direction across it the contacts carry the share
    /// of the force there, or more where they oppose each other to carry its moment. What they carry of the moment of that share itself is
    /// left out: such bodies rattle more than they lock.
    fn oblique(&self, guided: &Guided, push: Vector3<f64>, levers: [Option<Lever>; 2]) -> Option<f64> {
        let along = push.dot(&guided.axis);
        let mut pressed = Vec::new();
        for (across, lever) in sideways(guided.planar, guided.axis).into_iter().zip(levers) {
            let force = push.dot(&across) / along;
            // Where nothing stands in its way the body leaves the guide.
            let stands = |contact: &Contact| contact.push.dot(&across) * force < -0.5 * force.abs();
            if force.abs() > SAME && !self.contacts.iter().any(stands) {
                return None;
            }
            pressed.push(force.abs().max(lever.map_or(0.0, |lever| 2.0 * lever.ratio())));
        }
        let squares = || pressed.iter().map(|force| force * force).sum();
        let sum = if self.round { libm::sqrt(squares()) } else { pressed.iter().sum() };
        (sum > 0.0).then(|| 1.0 / sum)
    }
}

/// The directions across an `axis`: one in a plane, two in space, where the axes of the frame are taken if it is one of them.
fn sideways(planar: bool, axis: Vector3<f64>) -> Vec<Vector3<f64>> {
    if planar {
        return vec![Vector3::new(-axis.y, axis.x, 0.0)];
    }
    let aside = if axis.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
    let first = (aside - axis * axis.dot(&aside)).normalize();
    vec![first, axis.cross(&first)]
}

#[cfg(test)]
mod tests {
    use super::{Lever, locked};
    use crate::scene::{Override, SceneFile, shipped};

    /// The carriage on two rods guides itself over 80 mm: with friction 0.3 it locks from 80/(2·0.3) mm beside its middle on,
    /// the 10 mm by which it is driven above the rods included.
    #[test]
    fn a_carriage_locks_where_its_drive_is_far_beside_it() {
        for (x, locks) in [("10", false), ("132", false), ("134", true), ("-134", true)] {
            let point = Override::set(&format!("drive.motor.point=[{x}, 0, 0]"));
            let file = SceneFile::parse("linear-guide", shipped("linear-guide").unwrap(), &[point]).unwrap();
            let found = file.mechanism.as_ref().map(locked).unwrap();
            assert_eq!(found.len(), usize::from(locks), "{x}");
            let length_is = |length: f64| move |lever: &Lever| (lever.length - length).abs() < 1e-12;
            assert!(
                found.iter().all(|locked| locked.levers.iter().all(length_is(0.08)) && locked.friction == 0.3),
                "{found:?}"
            );
        }
    }
}
