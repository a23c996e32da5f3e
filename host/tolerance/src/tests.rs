//! Models with known answers, through everything.

use super::{
    analysis::{Analysis, Theory, analyse},
    counting::{
        pairs::Pairs,
        study::{Settings, Study, StudyError, join},
    },
    examples::{MM, chain, clutch, left_front, linear, normal, normals, rectangulars, scalar},
    model::{Distribution, Function, Model},
    report::report,
    sampling::sampler::Method,
    statistics::estimate::{Estimate, Spread, quantile},
    theory::moments,
};
use crate::numeric::{
    lanes::Lanes,
    normal::{density, tail},
};

const MC: Settings = Settings { method: Method::PseudoRandom, samples: 100_000, replicates: 1, seed: 1 };

fn analysed(model: &Model) -> Analysis {
    analyse(model, MC, |_| ()).unwrap()
}

fn near(estimate: &Estimate, expected: f64) {
    let error = estimate.error.unwrap();
    assert!((estimate.value - expected).abs() <= 4.0 * error, "{} ± {error}, not {expected}", estimate.value);
}

#[track_caller]
fn close(found: f64, expected: f64, bound: f64) {
    assert!((found - expected).abs() <= bound, "{found}, not {expected}");
}

#[test]
fn chain_of_seven() {
    let analysis = analysed(&chain());
    let (theory, joint) = (&analysis.theory, &analysis.joint);
    let worst = theory.worst_cases[0];
    for [low, high] in [worst.linear, worst.range] {
        close(low, 0.017 * MM, 1e-9 * MM);
        close(high, 0.783 * MM, 1e-9 * MM);
    }
    let rss = &theory.sums_of_squares[0];
    close(rss.middle, 0.4 * MM, 1e-9 * MM);
    close(rss.tolerance, 0.17825 * MM, 5e-6 * MM);
    close(rss.tolerance / 3.0, rss.deviation, 1e-9 * MM);
    let moments = theory.moments[0];
    close(moments.mean, rss.middle, 1e-9 * MM);
    close(moments.deviation, rss.deviation, 1e-9 * MM);
    close(moments.skewness, 0.0, 1e-6);
    close(moments.kurtosis, 3.0, 1e-6);
    near(&joint.measures[0].mean, moments.mean);
    near(&joint.measures[0].deviation, moments.deviation);
    near(&joint.measures[0].skewness.unwrap(), 0.0);
    near(&joint.measures[0].kurtosis.unwrap(), 3.0);
    assert!(theory.indices[0].is_none());
    // 6.73 standard deviations: nothing to count, and a flat border.
    let expected = tail(0.4 * MM / rss.deviation);
    for side in &theory.tails[0] {
        let side = side.as_ref().unwrap();
        close(side.first_order.unwrap() / expected, 1.0, 1e-6);
        close(side.probability / expected, 1.0, 4.0 * side.error / expected);
        assert!(side.error / expected < 0.01 && side.evaluations <= 20_000);
    }
}

