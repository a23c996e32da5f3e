//! Run-out, coaxiality, concentricity, symmetry, roundness and cylindricity against closed forms.

use std::f64::consts::FRAC_1_SQRT_2;

use slipfit_tolerance::theory::{derivative::expansion, moments, worst_case::linear};

use super::tests::{check_all, close, product_of};

/// Worst case and standard deviation of every measure (mm or rad), by their slopes.
fn spreads(text: &str) -> Vec<([f64; 2], f64)> {
    let product = product_of(text);
    let model = &product.model;
    let (_, deviations) = moments::spreads(model);
    let worst = linear(model, &expansion(model, &model.middles(), &deviations));
    worst.into_iter().zip(moments::of_measures(model)).map(|(worst, moments)| (worst, moments.deviation)).collect()
}

/// A shaft on two journals, with a seat in the middle between them and a shoulder.
const SHAFT: &str = r#"
[[part]]
name = "shaft"
axis = [
  { name = "left", at = [-100, 0, 0], along = "+x", length = 20, vectorial = { position = { z = JOURNAL } } },
  { name = "right", at = [100, 0, 0], along = "+x", length = 20, vectorial = { position = { z = JOURNAL } } },
  { name = "seat", at = [0, 0, 0], along = "+x", length = 40, kind = "pin", diameter = { value = 30, tolerance = [-0.1, 0] }, CALLOUT },
]
plane = [
  { name = "floor", at = [0, 0, -50], normal = "+z", along = "+x", extents = [100, 100], flatness = "none" },
  { name = "shoulder", at = [20, 0, 0], normal = "+x", along = "+y", extents = [50, 50], run_out = { zone = 0.04, datum = "shaft.left-shaft.right" } },
]
[[measure]]
name = "height"
distance = ["shaft.seat", "shaft.floor"]
[[measure]]
name = "lean"
angle = ["shaft.seat", "shaft.floor"]
[[measure]]
name = "wobble"
angle = ["shaft.shoulder", "shaft.floor"]
"#;

fn shaft(journal: &str, callout: &str) -> Vec<([f64; 2], f64)> {
    let callout = callout.replace("DATUM", "datum = \"shaft.left-shaft.right\"");
    spreads(&SHAFT.replace("JOURNAL", journal).replace("CALLOUT", &callout))
}

fn check(found: ([f64; 2], f64), middle: f64, half: f64, deviation: f64, unit: f64) {
    let [low, high] = found.0.map(|x| x * unit);
    close(low, middle - half, 1e-9);
    close(high, middle + half, 1e-9);
    close(found.1 * unit, deviation, 1e-5 * half);
}

#[test]
fn what_runs_out_lies_in_a_cylinder_about_its_datum() {
    let quarter = 90f64.to_radians();
    for name in ["run_out", "total_run_out", "coaxiality"] {
        // The axis is off by half of what the gauge shows in a turn, and leans by all of it over its length.
        let found = shaft("\"0.000001 mm\"", &format!("{name} = {{ zone = 0.06, DATUM }}"));
        // Both have equal parts in the σ of its ends, a sixth of the zone.
        check(found[0], 50.0, 0.03 + 1e-6, 0.01 * FRAC_1_SQRT_2, 1e3);
        let leant = 0.06 / 40.0;
        close(found[1].0[1] - quarter, leant, 2e-8);
        close(found[1].1, leant / 3.0 * FRAC_1_SQRT_2, 1e-5 * leant);
        // The shoulder wobbles by its own over its diameter.
        close(found[2].0[1] - quarter, 0.04 / 50.0, 2e-8);
    }
    // The seat goes with the middle of both journals.
    let found = shaft("0.1", "run_out = { zone = 0.06, DATUM }");
    let journal = 0.1 / 3.0;
    check(found[0], 50.0, 0.03 + 0.1, libm::sqrt(0.5e-4 + 0.5 * journal * journal), 1e3);
    // And the shoulder leans with the line through both.
    close(found[2].0[1] - quarter, 0.04 / 50.0 + 0.2 / 200.0, 2e-8);
}

#[test]
fn concentricity_is_of_the_middle_and_coaxiality_has_a_bonus() {
    let concentric = shaft("\"0.000001 mm\"", "concentricity = { zone = 0.06, DATUM }");
    check(concentric[0], 50.0, 0.03 + 1e-6, 0.01, 1e3);
    close(concentric[1].0[1] - concentric[1].0[0], 0.0, 4e-8);
    // 0.1 mm of the diameter at the smallest pin.
    let coaxial = shaft("\"0.000001 mm\"", "coaxiality = { zone = 0.06, material = \"maximum\", DATUM }");
    close(coaxial[0].0[1] * 1e3, 50.08 + 1e-6, 1e-9);
    close(coaxial[1].0[1] - 90f64.to_radians(), 0.16 / 40.0, 2e-8);
    // A refinement narrows the tilts; an end keeps its σ.
    let refined = shaft("\"0.000001 mm\"", "coaxiality = { zone = 0.06, DATUM }, parallelism = { zone = 0.02, DATUM }");
    check(refined[0], 50.0, 0.03 + 1e-6, 0.01 * libm::sqrt(8.0) / 3.0, 1e3);
    close(refined[1].0[1] - 90f64.to_radians(), 0.02 / 40.0, 2e-8);
}

