//! The monitor on simulated strokes with noise, against tables that the host makes: what it says of n, and of jams.

use std::sync::LazyLock;

use libm::{cos, fabs, log, sqrt};
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;
use slipfit::{
    dynamics::{
        simulate::{Settings, simulate},
        trajectory::Trajectory,
    },
    firmware::{
        flash::{AxisSpec, ChannelSpec, TableSpec, encode},
        force_table::{self, Demand},
    },
    scene::{CD_ROM_SLIDE, Override},
    setup::Scene,
};
use slipfit_core::{
    monitor::{BankError, Estimate, LevelBank, Limits, Monitor, MonitorError, Report, Sample, Verdict, Watch},
    table::{AxisKind, Encoding, MotionVerdict, Table, TableError},
};

const SEEDS: u64 = 1000;

/// Samples are taken at this period (s), that of the tables' instants.
const PERIOD: f64 = 1e-3;

/// From here on a motion says something: the drive's ramp has started.
const START: f64 = 0.05;

/// The paper's slide, run for `duration` (ms), with a table over `levels`.
fn scene(duration: &str, levels: &str, settings: &[&str]) -> Scene {
    let mut overrides = vec![Override::option("", "run.duration", duration), Override::option("", "sweep.n", levels)];
    overrides.extend(settings.iter().map(|setting| Override::set(setting)));
    Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &overrides).unwrap()
}

/// The table of `scene` whose force errs by `error` (N) at most. A stroke has events of a few milliseconds that no table
/// of 256 KB resolves better than to a tenth of a newton.
fn table(scene: &Scene, error: f64) -> Vec<u8> {
    force_table::make(scene, Demand::MaxError(error), || ()).unwrap().0.bytes
}

fn run(scene: &Scene, n: f64) -> Trajectory {
    let settings = Settings::desk(scene, PERIOD);
    simulate(scene, &scene.gaps_at(&[n; 16]), &settings).unwrap().trajectory
}

/// The greatest force after the ramp's start (N).
fn peak(run: &Trajectory) -> f64 {
    run.t.iter().zip(&run.force).filter(|(t, _)| **t >= START).fold(0.0, |peak, (_, force)| force.abs().max(peak))
}

/// Standard normal numbers.
struct Noise(Xoshiro256PlusPlus);

