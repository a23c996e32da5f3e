//! Random mechanisms in space: free bodies on pins, rods and stops; and trees on ideal joints with such contacts.

use super::{
    dice::Dice,
    scene::{Body, Drive, Joint, Kind, Port, Scene, Vec3},
};

/// Most bodies, and coordinates of bodies on ideal joints, that slipfit has room for.
const BODIES: usize = 3;
const COORDINATES: usize = 14;

/// Free bodies, each held by contacts of one kind against the frame or the body before.
pub fn free(seed: u64) -> Scene {
    let mut dice = Dice::new(seed);
    let mut scene = empty(&mut dice);
    let count: usize = if dice.chance(0.65) { 1 } else { 2 };
    for body in 0..count {
        let on = body.checked_sub(1).filter(|_| dice.chance(0.7));
        let centre = on.map_or(Vec3::zeros(), |on| scene.bodies[on].centre) + dice.vector(0.02, false);
        add_body(&mut scene, &mut dice, centre);
        match dice.below(3) {
            0 => add_pins(&mut scene, &mut dice, [body.into(), on]),
            1 => add_rods(&mut scene, &mut dice, [body.into(), on]),
            _ => add_box(&mut scene, &mut dice, [body.into(), on]),
        }
        add_stops(&mut scene, &mut dice, 2);
    }
    add_drive(&mut scene, &mut dice);
    scene
}

/// Bodies on ideal joints, with stops, pins and rods between them.
pub fn jointed(seed: u64) -> Scene {
    let mut dice = Dice::new(seed);
    let mut scene = empty(&mut dice);
    let mut coordinates = 0;
    for body in 0..1 + dice.below(BODIES) {
        let carrier = if body > 0 && dice.chance(0.6) { Some(dice.below(body)) } else { None };
        let at = carrier.map_or(Vec3::zeros(), |on| scene.bodies[on].centre) + dice.vector(0.04, false);
        let axis = dice.direction(false);
        let (freedoms, kind) = match dice.below(12) {
            0..=3 => (1, Some(Kind::Revolute(axis))),
            4 | 5 => (1, Some(Kind::Prismatic(axis))),
            6 | 7 => (2, Some(Kind::Cylindrical(axis))),
            8 | 9 => (3, Some(Kind::Spherical)),
            10 if carrier.is_some() => (0, Some(Kind::Fixed)),
            // The first has an ideal joint, so that the mechanism is none of free bodies.
            _ if body == 0 => (1, Some(Kind::Revolute(axis))),
            _ => (6, None),
        };
        if coordinates + freedoms > COORDINATES {
            break;
        }
        coordinates += freedoms;
        let centre = at + dice.vector(0.03, false);
        add_body(&mut scene, &mut dice, centre);
        let Some(kind) = kind else {
            add_box(&mut scene, &mut dice, [body.into(), carrier]);
            continue;
        };
        let [slides, turns] = match kind {
            Kind::Revolute(_) => [false, true],
            Kind::Prismatic(_) => [true, false],
            Kind::Cylindrical(_) => [true, true],
            _ => [false, false],
        };
        let started = &mut scene.bodies[body];
        if turns && dice.chance(0.6) {
            started.spin = dice.sign() * dice.log(1.0, 20.0);
        }
        if turns && dice.chance(0.15) {
            started.angle = dice.within(-1.5, 1.5);
        }
        if slides && dice.chance(0.6) {
            started.speed = dice.sign() * dice.log(0.05, 1.0);
        }
        let between = if dice.chance(0.5) { [carrier, body.into()] } else { [body.into(), carrier] };
        scene.joints.push(Joint { name: format!("joint {body}"), between, at, kind, laws: None });
    }
    add_stops(&mut scene, &mut dice, 4);
    let last = scene.bodies.len() - 1;
    if dice.chance(0.25) {
        add_pins(&mut scene, &mut dice, [last.into(), None]);
    } else if dice.chance(0.25) {
        add_rods(&mut scene, &mut dice, [last.into(), None]);
    }
    add_drive(&mut scene, &mut dice);
    scene
}

fn empty(dice: &mut Dice) -> Scene {
    let gravity = match dice.below(10) {
        0..5 => Vec3::new(0.0, -9.81, 0.0),
        5..9 => dice.direction(false) * 9.81,
        _ => Vec3::zeros(),
    };
    let duration = (dice.within(0.03, 0.15) * 1e3).round() / 1e3;
    let (bodies, joints, springs, drives) = Default::default();
    Scene { planar: false, gravity, bodies, joints, springs, drives, duration }
}

fn add_body(scene: &mut Scene, dice: &mut Dice, centre: Vec3) {
    let mass = dice.log(0.03, 0.8);
    // Of a box with these edges.
    let edges = Vec3::new(dice.log(0.02, 0.12), dice.log(0.02, 0.12), dice.log(0.02, 0.12));
    let squares = edges.component_mul(&edges);
    let inertia = squares.map(|square| (squares.sum() - square) * mass / 12.0);
    let name = format!("body {}", scene.bodies.len());
    scene.bodies.push(Body { name, mass, inertia, centre, angle: 0.0, spin: 0.0, speed: 0.0 });
}

