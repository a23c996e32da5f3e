//! Refinements, datums of their own, common datums, holes on pins, against closed forms.

use nalgebra::{Matrix3, Vector3};
use slipfit_tolerance::{
    analysis,
    model::{Model, Variation},
    product::Product,
    theory::moments,
};

use super::tests::{at, close, parse, product_of};

fn variable(model: &Model, name: &str) -> usize {
    let at = model.contributors.iter().position(|contributor| contributor.name == name);
    model.offsets()[at.unwrap_or_else(|| panic!("no {name}"))]
}

/// A lid 400 × 200 in a profile of 0.3 to its bottom; measured at its corner, and how it leans along its length.
fn lid(more: &str) -> Product {
    product_of(&format!(
        r#"
[[part]]
name = "lid"
plane = [
  {{ name = "bottom", at = [0, 0, 0], normal = "-z", along = "+x", extents = [400, 200] }},
  {{ name = "top", at = [0, 0, 10], normal = "+z", along = "+x", extents = [400, 200], profile = {{ zone = 0.3, datum = "lid.bottom" }}{more} }},
]
point = [{{ name = "end", at = [200, 0, 10], normal = "+z" }}, {{ name = "middle", at = [0, 0, 10], normal = "+z" }}]
[[measure]]
name = "end"
distance = ["lid.top", "lid.end"]
[[measure]]
name = "middle"
distance = ["lid.top", "lid.middle"]
[[measure]]
name = "lean"
is = "(end - middle) / 200 mm"
"#
    ))
}

#[test]
fn a_refinement_narrows_and_adds_nothing() {
    let [alone, refined] = ["", ", parallelism = { zone = 0.1, datum = \"lid.bottom\" }"].map(lid);
    let theory = |product: &Product| analysis::theory(&product.model, 1, None).unwrap();
    let (alone, narrowed) = (theory(&alone), theory(&refined));
    let range = |theory: &analysis::Theory, i: usize| {
        let [low, high] = theory.worst_cases[i].linear;
        0.5 * (high - low)
    };
    for theory in [&alone, &narrowed] {
        // Neither the end nor the middle leaves the profile.
        close(range(theory, 0) * 1e3, 0.15, 1e-9);
        close(range(theory, 1) * 1e3, 0.15, 1e-9);
    }
    // The face leans by its own zone over its length: 0.3, then 0.1 in 400 mm.
    close(range(&alone, 2), 0.3 / 400.0, 1e-9);
    close(range(&narrowed, 2), 0.1 / 400.0, 1e-9);
    close(alone.moments[2].deviation / narrowed.moments[2].deviation, 3.0, 1e-6);
    close(alone.moments[1].deviation, narrowed.moments[1].deviation, 1e-9);
    let [low, high] = narrowed.worst_cases[0].range;
    close((high - low) * 1e3, 0.3, 1e-6);
}

/// A bracket whose hole is positioned to three datums, and square to one other.
const BRACKET: &str = r#"
[[part]]
name = "bracket"
plane = [
  { name = "A", at = [0, 0, 0], normal = "-z", along = "+x", extents = [100, 100], flatness = 0.1 },
  { name = "B", at = [-50, 0, 20], normal = "-x", along = "+y", extents = [100, 40], flatness = 0.1 },
  { name = "C", at = [0, -50, 20], normal = "-y", along = "+x", extents = [100, 40], flatness = 0.1 },
  { name = "D", at = [0, 0, 40], normal = "+z", along = "+x", extents = [100, 100], flatness = 0.1 },
]
axis = [
  { name = "hole", at = [0, 0, 20], along = "+z", length = 40, position = { zone = 0.2, datum = ["bracket.A", "bracket.B", "bracket.C"] }, perpendicularity = { zone = 0.05, datum = "bracket.D" } },
]
[[measure]]
name = "to D"
angle = ["bracket.hole", "bracket.D"]
[[measure]]
name = "to A"
angle = ["bracket.hole", "bracket.A"]
[[measure]]
name = "from B"
distance = ["bracket.hole", "bracket.B"]
"#;

