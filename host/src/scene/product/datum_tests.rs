//! Frames of datums: which datum turns them, and what an incomplete one leaves free.

use slipfit_tolerance::product::Product;

use super::tests::{at, check_all, close, parse, product_of};

fn variable(product: &Product, name: &str) -> usize {
    let at = product.model.contributors.iter().position(|contributor| contributor.name == name);
    product.model.offsets()[at.unwrap_or_else(|| panic!("no {name}"))]
}

/// A plate with a bore and a side face as datums; two points on it that go with the frame, seen from fixed walls.
const PLATE: &str = r#"
[tolerance]
datums = "RULE"
[[part]]
name = "plate"
plane = [
  { name = "A", at = [0, 0, 0], normal = "-z", along = "+x", extents = [120, 80], flatness = "none" },
  { name = "C", at = [40, -30, 0], normal = "-y", along = "+x", extents = [60, 10], flatness = "none", offset = 5, vectorial = { orientation = { x = 0.02 } } },
  { name = "wall x", at = [0, 0, 0], normal = "+x", along = "+y", extents = [10, 10], flatness = "none" },
  { name = "wall y", at = [0, 0, 0], normal = "+y", along = "+x", extents = [10, 10], flatness = "none" },
]
axis = [{ name = "B", at = [0, 0, 0], along = "+z", length = 10, vectorial = { position = { x = 1, y = 1 } } }]
point = [
  { name = "one", at = [60, 0, 0], normal = "+y", profile = { zone = 0.000001, datum = DATUMS } },
  { name = "two", at = [0, 25, 0], normal = "+y", profile = { zone = 0.000001, datum = DATUMS } },
]
[[measure]]
name = "one x"
distance = ["plate.one", "plate.wall x"]
[[measure]]
name = "one y"
distance = ["plate.one", "plate.wall y"]
[[measure]]
name = "two x"
distance = ["plate.two", "plate.wall x"]
[[measure]]
name = "two y"
distance = ["plate.two", "plate.wall y"]
"#;

fn plate(rule: &str, datums: &str) -> Product {
    product_of(&PLATE.replace("RULE", rule).replace("DATUMS", datums))
}

/// Where both points are (mm).
fn points(plate: &Product, values: &[(&str, f64)]) -> [f64; 4] {
    let values: Vec<_> = values.iter().map(|(name, value)| (variable(plate, name), *value)).collect();
    let found = at(plate, &values);
    [0, 1, 2, 3].map(|i| found[i] * 1e3)
}

fn check(found: [f64; 4], expected: [f64; 4], tolerance: f64) {
    for (one, other) in found.into_iter().zip(expected) {
        assert!((one - other).abs() <= tolerance, "{found:?}, not {expected:?}");
    }
}

/// Both points after a turn by `angle` about the bore.
fn turned(angle: f64) -> [f64; 4] {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    [60.0 * c, 60.0 * s, -25.0 * s, 25.0 * c]
}

#[test]
fn two_datums_do_not_turn_the_frame() {
    for rule in ["least-squares", "iso-5459"] {
        let plate = plate(rule, "[\"plate.A\", \"plate.B\"]");
        // The frame goes where the bore goes, and only there.
        let moved = points(&plate, &[("plate.B position x", 0.3e-3), ("plate.B position y", -0.2e-3)]);
        check(moved, [60.3, -0.2, 0.3, 24.8], 1e-9);
        // An axis alone holds neither the turn about it nor the shift along it.
        let alone = self::plate(rule, "\"plate.B\"");
        check(points(&alone, &[("plate.B position y", 0.5e-3)]), [60.0, 0.5, 0.0, 25.5], 1e-9);
    }
}

#[test]
fn the_tertiary_datum_turns_the_frame_by_its_location_alone() {
    let datums = "[\"plate.A\", \"plate.B\", \"plate.C\"]";
    let iso = plate("iso-5459", datums);
    // The face is 0.5 mm further out: the middle of the frame's own face, 50 mm from the bore, comes to lie on it.
    for off in [0.5, -0.5] {
        let angle = libm::atan2(30.0, 40.0) - libm::asin((30.0 + off) / 50.0);
        check(points(&iso, &[("plate.C offset", off * 1e-3)]), turned(angle), 1e-7);
    }
    // A lean about its middle turns nothing.
    check(points(&iso, &[("plate.C orientation x", 0.02)]), turned(0.0), 1e-9);
    // By a least-squares fit it does: lever 40 mm of the middle, 30 mm of half the face, to first order.
    let fit = plate("least-squares", datums);
    let weight = 30.0 * 30.0 / (30.0 * 30.0 + 40.0 * 40.0);
    for lean in [1e-4, -1e-4] {
        check(points(&fit, &[("plate.C orientation x", lean)]), turned(weight * lean), 2e-5);
    }
    let angle = -40.0 * 0.01 / (30.0 * 30.0 + 40.0 * 40.0);
    check(points(&fit, &[("plate.C offset", 0.01e-3)]), turned(angle), 2e-5);
}

