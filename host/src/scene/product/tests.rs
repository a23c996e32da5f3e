//! The shipped products against known numbers, and what tests of products have in common.

use slipfit_tolerance::{
    analysis::analyse,
    counting::study::Settings,
    model::{Distribution, Quantity, Variation},
    numeric::lanes::{LANES, Lanes},
    product::Product,
    report::report,
    sampling::sampler::Method,
    theory::moments,
};

use super::judgement_tests::capped;
use crate::scene::{Override, Problem, SceneError, SceneFile, shipped};

pub(super) fn parse(text: &str, overrides: &[&str]) -> Result<SceneFile, SceneError> {
    let overrides: Vec<_> = overrides.iter().map(|text| Override::set(text)).collect();
    SceneFile::parse("scene.toml", text, &overrides)
}

pub(super) fn product(name: &str, overrides: &[&str]) -> Product {
    let file = parse(shipped(name).unwrap(), overrides).unwrap_or_else(|error| panic!("{error}"));
    file.product.unwrap()
}

/// The product of a scene.
pub(super) fn product_of(text: &str) -> Product {
    parse(text, &[]).unwrap_or_else(|error| panic!("{error}")).product.unwrap()
}

/// The measures with variable `i` at `value` (SI) and the others at their nominal values.
pub(super) fn at(product: &Product, values: &[(usize, f64)]) -> Vec<f64> {
    let mut variables: Vec<_> = product.nominal.iter().map(|value| Lanes::splat(*value)).collect();
    for (i, value) in values {
        variables[*i] = Lanes::splat(*value);
    }
    let mut measures = vec![Lanes::ZERO; product.model.measures.len()];
    product.model.function.evaluate(&variables, &mut measures);
    measures.iter().map(|measure| measure.0[LANES - 1]).collect()
}

/// Half widths and middles of the tolerances of dimensions.
fn limits(product: &Product) -> Vec<[f64; 2]> {
    let limits = product.model.contributors.iter().map(|contributor| match contributor.variation {
        Variation::Scalar { limits, .. } => limits,
        Variation::Zone(_) | Variation::Disc(_) | Variation::Nested(_) => panic!("a plane or an axis"),
    });
    limits.collect()
}

/// Linear worst case and RSS about the nominal values: half widths by the derivatives there.
fn linear(product: &Product) -> [f64; 2] {
    let half = |[lower, upper]: [f64; 2]| (upper - lower) / 2.0;
    let effects = limits(product).into_iter().enumerate().map(|(i, limits)| {
        let step = half(limits) * 1e-3;
        let [up, down] = [step, -step].map(|step| at(product, &[(i, product.nominal[i] + step)])[0]);
        (up - down) / 2e-3
    });
    let effects: Vec<f64> = effects.collect();
    [effects.iter().map(|x| x.abs()).sum(), libm::sqrt(effects.iter().map(|x| x * x).sum())]
}

pub(super) fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found}, not {expected}");
}

#[test]
fn one_way_clutch() {
    let clutch = product("clutch", &[]);
    close(clutch.nominal_measures()[0].to_degrees(), 7.018_389_8, 5e-8);
    let [worst, rss] = linear(&clutch).map(f64::to_degrees);
    close(worst, 0.9806, 5e-5);
    close(rss, 0.6579, 5e-5);
    let [phi] = &moments::of_measures(&clutch.model)[..] else { panic!("one measure") };
    // The exact mean is 7.014956°, to second order 7.01497°; the standard deviation to first order is the RSS's third.
    close(phi.mean.to_degrees(), 7.014_956, 3e-5);
    close(phi.deviation.to_degrees(), rss / 3.0, 1e-4);
    let measure = &clutch.model.measures[0];
    assert_eq!((measure.name.as_str(), measure.quantity), ("pressure angle", Quantity::Angle));
    assert_eq!(
        measure.limits,
        ["6.0184", "8.0184"].map(|d| d.parse().ok().map(|d: f64| d * (std::f64::consts::PI / 180.0)))
    );
}

