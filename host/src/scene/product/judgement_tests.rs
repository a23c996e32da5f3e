//! Worst cases, contributors, undefined measures and far lots of scenes against closed forms.

use slipfit_tolerance::{
    analysis::{Analysis, analyse, theory},
    counting::study::{Settings, StudyError},
    numeric::normal::{density, quantile, tail},
    report::{MeasureReport, report},
    sampling::sampler::Method,
    theory::experiment::{Design, experiment},
};

use super::tests::{close, parse, product_of};

/// Dimensions (name, value, lower and upper deviation; mm or with their units) and measures (keys in TOML).
fn scene(dimensions: &[(&str, &str, &str)], measures: &[&str]) -> String {
    let mut text = String::new();
    for (name, value, tolerance) in dimensions {
        text += &format!("[[dimension]]\nname = \"{name}\"\nvalue = {value}\ntolerance = {tolerance}\n");
    }
    for (i, measure) in measures.iter().enumerate() {
        text += &format!("[[measure]]\nname = \"m{i}\"\n{measure}\n");
    }
    text
}

fn settings(samples: u64) -> Settings {
    Settings { method: Method::PseudoRandom, samples, replicates: 1, seed: 1 }
}

fn analysed(text: &str, samples: u64) -> (Analysis, Vec<MeasureReport>) {
    let product = product_of(text);
    let analysis = analyse(&product.model, settings(samples), |_| ()).unwrap();
    let report = report("", &product.model, &analysis);
    (analysis, report.measures)
}

/// Worst cases (mm, ° or plain) of measures.
fn worst_cases(text: &str) -> Vec<[f64; 2]> {
    let model = product_of(text).model;
    let found = theory(&model, 1, None).unwrap();
    let scaled = |(worst, measure): (&slipfit_tolerance::theory::worst_case::WorstCase, _)| {
        let measure: &slipfit_tolerance::model::Measure = measure;
        worst.range.map(|end| end * measure.quantity.factor())
    };
    found.worst_cases.iter().zip(&model.measures).map(scaled).collect()
}

#[track_caller]
fn check_worst(dimensions: &[(&str, &str, &str)], expression: &str, expected: [f64; 2]) {
    let found = worst_cases(&scene(dimensions, &[&format!("is = \"{expression}\"")]))[0];
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() <= 1e-7 * expected.abs().max(1.0), "{expression}: {found}, not {expected}");
    }
}

#[test]
fn worst_cases_are_those_of_corners_kinks_and_the_inside() {
    let clutch = [("a", "27.645", "0.05"), ("c", "11.43", "0.01"), ("e", "50.8", "0.0125")];
    check_worst(&clutch, "acos((a + c) / (e - c))", [5.957_364_503_163, 7.938_469_292_598]);
    let cosine = libm::cos(3f64.to_radians());
    let tilted = [("L", "100", "0.1"), ("tilt", "\"0°\"", "\"3°\"")];
    check_worst(&tilted, "L - L*cos(tilt)", [0.0, 100.1 * (1.0 - cosine)]);
    let one_sided = [("L", "100", "0.1"), ("tilt", "\"0°\"", "[\"-1°\", \"3°\"]")];
    check_worst(&one_sided, "L*cos(tilt)", [99.9 * cosine, 100.1]);
    check_worst(&[("pin", "10", "0.05"), ("hole", "10.05", "0.05")], "max(0 mm, pin - hole)", [0.0, 0.05]);
    check_worst(&[("a", "10", "0.15"), ("b", "10.2", "0.15")], "abs(b - a)", [0.0, 0.5]);
    check_worst(&[("a", "10.2", "0.15"), ("b", "10", "0.15")], "-abs(b - a)", [-0.5, 0.0]);
    check_worst(&[("x", "0", "0.3"), ("y", "0", "0.4")], "sqrt(x*x + y*y)", [0.0, 0.5]);
    check_worst(&[("x", "0.4", "0.3")], "x * (1 - x / 1 mm)", [0.09, 0.25]);
    check_worst(&[("x", "0.2", "0.3"), ("y", "0", "0.4")], "x * y / 1 mm", [-0.2, 0.2]);
    // A valley between two kinks, which no single dimension leads along.
    let valley = [("a", "0.1", "0.3"), ("b", "1", "0.2"), ("c", "1", "0.2")];
    check_worst(&valley, "abs(a + b - c) + abs(a - b + c)", [0.0, 0.8]);
    check_worst(&valley, "max(a, min(b - c, 0.3 mm))", [-0.2, 0.4]);
    // In a ridge across both dimensions.
    check_worst(
        &[("x", "0", "1"), ("y", "0.2", "1")],
        "1 mm - (x - y)^2 / 0.01 mm - (x + y - 0.6 mm)^2 / 1 mm",
        [1.0 - 484.0 - 0.16, 1.0],
    );
}