#[test]
fn the_secondary_datum_turns_the_frame_by_its_orientation() {
    // After the axis B the face C is the secondary datum, which its lean turns and its offset does not.
    let datums = "[\"plate.B\", \"plate.C\"]";
    let iso = plate("iso-5459", datums);
    check(points(&iso, &[("plate.C offset", 0.5e-3)]), turned(0.0), 1e-9);
    for lean in [0.01, -0.01] {
        // The normal (lean, −1) leans by atan(lean) about z.
        check(points(&iso, &[("plate.C orientation x", lean)]), turned(libm::atan(lean)), 1e-7);
    }
    let fit = plate("least-squares", datums);
    assert!(points(&fit, &[("plate.C offset", 0.5e-3)])[1].abs() > 0.1);
}

/// Three planes leave nothing to choose: the rule makes no difference.
#[test]
fn three_planes_are_the_same_by_both_rules() {
    let text = |rule: &str| {
        format!(
            r#"
[tolerance]
datums = "{rule}"
[[part]]
name = "box"
plane = [
  {{ name = "A", at = [0, 0, 0], normal = "-z", along = "+x", extents = [100, 100], flatness = 0.2 }},
  {{ name = "B", at = [-50, 10, 20], normal = "-x", along = "+y", extents = [80, 40], flatness = 0.2 }},
  {{ name = "C", at = [20, -50, 20], normal = "-y", along = "+x", extents = [60, 40], flatness = 0.2 }},
]
axis = [{{ name = "bore", at = [10, 20, 20], along = "+z", length = 40, position = {{ zone = 0.1, datum = ["box.A", "box.B", "box.C"] }} }}]
[[measure]]
name = "from B"
distance = ["box.bore", "box.B"]
[[measure]]
name = "from C"
distance = ["box.bore", "box.C"]
[[measure]]
name = "lean"
angle = ["box.bore", "box.A"]
"#
        )
    };
    let [one, other] = ["least-squares", "iso-5459"].map(|rule| product_of(&text(rule)));
    let values: Vec<_> = (0..9).map(|i| (i, 0.3 - 0.07 * i as f64)).collect();
    for (one, other) in at(&one, &values).into_iter().zip(at(&other, &values)) {
        close(one, other, 1e-12);
    }
    assert!(one.warnings.iter().all(|warning| !warning.contains("incomplete")), "{:?}", one.warnings);
    check_all(
        &text("iso-5459"),
        &[(
            "\"iso-5459\"",
            "\"iso\"",
            ["datums = |\"iso\"", "`tolerance.datums` is \"iso\"", "least-squares, iso-5459"],
        )],
    );
}

/// A box whose features have the callout of a case.
fn box_with(callout: &str, of: &str) -> String {
    let face = |(name, at, normal, along): (&str, &str, &str, &str)| {
        format!(
            "[[part.plane]]\nname = \"{name}\"\nat = {at}\nnormal = \"{normal}\"\nalong = \"{along}\"\nextents = [100, 40]\n\
             flatness = \"none\"\n"
        )
    };
    let faces = [("A", "[0, 0, 0]", "-z", "+x"), ("B", "[-50, 0, 20]", "-x", "+y"), ("C", "[0, -50, 20]", "-y", "+x")]
        .map(face);
    format!(
        r#"[[part]]
name = "box"
{faces}
[[part.axis]]
name = "D"
at = [0, 0, 20]
along = "+z"
length = 40
[[part.axis]]
name = "bore"
at = [0, 0, 20]
along = "+z"
length = 40
{bore}
[[part.point]]
name = "tip"
at = [0, 0, 40]
normal = "+z"
{tip}
[[part.plane]]
name = "lid"
at = [0, 0, 40]
normal = "+z"
along = "+x"
extents = [100, 100]
flatness = "none"
{lid}
[[measure]]
name = "m"
distance = ["box.tip", "box.A"]
"#,
        faces = faces.concat(),
        lid = if of == "lid" { callout } else { "" },
        bore = if of == "bore" { callout } else { "" },
        tip = if of == "tip" { callout } else { "" },
    )
}

/// The warnings at the `callout` of a feature `of` that box.
fn warned(callout: &str, of: &str) -> Vec<String> {
    let text = box_with(callout, of);
    let first = callout.lines().next().unwrap();
    let place = text.lines().position(|line| line == first).unwrap();
    let column = callout.find('=').unwrap() + 3;
    let warnings = parse(&text, &[]).unwrap_or_else(|error| panic!("{error}")).product.unwrap().warnings;
    let start = format!("scene.toml:{}:{column}: ", place + 1);
    let own = warnings.into_iter().filter_map(|warning| warning.strip_prefix(&start).map(str::to_owned));
    own.collect()
}

