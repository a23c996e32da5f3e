//! Bonus tolerances and datum shift against closed forms.

use std::f64::consts::FRAC_1_SQRT_2;

use slipfit_tolerance::{
    analysis::{Theory, analyse, theory},
    counting::study::Settings,
    product::Product,
    sampling::sampler::Method,
};

use super::tests::{check_all, close, product_of};

fn theory_of(product: &Product) -> Theory {
    theory(&product.model, 1, None).unwrap()
}

/// Lowest and highest (mm), by slopes where these describe the measure: closed forms leave out that tilts shorten distances, by
/// some micrometres.
fn worst(theory: &Theory, measure: usize) -> [f64; 2] {
    let found = theory.worst_cases[measure];
    if !theory.moments[measure].described {
        return found.range.map(|x| x * 1e3);
    }
    for (end, linear) in found.range.into_iter().zip(found.linear) {
        close(end * 1e3, linear * 1e3, 5e-3);
    }
    found.linear.map(|x| x * 1e3)
}

fn check_worst(theory: &Theory, measure: usize, expected: [f64; 2]) {
    for (found, expected) in worst(theory, measure).into_iter().zip(expected) {
        close(found, expected, 1e-9);
    }
}

/// Whether second-order theory and drawn units have this standard deviation (mm).
fn check_deviation(product: &Product, measure: usize, expected: f64) {
    close(theory_of(product).moments[measure].deviation * 1e3 / expected, 1.0, 1e-4);
    let settings = Settings { method: Method::PseudoRandom, samples: 20_000, replicates: 1, seed: 1 };
    let found = analyse(&product.model, settings, |_| ()).unwrap().joint.measures[measure].deviation;
    assert!((found.value * 1e3 - expected).abs() < 4e3 * found.error.unwrap(), "{found:?}, not {expected}");
}

fn root(squares: &[f64]) -> f64 {
    libm::sqrt(squares.iter().map(|x| x * x).sum())
}

/// A hole Ø 10 +0.2 in 50 mm from a face; what is left of the wall.
const WALL: &str = r#"
[[part]]
name = "plate"
plane = [
  { name = "A", at = [0, 0, 0], normal = "-z", along = "+x", extents = [100, 100], flatness = "none" },
  { name = "B", at = [-50, 0, 10], normal = "-x", along = "+y", extents = [100, 20], flatness = "none" },
]
axis = [
  { name = "hole", at = [0, 0, 10], along = "+z", length = 20, kind = "hole", diameter = { value = 10, tolerance = [0, 0.2] }, position = { zone = 0.1, material = "maximum", datum = ["plate.A", "plate.B"] } },
]
[[measure]]
name = "from B"
distance = ["plate.hole", "plate.B"]
[[measure]]
name = "wall"
is = "-'from B' - plate.hole.diameter / 2"
[[measure]]
name = "lean"
angle = ["plate.hole", "plate.B"]
"#;

#[test]
fn a_wall_beside_a_hole_at_maximum_material() {
    let plate = product_of(WALL);
    let theory = theory_of(&plate);
    // Least at the largest hole, which also has the greatest bonus; most at the virtual condition 10 − 0.1, whatever the size.
    check_worst(&theory, 1, [50.0 - 5.1 - 0.15, 50.0 - 4.95]);
    check_worst(&theory, 0, [-50.15, -49.85]);
    // A zone of 0.1 + 0.1 in the mean, of which the middle of an axis has less than its ends by √2; and how it and the radius
    // vary with the size.
    let size = 0.1 / 3.0;
    check_deviation(&plate, 1, root(&[0.2 / 6.0 * FRAC_1_SQRT_2, size / 6.0 * FRAC_1_SQRT_2, size / 2.0]));
    assert!(theory.moments[1].described);
    // The size has both in the worst case, the position what is left in the middle.
    let reach: Vec<f64> = theory.sensitivities[1].iter().map(|sensitivity| sensitivity.reach * 1e3).collect();
    close(reach.iter().sum::<f64>(), 0.5 * (45.05 - 44.75), 1e-9);
}

#[test]
fn a_wall_beside_a_hole_at_least_material() {
    let plate = product_of(&WALL.replace("maximum", "least"));
    // Never less than by the virtual condition 10.2 + 0.1; most at the smallest hole.
    check_worst(&theory_of(&plate), 1, [50.0 - 5.15, 50.0 - 5.0 + 0.15]);
    let size = 0.1 / 3.0;
    check_deviation(&plate, 1, root(&[0.2 / 6.0 * FRAC_1_SQRT_2, size / 6.0 * FRAC_1_SQRT_2, size / 2.0]));
    // The same of a pin: here the smallest one has the least material.
    let pin = product_of(&WALL.replace("maximum", "(L)").replace("\"hole\", diameter", "\"pin\", diameter"));
    check_worst(&theory_of(&pin), 1, [50.0 - 5.1 - 0.15, 50.0 - 4.95]);
}