#[test]
fn orientation_has_datums_of_its_own() {
    let bracket = product_of(BRACKET);
    let lean = |name: &str, measure: usize| {
        let tilt = variable(&bracket.model, name) + 1;
        at(&bracket, &[(tilt, 1.0)])[measure]
    };
    // The hole turns with D, not with A: by 0.1 mm over 100 mm.
    let slope = libm::atan(0.1 / 100.0);
    close(lean("bracket.D flatness", 0), 0.0, 1e-7);
    close(std::f64::consts::PI - lean("bracket.D flatness", 1), slope, 1e-7);
    close(lean("bracket.A flatness", 0), 0.0, 1e-7);
    // Its place goes with B, by half the zone.
    let [inwards] = [variable(&bracket.model, "bracket.B flatness")];
    close(at(&bracket, &[(inwards, 1.0)])[2] + 50e-3, 0.0, 1e-7);
    let [moved, still] = [1.0, 0.0].map(|u| at(&bracket, &[(inwards, u)])[2]);
    close(moved, still, 1e-9);
}

/// A shaft on two journals that are one datum, with a seat between.
const SHAFT: &str = r#"
[[part]]
name = "shaft"
axis = [
  { name = "left", at = [0, 0, 0], along = "+x", length = 20, diameter = { value = 20, tolerance = "h6" }, vectorial = { position = { z = 0.1 } } },
  { name = "right-hand", at = [200, 0, 0], along = "+x", length = 20, diameter = { value = 20, tolerance = "h6" }, vectorial = { position = { z = 0.1 } } },
]
plane = [{ name = "shoulder", at = [200, 0, 0], normal = "+x", along = "+y", extents = [30, 30], flatness = "none" }]
point = [{ name = "tip", at = [300, 0, 0], normal = "+z", profile = { zone = 0.001, datum = DATUM } }]
"#;

#[test]
fn two_journals_are_one_datum() {
    for datum in [
        "[\"shaft.left-shaft.right-hand\", \"shaft.shoulder\"]",
        "[[\"shaft.left\", \"shaft.right-hand\"], \"shaft.shoulder\"]",
    ] {
        let text = SHAFT.replace("DATUM", datum)
            + "[[measure]]\nname = \"arm\"\ndistance = [\"shaft.tip\", \"shaft.left\"]\n[[measure]]\nname = \"off\"\ndistance = [\"shaft.tip\", \"shaft.right-hand\"]\n";
        let shaft = product_of(&text);
        let [left, right] =
            ["left", "right-hand"].map(|name| variable(&shaft.model, &format!("shaft.{name} position z")));
        // The axis through both middles: the tip, half as far again out, goes by 3/2 of the right journal, −1/2 of the left.
        let off = |values: &[(usize, f64)]| at(&shaft, values)[0];
        close(off(&[(right, 1e-4)]), 1.5e-4, 1e-9);
        // From the left journal's own axis, which has moved by 1.
        close(off(&[(left, 1e-4)]), 1.5e-4, 1e-9);
        close(off(&[(left, 1e-4), (right, 1e-4)]), 0.0, 1e-9);
    }
    let wrong = SHAFT.replace("DATUM", "\"shaft.left-shaft.shoulder\"")
        + "[[measure]]\nname = \"arm\"\ndistance = [\"shaft.tip\", \"shaft.left\"]\n";
    let error = parse(&wrong, &[]).err().unwrap().to_string();
    assert!(error.contains("a common datum of an axis and a plane is not supported"), "{error}");
}

/// A plate on two pins.
fn plate(holes: &str, pins: &str, more: &str) -> Result<Product, crate::scene::SceneError> {
    let text = format!(
        r#"
[[part]]
name = "base"
plane = [{{ name = "top", at = [0, 0, 0], normal = "+z", along = "+x", extents = [100, 60], flatness = "none" }}]
axis = [
  {{ name = "pin 1", at = [0, 0, 3], along = "+z", length = 6, diameter = {{ value = 10, tolerance = {pins} }} }},
  {{ name = "pin 2", at = [80, 0, 3], along = "+z", length = 6, diameter = {{ value = 10, tolerance = {pins} }} }},
]
[[part]]
name = "plate"
plane = [{{ name = "bottom", at = [0, 0, 0], normal = "-z", along = "+x", extents = [100, 60], flatness = "none" }}]
axis = [
  {{ name = "hole 1", at = [0, 0, 3], along = "+z", length = 6, diameter = {{ value = 10, tolerance = {holes} }} }},
  {{ name = "hole 2", at = [80, 0, 3], along = "+z", length = 6, diameter = {{ value = 10, tolerance = {holes} }}, vectorial = {{ position = {{ x = 0.01 }} }} }},
  {{ name = "bore", at = [160, 0, 3], along = "+z", length = 6 }},
]
[[mate]]
part = "plate"
contacts = [["plate.bottom", "base.top"], ["plate.hole 1", "base.pin 1"], ["plate.hole 2", "base.pin 2"]]
{more}
[[measure]]
name = "off"
distance = ["plate.hole 1", "base.pin 1"]
"#
    );
    parse(&text, &[]).map(|file| file.product.unwrap())
}

