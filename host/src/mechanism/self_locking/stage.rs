//! Bodies of a mechanism on joints with play, one on another.

use nalgebra::Vector3;

use super::{Contact, DriveSide, Guided, Lever, SAME, direction, locking, sideways};
use crate::mechanism::{Action, JointKind, Mechanism, Port, mobility::SURFACE_NORMALS};

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
/// fixed to it, on what carries it, and that, where it has such joints too, on what carries that.
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
    let mut guiding =
        mechanism.joints.iter().filter(|joint| is_moving(joint.between[0]) != is_moving(joint.between[1]));
    let axis = guiding.find_map(|joint| match joint.kind {
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
                stage.friction = stage.friction.min(joint.laws.friction.holds());
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

    /// The critical friction of a body that is pushed at an angle to its travel. In each direction across it the contacts carry the share
    /// of the force there, or more where they oppose each other to carry its moment. What they carry of the moment of that share itself is
    /// left out: such bodies rattle more than they lock.
    fn oblique(&self, guided: &Guided, push: Vector3<f64>, levers: [Option<Lever>; 2]) -> Option<f64> {
        let along = push.dot(&guided.axis);
        let mut pressed = Vec::new();
        for (across, lever) in sideways(guided.planar, guided.axis).into_iter().zip(levers) {
            let force = push.dot(&across) / along;
            // Where no contact resists it the body leaves the guide.
            let resists = |contact: &Contact| contact.push.dot(&across) * force < -0.5 * force.abs();
            if force.abs() > SAME && !self.contacts.iter().any(resists) {
                return None;
            }
            pressed.push(force.abs().max(lever.map_or(0.0, |lever| 2.0 * lever.ratio())));
        }
        let squares = || pressed.iter().map(|force| force * force).sum();
        let sum = if self.round { libm::sqrt(squares()) } else { pressed.iter().sum() };
        (sum > 0.0).then(|| 1.0 / sum)
    }
}
#[cfg(test)]
mod tests {
    use super::locked;
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
            let length_is = |length: f64| move |lever: &super::Lever| (lever.length - length).abs() < 1e-12;
            assert!(
                found.iter().all(|locked| locked.levers.iter().all(length_is(0.08)) && locked.friction == 0.3),
                "{found:?}"
            );
        }
    }
}
