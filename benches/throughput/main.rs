//! Units per second and core with all statistics, beside numpy drawing the same normals and measures.
//!
//! `cargo bench --bench throughput`. Both run on one thread, one after the other; numpy's side is `numpy_peer.py`.

use std::{
    process::Command,
    time::{Duration, Instant},
};

use slipfit::tolerance::{
    lanes::Lanes,
    linear::Linear,
    model::{Contributor, Distribution, Function, Measure, Model, Quantity, Variation, ZoneRule},
    sampler::Method,
    study::{Settings, Study},
};

const MEASURES: usize = 18;

/// A chain that costs what three small turns and shifts a plane do: 35 rotations of a point, about 100 ns a unit.
struct Chain;

impl Function for Chain {
    fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
        let mut point = [Lanes::splat(0.062), Lanes::splat(0.006), Lanes::splat(0.018)];
        for (number, plane) in variables.chunks_exact(3).enumerate() {
            let [w, a, b] = [plane[0] * 1e-4, plane[1] * 1e-3, plane[2] * 1e-3];
            let [x, y, z] = point;
            point = [x + b * z, y + w - a * z + b * x, z + a * y];
            if number >= 17 {
                measures[number - 17] = point[number % 3] + w;
            }
        }
    }
}

fn model(contributors: Vec<Variation>, function: Box<dyn Function>) -> Model {
    let named = |(i, variation)| Contributor { name: format!("c{i}"), variation };
    let measure = |i| Measure { name: format!("m{i}"), quantity: Quantity::Length, limits: [Some(-1e-2), Some(1e-2)] };
    Model {
        contributors: contributors.into_iter().enumerate().map(named).collect(),
        correlations: Vec::new(),
        measures: (0..MEASURES).map(measure).collect(),
        sums: Vec::new(),
        function,
    }
}

/// 47 normals, 18 measures.
fn linear() -> Model {
    let normal =
        Variation::Scalar { distribution: Distribution::Normal { mean: 0.0, deviation: 1e-4 }, limits: [-3e-4, 3e-4] };
    let row = |i: usize| (0..47).map(|k| f64::from((i * 7 + k * 13) as u32 % 11) / 5.0 - 1.0).collect();
    let function = Linear { constants: vec![0.0; MEASURES], coefficients: (0..MEASURES).map(row).collect() };
    model(vec![normal; 47], Box::new(function))
}

/// 35 planes with three variables each.
fn chain() -> Model {
    model(vec![Variation::Zone(ZoneRule::SigmaZone); 35], Box::new(Chain))
}

/// Units per second on one thread: the best of several runs.
fn rate(model: &Model, method: Method) -> f64 {
    let settings = Settings { method, samples: 1 << 18, replicates: 1, seed: 1 };
    let study = Study::new(model, settings).expect("the models are sound");
    let mut best = Duration::MAX;
    for _ in 0..7 {
        let mut tallies = study.empty();
        let start = Instant::now();
        study.add(0..settings.blocks(), &mut tallies, |_| ());
        best = best.min(start.elapsed());
        std::hint::black_box(tallies);
    }
    settings.samples as f64 / best.as_secs_f64()
}

/// Of numpy: normals and measures alone, and with statistics.
fn numpy() -> Option<[f64; 2]> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/throughput/numpy_peer.py");
    let mut command = Command::new("python3");
    for threads in ["OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"] {
        command.env(threads, "1");
    }
    let output = command.arg(script).output().ok().filter(|output| output.status.success())?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let mut rates = text.lines().map(str::parse);
    Some([rates.next()?.ok()?, rates.next()?.ok()?])
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    pool.install(|| {
        let (linear, chain) = (linear(), chain());
        let reference = rate(&linear, Method::PseudoRandom);
        println!("million units per second on one core, statistics included");
        for (name, model) in [("47 normals, 18 linear measures", &linear), ("105 variables, chain", &chain)] {
            for method in [Method::PseudoRandom, Method::LatinHypercube, Method::ScrambledSobol] {
                println!("{name:32} {method:?}: {:.3}", rate(model, method) / 1e6);
            }
        }
        match numpy() {
            Some(rates) => {
                for (what, peer) in ["normals and measures only", "with statistics"].into_iter().zip(rates) {
                    println!("numpy, {what}: {:.3}; here {:.2} times as many", peer / 1e6, reference / peer);
                }
            }
            None => println!("numpy is not installed: pip install numpy to compare with it"),
        }
    });
}