#[test]
fn the_form_of_a_surface_moves_the_axis_that_mates_find() {
    let round = shaft("\"0.000001 mm\"", "roundness = 0.012");
    check(round[0], 50.0, 0.006, 0.002, 1e3);
    close(round[1].0[1] - round[1].0[0], 0.0, 1e-9);
    let cylindrical = shaft("\"0.000001 mm\"", "cylindricity = 0.012");
    check(cylindrical[0], 50.0, 0.006, 0.002 * FRAC_1_SQRT_2, 1e3);
    close(cylindrical[1].0[1] - 90f64.to_radians(), 0.012 / 40.0, 1e-9);
    // It comes on top of where the axis is, and lies within a run-out, which is of the surface.
    let placed = shaft("\"0.000001 mm\"", "concentricity = { zone = 0.06, DATUM }, roundness = 0.012");
    check(placed[0], 50.0, 0.036 + 1e-6, libm::sqrt(1e-4 + 4e-6), 1e3);
    let within = shaft("\"0.000001 mm\"", "run_out = { zone = 0.06, DATUM }, roundness = 0.012");
    check(within[0], 50.0, 0.03 + 1e-6, 0.01 * FRAC_1_SQRT_2, 1e3);
}

#[test]
fn symmetry_is_between_two_planes() {
    let found = spreads(
        r#"
[[part]]
name = "fork"
plane = [
  { name = "middle", at = [0, 0, 0], normal = "+y", along = "+x", extents = [40, 40], flatness = "none" },
  { name = "tongue", at = [0, 0, 10], normal = "+y", along = "+x", extents = [20, 10], symmetry = { zone = 0.2, datum = "fork.middle" } },
  { name = "end", at = [20, 0, 0], normal = "+x", along = "+y", extents = [40, 40], flatness = "none" },
]
axis = [{ name = "bolt", at = [10, 0, 0], along = "+z", length = 20, symmetry = { zone = 0.12, datum = "fork.middle" } }]
[[measure]]
name = "off"
distance = ["fork.bolt", "fork.middle"]
[[measure]]
name = "from end"
distance = ["fork.bolt", "fork.end"]
[[measure]]
name = "tongue"
distance = ["fork.tongue", "fork.middle"]
"#,
    );
    check(found[0], 0.0, 0.06, 0.02, 1e3);
    close(found[1].0[1] - found[1].0[0], 0.0, 1e-15);
    check(found[2], 0.0, 0.1, 0.1 / (3.0 * libm::sqrt(3.0)), 1e3);
}

#[test]
fn callouts_that_are_none_are_named_however_they_are_written() {
    let text = SHAFT.replace("JOURNAL", "0.1").replace("CALLOUT", "roundness = 0.1");
    let seat = "roundness = 0.1";
    let unknown = |written: &str| format!("{written} = 0.1");
    for (written, name) in [
        ("\"⌖\"", "position"),
        ("\"↗\"", "run_out"),
        ("runout", "run_out"),
        ("\"total run-out\"", "total_run_out"),
        ("\"◎\"", "coaxiality"),
        ("circularity", "roundness"),
    ] {
        let meant = format!("did you mean `part.axis.{name}`");
        check_all(&text, &[(seat, &unknown(written), [&format!("|{written}"), &meant, "coaxiality"])]);
    }
    for (written, name) in [
        ("\"⌓\"", "⌓, profile, is not supported"),
        ("\"⌒\"", "the profile of a line"),
        ("projected_zone", "a projected tolerance zone"),
        ("\"cz\"", "a combined zone"),
        ("\"Ⓔ\"", "the envelope requirement"),
    ] {
        check_all(&text, &[(seat, &unknown(written), [&format!("|{written}"), name, "coaxiality"])]);
    }
    let about = "{ zone = 0.1, datum = \"shaft.left\" }";
    check_all(
        &text,
        &[
            (
                seat,
                "run_out = 0.1",
                ["run_out = |0.1", "`part.axis.run_out.datum` is missing", "the axis that it is about"],
            ),
            (
                "run_out = { zone = 0.04, datum = \"shaft.left-shaft.right\" }",
                "run_out = { zone = 0.04, datum = \"shaft.floor\" }",
                ["datum = |\"shaft.floor", "run_out to a plane is not supported", "the axis"],
            ),
            (
                "at = [0, 0, 0], along = \"+x\", length = 40, kind = \"pin\", diameter = { value = 30, tolerance = [-0.1, 0] }, roundness = 0.1",
                &format!("at = [0, 0, 1], along = \"+x\", length = 40, coaxiality = {about}"),
                ["datum = |\"shaft.left\" }", "coaxiality of a feature that the drawing has off its datum", "one line"],
            ),
            (
                seat,
                "run_out = { zone = 0.1, material = \"MMC\", datum = \"shaft.left\" }",
                ["run_out = |{", "run_out at a condition of material is not supported", "coaxiality"],
            ),
            (
                seat,
                &format!("position = 0.1, run_out = {about}"),
                ["run_out = |{", "run_out beside position of one feature", "the narrower one"],
            ),
            (seat, "position = { zone = 0.1, \"Ⓟ\" = 5 }", ["|\"Ⓟ\"", "Ⓟ, a projected tolerance zone,", "material"]),
            (
                seat,
                "position = { zone = 0.1, mmc = true }",
                ["|mmc", "did you mean `part.axis.position.material`", "rule"],
            ),
        ],
    );
}

