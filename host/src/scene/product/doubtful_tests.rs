//! What is accepted and still hardly meant: warnings at their line. And keys that would do nothing: errors.

use super::tests::{check_all, parse};
use crate::scene::shipped;

fn warnings(text: &str) -> Vec<String> {
    parse(text, &[]).unwrap_or_else(|error| panic!("{error}")).product.unwrap().warnings
}

/// What varies of a slide and of a mechanism has the same warnings and refusals.
#[test]
fn what_varies_over_a_production_is_looked_at_alike() {
    let vary = "\n[vary.friction]\ncoefficient = { tolerance = 0.01, distribution = { kind = \"normal\", deviation = 0.02 } }\n";
    let said = "62 % of the units are outside of the tolerance";
    let slide = shipped("cd-rom-slide").unwrap().to_owned() + vary;
    let told = parse(&slide, &[]).unwrap().slide.unwrap().warnings;
    let line = slide.lines().count();
    assert!(
        told.len() == 1 && told[0].starts_with(&format!("scene.toml:{line}:")) && told[0].contains(said),
        "{told:?}"
    );
    let mechanism = shipped("hatch").unwrap().to_owned() + vary;
    let told = parse(&mechanism, &[]).unwrap().mechanism.unwrap().warnings;
    assert!(told.len() == 1 && told[0].contains(said), "{told:?}");
    let ignored = vary.replace("\"normal\", deviation", "\"uniform\", deviation");
    let error = parse(&(shipped("hatch").unwrap().to_owned() + &ignored), &[]).err().unwrap().to_string();
    assert!(error.contains("`vary.friction.coefficient.distribution.deviation` has no effect"), "{error}");
}

/// A dimension of 5 mm with further `keys` from its fourth line on.
fn dimension(keys: &str) -> String {
    format!("[[dimension]]\nname = \"x\"\nvalue = 5\n{keys}\n[[measure]]\nname = \"m\"\nis = \"x\"\n")
}

/// Whether the `keys` have one warning, at this place of theirs, or none.
fn check(keys: &str, expected: Option<(&str, &str)>) {
    let text = dimension(&keys.replace('|', ""));
    let found = warnings(&text);
    match expected {
        None => assert!(found.is_empty(), "{keys}: {found:?}"),
        Some((marked, said)) => {
            let start = text.find(&marked.replace('|', "")).unwrap() + marked.find('|').unwrap();
            let before = &text[..start];
            let column = before.rsplit('\n').next().unwrap().len() + 1;
            let place = format!("scene.toml:{}:{column}: ", before.matches('\n').count() + 1);
            assert!(found.len() == 1 && found[0].starts_with(&place) && found[0].contains(said), "{keys}: {found:?}");
        }
    }
}

#[test]
fn absolute_values_are_warned_of() {
    for (keys, marked, key) in [
        ("distribution = { kind = \"table\", deviations = [4.98, 5, 5.03] }", "= |[4.98", "distribution.deviations"),
        ("tolerance = [4.9, 5.1]", "= |[4.9", "tolerance"),
        (
            "distribution = { kind = \"weibull\", shape = 2, scale = 0.1, location = 4.9 }",
            "= |4.9",
            "distribution.location",
        ),
        ("distribution = { kind = \"gumbel\", mode = 5.02, scale = 0.1 }", "= |5.02", "distribution.mode"),
        ("distribution = { kind = \"lognormal\", mean = 5.1, deviation = 0.1 }", "= |5.1", "distribution.mean"),
        ("distribution = { kind = \"normal\", mean = 5.01, deviation = 0.1 }", "= |5.01", "distribution.mean"),
        (
            "distribution = { kind = \"mixture\", of = [{ tolerance = 0.1 }, { tolerance = [4.9, 5.1] }] }",
            "= |[4.9",
            "distribution.of.tolerance",
        ),
    ] {
        check(keys, Some((marked, &format!("`dimension.{key}` counts from `value`"))));
    }
    for keys in [
        "distribution = { kind = \"table\", deviations = [-0.02, 0, 0.03] }",
        "distribution = { kind = \"table\", deviations = [0.5, 1, 1.5] }",
        "distribution = { kind = \"table\", deviations = [0, 5] }",
        "tolerance = [0.1, 0.3]",
        "distribution = { kind = \"weibull\", shape = 2, scale = 0.1, location = -0.1 }",
        "distribution = { kind = \"normal\", mean = 0.01, deviation = 0.1 }",
    ] {
        check(keys, None);
    }
    // Deviations from 0 have nothing else to count from.
    let zero = dimension("tolerance = [0.1, 0.3]").replace("value = 5", "value = 0");
    assert!(warnings(&zero).is_empty());
}

