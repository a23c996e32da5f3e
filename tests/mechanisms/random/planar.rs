//! Random mechanisms in a plane: trees on ideal joints, joints with clearance that add bodies or close loops, stops, springs, drives.

use super::{
    dice::Dice,
    scene::{Body, Drive, Joint, Kind, Port, Scene, Spring, Vec3},
};

/// Most coordinates that slipfit has room for.
const COORDINATES: usize = 6;

/// The mechanism of a `seed`.
pub fn planar(seed: u64) -> Scene {
    let mut dice = Dice::new(seed);
    // Nothing holds the first body of such a mechanism, and no other is held by the frame.
    let is_afloat = dice.chance(0.08);
    let count = if is_afloat { 2 + dice.below(2) } else { 1 + dice.below(3) };
    let gravity = match dice.below(10) {
        0..4 => Vec3::new(0.0, -9.81, 0.0),
        4..7 => dice.direction(true) * 9.81,
        _ => Vec3::zeros(),
    };
    let duration = dice.within(0.05, 0.25);
    let mut scene = Scene {
        planar: true,
        gravity,
        bodies: Vec::new(),
        joints: Vec::new(),
        springs: Vec::new(),
        drives: Vec::new(),
        duration: (duration * 1e3).round() / 1e3,
    };
    let (mut coordinates, mut turning) = (0, Vec::new());
    for i in 0..count {
        let carrier = match i {
            0 => None,
            _ if is_afloat || dice.chance(0.6) => Some(dice.below(i)),
            _ => None,
        };
        let added = add_body(&mut scene, &mut dice, carrier, (COORDINATES - coordinates, is_afloat && i == 0));
        let Some((freedoms, turns)) = added else { break };
        coordinates += freedoms;
        if turns {
            turning.push(i);
        }
    }
    add_contacts(&mut scene, &mut dice, is_afloat);
    if dice.chance(0.35) && !turning.is_empty() {
        let one = dice.pick(&turning);
        let other = Some(dice.pick(&turning)).filter(|other| *other != one);
        if other.is_some() || !is_afloat {
            let between = if dice.chance(0.5) { [Some(one), other] } else { [other, Some(one)] };
            let damping = if dice.chance(0.5) { 0.0 } else { dice.log(1e-5, 3e-3) };
            scene.springs.push(Spring { between, stiffness: dice.log(0.01, 2.0), damping });
        }
    }
    // Something has to move.
    let rests = scene.gravity.norm() == 0.0 && scene.bodies.iter().all(|body| body.spin == 0.0 && body.speed == 0.0);
    if is_afloat && rests {
        scene.bodies[0].spin = dice.sign() * dice.log(1.0, 30.0);
    }
    if !is_afloat && (rests || dice.chance(0.6)) {
        add_drive(&mut scene, &mut dice, &turning);
    }
    scene
}

