//! A slide on its pins for the player.

use slipfit_core::{law::Elastic, slide::ABSENT};

use super::{Body, Contact, Joint, MM, Motion, Plot, Run, Series, View, events, rounded};
use crate::{
    dynamics::{
        film::{Film, Frame},
        laws::AnyElastic,
    },
    setup::{SURFACES, Scene},
};

/// How far (mm) the slide is drawn beyond its pins at least.
const RIM: f64 = 10.0;
/// What sides the surfaces of a slot are of its pin; the rail lies on the pin.
const SIDES: [&str; 4] = ["left", "right", "high", "low"];
/// Name of the moving body, and of what carries the pins.
const SLIDE: &str = "slide";
const FRAME: &str = "frame";

/// A `film` of the slide of `scene`, whose `label` tells it from other runs.
pub fn run(scene: &Scene, label: String, film: &Film) -> Run {
    let frames = &film.frames;
    let sign = if scene.drive.speed < 0.0 { -1.0 } else { 1.0 };
    Run {
        title: scene.title.clone(),
        label,
        t: series(frames, 3, |frame| frame.t * MM),
        views: vec![View { name: "from above", axes: ["x", "-z"] }, View { name: "from the front", axes: ["x", "y"] }],
        bodies: vec![slide(scene, frames)],
        joints: (0..scene.pins.len()).map(|pin| joint(scene, frames, pin)).collect(),
        plots: vec![
            Plot {
                name: "drive force",
                unit: "N",
                values: series(frames, 4, |frame| sign * scene.drive.force(frame.t, frame.vz)),
            },
            Plot { name: "speed", unit: "mm/s", values: series(frames, 3, |frame| sign * frame.vz * MM) },
        ],
        events: events(&film.outcome),
        from: rounded(scene.drive.ramp_start * MM, 3),
    }
}

fn slide(scene: &Scene, frames: &[Frame]) -> Body {
    let [wide, high, long] = scene.slide.inertia_box.map(|edge| 0.5 * edge * MM);
    let beyond = |axis: usize| scene.pins.iter().map(|pin| pin.position[axis].abs() * MM + RIM).fold(0.0, f64::max);
    let [x, y, z] = [wide.max(beyond(0)), high, long.max(beyond(2))].map(|half| rounded(half, 1));
    let across = |y: f64| vec![[-x, y, -z], [x, y, -z], [x, y, z], [-x, y, z]];
    let upright = |z: f64| vec![[-x, -y, z], [x, -y, z], [x, y, z], [-x, y, z]];
    let part = |digits, of: &dyn Fn(&Frame) -> f64| Some(series(frames, digits, of));
    Body {
        name: SLIDE.into(),
        outline: vec![across(y), across(-y), upright(z), upright(-z)],
        travel: Motion { z: part(3, &|frame| frame.displacement[2] * MM), ..Motion::default() },
        sway: Motion {
            x: part(5, &|frame| frame.displacement[0] * MM),
            y: part(5, &|frame| frame.displacement[1] * MM),
            ax: part(8, &|frame| frame.turn[0]),
            ay: part(8, &|frame| frame.turn[1]),
            az: part(8, &|frame| frame.turn[2]),
            ..Motion::default()
        },
        ..Body::default()
    }
}

fn joint(scene: &Scene, frames: &[Frame], pin: usize) -> Joint {
    let gap = |frame: &Frame, surface: usize| frame.gaps[4 * pin + surface];
    let drawn = frames.first().map_or([ABSENT; 4], |frame| std::array::from_fn(|surface| gap(frame, surface)));
    let limit = |surface: usize, sign: f64| (drawn[surface] != ABSENT).then(|| rounded(sign * drawn[surface] * MM, 5));
    // By how much the slot has moved past the pin, seen by whichever of two opposite surfaces is there.
    let moved = |one: usize, other: usize, sign: f64| {
        series(frames, 5, |frame| {
            let by = |surface: usize| (gap(frame, surface) - drawn[surface]) * MM;
            if drawn[one] != ABSENT {
                sign * by(one)
            } else if drawn[other] != ABSENT {
                -sign * by(other)
            } else {
                0.0
            }
        })
    };
    let elastic = AnyElastic::new(&scene.slide_data::<f64>(&frames.first().map_or([ABSENT; 16], |f| f.gaps)).contact);
    let contact = |surface: usize| Contact {
        side: SIDES[surface],
        name: SURFACES[surface],
        force: series(frames, 3, |frame| {
            let depth = (-gap(frame, surface)).max(0.0);
            elastic.as_ref().map_or(0.0, |elastic| elastic.force(depth).0)
        }),
    };
    Joint {
        name: scene.pins[pin].name.clone(),
        at: scene.pins[pin].position.map(|x| x * MM),
        between: [FRAME, SLIDE].map(str::to_owned),
        axes: ["x", "y"],
        round: false,
        turn: 0.0,
        limits: [limit(0, -1.0), limit(1, 1.0), limit(3, -1.0), limit(2, 1.0)],
        pin: [moved(0, 1, 1.0), moved(3, 2, 1.0)],
        contacts: (0..4).filter(|surface| drawn[*surface] != ABSENT).map(contact).collect(),
    }
}

fn series(frames: &[Frame], digits: i32, of: impl Fn(&Frame) -> f64) -> Series {
    Series(frames.iter().map(|frame| rounded(of(frame), digits)).collect())
}

#[cfg(test)]
mod tests {
    use super::run;
    use crate::{
        dynamics::{example, film::film},
        show::player::figure,
    };

    #[test]
    fn pins_stay_in_their_gaps_and_press_where_they_touch() {
        let mut scene = example::cd_rom();
        scene.title = "</script> & <!--<script>".into();
        let played = run(&scene, "n = +2.5".into(), &film(&scene, &scene.gaps_at(&[2.5; 16]), 60).unwrap());
        let mut pressed = 0.0f64;
        for joint in &played.joints {
            let [left, right, low, high] = joint.limits.map(Option::unwrap);
            for k in 0..played.t.0.len() {
                let [x, y] = [&joint.pin[0], &joint.pin[1]].map(|series| series.0[k]);
                for contact in &joint.contacts {
                    let room = match contact.side {
                        "left" => x - left,
                        "right" => right - x,
                        "low" => y - low,
                        _ => high - y,
                    };
                    let force = contact.force.0[k];
                    // 100 N/mm^1.5.
                    let elastic = 100.0 * libm::pow((-room).max(0.0), 1.5);
                    assert!(
                        (force - elastic).abs() < 2e-3 + 1e-3 * elastic,
                        "{} {} {room} {force}",
                        joint.name,
                        contact.side
                    );
                    pressed = pressed.max(force);
                }
            }
        }
        // A quarter of the weight of 81.8 g, and more while what was compressed is let go.
        assert!(pressed > 0.1 && pressed < 20.0, "{pressed}");
        let figure = figure(&[played], "Caption").unwrap().into_string();
        let (_, data) = figure.split_once("json\">").unwrap();
        let (data, rest) = data.split_once('<').unwrap();
        // The data end where the script's element does, and say what they said.
        assert!(rest.starts_with("/script>"));
        let read: serde_json::Value = serde_json::from_str(data).unwrap();
        assert_eq!(read[0]["title"], scene.title);
    }
}