#[test]
fn linear_chain() {
    let chain = product("linear-chain", &[]);
    close(chain.nominal_measures()[0] * 1e3, 0.25, 1e-9);
    let [worst, rss] = linear(&chain);
    close(worst * 1e3, 0.383, 1e-9);
    close(rss * 1e3, 0.17825, 5e-6);
    let [play] = &moments::of_measures(&chain.model)[..] else { panic!("one measure") };
    close(play.mean * 1e3, 0.4, 1e-9);
    close(play.deviation * 1e3, 0.17825 / 3.0, 2e-6);
}

#[test]
fn one_sided_worst_case() {
    // 100 +0.3/−0.1 − 40 +0.2/−0.4: 60, worst case 59.7…60.7.
    let text = "[[dimension]]\nname = \"a\"\nvalue = 100\ntolerance = [-0.1, 0.3]\n\
                [[dimension]]\nname = \"b\"\nvalue = 40\ntolerance = [-0.4, 0.2]\n\
                [[measure]]\nname = \"m\"\nis = \"a - b\"\n";
    let stack = parse(text, &[]).unwrap().product.unwrap();
    close(stack.nominal_measures()[0] * 1e3, 60.0, 1e-9);
    let [a, b] = limits(&stack)[..] else { panic!("two dimensions") };
    close(at(&stack, &[(0, a[0]), (1, b[1])])[0] * 1e3, 59.7, 1e-9);
    close(at(&stack, &[(0, a[1]), (1, b[0])])[0] * 1e3, 60.7, 1e-9);
}

#[test]
fn three_part_stack() {
    let stack = product("three-part-stack", &[]);
    close(stack.nominal_measures()[0] * 1e3, 0.5, 1e-9);
    assert_eq!(limits(&stack)[2], [0.0195 - 0.0002, 0.0195 + 0.0002]);
    // From the command line, by name.
    let finer = product("three-part-stack", &["dimension.block A.tolerance=f", "measure.play.lower=0.05"]);
    assert_eq!(limits(&finer)[1], [0.04 - 0.00015, 0.04 + 0.00015]);
    assert_eq!(finer.model.measures[0].limits, [Some(0.05e-3), Some(1e-3)]);
}

#[test]
fn distributions_and_correlation() {
    let worn = product("worn-tool", &[]);
    let kinds: Vec<_> = worn
        .model
        .contributors
        .iter()
        .map(|contributor| match &contributor.variation {
            Variation::Scalar { distribution, .. } => distribution.clone(),
            Variation::Zone(_) | Variation::Disc(_) | Variation::Nested(_) => panic!("a plane or an axis"),
        })
        .collect();
    assert_eq!(kinds[0], Distribution::Uniform { limits: [0.05 - 1e-4, 0.05 + 1e-4] });
    assert!(matches!(kinds[1], Distribution::TruncatedNormal { deviation, .. } if (deviation - 25e-6).abs() < 1e-18));
    assert!(matches!(&kinds[2], Distribution::Table(values) if values.len() == 8 && values[0] == 2e-3 - 0.06e-3));
    assert!(matches!(kinds[3], Distribution::Normal { deviation, .. } if (deviation - 0.2e-3 / 3.0).abs() < 1e-18));
    assert!(matches!(kinds[5], Distribution::Skewed { skewness: 0.8, .. }));
    assert!(matches!(kinds[6], Distribution::Triangular { limits: [a, b], .. } if (b - a - 0.4e-3).abs() < 1e-17));
    // ISO 2768-1 m: 30′ at a shorter side of 12 mm.
    assert!(
        matches!(kinds[7], Distribution::Trapezoidal { limits: [a, b], .. } if ((b - a).to_degrees() - 1.0).abs() < 1e-12)
    );
    assert_eq!(worn.model.correlations, [(3, 4, 0.8)]);
    assert_eq!(worn.model.sums[0].measures, [0, 1]);
    // With the flanges' correlation left out, their variances add up without 2ρσ².
    let [with, without] = [&worn.model, &product("worn-tool", &["correlation=[]"]).model]
        .map(|model| moments::of_measures(model)[0].deviation);
    close(with * with - without * without, 2.0 * 0.8 * (0.2e-3 / 3.0) * (0.2e-3 / 3.0), 1e-16);
}

