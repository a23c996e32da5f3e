//! A run that is killed goes on where it stopped and ends with the same bytes. The program runs itself as the victim.

use std::{
    path::{Path, PathBuf},
    process::Command,
    time::{Duration, Instant},
};

use slipfit::tolerance::{
    counting::{
        file::{Part, Source},
        run::{self, Keep, RunError, Shard, checkpoint, run},
        study::{Settings, Study},
    },
    model::{Contributor, Distribution, Function, Measure, Model, Quantity, Variation},
    numeric::lanes::Lanes,
    sampling::sampler::Method,
};

const SETTINGS: Settings = Settings { method: Method::ScrambledSobol, samples: 4 * 300_000, replicates: 4, seed: 3 };

/// A product and a quotient, slowly.
struct Bent(Duration);

impl Function for Bent {
    fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
        measures[0] = variables[0] * variables[1];
        measures[1] = variables[2] / variables[0];
        if !self.0.is_zero() {
            std::thread::sleep(self.0);
        }
    }
}

fn model(pause: Duration) -> Model {
    let normal = |name: &str| Contributor {
        name: name.into(),
        variation: Variation::Scalar {
            distribution: Distribution::Normal { mean: 10.0, deviation: 0.1 },
            limits: [9.7, 10.3],
        },
    };
    let measure = |name: &str| Measure { name: name.into(), quantity: Quantity::Ratio, limits: [None, Some(103.0)] };
    Model {
        contributors: ["a", "b", "c"].map(normal).into(),
        correlations: vec![(0, 2, 0.5)],
        measures: ["product", "quotient"].map(measure).into(),
        sums: Vec::new(),
        function: std::sync::Arc::new(Bent(pause)),
    }
}

/// The shards of a tolerance analysis.
fn merge(paths: &[PathBuf]) -> Result<Part, RunError> {
    run::merge(paths)
}

fn work(out: &Path, pause: Duration, shard: Shard, resume: bool, seed: u64) -> Result<(), RunError> {
    let model = model(pause);
    let study = Study::new(&model, Settings { seed, ..SETTINGS })?;
    let source = Source { name: "bent".into(), text: "a scene".into(), set: Vec::new(), measured: None };
    run(&study, &source, shard, Some(&Keep { out, resume }), |_| ()).map(drop)
}

fn main() {
    if let [_, victim, out] = &std::env::args().collect::<Vec<_>>()[..]
        && victim == "--victim"
    {
        work(Path::new(out), Duration::from_micros(20), Shard::ALL, false, 3).unwrap();
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let bytes = |name: &str| std::fs::read(at(name)).unwrap();
    work(&at("whole"), Duration::ZERO, Shard::ALL, false, 3).unwrap();

    let mut victim = Command::new(std::env::current_exe().unwrap()).arg("--victim").arg(at("killed")).spawn().unwrap();
    let start = Instant::now();
    while !checkpoint(&at("killed")).exists() {
        assert!(start.elapsed() < Duration::from_secs(60) && victim.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(5));
    }
    // On Unix this is signal 9.
    victim.kill().unwrap();
    victim.wait().unwrap();
    assert!(!at("killed").exists());

    // Neither another seed nor another shard goes on from there.
    let different = |result| matches!(result, Err(RunError::Different { .. }));
    assert!(different(work(&at("killed"), Duration::ZERO, Shard::ALL, true, 4)));
    assert!(different(work(&at("killed"), Duration::ZERO, Shard { number: 1, count: 2 }, true, 3)));
    assert!(matches!(merge(&[checkpoint(&at("killed"))]), Err(RunError::Unfinished { .. })));
    work(&at("killed"), Duration::ZERO, Shard::ALL, true, 3).unwrap();
    assert!(bytes("killed") == bytes("whole"));
    assert!(!checkpoint(&at("killed")).exists());

    for number in [1, 2, 3] {
        work(&at(&format!("shard{number}")), Duration::ZERO, Shard { number, count: 3 }, false, 3).unwrap();
    }
    let shards = |numbers: &[u64]| numbers.iter().map(|number| at(&format!("shard{number}"))).collect::<Vec<_>>();
    for order in [[1, 2, 3], [3, 1, 2], [2, 3, 1]] {
        assert!(merge(&shards(&order)).unwrap().encode().unwrap() == bytes("whole"), "{order:?}");
    }
    let refused = |numbers: &[u64]| merge(&shards(numbers)).unwrap_err().to_string();
    assert_eq!(refused(&[1, 3]), "of 3 shards these are missing: 2");
    assert!(refused(&[1, 2, 2]).starts_with("shard 2 is there twice"));
    work(&at("shard4"), Duration::ZERO, Shard { number: 3, count: 3 }, false, 9).unwrap();
    assert!(refused(&[1, 2, 4]).contains("is of another seed than"));
    let whole = bytes("shard2");
    for (damaged, why) in [
        (&whole[..whole.len() / 2], "it is truncated or corrupted"),
        (&whole[..3], "it is truncated or corrupted"),
        (&b"something else"[..], "it is not a study file of the same command and kind of scene"),
    ] {
        std::fs::write(at("shard2"), damaged).unwrap();
        assert!(refused(&[1, 2, 3]).ends_with(why));
    }
    for byte in (0..whole.len()).step_by(997) {
        let mut flipped = whole.clone();
        flipped[byte] ^= 1 << (byte % 8);
        std::fs::write(at("shard2"), flipped).unwrap();
        assert!(merge(&shards(&[1, 2, 3])).is_err(), "byte {byte}");
    }
    println!("killed, resumed, split and damaged: ok");
}
