//! Products of parts, features and mates.

use slipfit_tolerance::{
    analysis,
    model::{
        Variation, ZoneRule,
        nested::{Nest, Nested},
    },
    product::Product,
    theory::{derivative::expansion, moments},
};

use super::tests::{at, check_all, close, parse, product};
use crate::{
    scene::{SceneFile, shipped},
    setup::Scene,
};

fn variable(product: &Product, name: &str) -> usize {
    let mut first = 0;
    for contributor in &product.model.contributors {
        if contributor.name == name {
            return first;
        }
        first += contributor.variation.variables();
    }
    panic!("no {name}");
}

#[test]
fn three_locators() {
    let plate = product("three-locators", &[]);
    let (means, deviations) = moments::spreads(&plate.model);
    let linear = expansion(&plate.model, &means, &deviations);
    let [middle, corner] = &linear.slopes[..] else { panic!("two measures") };
    let deviation = |slopes: &[f64]| libm::sqrt(slopes.iter().zip(&deviations).map(|(s, d)| s * s * d * d).sum());
    let sigma = 0.01e-3;
    // σ·√Σλ², λ the barycentric coordinates of the point in the triangle of the locators: for small turns.
    close(deviation(middle) / sigma, std::f64::consts::FRAC_1_SQRT_2, 1e-9);
    close(deviation(corner) / sigma, libm::sqrt(3.0), 1e-9);
    let of_middle = moments::of_measures(&plate.model)[0];
    close(of_middle.mean, 0.0, 1e-9);
    close(of_middle.deviation / sigma, std::f64::consts::FRAC_1_SQRT_2, 1e-7);
}

/// Table 2: mean and standard deviation (mm) of the left, right, rail and wall gap, pin by pin.
const TABLE_2: [[f64; 2]; 16] = [
    [0.0064, 0.0404],
    [0.4327, 0.0266],
    [-0.0003, 0.0145],
    [0.5757, 0.0465],
    [0.2049, 0.0573],
    [0.7760, 0.0478],
    [0.0002, 0.0148],
    [0.5779, 0.0490],
    [-0.0223, 0.0624],
    [0.4037, 0.0488],
    [-0.0003, 0.0176],
    [0.5754, 0.0581],
    [0.2040, 0.0767],
    [0.7776, 0.0633],
    [0.0002, 0.0177],
    [0.5778, 0.0579],
];

#[test]
fn the_drawing_of_the_slide_gives_table_2() {
    let drawing = product("cd-rom-slide-drawing", &[]);
    let moments = moments::of_measures(&drawing.model);
    for (statistics, expected) in moments.iter().zip(TABLE_2) {
        close(statistics.mean * 1e3, expected[0], 0.5e-4);
        close(statistics.deviation * 1e3, expected[1], 0.5e-4);
    }
    let names: Vec<_> = drawing.model.measures.iter().map(|measure| measure.name.as_str()).collect();
    assert_eq!(
        (names.len(), &names[14..]),
        (18, &["right front rail", "right front wall", "rail distance back", "rail distance front"][..])
    );
    close(drawing.nominal_measures()[17] * 1e3, 144.0, 1e-9);
    // 29 planes of three variables and 18 points of one.
    let zones = drawing.model.contributors.iter().filter(|c| matches!(c.variation, Variation::Zone(_))).count();
    assert_eq!((zones, drawing.model.contributors.len(), drawing.nominal.len()), (29, 47, 29 * 3 + 18));
    assert!(drawing.warnings[0].contains("ISO 2768-2 was withdrawn"));
    let sums: Vec<_> = drawing.model.sums.iter().map(|sum| (sum.name.as_str(), &sum.measures[..])).collect();
    assert_eq!((sums.len(), sums[4]), (8, ("left front across", &[8, 9][..])));
}

