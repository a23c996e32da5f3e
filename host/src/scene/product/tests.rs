//! The shipped products against known numbers, and every kind of bad input.

use crate::{
    product::Product,
    scene::{Override, Problem, SceneError, SceneFile, shipped},
    tolerance::moments,
    tolerance::{
        analysis::analyse,
        lanes::{LANES, Lanes},
        model::{Distribution, Quantity, Variation},
        report::report,
        sampler::Method,
        study::Settings,
    },
};

pub(super) fn parse(text: &str, overrides: &[&str]) -> Result<SceneFile, SceneError> {
    let overrides: Vec<_> = overrides.iter().map(|text| Override::set(text)).collect();
    SceneFile::parse("scene.toml", text, &overrides)
}

pub(super) fn product(name: &str, overrides: &[&str]) -> Product {
    let file = parse(shipped(name).unwrap(), overrides).unwrap_or_else(|error| panic!("{error}"));
    file.product.unwrap()
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

/// A scene with one dimension of 5 mm, and the distribution and the tolerance that `keys` give it.
fn alone(keys: &str) -> Result<SceneFile, SceneError> {
    parse(&format!("[[dimension]]\nname = \"x\"\nvalue = 5\n{keys}\n[[measure]]\nname = \"m\"\nis = \"x\"\n"), &[])
}

#[test]
fn distributions_by_name() {
    let of = |keys: &str| match alone(keys).unwrap().product.unwrap().model.contributors.remove(0).variation {
        Variation::Scalar { distribution, limits } => (distribution, limits),
        other => panic!("{other:?}"),
    };
    let (weibull, limits) = of("distribution = { kind = \"weibull\", shape = 2, scale = 0.1, location = -0.05 }");
    assert_eq!(weibull, Distribution::Weibull { shape: 2.0, scale: 0.1e-3, location: 5e-3 - 0.05e-3 });
    close(limits[1], 4.95e-3 + 0.1e-3 * libm::sqrt(-libm::log(1.349_898_031_630_094_5e-3)), 1e-15);
    let (gumbel, limits) =
        of("tolerance = [-0.1, 0.4]\ndistribution = { kind = \"gumbel\", mode = \"10 µm\", scale = 0.05 }");
    assert_eq!((gumbel, limits), (Distribution::Gumbel { mode: 5e-3 + 10e-6, scale: 0.05e-3 }, [4.9e-3, 5.4e-3]));
    let (smallest, _) = of("distribution = { kind = \"gumbel-smallest\", scale = 0.05 }");
    assert_eq!(smallest, Distribution::Gumbel { mode: 5e-3, scale: -0.05e-3 });
    let (beta, limits) = of("tolerance = 0.1\ndistribution = { kind = \"beta\", shapes = [2, 5] }");
    assert_eq!(beta, Distribution::Beta { limits, shapes: [2.0, 5.0] });
    let (lognormal, _) = of("distribution = { kind = \"lognormal\", mean = 0.04, deviation = 0.02 }");
    let Distribution::Skewed { mean, deviation, skewness } = lognormal else { panic!("{lognormal:?}") };
    close(mean, 5.04e-3, 1e-17);
    assert_eq!((deviation, skewness), (0.02e-3, 0.5 * (0.25 + 3.0)));
    let (mixture, limits) = of("distribution = { kind = \"mixture\", of = [\
         { weight = 3, tolerance = [-0.1, 0], sigma = 2 }, { tolerance = 0.2, distribution = \"uniform\" }] }");
    let Distribution::Mixture(parts) = mixture else { panic!("{mixture:?}") };
    assert_eq!(limits, [5e-3 - 0.2e-3, 5e-3 + 0.2e-3]);
    assert_eq!(parts[1], (0.25, Distribution::Uniform { limits }));
    let (share, Distribution::Normal { mean, deviation }) = parts[0] else { panic!("{parts:?}") };
    assert_eq!(share, 0.75);
    close(mean, 4.95e-3, 1e-17);
    close(deviation, 0.025e-3, 1e-17);
}

#[test]
fn distributions_that_do_not_fit_are_pointed_at() {
    for (keys, expected) in [
        ("distribution = \"cauchy\"", "gumbel-smallest, mixture"),
        ("distribution = \"weibull\"", "`dimension.distribution.shape` is missing"),
        ("distribution = { kind = \"weibull\", shape = 0.1, scale = 1 }", "`dimension.distribution.shape` is 0.1"),
        ("distribution = { kind = \"gumbel\", scale = -1 }", "more than 0"),
        ("distribution = { kind = \"lognormal\", mean = -1, deviation = 1 }", "the mean is not above the location"),
        ("distribution = { kind = \"beta\", shapes = [2, 5] }", "`dimension.tolerance` is missing"),
        ("distribution = { kind = \"mixture\", of = [{ tolerance = 0.1 }] }", "a list of two or more"),
        (
            "distribution = { kind = \"mixture\", of = [{ tolerance = 0.1 }, { weight = 0, tolerance = 1 }] }",
            "more than 0",
        ),
        (
            "distribution = { kind = \"mixture\", of = [{ tolerance = 0.1 }, { weight = 2 }] }",
            "of.tolerance` is missing",
        ),
        (
            "distribution = { kind = \"mixture\", of = [{ tolerance = 0.1, distribution = \"flat\" }, { tolerance = 1 }] }",
            "is \"flat\"",
        ),
    ] {
        let error = alone(keys).err().unwrap_or_else(|| panic!("{keys}")).to_string();
        assert!(error.contains(expected) && error.contains("scene.toml:"), "{keys}: {error}");
    }
}

/// The drag of a slide by its coefficient of friction, its spring and a load.
const DRAG: &str = r#"
[tolerance]
general = "m"
[[dimension]]
name = "friction"
quantity = "number"
value = 0.15
tolerance = 0.03
[[dimension]]
name = "spring"
value = "2 N/mm"
tolerance = 0.2
[[dimension]]
name = "travel"
value = 5
tolerance = 0.5
[[dimension]]
name = "load"
value = "500 mN"
tolerance = "50 mN"
distribution = "uniform"
[[measure]]
name = "drag"
is = "friction * (spring * travel + load)"
upper = 2.5
[[measure]]
name = "stiffness, twice"
is = "2 * spring"
lower = "3000 N/m"
[[measure]]
name = "safety"
is = "3 N / drag"
"#;

#[test]
fn dimensions_are_numbers_and_forces_too() {
    let product = parse(DRAG, &[]).unwrap().product.unwrap();
    let nominal = product.nominal_measures();
    close(nominal[0], 0.15 * 10.5, 1e-14);
    close(nominal[1], 4000.0, 1e-10);
    close(nominal[2], 3.0 / 1.575, 1e-14);
    let measured = [0, 1, 2].map(|i| (product.model.measures[i].quantity, product.model.measures[i].limits));
    assert_eq!(measured[0], (Quantity::Force, [None, Some(2.5)]));
    assert_eq!(measured[1], (Quantity::Stiffness, [Some(3000.0), None]));
    assert_eq!(measured[2].0, Quantity::Ratio);
    let settings = Settings { method: Method::PseudoRandom, samples: 1000, replicates: 1, seed: 1 };
    let report = report("drag", &product.model, &analyse(&product.model, settings, |_| ()).unwrap());
    let [drag, twice, _] = &report.measures[..] else { panic!("three measures") };
    assert_eq!([drag.unit, twice.unit], ["N", "N/mm"]);
    close(drag.nominal.unwrap(), 1.575, 1e-12);
    close(drag.worst_case_vertices.unwrap()[1], 0.18 * (2.2 * 5.5 + 0.55), 1e-12);
    close(twice.rss.unwrap().tolerance, 0.4, 1e-9);
    // The middle of every tolerance is its nominal value: ∂drag/∂spring is friction · travel.
    let slopes =
        [("spring", 0.15 * 5.0, "N/mm"), ("travel", 0.15 * 2.0, "mm"), ("friction", 10.5, ""), ("load", 0.15, "N")];
    for (name, slope, per) in slopes {
        let share = drag.contributors.iter().find(|share| share.name == name).unwrap();
        close(share.slope.unwrap(), slope, 1e-6);
        assert_eq!(share.per, Some(per));
    }
}

#[test]
fn kinds_that_do_not_fit_are_pointed_at() {
    for (old, new, expected) in [
        ("tolerance = 0.2", "tolerance = \"m\"", "the class m of a stiffness"),
        ("tolerance = 0.2", "tolerance = \"H7\"", "the class H7 of a stiffness"),
        ("tolerance = 0.2", "", "`dimension.tolerance` is missing"),
        ("tolerance = \"50 mN\"", "tolerance = \"50 mm\"", "`dimension.tolerance` is \"50 mm\""),
        ("\"number\"", "\"weight\"", "length, angle, number, force, stiffness, mass, moment, pressure, time"),
        ("value = 0.15", "value = \"0.15 mm\"", "a number without a unit"),
        ("spring * travel + load", "spring * travel + friction", "cannot add a force and a plain number"),
        ("upper = 2.5", "upper = \"2.5 mm\"", "N, mN, kN"),
    ] {
        let text = DRAG.replacen(old, new, 1);
        assert_ne!(text, DRAG);
        let error = parse(&text, &[]).err().unwrap_or_else(|| panic!("{new}")).to_string();
        assert!(error.contains(expected), "{new}: {error}");
    }
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
    let theory = crate::tolerance::analysis::theory(&fixed.model, 1, None).unwrap();
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
        // 50/0.4² · (0.1² + 0.1²).
        close(report.coefficient, 312.5, 1e-9);
        assert!((report.mean.value - 6.25).abs() < 4.0 * report.mean.error.unwrap(), "{report:?}");
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
    let error = crate::scene::Scene::parse("clutch.toml", shipped("clutch").unwrap(), &[]).unwrap_err();
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

/// A stack to spoil.
const STACK: &str = r#"
[tolerance]
general = "mK"
[[dimension]]
name = "a"
value = 10
tolerance = 0.1
[[dimension]]
name = "b"
value = 20
distribution = { kind = "triangular", mode = 0.1 }
[[dimension]]
name = "phi"
value = "30°"
side = 20
[[correlation]]
of = ["a", "b"]
coefficient = 0.5
[[measure]]
name = "m"
is = "a + 'b' / 2"
lower = 10
upper = 30
[[sum]]
name = "s"
of = ["m"]
"#;

#[test]
fn the_stack_to_spoil_is_sound() {
    let file = parse(STACK, &[]).unwrap();
    assert!(file.product.unwrap().warnings[0].contains("withdrawn"));
}

#[test]
fn bad_input_is_shown_with_its_place_and_what_is_allowed() {
    let cases = [
        ("\"mK\"", "\"xK\"", ["general = |\"xK\"", "is \"xK\"", "f, m, c, v"]),
        ("general = \"mK\"", "rule = \"sigma\"", ["rule = |\"sigma", "is \"sigma\"", "sigma-zone, truncated"]),
        ("general = \"mK\"", "sigma = 0", ["sigma = |0", "`tolerance.sigma` is 0", "0.1 to 100"]),
        ("general = \"mK\"", "sigma = 3", ["|[[dimension]]\nname = \"b\"", "`dimension.tolerance` is missing", "±"]),
        ("general", "generl", ["|generl", "did you mean `tolerance.general`", "general, rule, sigma"]),
        ("value = 10", "value = true", ["value = |true", "is a boolean", "a number in mm"]),
        ("value = 10", "value = inf", ["value = |inf", "not finite", "mm"]),
        ("value = 10", "value = \"10 lb\"", ["value = |\"10 lb", "unit does not fit", "mm, m"]),
        (
            "value = 20",
            "value = 0.2",
            ["value = |0.2", "class m has no tolerance of a size for 0.2 mm", "from 0.5 up to 4000"],
        ),
        ("value = 20", "value = 4001", ["value = |4001", "for 4001 mm", "from 0.5 up to 4000 mm"]),
        ("tolerance = 0.1", "tolerance = 0", ["tolerance = |0", "`dimension.tolerance` is 0 mm", "\"constant\""]),
        ("tolerance = 0.1", "tolerance = [0.3, -0.1]", ["tolerance = |[0.3", "lower limit is above", "[-0.1, 0.3]"]),
        ("tolerance = 0.1", "tolerance = \"K9\"", ["tolerance = |\"K9", "no class K9 for 10 mm", "H7 or g6"]),
        (
            "value = 10\ntolerance = 0.1",
            "value = 501\ntolerance = \"H7\"",
            ["value = |501", "up to 500 mm, not 501", "H7"],
        ),
        ("tolerance = 0.1", "tolerance = -0.1", ["tolerance = |-0.1", "is -0.1 mm", "more than 0"]),
        ("tolerance = 0.1", "tolerance = [0.1, 0.1]", ["tolerance = |[0.1", "no width", "below the upper one"]),
        (
            "tolerance = 0.1",
            "tolerance = \"x\"",
            ["tolerance = |\"x", "is \"x\"", "ISO 286 class with its size: H7, g6"],
        ),
        ("tolerance = 0.1", "tolerance = 1e-18", ["tolerance = |1e-18", "no width", "±"]),
        ("side = 20", "", ["|[[dimension]]\nname = \"phi", "`dimension.side` is missing", "shorter side"]),
        ("mode = 0.1", "mode = 0.3", ["distribution = |{ kind", "the mode is not within", "±"]),
        ("\"triangular\"", "\"bell\"", ["kind = |\"bell", "is \"bell\"", "normal, truncated-normal"]),
        ("\"triangular\"", "\"table\"", ["|{ kind", "`dimension.distribution.deviations` is missing", "two or more"]),
        ("name = \"phi\"", "name = \"a\"", ["name = |\"a\"\nvalue = \"30", "is \"a\" again", "a name of its own"]),
        ("name = \"phi\"", "name = \"it's\"", ["name = |\"it's", "`dimension.name`", "without single quotes"]),
        ("[\"a\", \"b\"]", "[\"a\", \"c\"]", ["[\"a\", |\"c\"]", "no contributor of one variable `c`", "a, b, phi"]),
        ("[\"a\", \"b\"]", "[\"a\"]", ["of = |[\"a\"]\ncoef", "is a list of 1", "two contributors"]),
        ("[\"a\", \"b\"]", "[\"a\", \"a\"]", ["of = |[\"a\", \"a\"]", "is \"a\" again", "every pair once"]),
        ("coefficient = 0.5", "coefficient = 1", ["coefficient = |1", "is 1", "between -0.9"]),
        ("coefficient = 0.5", "coefficient = 1.1", ["coefficient = |1.1", "is 1.1", "-1 to 1"]),
        ("a + 'b'", "a + 'c'", ["a + |'c' / 2", "no measure above called `c`", "a dimension"]),
        ("a + 'b'", "a + + +", ["a + + + |/", "found `/`", "such as"]),
        ("a + 'b'", "a + phi", ["a |+ phi", "cannot add a length and an angle", "one kind"]),
        ("'b' / 2", "'b' / 0", ["'b' |/ 0", "divides by zero", "finite at the nominal"]),
        ("a + 'b' / 2", "m", ["is = \"|m", "no measure above called `m`", "stands above"]),
        ("upper = 30", "upper = 10", ["upper = |10", "which is not above the lower limit, 10 mm", "above the lower"]),
        ("upper = 30", "upper = \"3°\"", ["upper = |\"3°", "unit does not fit", "mm"]),
        ("[\"m\"]", "[\"n\"]", ["of = [|\"n\"]", "there is no measure `n`", "m"]),
        ("[\"m\"]", "[]", ["of = |[]", "is a list of 0", "a list of measures"]),
        ("is = \"a", "it = \"a", ["|it = ", "unknown key `measure.it`", "name, is"]),
    ];
    check_all(STACK, &cases);
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