#[test]
fn one_way_clutch() {
    let analysis = analysed(&clutch());
    let (theory, measure) = (&analysis.theory, &analysis.joint.measures[0]);
    let degrees = |angle: f64| angle.to_degrees();
    let rss = &theory.sums_of_squares[0];
    close(degrees(rss.middle), 7.018_389_8, 5e-8);
    let [low, high] = theory.worst_cases[0].linear.map(degrees);
    close((high - low) / 2.0, 0.9806, 5e-5);
    close((high + low) / 2.0, degrees(rss.middle), 1e-9);
    close(degrees(rss.tolerance), 0.6579, 5e-5);
    for (share, percent) in rss.shares.iter().zip([81.942, 13.013, 5.045]) {
        close(share * 100.0, percent, 5e-4);
    }
    // cos φ = (a + c)/(e − c), differentiated: by a, c, e times their tolerances.
    let (a, c, e): (f64, f64, f64) = (27.645, 11.43, 50.8);
    let cosine = (a + c) / (e - c);
    let sine = (e - c) * libm::sqrt(1.0 - cosine * cosine);
    let parts = [0.05 / sine, 0.01 * (1.0 + cosine) / sine, 0.0125 * cosine / sine];
    let square: f64 = parts.iter().map(|part| part * part).sum();
    close(rss.middle, libm::acos(cosine), 1e-9);
    close((high - low).to_radians() / 2.0, parts.iter().sum(), 1e-9);
    close(rss.tolerance, libm::sqrt(square), 1e-9);
    for (share, part) in rss.shares.iter().zip(parts) {
        close(*share, part * part / square, 1e-9);
    }
    let moments = theory.moments[0];
    // Second order leaves out what the third has in them; quadrature does not.
    let exact = theory.exact[0].unwrap();
    close(degrees(exact.mean), 7.014_956, 5e-7);
    close(degrees(exact.deviation), 0.219_670, 5e-7);
    close(degrees(moments.mean), 7.014_956, 2e-5);
    close(degrees(moments.deviation), 0.219_670, 4e-4);
    close(moments.skewness, -0.09439, 2e-3);
    close(moments.kurtosis, 3.0239, 2e-2);
    let factor = 1f64.to_degrees();
    near(&measure.mean.scaled(factor), 7.014_956);
    near(&measure.deviation.scaled(factor), 0.219_670);
    near(&measure.skewness.unwrap(), -0.09439);
    near(&measure.kurtosis.unwrap(), 3.0239);
    for (tail, ppm) in theory.tails[0].iter().zip([11.395, 0.5185]) {
        let tail = tail.as_ref().unwrap();
        assert!(tail.evaluations <= 20_000);
        close(tail.probability * 1e6 / ppm, 1.0, 0.05);
        close(tail.probability * 1e6, ppm, 4.0 * tail.error * 1e6 + 5e-5 * ppm);
    }
    let indices = theory.indices[0].as_ref().unwrap();
    for ((first, total), share) in indices.first.iter().zip(&indices.total).zip(&rss.shares) {
        close(*first, *share, 0.02);
        close(*total, *share, 0.02);
    }
}

#[test]
fn difference_of_two_with_limits_off_centre() {
    let centred = |mean: f64, half: f64| normal("x", mean, half);
    let model = linear(vec![centred(100.1, 0.2), centred(39.9, 0.3)], vec![vec![1.0, -1.0]]);
    let [low, high] = analysed(&model).theory.worst_cases[0].linear;
    close(low, 59.7, 1e-9);
    close(high, 60.7, 1e-9);
}

#[test]
fn sums_of_rectangulars() {
    for (deviations, expected) in [(vec![1.0; 4], 3.87941), (vec![1.0, 1.0, 1.0, 10.0], 17.0156)] {
        let model = rectangulars(&deviations);
        let study = Study::new(&model, MC).unwrap();
        let mut tallies = study.empty();
        study.add(0..MC.blocks(), &mut tallies, |_| ());
        for (p, sign) in [(0.025, -1.0), (0.975, 1.0)] {
            let found = quantile(study.frames(), &tallies, 0, p);
            // The density at the point, by a difference of the same sample's quantiles.
            let slope = (quantile(study.frames(), &tallies, 0, p + 0.005)
                - quantile(study.frames(), &tallies, 0, p - 0.005))
                / 0.01;
            let error = slope * libm::sqrt(0.025 * 0.975 / MC.samples as f64);
            close(found, sign * expected, 4.0 * error);
        }
        let moments = analysed(&model).theory.moments[0];
        let squares: Vec<f64> = deviations.iter().map(|d| d * d).collect();
        let variance: f64 = squares.iter().sum();
        close(moments.deviation, libm::sqrt(variance), 1e-9);
        close(moments.kurtosis, 3.0 - 1.2 * squares.iter().map(|s| s * s).sum::<f64>() / variance / variance, 1e-6);
    }
}

/// Locators at (0, 0), (124, 0) and (0, 36), barycentric weights at (62, 18) and (124, 36).
#[test]
fn three_locators() {
    let coefficients = vec![vec![0.0, 0.5, 0.5], vec![-1.0, 1.0, 1.0]];
    let model = linear((0..3).map(|_| normal("locator", 0.0, 3.0)).collect(), coefficients);
    let analysis = analysed(&model);
    for (i, expected) in [libm::sqrt(0.5), libm::sqrt(3.0)].into_iter().enumerate() {
        close(analysis.theory.moments[i].deviation, expected, 1e-9);
        near(&analysis.joint.measures[i].deviation, expected);
    }
    close(analysis.joint.correlation[0][1], 1.0 / libm::sqrt(1.5), 4.0 / libm::sqrt(1e5));
}

