//! Units per second and core with all statistics, beside numpy drawing the same normals and measures.
//!
//! `cargo bench --bench throughput`. Both run on one thread, one after the other; numpy's side is `numpy_peer.py`. Fails
//! below a ratio to numpy, which depends on the machine less than a rate does.

use std::{
    process::{Command, ExitCode},
    time::{Duration, Instant},
};

use slipfit::{
    scene::{SceneFile, shipped},
    tolerance::{
        linear::Linear,
        model::{Contributor, Distribution, Measure, Model, Quantity, Variation},
        sampler::Method,
        study::{Settings, Study},
    },
};

const MEASURES: usize = 18;
/// What has to be reached on linear measures and on the full chain, statistics included, as a ratio to numpy without: 1.5 and
/// 0.6 million units per second where numpy makes 1.15.
const LEAST: [f64; 2] = [1.3, 0.52];

/// 47 normals, 18 measures.
fn linear() -> Model {
    let normal =
        Variation::Scalar { distribution: Distribution::Normal { mean: 0.0, deviation: 1e-4 }, limits: [-3e-4, 3e-4] };
    let row = |i: usize| (0..47).map(|k| f64::from((i * 7 + k * 13) as u32 % 11) / 5.0 - 1.0).collect();
    let measure = |i| Measure { name: format!("m{i}"), quantity: Quantity::Length, limits: [Some(-1e-2), Some(1e-2)] };
    Model {
        contributors: (0..47).map(|i| Contributor { name: format!("c{i}"), variation: normal.clone() }).collect(),
        correlations: Vec::new(),
        measures: (0..MEASURES).map(measure).collect(),
        sums: Vec::new(),
        function: Box::new(Linear { constants: vec![0.0; MEASURES], coefficients: (0..MEASURES).map(row).collect() }),
    }
}

/// The slide from its drawing: 29 planes of three variables and 18 points through all displacements, 18 measures, 8 sums.
fn drawing() -> Model {
    let text = shipped("cd-rom-slide-drawing").expect("it is shipped");
    let file = SceneFile::parse("cd-rom-slide-drawing", text, &[]).expect("it is sound");
    file.product.expect("it has parts").model
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

fn main() -> ExitCode {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    println!("million units per second on one core, statistics included");
    let rates = pool.install(|| {
        [("47 normals, 18 linear measures", linear()), ("the slide's full chain", drawing())].map(|(name, model)| {
            let rates = [Method::PseudoRandom, Method::LatinHypercube, Method::ScrambledSobol].map(|method| {
                let rate = rate(&model, method);
                println!("{name:32} {method:?}: {:.3}", rate / 1e6);
                rate
            });
            rates[0]
        })
    });
    let Some([normals, statistics]) = numpy() else {
        eprintln!("nothing to compare with: pip install numpy");
        return ExitCode::FAILURE;
    };
    println!(
        "numpy, the same normals and linear measures: {:.3}, with statistics {:.3}",
        normals / 1e6,
        statistics / 1e6
    );
    let mut fast = true;
    for ((what, rate), least) in ["linear measures", "full chain"].into_iter().zip(rates).zip(LEAST) {
        println!("{what}: {:.2} times as many units as numpy's without statistics, at least {least}", rate / normals);
        fast &= rate >= least * normals;
    }
    if fast { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