/// Three dimensions, each pair correlated by the same coefficient.
fn three(distribution: &str, kind: &str, coefficient: f64) -> String {
    let dimension = |name: &str| {
        format!("[[dimension]]\nname = \"{name}\"\nvalue = 5\ntolerance = 0.3\ndistribution = {distribution}\n")
    };
    let pair = |one: &str, other: &str| {
        format!("[[correlation]]\nof = [\"{one}\", \"{other}\"]\ncoefficient = {coefficient}\n")
    };
    format!(
        "[tolerance]\ncorrelation = \"{kind}\"\n{}{}{}{}{}{}[[measure]]\nname = \"m\"\nis = \"a + b + c\"\n",
        dimension("a"),
        dimension("b"),
        dimension("c"),
        pair("a", "b"),
        pair("a", "c"),
        pair("b", "c"),
    )
}

#[test]
fn correlations_are_checked_as_a_whole_and_mean_one_thing() {
    let deviation = |text: &str| moments::of_measures(&parse(text, &[]).unwrap().product.unwrap().model)[0].deviation;
    let sum = |sigma: f64, rho: f64| sigma * libm::sqrt(3.0 + 6.0 * rho);
    // The first two of these alone would be impossible with nothing between b and c.
    close(deviation(&three("\"normal\"", "pearson", 0.75)), sum(1e-4, 0.75), 1e-12);
    assert!(parse(&three("\"normal\"", "pearson", -0.51), &[]).is_err());
    let uniform = 0.3e-3 / libm::sqrt(3.0);
    // Of uniform values ranks and values have the same correlation; of skewed ones they do not.
    for kind in ["pearson", "spearman"] {
        close(deviation(&three("\"uniform\"", kind, 0.6)), sum(uniform, 0.6), 1e-10);
    }
    let skewed = "{ kind = \"skewed\", skewness = 2 }";
    close(deviation(&three(skewed, "pearson", 0.6)), sum(1e-4, 0.6), 1e-10);
    assert!(deviation(&three(skewed, "spearman", 0.6)) < 0.999 * sum(1e-4, 0.6));
    // The units have it, too.
    for kind in ["pearson", "spearman"] {
        let product = parse(&three(skewed, kind, 0.6), &[]).unwrap().product.unwrap();
        let settings = Settings { method: Method::PseudoRandom, samples: 100_000, replicates: 1, seed: 1 };
        let found = analyse(&product.model, settings, |_| ()).unwrap().joint.measures[0].deviation;
        let expected = deviation(&three(skewed, kind, 0.6));
        assert!((found.value - expected).abs() < 4.0 * found.error.unwrap(), "{kind}: {found:?} {expected}");
    }
    let error = parse(&three(skewed, "pearson", -0.9), &[]).err().unwrap().to_string();
    assert!(error.contains("between -0.7") && error.contains("1.000"), "{error}");
}

/// A wall 400 × 10 on a floor 400 × 80.
const WALL: &str = r#"
[tolerance]
general = "mK"
[[part]]
name = "box"
plane = [
  { name = "floor", at = [0, 0, 0], normal = "+z", along = "+x", extents = [400, 80], flatness = "none" },
  { name = "wall", at = [0, 40, 5], normal = "-y", along = "+x", extents = [400, 10], flatness = "none", perpendicularity = { datum = "box.floor" } },
  { name = "roof", at = [0, 0, 10], normal = "-z", along = "+x", extents = [400, 80], offset = { value = 0, tolerance = 0.4 }, flatness = "none", parallelism = { datum = "box.floor" } },
]
[[measure]]
name = "corner"
angle = ["box.wall", "box.floor"]
[[measure]]
name = "roof"
angle = ["box.roof", "box.floor"]
"#;