#[test]
fn a_pair_of_gaps_closes_as_its_correlation_says() {
    for correlation in [-0.5, 0.0, 0.6] {
        let closing = analysed(&left_front(correlation)).theory.closings[0].clone();
        close(closing.together * 1e6, 302.0, 0.5);
        close(closing.independent * 1e6, 0.74, 0.005);
        let variance = 0.0624 * 0.0624 + 0.0488 * 0.0488 + 2.0 * correlation * 0.0624 * 0.0488;
        let expected = tail(0.3814 / libm::sqrt(variance));
        close(closing.normal / expected, 1.0, 1e-6);
        let found = closing.tail.unwrap();
        close(found.probability / expected, 1.0, 4.0 * found.error / expected);
        assert!(found.error < 0.02 * expected);
    }
}

#[test]
fn threads_and_shards_give_the_same_bytes() {
    let model = clutch();
    for (method, replicates) in [(Method::PseudoRandom, 1), (Method::LatinHypercube, 2), (Method::ScrambledSobol, 4)] {
        let settings = Settings { method, samples: 40_000, replicates, seed: 7 };
        let study = Study::new(&model, settings).unwrap();
        let on = |threads: usize| {
            let mut tallies = study.empty();
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| study.add(0..settings.blocks(), &mut tallies, |_| ()));
            tallies
        };
        let one = on(1);
        assert!(one == on(2) && one == on(8), "{method:?}");
        let mut joined = study.empty();
        let shards = 3;
        for shard in [1, 2, 0] {
            let mut part = study.empty();
            study.add(shard * settings.blocks() / shards..(shard + 1) * settings.blocks() / shards, &mut part, |_| ());
            join(&mut joined, &part);
        }
        assert!(joined == one, "{method:?}");
        let other = Study::new(&model, Settings { seed: 8, ..settings }).unwrap();
        assert!(other.unit_measures(0) != study.unit_measures(0));
        assert_eq!(study.unit_measures(11)[0].0[0], study.unit_measures(8)[0].0[3]);
    }
}

/// Root mean square over seeds of the relative error of the standard deviation.
fn deviation_error(coefficients: &[f64], method: Method) -> f64 {
    let model = normals(coefficients);
    let exact = libm::sqrt(coefficients.iter().map(|c| c * c).sum());
    let seeds = 200;
    let shapes = moments::of_measures(&model).into_iter().map(|moments| moments.shape).collect();
    let spread = Spread { shapes, pairs: Pairs::new(&model) };
    let square = |seed| {
        let settings = Settings { method, samples: 4096, replicates: 1, seed };
        let study = Study::new(&model, settings).unwrap();
        let mut tallies = study.empty();
        study.add(0..settings.blocks(), &mut tallies, |_| ());
        let joint = super::statistics::estimate::joint(&model, method, study.frames(), &tallies, &spread);
        let error = joint.measures[0].deviation.value / exact - 1.0;
        error * error
    };
    libm::sqrt((0..seeds).map(square).sum::<f64>() / seeds as f64)
}

#[test]
fn scrambled_sobol_points_find_deviations_better() {
    let falling: Vec<f64> = (0..47).map(|i| libm::pow(0.8, f64::from(i))).collect();
    for (coefficients, least) in [(vec![1.0; 47], 5.0), (falling, 20.0)] {
        let random = deviation_error(&coefficients, Method::PseudoRandom);
        let sobol = deviation_error(&coefficients, Method::ScrambledSobol);
        println!("error of σ: pseudo-random {random:.2e}, scrambled Sobol' {sobol:.2e}, {:.1} times", random / sobol);
        assert!(random / sobol >= least, "{random} / {sobol} = {}", random / sobol);
    }
}

#[test]
fn replicates_that_count_nothing_still_have_an_interval() {
    let settings = Settings { method: Method::ScrambledSobol, samples: 8 * 1024, replicates: 8, seed: 1 };
    let good = analyse(&clutch(), settings, |_| ()).unwrap().joint.good.unwrap();
    assert_eq!(good.value, 1.0);
    // 12 ppm are outside; 8192 good units show no more than that it is less than 450 (Clopper and Pearson).
    close(good.interval[0].unwrap(), 1.0 - 450e-6, 1e-6);
    assert_eq!(good.interval[1], Some(1.0));
}

#[test]
fn impossible_studies_are_refused() {
    let model = chain();
    let refused = |settings| Study::new(&model, settings).err();
    assert_eq!(refused(Settings { samples: 1, ..MC }), Some(StudyError::Samples(1)));
    assert_eq!(
        refused(Settings { replicates: 7, ..MC }),
        Some(StudyError::Replicates { samples: 100_000, replicates: 7 })
    );
    let sobol = Settings { method: Method::ScrambledSobol, samples: 1 << 33, ..MC };
    assert_eq!(refused(sobol), Some(StudyError::SobolSamples(1 << 33)));
}