/// Adds a body on a joint that leaves at most `room` coordinates; gives how many, and whether it turns by itself.
fn add_body(
    scene: &mut Scene,
    dice: &mut Dice,
    carrier: Port,
    (room, is_free): (usize, bool),
) -> Option<(usize, bool)> {
    let body = scene.bodies.len();
    let near = carrier.map_or(Vec3::zeros(), |carrier| scene.bodies[carrier].centre);
    let at = near + dice.vector(0.04, true);
    let choice = if is_free { 0 } else { 1 + dice.below(20) };
    let ([freedoms, turns], kind, reach) = match choice {
        0 => ([3, 1], None, 0.04),
        1..=8 => ([1, 1], Some(Kind::Revolute(Vec3::z())), 0.05),
        9..=11 => ([1, 0], Some(Kind::Prismatic(dice.direction(true))), 0.02),
        12..=13 => ([2, 1], Some(Kind::PinSlot(dice.direction(true))), 0.05),
        14 if carrier.is_some() => ([0, 0], Some(Kind::Fixed), 0.04),
        14..=17 => ([3, 1], Some(Kind::Journal { gap: dice.clearance(), radius: dice.log(1e-3, 1e-2) }), 0.05),
        _ => {
            let gap = if dice.chance(0.2) { -dice.log(5e-7, 5e-6) } else { dice.clearance() };
            let edges = [dice.within(0.02, 0.08), dice.within(0.01, 0.04)];
            ([3, 0], Some(Kind::Guide { gap, axis: dice.direction(true), edges }), 0.01)
        }
    };
    if freedoms > room {
        return None;
    }
    let turns = turns == 1;
    let mass = dice.log(0.02, 0.5);
    let gyration = dice.log(0.01, 0.04);
    let slides = matches!(kind, Some(Kind::Prismatic(_) | Kind::PinSlot(_)));
    let is_ideal = kind.as_ref().is_some_and(Kind::is_ideal);
    let is_moving = dice.chance(0.5);
    let spin = if !(turns && is_moving) {
        0.0
    } else if is_ideal || is_free {
        dice.sign() * dice.log(1.0, 30.0)
    } else {
        dice.sign() * dice.log(0.5, 5.0)
    };
    let speed = if slides && is_moving { dice.sign() * dice.log(0.05, 1.0) } else { 0.0 };
    let angle = if is_ideal && turns && dice.chance(0.15) { dice.within(-1.5, 1.5) } else { 0.0 };
    scene.bodies.push(Body {
        name: format!("body {body}"),
        mass,
        inertia: Vec3::repeat(mass * gyration * gyration),
        centre: at + dice.vector(reach, true),
        angle,
        spin,
        speed,
    });
    if let Some(kind) = kind {
        let laws = (!kind.is_ideal()).then(|| dice.laws());
        let between = if dice.chance(0.5) { [carrier, Some(body)] } else { [Some(body), carrier] };
        scene.joints.push(Joint { name: format!("joint {body}"), between, at, kind, laws });
    }
    Some((freedoms, turns))
}

/// Adds stops, and now and then a journal that closes a loop.
fn add_contacts(scene: &mut Scene, dice: &mut Dice, is_afloat: bool) {
    let count = scene.bodies.len();
    let partner = |dice: &mut Dice, body: usize| -> Option<Port> {
        let other = Some(dice.below(count)).filter(|other| *other != body);
        if is_afloat { other.map(Some) } else { Some(other.filter(|_| dice.chance(0.5))) }
    };
    for stop in 0..dice.below(4) {
        let body = dice.below(count);
        let Some(other) = partner(dice, body) else { continue };
        let between = if dice.chance(0.6) { [Some(body), other] } else { [other, Some(body)] };
        let at = scene.bodies[body].centre + dice.vector(0.04, true);
        let kind = Kind::Stop { gap: dice.gap(), normal: dice.direction(true) };
        scene.joints.push(Joint { name: format!("stop {stop}"), between, at, kind, laws: Some(dice.laws()) });
    }
    if dice.chance(0.3) {
        let body = count - 1;
        let Some(other) = partner(dice, body) else { return };
        let between = if dice.chance(0.5) { [Some(body), other] } else { [other, Some(body)] };
        let at = scene.bodies[body].centre + dice.vector(0.05, true);
        let kind = Kind::Journal { gap: dice.clearance(), radius: dice.log(1e-3, 1e-2) };
        scene.joints.push(Joint { name: "loop".into(), between, at, kind, laws: Some(dice.laws()) });
    }
}

fn add_drive(scene: &mut Scene, dice: &mut Dice, turning: &[usize]) {
    let start = dice.within(0.0, 0.02);
    let ramp = [start, start + dice.log(0.01, 0.1)];
    let turns = !turning.is_empty() && dice.chance(0.6);
    let body = if turns { dice.pick(turning) } else { dice.below(scene.bodies.len()) };
    let Body { mass, inertia, .. } = scene.bodies[body];
    // Quick against the motion, and slow against the steps of an explicit method.
    let rate = dice.log(3.0, 1000.0);
    let (gain, speed) =
        if turns { (rate * inertia.z, dice.log(1.0, 40.0)) } else { (rate * mass, dice.log(0.05, 1.0)) };
    // Beside the centre of mass the drive's feedback may turn positive where the body turns.
    let point = if dice.chance(0.5) && !turning.contains(&body) { dice.vector(0.02, true) } else { Vec3::zeros() };
    let axis = if turns { Vec3::z() } else { dice.direction(true) };
    let speed = speed * dice.sign();
    scene.drives.push(Drive { body, turns, axis, point, at_centre: body.is_multiple_of(2), gain, ramp, speed });
}
