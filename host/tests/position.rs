//! Tables over position, and over position and commanded speed, against the runs they are made from and closed forms.

use std::sync::LazyLock;

use slipfit::{
    dynamics::{
        outcome::Verdict,
        simulate::{Settings, simulate},
    },
    firmware::force_table::{
        Demand, TableError,
        position::{self, PositionError, PositionTable, SAMPLE, Wish},
    },
    scene::{Override, shipped},
    setup::{LevelRange, RunSpec, Scene},
};
use slipfit_core::{
    drive::Drive,
    slide::CONTACTS,
    table::{AxisKind, Table},
};

/// The fast slide's stroke at `levels`.
fn scene(levels: &str, settings: &[&str]) -> Scene {
    let mut overrides: Vec<_> = ["run.duration=700"].map(Override::set).into();
    overrides.extend(settings.iter().map(|setting| Override::set(setting)));
    overrides.push(Override::option("", "sweep.n", levels));
    Scene::parse("cd-rom-slide-fast.toml", shipped("cd-rom-slide-fast").unwrap(), &overrides).unwrap()
}

/// Runs as tables over position are made from, past the stroke's end.
fn at_every_step(scene: &Scene) -> Settings {
    let run = RunSpec { stroke: None, ..scene.run };
    Settings { run, ..Settings::desk(scene, 50e-6) }
}

const WISH: Wish<'_> = Wish { speeds: None, stroke: None, demand: Demand::Full };

/// 60, 80 and 100 mm/s.
const SPEEDS: LevelRange = LevelRange { first: 0.06, step: 0.02, count: 3 };

fn made(scene: &Scene, wish: &Wish<'_>) -> PositionTable {
    position::make(scene, wish, || ()).unwrap()
}

/// Force and velocity of the unit `n` commanded to `speed` (m/s) where it first comes to `z` (m).
fn passing(scene: &Scene, n: f64, speed: f64, places: &[f64]) -> Vec<[f64; 2]> {
    let scene = Scene { drive: Drive { speed, ..scene.drive }, ..scene.clone() };
    let settings = at_every_step(&scene);
    let run = simulate(&scene, &scene.gaps_at(&[n; CONTACTS]), &settings).unwrap().trajectory;
    let found = places.iter().map(|place| {
        let i = run.z.iter().position(|z| z >= place).unwrap();
        let part = (place - run.z[i - 1]) / (run.z[i] - run.z[i - 1]);
        [&run.force, &run.vz].map(|values| values[i - 1] * (1.0 - part) + values[i] * part)
    });
    found.collect()
}

static OVER_POSITION: LazyLock<(Scene, PositionTable)> = LazyLock::new(|| {
    let scene = scene("1:2:0.5", &[]);
    let made = made(&scene, &Wish { stroke: Some(0.02), ..WISH });
    (scene, made)
});

static OVER_SPEED: LazyLock<(Scene, PositionTable)> = LazyLock::new(|| {
    let scene = scene("1:2:0.5", &[]);
    let made = made(&scene, &Wish { speeds: Some(&SPEEDS), stroke: Some(0.02), ..WISH });
    (scene, made)
});

#[test]
fn nodes_are_what_a_run_does_where_it_passes() {
    let (scene, made) = &*OVER_POSITION;
    let kinds = [AxisKind::Level, AxisKind::Position];
    let table = Table::<2>::open(&made.table.bytes).unwrap().expect_axes(kinds).unwrap();
    let [levels, positions] = table.axes();
    assert_eq!((levels.count(), positions.count(), positions.step()), (3, 81, position::STEP as f32));
    let nodes: Vec<f64> = (1..81).map(|k| f64::from(k) * position::STEP).collect();
    for n in [1.0, 2.0] {
        for (z, [force, velocity]) in nodes.iter().zip(passing(scene, n, scene.drive.speed, &nodes)) {
            let found = table.lookup([n as f32, *z as f32]);
            assert!((f64::from(found.force) - force).abs() < 2e-5, "{n} {z} {found:?} {force}");
            assert!((f64::from(found.velocity) - velocity).abs() < 1e-6, "{n} {z} {found:?} {velocity}");
        }
    }
    // Between nodes, within the error that the table was measured to have.
    let [worst_force, worst_velocity] = made.table.worst_error;
    let between: Vec<f64> = (1..320).map(|k| f64::from(k) * SAMPLE).collect();
    let mut greatest = 0.0f64;
    for n in [1.25, 2.0] {
        for (z, [force, velocity]) in between.iter().zip(passing(scene, n, scene.drive.speed, &between)) {
            let found = table.lookup([n as f32, *z as f32]);
            let error = (f64::from(found.force) - force).abs();
            assert!(error <= worst_force + 1e-9, "{n} {z} {found:?} {force}");
            assert!(
                (f64::from(found.velocity) - velocity).abs() <= worst_velocity + 1e-9,
                "{n} {z} {found:?} {velocity}"
            );
            greatest = greatest.max(error);
        }
    }
    assert!(greatest > 1e-4, "nothing was interpolated");
    assert_eq!(table.channels().map(|channel| channel.worst_error), [worst_force as f32, worst_velocity as f32]);
}

