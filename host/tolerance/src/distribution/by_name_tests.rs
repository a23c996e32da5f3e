//! Distributions by name against closed forms, another library, and the units that are drawn.

use statrs::distribution::{ContinuousCDF, Gumbel, Weibull};

use super::{Marginal, quadrature::nodes};
use crate::{
    analysis::analyse,
    counting::study::Settings,
    examples::{linear, scalar},
    model::{Distribution, Variation},
    numeric::shape::{Shape, weighted},
    sampling::sampler::Method,
};

/// A distribution with its mean, standard deviation, skewness and kurtosis in closed form.
fn cases() -> Vec<(Distribution, [f64; 4])> {
    let pi = std::f64::consts::PI;
    let rayleigh = {
        let rest = 4.0 - pi;
        let skewness = 2.0 * libm::sqrt(pi) * (pi - 3.0) / libm::pow(rest, 1.5);
        let kurtosis = 3.0 - (6.0 * pi * pi - 24.0 * pi + 16.0) / (rest * rest);
        [1.0 + 0.2 * libm::sqrt(pi / 2.0), 0.2 * libm::sqrt(rest / 2.0), skewness, kurtosis]
    };
    // With Euler's constant and Apéry's.
    let gumbel = |scale: f64| {
        let skewness = 12.0 * libm::sqrt(6.0) * 1.202_056_903_159_594_3 / (pi * pi * pi);
        [2.0 + scale * 0.577_215_664_901_532_9, scale.abs() * pi / libm::sqrt(6.0), skewness.copysign(scale), 5.4]
    };
    let beta = |[a, b]: [f64; 2]| {
        let (sum, product) = (a + b, a * b);
        let skewness = 2.0 * (b - a) * libm::sqrt(sum + 1.0) / ((sum + 2.0) * libm::sqrt(product));
        let excess =
            6.0 * ((a - b) * (a - b) * (sum + 1.0) - product * (sum + 2.0)) / (product * (sum + 2.0) * (sum + 3.0));
        [-1.0 + 4.0 * a / sum, 4.0 * libm::sqrt(product / (sum + 1.0)) / sum, skewness, 3.0 + excess]
    };
    // Means 0 and 1, deviations 0.2 and 0.5, shares 3/4 and 1/4.
    let mixture = {
        let parts: [[f64; 3]; 2] = [[0.75, -0.25, 0.2], [0.25, 0.75, 0.5]];
        let sum = |of: &dyn Fn(f64, f64) -> f64| parts.iter().map(|[w, d, s]| w * of(*d, s * s)).sum::<f64>();
        let variance = sum(&|d, v| d * d + v);
        let third = sum(&|d, v| d * (d * d + 3.0 * v));
        let fourth = sum(&|d, v| d * d * d * d + 6.0 * d * d * v + 3.0 * v * v);
        [0.25, libm::sqrt(variance), third / libm::pow(variance, 1.5), fourth / (variance * variance)]
    };
    let limits = [-1.0, 3.0];
    let normal = |mean, deviation| Distribution::Normal { mean, deviation };
    vec![
        (Distribution::Weibull { shape: 2.0, scale: 0.2 * libm::sqrt(2.0), location: 1.0 }, rayleigh),
        (Distribution::Weibull { shape: 1.0, scale: 0.5, location: 0.0 }, [0.5, 0.5, 2.0, 9.0]),
        (Distribution::Gumbel { mode: 2.0, scale: 0.3 }, gumbel(0.3)),
        (Distribution::Gumbel { mode: 2.0, scale: -0.3 }, gumbel(-0.3)),
        (Distribution::Beta { limits, shapes: [2.0, 5.0] }, beta([2.0, 5.0])),
        (Distribution::Beta { limits, shapes: [0.5, 0.5] }, beta([0.5, 0.5])),
        (Distribution::Mixture(vec![(0.75, normal(0.0, 0.2)), (0.25, normal(1.0, 0.5))]), mixture),
    ]
}

#[test]
fn moments_are_those_in_closed_form() {
    for (distribution, expected) in cases() {
        let nodes = nodes(&Variation::Scalar { distribution: distribution.clone(), limits: [0.0; 2] });
        let (mean, moments) = weighted(nodes.iter().map(|node| (node.weight, node.at[0])));
        let shape = Shape::of_moments(moments);
        for (found, expected) in
            [mean, libm::sqrt(moments[2]), shape.skewness(), shape.kurtosis()].into_iter().zip(expected)
        {
            assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{distribution:?}: {found} {expected}");
        }
    }
}

#[test]
fn units_have_the_moments_of_their_distribution() {
    let settings = Settings { method: Method::PseudoRandom, samples: 20_000, replicates: 1, seed: 3 };
    for (distribution, expected) in cases() {
        let model = linear(vec![scalar("x", distribution.clone(), [0.0, 1.0])], vec![vec![1.0]]);
        let found = analyse(&model, settings, |_| ()).unwrap().joint.measures[0].clone();
        for (found, expected) in [Some(found.mean), Some(found.deviation), found.skewness].into_iter().zip(expected) {
            let found = found.unwrap();
            let error = found.error.unwrap();
            assert!((found.value - expected).abs() < 4.0 * error, "{distribution:?}: {found:?} {expected}");
        }
    }
}

#[test]
fn probabilities_are_those_of_another_library() {
    let weibull = Weibull::new(1.7, 0.4).unwrap();
    let gumbel = Gumbel::new(0.3, 0.2).unwrap();
    let named = [
        Distribution::Weibull { shape: 1.7, scale: 0.4, location: 0.0 },
        Distribution::Gumbel { mode: 0.3, scale: 0.2 },
    ];
    for x in [0.05, 0.3, 0.7, 1.0, 1.8] {
        let expected = [weibull.cdf(x), gumbel.cdf(x)];
        for (distribution, expected) in named.iter().zip(expected) {
            let [below, above] = Marginal::new(distribution).tails(x);
            assert!((below - expected).abs() < 1e-12 && (above + expected - 1.0).abs() < 1e-12, "{distribution:?} {x}");
        }
    }
}

/// Mean 1 and standard deviation 0.5 from 0 on: Φ((ln x + s²/2)/s) with s² = ln 1.25, by 30 digits.
#[test]
fn probabilities_of_a_lognormal() {
    let marginal = Marginal::new(&Distribution::Skewed { mean: 1.0, deviation: 0.5, skewness: 0.5 * (0.25 + 3.0) });
    for (x, expected) in [
        (0.05, 5.121_253_802_161_797e-10),
        (0.3, 0.010_373_872_668_292_709),
        (0.7, 0.301_926_452_343_897_3),
        (1.0, 0.593_357_521_603_450_1),
        (1.8, 0.930_629_723_612_950_1),
    ] {
        let [below, above] = marginal.tails(x);
        assert!((below / expected - 1.0).abs() < 1e-12 && (above + expected - 1.0).abs() < 1e-15, "{x}: {below:e}");
    }
}
