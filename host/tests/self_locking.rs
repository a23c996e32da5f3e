//! The rule of self-locking against simulations: just below the critical friction the body runs, just above it is jammed.

use std::fmt::Write;

use slipfit::{
    dynamics::{
        outcome::Verdict,
        simulate::{Settings, simulate},
    },
    mechanism::{
        Mechanism, run,
        self_locking::{DriveSide, guide, locked},
    },
    scene::{Override, SceneFile},
    setup::Scene,
};

/// Pins at x = ±62 mm, z = ±18 mm, by whose gaps a slide or a body on tracks is guided: left, right, rail and wall in the order left
/// back, right back, left front, right front; `None` where there is no such surface.
type Gaps = [[Option<f64>; 4]; 4];

const PLACES: [[f64; 2]; 4] = [[-62.0, -18.0], [62.0, -18.0], [-62.0, 18.0], [62.0, 18.0]];
const SURFACES: [&str; 4] = ["left", "right", "rail", "wall"];

/// What is the same for all: contacts so stiff and a drive so strong that a jam is one, a stroke so short that nothing tips.
const COMMON: &str = r#"
contact = { stiffness = 10000, exponent = 1.5, damping = 1, depth = 0.1 }
run = { duration = 300, stroke = 4 }
"#;

fn friction(coefficient: f64) -> String {
    format!("friction = {{ law = \"regularised\", coefficient = {coefficient}, stick_band = 0.1 }}\n")
}

