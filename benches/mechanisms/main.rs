//! Mechanisms: the desk beside diffsol's BDF, and elements chosen at run time beside those composed by type.
//!
//! `cargo bench --features peers --bench mechanisms`. The desk's time is that of the integration with its records, and,
//! as the second ratio, of everything that `slipfit simulate` computes of all bodies and drives; diffsol gets the
//! composed type's own forces and a range of tolerances, of which the best counts. Both must meet the reference run
//! to [`WITHIN`] of the greatest effort. Ratios are medians of turns, because a shared machine changes its pace. Fails above
//! [`OF_BDF`] or [`OF_COMPOSED`].
//!
//! Then units of populations of mechanisms in a plane, on one thread: one by one, and as many at a time as registers hold. Fails where
//! that is not [`TOGETHER`] times as fast.

#[path = "../work_precision/diffsol_peer.rs"]
#[allow(dead_code)]
mod diffsol_peer;
#[path = "../work_precision/entry.rs"]
#[allow(dead_code)]
mod entry;

use std::{hint::black_box, process::ExitCode, time::Instant};

use diffsol_peer::{BDF, FirstOrder};
use entry::Tolerances;
use slipfit::{
    mechanism::{Mechanism, Mounts, ProductionUnit, planar, run, run_units, spatial},
    scene::{Override, SceneFile, shipped},
};
use slipfit_core::{
    SVector, integrator::Integrator, kernel::Kernel, mechanism::Mechanism as Mechanics, system::System,
};
use slipfit_problems::{
    first_order::{Numbers, rates_of},
    mechanisms::{linear_guide, slider_crank, telescopic_drawer},
};
use slipfit_tests::known_runs::mechanism_rows;

/// Error as a share of the greatest effort.
const WITHIN: f64 = 1e-3;
/// The most that the desk may take of diffsol's time.
const OF_BDF: f64 = 0.5;
/// The most that elements chosen at run time may take of the time of composed ones.
const OF_COMPOSED: f64 = 1.3;
const TURNS: usize = 15;
/// How many times as fast units have to run four and eight at a time, with all that is computed from their motions.
const TOGETHER: [f64; 2] = [1.7, 2.0];

fn main() -> ExitCode {
    println!("mechanism            desk, ms  of diffsol's BDF, with all columns   chosen elements of composed ones");
    let scene = |name: &str| {
        let set = [Override::set("run.stroke=1000")];
        let set = if name == "telescopic-drawer" { &set[..] } else { &[] };
        SceneFile::parse(name, shipped(name).expect("it is shipped"), set).expect("it is sound").mechanism.expect("one")
    };
    let mut fails = false;
    {
        let mechanism = scene("slider-crank");
        let mounts = Mounts::of(&mechanism).expect("a tree");
        let gaps = mechanism.gaps_at(&[0.0]).expect("in bounds");
        let tree = planar::bodies::<3>(&mechanism, &mounts).expect("in bounds");
        let elements = planar::elements::<3>(&mechanism, &mounts, &gaps, 1.0).expect("in bounds");
        let case = Case { file: "P1-slow", mechanism: &mechanism, driven: 0 };
        let composed = slider_crank::unit(0.0).expect("in bounds");
        let start = slider_crank::start();
        fails |= case.judge::<_, _, slider_crank::Scheme, 3>(composed, System::new(tree, &elements[..]), start);
    }
    {
        let mechanism = scene("linear-guide");
        let gaps = mechanism.gaps_at(&[0.0]).expect("in bounds");
        let bodies = spatial::bodies::<1, 6>(&mechanism).expect("in bounds");
        let elements = spatial::elements(&mechanism, &gaps, 1.0).expect("in bounds");
        let case = Case { file: "S1-runs", mechanism: &mechanism, driven: 2 };
        let composed = linear_guide::unit(0.0).expect("in bounds");
        let start = linear_guide::start();
        fails |= case.judge::<_, _, linear_guide::Scheme, 6>(composed, System::new(bodies, &elements[..]), start);
    }
    {
        let mechanism = scene("telescopic-drawer");
        let gaps = mechanism.gaps_at(&[0.0]).expect("in bounds");
        let bodies = spatial::bodies::<2, 12>(&mechanism).expect("in bounds");
        let elements = spatial::elements(&mechanism, &gaps, 1.0).expect("in bounds");
        let case = Case { file: "S2-first", mechanism: &mechanism, driven: 8 };
        let composed = telescopic_drawer::unit(0.0).expect("in bounds");
        let start = telescopic_drawer::start();
        fails |= case.judge::<_, _, telescopic_drawer::Scheme, 12>(composed, System::new(bodies, &elements[..]), start);
    }
    println!("units a second       one by one    four at a time    eight at a time");
    for name in ["slider-crank", "four-bar", "slider-crank-guide"] {
        let made = units(scene(name));
        let turns = (0..TURNS).map(|_| [1, 4, 8].map(|lanes| rate(&made, lanes)));
        let turns: Vec<[f64; 3]> = turns.collect();
        let rates = [0, 1, 2].map(|k| median(turns.iter().map(|rates| rates[k])));
        let ratios = [1, 2].map(|k| median(turns.iter().map(|rates| rates[k] / rates[0])));
        let text = |k: usize| format!("{:.0} ({:.2} times)", rates[k], ratios[k - 1]);
        println!("{name:20} {:>10.0} {:>18} {:>18}", rates[0], text(1), text(2));
        let widest = slipfit_desk::units::lane_count(usize::MAX).unwrap_or(1);
        fails |= (widest >= 4 && ratios[0] < TOGETHER[0]) || (widest >= 8 && ratios[1] < TOGETHER[1]);
    }
    ExitCode::from(u8::from(fails))
}

