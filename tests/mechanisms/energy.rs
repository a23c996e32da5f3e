//! What moves without friction, damping and drive keeps its energy. It is computed here from the motion alone, with geometry of
//! its own: kinetic, of height, of springs, of what is pressed in.

use nalgebra::{Matrix3, Rotation3, Vector3};
use slipfit::mechanism::{BodyMotion, Joint, JointKind, Mechanism, Moment, NormalData, SlidingData, film};
use slipfit_core::menu::ContactData;

use super::mechanism;

/// The shipped `scene` without anything that takes energy or gives it, moved by what it has or is given: a spin of its first body
/// (rad/s), gravity (m/s²).
fn conservative(scene: &str, spin: Option<f64>, gravity: [f64; 3]) -> Mechanism {
    let mut own = mechanism(scene, &[]);
    for joint in &mut own.joints {
        joint.laws.friction = SlidingData::NONE;
        let [stiffness, exponent] = joint.laws.contact.spring();
        let depth = 1e-5;
        joint.laws.contact = NormalData::Impact(ContactData { stiffness, exponent, damping: 0.0, depth });
    }
    own.springs.iter_mut().for_each(|spring| spring.damping = 0.0);
    own.drives.iter_mut().for_each(|drive| drive.drive.gain = 0.0);
    spin.into_iter().for_each(|spin| own.bodies[0].start.spin = spin);
    own.gravity = gravity;
    own.run.stroke = None;
    own.run.duration = 0.2;
    own
}

/// Where a point of a body, or of the frame, that is `at` (m) in the drawn pose has come to, and how the body is turned.
fn point(mechanism: &Mechanism, motions: &[BodyMotion], body: Option<usize>, at: Vector3<f64>) -> Vector3<f64> {
    body.map_or(at, |body| {
        let centre = Vector3::from(mechanism.bodies[body].centre);
        centre + motions[body].displacement + turned(motions, Some(body)) * (at - centre)
    })
}

fn turned(motions: &[BodyMotion], body: Option<usize>) -> Rotation3<f64> {
    body.map_or(Rotation3::identity(), |body| motions[body].orientation.to_rotation_matrix())
}