#[test]
fn zero_tolerance_and_a_refinement_at_maximum_material() {
    let refined = |more: &str| {
        let position = "position = { zone = 0.1, material = \"maximum\"";
        product_of(
            &WALL.replace(position, &format!("perpendicularity = {{ {more}, datum = \"plate.A\" }}, {position}")),
        )
    };
    // The axis leans by its zone over its length of 20 mm, at most where the hole is largest.
    let both = theory_of(&refined("zone = 0, material = \"MMC\""));
    let quarter = 90f64.to_radians();
    for (found, expected) in both.worst_cases[2].linear.into_iter().zip([quarter - 0.01, quarter + 0.01]) {
        close(found, expected, 1e-9);
    }
    check_worst(&both, 0, [-50.15, -49.85]);
    // Without a bonus of its own it stays as narrow as it is, and the place has all of its own.
    let one = theory_of(&refined("zone = 0.05"));
    for (found, expected) in one.worst_cases[2].linear.into_iter().zip([quarter - 0.0025, quarter + 0.0025]) {
        close(found, expected, 1e-9);
    }
    check_worst(&one, 1, [44.75, 45.05]);
    // An orientation alone has a bonus, too.
    let alone = WALL.replace("position = { zone = 0.1", "perpendicularity = { zone = 0");
    let alone = theory_of(&product_of(&alone.replace("[\"plate.A\", \"plate.B\"] }", "\"plate.A\" }")));
    close(alone.worst_cases[2].linear[1], quarter + 0.01, 1e-9);
}

/// A pin in a hole, both positioned to the same faces.
const PIN: &str = r#"
[[part]]
name = "box"
plane = [
  { name = "A", at = [0, 0, 0], normal = "+z", along = "+x", extents = [100, 100], flatness = "none" },
  { name = "B", at = [-50, 0, 10], normal = "+x", along = "+y", extents = [100, 20], flatness = "none" },
  { name = "C", at = [0, -50, 10], normal = "+y", along = "+x", extents = [100, 20], flatness = "none" },
]
axis = [{ name = "pin", at = [0, 0, 5], along = "+z", length = 10, kind = "pin", diameter = { value = 10, tolerance = [-0.2, -0.1] }, position = { zone = 0.05, material = "Ⓜ", datum = ["box.A", "box.B", "box.C"] } }]
[[part]]
name = "lid"
plane = [
  { name = "A", at = [0, 0, 0], normal = "-z", along = "+x", extents = [100, 100], flatness = "none" },
  { name = "B", at = [-50, 0, 10], normal = "-x", along = "+y", extents = [100, 20], flatness = "none" },
  { name = "C", at = [0, -50, 10], normal = "-y", along = "+x", extents = [100, 20], flatness = "none" },
]
axis = [{ name = "hole", at = [0, 0, 5], along = "+z", length = 10, kind = "hole", diameter = { value = 10, tolerance = [0.1, 0.3] }, position = { zone = 0.1, material = "Ⓜ", datum = ["lid.A", "lid.B", "lid.C"] } }]
[[mate]]
part = "lid"
contacts = [["lid.A", "box.A"], ["lid.B", "box.B"], ["lid.C", "box.C"]]
[[measure]]
name = "off"
distance = ["lid.hole", "box.pin"]
[[measure]]
name = "gap"
is = "(lid.hole.diameter - box.pin.diameter) / 2 - off"
"#;

#[test]
fn a_pin_in_a_hole_has_the_gap_of_their_virtual_conditions() {
    let theory = theory_of(&product_of(PIN));
    // (10.1 − 0.1) − (9.9 + 0.05), over both sides; at most 10.3 − 9.8 without being off.
    check_worst(&theory, 1, [0.025, 0.25]);
    // Both at least material: 0.1 + 0.2 and 0.05 + 0.1.
    check_worst(&theory, 0, [0.0, 0.225]);
}

/// Holes positioned to a bore, whose axis is square to a face.
const SHIFT: &str = r#"
[[part]]
name = "plate"
plane = [{ name = "A", at = [0, 0, 0], normal = "-z", along = "+x", extents = [100, 100], flatness = "none" }]
axis = [
  { name = "B", at = [0, 0, 10], along = "+z", length = 20, kind = "hole", diameter = { value = 20, tolerance = [0, 0.1] }, perpendicularity = { zone = 0.05, material = "maximum", datum = "plate.A" } },
  { name = "one", at = [30, 0, 10], along = "+z", length = 20, position = { zone = 0.1, datum = ["plate.A", "plate.B (M)"] } },
  { name = "two", at = [-30, 0, 10], along = "+z", length = 20, position = { zone = 0.1, datum = ["plate.A", "plate.B (M)"] } },
]
[[measure]]
name = "arm"
distance = ["plate.one", "plate.B"]
[[measure]]
name = "apart"
distance = ["plate.one", "plate.two"]
"#;