/// A slide on pins with these `gaps` (mm), driven at a `point` (mm from the centre of mass).
fn slide(gaps: Gaps, point: [f64; 3], coefficient: f64) -> Scene {
    let mut text = String::from("slide = { mass = 81.8, inertia_box = [130, 12, 150], gravity = [0, -9.81, 0] }\n");
    text += &friction(coefficient);
    text += COMMON;
    let _ =
        writeln!(text, "drive = {{ gain = 0.4, ramp_start = 0.05, ramp_end = 0.1, speed = 100, point = {point:?} }}");
    text += "sweep = { n = 0 }\n";
    for (i, ([x, z], gaps)) in PLACES.into_iter().zip(gaps).enumerate() {
        let _ = writeln!(text, "[[pin]]\nname = \"{i}\"\nposition = [{x:?}, 0, {z:?}]");
        for (surface, gap) in SURFACES.into_iter().zip(gaps) {
            text += &gap.map_or_else(String::new, |gap| format!("{surface} = [{gap:?}, 0]\n"));
        }
    }
    Scene::parse("slide.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// The same as a body on tracks: pins of the frame between walls of the body, or of the body between walls of the frame.
fn tracks(gaps: Gaps, point: [f64; 3], coefficient: f64, pins_of_frame: bool) -> Mechanism {
    let mut text = String::from("mechanism = { space = \"space\", gravity = [0, -9.81, 0] }\n");
    text += &friction(coefficient);
    text += COMMON;
    text += "body = [{ name = \"drawer\", mass = 81.8, inertia = [153531, 269000, 116000], centre = [0, 0, 0] }]\n";
    let between = if pins_of_frame { "[\"frame\", \"drawer\"]" } else { "[\"drawer\", \"frame\"]" };
    for (i, ([x, z], gaps)) in PLACES.into_iter().zip(gaps).enumerate() {
        let _ =
            writeln!(text, "[[joint]]\nname = \"{i}\"\nkind = \"track\"\nbetween = {between}\nat = [{x:?}, 0, {z:?}]");
        // What is a wall of the body to the left of a pin of the frame, is a wall of the frame to the right of a pin of the body.
        let order = if pins_of_frame { [0, 1, 2, 3] } else { [1, 0, 3, 2] };
        for (k, surface) in order.into_iter().zip(SURFACES) {
            text += &gaps[k].map_or_else(String::new, |gap| format!("{surface} = [{gap:?}, 0]\n"));
        }
    }
    let _ = writeln!(
        text,
        "[[drive]]\nname = \"motor\"\npushes = \"drawer\"\naxis = [0, 0, 1]\ngain = 0.4\nramp_start = 0.05\nramp_end = 0.1\n\
         speed = 100\npoint = {point:?}"
    );
    mechanism(&text, &[])
}

fn mechanism(text: &str, set: &[&str]) -> Mechanism {
    let set: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
    SceneFile::parse("m.toml", text, &set).unwrap_or_else(|error| panic!("{error}")).mechanism.unwrap()
}

/// What the slide does.
fn verdict(scene: &Scene) -> Verdict {
    let run = simulate(scene, &scene.gaps_at(&[0.0; 16]), &Settings::desk(scene, 1e-2)).unwrap();
    run.outcome.verdict
}

/// What the drive of a mechanism does.
fn verdict_of(mechanism: &Mechanism) -> Verdict {
    run(mechanism, &mechanism.gaps_at(&[0.0]).unwrap(), 1e-2).unwrap().outcomes[0].verdict
}

const BOTH: Gaps = [[Some(0.05), Some(0.05), Some(0.0), Some(0.5)]; 4];
/// Each side of the drawer is guided outwards alone. With more play the drawer would turn so far before it touches that its width would
/// lengthen or shorten the guide.
const OUTWARDS: Gaps = {
    let [left, right] = [[Some(0.05), None, Some(0.0), Some(0.5)], [None, Some(0.05), Some(0.0), Some(0.5)]];
    [left, right, left, right]
};
/// The pins on the left have the narrower slots, as in the CD-ROM slide.
const LEFT: Gaps = {
    let wide = [Some(0.4), Some(0.4), Some(0.0), Some(0.5)];
    [[Some(0.1), Some(0.1), Some(0.0), Some(0.5)], wide, [Some(0.1), Some(0.1), Some(0.0), Some(0.5)], wide]
};

/// A drive whose body turns about a point between the drive and the centre of mass: the centre, by whose speed the drive goes, moves back
/// as the drive pushes. Such a drive pushes ever harder, and what locks is thrown about.
const FAR: &str = "left, beyond the guide line on the other side";

/// Guides, drive points, where the guide line is and how far the drive passes beside it (mm), and the distance above or below.
#[expect(clippy::type_complexity, reason = "a table, whose columns the comment above names")]
const CASES: [(&str, Gaps, [f64; 3], f64, f64, f64); 9] = [
    ("both sides", BOTH, [60.0, 0.0, 0.0], 0.0, 60.0, 0.0),
    ("both sides, to the left", BOTH, [-60.0, 0.0, 0.0], 0.0, 60.0, 0.0),
    ("outwards on both sides", OUTWARDS, [60.0, 0.0, 0.0], 0.0, 60.0, 0.0),
    ("outwards, to the left", OUTWARDS, [-45.0, 0.0, 0.0], 0.0, 45.0, 0.0),
    ("left, beyond", LEFT, [10.0, 0.0, 0.0], -62.0, 72.0, 0.0),
    (FAR, LEFT, [-130.0, 0.0, 0.0], -62.0, 68.0, 0.0),
    ("above", BOTH, [0.0, 60.0, 0.0], 0.0, 0.0, 60.0),
    ("below", BOTH, [0.0, -60.0, 0.0], 0.0, 0.0, 60.0),
    ("beside and above", BOTH, [30.0, 30.0, 0.0], 0.0, 30.0, 30.0),
];

#[test]
fn slides_lock_where_the_rule_says() {
    for (name, gaps, point, line, beside, above) in CASES {
        let critical = 36.0 / (2.0 * (beside + above));
        let found = guide(&slide(gaps, point, 0.3), 0.0).unwrap_or_else(|| panic!("{name}: no guide"));
        let near =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-9, "{name}: {found} for {expected}");
        near(found.critical_friction.unwrap(), critical);
        near(found.line_x, line * 1e-3);
        near(found.drive_distance, beside * 1e-3);
        near(found.length, 0.036);
        near(found.height.map_or(0.0, |lever| lever.distance), above * 1e-3);
        assert_eq!(found.side, DriveSide::Beyond, "{name}");
        for (share, locks) in [(0.95, false), (1.05, true)] {
            let scene = slide(gaps, point, critical * share);
            assert_eq!(guide(&scene, 0.0).unwrap().warn, locks, "{name}");
            let does = verdict(&scene);
            // Driven on the far side, where its feedback is positive, what does not lock runs away.
            let expected = match (locks, name.contains("other side")) {
                (false, _) => Verdict::Runs,
                (true, false) => Verdict::Jammed,
                (true, true) => Verdict::Overruns,
            };
            assert_eq!(does, expected, "{name} at {share} of the critical friction");
        }
    }
}

/// Between the guide line and the centre of mass a drive never locks.
#[test]
fn a_drive_short_of_the_resistances_runs() {
    for x in [-10.0, -50.0, -62.0] {
        let scene = slide(LEFT, [x, 0.0, 0.0], 0.9);
        let found = guide(&scene, 0.0).unwrap();
        assert!(!found.warn && found.side == DriveSide::Short, "{x}: {found:?}");
        assert_eq!(verdict(&scene), Verdict::Runs, "{x}");
    }
    let centred = guide(&slide(LEFT, [0.0; 3], 0.3), 0.0).unwrap();
    assert!(centred.side == DriveSide::Edge && centred.warn, "{centred:?}");
    // With a guide on both sides the drive through the middle is on the guide line.
    let middle = slide(BOTH, [0.0; 3], 0.9);
    let found = guide(&middle, 0.0).unwrap();
    assert!(found.critical_friction.is_none() && !found.warn, "{found:?}");
    assert_eq!(verdict(&middle), Verdict::Runs);
}

#[test]
fn tracks_lock_where_the_rule_says() {
    for (name, gaps, point, _, beside, above) in CASES {
        let critical = 36.0 / (2.0 * (beside + above));
        for pins_of_frame in [true, false] {
            // The pins of a body travel with it: the same contacts carry.
            for (share, locks) in [(0.95, false), (1.05, true)] {
                let mechanism = tracks(gaps, point, critical * share, pins_of_frame);
                let found = locked(&mechanism);
                assert_eq!(found.len(), usize::from(locks), "{name} {pins_of_frame}: {found:?}");
                for found in &found {
                    assert!((found.critical_friction / critical - 1.0).abs() < 1e-9, "{name}: {found:?}");
                    assert_eq!((found.body, found.on), ("drawer", "frame"));
                }
                if name == FAR && locks {
                    continue;
                }
                let does = verdict_of(&mechanism);
                let expected = if locks { Verdict::Jammed } else { Verdict::Runs };
                assert_eq!(does, expected, "{name} {pins_of_frame} at {share} of the critical friction");
            }
        }
    }
    assert!(locked(&tracks(LEFT, [-10.0, 0.0, 0.0], 0.9, true)).is_empty());
    // The other way, by a negative speed or a negative axis.
    let mut back = tracks(LEFT, [10.0, 0.0, 0.0], 0.3, true);
    back.drives[0].drive.speed = -0.1;
    assert!((locked(&back)[0].critical_friction - 0.25).abs() < 1e-9);
    assert_eq!(verdict_of(&back), Verdict::Jammed);
}

/// A block between two lines, guided over 40 mm, pushed 60 mm beside its middle.
const BLOCK: &str = r#"
run = { duration = 300, stroke = 4 }
mechanism = { space = "plane", gravity = [0, -9.81] }
contact = { stiffness = 10000, exponent = 1.5, damping = 1, depth = 0.1 }
friction = { law = "regularised", coefficient = 0.3, stick_band = 0.1 }
body = [{ name = "block", mass = 100, inertia = 3e4, centre = [0, 0] }]
[[joint]]
name = "guide"
kind = "prismatic"
between = ["block", "frame"]
at = [0, 0]
axis = [1, 0]
length = 40
width = 20
clearance = [0.1, 0]
[[joint]]
name = "end"
kind = "stop"
between = ["block", "frame"]
at = [20, 0]
normal = [-1, 0]
clearance = [400, 0]
[[drive]]
name = "motor"
pushes = "block"
axis = [1, 0]
point = [0, 60]
gain = 0.4
ramp_start = 0.05
ramp_end = 0.1
speed = 100
"#;

#[test]
fn a_block_in_a_plane_locks_where_the_rule_says() {
    let critical = 40.0 / (2.0 * 60.0);
    for point in ["[0, 60]", "[0, -60]"] {
        for (share, locks) in [(0.95, false), (1.05, true)] {
            let set = [format!("drive.motor.point={point}"), format!("friction.coefficient={}", critical * share)];
            let mechanism = mechanism(BLOCK, &set.each_ref().map(String::as_str));
            let found = locked(&mechanism);
            assert_eq!(found.len(), usize::from(locks), "{found:?}");
            assert!(found.iter().all(|found| (found.critical_friction / critical - 1.0).abs() < 1e-9), "{found:?}");
            let expected = if locks { Verdict::Jammed } else { Verdict::Runs };
            assert_eq!(verdict_of(&mechanism), expected, "{point} at {share} of the critical friction");
        }
    }
}

/// Each stage of a drawer locks by its own guide: the drawer on its intermediate member, both of them on the frame.
#[test]
fn every_stage_of_a_drawer_is_looked_at() {
    let scene = |set: &[&str]| mechanism(slipfit::scene::shipped("telescopic-drawer").unwrap(), set);
    let stages = |set: &[&str]| {
        let mechanism = scene(set);
        let found: Vec<_> = locked(&mechanism).iter().map(|one| (one.body.to_owned(), one.critical_friction)).collect();
        found
    };
    assert!(stages(&[]).is_empty());
    // Inner guide 60 mm long at the drawer's height, outer guide 50 mm long and 12 mm below the drive.
    let found = stages(&["drive.motor.point=[160, 0, 50]"]);
    let expected = [("intermediate", 0.5 / (160.0 / 50.0 + 12.0 / 50.0)), ("drawer", 60.0 / 320.0)];
    assert_eq!(found.len(), 2, "{found:?}");
    for (body, critical) in expected {
        let (_, of) = found.iter().find(|(name, _)| name == body).unwrap_or_else(|| panic!("{body} {found:?}"));
        assert!((of / critical - 1.0).abs() < 1e-9, "{body}: {of} for {critical}");
    }
    // Between the two only the shorter guide locks.
    let found = stages(&["drive.motor.point=[140, 0, 50]"]);
    assert!(found.len() == 1 && found[0].0 == "intermediate", "{found:?}");
}

/// A push at an angle between the two contacts, 40 mm apart, presses the body on its guide with tan α of what moves it.
#[test]
fn a_block_pushed_at_an_angle_locks_where_the_rule_says() {
    for (degrees, ahead) in [(60.0, 0.0), (75.0, 0.0), (75.0, 15.0), (60.0, -10.0), (50.0, 5.0)] {
        let angle = f64::to_radians(degrees);
        let critical = 1.0 / libm::tan(angle);
        for (share, locks) in [(0.95, false), (1.05, true)] {
            let set = [
                format!("drive.motor.axis=[{}, {}]", libm::cos(angle), libm::sin(angle)),
                format!("drive.motor.point=[{ahead:?}, 0]"),
                format!("friction.coefficient={}", critical * share),
                "mechanism.gravity=[0, 0]".into(),
            ];
            let mechanism = mechanism(BLOCK, &set.each_ref().map(String::as_str));
            let found = locked(&mechanism);
            assert_eq!(found.len(), usize::from(locks), "{degrees}° {ahead}: {found:?}");
            assert!(found.iter().all(|found| (found.critical_friction / critical - 1.0).abs() < 1e-9), "{found:?}");
            assert!(found.iter().all(|found| (found.angle - angle).abs() < 1e-9), "{found:?}");
            let expected = if locks { Verdict::Jammed } else { Verdict::Runs };
            assert_eq!(verdict_of(&mechanism), expected, "{degrees}° {ahead} mm at {share} of the critical friction");
        }
    }
}

/// A drive on an arm that is fixed to the guided body drives that body.
#[test]
fn a_block_driven_by_its_arm_locks_where_the_rule_says() {
    let arm = "{ name = \"arm\", mass = 1, inertia = 10, centre = [0, 60] }";
    let weld = "\n[[joint]]\nname = \"weld\"\nkind = \"fixed\"\nbetween = [\"arm\", \"block\"]\nat = [0, 60]\n";
    let text = BLOCK.replace("centre = [0, 0] }]", &format!("centre = [0, 0] }}, {arm}]")) + weld;
    let text = text.replace("pushes = \"block\"", "pushes = \"arm\"");
    let critical = 40.0 / (2.0 * 60.0);
    for (share, locks) in [(0.95, false), (1.05, true)] {
        let mechanism =
            mechanism(&text, &["drive.motor.point=[0, 0]", &format!("friction.coefficient={}", critical * share)]);
        let found = locked(&mechanism);
        assert_eq!(found.len(), usize::from(locks), "{found:?}");
        assert!(found.iter().all(|found| (found.critical_friction / critical - 1.0).abs() < 1e-9), "{found:?}");
        let expected = if locks { Verdict::Jammed } else { Verdict::Runs };
        assert_eq!(verdict_of(&mechanism), expected, "at {share} of the critical friction");
    }
}
