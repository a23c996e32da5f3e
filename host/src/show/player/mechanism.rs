//! A mechanism of bodies and joints for the player: bodies at true scale, pins enlarged in their gaps.

use super::{AXES, Body, Event, MM, Motion, Plot, Run, View, events, hull::hull, joints::joints, rounded, series};
use crate::{
    dynamics::driven::Driven,
    mechanism::{Body as Drawn, BodyMotion, ByDrive, JointKind, Mechanism, MechanismRun, Moment},
};

/// How far a body is drawn beyond its joints, as a share of the mechanism's size.
const RIM: f64 = 0.025;
/// A `run` of the unit of a `mechanism` with these `gaps` (m), `driven` by one of its drives if it has any; its `label` tells it
/// from other runs.
pub fn run(mechanism: &Mechanism, driven: Option<&ByDrive>, gaps: &[f64], label: String, run: &MechanismRun) -> Run {
    let moments = &run.film[..];
    let views = match mechanism.planar {
        true => vec![View { name: "in its plane", axes: ["x", "y"] }],
        false => {
            vec![View { name: "from the front", axes: ["x", "y"] }, View { name: "from the side", axes: ["z", "y"] }]
        }
    };
    let rim = RIM * size(mechanism);
    let bodies = mechanism.bodies.iter().enumerate();
    let (plots, events) = driven.map(|driven| of_drive(driven, run)).unwrap_or_default();
    Run {
        title: mechanism.title.clone(),
        label,
        t: series(moments, 3, |moment| moment.t * MM),
        bodies: bodies.map(|(i, body)| drawn(mechanism, i, body, moments, &views, rim)).collect(),
        views,
        joints: mechanism.joints.iter().flat_map(|joint| joints(mechanism, joint, gaps, moments)).collect(),
        plots,
        events,
        from: driven.map_or(0.0, |driven| rounded(driven.drive().ramp_start * MM, 3)),
    }
}

/// What a drive does, and when.
fn of_drive(driven: &ByDrive, run: &MechanismRun) -> (Vec<Plot>, Vec<Event>) {
    let (mechanism, moments) = (driven.mechanism(), &run.film[..]);
    let kind = driven.kind();
    let sign = if driven.drive().speed < 0.0 { -1.0 } else { 1.0 };
    let at_drive = |of: &dyn Fn(f64, f64) -> f64, digits| {
        series(moments, digits, |moment| {
            let at = mechanism.drives_at(moment.t, &moment.motions).nth(driven.index());
            at.map_or(0.0, |at| sign * of(moment.efforts[driven.index()], at.vz))
        })
    };
    let force = Plot {
        name: kind.choose("drive force", "drive torque"),
        unit: kind.effort_unit(),
        values: at_drive(&|force, _| force, 4),
    };
    let speed = Plot { name: "speed", unit: kind.speed_unit(), values: at_drive(&|_, speed| kind.speed(speed), 3) };
    (vec![force, speed], events(&run.outcomes[driven.index()]))
}

/// The longest edge (m) of the box around all bodies and joints.
fn size(mechanism: &Mechanism) -> f64 {
    let places =
        || mechanism.bodies.iter().map(|body| body.centre).chain(mechanism.joints.iter().map(|joint| joint.at));
    let edge = |k: usize| {
        let [low, high] = places().fold([f64::MAX, f64::MIN], |[low, high], at| [low.min(at[k]), high.max(at[k])]);
        high - low
    };
    (0..3).map(edge).fold(1e-3, f64::max)
}