#[test]
fn holes_shift_with_their_datum_in_its_boundary() {
    let plate = product_of(SHIFT);
    let theory = theory_of(&plate);
    // Half of 0.1, and of 20.1 − (20 − 0.05).
    check_worst(&theory, 0, [30.0 - 0.125, 30.0 + 0.125]);
    // Both shift together.
    check_worst(&theory, 1, [59.9, 60.1]);
    check_deviation(&plate, 0, root(&[0.1 / 6.0 * FRAC_1_SQRT_2, 0.1 / 6.0, 0.1 / 36.0]));
    check_deviation(&plate, 1, 0.1 / 6.0);
    // A perpendicularity without Ⓜ leaves the boundary at the smallest hole.
    let own = SHIFT.replace("zone = 0.05, material = \"maximum\"", "zone = 0.05");
    check_worst(&theory_of(&product_of(&own)), 0, [30.0 - 0.1, 30.0 + 0.1]);
    // At least material the boundary is the largest hole.
    let least = product_of(&own.replace("(M)", "Ⓛ"));
    check_worst(&theory_of(&least), 0, [30.0 - 0.1, 30.0 + 0.1]);
    let fixed = product_of(&SHIFT.replace(" (M)", " (S)"));
    check_worst(&theory_of(&fixed), 0, [30.0 - 0.05, 30.0 + 0.05]);
}

#[test]
fn a_hole_that_floats_has_its_largest_play_at_the_limits() {
    let lid = PIN
        .replace("position = { zone = 0.05, material = \"Ⓜ\", datum = [\"box.A\", \"box.B\", \"box.C\"] }", "")
        .replace("position = { zone = 0.1, material = \"Ⓜ\", datum = [\"lid.A\", \"lid.B\", \"lid.C\"] }", "")
        .replace(
            "[\"lid.B\", \"box.B\"], [\"lid.C\", \"box.C\"]",
            "[\"lid.hole\", \"box.pin\"], [\"lid.B\", \"box.B\"]",
        )
        .replace("distance = [\"lid.hole\", \"box.pin\"]", "distance = [\"lid.hole\", \"box.C\"]")
        .replace("- off", "");
    // The largest hole on the smallest pin: half of 10.3 − 9.8.
    check_worst(&theory_of(&product_of(&lid)), 0, [50.0 - 0.25, 50.0 + 0.25]);
}

#[test]
fn what_has_no_condition_of_material_is_named() {
    let hole = "material = \"maximum\"";
    check_all(
        WALL,
        &[
            (hole, "material = \"Ⓟ\"", ["material = |\"Ⓟ", "Ⓟ, a projected tolerance zone, is not supported", "Ⓜ"]),
            (hole, "material = \"(U)\"", ["material = |\"(U)", "an unequally disposed profile", "maximum"]),
            (hole, "material = \"most\"", ["material = |\"most", "is \"most\"", "maximum"]),
            (
                "zone = 0.1, material = \"maximum\"",
                "zone = \"0.1 (M)\"",
                ["zone = |\"0.1 (M)", "Ⓜ, the maximum material condition, behind", "material = \"maximum\""],
            ),
            ("zone = 0.1, material = \"maximum\"", "zone = \"0.1 Ⓣ\"", ["zone = |\"0.1 Ⓣ", "a tangent plane", "least"]),
            ("kind = \"hole\", ", "", ["position = |{", "`plate.hole.kind` is missing", "kind = \"hole\" or \"pin\""]),
            (
                "kind = \"hole\", diameter = { value = 10, tolerance = [0, 0.2] }, ",
                "",
                ["position = |{", "position at maximum material condition without a diameter", "a diameter"],
            ),
            (
                "extents = [100, 20], flatness = \"none\"",
                "extents = [100, 20], position = { zone = 0.1, material = \"MMC\", datum = \"plate.A\" }",
                [
                    "position = |{ zone = 0.1, material = \"MMC",
                    "at maximum material condition of a plane",
                    "pin or hole",
                ],
            ),
            (
                "position = { zone = 0.1, material = \"maximum\", datum = [\"plate.A\", \"plate.B\"] }",
                "straightness = { zone = 0.1, material = \"maximum\" }",
                ["straightness = |{", "straightness at a condition of material", "position"],
            ),
            ("\"plate.B\"] }", "\"plate.B Ⓜ\"] }", ["|\"plate.B Ⓜ", "the datum `plate.B` at maximum", "a diameter"]),
            ("\"plate.B\"] }", "\"plate.B (F)\"] }", ["|\"plate.B (F)", "Ⓕ, the free state, is not", "maximum"]),
            (
                "position = {",
                "perpendicularity = 0.2, position = {",
                ["perpendicularity = |0.2", "perpendicularity that is wider than position at a limit", "narrower"],
            ),
            (
                "position = {",
                "perpendicularity = 0.02, position = { rule = \"truncated\",",
                ["perpendicularity = |0.02", "beside position with a bonus", "sigma-zone"],
            ),
        ],
    );
}