/// Some units of `mechanism`, at the tolerance of populations, whose gaps are at as many levels.
fn units(mut mechanism: Mechanism) -> Vec<ProductionUnit> {
    mechanism.run.error = 1e-4;
    let unit = |k: u32| {
        let levels: Vec<f64> =
            (0..mechanism.gaps.len()).map(|gap| f64::from(k * (gap as u32 + 3) % 41) * 0.1 - 2.0).collect();
        ProductionUnit { gaps: mechanism.gaps_at(&levels).expect("in bounds"), mechanism: mechanism.clone() }
    };
    (0..48).map(unit).collect()
}

/// Units a second on this thread.
fn rate(made: &[ProductionUnit], lanes: usize) -> f64 {
    let start = Instant::now();
    let found = black_box(run_units(made, lanes));
    assert!(found.iter().all(Result::is_ok), "every unit is solved");
    made.len() as f64 / start.elapsed().as_secs_f64()
}

/// A mechanism, its reference run, whose first column is the effort, and the coordinate whose speed the drive sees.
struct Case<'a> {
    file: &'static str,
    mechanism: &'a Mechanism,
    driven: usize,
}

impl Case<'_> {
    /// Measures, prints and tells whether a ratio is too great.
    fn judge<A, B, I, const D: usize>(&self, composed: A, chosen: B, start: (A::Pose, SVector<f64, D>)) -> bool
    where
        A: Mechanics<f64, D, Pose: Numbers + Copy> + Copy,
        B: Mechanics<f64, D, Pose = A::Pose> + Copy,
        I: Integrator,
    {
        let bdf = self.of_bdf::<A, D>(composed, start);
        let elements = of_composed::<A, B, I, D>(composed, chosen, start);
        let told = bdf.map_or("it does not meet the error".to_owned(), |(_, [one, all])| format!("{one:.2}, {all:.2}"));
        let desk = bdf.map_or(f64::NAN, |(desk, _)| desk * 1e3);
        println!("{:18} {desk:10.2}  {told:>34}   {elements:.2}", self.file);
        bdf.is_some_and(|(_, [ratio, _])| ratio > OF_BDF) || elements > OF_COMPOSED
    }

    /// The error of efforts at every millisecond.
    fn error(&self, efforts: impl Iterator<Item = f64>) -> f64 {
        let rows = mechanism_rows(self.file);
        let peak = rows.iter().fold(0.0, |peak: f64, row| peak.max(row[0].abs()));
        rows.iter().zip(efforts).fold(0.0, |worst: f64, (row, effort)| worst.max((row[0] - effort).abs())) / peak
    }

    /// The least time (s) of the desk that meets the error, and its ratios to diffsol's: of the integration and of everything.
    fn of_bdf<A, const D: usize>(
        &self,
        composed: A,
        (pose, velocity): (A::Pose, SVector<f64, D>),
    ) -> Option<(f64, [f64; 2])>
    where
        A: Mechanics<f64, D, Pose: Numbers>,
    {
        let gaps = self.mechanism.gaps_at(&[0.0]).expect("in bounds");
        let drive = self.mechanism.drives[0].drive;
        let desk = |error: f64| {
            let mut mechanism = self.mechanism.clone();
            mechanism.run.error = error;
            let start = Instant::now();
            let done = run(&mechanism, &gaps, 1e-3).expect("it is solved");
            let whole = start.elapsed().as_secs_f64();
            let error = self.error(done.samples.rows.iter().map(|row| row[1]));
            (error, [done.integration.as_secs_f64(), whole])
        };
        // 33 tolerances from 1e-3 to 1e-7. The peer has more to choose from: 192 pairs of tolerances and their proportions.
        let errors = (0..33).map(|i| 1e-3 * libm::pow(10.0, -0.125 * f64::from(i)));
        let able = errors.map(|error| (error, desk(error))).filter(|(_, (error, _))| *error <= WITHIN);
        let (best, _) = able.min_by(|one, other| one.1.1[0].total_cmp(&other.1.1[0]))?;

        let mut numbers = vec![0.0; A::Pose::COUNT + D];
        pose.write(&mut numbers);
        numbers[A::Pose::COUNT..].copy_from_slice(velocity.as_slice());
        let rates = |t: f64, state: &[f64], rates: &mut [f64]| rates_of(&composed, t, state, rates);
        let problem = FirstOrder { rates, start: &numbers, velocity: A::Pose::COUNT };
        let milliseconds = (self.mechanism.run.duration * 1e3).round() as u32;
        let peer = |tolerances: Tolerances| {
            let speed = |state: &[f64]| state[A::Pose::COUNT + self.driven];
            let (speeds, time) = problem.solve(milliseconds, BDF, tolerances, speed)?;
            let efforts = speeds.iter().enumerate().map(|(k, speed)| drive.force(k as f64 * 1e-3, *speed));
            Some((self.error(efforts), time.as_secs_f64()))
        };
        let able = Tolerances::all().filter_map(|tolerances| Some((tolerances, peer(tolerances)?)));
        let able = able.filter(|(_, (error, _))| *error <= WITHIN);
        let (tolerances, _) = able.min_by(|one, other| one.1.1.total_cmp(&other.1.1))?;
        let times: Vec<_> =
            (0..TURNS).map(|_| (desk(best).1, peer(tolerances).map_or(f64::NAN, |(_, time)| time))).collect();
        let least = times.iter().fold(f64::MAX, |least, (desk, _)| least.min(desk[0]));
        Some((least, [0, 1].map(|k| median(times.iter().map(|(desk, peer)| desk[k] / peer)))))
    }
}

/// The time of steps by elements chosen at run time over that by composed ones.
fn of_composed<A, B, I, const D: usize>(composed: A, chosen: B, start: (A::Pose, SVector<f64, D>)) -> f64
where
    A: Mechanics<f64, D, Pose: Copy> + Copy,
    B: Mechanics<f64, D, Pose = A::Pose> + Copy,
    I: Integrator,
{
    let times = (0..TURNS).map(|_| [stepped::<_, I, D>(&composed, start), stepped::<_, I, D>(&chosen, start)]);
    median(times.map(|[composed, chosen]| chosen / composed))
}

/// The time (s) of some steps.
fn stepped<M: Mechanics<f64, D> + Copy, I: Integrator, const D: usize>(
    mechanism: &M,
    (pose, velocity): (M::Pose, SVector<f64, D>),
) -> f64 {
    let kernel = Kernel::<f64, _, I>::new(*mechanism, 1e-4).expect("in bounds");
    let mut state = kernel.at_rest(pose);
    state.motion.velocity = velocity;
    let start = Instant::now();
    for _ in 0..1000 {
        let _ = black_box(kernel.step(&mut state));
    }
    start.elapsed().as_secs_f64()
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
