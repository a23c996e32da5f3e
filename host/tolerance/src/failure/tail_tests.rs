//! Probabilities of failures with several regions, corners or a ring, against closed forms.

use rayon::prelude::*;

use super::{
    Failure,
    tail::{Source, Tail, probability},
};
use crate::{
    examples::{linear, normal},
    model::{Function, Model},
    numeric::{
        lanes::Lanes,
        normal::{density, tail},
    },
    sampling::draw::Draw,
    statistics::interval::student_factor,
};

/// A measure of standard normals.
struct Of(fn(&[f64]) -> f64);

impl Function for Of {
    fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
        measures[0] = Lanes(std::array::from_fn(|lane| {
            let unit: Vec<f64> = variables.iter().map(|variable| variable.0[lane]).collect();
            (self.0)(&unit)
        }));
    }
}

/// A measure and the exact probability that it is beyond a limit.
struct Case {
    name: &'static str,
    variables: usize,
    measure: fn(&[f64]) -> f64,
    above: bool,
    exact: fn(f64) -> f64,
}

impl Case {
    fn model(&self) -> Model {
        let contributors = (0..self.variables).map(|_| normal("x", 0.0, 3.0)).collect();
        let mut model = linear(contributors, vec![vec![1.0; self.variables]]);
        model.function = std::sync::Arc::new(Of(self.measure));
        model
    }

    /// The limit with this probability beyond it.
    fn limit(&self, probability: f64) -> f64 {
        let (mut low, mut high) = (-60.0, 60.0);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if ((self.exact)(middle) > probability) == self.above { low = middle } else { high = middle }
        }
        low
    }

    fn found(&self, model: &Model, limit: f64, seed: u64) -> Option<Tail> {
        let failure = Failure { measures: vec![0], limit, above: self.above };
        probability(model, &Draw::new(model, 1).unwrap(), &failure, seed, None)
    }
}

/// |a − b| with a 10.01 ± 0.15, b 10 ± 0.15.
const DIFFERENCE: Case = Case {
    name: "difference either way",
    variables: 2,
    measure: |z| (0.01 + 0.05 * (z[0] - z[1])).abs(),
    above: true,
    exact: |limit| {
        let deviation = 0.05 * libm::sqrt(2.0);
        tail((limit - 0.01) / deviation) + tail((limit + 0.01) / deviation)
    },
};

/// P(xy > c) = 2∫φ(x)·Φ(−c/x) dx over x > 0.
const PRODUCT: Case = Case {
    name: "product",
    variables: 2,
    measure: |z| z[0] * z[1],
    above: true,
    exact: |limit| {
        const STEPS: i32 = 4000;
        let step = 10.0 / f64::from(STEPS);
        let places = (0..STEPS).map(|i| (f64::from(i) + 0.5) * step);
        2.0 * step * places.map(|x| density(x) * tail(limit / x)).sum::<f64>()
    },
};

const LARGER_OF_TWO: Case = Case {
    name: "larger of two gaps",
    variables: 4,
    measure: |z| (z[0] + z[1]).max(1.2 * z[2] + z[3] - 0.3),
    above: true,
    exact: |limit| {
        let [one, two] = [tail(limit / libm::sqrt(2.0)), tail((limit + 0.3) / libm::sqrt(2.44))];
        one + two - one * two
    },
};

const RADIUS: Case = Case {
    name: "radius of a position zone",
    variables: 2,
    measure: |z| libm::hypot(z[0], z[1]),
    above: true,
    exact: |limit| libm::exp(-0.5 * limit * limit),
};

/// The axes of two holes, each in its zone, on a plate with tolerances of its own.
const SUM_OF_ZONES: Case = Case {
    name: "radius of three position zones",
    variables: 6,
    measure: |z| libm::hypot(z[0] + 2.0 * z[2] + 0.5 * z[4], z[1] + 2.0 * z[3] + 0.5 * z[5]),
    above: true,
    exact: |limit| libm::exp(-0.5 * limit * limit / 5.25),
};

const FOUR_GAPS: Case = Case {
    name: "least of four gaps",
    variables: 8,
    measure: |z| {
        let gap = |i: usize, mean: f64| mean + z[2 * i] + 0.5 * z[2 * i + 1];
        gap(0, 0.0).min(gap(1, 0.2)).min(gap(2, 0.0)).min(gap(3, 0.4))
    },
    above: false,
    exact: |limit| {
        let good = |mean: f64| 1.0 - tail((mean - limit) / libm::sqrt(1.25));
        let bad: f64 = [0.0, 0.2, 0.0, 0.4].iter().map(|mean| libm::log1p(good(*mean) - 1.0)).sum();
        -libm::expm1(bad)
    },
};