/// What moves such measures shows inside alone: at every corner, and where most dimensions are in the middle, they are level.
#[test]
fn worst_cases_of_measures_that_are_level_at_all_corners() {
    for middle in ["0.5", "0.7", "1", "1.4", "2", "2.5"] {
        let overlap = [("width", "0.4", "0.2"), ("position", middle, "3")];
        check_worst(&overlap, "max(0 mm, width - abs(position))", [0.0, 0.6]);
        check_worst(&overlap, "min(0.05*width, abs(position))", [0.0, 0.03]);
        check_worst(&overlap, "sqrt(max(0 mm * 1 mm, width^2 - position^2))", [0.0, 0.6]);
        check_worst(&overlap, "max(0 mm, min(width - position, width + position))", [0.0, 0.6]);
    }
    let bell = [("a", "1.4", "0.47"), ("b", "0.14", "0.34"), ("c", "0", "0.3"), ("d", "1", "0.1")];
    check_worst(&bell, "max(0 mm, a - b^2 / 0.01 mm)", [0.0, 1.87]);
    check_worst(&bell, "max(0 mm, a - b^2 / 0.0025 mm)", [0.0, 1.87]);
    check_worst(&bell, "max(0.9 mm, a*cos(b * 8 rad / 1 mm))", [0.9, 1.87]);
    check_worst(&bell, "max(0 mm, a - abs(b)/0.05 - abs(c)/0.05)", [0.0, 1.87]);
    check_worst(&bell, "max(0 mm, a - abs(b - c - 0.3 mm)/0.05) * d / 1 mm", [0.0, 1.87 * 1.1]);
    check_worst(&bell, "max(0 mm, min(b - 0.05 mm, 0.1 mm - b)) * a / 1 mm", [0.0, 0.025 * 1.87]);
    let windows = [("a", "0", "0.3"), ("b", "1", "0.2"), ("c", "0", "0.3"), ("d", "1", "0.2")];
    let window = |x: &str, by: &str| format!("min(max({x} - 0.1 mm, 0 mm), max(0.2 mm - {x}, 0 mm)) * {by} / 1 mm");
    check_worst(&windows, &format!("{} + {}", window("a", "b"), window("c", "d")), [0.0, 0.12]);
    let three = [("x", "0.4", "0.2"), ("y", "1.4", "3"), ("z", "0", "0.1")];
    check_worst(&three, "min(0.3 mm, abs(y - z)) + x", [0.2, 0.9]);
}

/// More dimensions than have all their corners computed.
#[test]
fn worst_cases_of_many_dimensions() {
    let names: Vec<String> = (0..100).map(|k| format!("x{k}")).collect();
    let dimensions = |count: usize, value: &'static str, tolerance: &'static str| -> Vec<(&str, &str, &str)> {
        names[..count].iter().map(|name| (name.as_str(), value, tolerance)).collect()
    };
    let sum = |count: usize, term: &dyn Fn(&str) -> String| -> String {
        names[..count].iter().map(|name| term(name)).collect::<Vec<_>>().join(" + ")
    };
    // Level everywhere but in one corner of a million: 20 · 0.1 − 1.95.
    let plain = sum(20, &|x| x.into());
    check_worst(&dimensions(20, "0", "0.1"), &format!("max(0 mm, {plain} - 1.95 mm)"), [0.0, 0.05]);
    check_worst(&dimensions(20, "0", "0.1"), &format!("min(0 mm, {plain} + 1.95 mm)"), [-0.05, 0.0]);
    check_worst(&dimensions(24, "0.05", "0.1"), &format!("abs({})", sum(24, &|x| x.into())), [0.0, 3.6]);
    let squares = sum(100, &|x| format!("{x}^2"));
    check_worst(&dimensions(100, "0.05", "0.15"), &format!("sqrt({squares})"), [0.0, 2.0]);
    // Each with a greatest value of its own inside: x(1 − x) in [0.1, 0.7].
    let humps = sum(40, &|x| format!("{x} * (1 - {x} / 1 mm)"));
    check_worst(&dimensions(40, "0.4", "0.3"), &humps, [40.0 * 0.09, 40.0 * 0.25]);
}