#[test]
fn holes_float_on_their_pins() {
    // Play 0.03 to 0.07 mm.
    let product = plate("[0.03, 0.05]", "[-0.02, 0]", "").unwrap();
    assert!(product.warnings.iter().all(|warning| !warning.contains("interference")), "{:?}", product.warnings);
    let play = variable(&product.model, "plate.hole 1 on base.pin 1 play");
    let (hole, pin) =
        (variable(&product.model, "plate.hole 1.diameter"), variable(&product.model, "base.pin 1.diameter"));
    for (hole_at, pin_at, half) in [(10.03e-3, 10e-3, 15e-6), (10.05e-3, 9.98e-3, 35e-6)] {
        let found = at(&product, &[(hole, hole_at), (pin, pin_at), (play, 0.6), (play + 1, -0.8)])[0];
        close(found, half, 1e-12);
    }
    // As far as the play of 0.05 mm in the middle: a radius with a sixth of it along any direction.
    let moments = moments::of_measures(&product.model)[0];
    let sigma = 0.05e-3 / 6.0;
    close(moments.mean / (sigma * libm::sqrt(std::f64::consts::FRAC_PI_2)), 1.0, 0.01);
    assert!(matches!(
        product.model.contributors.iter().find(|c| c.name.ends_with("play")).unwrap().variation,
        Variation::Disc(_)
    ));
    let centred = plate("[0.03, 0.05]", "[-0.02, 0]", "float = \"none\"").unwrap();
    assert!(centred.model.contributors.iter().all(|contributor| !contributor.name.ends_with("play")));
}

#[test]
fn interference_is_told() {
    let warnings = |holes: &str, pins: &str| plate(holes, pins, "").unwrap().warnings.join("\n");
    // Hole and pin overlap at their limits alone.
    let told = warnings("[-0.001, 0.05]", "[-0.05, 0]");
    assert!(told.contains("plate.hole 1 on base.pin 1: interference of 0.001 mm at the limits"), "{told}");
    // In nearly all units.
    let told = warnings("\"P7\"", "\"h6\"");
    assert!(
        told.contains("plate.hole 1 on base.pin 1: interference in 100.0 %") && told.contains("without play"),
        "{told}"
    );
    // Large enough both, but the pitch differs by more than there is room.
    let told = warnings("[0.001, 0.0011]", "[-0.0001, 0]");
    assert!(told.contains("plate.hole 2 on base.pin 2: interference in"), "{told}");
    assert!(!told.contains("hole 1 on"), "{told}");
}

/// A rod of 100 mm that leans from its bearing against a ceiling at 86.6 mm.
const ROD: &str = r#"
[[part]]
name = "frame"
plane = [
  { name = "side", at = [0, 0, 0], normal = "-y", along = "+x", extents = [100, 100], flatness = "none" },
  { name = "ceiling", at = [50, 0, 86.60254037844386], normal = "-z", along = "+x", extents = [100, 100], flatness = "none", offset = OFFSET },
]
axis = [{ name = "bearing", at = [0, 0, 0], along = "+y", length = 10 }]
[[part]]
name = "rod"
plane = [{ name = "side", at = [0, 0, 0], normal = "+y", along = "+x", extents = [100, 100], flatness = "none" }]
axis = [{ name = "journal", at = [0, 0, 0], along = "+y", length = 10 }]
point = [{ name = "tip", at = [50, 0, 86.60254037844386], normal = "+z", flatness = "none" }]
[[mate]]
part = "rod"
contacts = [["rod.journal", "frame.bearing"], ["rod.side", "frame.side"], ["rod.tip", "frame.ceiling"]]
[[measure]]
name = "reach"
distance = ["rod.tip", "frame.bearing"]
[[measure]]
name = "lean"
distance = ["rod.tip", "frame.ceiling"]
"#;

