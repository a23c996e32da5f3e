//! Error against run time of the kernel's integrators and of general stiff solvers, in one run on one thread.
//!
//! All solve the paper's slide at n = 2.5, in f64 with regularised friction, and give the drive force every
//! millisecond; errors are against the reference runs. Error control computes the pins as the desk does: side by side where the
//! machine can. diffsol and, where it is installed, SUNDIALS
//! CVODE get the kernel's own forces as their right-hand side and a range of tolerances, of which the best found counts.
//!
//! `cargo bench --bench work_precision` prints each solver's quickest run within 1, 0.1 and 0.01 %, `-- --all` every run.

mod cvode_peer;
mod diffsol_peer;
mod entry;

use std::{
    ops::ControlFlow,
    time::{Duration, Instant},
};

use cvode_peer::Cvode;
use entry::{Achieved, Entry};
use slipfit::dynamics::{
    error_control::{Knot, Tolerance, sampled},
    scheme::{IntegratorKind, IntegratorVisitor},
};
use slipfit_core::{integrator::Integrator, kernel::Kernel, pose::Pose};
use slipfit_desk::slide::by_desk;
use slipfit_problems::cd_rom::{self, CdRomSlide};
use slipfit_tests::known_runs::{Reference, references};

/// Errors (% of the peak force, greatest over the whole run) at which run times are compared.
const WITHIN: [f64; 3] = [1.0, 0.1, 0.01];
/// Steps of the kernel (s).
const STEPS: [f64; 11] = [1e-3, 500e-6, 250e-6, 200e-6, 100e-6, 50e-6, 25e-6, 10e-6, 5e-6, 2e-6, 1e-6];

/// What an entry achieved.
struct Finding {
    /// Which of the entries.
    entry: usize,
    solver: &'static str,
    setting: String,
    max_percent: f64,
    time: Duration,
}

fn main() {
    // Cargo passes --bench.
    let all = std::env::args().any(|argument| argument == "--all");
    let cvode = Cvode::built();
    if let Err(why) = &cvode {
        println!("without SUNDIALS CVODE: {why}");
    }
    for name in ["slide-opening-n2.5", "slide-stroke-n2.5"] {
        let found = references().into_iter().find(|reference| reference.name == name);
        compare(&found.unwrap_or_else(|| panic!("{name} is a reference run")), cvode.as_ref().ok(), all);
    }
}

fn compare(reference: &Reference, cvode: Option<&Cvode>, all: bool) {
    let slide = cd_rom::slide(reference.n);
    let milliseconds = (reference.duration * 1e3).round() as u32;
    let mut entries = kernels(&slide, milliseconds);
    entries.extend(controlled(reference.n, milliseconds));
    entries.extend(diffsol_peer::entries(&slide, milliseconds));
    entries.extend(cvode.map(|cvode| cvode.entries(milliseconds)).into_iter().flatten());
    let findings = entries.iter().enumerate().filter_map(|(i, entry)| measure(i, entry, reference));
    let findings: Vec<Finding> = findings.collect();
    println!("\n{}, {} ms", reference.name, reference.duration * 1e3);
    if all {
        for finding in &findings {
            print(finding, "");
        }
    }
    let mut solvers: Vec<&str> = findings.iter().map(|finding| finding.solver).collect();
    solvers.dedup();
    for within in WITHIN {
        println!("\n  within {within} %{:35}max error, %   time, ms   of diffsol's BDF", "");
        let quickest = |solver: &str| {
            let able = findings.iter().filter(|found| found.solver == solver && found.max_percent <= within);
            able.min_by_key(|found| found.time)
        };
        let bdf = quickest(diffsol_peer::BDF);
        let mut best: Vec<&Finding> = solvers.iter().filter_map(|solver| quickest(solver)).collect();
        best.sort_by_key(|found| found.time);
        for found in best {
            let ratio = bdf.and_then(|bdf| ratio(found, bdf, &entries));
            print(found, &ratio.map_or_else(String::new, |ratio| format!("{ratio:10.2}")));
        }
    }
}