/// Where a joint of the first of two bodies is.
fn near(scene: &Scene, [body, _]: [Port; 2]) -> Vec3 {
    body.map_or(Vec3::zeros(), |body| scene.bodies[body].centre)
}

fn add(scene: &mut Scene, dice: &mut Dice, between: [Port; 2], at: Vec3, kind: Kind) {
    let between = if dice.chance(0.5) { between } else { [between[1], between[0]] };
    let name = format!("contact {}", scene.joints.len());
    scene.joints.push(Joint { name, between, at, kind, laws: Some(dice.laws()) });
}

/// Up to four pins between walls, along z.
fn add_pins(scene: &mut Scene, dice: &mut Dice, between: [Port; 2]) {
    let centre = near(scene, between);
    let half = Vec3::new(dice.within(0.01, 0.06), dice.within(-0.01, 0.01), dice.within(0.01, 0.04));
    let corners = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
    let missing = dice.below(12);
    // The pins belong to one body, or their walls would not be parallel parts of one.
    let between = if dice.chance(0.5) { between } else { [between[1], between[0]] };
    for (i, [x, z]) in corners.into_iter().enumerate().filter(|(i, _)| *i != missing) {
        let gap = |dice: &mut Dice| {
            let gap = if dice.chance(0.2) { -dice.log(5e-7, 1e-5) } else { dice.clearance() };
            Some(gap).filter(|_| dice.chance(0.95))
        };
        let gaps = [gap(dice), gap(dice), gap(dice), gap(dice)];
        if gaps.iter().all(Option::is_none) {
            continue;
        }
        let at = centre + half.component_mul(&Vec3::new(x, 1.0, z));
        let name = format!("pin {} {i}", scene.joints.len());
        scene.joints.push(Joint { name, between, at, kind: Kind::Track(gaps), laws: Some(dice.laws()) });
    }
}

/// Bearings on one or two parallel rods.
fn add_rods(scene: &mut Scene, dice: &mut Dice, between: [Port; 2]) {
    let axis = dice.direction(false);
    let aside = axis.cross(&dice.vector(1.0, false)).normalize();
    let count = 1 + dice.below(3);
    let centre = near(scene, between);
    let between = if dice.chance(0.5) { between } else { [between[1], between[0]] };
    let (gap, radius) = (dice.clearance(), dice.log(1e-3, 1e-2));
    for bearing in 0..count {
        let along = axis * dice.within(-0.03, 0.03);
        let at = centre + along + aside * if bearing % 2 == 0 { 0.03 } else { -0.03 };
        let kind = Kind::Bearing { gap, axis, length: dice.within(0.005, 0.03), radius };
        let name = format!("bearing {}", scene.joints.len());
        scene.joints.push(Joint { name, between, at, kind, laws: Some(dice.laws()) });
    }
}

/// Stops on all sides.
fn add_box(scene: &mut Scene, dice: &mut Dice, between: [Port; 2]) {
    let centre = near(scene, between);
    for axis in [Vec3::x(), Vec3::y(), Vec3::z()] {
        for normal in [axis, -axis] {
            let at = centre + dice.vector(0.03, false);
            let gap = if dice.chance(0.15) { -dice.log(5e-7, 1e-5) } else { dice.log(5e-5, 5e-3) };
            add(scene, dice, between, at, Kind::Stop { gap, normal });
        }
    }
}

/// Up to `most` stops of any two bodies.
fn add_stops(scene: &mut Scene, dice: &mut Dice, most: usize) {
    for _ in 0..dice.below(most + 1) {
        let body = dice.below(scene.bodies.len());
        let other = Some(dice.below(scene.bodies.len())).filter(|other| *other != body);
        let between = [Some(body), other.filter(|_| dice.chance(0.5))];
        let at = near(scene, between) + dice.vector(0.04, false);
        let kind = Kind::Stop { gap: dice.gap(), normal: dice.axis(false) };
        add(scene, dice, between, at, kind);
    }
}

fn add_drive(scene: &mut Scene, dice: &mut Dice) {
    if scene.gravity.norm() > 0.0 && dice.chance(0.35) {
        return;
    }
    let body = dice.below(scene.bodies.len());
    let turns = dice.chance(0.35);
    let start = dice.within(0.0, 0.02);
    let ramp = [start, start + dice.log(0.01, 0.1)];
    let Body { mass, inertia, .. } = scene.bodies[body];
    let rate = dice.log(3.0, 500.0);
    let (gain, speed) =
        if turns { (rate * inertia.min(), dice.log(0.5, 20.0)) } else { (rate * mass, dice.log(0.05, 0.5)) };
    // Beside the centre of mass the drive's feedback may turn positive where the body turns freely.
    let is_held = scene.joints.iter().any(|joint| joint.between.contains(&Some(body)) && !joint.kind.is_ideal());
    let point = if !turns && is_held && dice.chance(0.5) { dice.vector(0.01, false) } else { Vec3::zeros() };
    let axis = dice.direction(false);
    scene.drives.push(Drive {
        body,
        turns,
        axis,
        point,
        at_centre: body.is_multiple_of(2),
        gain,
        ramp,
        speed: speed * dice.sign(),
    });
}
