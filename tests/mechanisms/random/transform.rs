//! The same mechanism described otherwise: what slipfit finds has to follow.

use super::{
    dice::Dice,
    motion::{Moved, Row},
    scene::{Drive, Kind, Loss, Port, Scene, Vec3},
    start::start,
};

/// Another description of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transform {
    /// Other names: the same bits.
    Renamed,
    /// Bodies and joints in another order, and the bodies of ideal joints exchanged.
    Reordered,
    /// Mirrored at x = 0.
    Mirrored,
    /// Masses, stiffnesses, dampings and gains times a factor: the same motion.
    Heavier,
    /// Lengths and times times a factor each.
    Scaled,
}

pub const ALL: [Transform; 5] =
    [Transform::Renamed, Transform::Reordered, Transform::Mirrored, Transform::Heavier, Transform::Scaled];

const MASS: f64 = 7.3;
const LENGTH: f64 = 1.7;
const TIME: f64 = 0.6;

impl Transform {
    /// The interval between rows, which was `every` (s).
    pub fn interval(self, every: f64) -> f64 {
        if self == Self::Scaled { TIME * every } else { every }
    }

    /// The scene described so, and its bodies' numbers in the old one.
    pub fn scene(self, scene: &Scene, seed: u64) -> (Scene, Vec<usize>) {
        let mut new = scene.clone();
        let same = (0..scene.bodies.len()).collect();
        match self {
            Self::Renamed => {
                new.bodies.iter_mut().rev().enumerate().for_each(|(i, body)| body.name = format!("Teil {i}"));
                new.joints.iter_mut().enumerate().for_each(|(i, joint)| joint.name = format!("Gelenk {i}"));
            }
            Self::Reordered => return reordered(scene, seed),
            Self::Mirrored => mirror(&mut new),
            Self::Heavier => scale(&mut new, [MASS, 1.0, 1.0]),
            Self::Scaled => scale(&mut new, [1.0, LENGTH, TIME]),
        }
        (new, same)
    }

    /// The motion of the new scene by that of the old one, `scene`.
    pub fn rows(self, scene: &Scene, rows: &[Row], order: &[usize]) -> Vec<Row> {
        let polar = |v: Vec3| Vec3::new(-v.x, v.y, v.z);
        let axial = |v: Vec3| Vec3::new(v.x, -v.y, -v.z);
        let moved = |m: &Moved| match self {
            Self::Mirrored => {
                Moved { shift: polar(m.shift), turn: axial(m.turn), velocity: polar(m.velocity), spin: axial(m.spin) }
            }
            Self::Scaled => Moved {
                shift: m.shift * LENGTH,
                turn: m.turn,
                velocity: m.velocity * (LENGTH / TIME),
                spin: m.spin / TIME,
            },
            _ => *m,
        };
        let effort = |(effort, drive): (&f64, &Drive)| match self {
            Self::Heavier => MASS * effort,
            Self::Scaled => effort * LENGTH * if drive.turns { LENGTH } else { 1.0 } / (TIME * TIME),
            // In a plane the axis of a torque cannot be mirrored.
            Self::Mirrored if scene.planar && drive.turns => -effort,
            _ => *effort,
        };
        let row = |row: &Row| Row {
            t: self.interval(row.t),
            efforts: row.efforts.iter().zip(&scene.drives).map(effort).collect(),
            bodies: order.iter().map(|body| moved(&row.bodies[*body])).collect(),
        };
        rows.iter().map(row).collect()
    }
}

fn mirror(scene: &mut Scene) {
    let flip = |v: &mut Vec3| v.x = -v.x;
    // Axes of rotation turn the other way round unless they lie along x.
    let flip_axis = |v: &mut Vec3| (v.y, v.z) = (-v.y, -v.z);
    flip(&mut scene.gravity);
    for body in &mut scene.bodies {
        flip(&mut body.centre);
        if scene.planar {
            (body.angle, body.spin) = (-body.angle, -body.spin);
        }
    }
    for joint in &mut scene.joints {
        flip(&mut joint.at);
        match &mut joint.kind {
            Kind::Revolute(axis) if !scene.planar => flip_axis(axis),
            Kind::Cylindrical(axis) => {
                // Along its axis the body slides against the mirrored direction: then both speeds keep their signs only if the axis
                // is mirrored as a direction and the angle is negated.
                flip(axis);
                // The one that hangs on the other has the higher number.
                if let Some(body) = joint.between.into_iter().flatten().max() {
                    let body = &mut scene.bodies[body];
                    (body.angle, body.spin) = (-body.angle, -body.spin);
                }
            }
            Kind::Prismatic(axis) | Kind::PinSlot(axis) | Kind::Guide { axis, .. } | Kind::Bearing { axis, .. } => {
                flip(axis);
            }
            Kind::Stop { normal, .. } => flip(normal),
            Kind::Track([left, right, ..]) => std::mem::swap(left, right),
            _ => {}
        }
    }
    for drive in &mut scene.drives {
        flip(&mut drive.point);
        match (drive.turns, scene.planar) {
            (true, true) => drive.speed = -drive.speed,
            (true, false) => flip_axis(&mut drive.axis),
            (false, _) => flip(&mut drive.axis),
        }
    }
}