#[test]
fn the_slide_runs_from_its_drawing() {
    let file = parse(shipped("cd-rom-slide-drawing").unwrap(), &[]).unwrap();
    let slide = file.slide.as_ref().unwrap();
    let given = Scene::parse("", crate::scene::CD_ROM_SLIDE, &[]).unwrap();
    for (gap, of_table) in slide.gaps_at(&[3.43; 16]).iter().zip(given.gaps_at(&[3.43; 16])) {
        close(gap * 1e3, of_table * 1e3, 3e-4);
    }
    assert_eq!((slide.contact, slide.drive, slide.run), (given.contact, given.drive, given.run));
}

/// A block on a table, held by three planes.
const BLOCK: &str = r#"
[tolerance]
general = "K"
[[part]]
name = "table"
plane = [
  { name = "top", at = [0, 0, 0], normal = "+z", along = "+x", extents = [100, 80] },
  { name = "back", at = [0, 40, 5], normal = "-y", along = "+x", extents = [100, 10], perpendicularity = { datum = "table.top" } },
  { name = "stop", at = [-50, 0, 5], normal = "+x", along = "+y", extents = [80, 10], flatness = "none" },
]
[[part]]
name = "block"
at = [0, 0, 10]
plane = [
  { name = "bottom", at = [0, 0, -10], normal = "-z", along = "+x", extents = [100, 80], flatness = 0.1 },
  { name = "back", at = [0, 40, 0], normal = "+y", along = "+x", extents = [100, 20], flatness = "none" },
  { name = "stop", at = [-50, 0, 0], normal = "-x", along = "+y", extents = [80, 20], flatness = "none" },
]
point = [{ name = "tip", at = [30, -20, 10], normal = "+z", flatness = "none" }]
axis = [{ name = "bore", at = [0, 0, 10], along = "+z", length = 20, position = { zone = 0.2, datum = "block.bottom" }, perpendicularity = 0.1 }]
[[mate]]
part = "block"
contacts = [["block.bottom", "table.top"], ["block.back", "table.back"], ["block.stop", "table.stop"]]
[[measure]]
name = "height"
distance = ["block.tip", "table.top"]
[[measure]]
name = "lean"
angle = ["block.bottom", "table.top"]
"#;

#[test]
fn a_block_follows_the_planes_it_lies_on() {
    let block = parse(BLOCK, &[]).unwrap().product.unwrap();
    close(block.nominal_measures()[0], 20e-3, 1e-15);
    close(block.nominal_measures()[1], std::f64::consts::PI, 1e-7);
    let bottom = variable(&block, "block.bottom flatness");
    // u = 1 is half of the zone: outwards is down, so that the block rises.
    close(at(&block, &[(bottom, 1.0)])[0], 20e-3 + 0.05e-3, 1e-12);
    // p = 1: the face is t/2 higher (outwards, down) at one end of 100 mm, and the block turns to lie flat again.
    for p in [-1.0, 1.0] {
        let slope = p * 0.1 / 100.0;
        let expected = (20e-3 + slope * 30e-3) / libm::sqrt(1.0 + slope * slope);
        close(at(&block, &[(bottom + 1, p)])[0], expected, 1e-12);
    }
    // The mating faces always come to lie on each other.
    let lean = at(&block, &[(bottom, 0.5), (bottom + 1, 0.7), (bottom + 2, -0.4), (0, 0.3), (1, -0.6), (2, 0.8)])[1];
    close(lean, std::f64::consts::PI, 1e-7);
}

#[test]
fn general_geometry_and_datums() {
    let block = parse(BLOCK, &[]).unwrap().product.unwrap();
    let names: Vec<_> = block.model.contributors.iter().map(|contributor| contributor.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "table.top flatness",
            "table.back perpendicularity",
            "block.bottom flatness",
            "block.bore position, perpendicularity",
        ]
    );
    // K: flatness 0.2 mm on 100 mm; half of it is u = 1.
    let raised = at(&block, &[(0, 1.0)])[0];
    close(raised, 20e-3, 1e-12);
    // Half as wide as the position, the perpendicularity narrows the tilts.
    let nested = Nested { of: Nest::Axis, rule: ZoneRule::SigmaZone, tilts: 0.5 };
    assert_eq!(block.model.contributors[3].variation, Variation::Nested(nested));
}