/// Body `i`: what encloses its centre and its joints in every view.
fn drawn(mechanism: &Mechanism, i: usize, body: &Drawn, moments: &[Moment], views: &[View], rim: f64) -> Body {
    let own = mechanism.joints.iter().filter(|joint| joint.between.contains(&Some(i)));
    let mut places: Vec<[f64; 3]> = vec![body.centre];
    for joint in own {
        places.push(joint.at);
        // What the joint itself says of the body's shape.
        let extended =
            |axis: [f64; 3], half: f64| [-half, half].map(|by| std::array::from_fn(|k| joint.at[k] + by * axis[k]));
        match joint.kind {
            JointKind::Guide { axis, edges, .. } if joint.between[0] == Some(i) => {
                places.extend(extended(axis, edges[0] / 2.0))
            }
            JointKind::Bearing { axis, length, .. } if joint.between[0] == Some(i) => {
                places.extend(extended(axis, length / 2.0))
            }
            _ => {}
        }
    }
    let outline = |view: &View| {
        let axes = view.axes.map(|letter| AXES.iter().position(|axis| *axis == letter).unwrap_or(0));
        let seen: Vec<[f64; 2]> = places.iter().map(|place| axes.map(|k| place[k])).collect();
        let corner = |[right, up]: [f64; 2]| {
            let mut place = body.centre;
            (place[axes[0]], place[axes[1]]) = (right, up);
            place.map(|x| rounded(x * MM, 2))
        };
        hull(&seen, rim).into_iter().map(corner).collect()
    };
    let part = |of: &dyn Fn(&BodyMotion) -> f64, digits| Some(series(moments, digits, |moment| of(&moment.motions[i])));
    Body {
        name: body.name.clone(),
        at: body.centre.map(|x| x * MM),
        outline: views.iter().map(outline).collect(),
        travel: Motion {
            x: part(&|motion| motion.displacement.x * MM, 4),
            y: part(&|motion| motion.displacement.y * MM, 4),
            z: part(&|motion| motion.displacement.z * MM, 4),
            ax: part(&|motion| motion.turn().x, 6),
            ay: part(&|motion| motion.turn().y, 6),
            az: part(&|motion| motion.turn().z, 6),
        },
        ..Body::default()
    }
}

#[cfg(test)]
mod tests {
    use super::{MM, run};
    use crate::{
        mechanism::{ByDrive, film},
        scene::{SHIPPED, SceneFile},
        show::player::{Run, figure},
    };

    fn played(name: &str, ending: f64) -> (Run, f64) {
        let text = SHIPPED.iter().find(|(own, _)| *own == name).unwrap().1;
        let mut mechanism = SceneFile::parse(name, text, &[]).unwrap().mechanism.unwrap();
        mechanism.run.duration = ending;
        let gaps = mechanism.stated_gaps_at(&[0.0]);
        let driven = ByDrive::new(&mechanism, 0).unwrap();
        let weight = mechanism.bodies.iter().map(|body| body.mass).sum::<f64>() * 9.81;
        (run(&mechanism, Some(&driven), &gaps, "n = 0".into(), &film(&mechanism, &gaps, 200).unwrap()), weight)
    }

    /// Every pin is where its gap lets it be, as far as its force presses it in.
    #[test]
    fn pins_stay_in_their_gaps() {
        for (name, joints) in [("slider-crank", 1), ("slider-crank-guide", 2), ("hatch", 6), ("telescopic-drawer", 12)]
        {
            let (run, _) = played(name, 0.3);
            assert!(run.joints.len() >= joints, "{name}: {}", run.joints.len());
            for joint in &run.joints {
                for frame in 0..run.t.0.len() {
                    let pin = [0, 1].map(|k| joint.pin[k].0[frame]);
                    let force = joint.contacts.iter().map(|contact| contact.force.0[frame]).fold(0.0, f64::max);
                    let outside = match joint.round {
                        true => libm::hypot(pin[0], pin[1]) - joint.limits[1].unwrap(),
                        false => (0..4)
                            .filter_map(|k| Some((joint.limits[k]?, if k % 2 == 0 { -1.0 } else { 1.0 }, pin[k / 2])))
                            .map(|(limit, sign, pin)| sign * (pin - limit))
                            .fold(0.0, f64::max),
                    };
                    assert!(outside < 0.1, "{name}, {}: {outside} mm", joint.name);
                    assert!(outside < 2e-4 || force > 0.0, "{name}, {}: {outside} mm without force", joint.name);
                }
            }
            figure(&[run], "Caption").unwrap();
        }
    }

    /// What carries the bodies is their weight.
    #[test]
    fn forces_carry_the_weight() {
        let (run, weight) = played("telescopic-drawer", 1.0);
        let last = run.t.0.len() - 1;
        let upwards = |side: &str| {
            let outer = run.joints.iter().filter(|joint| joint.name.starts_with("outer") && joint.limits[3].is_some());
            let contacts = outer.flat_map(|joint| &joint.contacts).filter(|contact| contact.side == side);
            contacts.map(|contact| contact.force.0[last]).sum::<f64>()
        };
        let carried = upwards("high") - upwards("low");
        assert!((carried / weight - 1.0).abs() < 0.03, "{carried} {weight} at {} ms", run.t.0[last] / MM * MM);
    }
}
