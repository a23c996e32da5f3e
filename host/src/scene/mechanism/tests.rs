//! Mechanisms that are none: each mistake is told where it is.

use crate::{
    mechanism::{NormalData, Rebound},
    scene::{Override, SHIPPED, SceneFile, shipped},
};

const SCENE: &str = r#"
[mechanism]
space = "plane"

[contact]
stiffness = 100
exponent = 1.5
damping = 1
depth = 0.1

[[body]]
name = "crank"
mass = 100
inertia = 1e5
centre = [25, 0]

[[body]]
name = "slider"
mass = 100
inertia = 1e5
centre = [50, 0]

[[joint]]
name = "bearing"
kind = "revolute"
between = ["frame", "crank"]
at = [0, 0]

[[joint]]
name = "guide"
kind = "prismatic"
between = ["frame", "slider"]
at = [50, 0]
axis = [1, 0]

[[joint]]
name = "pin"
kind = "revolute"
between = ["crank", "slider"]
at = [50, 0]
clearance = [0.1, 0.01]
radius = 5

[run]
duration = 10
"#;

fn parse(text: &str, set: &[&str]) -> Result<SceneFile, String> {
    let overrides: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
    SceneFile::parse("scene.toml", text, &overrides).map_err(|error| error.to_string())
}

/// The scene with `from` replaced is refused: with `message`, at the line and column of `at`.
fn refused(from: &str, to: &str, message: &str, at: &str) {
    assert!(SCENE.contains(from), "{from}");
    let text = SCENE.replacen(from, to, 1);
    let error = parse(&text, &[]).err().unwrap_or_else(|| panic!("{to} is accepted"));
    assert!(error.contains(message), "{error}");
    let start = text.find(at).unwrap_or_else(|| panic!("{at}"));
    let line = text[..start].matches('\n').count() + 1;
    let column = start - text[..start].rfind('\n').unwrap();
    assert!(error.contains(&format!("scene.toml:{line}:{column}")), "{line}:{column} {error}");
}

#[test]
fn is_one() {
    let mechanism = parse(SCENE, &["joint.pin.clearance=[0.2, 0.01]"]).ok().unwrap().mechanism.unwrap();
    assert_eq!(mechanism.gaps_at(&[1.0]).unwrap(), [0.00019]);
    assert!(mechanism.gaps_at(&[21.0]).unwrap_err().to_string().contains("allowed is 0 to"));
}

#[test]
fn mistakes_are_told_where_they_are() {
    refused("kind = \"prismatic\"", "kind = \"hinge\"", "`joint.kind` is \"hinge\"", "\"hinge\"");
    refused("[\"crank\", \"slider\"]", "[\"crank\", \"crank\"]", "joins \"crank\" to itself", "[\"crank\", \"crank\"]");
    refused("[\"crank\", \"slider\"]", "[\"crank\", \"rod\"]", "there is no body `rod`", "\"rod\"");
    refused("inertia = 1e5\n", "", "`body.inertia` is missing", "[[body]]");
    refused("axis = [1, 0]", "axis = [0, 0]", "`joint.axis` is [0, 0]", "[0, 0]\n\n[[joint]]\nname = \"pin\"");
    refused("clearance = [0.1, 0.01]", "clearance = [-0.1, 0.01]", "the gap \"pin\" is -0.1 mm", "[-0.1, 0.01]");
    refused("at = [0, 0]", "at = [90000, 0]", "mm from the centre of the nearer body", "[90000, 0]");
    refused(
        "clearance = [0.1, 0.01]\nradius = 5\n",
        "",
        "closes a loop of joints without play",
        "[[joint]]\nname = \"pin\"",
    );
    refused("radius = 5\n", "", "`joint.radius` is missing", "[[joint]]\nname = \"pin\"");
    refused(
        "name = \"guide\"",
        "name = \"bearing\"",
        "`joint.name` is \"bearing\" again",
        "\"bearing\"\nkind = \"prismatic\"",
    );
    refused(
        "inertia = 1e5\n",
        "inertia = 1e5\nspeed = 10\n",
        "`speed` at the start of a body that no joint lets move so",
        "10\ncentre",
    );
    // The second body slides and does not turn.
    let slider = "name = \"slider\"\n";
    refused(slider, "name = \"slider\"\nspin = 7\n", "`spin` at the start of a body", "7\nmass");
    refused("space = \"plane\"", "space = \"line\"", "`mechanism.space` is \"line\"", "\"line\"");
    refused("radius = 5", "radius = 5\nspring = 3", "unknown key `joint.spring`", "spring = 3");
    refused(
        "[contact]\nstiffness = 100\nexponent = 1.5\ndamping = 1\ndepth = 0.1\n",
        "",
        "`contact` is missing",
        "[[joint]]\nname = \"pin\"",
    );
}

#[test]
fn a_torsion_spring_in_space_is_refused() {
    let spring = "[[spring]]\nname = \"twist\"\nbetween = [\"carriage\", \"frame\"]\nstiffness = 1000\n";
    let text = format!("{}\n{spring}", shipped("linear-guide").unwrap());
    let error = parse(&text, &[]).err().unwrap();
    assert!(error.contains("a torsion spring in space is not supported"), "{error}");
}

const REBOUND: &str = "law = \"hunt-crossley\"\nrestitution = 0.9\nspeed = 250\n";