/// Two holes 50 mm apart along a slant, each anywhere in its cylindrical zone without a lean.
const HOLES: &str = r#"
[tolerance]
rule = "translation"
[[part]]
name = "plate"
plane = [{ name = "face", at = [0, 0, 0], normal = "-z", along = "+x", extents = [80, 80] }]
axis = [
  { name = "one", at = [0, 0, 5], along = "+z", length = 10, position = { zone = 0.2, datum = "plate.face" } },
  { name = "two", at = [30, 40, 5], along = "+z", length = 10, position = { zone = 0.2, datum = "plate.face" } },
  { name = "same", at = [0, 0, 5], along = "+z", length = 10, position = { zone = 0.2, datum = "plate.face" } },
]
[[measure]]
name = "apart"
distance = ["plate.one", "plate.two"]
[[measure]]
name = "off"
distance = ["plate.one", "plate.same"]
"#;

#[test]
fn a_cylindrical_zone_is_a_disc() {
    let plate = parse(HOLES, &[]).unwrap().product.unwrap();
    let theory = analysis::theory(&plate.model, 1, None).unwrap();
    // Each axis gives a tenth of a millimetre along any direction, not a square's diagonal.
    let [low, high] = theory.worst_cases[0].linear;
    close(low * 1e3, 49.8, 1e-6);
    close(high * 1e3, 50.2, 1e-6);
    close(theory.moments[0].deviation * 1e3, 0.2 / 6.0 * libm::sqrt(2.0), 1e-6);
    for (share, expected) in theory.sums_of_squares[0].shares.iter().zip([0.5, 0.5, 0.0]) {
        close(*share, expected, 1e-6);
    }
    // The distance of two axes that coincide on the drawing is a radius: Rayleigh's distribution.
    assert!(theory.moments[0].described && !theory.moments[1].described);
    let spread = 0.2 / 6.0 * libm::sqrt(2.0);
    close(theory.moments[1].mean * 1e3, spread * libm::sqrt(std::f64::consts::FRAC_PI_2), 2e-4 * spread);
    close(theory.moments[1].deviation * 1e3, spread * libm::sqrt(2.0 - std::f64::consts::FRAC_PI_2), 2e-4 * spread);
    let [least, greatest] = theory.worst_cases[1].range;
    close(least, 0.0, 1e-9);
    close(greatest * 1e3, 0.2, 1e-6);
    let total = &theory.indices[1].as_ref().unwrap().total;
    close(total[0] / (total[0] + total[2]), 0.5, 0.02);
    close(total[1], 0.0, 1e-9);
}

#[test]
fn an_angle_at_its_end_is_a_fold() {
    let lid = product("lid-on-pins", &["part.box.plane.rim.parallelism.zone=0.2"]);
    let theory = analysis::theory(&lid.model, 1, None).unwrap();
    let moments = theory.moments[2];
    assert!(!moments.described && theory.moments[0].described && theory.moments[3].described);
    close(moments.mean.to_degrees(), 179.927, 1e-3);
    let [least, greatest] = theory.worst_cases[2].range.map(f64::to_degrees);
    close(greatest, 180.0, 1e-6);
    // Of 100,000 units the least has 179.7.
    assert!((179.0..179.7).contains(&least), "{least}");
}

#[test]
fn a_turned_part_takes_what_lies_on_it_along() {
    let lid = product("lid-on-pins", &[]);
    let nominal = lid.nominal_measures();
    for (found, expected) in nominal.iter().zip([4e-3, libm::sqrt(0.04 * 0.04 + 0.02 * 0.02), std::f64::consts::PI]) {
        close(*found, expected, 1e-9);
    }
    // The bearing's lean lowers the tip by what of its arm points that way.
    let lean = variable(&lid, "lid.bearing orientation x");
    for (by, angle) in [("30°", 30f64), ("120°", 120.0)] {
        let lid = product("lid-on-pins", &[&format!("mate.lever.turn.by={by}")]);
        let expected = 4e-3 - 0.002 * 0.03 * libm::cos(angle.to_radians());
        close(at(&lid, &[(lean, 0.002)])[0], expected, 1e-8);
    }
    for (name, half) in [("lid.bearing position x", 0.05e-3), ("lid.bearing orientation y", 0.002)] {
        let contributor = lid.model.contributors.iter().find(|contributor| contributor.name == name).unwrap();
        let Variation::Scalar { limits, .. } = contributor.variation else { panic!("a plane") };
        close(limits[1], half, 1e-12);
    }
}

