//! Fits against published ones and those of other programs.
#![cfg(test)]

use slipfit_core::sampling::{
    normal::score,
    stream::{Rng, unit_stream},
};

use super::{
    Family, Fit, FitError, JohnsonSb, JohnsonSu, Kind, Lognormal, Normal, Posterior, TwoNormals, Weibull, choose,
    preferred,
};
use crate::examples::{BALL_BEARINGS, ROSNER};

fn parameters(fit: &Fit) -> Vec<f64> {
    fit.family.parameters().into_iter().map(|(_, value)| value).collect()
}

#[track_caller]
fn near(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within, "{found}, not {expected}");
}

#[test]
fn ball_bearings_as_published() {
    // J. Lawless, "Statistical Models and Methods for Lifetime Data": Weibull's shape 2.10 and scale 81.88; mean and
    // deviation of the logarithms 4.15 and 0.522.
    let weibull = Kind::Weibull.fit(&BALL_BEARINGS).expect("a fit");
    let [_, scale, shape] = parameters(&weibull)[..] else { panic!() };
    near(scale, 81.88, 0.005);
    near(shape, 2.10, 0.005);
    let lognormal = Kind::Lognormal.fit(&BALL_BEARINGS).expect("a fit");
    let [_, mean, deviation] = parameters(&lognormal)[..] else { panic!() };
    near(mean, 4.15, 0.005);
    near(deviation, 0.522, 0.0005);
    // Logarithms of the likelihoods by SciPy 1.17.
    near(weibull.ln_likelihood, -113.691_290_932, 1e-8);
    near(lognormal.ln_likelihood, -113.128_566_737, 1e-8);
}

#[test]
fn an_unbounded_fit_is_as_likely_as_another_programs() {
    // SciPy 1.17's johnsonsu.fit of Rosner's data from three starts: −77.566007 at γ −0.841, δ 1.140, ξ 1.489, λ 0.720.
    let fit = Kind::JohnsonSu.fit(&ROSNER).expect("a fit");
    near(fit.ln_likelihood, -77.566_007, 1e-5);
    for (found, expected) in parameters(&fit).into_iter().zip([-0.841, 1.140, 1.489, 0.720]) {
        near(found, expected, 1e-3);
    }
}

/// A drawn sample of a distribution.
pub fn draw(family: &dyn Family, parts: usize, seed: u64) -> Vec<f64> {
    let mut stream = unit_stream(seed, 0);
    (0..parts).map(|_| family.value(score(stream.next_u64()))).collect()
}

pub fn examples() -> Vec<(Kind, Box<dyn Family>)> {
    vec![
        (Kind::Normal, Box::new(Normal { mean: 0.0, deviation: 0.1 })),
        (Kind::Lognormal, Box::new(Lognormal { shift: 0.0, mean: 1.0, deviation: 0.7 })),
        (Kind::Weibull, Box::new(Weibull { shift: 0.0, scale: 2.0, shape: 1.2 })),
        (Kind::ShiftedLognormal, Box::new(Lognormal { shift: 30.0, mean: 1.0, deviation: 0.5 })),
        (Kind::ShiftedWeibull, Box::new(Weibull { shift: -7.0, scale: 2.0, shape: 1.7 })),
        (Kind::JohnsonSu, Box::new(JohnsonSu { gamma: -0.5, delta: 1.2, xi: 3.0, lambda: 0.2 })),
        (Kind::JohnsonSb, Box::new(JohnsonSb { gamma: 0.3, delta: 0.8, xi: 1.0, lambda: 2.0 })),
        (
            Kind::TwoNormals,
            Box::new(TwoNormals {
                share: 0.4,
                parts: [Normal { mean: 0.0, deviation: 1.0 }, Normal { mean: 5.0, deviation: 1.0 }],
            }),
        ),
    ]
}