#[test]
fn incomplete_frames_are_warned_of_at_their_line() {
    for (of, callout, said) in [
        ("bore", "position = { zone = 0.1, datum = \"box.A\" }", "move along"),
        ("bore", "position = { zone = 0.1, datum = [\"box.A\", \"box.B\"] }", "move along (0.00, 1.00, 0.00)"),
        ("bore", "position = { zone = 0.1, datum = \"box.B\" }", "incomplete frame"),
        ("lid", "position = { zone = 0.1, datum = \"box.B\" }", "incomplete frame"),
        ("lid", "profile = { zone = 0.1, datum = \"box.D\" }", "move along (0.00, 0.00, 1.00)"),
        ("tip", "position = { zone = 0.1, datum = \"box.B\" }", "incomplete frame"),
    ] {
        let warnings = warned(callout, of);
        assert!(warnings.len() == 1 && warnings[0].contains(said), "{callout}: {warnings:?}");
        assert!(warnings[0].contains(&format!("box.{of} ")), "{warnings:?}");
    }
    for (of, callout) in [
        ("bore", "position = { zone = 0.1, datum = [\"box.A\", \"box.B\", \"box.C\"] }"),
        ("bore", "position = { zone = 0.1, datum = [\"box.A\", \"box.D\"] }"),
        ("bore", "coaxiality = { zone = 0.1, datum = \"box.D\" }"),
        ("bore", "run_out = { zone = 0.1, datum = \"box.D\" }"),
        ("bore", "concentricity = { zone = 0.1, datum = \"box.D\" }"),
        ("bore", "perpendicularity = { zone = 0.1, datum = \"box.A\" }"),
        ("lid", "parallelism = { zone = 0.1, datum = \"box.A\" }"),
        ("lid", "position = { zone = 0.1, datum = \"box.A\" }"),
        ("lid", "run_out = { zone = 0.1, datum = \"box.D\" }"),
        ("tip", "profile = { zone = 0.1, datum = \"box.A\" }"),
        ("lid", "perpendicularity = { zone = 0.1, datum = \"box.B\" }"),
        ("lid", "profile = 0.1"),
    ] {
        let warnings = warned(callout, of);
        assert!(warnings.is_empty(), "{callout}: {warnings:?}");
    }
}

#[test]
fn an_orientation_at_another_angle_than_drawn_is_warned_of() {
    for (of, callout, angle) in [
        ("bore", "parallelism = { zone = 0.1, datum = \"box.A\" }", "90.0°"),
        ("lid", "parallelism = { zone = 0.1, datum = \"box.B\" }", "90.0°"),
        ("lid", "perpendicularity = { zone = 0.1, datum = \"box.A\" }", "0.0°"),
    ] {
        let warnings = warned(callout, of);
        let expected = format!("it is drawn at {angle} to its datum box.");
        assert!(warnings.iter().any(|warning| warning.contains(&expected)), "{callout}: {warnings:?}");
    }
}

#[test]
fn a_position_without_a_datum_is_warned_of_at_its_line() {
    for (of, callout) in [
        ("bore", "position = 0.1"),
        ("lid", "position = { zone = 0.1 }"),
        ("tip", "position = 0.1"),
        ("lid", "parallelism = 0.1"),
        ("bore", "perpendicularity = 0.1"),
    ] {
        let warnings = warned(callout, of);
        assert!(warnings.len() == 1 && warnings[0].contains("has no datum"), "{callout}: {warnings:?}");
    }
    // Beside a position the orientation has its datums.
    let both = "position = { zone = 0.1, datum = [\"box.A\", \"box.B\", \"box.C\"] }\nperpendicularity = 0.02";
    assert!(warned(both, "bore").is_empty());
}

#[test]
fn a_datum_stands_once_in_a_list() {
    let text = box_with("position = { zone = 0.1, datum = [\"box.A\", \"box.B\", \"box.A\"] }", "bore");
    let error = parse(&text, &[]).err().unwrap().to_string();
    assert!(error.contains("the datum `box.A` twice") && error.contains("each feature once"), "{error}");
}

#[test]
fn a_direction_that_would_tilt_along_itself_is_warned_of() {
    // The bore goes along z.
    for (axis, warns) in [("x", false), ("y", false), ("z", true)] {
        let text = box_with(&format!("vectorial = {{ orientation = {{ {axis} = 0.01 }} }}"), "bore");
        let warnings = parse(&text, &[]).unwrap_or_else(|error| panic!("{error}")).product.unwrap().warnings;
        let told: Vec<_> = warnings.iter().filter(|warning| warning.contains("does not tilt along itself")).collect();
        assert_eq!(told.len(), usize::from(warns), "{axis}: {warnings:?}");
    }
}