/// How deep (m) the contacts of a `joint` are pressed in; negative where they are open.
fn depths(mechanism: &Mechanism, motions: &[BodyMotion], joint: &Joint, gaps: &[f64]) -> Vec<f64> {
    let [first, second] = joint.between;
    let at = Vector3::from(joint.at);
    // From the second body's point to the first's, which are one in the drawn pose, in the axes of the second.
    let apart = |at: Vector3<f64>| {
        let from_second = point(mechanism, motions, first, at) - point(mechanism, motions, second, at);
        turned(motions, second).inverse() * from_second
    };
    match joint.kind {
        JointKind::Journal { gap, .. } => vec![apart(at).norm() - gaps[gap]],
        JointKind::Bearing { gap, axis, length, .. } => {
            let axis = Vector3::from(axis);
            let end = |side: f64| {
                let centre = point(mechanism, motions, first, at + axis * (0.5 * length * side));
                let from_rod = centre - point(mechanism, motions, second, at);
                from_rod.cross(&(turned(motions, second) * axis)).norm() - gaps[gap]
            };
            vec![end(-1.0), end(1.0)]
        }
        JointKind::Guide { gap, axis, edges: [long, wide] } => {
            let along = Vector3::from(axis);
            let across = Vector3::new(-along.y, along.x, 0.0);
            let corner = |(along_by, side): (f64, f64)| {
                let corner = at + along * (0.5 * long * along_by) + across * (0.5 * wide * side);
                side * across.dot(&apart(corner)) - gaps[gap]
            };
            [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(corner).into()
        }
        JointKind::Track { gaps: walls } => {
            let normals = [Vector3::x(), -Vector3::x(), -Vector3::y(), Vector3::y()];
            let depth = |(gap, normal): (Option<usize>, Vector3<f64>)| Some(-gaps[gap?] - normal.dot(&apart(at)));
            walls.into_iter().zip(normals).filter_map(depth).collect()
        }
        JointKind::Stop { gap, normal } => vec![-gaps[gap] - Vector3::from(normal).dot(&apart(at))],
        _ => vec![],
    }
}

/// Kinetic energy (J), and all other.
fn energies(mechanism: &Mechanism, gaps: &[f64], moment: &Moment) -> [f64; 2] {
    let motions = &moment.motions[..];
    let (mut kinetic, mut stored) = (0.0, 0.0);
    for (body, motion) in mechanism.bodies.iter().zip(motions) {
        let about = motion.orientation.to_rotation_matrix();
        let inertia = about * Matrix3::from_diagonal(&Vector3::from(body.inertia)) * about.inverse();
        kinetic += 0.5 * body.mass * motion.velocity.norm_squared() + 0.5 * motion.spin.dot(&(inertia * motion.spin));
        stored -= body.mass * Vector3::from(mechanism.gravity).dot(&motion.displacement);
    }
    for spring in &mechanism.springs {
        let [one, other] = spring.between.map(|body| body.map_or(0.0, |body| motions[body].turned.z));
        stored += 0.5 * spring.stiffness * (one - other) * (one - other);
    }
    for joint in &mechanism.joints {
        let [stiffness, exponent] = joint.laws.contact.spring();
        let pressed = depths(mechanism, motions, joint, gaps).into_iter().map(|depth| depth.max(0.0));
        stored += pressed.map(|depth| stiffness / (exponent + 1.0) * libm::pow(depth, exponent + 1.0)).sum::<f64>();
    }
    [kinetic, stored]
}

/// The greatest change of the energy over a run, as a share of the greatest kinetic energy, and how often something was pressed in.
fn drift(mechanism: &Mechanism) -> (f64, usize) {
    let gaps = mechanism.gaps_at(&[0.0]).unwrap();
    let moments = film(mechanism, &gaps, 600).unwrap().film;
    let energies: Vec<[f64; 2]> = moments.iter().map(|moment| energies(mechanism, &gaps, moment)).collect();
    let exchanged = energies.iter().map(|[kinetic, _]| *kinetic).fold(0.0, f64::max);
    let start: f64 = energies[0].iter().sum();
    let worst = energies.iter().map(|[kinetic, stored]| (kinetic + stored - start).abs()).fold(0.0, f64::max);
    let pressed = |moment: &Moment| {
        let joints = mechanism.joints.iter();
        joints.flat_map(|joint| depths(mechanism, &moment.motions, joint, &gaps)).any(|depth| depth > 0.0)
    };
    let touches = moments.windows(2).filter(|pair| !pressed(&pair[0]) && pressed(&pair[1])).count();
    (worst / exchanged, touches)
}

const DOWN: [f64; 3] = [0.0, -9.81, 0.0];
/// So that what slides along z comes to its stops.
const TILTED: [f64; 3] = [0.5, -9.81, 3.0];

#[test]
fn every_shipped_mechanism_keeps_its_energy() {
    let cases = [
        ("slider-crank", Some(40.0), DOWN),
        ("slider-crank-guide", Some(40.0), DOWN),
        ("four-bar", Some(20.0), DOWN),
        ("woodpecker-toy", None, DOWN),
        ("linear-guide", None, TILTED),
        ("telescopic-drawer", None, TILTED),
        ("hatch", None, TILTED),
        ("ball-rod", Some(20.0), TILTED),
    ];
    for (scene, spin, gravity) in cases {
        let (mut touches, mut drifts, mut gains) = (0, Vec::new(), Vec::new());
        // Touches make one run's error a matter of chance: it is ten times as large for starts that differ by a millionth.
        for factor in [0.95, 0.975, 1.0, 1.025, 1.05] {
            let mut own = conservative(scene, spin.map(|spin| spin * factor), gravity.map(|g| g * factor));
            let error = own.run.error;
            let mut at = |share: f64| {
                own.run.error = share * error;
                drift(&own)
            };
            let (found, touched) = at(1.0);
            touches += touched;
            drifts.push(found);
            gains.push(at(30.0).0 / at(1.0 / 30.0).0);
        }
        let (drift, gain) = (median(drifts), median(gains));
        println!(
            "{scene:20} {touches:3} touches, energy drifts by {drift:.1e}; \
             {gain:.0} times as much at 30 times the tolerance as at a thirtieth"
        );
        assert!(touches > 0 && drift < 5e-6, "{scene}: {touches} {drift:e}");
        // By 900 times, if it went by the tolerance alone.
        assert!(gain > 300.0, "{scene}: {gain}");
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// A double pendulum, thrown, for half a second: a slider-crank whose slider is not felt.
#[test]
fn a_double_pendulum_keeps_its_energy() {
    let mut own = conservative("slider-crank", Some(40.0), DOWN);
    for joint in &mut own.joints {
        joint.laws.contact =
            NormalData::Impact(ContactData { stiffness: 1e-9, exponent: 1.5, damping: 0.0, depth: 1e-5 });
    }
    own.run.duration = 0.5;
    let (found, _) = drift(&own);
    assert!(found < 2e-5, "{found:e}");
}