#[test]
fn a_constant_measure_has_no_shape() {
    let third = scalar("x", Distribution::Constant(0.1), [0.1; 2]);
    let model = linear(vec![third, normal("y", 0.0, 1.0)], vec![vec![3.0, 0.0], vec![0.0, 1.0]]);
    let measures = analysed(&model).joint.measures;
    assert!(measures[0].skewness.is_none() && measures[0].kurtosis.is_none());
    assert!(measures[1].skewness.is_some() && measures[1].kurtosis.is_some());
}

/// |x|, max(0, x − 3), min(x, y) and a parabola of standard normals.
struct Kinks;

impl Function for Kinks {
    fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
        let [x, y] = [variables[0], variables[1]];
        measures[0] = x.map(f64::abs);
        measures[1] = (x - Lanes::splat(3.0)).map(|x| x.max(0.0));
        measures[2] = Lanes(std::array::from_fn(|lane| x.0[lane].min(y.0[lane])));
        measures[3] = x + y * 0.5 + x * x * 0.01;
    }
}

#[test]
fn kinks_are_told_from_bends() {
    let mut model = linear(vec![normal("x", 0.0, 3.0), normal("y", 0.0, 3.0)], vec![vec![1.0; 2]; 4]);
    model.function = std::sync::Arc::new(Kinks);
    let analysis = analysed(&model);
    let Theory { moments, worst_cases, sums_of_squares, .. } = &analysis.theory;
    assert_eq!(moments.iter().map(|of| of.described).collect::<Vec<_>>(), [false, false, false, true]);
    // Half a normal; the lesser of two.
    let pi = std::f64::consts::PI;
    close(moments[0].mean, libm::sqrt(2.0 / pi), 1e-4);
    close(moments[0].deviation, libm::sqrt(1.0 - 2.0 / pi), 1e-4);
    close(moments[2].mean, -1.0 / libm::sqrt(pi), 2e-4);
    close(moments[2].deviation, libm::sqrt(1.0 - 1.0 / pi), 2e-4);
    for (worst, expected) in worst_cases.iter().zip([[0.0, 3.0], [0.0, 0.0], [-3.0, 3.0]]) {
        for (found, expected) in worst.range.into_iter().zip(expected) {
            close(found, expected, 1e-6);
        }
    }
    let report = report("", &model, &analysis);
    assert!(report.measures[..3].iter().all(|m| m.rss.is_none() && m.second_order.is_none()));
    assert!(report.measures[3].rss.is_some() && sums_of_squares.len() == 4);
    let shares = |i: usize| {
        let contributors = &report.measures[i].contributors;
        ["x", "y"].map(|name| contributors.iter().find(|share| share.name == name).unwrap().percent.unwrap())
    };
    assert_eq!(shares(0).map(|percent| percent.round()), [100.0, 0.0]);
    assert!(shares(2).iter().all(|percent| (percent - 50.0).abs() < 1.0), "{:?}", shares(2));
    assert!(report.notes.iter().filter(|note| note.contains("kink or a fold")).count() == 3);
    // Nearly all units have no more than nothing, all those of the first pilot among them.
    let gap = &analysis.joint.measures[1];
    assert_eq!(gap.points[..2].iter().map(|point| point.value).collect::<Vec<_>>(), [0.0, 0.0]);
    close(gap.points[2].value, 0.0, 1e-2);
    near(&gap.mean, density(3.0) - 3.0 * tail(3.0));
}

#[test]
fn measures_that_cannot_be_computed_are_counted() {
    let mut model = clutch();
    // A roller so large that half of the units have no angle.
    let distribution = Distribution::Uniform { limits: [11.577_5 * MM, 11.727_5 * MM] };
    model.contributors[0] = normal("hub", 27.495 * MM, 1e-6 * MM);
    model.contributors[1] = scalar("roller", distribution, [11.577_5 * MM, 11.727_5 * MM]);
    model.contributors[2] = normal("cage", 50.8 * MM, 1e-6 * MM);
    let measure = &analysed(&model).joint.measures[0];
    assert_eq!(measure.units + measure.undefined, MC.samples);
    close(measure.undefined as f64 / MC.samples as f64, 0.5, 0.01);
    assert!(measure.mean.value.is_finite() && measure.kurtosis.is_some());
}