#[test]
fn general_perpendicularity_goes_by_the_shorter_leg_and_parallelism_by_the_whole_size() {
    let wall = parse(WALL, &[]).unwrap().product.unwrap();
    let first = |name: &str| wall.model.contributors.iter().position(|c| c.name == name).unwrap();
    let offset = |name: &str| wall.model.offsets()[first(name)];
    // Class K up to 100 mm: 0.4 mm over the wall's height of 10 mm.
    let leant = at(&wall, &[(offset("box.wall perpendicularity") + 2, 1.0)])[0];
    close((leant - std::f64::consts::FRAC_PI_2).abs(), libm::atan(0.4 / 10.0), 1e-9);
    // ± 0.4 mm is 0.8 mm in all, more than the flatness of 0.4 mm: half of it at either end of 80 mm.
    let tilted = at(&wall, &[(offset("box.roof parallelism") + 2, 1.0)])[1];
    close(std::f64::consts::PI - tilted, libm::atan(0.8 / 80.0), 1e-6);
}

#[test]
fn general_tolerances_cover_place_and_no_form_beyond_an_orientation() {
    let names = |product: &Product| product.model.contributors.iter().map(|c| c.name.clone()).collect::<Vec<_>>();
    let wall = parse(WALL, &[]).unwrap().product.unwrap();
    assert_eq!(
        names(&wall),
        ["box.wall perpendicularity", "box.wall place", "box.roof offset", "box.roof parallelism"]
    );
    // ISO 2768-1 m: 0.3 mm for 40 mm.
    let Variation::Scalar { limits, .. } = wall.model.contributors[1].variation else { panic!("a scalar") };
    close(limits[1], 0.3e-3, 1e-15);
    assert!(wall.warnings.contains(&"without a tolerance: box.floor".to_owned()), "{:?}", wall.warnings);
    let fixed = WALL
        .replace("flatness = \"none\", perpendicularity = {", "offset = \"none\", perpendicularity = { zone = 0.05,");
    let fixed = parse(&fixed, &[]).unwrap().product.unwrap();
    assert_eq!(names(&fixed)[0], "box.wall perpendicularity");
    let told = "without a tolerance of their place: box.wall".to_owned();
    assert!(fixed.warnings.contains(&told), "{:?}", fixed.warnings);
    // All of the lean is that of the stated zone: the general flatness of 0.4 mm is not in force.
    let theory = slipfit_tolerance::analysis::theory(&fixed.model, 1, None).unwrap();
    let [low, high] = theory.worst_cases[0].linear;
    close(0.5 * (high - low), libm::atan(0.05 / 10.0), 1e-6);
}

#[test]
fn losses_are_counted_off_the_target() {
    let text = |loss: &str| {
        format!(
            "[[dimension]]\nname = \"d\"\nvalue = 10.1\ntolerance = 0.3\n\
             [[measure]]\nname = \"m\"\nis = \"d\"\nlower = 9.6\nupper = 10.4\nloss = {loss}\n"
        )
    };
    for loss in ["{ cost = 50, repair = 2 }", "{ cost = 50, at = 0.4, target = 10, repair = 2 }"] {
        let product = parse(&text(loss), &[]).unwrap().product.unwrap();
        let settings = Settings { method: Method::PseudoRandom, samples: 100_000, replicates: 1, seed: 1 };
        let analysis = analyse(&product.model, settings, |_| ()).unwrap();
        let report = report("", &product.model, &analysis).measures[0].loss.unwrap();
        // 50/0.4², and no more than 2.
        close(report.coefficient, 312.5, 1e-9);
        let expected = capped(0.1, 0.1, 312.5, 2.0);
        assert!((report.mean.value - expected).abs() < 4.0 * report.mean.error.unwrap(), "{report:?}");
        assert!(report.mean.error.unwrap() < 0.05);
        close(report.signal_to_noise.unwrap(), 20.0 * libm::log10(101.0), 0.05);
        close(report.balanced_tolerance.unwrap(), 0.08, 1e-9);
    }
    for (loss, said) in [
        ("{ cost = 0 }", "`measure.loss.cost` is 0"),
        ("{ at = 0.1 }", "`measure.loss.cost` is missing"),
        ("{ cost = 1, at = 0 }", "`measure.loss.at` is 0 mm"),
        ("{ cost = 1, of = 0 }", "unknown key `measure.loss.of`"),
    ] {
        let error = parse(&text(loss), &[]).err().unwrap().to_string();
        assert!(error.contains(said), "{error}");
    }
    let error = parse(&text("{ cost = 1, at = 0.1 }").replace("upper = 10.4\n", ""), &[]).err().unwrap().to_string();
    assert!(error.contains("`measure.loss.target` is missing"), "{error}");
}