#[test]
fn bad_parts_are_shown_with_their_place_and_what_is_allowed() {
    let bottom = "flatness = 0.1 }";
    let datum = "perpendicularity = { datum = \"table.top\" }";
    let contacts = "[\"block.stop\", \"table.stop\"]]";
    let cases = [
        (
            "\"table.top\" } }",
            "\"table.topp\" } }",
            ["datum = |\"table.topp", "no feature `table.topp`", "such as table.top"],
        ),
        (bottom, "flatness = 0 }", ["flatness = |0 }", "flatness` is 0 mm", "more than 0"]),
        (bottom, "flatness = -0.1 }", ["flatness = |-0.1", "is -0.1 mm", "0 to"]),
        (bottom, "cylindricity = 0.1 }", ["|cylindricity", "cylindricity is not supported", "flatness, straightness"]),
        (bottom, "flatnes = 0.1 }", ["|flatnes ", "did you mean `part.plane.flatness`", "name, at, normal"]),
        (
            bottom,
            "flatness = { zone = 0.1, datum = \"table.top\" } }",
            ["zone = 0.1, datum = |\"table.top\" } }", "a datum of part.plane.flatness is not", "no datum"],
        ),
        (
            bottom,
            "angularity = { datum = \"table.top\" } }",
            ["angularity = |{", "zone` is missing", "the width of its zone"],
        ),
        (
            bottom,
            "parallelism = { zone = 0.1, datum = \"table.top\" } }",
            ["|{ name = \"bottom", "of another part is not", "same part"],
        ),
        (
            datum,
            "perpendicularity = { zone = 0.1, rule = \"translation\" }",
            ["rule = |\"trans", "by the rule translation is not", "with tilts"],
        ),
        (datum, "profile = { zone = 0.1, datum = [] }", ["datum = |[]", "is a list of 0", "one to three"]),
        (datum, "offset = { tolerance = 0 }", ["tolerance = |0 }", "is 0 mm", "more than 0"]),
        (
            "extents = [100, 80] },\n  { name = \"back",
            "extents = [4000, 80] },\n  { name = \"back",
            ["extents = |[4000", "no flatness for 4000 mm", "up to 3000 mm"],
        ),
        ("extents = [100, 20]", "extents = [0, 20]", ["extents = [|0", "is 0 mm", "0.000001 to"]),
        ("normal = \"+z\", along", "normal = [0, 0, 0], along", ["normal = |[0", "part.plane.normal", "not all 0"]),
        ("normal = \"+z\", along", "normal = \"z\", along", ["normal = |\"z", "is \"z\"", "\"+x\""]),
        (
            "normal = \"+z\", along = \"+x\"",
            "normal = \"+z\", along = \"+z\"",
            ["along = |\"+z\", ext", "part.plane.along", "right angle"],
        ),
        (
            "normal = \"+z\", flatness = \"none\" }",
            "normal = \"+z\" }",
            ["point = [|{", "extents` is missing", "flatness = \"none\""],
        ),
        (
            "normal = \"+z\", flatness = \"none\" }",
            "normal = \"+z\", straightness = 1 }",
            ["|straightness = 1", "unknown key `part.point.straightness`", "profile"],
        ),
        (
            "name = \"back\", at = [0, 40, 5]",
            "name = \"top\", at = [0, 40, 5]",
            ["name = |\"top\", at = [0, 40", "is \"top\" again", "each feature"],
        ),
        ("name = \"block\"", "name = \"table\"", ["name = |\"table\"\nat", "is \"table\" again", "each part"]),
        ("part = \"block\"", "part = \"table\"", ["part = |\"table", "the part `table` is placed already", "one mate"]),
        ("part = \"block\"", "part = \"blok\"", ["part = |\"blok", "there is no part `blok`", "table, block"]),
        (
            contacts,
            "]",
            [
                "part = |\"block\"\ncon",
                "1 of 6 freedoms are left, it can still move along (1.00, 0.00, 0.00)",
                "all six",
            ],
        ),
        (
            contacts,
            "[\"block.back\", \"table.top\"]]",
            ["[|\"block.back\", \"table.top\"]]", "over-constrained", "3, 2 and 1 freedoms"],
        ),
        (
            contacts,
            "[\"block.stop\", \"table.stop\"], [\"block.bottom\", \"table.top\"]]",
            ["[|\"block.bottom\", \"table.top\"]]", "over-constrained", "3, 2 and 1 freedoms"],
        ),
        (
            contacts,
            "[\"block.stop\", \"table.stop\"]]\nmove = { along = \"+x\", by = 3 }",
            ["move = |{", "over-constrained", "each hold something"],
        ),
        (
            contacts,
            "[\"block.bore\", \"table.stop\"]]",
            ["\"block.bore\", |\"table.stop", "a contact of an axis and a plane is not", "axis and axis"],
        ),
        (contacts, "[\"block.stop\", \"block.stop\"]]", ["|[[mate]]", "the mates form a loop: block", "lead back"]),
        (
            contacts,
            "[\"table.stop\", \"table.stop\"]]",
            ["[|\"table.stop\"", "no feature of `block` `table.stop`", "pairs"],
        ),
        (contacts, "[\"block.stop\"]]", ["|[\"block.stop\"]]", "is a list of 1", "pairs"]),
        (
            "[\"block.tip\", \"table.top\"]",
            "[\"block.tipp\", \"table.top\"]",
            ["[|\"block.tipp", "`block.tipp`", "such as block.tip"],
        ),
        ("angle = [", "is = \"1\"\nangle = [", ["angle = |[", "a measure of two kinds is not", "one of"]),
        (
            "angle = [\"block.bottom",
            "angle = [\"block.tip",
            ["angle = |[\"block.tip", "an angle of a point", "planes and axes"],
        ),
        ("angle = [", "was = [", ["|was", "unknown key `measure.was`", "distance"]),
    ];
    check_all(BLOCK, &cases);
}