#[test]
fn contacts_that_do_not_close_are_an_error() {
    // Far off, and still closed: Newton's passes go on for as long as it takes.
    let rod = product_of(&ROD.replace("OFFSET", "5"));
    let raised = variable(&rod.model, "frame.ceiling offset");
    for by in [-5e-3, 5e-3] {
        let found = at(&rod, &[(raised, by)]);
        close(found[0], 0.1, 1e-9);
        close(found[1], 0.0, 1e-9);
    }
    // A ceiling beyond the reach of the rod in some units, whose measures have no value, and in many.
    assert!(parse(&ROD.replace("OFFSET", "20"), &[]).is_ok());
    let error = parse(&ROD.replace("OFFSET", "60"), &[]).err().unwrap().to_string();
    assert!(error.contains("the contacts cannot be closed in ") && error.contains("of 1024 units"), "{error}");
}

/// A block in a corner whose floor leans by 4 mm on 100 and whose wall by 4 mm on 10, so that turns differ by their squares.
#[test]
fn a_block_turns_about_the_floor_it_lies_on_until_it_meets_the_wall() {
    let product = product_of(
        r#"
[[part]]
name = "base"
plane = [
  { name = "floor", at = [0, 0, 0], normal = "+z", along = "+x", extents = [100, 60], flatness = { zone = 4 } },
  { name = "wall", at = [0, 30, 5], normal = "-y", along = "+x", extents = [100, 10], flatness = { zone = 4 } },
  { name = "stop", at = [50, 0, 5], normal = "-x", along = "+y", extents = [60, 10] },
  { name = "front", at = [0, -40, 5], normal = "+y", along = "+x", extents = [60, 10] },
]
[[part]]
name = "block"
plane = [
  { name = "bottom", at = [0, 0, 0], normal = "-z", along = "+x", extents = [100, 60] },
  { name = "back", at = [0, 30, 20], normal = "+y", along = "+x", extents = [100, 40] },
  { name = "side", at = [50, 0, 20], normal = "+x", along = "+y", extents = [60, 40] },
]
point = [{ name = "tip", at = [-50, -30, 40], normal = "+z" }]
[[mate]]
part = "block"
contacts = [["block.bottom", "base.floor"], ["block.back", "base.wall"], ["block.side", "base.stop"]]
[[measure]]
name = "from stop"
distance = ["block.tip", "base.stop"]
[[measure]]
name = "from front"
distance = ["block.tip", "base.front"]
"#,
    );
    let [floor, wall] = ["base.floor flatness", "base.wall flatness"].map(|name| variable(&product.model, name));
    for [along, up] in [[1.0, 1.0], [1.0, -1.0], [-1.0, 0.7]] {
        let found = at(&product, &[(floor + 1, along), (wall + 2, up)]);
        let normals = [Vector3::new(-0.04 * along, 0.0, 1.0), Vector3::new(0.0, -1.0, -0.4 * up), -Vector3::x()];
        // What is left of the wall's normal across the floor's is the block's second axis.
        let third = normals[0].normalize();
        let second = -(normals[1] - third * normals[1].dot(&third)).normalize();
        let axes = Matrix3::from_columns(&[second.cross(&third), second, third]);
        let own = [[0.0, 0.0, 0.0], [0.0, 30.0, 20.0], [50.0, 0.0, 20.0]].map(Vector3::from);
        let met = [[0.0, 0.0, 0.0], [0.0, 30.0, 5.0], [50.0, 0.0, 5.0]].map(Vector3::from);
        let short = Vector3::from_fn(|i, _| (met[i] - axes * own[i]).dot(&normals[i]));
        let rows = Matrix3::from_rows(&normals.map(|normal| normal.transpose()));
        let tip = axes * Vector3::new(-50.0, -30.0, 40.0) + rows.try_inverse().unwrap() * short;
        close(found[0] * 1e3, 50.0 - tip.x, 1e-6);
        close(found[1] * 1e3, 40.0 + tip.y, 1e-6);
    }
}
