//! Where and how fast the bodies of a scene start: each follows the body that carries it by an ideal joint.

use nalgebra::{Matrix3, Rotation3};

use super::{
    forces::Placed,
    scene::{Body, Joint, Kind, Port, Scene, Vec3},
};

/// The bodies of `scene` at the start.
pub fn start(scene: &Scene) -> Vec<Placed> {
    let mut placed: Vec<Option<Placed>> = vec![None; scene.bodies.len()];
    let mut used = vec![false; scene.joints.len()];
    loop {
        let is_placed = |port: Port| port.is_none_or(|body| placed[body].is_some());
        let carried = scene
            .joints
            .iter()
            .enumerate()
            .find(|(i, joint)| !used[*i] && joint.kind.is_ideal() && joint.between.into_iter().any(is_placed));
        if let Some((i, joint)) = carried {
            used[i] = true;
            let [carrier, body] =
                if is_placed(joint.between[0]) { joint.between } else { [joint.between[1], joint.between[0]] };
            let at = carrier.map_or_else(Placed::frame, |carrier| placed[carrier].unwrap_or_else(Placed::frame));
            let drawn = carrier.map_or(Vec3::zeros(), |carrier| scene.bodies[carrier].centre);
            let Some(body) = body else { continue };
            placed[body] = Some(on_joint(scene, joint, body, (&at, drawn)));
        } else if let Some(free) = placed.iter().position(Option::is_none) {
            placed[free] = Some(afloat(&scene.bodies[free]));
        } else {
            return placed.into_iter().flatten().collect();
        }
    }
}

/// A body that no ideal joint holds.
fn afloat(body: &Body) -> Placed {
    Placed {
        place: body.centre,
        turned: turned(&Vec3::z(), body.angle),
        angle: body.angle,
        velocity: Vec3::zeros(),
        spin: Vec3::z() * body.spin,
    }
}

/// A body on its carrier, whose centre of mass is `drawn` in the drawn pose.
fn on_joint(scene: &Scene, joint: &Joint, index: usize, (carrier, drawn): (&Placed, Vec3)) -> Placed {
    let body = &scene.bodies[index];
    let at = carrier.place + carrier.turned * (joint.at - drawn);
    let axis = match joint.kind {
        Kind::Revolute(axis) | Kind::Prismatic(axis) | Kind::PinSlot(axis) | Kind::Cylindrical(axis) => axis,
        _ => Vec3::zeros(),
    };
    let turns = matches!(joint.kind, Kind::Revolute(_) | Kind::PinSlot(_) | Kind::Cylindrical(_));
    let [angle, spin] = if turns { [body.angle, body.spin] } else { [0.0; 2] };
    let along = carrier.turned * axis;
    // In a plane angles are those in the frame, in space those against the carrier.
    let (turned, angle, spin) = match (turns, scene.planar) {
        (true, true) => (turned(&Vec3::z(), angle), angle, Vec3::z() * spin),
        (true, false) => (turned(&along, angle) * carrier.turned, 0.0, carrier.spin + along * spin),
        (false, _) => (carrier.turned, carrier.angle, carrier.spin),
    };
    let lever = turned * (body.centre - joint.at);
    // A slot belongs to the first body, and turns with it.
    let has_slot = matches!(joint.kind, Kind::PinSlot(_)) && joint.between[0] == Some(index);
    let along = if has_slot { turned * axis } else { along };
    let velocity = carrier.material(&at) + along * body.speed + spin.cross(&lever);
    Placed { place: at + lever, turned, angle, velocity, spin }
}

fn turned(axis: &Vec3, angle: f64) -> Matrix3<f64> {
    Rotation3::from_scaled_axis(axis * angle).into_inner()
}