#[test]
fn the_node_at_the_start_holds_the_breakaway() {
    let (scene, made) = &*OVER_POSITION;
    let table = Table::<2>::open(&made.table.bytes).unwrap();
    let settings = at_every_step(scene);
    let run = simulate(scene, &scene.gaps_at(&[2.0; CONTACTS]), &settings).unwrap().trajectory;
    let leaving = run.z.iter().take_while(|z| **z < SAMPLE).count();
    let greatest = run.force[..leaving].iter().copied().fold(0.0, f64::max);
    let found = table.lookup([2.0, 0.0]);
    assert!(
        f64::from(found.force) >= greatest * (1.0 - 1e-7)
            && found.force < run.force[leaving].max(greatest) as f32 + 1e-6
    );
    assert_eq!(found.velocity, 0.0);
    // Friction has to be overcome before anything moves.
    assert!(found.force > 0.3 * 0.0818 * 9.81, "{found:?}");
}

#[test]
fn over_speed_too_nodes_are_what_a_run_does() {
    let (scene, made) = &*OVER_SPEED;
    let kinds = [AxisKind::Level, AxisKind::Position, AxisKind::Velocity];
    let table = Table::<3>::open(&made.table.bytes).unwrap().expect_axes(kinds).unwrap();
    assert_eq!(table.axes().map(|axis| axis.count()), [3, 81, 3]);
    let places: Vec<f64> = [1, 4, 40, 75].map(|k| f64::from(k) * position::STEP).into();
    for (n, speed) in [(1.0, 0.06), (1.5, 0.08), (2.0, 0.1)] {
        for (z, [force, velocity]) in places.iter().zip(passing(scene, n, speed, &places)) {
            let found = table.lookup([n as f32, *z as f32, speed as f32]);
            assert!((f64::from(found.force) - force).abs() < 2e-5, "{n} {z} {speed} {found:?} {force}");
            assert!((f64::from(found.velocity) - velocity).abs() < 1e-6, "{n} {z} {speed} {found:?} {velocity}");
        }
    }
    let [worst_force, worst_velocity] = made.table.worst_error;
    let (n, speed) = (1.25, 0.07);
    for (z, [force, velocity]) in places.iter().zip(passing(scene, n, speed, &places)) {
        let found = table.lookup([n as f32, *z as f32, speed as f32]);
        assert!((f64::from(found.force) - force).abs() <= worst_force + 1e-9, "{z} {found:?} {force}");
        assert!((f64::from(found.velocity) - velocity).abs() <= worst_velocity + 1e-9, "{z} {found:?} {velocity}");
    }
}

/// Where no gap across is compressed, the rails carry the weight alone: at a steady speed the drive overcomes μ·m·g, and the
/// slide lags behind the command by that over the gain. The rails' normals tilt with the slide, here by less than 0.6 mrad,
/// which is 0.2 % of μ. Without friction it takes no force at all.
#[test]
fn steady_sliding_takes_the_friction_of_the_weight() {
    let scene = self::scene("-1:-0.5:0.5", &["run.duration=300"]);
    let made = self::made(&scene, &Wish { speeds: Some(&SPEEDS), stroke: Some(0.01), ..WISH });
    let table = Table::<3>::open(&made.table.bytes).unwrap();
    let friction = 0.3 * scene.slide.mass * 9.81;
    for n in [-1.0f32, -0.75, -0.5] {
        for speed in [0.06f32, 0.07, 0.08, 0.1] {
            // The ramp is over and its lag has died away.
            let found = table.lookup([n, 0.005, speed]);
            assert!((f64::from(found.force) / friction - 1.0).abs() < 2e-3, "{n} {speed} {found:?} {friction}");
            let lag = friction / scene.drive.gain;
            assert!((f64::from(speed - found.velocity) / lag - 1.0).abs() < 2e-3, "{n} {speed} {found:?} {lag}");
        }
    }
    let free = self::scene("1:2:1", &["friction.law=none"]);
    let made = self::made(&free, &Wish { stroke: Some(0.01), ..WISH });
    let found = Table::<2>::open(&made.table.bytes).unwrap().lookup([1.5, 0.0095]);
    assert!(found.force.abs() < 2e-3 * friction as f32 && (found.velocity - 0.1).abs() < 2e-5, "{found:?}");
}

