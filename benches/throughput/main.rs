//! Units per second and core with all statistics, beside numpy drawing the same normals and measures.
//!
//! `cargo bench --bench throughput`. Both run on one thread and in turns, because the pace of a machine changes from one moment
//! to the next; a ratio is the median over the rounds. numpy's side is `numpy_peer.py`. Fails below a ratio, and without
//! numpy.

use std::{
    io::{BufRead, BufReader, Write},
    process::{Child, ChildStdin, ChildStdout, Command, ExitCode, Stdio},
    time::Instant,
};

use slipfit::{
    scene::{SceneFile, shipped},
    tolerance::{
        counting::study::{Settings, Study},
        model::{Contributor, Distribution, Measure, Model, Quantity, Variation, linear::Linear},
        sampling::sampler::Method,
    },
};

const NORMALS: usize = 47;
const MEASURES: usize = 18;
const ROUNDS: usize = 11;
const SAMPLES: u64 = 1 << 18;

/// A model, and the least ratio to numpy that it has to reach, statistics included, where numpy makes none.
struct Row {
    name: &'static str,
    model: Model,
    least: f64,
}

/// Of measure `i` by normal `k`.
fn coefficient(i: usize, k: usize) -> f64 {
    ((i * 7 + k * 13) % 11) as f64 / 5.0 - 1.0
}

/// 47 normals, 18 measures, as a matrix.
fn linear() -> Model {
    let normal =
        Variation::Scalar { distribution: Distribution::Normal { mean: 0.0, deviation: 1e-4 }, limits: [-3e-4, 3e-4] };
    let rows: Vec<Vec<f64>> = (0..MEASURES).map(|i| (0..NORMALS).map(|k| coefficient(i, k)).collect()).collect();
    let measure = |i| Measure { name: format!("m{i}"), quantity: Quantity::Length, limits: [Some(-1e-2), Some(1e-2)] };
    Model {
        contributors: (0..NORMALS).map(|i| Contributor { name: format!("c{i}"), variation: normal.clone() }).collect(),
        correlations: Vec::new(),
        measures: (0..MEASURES).map(measure).collect(),
        sums: Vec::new(),
        function: std::sync::Arc::new(Linear::new(&[0.0; MEASURES], &rows)),
    }
}

/// The same as the text of a scene.
fn dense() -> Model {
    let dimension = |k: usize| format!("[[dimension]]\nname = \"c{k}\"\nvalue = 0\ntolerance = 0.3\n");
    let measure = |i: usize| {
        let terms: Vec<_> = (0..NORMALS).map(|k| format!("{} * c{k}", coefficient(i, k))).collect();
        format!("[[measure]]\nname = \"m{i}\"\nis = \"{}\"\nlower = -10\nupper = 10\n", terms.join(" + "))
    };
    parsed("dense", &(0..NORMALS).map(dimension).chain((0..MEASURES).map(measure)).collect::<String>())
}

/// The slide from its drawing: 29 planes of three variables and 18 points through all displacements, 18 measures, 8 sums.
fn drawing() -> Model {
    parsed("cd-rom-slide-drawing", shipped("cd-rom-slide-drawing").expect("it is shipped"))
}

fn parsed(name: &str, text: &str) -> Model {
    let file = SceneFile::parse(name, text, &[]).unwrap_or_else(|error| panic!("{error}"));
    file.product.expect("it has measures").model
}

/// Units per second of one round on this thread.
fn rate(model: &Model, method: Method) -> f64 {
    let settings = Settings { method, samples: SAMPLES, replicates: 1, seed: 1 };
    let study = Study::new(model, settings).expect("the models are sound");
    let mut tallies = study.empty();
    let start = Instant::now();
    study.add(0..settings.blocks(), &mut tallies, |_| ());
    let taken = start.elapsed();
    std::hint::black_box(tallies);
    settings.samples as f64 / taken.as_secs_f64()
}

/// A process with numpy that waits for rounds.
struct Numpy {
    process: Child,
    ask: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Numpy {
    /// `None` without numpy.
    fn start() -> Option<Self> {
        let mut command = Command::new("python3");
        for threads in ["OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"] {
            command.env(threads, "1");
        }
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/throughput/numpy_peer.py");
        let mut process = command.arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().ok()?;
        let (ask, answers) = (process.stdin.take()?, BufReader::new(process.stdout.take()?));
        let mut numpy = Self { process, ask, answers };
        // The first round is slower than others.
        numpy.rate("draw").is_some().then_some(numpy)
    }

    /// Units per second of a round.
    fn rate(&mut self, round: &str) -> Option<f64> {
        writeln!(self.ask, "{round}").ok()?;
        let mut line = String::new();
        self.answers.read_line(&mut line).ok()?;
        line.trim().parse().ok()
    }

    /// Lets the process end.
    fn stop(self) {
        let Self { mut process, ask, .. } = self;
        drop(ask);
        process.wait().ok();
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn main() -> ExitCode {
    let rows = [
        Row { name: "47 normals, 18 linear measures", model: linear(), least: 1.3 },
        Row { name: "the same from a scene's text", model: dense(), least: 1.5 },
        Row { name: "the slide's full chain", model: drawing(), least: 0.52 },
    ];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    println!("million units per second on one core, statistics included");
    for (row, method) in rows.iter().flat_map(|row| {
        [Method::PseudoRandom, Method::LatinHypercube, Method::ScrambledSobol].map(|method| (row, method))
    }) {
        let rates = (0..3).map(|_| pool.install(|| rate(&row.model, method))).collect();
        println!("{:32} {method:?}: {:.3}", row.name, median(rates) / 1e6);
    }
    let Some(mut numpy) = Numpy::start() else {
        eprintln!("nothing to compare with: pip install numpy");
        return ExitCode::FAILURE;
    };
    let mut ratios = [const { Vec::new() }; 3];
    let mut rates = Vec::new();
    for _ in 0..ROUNDS {
        for (row, ratios) in rows.iter().zip(&mut ratios) {
            let Some(theirs) = numpy.rate("draw") else { continue };
            rates.push(theirs);
            ratios.push(pool.install(|| rate(&row.model, Method::PseudoRandom)) / theirs);
        }
    }
    let statistics = numpy.rate("analyse").unwrap_or(f64::NAN);
    numpy.stop();
    println!(
        "numpy, the same normals and linear measures: {:.3}, with statistics {:.3}",
        median(rates) / 1e6,
        statistics / 1e6
    );
    let mut fast = true;
    for (Row { name, least, .. }, ratios) in rows.into_iter().zip(ratios) {
        let ratio = median(ratios);
        println!("{name}: {ratio:.2} times as many units as numpy's without statistics, at least {least}");
        fast &= ratio >= least;
    }
    if fast { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
