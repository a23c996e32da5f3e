//! Input that is impossible, without effect, or possible but implausible: refused or warned about at its line.

mod commands;
#[path = "../common/mod.rs"]
mod common;
mod contacts;
mod refused;

use slipfit::{
    dynamics::simulate::{Settings, simulate},
    mechanism::{Mechanism, run},
    scene::{CD_ROM_SLIDE, Override, SHIPPED, SceneFile, shipped},
};

/// A lever in a plane, pushed up against its weight, with a stop above it.
const LEVER: &str = r#"
run = { duration = 100 }
mechanism = { space = "plane", gravity = [0, -9.81] }
contact = { stiffness = "1e7 N/m^1.5", exponent = 1.5, damping = "10 N·s/m", depth = 0.01 }
friction = { law = "regularised", coefficient = 0.2, stick_band = 1 }
[[body]]
name = "lever"
mass = 100
inertia = 1e5
centre = [50, 0]
[[joint]]
name = "shaft"
kind = "revolute"
between = ["frame", "lever"]
at = [0, 0]
[[joint]]
name = "bumper"
kind = "stop"
between = ["lever", "frame"]
at = [100, 0]
normal = [0, -1]
clearance = [5, 0.1]
[[drive]]
name = "motor"
turns = "lever"
gain = 0.1
ramp_start = 0
ramp_end = 0.01
speed = 1
"#;

/// A slider that is pushed towards two stops with friction.
const SLIDER: &str = r#"
run = { duration = 100 }
mechanism = { space = "plane" }
contact = { stiffness = "1e7 N/m^1.5", exponent = 1.5, damping = "10 N·s/m", depth = 0.01 }
friction = { law = "regularised", coefficient = 0.2, stick_band = 1 }
[[body]]
name = "slider"
mass = 100
inertia = 1e5
centre = [0, 0]
[[joint]]
name = "guide"
kind = "prismatic"
between = ["slider", "frame"]
at = [0, 0]
axis = [1, 0]
[[joint]]
name = "end"
kind = "stop"
between = ["slider", "frame"]
at = [50, 0]
normal = [-1, 0]
clearance = [40, 0.1]
[[joint]]
name = "start"
kind = "stop"
between = ["slider", "frame"]
at = [-50, 0]
normal = [1, 0]
clearance = [40, 0.1]
[[drive]]
name = "motor"
pushes = "slider"
axis = [1, 0]
gain = 1
ramp_start = 0
ramp_end = 0.01
speed = 50
"#;

fn parse(text: &str, set: &[&str]) -> Result<SceneFile, String> {
    let set: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
    SceneFile::parse("scene.toml", text, &set).map_err(|error| error.to_string())
}

/// The warnings about what moves in a scene; it has to be sound otherwise.
#[track_caller]
fn warnings(text: &str, set: &[&str]) -> Vec<String> {
    let file = parse(text, set).unwrap_or_else(|error| panic!("{error}"));
    file.slide.map(|slide| slide.warnings).or(file.mechanism.map(|mechanism| mechanism.warnings)).unwrap()
}