#[test]
fn contacts_with_a_restitution_are_read() {
    let spring = Rebound { stiffness: 100.0 * libm::pow(1e3, 1.5), exponent: 1.5, restitution: 0.9, speed: 0.25 };
    let of = |text: &str| {
        let text = SCENE.replacen("damping = 1\ndepth = 0.1\n", text, 1);
        parse(&text, &[]).unwrap_or_else(|error| panic!("{error}")).mechanism.unwrap().joints[2].laws.contact
    };
    let near = |found: Rebound| assert!((found.stiffness / spring.stiffness - 1.0).abs() < 1e-15, "{found:?}");
    let NormalData::HuntCrossley(found) = of(REBOUND) else { panic!("another law") };
    near(found);
    let NormalData::LankaraniNikravesh(found) = of(&REBOUND.replace("hunt-crossley", "lankarani-nikravesh")) else {
        panic!("another law")
    };
    near(found);
    assert_eq!(Rebound { stiffness: spring.stiffness, ..found }, spring);
    assert_eq!(of("damping = 1\ndepth = 0.1\n"), of("law = \"impact\"\ndamping = 1\ndepth = 0.1\n"));
}

#[test]
fn contact_laws_have_their_own_keys() {
    refused("damping = 1", "law = \"hertz\"\ndamping = 1", "`contact.law` is \"hertz\"", "\"hertz\"");
    let with = format!("damping = 1\n{REBOUND}");
    refused("damping = 1\n", &with, "`contact.damping` of the law \"hunt-crossley\"", "1\nlaw");
    let restitution = "`contact.restitution` of the law \"impact\"";
    refused("damping = 1\n", "damping = 1\nrestitution = 0.9\n", restitution, "0.9");
    let lively = REBOUND.replace("0.9", "1.5");
    refused("damping = 1\ndepth = 0.1\n", &lively, "`contact.restitution` is 1.5", "1.5\nspeed");
    let silent = REBOUND.replace("speed = 250\n", "");
    refused("damping = 1\ndepth = 0.1\n", &silent, "`contact.speed` is missing", "[contact]");
}

#[test]
fn a_body_that_nothing_holds_floats() {
    let more = "\n[[body]]\nname = \"lost\"\nmass = 1\ninertia = 1\ncentre = [0, 0]\n";
    let error = parse(&format!("{SCENE}{more}"), &[]).err().unwrap();
    assert!(error.contains("nothing joins the body \"lost\"") && error.contains("name = \"lost\""), "{error}");
}

#[test]
fn three_mistakes_are_told_at_once() {
    let set = ["body.crank.mass=-1", "joint.pin.radius=nan", "run.duration=5 kg"];
    let error = parse(SCENE, &set).err().unwrap();
    assert_eq!(error.matches("error:").count(), 3, "{error}");
}

#[test]
fn ideal_joints_in_space_are_checked() {
    let scene = shipped("ball-rod").unwrap();
    let refused = |from: &str, to: &str, message: &str| {
        assert!(scene.contains(from), "{from}");
        let error = parse(&scene.replacen(from, to, 1), &[]).err().unwrap_or_else(|| panic!("{to} is accepted"));
        assert!(error.contains(message), "{error}");
    };
    refused("axis = [0, 0.6, 0.8]\n", "", "`joint.axis` is missing");
    refused("axis = [0, 1, 0]\n", "axis = [0, 0, 0]\n", "`joint.axis` is [0, 0, 0]");
    refused(
        "at = [15, 0, 0]\n",
        "at = [15, 0, 0]\nclearance = [0.1, 0.01]\n",
        "a clearance of a joint of kind \"spherical\"",
    );
    refused("axis = [0, 1, 0]\n", "axis = [0, 1, 0]\nclearance = [0.1, 0.01]\n", "of kind \"prismatic\" in space");
    refused("kind = \"spherical\"", "kind = \"pin-slot\"", "a joint of kind \"pin-slot\" in space");
    refused("mass = \"20 g\"", "mass = \"20 g\"\nspin = 1", "`spin` at the start of a body that no joint lets move so");
    let ball =
        "kind = \"track\"\nbetween = [\"rod\", \"slide\"]\nat = [15, 60, 0]\nleft = [0.05, 0.01]               # mm\n";
    let loops = "kind = \"spherical\"\nbetween = [\"rod\", \"slide\"]\nat = [15, 60, 0]\n";
    refused(ball, loops, "the joint \"upper ball\" closes a loop of joints without play");
    // A crank on its shaft can start turned and turning, a slide in its guide moving.
    let set = ["body.crank.angle=0.2", "body.crank.spin=3", "body.slide.speed=10"];
    let start = |i: usize| parse(scene, &set).ok().unwrap().mechanism.unwrap().bodies[i].start;
    assert!((start(0).angle - 0.2f64.to_radians()).abs() < 1e-15 && (start(0).spin, start(2).speed) == (3.0, 0.01));
    // But not so far that its rod's ball leaves the slide.
    let torn = parse(scene, &["body.crank.angle=20"]).err().unwrap();
    assert!(torn.contains("this start tears `upper ball` open") && torn.contains("body.crank.angle=20"), "{torn}");
}

#[test]
fn every_shipped_mechanism_is_read() {
    let mechanisms = SHIPPED
        .iter()
        .filter(|(name, text)| parse(text, &[]).ok().unwrap_or_else(|| panic!("{name}")).mechanism.is_some());
    assert_eq!(mechanisms.count(), 8);
}

/// A guide that presses its slide in the drawn pose is not torn open by a body that starts turned.
#[test]
fn a_preload_is_no_torn_joint() {
    let scene = shipped("slider-crank-guide").unwrap();
    assert!(scene.contains("angle = "));
    let preloaded = parse(scene, &["joint.guide.clearance=[-0.3, 0]"]);
    assert!(preloaded.is_ok(), "{:?}", preloaded.err());
}