#[test]
fn only_a_slide_moves() {
    let error = crate::setup::Scene::parse("clutch.toml", shipped("clutch").unwrap(), &[]).unwrap_err();
    assert_eq!(error.problem(), &Problem::NoSlide);
    assert!(parse(shipped("clutch").unwrap(), &[]).unwrap().slide.is_none());
}

#[test]
fn inches_and_fits_are_tolerances() {
    let scene = |value: &str, tolerance: &str| {
        let text = format!(
            "[[dimension]]\nname = \"d\"\nvalue = {value}\ntolerance = {tolerance}\n[[measure]]\nname = \"m\"\nis = \"d\"\n"
        );
        let product = parse(&text, &[]).unwrap().product.unwrap();
        let Variation::Scalar { limits, .. } = product.model.contributors[0].variation else { panic!("a scalar") };
        limits.map(|limit| (limit * 1e9).round() / 1e6)
    };
    assert_eq!(scene("\"0.5 in\"", "\"0.01 in\""), [12.446, 12.954]);
    assert_eq!(scene("25", "\"H7\""), [25.0, 25.021]);
    assert_eq!(scene("25", "\"g6\""), [24.980, 24.993]);
    assert_eq!(scene("500", "\"K7\""), [499.955, 500.018]);
    assert_eq!(scene("\"1 in\"", "\"p6\""), [25.422, 25.435]);
    assert_eq!(scene("120", "\"f\""), [119.85, 120.15]);
}

/// Whether `text` with `from` replaced by `to` is refused at the bar in `marked`; else what happens.
pub(super) fn check(text: &str, from: &str, to: &str, [marked, problem, allowed]: [&str; 3]) -> Result<(), String> {
    assert!(text.contains(from), "{from}");
    let text = text.replacen(from, to, 1);
    let error = parse(&text, &[]).err().ok_or_else(|| format!("accepted: {to}"))?.to_string();
    let start = text.find(&marked.replace('|', "")).unwrap_or_else(|| panic!("{marked}"));
    let before = &text[..start + marked.find('|').unwrap()];
    let column = before.chars().rev().take_while(|character| *character != '\n').count() + 1;
    let place = format!(" scene.toml:{}:{column}\n", before.matches('\n').count() + 1);
    let missing = [place.as_str(), problem, allowed].into_iter().find(|part| !error.contains(part));
    missing.map_or(Ok(()), |part| Err(format!("{part} is not in\n{error}")))
}

/// Panics with all failures of cases.
pub(super) fn check_all(text: &str, cases: &[(&str, &str, [&str; 3])]) {
    let failures = cases.iter().filter_map(|(from, to, expected)| check(text, from, to, *expected).err());
    let failures: Vec<_> = failures.collect();
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
}

/// Three wrong dimensions and measures are three errors; what uses their names is not wrong as well.
#[test]
fn every_mistake_of_a_product_is_told() {
    let text = "[[dimension]]\nname = \"a\"\nvalue = 30\ntolerance = 0\n\
                [[dimension]]\nname = \"b\"\nvalue = 30\ntolerance = [0.1, -0.1]\n\
                [[measure]]\nname = \"c\"\nis = \"hypot(a, b)\"\n\
                [[measure]]\nname = \"d\"\nis = \"a + zz\"\n\
                [[measure]]\nname = \"e\"\nis = \"a + c\"\nlower = 31\nupper = 29\n";
    let said = SceneFile::parse("x.toml", text, &[]).err().unwrap().to_string();
    let places: Vec<_> = said.lines().filter_map(|line| line.split_once("x.toml:")).map(|(_, place)| place).collect();
    assert_eq!(places, ["4:13", "8:13", "11:7", "14:11", "19:9"], "{said}");
}