#[test]
fn a_distribution_far_outside_of_its_tolerance_is_warned_of() {
    for (keys, marked, percent) in [
        // All but 1 − e^(−0.01) of Rayleigh's distribution with the scale 1 are above 0.1.
        ("tolerance = 0.1\ndistribution = { kind = \"weibull\", shape = 2, scale = 1 }", "= |{ kind", "99 %"),
        // 2·Q(1).
        ("tolerance = 0.1\nsigma = 1", "sigma = |1", "32 %"),
        // 2·Q(1/2).
        ("tolerance = 0.1\ndistribution = { kind = \"normal\", deviation = 0.2 }", "= |{ kind", "62 %"),
        // Not too wide, but beside.
        ("tolerance = 0.1\ndistribution = { kind = \"normal\", shift = 0.1 }", "= |{ kind", "50 %"),
        (
            "tolerance = 0.1\ndistribution = { kind = \"lognormal\", mean = 0.2, deviation = 0.01, location = -1 }",
            "= |{ kind",
            "100 %",
        ),
        (
            "tolerance = 0.1\ndistribution = { kind = \"mixture\", of = [{ tolerance = 0.1 }, { tolerance = [0.2, 0.3] }] }",
            "= |{ kind",
            "50 %",
        ),
    ] {
        check(keys, Some((marked, &format!("{percent} of the units are outside of the tolerance"))));
    }
    for keys in [
        "tolerance = 0.1\nsigma = 2",
        "tolerance = 0.1\ndistribution = \"uniform\"",
        "tolerance = 0.1\ndistribution = { kind = \"normal\", cpk = 0.8 }",
        "distribution = { kind = \"normal\", deviation = 0.2 }",
        "tolerance = 0.1\ndistribution = { kind = \"truncated-normal\", deviation = 0.2 }",
        "distribution = { kind = \"mixture\", of = [{ tolerance = 0.1 }, { tolerance = 0.3 }] }",
    ] {
        check(keys, None);
    }
}

#[test]
fn a_dimension_that_nothing_uses_is_warned_of() {
    let text = "[[dimension]]\nname = \"a\"\nvalue = 5\ntolerance = 0.1\n\
                [[dimension]]\nname = \"b\"\nvalue = 5\ntolerance = 0.1\n\
                [[dimension]]\nname = \"c\"\nvalue = 5\ntolerance = 0.1\n\
                [[measure]]\nname = \"m\"\nis = \"2 * a\"\n[[measure]]\nname = \"n\"\nis = \"m + IT\"\n";
    let found = warnings(&text.replace("IT", "1 mm"));
    let told: Vec<_> = found.iter().map(String::as_str).collect();
    let expected = |line: usize, name: &str| format!("scene.toml:{line}:8: no measure uses the dimension `{name}`");
    assert_eq!(told, [expected(6, "b"), expected(10, "c")]);
    // By a measure of a measure it is used, by a correlation alone it is not.
    let correlated = text.replace("IT", "min(b, 4 mm)") + "[[correlation]]\nof = [\"a\", \"c\"]\ncoefficient = 0.5\n";
    assert_eq!(warnings(&correlated), [expected(10, "c")]);
    assert!(warnings(&text.replace("IT", "b * c / 1 mm")).is_empty());
}

