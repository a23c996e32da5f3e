//! How often the stated intervals hold what they should.

use super::{
    counting::{
        pairs::Pairs,
        study::{Settings, Study},
    },
    distribution::Marginal,
    examples::{linear, scalar},
    model::Distribution,
    sampling::sampler::Method,
    statistics::estimate::{Estimate, POINTS, Spread, joint},
    theory::moments,
};
use crate::numeric::normal::quantile;

/// Four times 300, whose own scatter is already 1.3 %.
const SEEDS: u64 = 1200;
/// 93 and 97 % of them.
const HELD: [u64; 2] = [1116, 1164];

struct Case {
    name: &'static str,
    distribution: Distribution,
    /// Skewness and kurtosis.
    shape: [f64; 2],
}

fn cases() -> Vec<Case> {
    // Two heaps with little between them.
    let heap = |from: f64| (0..20).map(move |k| from + 0.06 * f64::from(k));
    let table: Vec<f64> = heap(-1.6).chain(heap(0.46)).collect();
    let of_pieces = |power: i32| {
        let antiderivative = |x: f64| libm::pow(x, f64::from(power + 1)) / f64::from(power + 1);
        let piece = |ends: &[f64]| (antiderivative(ends[1]) - antiderivative(ends[0])) / (ends[1] - ends[0]);
        table.windows(2).map(piece).sum::<f64>() / (table.len() - 1) as f64
    };
    let bimodal = of_pieces(4) / (of_pieces(2) * of_pieces(2));
    // Of a log-normal with e^(s²) = w: (w + 2)·√(w − 1) is 2.
    let w: f64 = 1.0 + 0.596_071_637_983_321_5 * 0.596_071_637_983_321_5;
    let log_normal = w * w * w * w + 2.0 * w * w * w + 3.0 * w * w - 3.0;
    vec![
        Case { name: "normal", distribution: Distribution::Normal { mean: 1.0, deviation: 0.5 }, shape: [0.0, 3.0] },
        Case { name: "uniform", distribution: Distribution::Uniform { limits: [-1.0, 3.0] }, shape: [0.0, 1.8] },
        Case {
            name: "skewness 2",
            distribution: Distribution::Skewed { mean: 0.0, deviation: 1.0, skewness: 2.0 },
            shape: [2.0, log_normal],
        },
        Case { name: "bimodal", distribution: Distribution::Table(table), shape: [0.0, bimodal] },
    ]
}

/// Every kind of interval, 1200 productions of 5000 units each.
#[test]
fn intervals_hold_in_93_to_97_of_100_productions() {
    for Case { name, distribution, shape } in cases() {
        let marginal = Marginal::new(&distribution);
        let points = POINTS.map(|p| marginal.value(quantile(p)));
        let contributors = ["x", "y"].map(|name| scalar(name, distribution.clone(), [-1.0, 1.0]));
        let mut model = linear(contributors.into(), vec![vec![1.0, 0.0], vec![1.0, 0.7]]);
        let theory = moments::of_measures(&model);
        let (mean, deviation) = (theory[0].mean, theory[0].deviation);
        let limits = [mean - 4.5 * deviation, mean + 6.0 * deviation];
        model.measures[0].limits = limits.map(Some);
        let by_points = [
            (limits[1] - limits[0]) / (points[2] - points[0]),
            ((points[1] - limits[0]) / (points[1] - points[0])).min((limits[1] - points[1]) / (points[2] - points[1])),
        ];
        let spread = Spread { shapes: theory.iter().map(|moments| moments.shape).collect(), pairs: Pairs::new(&model) };
        assert_eq!(spread.shapes[0].is_normal(), name == "normal");
        let mut held: Vec<(&str, u64)> = Vec::new();
        for seed in 0..SEEDS {
            let settings = Settings { method: Method::PseudoRandom, samples: 5000, replicates: 1, seed };
            let study = Study::new(&model, settings).unwrap();
            let mut tallies = study.empty();
            study.add(0..settings.blocks(), &mut tallies, |_| ());
            let joint = joint(&model, settings.method, study.frames(), &tallies, &spread);
            let found = &joint.measures[0];
            let mut look = |what: &'static str, interval: [Option<f64>; 2], truth: f64| {
                let holds = interval[0].is_none_or(|low| low <= truth) && interval[1].is_none_or(|high| truth <= high);
                match held.iter_mut().find(|(known, _)| *known == what) {
                    Some((_, count)) => *count += u64::from(holds),
                    None => held.push((what, u64::from(holds))),
                }
            };
            let mut of = |what, estimate: Estimate, truth| look(what, estimate.interval, truth);
            of("mean", found.mean, mean);
            of("deviation", found.deviation, deviation);
            of("skewness", found.skewness.unwrap(), shape[0]);
            of("kurtosis", found.kurtosis.unwrap(), shape[1]);
            of("0.135 %", found.points[0], points[0]);
            of("median", found.points[1], points[1]);
            of("99.865 %", found.points[2], points[2]);
            of("Pp", found.pp.unwrap(), 10.5 / 6.0);
            of("Ppk", found.ppk.unwrap(), 1.5);
            if let Some([pp, ppk]) = found.by_points {
                of("Pp by points", pp.unwrap(), by_points[0]);
                of("Ppk by points", ppk.unwrap(), by_points[1]);
            }
            look("correlation", joint.correlation_intervals[0][1], 1.0 / libm::sqrt(1.49));
        }
        println!("{name}: {held:?}");
        for (what, count) in held {
            assert!(HELD[0] <= count && count <= HELD[1], "{name}: {what} {count} of {SEEDS}");
        }
    }
}