/// Two holes 40 mm apart, 0.8 to their datums and 0.2 within their pattern.
const PATTERN: &str = r#"
[[part]]
name = "plate"
plane = [
  { name = "A", at = [0, 0, 0], normal = "-z", along = "+x", extents = [100, 100], flatness = "none" },
  { name = "B", at = [-50, 0, 10], normal = "-x", along = "+y", extents = [100, 20], flatness = "none" },
  { name = "C", at = [0, -50, 10], normal = "-y", along = "+x", extents = [100, 20], flatness = "none" },
]
axis = [
  { name = "one", at = [-20, 0, 10], along = "+z", length = 20, POSITION },
  { name = "two", at = [20, 0, 10], along = "+z", length = 20, POSITION },
]
[[measure]]
name = "one from C"
distance = ["plate.one", "plate.C"]
[[measure]]
name = "two from C"
distance = ["plate.two", "plate.C"]
[[measure]]
name = "skew"
is = "'one from C' - 'two from C'"
[[measure]]
name = "apart"
distance = ["plate.one", "plate.two"]
"#;

#[test]
fn a_pattern_turns_and_its_holes_vary_within() {
    let position =
        "position = { zone = 0.8, within = 0.2, pattern = \"bolts\", datum = [\"plate.A\", \"plate.B\", \"plate.C\"] }";
    let text = PATTERN.replace("POSITION", position);
    let found = spreads(&text);
    // Each hole stays in the wider zone; half of 0.6 by the pattern, which shifts or turns, the rest by itself, whose middle has
    // less σ than its ends by √2.
    check(found[0], -50.0, 0.4, libm::sqrt(0.01 + 0.01 / 18.0), 1e3);
    // Both to opposite sides, by the turn and by themselves.
    check(found[2], 0.0, 0.8, libm::sqrt(0.02 + 0.02 / 18.0), 1e3);
    // Along the line through both only what each has within the pattern.
    let [low, high] = found[3].0.map(|x| x * 1e3);
    close(low, 39.8, 1e-9);
    close(high, 40.2, 1e-9);
    // The primary datum alone does not keep the pattern from turning; with a second one it shifts only.
    let held = |datums: &str| spreads(&text.replace("within = 0.2", &format!("within = 0.2, within_datum = {datums}")));
    assert_eq!(held("\"plate.A\""), found);
    let shifted = held("[\"plate.A\", \"plate.B\"]");
    check(shifted[0], -50.0, 0.4, libm::sqrt(0.01 + 0.01 / 18.0), 1e3);
    check(shifted[2], 0.0, 0.2, libm::sqrt(0.02 / 18.0), 1e3);
    check_all(
        &text,
        &[
            (", within = 0.2", "", ["position = |{", "`part.axis.position.within` is missing", "two or more axes"]),
            (
                "within = 0.2",
                "within = 0.2, within_datum = \"plate.B\"",
                ["within_datum = |\"plate.B\"", "other than the first datums of the zone", "in their order"],
            ),
            (
                ", within = 0.2, pattern = \"bolts\"",
                ", within_datum = \"plate.A\"",
                ["position = |{", "pattern` is missing", "two or"],
            ),
            ("within = 0.2", "within = 0.9", ["within = |0.9", "is 0.9 mm", "less than the zone of the pattern"]),
            (
                "pattern = \"bolts\"",
                "pattern = \"nuts\"",
                ["|\"nuts\"", "the pattern `plate.nuts` of one axis", "two or"],
            ),
            (
                "zone = 0.8",
                "zone = 0.7",
                ["|\"bolts\", datum = [\"plate.A\", \"plate.B\", \"plate.C\"] } },\n]", "different zones", "same"],
            ),
            (
                "flatness = \"none\"",
                "position = { zone = 1, within = 0.2, pattern = \"bolts\" }",
                ["|\"bolts\" } },\n  { name = \"B", "a composite position of a plane", "axes"],
            ),
        ],
    );
}