/// A block of 100 mm against a stop.
fn block(at: &str, normal: &str) -> String {
    format!(
        r#"[[part]]
name = "frame"
plane = [
  {{ name = "floor", at = [0, 0, 0], normal = "+z", along = "+x", extents = [200, 200], flatness = "none", offset = 0.1 }},
  {{ name = "back", at = [0, 50, 5], normal = "-y", along = "+x", extents = [200, 10], flatness = "none", offset = 0.1 }},
  {{ name = "stop", at = [0, 0, 5], normal = "+x", along = "+y", extents = [200, 10], flatness = "none", offset = 0.1 }},
]
[[part]]
name = "block"
at = {at}
plane = [
  {{ name = "floor", at = [50, 0, 0], normal = "-z", along = "+x", extents = [100, 100], flatness = "none", offset = 0.1 }},
  {{ name = "back", at = [50, 50, 5], normal = "+y", along = "+x", extents = [100, 10], flatness = "none", offset = 0.1 }},
  {{ name = "stop", at = [0, 0, 5], normal = "{normal}", along = "+y", extents = [100, 10], flatness = "none", offset = 0.1 }},
]
point = [{{ name = "end", at = [100, 0, 5], normal = "+x", offset = 0.1 }}]
[[mate]]
part = "block"
contacts = [
  ["block.floor", "frame.floor"],
  ["block.back", "frame.back"],
  ["block.stop", "frame.stop"],
]
[[measure]]
name = "end"
distance = ["block.end", "frame.stop"]
"#
    )
}

#[test]
fn a_part_drawn_off_its_locator_is_warned_of() {
    assert!(warnings(&block("[0, 0, 0]", "-x")).is_empty());
    // Drawn where its end is at 97 mm; it is moved to the stop.
    let off = parse(&block("[-3, 0, 0]", "-x"), &[]).unwrap().product.unwrap();
    assert!((off.nominal_measures()[0] - 0.1).abs() < 1e-12);
    let [told] = &off.warnings[..] else { panic!("{:?}", off.warnings) };
    let said =
        "scene.toml:18:8: the part block is drawn off the features that place it, shifted by 3 mm and turned by 0°";
    assert!(told.starts_with(said), "{told}");
    // Less than a micrometre is the drawing's rounding.
    assert!(warnings(&block("[0.0004, 0, 0]", "-x")).is_empty());
    let turned = warnings(&block("[0, 0, 0]\nturned = [\"0.1°\", 0, 0]", "-x"));
    assert!(turned.iter().any(|told| told.contains("turned by 0.1°")), "{turned:?}");
}

#[test]
fn a_normal_into_the_material_is_warned_of() {
    let found = warnings(&block("[0, 0, 0]", "+x"));
    let [told] = &found[..] else { panic!("{found:?}") };
    let said = "scene.toml:22:4: the normals of block.stop and frame.stop, which meet, point the same way";
    assert!(told.starts_with(said), "{told}");
    let point = block("[0, 0, 0]", "-x").replace("[\"block.stop\", \"frame.stop\"]", "[\"block.end\", \"frame.stop\"]");
    let point = point.replace("at = [100, 0, 5], normal = \"+x\"", "at = [0, 0, 5], normal = \"+x\"");
    assert!(warnings(&point).iter().any(|told| told.starts_with("scene.toml:22:4: the normals of block.end and")));
}

#[test]
fn a_warning_about_an_override_shows_the_override() {
    let text = dimension("tolerance = 0.1");
    let file = parse(&text, &["dimension.x.tolerance=[4.9, 5.1]"]).unwrap();
    let told = file.product.unwrap().warnings;
    assert!(told[0].starts_with("--set dimension.x.tolerance=[4.9, 5.1]: `dimension.tolerance` counts"), "{told:?}");
}