#[test]
fn the_family_of_many_parts_is_found_again() {
    for (kind, family) in examples() {
        let values = draw(family.as_ref(), 2000, 7);
        let (fits, _) = choose(&values).expect("fits");
        assert_eq!(
            preferred(&fits).map(|fit| fit.kind),
            Some(kind),
            "{:?}",
            fits.iter().map(|fit| (fit.kind, fit.aicc)).collect::<Vec<_>>()
        );
        assert!(fits[0].qq_correlation > 0.99, "{kind} {}", fits[0].qq_correlation);
        // A likeliest distribution is at least as likely as the true one.
        assert!(fits[0].ln_likelihood >= family.ln_likelihood(&values), "{kind}");
        for probability in [0.001_35, 0.5, 0.998_65] {
            let [found, truth] = [fits[0].family.quantile(probability), family.quantile(probability)];
            let spread = family.quantile(0.998_65) - family.quantile(0.001_35);
            assert!((found - truth).abs() < 0.1 * spread, "{kind} {probability}: {found} {truth}");
        }
    }
}

#[test]
fn quantiles_are_inverse_to_tails_and_densities_their_slopes() {
    for (_, family) in examples() {
        for probability in [1e-6, 0.001_35, 0.1, 0.5, 0.9, 0.998_65] {
            let x = family.quantile(probability);
            let [below, above] = family.tails(x);
            near(below / probability, 1.0, 1e-8);
            near(below + above, 1.0, 1e-12);
            let step = 1e-5 * (family.quantile(0.9) - family.quantile(0.1));
            let slope = (family.cdf(x + step) - family.cdf(x - step)) / (2.0 * step);
            if probability >= 0.1 {
                near(libm::log(slope), family.ln_density(x), 1e-5);
            }
        }
    }
}

#[test]
fn too_few_parts_and_wrong_values_are_refused() {
    assert!(matches!(choose(&[1.0; 6]), Err(FitError::FewToChoose { least: 30, found: 6 })));
    let error = Kind::Weibull.fit(&[1.0, 2.0]).expect_err("few");
    assert_eq!(error.to_string(), "weibull needs 5 measured parts, but there are 2");
    assert!(matches!(Kind::Normal.fit(&[3.0; 10]), Err(FitError::NoVariation(3.0))));
    assert!(matches!(Kind::Lognormal.fit(&[1.0, 2.0, 3.0, 0.0, 4.0]), Err(FitError::NotPositive { .. })));
    assert!(matches!(Kind::Normal.fit(&[1e308, -1e308, 0.0]), Err(FitError::TooFarApart)));
    // Values with a long lower tail have no lower end.
    let mirrored: Vec<f64> =
        draw(&Lognormal { shift: 0.0, mean: 0.0, deviation: 0.5 }, 200, 3).iter().map(|x| -x).collect();
    assert!(matches!(Kind::ShiftedLognormal.fit(&mirrored), Err(FitError::NoMaximum(_))));
}

#[test]
fn what_is_unknown_of_a_normal_is_as_exact_intervals_tell() {
    let values = draw(&Normal { mean: 3.0, deviation: 0.5 }, 12, 4);
    let fit = Kind::Normal.fit(&values).expect("a fit");
    let posterior = Posterior::new(Kind::Normal, Some(fit.family.as_ref()), &values).expect("a posterior");
    let [Normal { mean, deviation }] = [Normal { mean: fit.family.quantile(0.5), deviation: parameters(&fit)[1] }];
    let s = deviation * libm::sqrt(12.0 / 11.0);
    // Student's t and χ² of 11 degrees of freedom: 2.200985, 3.815748 and 21.920049.
    let [[low, high], [least, greatest]] =
        posterior.intervals(|family| [family.quantile(0.5), family.value(1.0) - family.value(0.0)]);
    near(low, mean - 2.200_985 * s / libm::sqrt(12.0), 0.03 * s);
    near(high, mean + 2.200_985 * s / libm::sqrt(12.0), 0.03 * s);
    near(least, s * libm::sqrt(11.0 / 21.920_049), 0.03 * s);
    near(greatest, s * libm::sqrt(11.0 / 3.815_748), 0.06 * s);
}