/// Two position zones of 0.2 whose axes coincide on the drawing, and an axis that leans in its zone.
#[test]
fn worst_cases_of_round_zones_lie_on_their_rims() {
    let text = r#"
        [[part]]
        name = "plate"
        plane = [{ name = "A", at = [0, 0, 0], normal = "-z", along = "+x", extents = [100, 100], flatness = "none" },
                 { name = "B", at = [-50, 0, 10], normal = "-x", along = "+y", extents = [100, 20], flatness = "none" }]
        axis = [
          { name = "one", at = [0, 0, 0], along = "+z", length = 20, position = { zone = 0.2, datum = ["plate.A", "plate.B"] } },
          { name = "two", at = [0, 0, 0], along = "+z", length = 20, position = { zone = 0.3, datum = ["plate.A", "plate.B"] } },
        ]
        [[measure]]
        name = "apart"
        distance = ["plate.one", "plate.two"]
    "#;
    let [low, high] = worst_cases(text)[0];
    // 0.1 and 0.15 in opposite directions, whichever these are.
    assert!(low.abs() < 1e-7 && (high - 0.25).abs() < 1e-7, "{low} {high}");
}

#[test]
fn what_slopes_do_not_describe_has_no_rss_and_total_indices() {
    // The tilt alone: beyond 2.7188 of its deviations 6,550 in a million fail.
    let limit = 100.0 * (1.0 - libm::cos(2.7188f64.to_radians()));
    let text = scene(
        &[("L", "100", "0.1"), ("tilt", "\"0°\"", "\"3°\"")],
        &[&format!("is = \"L - L*cos(tilt)\"\nupper = {limit}")],
    );
    let (_, measures) = analysed(&text, 200_000);
    let found = &measures[0];
    let share = |name: &str| found.contributors.iter().find(|share| share.name == name).unwrap();
    assert!(found.rss.is_none() && found.by_indices);
    assert!((share("tilt").percent.unwrap() - 100.0).abs() < 0.1, "{:?}", found.contributors);
    close(share("tilt").reach, 0.5 * 100.0 * (1.0 - libm::cos(3f64.to_radians())), 1e-9);
    let failing = 2e6 * tail(2.7188);
    let dpm = found.dpm[1].unwrap().dpm;
    assert!((dpm / failing - 1.0).abs() < 0.05, "{dpm} {failing}");
    assert!(found.worst_case_linear.unwrap().iter().all(|end| end.abs() < 1e-9));
    // A linear measure keeps both, and its worst case by slopes is its worst case.
    let (_, linear) = analysed(&scene(&[("a", "1", "0.1"), ("b", "2", "0.2")], &["is = \"a + b\""]), 1000);
    assert!(linear[0].rss.is_some() && !linear[0].by_indices);
    assert_eq!(linear[0].worst_case_linear, Some(linear[0].worst_case));
}

