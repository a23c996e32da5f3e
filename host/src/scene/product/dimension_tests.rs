//! Distributions and kinds of dimensions.

use slipfit_tolerance::{
    analysis::analyse,
    counting::study::Settings,
    distribution::quadrature::mean_and_deviation,
    model::{Distribution, Quantity, Variation},
    report::report,
    sampling::sampler::Method,
};

use super::tests::{close, parse};
use crate::scene::{SceneError, SceneFile};

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

/// Mean, standard deviation and limits (mm, from the value of 5 mm) of a normal distribution.
fn normal(keys: &str) -> ([f64; 2], [f64; 2]) {
    let product = alone(keys).unwrap_or_else(|error| panic!("{error}")).product.unwrap();
    let Variation::Scalar { distribution, limits } = &product.model.contributors[0].variation else { panic!("{keys}") };
    let Distribution::Normal { mean, deviation } = distribution else { panic!("{distribution:?}") };
    ([(mean - 5e-3) * 1e3, deviation * 1e3], limits.map(|limit| (limit - 5e-3) * 1e3))
}

#[test]
fn a_process_has_a_mean_and_a_deviation_of_its_own() {
    let tolerance = "tolerance = [-0.1, 0.3]\ndistribution = ";
    for (keys, mean, deviation, limits) in [
        ("{ kind = \"normal\" }", 0.1, 0.2 / 3.0, [-0.1, 0.3]),
        // From the value, and from the middle of the limits.
        ("{ kind = \"normal\", mean = 0.02 }", 0.02, 0.2 / 3.0, [-0.1, 0.3]),
        ("{ kind = \"normal\", shift = 0.02 }", 0.12, 0.2 / 3.0, [-0.1, 0.3]),
        ("{ kind = \"normal\", shift = \"-20 µm\", deviation = \"30 µm\" }", 0.08, 0.03, [-0.1, 0.3]),
        // Cpk: the nearer limit is 3·Cpk standard deviations from the mean.
        ("{ kind = \"normal\", cpk = 1.33 }", 0.1, 0.2 / 3.99, [-0.1, 0.3]),
        ("{ kind = \"normal\", mean = 0.2, cpk = 1.25 }", 0.2, 0.1 / 3.75, [-0.1, 0.3]),
        ("{ kind = \"normal\", mean = 0, cpk = 1.25 }", 0.0, 0.1 / 3.75, [-0.1, 0.3]),
    ] {
        let found = normal(&format!("{tolerance}{keys}"));
        for (found, expected) in found.0.into_iter().chain(found.1).zip([mean, deviation].into_iter().chain(limits)) {
            close(found, expected, 1e-12);
        }
    }
    // With a deviation of its own it needs no tolerance: its limits are three standard deviations off.
    let (found, limits) = normal("distribution = { kind = \"normal\", mean = 0.02, deviation = 0.01 }");
    for (found, expected) in found.into_iter().chain(limits).zip([0.02, 0.01, -0.01, 0.05]) {
        close(found, expected, 1e-12);
    }
    // What the analysis makes of it: Cpk as stated, the mean where it is.
    let text = "[[dimension]]\nname = \"x\"\nvalue = 5\ntolerance = 0.1\ndistribution = { kind = \"normal\", shift = 0.05, cpk = 1 }\n\
                [[measure]]\nname = \"m\"\nis = \"x\"\nlower = 4.9\nupper = 5.1\n";
    let product = parse(text, &[]).unwrap().product.unwrap();
    let settings = Settings { method: Method::PseudoRandom, samples: 100_000, replicates: 1, seed: 1 };
    let found = &analyse(&product.model, settings, |_| ()).unwrap().joint.measures[0];
    assert!((found.mean.value - 5.05e-3).abs() < 4.0 * found.mean.error.unwrap(), "{:?}", found.mean);
    assert!((found.deviation.value - 0.05e-3 / 3.0).abs() < 4.0 * found.deviation.error.unwrap());
    // The same of a truncated and of a skewed one.
    for kind in ["truncated-normal", "skewed"] {
        let more = if kind == "skewed" { ", skewness = 0.5" } else { "" };
        let keys =
            format!("tolerance = 0.3\ndistribution = {{ kind = \"{kind}\", mean = 0.05, deviation = 0.02{more} }}");
        let product = alone(&keys).unwrap().product.unwrap();
        let [mean, deviation] = mean_and_deviation(&product.model.contributors[0].variation)[0];
        close(mean * 1e3, 5.05, 1e-9);
        close(deviation * 1e3, 0.02, 1e-9);
    }
}

#[test]
fn distributions_that_do_not_fit_are_pointed_at() {
    for (keys, expected) in [
        ("distribution = \"cauchy\"", "gumbel-smallest, mixture"),
        (
            "tolerance = 0.1\ndistribution = { kind = \"normal\", mean = 0.1, cpk = 1 }",
            "the mean is not within the tolerance",
        ),
        ("tolerance = 0.1\ndistribution = { kind = \"normal\", cpk = 0 }", "`dimension.distribution.cpk` is 0"),
        ("tolerance = 0.1\ndistribution = { kind = \"normal\", deviation = 0 }", "more than 0"),
        ("distribution = { kind = \"normal\", cpk = 1 }", "`dimension.tolerance` is missing"),
        ("distribution = { kind = \"truncated-normal\", deviation = 1 }", "`dimension.tolerance` is missing"),
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
    close(drag.worst_case[1], 0.18 * (2.2 * 5.5 + 0.55), 1e-12);
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