/// The time of `found` over that of `peer`: the median of turns, because a shared machine changes its pace; where it is
/// far above, one run each says enough.
fn ratio(found: &Finding, peer: &Finding, entries: &[Entry]) -> Option<f64> {
    /// Runs of each in a turn, of which the quickest counts, and turns.
    const RUNS: u32 = 3;
    const TURNS: u32 = 31;
    const FAR: u32 = 10;
    let quickest = |entry: &Entry| -> Option<f64> {
        let times = (0..RUNS).map(|_| (entry.work)().map(|achieved| achieved.time.as_secs_f64()));
        times.reduce(|a, b| Some(a?.min(b?)))?
    };
    if found.time > FAR * peer.time {
        return Some(found.time.as_secs_f64() / peer.time.as_secs_f64());
    }
    let (entry, peer) = (&entries[found.entry], &entries[peer.entry]);
    let ratios = (0..TURNS).map(|_| Some(quickest(entry)? / quickest(peer)?));
    let mut ratios: Vec<f64> = ratios.collect::<Option<_>>()?;
    ratios.sort_by(f64::total_cmp);
    Some(ratios[ratios.len() / 2])
}

fn print(Finding { solver, setting, max_percent, time, .. }: &Finding, ratio: &str) {
    let milliseconds = time.as_secs_f64() * 1e3;
    println!("  {solver:24}{setting:26}{max_percent:10.4}{milliseconds:11.3}{ratio}");
}

/// The kernel with every integrator at every step.
fn kernels(slide: &CdRomSlide<f64>, milliseconds: u32) -> Vec<Entry> {
    let every = |kind: IntegratorKind| STEPS.map(|step| kind.visit(KernelEntry { slide: *slide, milliseconds, step }));
    IntegratorKind::ALL.into_iter().flat_map(every).collect()
}

/// The desk's steps under error control, at every tolerance.
fn controlled(n: f64, milliseconds: u32) -> Vec<Entry> {
    let entry = |force: f64| {
        let work = move || {
            let (slide, data) = (cd_rom::slide(n), cd_rom::data::<f64>(n));
            let duration = f64::from(milliseconds) * 1e-3;
            let mut knots = Vec::new();
            let start = Instant::now();
            by_desk(
                &data,
                cd_rom::STICK_BAND,
                duration,
                Tolerance::of_force(force),
                &mut |t, motion, _, accelerations| {
                    let rates = accelerations.map(|both| both.map(|acceleration| [acceleration.z]));
                    knots.push(Knot { t, values: [motion.velocity.z], rates });
                    ControlFlow::Continue(())
                },
            )
            .ok()?;
            let times = (0..=milliseconds).map(|k| f64::from(k) * 1e-3);
            let values = sampled(&knots, times.clone());
            let force = times.zip(values).map(|(t, [vz])| slide.drive().force(t, vz)).collect();
            Some(Achieved { force, time: start.elapsed() })
        };
        Entry { solver: "error control, rodas4", setting: format!("{force:.1e} N"), work: Box::new(work) }
    };
    (0..41).map(|i| entry(1e-2 * libm::pow(10.0, -0.1 * f64::from(i)))).collect()
}

struct KernelEntry {
    slide: CdRomSlide<f64>,
    milliseconds: u32,
    step: f64,
}

impl IntegratorVisitor for KernelEntry {
    type Output = Entry;

    fn visit<I: Integrator>(self) -> Entry {
        let Self { slide, milliseconds, step } = self;
        let work = move || {
            let kernel = Kernel::<f64, _, I>::new(slide, step).ok()?;
            let start = Instant::now();
            let mut state = kernel.at_rest(Pose::nominal());
            let per_sample = (1e-3 / step).round() as u32;
            let mut force = vec![slide.drive().force(0.0, 0.0)];
            for _ in 0..milliseconds {
                for _ in 0..per_sample {
                    if !kernel.step(&mut state).residual.is_finite() {
                        return None;
                    }
                }
                force.push(slide.drive().force(kernel.time(state.steps), state.motion.velocity.z));
            }
            Some(Achieved { force, time: start.elapsed() })
        };
        Entry { solver: I::NAME, setting: format!("{} µs", (step * 1e6).round()), work: Box::new(work) }
    }
}

/// The error of an entry and its least time of at least 10 runs and 60 ms, unless these take more than half a second.
fn measure(index: usize, entry: &Entry, reference: &Reference) -> Option<Finding> {
    let begin = Instant::now();
    let mut time = Duration::MAX;
    let mut count = 0;
    loop {
        let achieved = (entry.work)()?;
        time = time.min(achieved.time);
        count += 1;
        let spent = begin.elapsed();
        if spent >= Duration::from_millis(500) || (count >= 10 && spent >= Duration::from_millis(60)) {
            let max_percent = reference.errors(&achieved.force).max;
            let (solver, setting) = (entry.solver, entry.setting.clone());
            return Some(Finding { entry: index, solver, setting, max_percent, time });
        }
    }
}