/// √(a − b) where a is above b in few units, in half of them, and in all; the shares of both are equal by symmetry.
#[test]
fn a_measure_that_few_units_have_tells_no_shares() {
    for (apart, has_shares) in
        [("[0.02, 0.22]", false), ("[-0.04, 0.16]", false), ("0.1", true), ("[-0.5, -0.3]", true)]
    {
        let text = scene(&[("a", "1", "0.1"), ("b", "1", apart)], &["is = \"sqrt((a - b) * 1 mm)\""]);
        let model = product_of(&text).model;
        let report = report("", &model, &analyse(&model, settings(100_000), |_| ()).unwrap());
        let shares: Vec<_> = report.measures[0].contributors.iter().filter_map(|share| share.percent).collect();
        let is_told = report.notes.iter().any(|note| note.contains("too few units have it"));
        assert_eq!((!shares.is_empty(), is_told), (has_shares, !has_shares), "{apart}: {:?}", report.notes);
        assert!(shares.iter().all(|share| (share - 50.0).abs() < 5.0), "{apart}: {shares:?}");
    }
}

/// A lot of a few in ten thousand, far away: the variance is in so few units that its shares are chance, and said to be.
#[test]
fn shares_of_a_rare_lot_are_said_to_be_uncertain() {
    let lot = |weight: f64| {
        format!(
            "[[dimension]]\nname = \"c\"\nvalue = 10\ndistribution = {{ kind = \"mixture\", of = [{{ weight = 1, tolerance = 0.1 }}, \
             {{ weight = {weight}, tolerance = [20, 21], distribution = \"uniform\" }}] }}\n"
        )
    };
    for (weight, is_uncertain) in [(5e-4, true), (2e-3, true), (0.3, false)] {
        let own = scene(&[("a", "1", "0.15"), ("b", "2", "0.15")], &["is = \"a * c * b / (1 mm)^2\""]);
        let model = product_of(&(lot(weight) + &own)).model;
        let report = report("", &model, &analyse(&model, settings(10_000), |_| ()).unwrap());
        let is_told = report.notes.iter().any(|note| note.contains("shares of its contributors"));
        assert_eq!(is_told, is_uncertain, "{weight}: {:?}", report.notes);
    }
}

/// What one unit in a hundred thousand has, slopes and moments of second order do not see: they are withheld, and contributors are not told.
#[test]
fn a_measure_that_few_units_move_is_not_said_to_be_level() {
    for (from, is_level) in [("0.142", false), ("0.15", false), ("0.7", true)] {
        let text = scene(
            &[("x", "1", "0.1"), ("y", "1", "0.1")],
            &[&format!("is = \"max(0 mm, x - 1 mm - {from} mm) + 0*y\"")],
        );
        let model = product_of(&text).model;
        let report = report("", &model, &analyse(&model, settings(1 << 20), |_| ()).unwrap());
        let measure = &report.measures[0];
        assert_eq!(measure.sd > 0.0, !is_level, "{from}: {measure:?}");
        assert_eq!(measure.rss.is_none() && measure.second_order.is_none(), !is_level, "{from}: {measure:?}");
        assert_eq!(
            report.notes.iter().any(|note| note.contains("has a kink")),
            !is_level,
            "{from}: {:?}",
            report.notes
        );
        let shares: Vec<_> = measure.contributors.iter().filter_map(|share| share.percent).collect();
        assert!(is_level || shares.is_empty() || (shares[0] - 100.0).abs() < 1e-6, "{from}: {shares:?}");
    }
}

#[test]
fn rss_has_the_correlations_of_the_scene() {
    for (rho, sum, difference) in [(0.5, 0.07, 0.03), (-0.5, 0.03, 0.07), (0.0, 0.05, 0.05)] {
        let mut text = scene(&[("a", "1", "0.1"), ("b", "2", "0.2")], &["is = \"a + b\"", "is = \"a - b\""]);
        if rho != 0.0 {
            text += &format!("[[correlation]]\nof = [\"a\", \"b\"]\ncoefficient = {rho}\n");
        }
        let (_, measures) = analysed(&text, 1000);
        for (measure, square) in measures.iter().zip([sum, difference]) {
            let rss = measure.rss.unwrap();
            close(rss.tolerance, libm::sqrt(square), 1e-9);
            close(rss.sd, libm::sqrt(square) / 3.0, 1e-9);
        }
    }
}

