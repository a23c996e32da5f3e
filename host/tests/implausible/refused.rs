//! Keys without effect, and mistakes that are blamed on what is wrong.

use slipfit::scene::CD_ROM_SLIDE;

use super::{LEVER, parse, refused, with};

#[test]
fn parameters_that_change_nothing_do_not_vary() {
    let tolerance = "={ tolerance = 0.01 }";
    let of = |key: &str| format!("{key}{tolerance}");
    let none = "friction.law=none";
    let slide = |key: &str, set: &str, why: &str| {
        assert!(parse(CD_ROM_SLIDE, &[&of(key)]).is_ok(), "{key}");
        refused(CD_ROM_SLIDE, &[set, &of(key)], &format!("`{key}` has no effect {why}"), "to leave it out");
    };
    slide("vary.friction.coefficient", none, "where the law of friction is \"none\"");
    slide("vary.slide.tilt_x", "slide.gravity=[9.81, 0, 0]", "where gravity is zero, or along the axis of the tilt");
    slide("vary.slide.tilt_z", "slide.gravity=[0, 0, 0]", "where gravity is zero");
    let mechanism = |key: &str, text: &str, why: &str| {
        assert!(parse(LEVER, &[&of(key)]).is_ok(), "{key}");
        refused(text, &[&of(key)], &format!("`{key}` has no effect {why}"), "to leave it out");
    };
    mechanism(
        "vary.friction.coefficient",
        &with(LEVER, "\"regularised\"", "\"none\""),
        "where the law of friction is \"none\"",
    );
    for law in ["hunt-crossley", "lankarani-nikravesh"] {
        let rebound = format!("law = \"{law}\", restitution = 0.5, speed = 100");
        let text = with(LEVER, "damping = \"10 N·s/m\", depth = 0.01", &rebound);
        mechanism("vary.contact.damping", &text, "where no contact has the law \"impact\"");
        assert!(parse(&text, &[&of("vary.contact.stiffness")]).is_ok());
        // One joint with the law is enough.
        let own = "\nnormal = [0, -1]\ncontact = { stiffness = 1, exponent = 1.5, damping = 1, depth = 0.1 }";
        assert!(parse(&with(&text, "\nnormal = [0, -1]", own), &[&of("vary.contact.damping")]).is_ok());
    }
    mechanism("vary.mechanism.tilt_z", &with(LEVER, ", gravity = [0, -9.81]", ""), "where gravity is zero");
    let from = LEVER.find("[[joint]]\nname = \"bumper\"").unwrap();
    let to = LEVER.find("[[drive]]").unwrap();
    let ideal = format!("{}{}", &LEVER[..from], &LEVER[to..]);
    mechanism("vary.contact.stiffness", &ideal, "where no joint has play");
    // Where the law itself is wrong, nothing else is said.
    refused(
        CD_ROM_SLIDE,
        &["friction.law=stribeck", &of("vary.friction.coefficient")],
        "`friction.law` is \"stribeck\"",
        "exact",
    );
}

#[test]
fn mistakes_are_not_blamed_on_something_else() {
    refused(LEVER, &["friction.law=stribeck"], "`friction.law` is \"stribeck\"", "regularised, exact, none");
    refused(LEVER, &["contact.law=hertz"], "`contact.law` is \"hertz\"", "impact, hunt-crossley");
    refused(CD_ROM_SLIDE, &["friction.law=stribeck"], "`friction.law` is \"stribeck\"", "regularised, exact, none");
    let own = with(LEVER, "clearance = [5, 0.1]", "clearance = [5, 0.1]\nfriction = { law = \"stribeck\" }");
    refused(&own, &[], "`joint.friction.law` is \"stribeck\"", "regularised, exact, none");
    refused(LEVER, &["drive.motor.turns=frame"], "`drive.turns` is \"frame\"", "a body that moves: lever");
    refused(LEVER, &["drive.motor.turns=rod"], "there is no body `rod`", "a body that moves: lever");
    refused(
        &with(LEVER, "name = \"lever\"", "name = \"frame\""),
        &[],
        "`body.name` is \"frame\"",
        "what the frame is called",
    );
}

#[test]
fn tables_and_keys_without_effect_are_refused() {
    let beside = format!("{LEVER}\n[slide]\nmass = 10\n");
    refused(
        &beside,
        &[],
        "`slide` beside `mechanism` is not supported",
        "a slide, [slide] and [[pin]], or bodies and joints",
    );
    refused(&format!("{LEVER}\n[[pin]]\nname = \"x\"\n"), &[], "`pin` beside `mechanism`", "or bodies");
    refused(CD_ROM_SLIDE, &["mechanism.space=plane"], "beside `mechanism` is not supported", "[[body]]");
    refused(&format!("{LEVER}\n[drawing]\nclearance = [0.4, 0.4]\n"), &[], "`drawing` beside", "or bodies");
    // With a spring it is a mechanism, whose springs are between two bodies.
    let spring = format!("{CD_ROM_SLIDE}\n[[spring]]\nname = \"s\"\nstiffness = 1\n");
    refused(&spring, &[], "`spring.between` is missing", "a list of two bodies");
    refused(CD_ROM_SLIDE, &["drive.axis=[0, 0, 1]"], "`drive.axis` has no effect", "gain, ramp_start");
    refused(LEVER, &["drive.motor.point=[1, 0]"], "`drive.point` has no effect", "turns");
    refused(LEVER, &["joint.shaft.radius=5"], "`joint.radius` has no effect", "name, kind, between, at");
    refused(LEVER, &["joint.bumper.axis=[1, 0]"], "`joint.axis` has no effect", "normal, clearance");
}

#[test]
fn a_correlation_needs_two_that_vary() {
    let text = |kind: &str| {
        let of =
            |name: &str, kind: &str| format!("[[dimension]]\nname = \"{name}\"\nvalue = 10\ntolerance = 0.1\n{kind}\n");
        format!(
            "{}{}[[correlation]]\nof = [\"a\", \"b\"]\ncoefficient = 0.5\n[[measure]]\nname = \"m\"\nis = \"a + b\"\n",
            of("a", ""),
            of("b", kind)
        )
    };
    assert!(parse(&text(""), &[]).is_ok());
    let constant = with(
        &text("distribution = \"constant\""),
        "value = 10\ntolerance = 0.1\ndistribution",
        "value = 10\ndistribution",
    );
    let error = parse(&constant, &[]).err().unwrap();
    assert!(error.contains("of which \"b\" is constant") && !error.contains("NaN"), "{error}");
    let ranks = format!("tolerance = {{ correlation = \"spearman\" }}\n{constant}");
    assert!(parse(&ranks, &[]).err().unwrap().contains("of which \"b\" is constant"));
}