fn scale(scene: &mut Scene, [mass, length, time]: [f64; 3]) {
    let speed = length / time;
    let force = mass * length / (time * time);
    scene.gravity *= length / (time * time);
    scene.duration *= time;
    for body in &mut scene.bodies {
        body.mass *= mass;
        body.inertia *= mass * length * length;
        body.centre *= length;
        body.spin /= time;
        body.speed *= speed;
    }
    for joint in &mut scene.joints {
        joint.at *= length;
        match &mut joint.kind {
            Kind::Journal { gap, radius } => (*gap, *radius) = (*gap * length, *radius * length),
            Kind::Guide { gap, edges, .. } => {
                *gap *= length;
                edges.iter_mut().for_each(|edge| *edge *= length);
            }
            Kind::Bearing { gap, length: along, radius, .. } => {
                (*gap, *along, *radius) = (*gap * length, *along * length, *radius * length);
            }
            Kind::Track(gaps) => gaps.iter_mut().flatten().for_each(|gap| *gap *= length),
            Kind::Stop { gap, .. } => *gap *= length,
            _ => {}
        }
        let Some(laws) = &mut joint.laws else { continue };
        laws.stiffness *= force / libm::pow(length, laws.exponent);
        match &mut laws.loss {
            Loss::Impact { damping, depth } => (*damping, *depth) = (*damping * force / speed, *depth * length),
            Loss::HuntCrossley { speed: of, .. } | Loss::LankaraniNikravesh { speed: of, .. } => *of *= speed,
        }
        if let Some([_, band]) = &mut laws.friction {
            *band *= speed;
        }
    }
    for spring in &mut scene.springs {
        spring.stiffness *= force * length;
        spring.damping *= force * length * time;
    }
    for drive in &mut scene.drives {
        drive.point *= length;
        drive.ramp = drive.ramp.map(|t| t * time);
        let turns = drive.turns;
        drive.gain *= if turns { force * length * time } else { force / speed };
        drive.speed *= if turns { 1.0 / time } else { speed };
    }
}

/// Where nothing ideal holds a body on the frame, the order of the bodies can decide what its start means: there it is kept.
fn reordered(scene: &Scene, seed: u64) -> (Scene, Vec<usize>) {
    let mut dice = Dice::new(seed ^ 0x5eed);
    let mut shuffled = |count: usize| {
        let mut order: Vec<usize> = (0..count).collect();
        (1..count).rev().for_each(|i| order.swap(i, dice.below(i + 1)));
        order
    };
    let (mut order, joints) = (shuffled(scene.bodies.len()), shuffled(scene.joints.len()));
    let mut new = in_order(scene, &order, &joints);
    let (old_start, new_start) = (start(scene), start(&new));
    // What hangs on what may depend on the order, and with it whose start is relative to whom.
    let differs = |(i, body): (usize, &usize)| {
        let (old, new) = (&old_start[*body], &new_start[i]);
        let moved = (old.velocity - new.velocity).norm() + (old.spin - new.spin).norm();
        moved + (old.place - new.place).norm() + (old.turned - new.turned).norm() > 1e-12
    };
    if order.iter().enumerate().any(differs) {
        order.sort_unstable();
        new = in_order(scene, &order, &joints);
    }
    (new, order)
}

fn in_order(scene: &Scene, order: &[usize], joints: &[usize]) -> Scene {
    let mut new = scene.clone();
    let number = |old: usize| order.iter().position(|body| *body == old).unwrap_or(old);
    let port = |port: Port| port.map(number);
    new.bodies = order.iter().map(|body| scene.bodies[*body].clone()).collect();
    new.joints = joints.iter().map(|joint| scene.joints[*joint].clone()).collect();
    for joint in &mut new.joints {
        joint.between = joint.between.map(port);
        // A pin-slot's axis is that of its first body.
        if joint.kind.is_ideal() && !matches!(joint.kind, Kind::PinSlot(_)) {
            joint.between.reverse();
        }
    }
    for spring in &mut new.springs {
        spring.between = spring.between.map(port);
        spring.between.reverse();
    }
    new.drives.iter_mut().for_each(|drive| drive.body = number(drive.body));
    new
}