#[test]
fn a_measure_without_any_value_is_refused() {
    let text = scene(&[("x", "0", "[-0.2, -0.1]"), ("y", "1", "0.1")], &["is = \"sqrt(x * 1 mm)\"", "is = \"y\""]);
    let model = product_of(&text).model;
    for (method, replicates) in [(Method::PseudoRandom, 1), (Method::ScrambledSobol, 8)] {
        let settings = Settings { method, samples: 4096, replicates, seed: 1 };
        let StudyError::Undefined { measure, computed: 0.., units } = analyse(&model, settings, |_| ()).unwrap_err()
        else {
            panic!("not refused")
        };
        assert_eq!((measure.as_str(), units), ("m0", 4096 / replicates));
    }
}

#[test]
fn infinite_is_undefined() {
    // 1/max(0, x) is infinite in half of the units.
    let text = scene(
        &[("x", "0.1", "[-0.6, 0.4]"), ("y", "1", "0.1")],
        &["is = \"1 mm * 1 mm / max(0 mm, x)\"\nlower = 0", "is = \"y + sqrt(1 mm * (x + 0.25 mm))\"\nupper = 5"],
    );
    let (analysis, measures) = analysed(&text, 100_000);
    let half = analysis.joint.measures[0].undefined as f64 / 1e5;
    assert!((half - 0.5).abs() < 0.01 && measures[0].max.is_finite(), "{half}");
    assert!((measures[0].good.unwrap() - 0.5).abs() < 0.01);
    // x < −0.25 in Φ(−1.5) of the units: these have no root, and all others have indices.
    let undefined = analysis.joint.measures[1].undefined as f64 / 1e5;
    assert!((undefined - tail(1.5)).abs() < 0.004, "{undefined}");
    let indices = analysis.theory.indices[1].as_ref().unwrap();
    assert!(indices.total[0] > 0.8 && indices.total[1] > 0.01 && indices.total[1] < 0.2, "{indices:?}");
    assert!(analysis.theory.worst_cases.iter().all(|worst| worst.undefined));
}

/// 0.2 % of the units come from a lot 50 standard deviations away.
#[test]
fn a_small_lot_far_away_is_where_it_is() {
    let text = "[[dimension]]\nname = \"x\"\nvalue = 10\n\
                distribution = { kind = \"mixture\", of = [{ weight = 998, tolerance = 0.03 }, { weight = 2, tolerance = [0.47, 0.53] }] }\n\
                [[measure]]\nname = \"m\"\nis = \"x\"\nupper = 10.1\n";
    for samples in [20_000, 1_000_000] {
        let (analysis, measures) = analysed(text, samples);
        // 0.135 of 0.2 % lie above: the 32.5 % point of the lot.
        let expected = 10.5 + 0.01 * quantile(1.0 - 0.135 / 0.2);
        let bound = if samples > 100_000 { 0.004 } else { 0.03 };
        assert!((measures[0].q99865 - expected).abs() < bound, "{} {expected}", measures[0].q99865);
        close(measures[0].median, 10.0 + 0.01 * quantile(0.5 / 0.998), 5e-4);
        close(measures[0].dpm[1].unwrap().dpm, 2000.0, 400.0);
        if let Some(tail) = &analysis.theory.tails[0][1] {
            assert!((tail.probability - 0.002).abs() < 4.0 * tail.error + 2e-5, "{tail:?}");
        }
    }
}