#[test]
fn keys_without_effect_are_refused() {
    let text = dimension("tolerance = 0.1\ndistribution = HERE");
    let of = |kind: &str, more: &str| format!("{{ kind = \"{kind}\", {more} }}");
    let mut cases = Vec::new();
    for (kind, needed, ignored) in [
        (
            "normal",
            "",
            &["mode = 0", "shoulders = [0, 0]", "skewness = 1", "scale = 1", "shape = 2", "shapes = [2, 2]"][..],
        ),
        ("truncated-normal", "", &["mode = 0", "skewness = 1", "location = 0", "of = []", "deviations = [0, 1]"]),
        ("skewed", "skewness = 1, ", &["mode = 0", "location = 0"]),
        ("uniform", "", &["mode = 0", "mean = 0", "deviation = 1", "cpk = 1", "shift = 0", "skewness = 1"]),
        ("triangular", "", &["shoulders = [0, 0]", "mean = 0", "cpk = 1"]),
        ("trapezoidal", "shoulders = [-0.01, 0.01], ", &["mode = 0", "deviation = 1"]),
        ("beta", "shapes = [2, 3], ", &["shape = 2", "mean = 0"]),
        ("weibull", "shape = 2, scale = 0.01, ", &["mode = 0", "shapes = [2, 2]", "cpk = 1"]),
        ("gumbel", "scale = 0.01, ", &["location = 0", "mean = 0"]),
        ("lognormal", "mean = 0.01, deviation = 0.01, ", &["scale = 1", "cpk = 1", "shift = 0"]),
        ("mixture", "of = [{ tolerance = 0.1 }, { tolerance = 0.1 }], ", &["mean = 0", "deviation = 1"]),
    ] {
        for ignored in ignored {
            let (key, _) = ignored.split_once(' ').unwrap();
            let value = ignored.split_once("= ").unwrap().1;
            cases.push((
                of(kind, &format!("{needed}{ignored}")),
                format!("{key} = |{value}"),
                format!("`dimension.distribution.{key}` has no effect with the distribution `{kind}`"),
            ));
        }
    }
    let case = |(to, place, said): &'static (String, String, String)| {
        ("HERE", to.as_str(), [place.as_str(), said.as_str(), ""])
    };
    let cases: Vec<_> = cases.leak().iter().map(case).collect();
    check_all(&text, &cases);
    for (keys, place, said) in [
        (
            "tolerance = 0.1\nsigma = 2\ndistribution = \"uniform\"",
            "sigma = |2",
            "`dimension.sigma` has no effect with",
        ),
        ("tolerance = 0.1\nsigma = 2\ndistribution = { kind = \"normal\", cpk = 1 }", "sigma = |2", "beside `cpk`"),
        ("sigma = 2\ndistribution = { kind = \"normal\", deviation = 1 }", "sigma = |2", "beside `deviation`"),
        ("tolerance = 0.1\nside = 9", "side = |9", "`dimension.side` has no effect here"),
        ("tolerance = \"m\"\nside = 9", "side = |9", "`dimension.side` has no effect here"),
        ("tolerance = 0.1\nedge = \"broken\"", "edge = |\"broken\"", "`dimension.edge` has no effect here"),
        ("tolerance = 0.1\ndistribution = { kind = \"normal\", mean = 0, shift = 0 }", "shift = |0", "beside `mean`"),
        (
            "tolerance = 0.1\ndistribution = { kind = \"normal\", deviation = 1, cpk = 1 }",
            "cpk = |1",
            "beside `deviation`",
        ),
        (
            "tolerance = 0.1\ncost = { exponential = 1, power = 2, range = [0.1, 1] }",
            "power = |2",
            "`dimension.cost.power` has no effect beside `exponential`",
        ),
        (
            "tolerance = 0.1\ncost = { reciprocal = 1, grades = [6, 8], range = [0.1, 1] }",
            "range = |[0.1",
            "`dimension.cost.range` has no effect beside `grades`",
        ),
    ] {
        check_all(&dimension("HERE"), &[("HERE", keys, [place, said, ""])]);
    }
    check_all(
        &block("[0, 0, 0]", "-x"),
        &[
            (
                "[[mate]]",
                "[[mate]]\nfloat = \"none\"",
                ["float = |\"none\"", "`mate.float` has no effect", "hole on a pin"],
            ),
            (
                "plane = [\n  { name = \"floor\", at = [0, 0, 0]",
                "axis = [{ name = \"a\", at = [0, 0, 0], along = \"+x\", length = 1, kind = \"pin\" }]\nplane = [\n  { name = \"floor\", at = [0, 0, 0]",
                ["kind = |\"pin\"", "`part.axis.kind` has no effect without a `diameter`", "with a diameter"],
            ),
            (
                "offset = 0.1",
                "offset = { tolerance = 0.1, edge = \"broken\" }",
                ["edge = |\"broken", "without a `value`", "ISO 2768-1"],
            ),
            (
                "offset = 0.1",
                "offset = { value = 0, tolerance = 0.1, side = 3 }",
                ["|side = 3", "unknown key `part.plane.offset.side`", "edge"],
            ),
        ],
    );
}