#[test]
fn beyond_a_jam_the_last_force_stands_and_the_table_says_so() {
    let scene = scene("-1:1:1", &[]);
    let made = made(&scene, &WISH);
    let table = Table::<2>::open(&made.table.bytes).unwrap();
    let [_, positions] = table.axes();
    let jammed: Vec<f64> = made.short.iter().map(|reach| reach.n).collect();
    assert_eq!(jammed, [-1.0, 0.0], "{:?}", made.short);
    for reach in &made.short {
        assert_eq!(reach.verdict, Verdict::Jammed);
        assert!(reach.z > 0.02 && reach.z < f64::from(positions.last()));
        // Blocked, the drive gives its gain times the command, but for what the slide creeps.
        let blocked = scene.drive.gain * scene.drive.speed;
        for z in [reach.z as f32 + positions.step(), positions.last()] {
            let found = table.lookup([reach.n as f32, z]);
            assert!(found.velocity == 0.0 && (f64::from(found.force) / blocked - 1.0).abs() < 1e-2, "{found:?}");
        }
        // Short of it the slide was on its way.
        let found = table.lookup([reach.n as f32, 0.01]);
        assert!(found.velocity > 0.05 && found.force < 0.5, "{found:?}");
    }
}

#[test]
fn a_table_is_made_as_small_as_its_error_allows() {
    let scene = scene("1:2:0.25", &[]);
    let wish = Wish { stroke: Some(0.02), ..WISH };
    let full = made(&scene, &wish);
    let error = full.table.worst_error_in_use[0];
    let small = made(&scene, &Wish { demand: Demand::MaxError(4.0 * error), ..wish });
    assert!(small.table.worst_error_in_use[0] <= 4.0 * error);
    assert!(small.table.bytes.len() < full.table.bytes.len());
    let end = |made: &PositionTable| {
        let axis = made.table.axes[1];
        f64::from(axis.step) * (axis.count - 1) as f64
    };
    assert!((end(&small) - 0.02).abs() < 1e-8 && (end(&full) - 0.02).abs() < 1e-8);
    let none = Wish { demand: Demand::MaxError(1e-9), ..wish };
    let refused = position::make(&scene, &none, || ()).unwrap_err();
    assert!(matches!(refused, TableError::MaxError { .. }), "{refused}");
}

#[test]
fn runs_that_come_nowhere_are_refused() {
    let refused = |scene: &Scene, wish: &Wish<'_>| match position::make(scene, wish, || ()) {
        Err(TableError::Position(error)) => error,
        other => panic!("{other:?}"),
    };
    let short = refused(&scene("1:2:1", &["run.duration=100"]), &WISH);
    assert_eq!(short, PositionError::Ramp { duration: 0.1, ramp_end: 0.1 });
    let slow = refused(&scene("1:2:1", &["drive.speed=1", "run.duration=110"]), &WISH);
    let PositionError::TooFar { asked, farthest, duration, .. } = slow else { panic!("{slow}") };
    assert!(asked == position::STEP && farthest.z < 1e-4 && duration == 0.11, "{slow}");
    let far = refused(&scene("1:2:1", &["run.duration=200"]), &Wish { stroke: Some(0.1), ..WISH });
    assert!(far.to_string().starts_with("no unit comes 100 mm far: in 200 ms the farthest, at n = "), "{far}");
    let turning = LevelRange { first: -0.1, ..SPEEDS };
    let turning = Wish { speeds: Some(&LevelRange { count: 11, ..turning }), ..WISH };
    assert!(matches!(refused(&scene("1:2:1", &[]), &turning), PositionError::Direction { .. }));
}