/// E min(k·x², A) of a normal x, by Simpson's rule.
pub(super) fn capped(mean: f64, deviation: f64, coefficient: f64, cap: f64) -> f64 {
    const STEPS: usize = 20_000;
    let step = 20.0 / STEPS as f64;
    let at = |i: usize| {
        let z = -10.0 + step * i as f64;
        let x = mean + deviation * z;
        let weight = if i == 0 || i == STEPS { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
        weight * density(z) * (coefficient * x * x).min(cap)
    };
    (0..=STEPS).map(at).sum::<f64>() * step / 3.0
}

#[test]
fn no_unit_costs_more_than_its_repair() {
    for (repair, mean) in [(2.0, 0.1), (4.0, 0.0), (8.0, -0.2), (1000.0, 0.1), (f64::INFINITY, 0.1)] {
        let limited = if repair.is_finite() { format!(", repair = {repair}") } else { String::new() };
        let text = scene(
            &[("d", &format!("{}", 10.0 + mean), "0.3")],
            &[&format!("is = \"d\"\nlower = 9.6\nupper = 10.4\nloss = {{ cost = 50{limited} }}")],
        );
        let (_, measures) = analysed(&text, 200_000);
        let loss = measures[0].loss.unwrap();
        let expected = capped(mean, 0.1, 312.5, repair);
        let error = loss.mean.error.unwrap();
        assert!((loss.mean.value - expected).abs() < 4.0 * error, "{repair}: {loss:?} {expected}");
        assert!(error < 0.02 * expected && loss.mean.value <= repair);
    }
}

/// Half the tolerance is one standard deviation or more, wherever that is said.
#[test]
fn sigma_has_the_bounds_that_are_documented() {
    let text = |of_all: &str, own: &str| {
        format!(
            "[tolerance]\nsigma = {of_all}\n[[dimension]]\nname = \"d\"\nvalue = 1\ntolerance = 0.1\n{own}[[measure]]\nname = \"m\"\nis = \"d\"\n"
        )
    };
    for (of_all, own, allowed) in [
        ("3", "sigma = 0.9\n", false),
        ("3", "sigma = 1\n", true),
        ("3", "sigma = 100\n", true),
        ("3", "sigma = 101\n", false),
        ("3", "sigma = 0.1\ndistribution = \"truncated-normal\"\n", false),
        ("0.9", "", false),
        ("1", "", true),
    ] {
        assert_eq!(parse(&text(of_all, own), &[]).is_ok(), allowed, "{of_all} {own}");
    }
}

/// The least and the greatest of y/x and its like, where x is 0.1 ± 0.2 mm or not below 0, and y 5 ± 0.1 mm.
#[test]
fn beside_a_pole_there_is_no_bound() {
    for (is, least, [low, high]) in [
        ("y/x", -0.1, [true, true]),
        ("y/x", 0.0, [false, true]),
        ("x - y^2/x", 0.0, [true, false]),
        ("y/(x*x)*(1 mm)", -0.1, [false, true]),
        ("1/(x - 0.07 mm)*(1 mm^2)", -0.1, [true, true]),
        ("(1 mm)*(y/(1 mm))^9*(x/(1 mm))^9", -0.1, [false, false]),
        ("max(0 mm, x + y - 5.39 mm)", -0.1, [false, false]),
        ("y/(x + 0.101 mm)", -0.1, [false, false]),
    ] {
        let text = format!(
            "[[dimension]]\nname = 'x'\nvalue = 0.1\ntolerance = {}\n[[dimension]]\nname = 'y'\nvalue = 5\ntolerance = 0.1\n\
             [[measure]]\nname = 'm'\nis = '{is}'\nupper = 1e6\n",
            0.1 - least
        );
        let found = worst_cases(&text)[0];
        assert_eq!(found.map(f64::is_infinite), [low, high], "{is} from {least}: {found:?}");
    }
}

/// The root of x − y + 0.05 mm has no value where x is a level below y.
#[test]
fn a_measure_without_a_value_in_one_run_has_no_mean_and_no_shares() {
    let text = "[[dimension]]\nname = 'x'\nvalue = 1\ntolerance = 0.1\n[[dimension]]\nname = 'y'\nvalue = 1\ntolerance = 0.1\n\
                [[measure]]\nname = 'm'\nis = 'sqrt((x - y + 0.05 mm) * 1 mm)'\n[[measure]]\nname = 'n'\nis = 'x'\n";
    let model = product_of(text).model;
    for (design, undefined) in [(Design::FullFactorial, 1), (Design::TwoLevel, 1), (Design::ThreeLevel, 3)] {
        let findings = experiment(&model, design).unwrap().findings;
        assert_eq!([findings[0].undefined, findings[1].undefined], [undefined, 0], "{design:?}");
        assert!(findings[0].mean.is_nan() && findings[0].shares.iter().all(|share| share.is_nan()));
        assert!((findings[1].mean - 1e-3).abs() < 1e-15 && (findings[1].shares[0] - 1.0).abs() < 1e-12);
    }
}