#[test]
fn mates_in_a_loop() {
    let mut text = String::new();
    for part in ["ground", "a", "b"] {
        text +=
            &format!("[[part]]\nname = \"{part}\"\npoint = [{{ name = \"p\", at = [0, 0, 0], normal = \"+z\" }}]\n");
    }
    for (part, on) in [("a", "b"), ("b", "a")] {
        text += &format!("[[mate]]\npart = \"{part}\"\ncontacts = [[\"{part}.p\", \"{on}.p\"]]\n");
    }
    text += "[[measure]]\nname = \"m\"\ndistance = [\"a.p\", \"b.p\"]\n";
    check_all(&text, &[("", "", ["|[[mate]]", "the mates form a loop: a, b", "lead back to the first part"])]);
    let (unplaced, _) = text.split_once("[[mate]]\npart = \"b").unwrap();
    let unplaced = unplaced.replace("b.p", "ground.p") + "[[measure]]\nname = \"m\"\nis = \"1\"";
    check_all(
        &unplaced,
        &[("", "", ["name = |\"b\"", "no mate places the part `b`: it is under-constrained", "one mate"])],
    );
}

proptest::proptest! {
    #[test]
    fn no_change_of_a_product_panics(
        at in 0..BLOCK.len(),
        length in 0..12usize,
        insert in "[-0-9.e\"\\[\\]=a-z{},]{0,4}",
    ) {
        let mut text = BLOCK.to_owned().into_bytes();
        text.splice(at..(at + length).min(BLOCK.len()), insert.into_bytes());
        if let Err(error) = SceneFile::parse("scene.toml", &String::from_utf8_lossy(&text), &[]) {
            proptest::prop_assert!(error.to_string().contains("scene.toml:"));
        }
    }
}