/// `text` with `from` replaced by `to`.
#[track_caller]
fn with(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

/// `text` with `from` replaced by `to` has one warning, at the place of `at`, with all `parts`.
#[track_caller]
fn warned(text: &str, [from, to, at]: [&str; 3], parts: &[&str]) {
    let text = with(text, from, to);
    let found = warnings(&text, &[]);
    let [warning] = &found[..] else { panic!("{to}: {found:?}") };
    let start = text.find(at).unwrap_or_else(|| panic!("{at}"));
    let line = text[..start].matches('\n').count() + 1;
    let column = start - text[..start].rfind('\n').map_or(0, |end| end + 1) + 1;
    assert!(warning.starts_with(&format!("scene.toml:{line}:{column}: ")), "{line}:{column} {warning}");
    for part in parts {
        assert!(warning.contains(part), "{part}: {warning}");
    }
}

/// `text` with the settings is refused with `message`, and `allowed` somewhere in what is allowed; with nothing else.
#[track_caller]
fn refused(text: &str, set: &[&str], message: &str, allowed: &str) {
    let error = parse(text, set).err().unwrap_or_else(|| panic!("{set:?} is accepted"));
    assert!(error.contains(message) && error.contains(allowed), "{error}");
    assert_eq!(error.matches("error:").count(), 1, "{error}");
}

#[test]
fn shipped_scenes_are_plausible() {
    for (name, text) in SHIPPED {
        let file = parse(text, &[]).unwrap_or_else(|error| panic!("{name}: {error}"));
        let of_slide = file.slide.map(|slide| slide.warnings);
        let found = of_slide.or(file.mechanism.map(|mechanism| mechanism.warnings)).unwrap_or_default();
        assert!(found.is_empty(), "{name}: {found:?}");
    }
    assert_eq!(warnings(LEVER, &[]), [""; 0]);
}

#[test]
fn gravity_is_one_that_a_planet_has() {
    let parts = ["`slide.gravity` is 9810 m/s² long", "usual is 9.81 m/s²", "mm/s² may be meant"];
    let slide = "[0, -9.81, 0]";
    warned(CD_ROM_SLIDE, [slide, "[0, -9810, 0]", "[0, -9810, 0]"], &parts);
    warned(CD_ROM_SLIDE, [slide, "[0, 0, 9810]", "[0, 0, 9810]"], &parts);
    let small = ["`slide.gravity` is 0.00981 m/s² long", "; m/s² may be meant"];
    warned(CD_ROM_SLIDE, [slide, "[0, \"-9.81 mm/s²\", 0]", "[0, \"-9.81"], &small);
    warned(LEVER, ["[0, -9.81]", "[-9810, 0]", "[-9810, 0]"], &["`mechanism.gravity` is 9810 m/s² long"]);
    for gravity in ["[0, 0, 0]", "[0, -1.62, 0]", "[0, -24.8, 0]", "[0, \"-9810 mm/s²\", 0]"] {
        assert_eq!(warnings(&with(CD_ROM_SLIDE, slide, gravity), &[]), [""; 0], "{gravity}");
    }
    // A setting of the command line is its own place.
    let set = warnings(CD_ROM_SLIDE, &["slide.gravity=[0, -9810, 0]"]);
    assert!(set[0].starts_with("--set slide.gravity=[0, -9810, 0]: `slide.gravity` is 9810 m/s² long"), "{set:?}");
}

#[test]
fn friction_is_one_that_solids_have() {
    let parts = ["`friction.coefficient` is 25", "usual is 0.05 to 1", "0.25 if per cent is meant"];
    let [from, to] = ["coefficient = 0.3", "coefficient = 25"];
    warned(CD_ROM_SLIDE, [from, to, "25\n"], &parts);
    let exact = with(CD_ROM_SLIDE, "\"regularised\"", "\"exact\"");
    warned(&exact, [from, to, "25\n"], &parts);
    warned(LEVER, ["coefficient = 0.2", "coefficient = 25", "25, stick"], &parts);
    let own = "clearance = [5, 0.1]\nfriction = { law = \"exact\", coefficient = 30 }";
    warned(LEVER, ["clearance = [5, 0.1]", own, "30 }"], &["`joint.friction.coefficient` is 30"]);
    assert_eq!(warnings(&with(CD_ROM_SLIDE, from, "coefficient = 1.6"), &[]), [""; 0]);
}

/// A band of sticking wider than the commanded speed leaves no dry friction; a hair below it is no matter of opinion.
#[test]
fn a_stick_band_is_slower_than_the_drive() {
    let [from, at] = ["stick_band = 0.1", "101"];
    warned(CD_ROM_SLIDE, [from, "stick_band = 101", at], &["`friction.stick_band` is 101 mm/s", "commanded 100 mm/s"]);
    warned(CD_ROM_SLIDE, [from, "stick_band = \"0.5 m/s\"", "\"0.5 m/s"], &["is 500 mm/s"]);
    assert_eq!(warnings(&with(CD_ROM_SLIDE, from, "stick_band = 99"), &[]), [""; 0]);
    let exact = with(CD_ROM_SLIDE, "\"regularised\"", "\"exact\"");
    assert_eq!(warnings(&with(&exact, from, "stick_band = 500"), &[]), [""; 0]);
    // On the stop of a slider that is pushed with 50 mm/s.
    let slider = SLIDER.replace("stick_band = 1 ", "stick_band = 60 ");
    let found = warnings(&slider, &[]);
    assert!(matches!(&found[..], [one] if one.contains("is 60 mm/s, more than the commanded 50 mm/s")), "{found:?}");
    assert_eq!(warnings(SLIDER, &[]), [""; 0]);
}

/// No principal moment of inertia of a rigid body is greater than the other two together; equal it is of a flat plate.
#[test]
fn moments_of_inertia_obey_the_triangle_inequality() {
    let drawer = shipped("telescopic-drawer").unwrap();
    let set = |moments: &str| format!("body.drawer.inertia={moments}");
    for moments in
        ["[8e5, 2e6, 9e5]", "[2e6, 8e5, 9e5]", "[8e5, 9e5, 2e6]", "['2e-3 kg·m²', '1e-3 kg·m²', '0.9e-3 kg·m²']"]
    {
        refused(drawer, &[&set(moments)], "`body.inertia` is [", "none is greater than the other two together");
    }
    for moments in ["[8e5, 1.6e6, 9e5]", "[8e5, 1.7e6, 9e5]", "[123, 580, 457]"] {
        assert!(parse(drawer, &[&set(moments)]).is_ok(), "{moments}");
    }
}

/// The radius of gyration √(J/m) says whether a moment of inertia is in the unit that is meant.
#[test]
fn moments_of_inertia_fit_the_mass() {
    // 100 g and 0.1 g·mm²: √0.001 mm. The joint is 50 mm away, and the joint is right.
    let message = "`body.inertia` is 0.1 g·mm², which with the mass of \"lever\" is a radius of gyration of 0.0316 mm";
    refused(&with(LEVER, "1e5", "0.1"), &[], message, "a bare number is in g·mm², kg·m² may be meant");
    refused(&with(LEVER, "1e5", "1e-4"), &[], "its joint \"shaft\" is 50 mm away", "kg·m² may be meant");
    // A joint that is far away is wrong where the body is sound.
    refused(
        LEVER,
        &["joint.bumper.at=[90000, 0]"],
        "the joint \"bumper\" is 89950 mm from the centre",
        "100 of its radii",
    );
    let of = ["a radius of gyration of 1 mm", "usual is 1.29 to 1450 mm", "kg·mm² may be meant"];
    warned(LEVER, ["inertia = 1e5", "inertia = 100", "100\ncentre"], &of);
    warned(
        LEVER,
        ["inertia = 1e5", "inertia = \"1e5 kg·m²\"", "\"1e5"],
        &["`body.inertia` is 1e5 kg·m²", "gyration of 1.0e6 mm"],
    );
    // Osmium has 22.6 g/cm³; 81.8 kg in a box of 130 × 12 × 150 mm would have 350.
    let [from, to, at] = ["mass = 81.8 ", "mass = 81800 ", "81800"];
    warned(CD_ROM_SLIDE, [from, to, at], &["`slide.mass` is 81800 g", "a bare mass is in g, a bare length in mm"]);
    warned(CD_ROM_SLIDE, ["[130, 12, 150]", "[0.13, 0.012, 0.15]", "81.8"], &["a bare length in mm"]);
    // What only slides on the frame has a moment of inertia that never counts.
    let text = shipped("slider-crank").unwrap();
    assert_eq!(warnings(text, &["body.slider.inertia=1e-3"]), [""; 0]);
}

/// Four contacts share the weight: each yields by (m·g/4/k)^(1/e), and as deep the slide lies after it has settled.
#[test]
fn parts_do_not_sink_deeper_than_their_gaps() {
    let stiff = "stiffness = 100 ";
    let deep = |stiffness: f64| libm::pow(0.0818 * 9.81 / 4.0 / stiffness, 1.0 / 1.5);
    // N/m^1.5 for N/mm^1.5: 15.9 mm, where the widest gap is 0.7776 mm and three times 0.0633.
    assert!((deep(100.0) - 15.9e-3).abs() < 5e-5);
    let parts = ["`contact.stiffness` is 100 N/m^1.5", "weight of 0.802 N, shared by 4 contacts,", "sink 15.9 mm"];
    let text = with(CD_ROM_SLIDE, stiff, "stiffness = \"100 N/m^1.5\" ");
    let found = warnings(&text, &[]);
    assert!(parts.iter().all(|part| found[0].contains(part)) && found.len() == 1, "{found:?}");
    assert!(found[0].contains("their widest gap is 0.96") && found[0].ends_with("N/mm^1.5 may be meant"), "{found:?}");
    // On the side of too soft alone, and only where it is deeper than a gap.
    let soft = |stiffness: &str| warnings(CD_ROM_SLIDE, &[&format!("contact.stiffness={stiffness}")]).len();
    assert_eq!(["0.1", "0.2", "0.25", "1000"].map(soft), [1, 1, 0, 0]);
    let of = |stiffness: f64| deep(stiffness * libm::pow(1e3, 1.5));
    assert!(of(0.2) > 0.9675e-3 && of(0.25) < 0.9675e-3, "{} {}", of(0.2), of(0.25));
    // A simulation without friction and drive sinks as deep.
    let set = [
        "contact.stiffness=0.2",
        "contact.damping=0.004",
        "friction.law=none",
        "drive.speed=1",
        "run.duration=0.5 s",
        "run.error=1e-4",
    ];
    let rails = ["left back", "right back", "left front", "right front"].map(|pin| format!("pin.{pin}.rail=[0, 0]"));
    let set: Vec<_> = set.into_iter().chain(rails.iter().map(String::as_str)).collect();
    let scene = parse(CD_ROM_SLIDE, &set).unwrap_or_else(|error| panic!("{error}")).slide.unwrap();
    let sunk = simulate(&scene, &scene.gaps_at(&[0.0; 16]), &Settings::desk(&scene, 1e-2)).unwrap();
    let depth = -sunk.trajectory.y.last().unwrap();
    assert!((depth / of(0.2) - 1.0).abs() < 1e-3, "{depth} {}", of(0.2));
    // A mechanism: once, whichever joint has the contact, and at that of its own.
    let drawer = shipped("telescopic-drawer").unwrap();
    let found = warnings(drawer, &["contact.stiffness=1e3 N/m^1.5"]);
    assert!(found.len() == 1 && found[0].contains("shared by 8 contacts"), "{found:?}");
}

/// A stop that begins inside its wall pushes with k·δ^e.
#[test]
fn a_reversed_stop_is_seen() {
    let drawer = shipped("telescopic-drawer").unwrap();
    let depth = libm::pow(32_872.0 / 1e7, 1.0 / 1.5) * 1e3;
    let set = format!("joint.inner stop left.clearance=[{}, 0.1]", -depth);
    let found = warnings(drawer, &[&set]);
    assert_eq!(found.len(), 1, "{found:?}");
    for part in ["presses \"inner stop left\" 22.1 mm deep at the start, with 32872 N", "is one of the two reversed?"] {
        assert!(found[0].contains(part), "{found:?}");
    }
    // What it says the simulation does: the drawer is thrown out by that force.
    let mechanism = parse(drawer, &[&set, "run.duration=1"]).ok().unwrap().mechanism.unwrap();
    let run = run(&mechanism, &mechanism.gaps_at(&[0.0]).unwrap(), 1e-5).unwrap();
    let column = run.samples.columns.iter().position(|name| name == "drawer.vz (m/s)").unwrap();
    let accelerated = run.samples.rows[1][column] / run.samples.rows[1][0];
    assert!((accelerated.abs() * 0.4 / 32_872.0 - 1.0).abs() < 0.05, "{accelerated}");
    // A preload of the size of the weight is none.
    assert_eq!(warnings(drawer, &["joint.inner stop left.clearance=[-0.02, 0.001]"]), [""; 0]);
    let slide = warnings(CD_ROM_SLIDE, &["pin.left back.left=[-2, 0.01]"]);
    assert!(slide.len() == 1 && slide[0].contains("presses \"left back left\" 2 mm deep"), "{slide:?}");
}

/// A drawer of 600 mm runs to its stop and stays there.
#[test]
fn stops_are_as_far_as_a_stroke_is_long() {
    let text = r#"
        run = { duration = 1500 }
        mechanism = { space = "SPACE" }
        contact = { stiffness = "1e7 N/m^1.5", exponent = 1.5, damping = "300 N·s/m", depth = 0.01 }
        body = [{ name = "drawer", mass = 2000, inertia = INERTIA, centre = [0, 0] }]
        [[joint]]
        name = "rail"
        kind = "prismatic"
        between = ["frame", "drawer"]
        at = [0, 0]
        axis = [1, 0]
        [[joint]]
        name = "end"
        kind = "stop"
        between = ["drawer", "frame"]
        at = [0, 0]
        normal = [-1, 0]
        clearance = [600, 0.5]
        [[drive]]
        name = "motor"
        pushes = "drawer"
        axis = [1, 0]
        gain = 0.1
        ramp_start = 0
        ramp_end = 0.1
        speed = 1000
    "#;
    let plane = text.replace("SPACE", "plane").replace("INERTIA", "1e7");
    let space = text.replace("SPACE", "space").replace("INERTIA", "[1e7, 1e7, 1e7]");
    let space = space.replace("[0, 0]", "[0, 0, 0]").replace("[1, 0]", "[1, 0, 0]").replace("[-1, 0]", "[-1, 0, 0]");
    let end = |text: &str, set: &[&str]| {
        let mechanism: Mechanism = parse(text, set).unwrap_or_else(|error| panic!("{error}")).mechanism.unwrap();
        let run = run(&mechanism, &mechanism.gaps_at(&[2.0]).unwrap(), 1e-2).unwrap();
        let column = run.samples.columns.iter().position(|name| name == "drawer.x (m)").unwrap();
        let place = run.samples.rows.last().unwrap()[column];
        // Blocked, the drive gives 100 N, to which the stop yields.
        place - libm::pow(100.0 / 1e7, 1.0 / 1.5)
    };
    for text in [&plane, &space] {
        assert!((end(text, &[]) - 0.599).abs() < 2e-5, "{}", end(text, &[]));
        assert!((end(text, &["joint.end.clearance=[250, 0.5]"]) - 0.249).abs() < 2e-5);
    }
    refused(&plane, &["joint.end.clearance=[10001, 0.5]"], "`joint.clearance` is 10001 mm", "-10000 to 10000 mm");
    // A pin in a hole has no such play.
    let crank = shipped("slider-crank").unwrap();
    refused(crank, &["joint.big end.clearance=[101, 0.1]"], "`joint.clearance` is 101 mm", "-100 to 100 mm");
}