impl Noise {
    fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    fn draw(&mut self) -> f64 {
        let mut uniform = || (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        // Box and Muller; 1 − u is never 0.
        sqrt(-2.0 * log(1.0 - uniform())) * cos(std::f64::consts::TAU * uniform())
    }
}

static STROKE: LazyLock<Scene> = LazyLock::new(|| scene("1500", "0.8:3.4:0.1", &[]));
static STROKE_TABLE: LazyLock<Vec<u8>> = LazyLock::new(|| table(&STROKE, 0.1));

/// Strokes from n = 1 to 3, on and between the table's levels.
static STROKES: LazyLock<Vec<(f64, Trajectory)>> = LazyLock::new(|| {
    let levels = (0..41).map(|i| 1.0 + 0.05 * f64::from(i));
    levels.map(|n| (n, run(&STROKE, n))).collect()
});

/// What a bank says of n after `run` with noise of the deviation `noise` (N).
fn estimated(table: &[u8], run: &Trajectory, noise: f64, seed: u64) -> Estimate {
    let table = Table::open(table).unwrap();
    let mut bank = LevelBank::<_, 96>::new(table).unwrap();
    let mut random = Noise::new(seed);
    for (&t, &force) in run.t.iter().zip(&run.force).filter(|(t, _)| **t >= START) {
        bank.add(t as f32, (force + noise * random.draw()) as f32);
    }
    bank.estimate().unwrap()
}

/// Root mean square of the error of n, and how many of the intervals hold it, over all seeds.
fn judged(table: &[u8], runs: &[(f64, Trajectory)], part: f64) -> (f64, u32, f64) {
    let all: Vec<_> = (0..SEEDS)
        .into_par_iter()
        .map(|seed| {
            let (n, run) = &runs[seed as usize % runs.len()];
            let estimate = estimated(table, run, part * peak(run), seed);
            let [low, high] = estimate.interval.map(f64::from);
            (f64::from(estimate.level) - n, low <= *n && *n <= high, high - low)
        })
        .collect();
    let count = all.len() as f64;
    let rms = sqrt(all.iter().map(|(error, ..)| error * error).sum::<f64>() / count);
    let width = all.iter().map(|(.., width)| width).sum::<f64>() / count;
    (rms, all.iter().map(|(_, covered, _)| u32::from(*covered)).sum(), width)
}

#[test]
fn a_noisy_stroke_tells_the_level() {
    let (rms, covered, width) = judged(&STROKE_TABLE, &STROKES, 0.02);
    println!("rms error {rms:.4}, covered {covered} of {SEEDS}, width {width:.4}");
    assert!(rms <= 0.0135, "{rms}");
    assert!((950..=990).contains(&covered), "{covered}");
}

#[test]
fn without_noise_the_interval_covers_too() {
    let missed = STROKES.iter().filter(|(n, run)| {
        let Estimate { level, interval: [low, high], .. } = estimated(&STROKE_TABLE, run, 0.0, 0);
        assert!(fabs(f64::from(level) - n) < 0.03, "{n} {level}");
        !(f64::from(low)..=f64::from(high)).contains(n)
    });
    // What is left is the table's own error: one in twenty may miss.
    assert!(missed.count() <= 2);
}

#[test]
fn an_opening_tells_less_but_its_interval_covers() {
    let opening = scene("200", "-3:5:0.1", &[]);
    let bytes = force_table::make(&opening, Demand::Full, || ()).unwrap().0.bytes;
    let runs: Vec<_> = (-12..=18).map(|i| 0.25 * f64::from(i) + 0.03).map(|n| (n, run(&opening, n))).collect();
    for part in [0.0, 0.001, 0.02, 0.1] {
        let (rms, covered, width) = judged(&bytes, &runs, part);
        println!("noise {part}: rms error {rms:.3}, covered {covered} of {SEEDS}, width {width:.3}");
        assert!(covered >= 900, "{part} {covered}");
    }
}

/// Limits that any test below takes: breakaway is over by 0.2 s.
fn limits(noise: f64) -> Limits {
    Limits { blind: 0.2, force_most: 3.5, ..Limits::for_noise(PERIOD as f32, noise as f32) }
}

/// What the monitor says of every sample of `run`.
fn watched(
    bytes: &[u8],
    level: f64,
    limits: Limits,
    scene: &Scene,
    run: &Trajectory,
    noise: f64,
    seed: u64,
) -> Vec<Report> {
    let monitor = Monitor::new(Table::open(bytes).unwrap(), level as f32, limits).unwrap();
    let (mut watch, mut random) = (Watch::default(), Noise::new(seed));
    let samples = run.t.iter().zip(&run.force).zip(&run.vz);
    samples
        .map(|((&t, force), speed)| {
            let force = (force + noise * random.draw()) as f32;
            let command = scene.drive.command(t) as f32;
            monitor.step(&mut watch, &Sample { time: t as f32, force, speed: *speed as f32, command })
        })
        .collect()
}

#[test]
fn a_jam_is_reported_within_20_ms() {
    // A table of its own for each: at these levels the table holds the jam.
    let tables = ["-0.5:0.5:0.25", "4.5:5.5:0.25"].map(|levels| table(&scene("1500", levels, &[]), 4.0));
    for (n, bytes, about) in [(0.0, &tables[0], 0.907), (5.0, &tables[1], 0.259)] {
        let jammed = run(&STROKE, n);
        let command = |t| STROKE.drive.command(t);
        let standing = |i: &usize| jammed.vz[*i] < 0.1 * command(jammed.t[*i]);
        let falls = (0..jammed.t.len()).rev().take_while(standing).last().unwrap();
        assert!(fabs(jammed.t[falls] - about) < 0.0025, "{}", jammed.t[falls]);
        for seed in 0..100 {
            let noise = if seed == 0 { 0.0 } else { 0.1 * peak(&jammed) };
            let reports = watched(bytes, n, limits(noise), &STROKE, &jammed, noise, seed);
            let reported = reports.iter().position(|report| report.verdict == Verdict::Jam).unwrap();
            let late = jammed.t[reported] - jammed.t[falls];
            assert!((0.0..=0.020).contains(&late), "n = {n}: {late} s");
        }
    }
}

#[test]
fn no_jam_is_reported_where_there_is_none() {
    (0..SEEDS).into_par_iter().for_each(|seed| {
        let (n, run) = &STROKES[seed as usize % STROKES.len()];
        let noise = 0.1 * peak(run);
        let reports = watched(&STROKE_TABLE, *n, limits(noise), &STROKE, run, noise, seed);
        assert!(reports.iter().all(|report| report.verdict != Verdict::Jam), "n = {n}");
    });
}

#[test]
fn tight_is_what_leaves_the_band() {
    let noise = 0.02 * peak(&STROKES[20].1);
    let tight = |run: &Trajectory, level: f64, seed| {
        let reports = watched(&STROKE_TABLE, level, limits(noise), &STROKE, run, noise, seed);
        assert!(reports.iter().take(199).all(|report| report.verdict == Verdict::Blind));
        reports.iter().position(|report| report.verdict == Verdict::Tight)
    };
    // Free where the unit is what it is taken for.
    let alarms = (0..SEEDS).filter(|&seed| {
        let (n, run) = &STROKES[seed as usize % STROKES.len()];
        tight(run, *n, seed).is_some()
    });
    assert!(alarms.count() <= 10);
    // Tight where friction is up by a fifth.
    let rough = scene("1500", "0.8:3.4:0.1", &["friction.coefficient=0.36"]);
    let run_rough = run(&rough, 2.0);
    assert!((0..100).all(|seed| tight(&run_rough, 2.0, seed).is_some()));
}

#[test]
fn never_adapts_outside_its_band() {
    let mut monitor = Monitor::new(Table::open(&STROKE_TABLE).unwrap(), 2.0, limits(0.02)).unwrap();
    let estimate = |level, deviation| Estimate { level, deviation, interval: [0.0, 4.0], residual: 0.0 };
    for (level, deviation, adapts) in [
        (2.6, 0.1, false),
        (1.4, 0.1, false),
        (2.1, 0.6, false),
        (2.1, f32::INFINITY, false),
        (f32::NAN, 0.1, false),
        (2.4, 0.1, true),
    ] {
        assert_eq!(monitor.adapt(&estimate(level, deviation)), adapts);
        assert_eq!(monitor.level(), if adapts { level } else { 2.0 });
    }
    // Nor step by step: the band is about the level that the monitor was made for.
    let taken = (1..=10).filter(|step| monitor.adapt(&estimate(2.0 + 0.25 * f64::from(*step) as f32, 0.1)));
    assert_eq!((taken.count(), monitor.level()), (2, 2.5));
    // Nor off the table's axis, where all lookups clamp.
    let wide = Limits { band: 10.0, ..limits(0.02) };
    let mut monitor = Monitor::new(Table::open(&STROKE_TABLE).unwrap(), 2.0, wide).unwrap();
    assert!(
        !monitor.adapt(&estimate(0.7, 0.1))
            && !monitor.adapt(&estimate(3.6, 0.1))
            && monitor.adapt(&estimate(0.8, 0.1))
    );
}

#[test]
fn refuses_what_it_cannot_watch() {
    let table = Table::open(&STROKE_TABLE).unwrap();
    assert_eq!(LevelBank::<_, 8>::new(table).unwrap_err(), BankError::Levels { found: 14, most: 8 });
    let axes = [(AxisKind::Level, 0.0, 1.0), (AxisKind::Position, 0.0, 1e-3)];
    let axes = axes.map(|(kind, first, step)| AxisSpec { kind, first, step, count: 3 });
    let channel = ChannelSpec { values: vec![1.0; 9], worst_error: 0.0, rms_error: 0.0 };
    let over_position = TableSpec {
        scene_hash: 0,
        axes: axes.into(),
        encoding: Encoding::F32,
        force: channel.clone(),
        velocity: channel,
        verdicts: vec![MotionVerdict::Runs; 3],
        production: None,
    };
    let over_position = encode(&over_position).unwrap();
    let over_position = Table::open(&over_position).unwrap();
    let kind = TableError::Kind { axis: 1, found: AxisKind::Position, asked: AxisKind::Time };
    assert_eq!(LevelBank::<_, 8>::new(over_position).unwrap_err(), BankError::Table(kind));
    assert_eq!(Monitor::new(over_position, 1.0, limits(0.01)).unwrap_err(), MonitorError::Table(kind));
    for (level, limits) in [
        (f32::NAN, limits(0.01)),
        (5.0, limits(0.01)),
        (2.0, Limits { period: 0.0, ..limits(0.01) }),
        (2.0, Limits { margin: f32::INFINITY, ..limits(0.01) }),
    ] {
        assert!(Monitor::new(table, level, limits).is_err());
    }
    // Samples that say nothing change nothing.
    let mut bank = LevelBank::<_, 32>::new(table).unwrap();
    for bad in [f32::NAN, f32::INFINITY, f32::MAX, -f32::MAX] {
        bank.add(0.3, bad);
        bank.add(bad, 0.3);
    }
    assert_eq!(bank.estimate(), None);
    let monitor = Monitor::new(table, 2.0, limits(0.01)).unwrap();
    let mut watch = Watch::default();
    for bad in [f32::NAN, f32::INFINITY, -f32::INFINITY, f32::MAX, -0.0, 1e-45] {
        let sample = Sample { time: bad, force: bad, speed: bad, command: bad };
        let report = monitor.step(&mut watch, &sample);
        assert!(report.tightness.expected.is_finite() && report.tightness.band.is_finite());
    }
}