const SIX: [&Case; 6] = [&DIFFERENCE, &PRODUCT, &LARGER_OF_TWO, &RADIUS, &SUM_OF_ZONES, &FOUR_GAPS];

#[track_caller]
fn near(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() <= relative, "{found:e}, not {expected:e}");
}

#[test]
fn all_regions_count() {
    for (case, limit, ppm) in [(&DIFFERENCE, 0.2, 5094.0), (&PRODUCT, 3.0, 9819.0)] {
        near((case.exact)(limit) * 1e6, ppm, 2e-4);
        near(case.found(&case.model(), limit, 1).unwrap().probability * 1e6, ppm, 0.02);
    }
    for case in SIX {
        let model = case.model();
        for probability in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7] {
            let found = case.found(&model, case.limit(probability), 1).unwrap();
            let ratio = found.probability / probability;
            assert!((ratio - 1.0).abs() < 0.05, "{}, {probability:e}: {ratio}", case.name);
            assert!(found.error < 0.03 * probability, "{}, {probability:e}: ±{:e}", case.name, found.error);
            assert_eq!(found.source, Source::ImportanceSampling);
        }
    }
}

#[test]
fn stated_intervals_hold() {
    for case in SIX {
        let model = case.model();
        let probability = 1e-5;
        let limit = case.limit(probability);
        let holds = |seed: u64| {
            let found = case.found(&model, limit, seed).unwrap();
            (found.probability - probability).abs() <= student_factor(16) * found.error
        };
        let held = (100..160u64).into_par_iter().filter(|seed| holds(*seed)).count();
        assert!(held >= 54, "{}: {held} of 60", case.name);
    }
}

#[test]
fn the_most_probable_point_is_reported_only_where_it_was_reached() {
    let corner = Case {
        name: "both gaps",
        variables: 2,
        measure: |z| z[0].min(z[1]),
        above: true,
        exact: |limit| tail(limit) * tail(limit),
    };
    let found = corner.found(&corner.model(), 3.0, 1).unwrap();
    near(found.probability, tail(3.0) * tail(3.0), 0.06);
    near(found.reliability.unwrap(), 3.0 * libm::sqrt(2.0), 1e-3);
    let ring = RADIUS.found(&RADIUS.model(), 4.0, 1).unwrap();
    near(ring.reliability.unwrap(), 4.0, 1e-3);
    assert!(ring.points.len() > 6 && ring.points.iter().all(|point| (point.distance - 4.0).abs() < 0.01));
    // A border of jumps has no slopes at all: only levels find it, and no point is reported.
    let steps = Case {
        name: "steps",
        variables: 2,
        measure: |z| libm::floor(4.0 * z[0]) / 4.0,
        above: true,
        exact: |limit| tail(limit + 0.25),
    };
    let found = steps.found(&steps.model(), 3.0, 1).unwrap();
    assert_eq!((found.reliability, found.source), (None, Source::SubsetSimulation));
    near(found.probability, tail(3.25), 4.0 * found.error / found.probability);
}

#[test]
fn what_nearly_always_fails_is_not_nothing() {
    let sum = Case { name: "sum", variables: 2, measure: |z| z[0] + z[1], above: true, exact: |x| tail(x / 1.414) };
    let model = sum.model();
    for (limit, probability) in [(-3.0, tail(-3.0 / libm::sqrt(2.0))), (-20.0, 1.0), (-200.0, 1.0), (-1e6, 1.0)] {
        let found = sum.found(&model, limit, 1).unwrap();
        near(found.probability, probability, 1e-6);
        assert!(found.error < 1e-6 && found.reliability.unwrap() < 0.0);
    }
    let found = sum.found(&model, 200.0, 1).unwrap();
    assert!(found.probability > 0.0 && found.probability < 1e-300);
}

#[test]
fn a_figure_that_contradicts_the_count_is_withheld() {
    let model = RADIUS.model();
    let draw = Draw::new(&model, 1).unwrap();
    let failure = Failure { measures: vec![0], limit: 4.0, above: true };
    let counted = |hits, units| probability(&model, &draw, &failure, 1, Some((hits, units)));
    // 335 ppm.
    assert!(counted(335, 1_000_000).is_some() && counted(0, 5000).is_some() && counted(4, 5000).is_some());
    assert!(counted(100, 1_000_000).is_none() && counted(30, 5000).is_none());
}

#[test]
fn the_figure_depends_on_the_seed_alone() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| SUM_OF_ZONES.found(&SUM_OF_ZONES.model(), 8.0, 3).unwrap())
    };
    assert_eq!(on(1), on(2));
    assert!(SUM_OF_ZONES.found(&SUM_OF_ZONES.model(), 8.0, 4).unwrap() != on(1));
}
