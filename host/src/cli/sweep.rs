//! `slipfit sweep`: a unit of every tolerance level, or of every value of keys.

mod over;

use std::{collections::BTreeMap, fmt::Write, path::PathBuf};

use clap::Args;
use serde::Serialize;
use slipfit_core::slide::CONTACTS;
use slipfit_tolerance::number::{fixed, level, or_dash};

use super::{
    arguments::{DriveArguments, Moving, SceneArguments, ThreadArguments},
    by_one_drive::{ByOneDrive, FINER, why_undecided},
    call::{self, Want},
    failure::Failure,
    simulate::{ControllerArguments, LengthArguments},
    terminal::{given, print, print_json, progress, text_table, warn},
};
use crate::{
    dynamics::{
        answer::{Range, on_the_way, ranges},
        confirm::with_step_tried,
        outcome::{Outcome, Verdict},
        simulate::{Settings, SimulateError, Solved},
        slide::slide_level,
        sweep::{Keep, Level, Sweep, sweep},
        trust::Trust,
    },
    scene::Override,
    setup::Scene,
    show::{export::of_sweep, figure::verdicts},
};

/// Simulates a slide or a mechanism at many tolerance levels, or values of any key: where does it run, crawl, jam?
///
/// A slide runs its opening (`run.duration`) unless `--stroke` is given; a mechanism runs for `run.duration`, or to the end of its stroke. The
/// desk computes the runs by error-controlled steps. With `--step`, `--integrator` or `--scalar` the controller computes them by steps of one
/// length, and a warning names the levels whose runs cannot be trusted.
///
/// For slides only: `--step`, `--integrator`, `--scalar`, `--stroke`.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    drive: DriveArguments,
    #[command(flatten)]
    levels: LevelArguments,
    /// Goes over the values of a key of the scene, from A to B, such as friction.coefficient=0.1:0.4:0.02; given twice, over two keys.
    ///
    /// A key is any that `--set` takes with a number, in the key's unit, or n, the tolerance level. At each value, or combination of two, the
    /// unit of level n = 0 or of the one `--n` is simulated.
    #[arg(long, value_name = "KEY=A:B:STEP", allow_hyphen_values = true)]
    over: Vec<String>,
    /// Units of the production to simulate at every value of `--over`: which share of them malfunctions.
    ///
    /// The units are the same at every value. A slide's run the opening unless `--stroke` is given.
    #[arg(long, requires = "over", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    units: Option<u64>,
    /// Writes a row of figures for every level, or value, as CSV.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draws verdict and force over the tolerance level, or over the keys, as SVG.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    length: LengthArguments,
    #[command(flatten)]
    controller: ControllerArguments,
    #[command(flatten)]
    threads: ThreadArguments,
}

/// Tolerance levels, where they differ from the scene's.
#[derive(Args)]
pub(super) struct LevelArguments {
    /// Tolerance levels from A to B, such as -3:5:0.1, or one level; positive is tighter.
    ///
    /// If not given, the levels are the scene's `sweep.n`.
    #[arg(long, value_name = "A:B:STEP", allow_hyphen_values = true)]
    n: Option<String>,
}

impl LevelArguments {
    /// The option as a setting of the scene.
    pub fn overrides(&self) -> Option<Override> {
        self.n.as_ref().map(|n| Override::option("--n", "sweep.n", n))
    }
}

/// A level for machines.
#[derive(Serialize)]
pub(super) struct LevelReport {
    n: f64,
    #[serde(flatten)]
    outcome: Outcome,
    solver: Solved,
    trust: Trust,
    compressed: usize,
    zero: usize,
    free: usize,
    /// Class of each gap by name.
    classes: BTreeMap<String, String>,
}

#[derive(Serialize)]
struct Report<'a> {
    title: &'a str,
    /// The drive's name.
    drive: &'a str,
    /// N, or N·m of a drive that turns, whose forces, speeds and travel are torques, rad/s and rad.
    effort_unit: &'static str,
    ranges: Vec<Range>,
    levels: Vec<LevelReport>,
    warnings: Vec<String>,
}

impl Arguments {
    /// What moves, for as long as is asked for.
    fn of_length(&self, moving: Moving) -> Result<Moving, Failure> {
        match moving {
            Moving::Slide(scene) => Ok(Moving::Slide(Box::new(self.length.applied(*scene)?))),
            Moving::Mechanism(_) if self.controller.given() || self.length.stroke => {
                let why = "--step, --integrator, --scalar and --stroke are for slides on pins; \
                           a mechanism runs for run.duration, or to run.stroke";
                Err(Failure::Input(why.into()))
            }
            moving => Ok(moving),
        }
    }

    pub fn run(&self) -> Result<(), Failure> {
        let of_run = self.controller.overrides().into_iter().chain(self.length.overrides());
        if !self.over.is_empty() {
            return self.over_keys(&of_run.collect::<Vec<_>>());
        }
        let overrides: Vec<_> = of_run.chain(self.levels.overrides()).collect();
        let (moving, product) = self.scene.load_moving_with_product(&overrides)?;
        let moving = self.of_length(moving)?;
        let of = ByOneDrive::new(&moving, &self.drive)?;
        let subject = of.subject();
        self.scene.check_outputs(&given([("--csv", &self.csv), ("--plot", &self.plot)]))?;
        let levels = subject.levels().levels();
        let bar = progress("simulating", levels.len());
        let unit = |n| of_point(&of, n, self.controller.given());
        let swept = self.threads.install(|| sweep(subject, &levels, Keep::Figures, unit, || bar.inc(1)))?;
        bar.finish_and_clear();
        let mut swept = swept?;
        if let (ByOneDrive::Slide(scene), Some(k)) = (of, worst_doubt(&swept)) {
            let worst = &mut swept.levels[k];
            worst.trust = with_step_tried(scene, &[worst.n; CONTACTS], worst.trust)?;
            worst.doubts = worst.trust.warning().into_iter().collect();
        }
        call::columns(Want::Columns, self.csv.as_deref(), || Ok(of_sweep(&swept)))?;
        call::picture(self.plot.as_deref(), "levels", || verdicts(&swept, subject.title()))?;
        let mut warnings = of.warnings()?;
        warnings.extend(product.into_iter().flat_map(|product| product.warnings));
        warnings.extend(doubts(&swept));
        if self.scene.json {
            return print_json(&Report {
                title: subject.title(),
                drive: of.drive_name(),
                effort_unit: subject.kind().effort_unit(),
                ranges: ranges(&swept),
                levels: for_machines(&swept),
                warnings,
            });
        }
        let finer = if self.controller.given() { "take a smaller --step" } else { FINER };
        print(&format!("{}\n\n{}\n{}", of.title(), answer(&swept), for_people(&of, &swept, finer)))?;
        warn(&warnings);
        Ok(())
    }
}

/// The unit of level `n`, by the desk or, of a slide, by its controller.
fn of_point(of: &ByOneDrive, n: f64, by_controller: bool) -> Result<Level, SimulateError> {
    match of {
        ByOneDrive::Slide(scene) if by_controller => slide_level(scene, n, &controllers(scene)),
        _ => of.subject().level(n, of.subject().motion(1e-3)),
    }
}

/// The controller's steps, with samples on them, a millisecond apart or a step where that is longer.
fn controllers(scene: &Scene) -> Settings {
    let step = scene.controller.step;
    Settings::controller(scene, (1e-3 / step).round().max(1.0) * step)
}

/// From which level to which the unit runs, crawls and jams: a line each.
pub(super) fn answer(sweep: &Sweep) -> String {
    ranges(sweep).iter().map(|range| range.describe() + "\n").collect()
}

/// The levels of a sweep as JSON wants them.
pub(super) fn for_machines(sweep: &Sweep) -> Vec<LevelReport> {
    let report = |level: &Level| {
        let [compressed, zero, free] = level.class_counts();
        let named = sweep.gaps.iter().zip(&level.classes);
        let classes = named.filter_map(|(name, class)| Some((name.clone(), (*class)?.to_string()))).collect();
        let &Level { n, outcome, solved: solver, trust, .. } = level;
        LevelReport { n, outcome, solver, trust, compressed, zero, free, classes }
    };
    sweep.levels.iter().map(report).collect()
}

/// The levels of a sweep as a table.
fn for_people(of: &ByOneDrive, sweep: &Sweep, finer: &str) -> String {
    let kind = sweep.kind;
    let rows: Vec<Vec<String>> = sweep
        .levels
        .iter()
        .map(|at| {
            let Outcome { breakaway, peak_force, settled_force, final_velocity, end, verdict, .. } = at.outcome;
            let [compressed, zero, free] = at.class_counts();
            vec![
                level(at.n),
                or_dash(breakaway, |t| fixed(t * 1e3, 2)),
                or_dash(peak_force, |f| fixed(f, 4)),
                or_dash(settled_force, |f| fixed(f, 4)),
                fixed(kind.speed(final_velocity), 3),
                fixed(kind.travel(end.z), 2),
                verdict.to_string(),
                format!("{compressed}/{zero}/{free}"),
                on_the_way(kind, &at.outcome),
            ]
        })
        .collect();
    let unit = kind.effort_unit();
    let heading = [
        "n",
        "breakaway, ms",
        &format!("peak, {unit}"),
        &format!("settled, {unit}"),
        &format!("final, {}", kind.speed_unit()),
        &format!("travel, {}", kind.travel_unit()),
        "verdict",
        "gaps compressed/zero/free",
        "on the way",
    ];
    let mut text = text_table(&heading, &rows);
    let longer = of.longer().map(|_| "--stroke runs the whole stroke");
    // Doubts say why the others have none.
    if sweep.levels.iter().any(|level| level.outcome.verdict == Verdict::Undecided && level.doubts.is_empty()) {
        let _ = writeln!(text, "\nundecided{}", why_undecided(of.subject(), longer, finer));
    }
    text
}

/// The place of the level whose run can be trusted least; `None` if all can.
fn worst_doubt(sweep: &Sweep) -> Option<usize> {
    let difference = |k: &usize| sweep.levels[*k].trust.difference.unwrap_or_default();
    let doubtful = (0..sweep.levels.len()).filter(|k| !sweep.levels[*k].doubts.is_empty());
    doubtful.max_by(|one, other| difference(one).total_cmp(&difference(other)))
}

/// A warning for the levels whose runs cannot be trusted, with the advice of the worst.
pub(super) fn doubts(sweep: &Sweep) -> Option<String> {
    let doubtful: Vec<&Level> = sweep.levels.iter().filter(|level| !level.doubts.is_empty()).collect();
    let worst = &sweep.levels[worst_doubt(sweep)?];
    let levels = doubtful.iter().map(|at| level(at.n)).collect::<Vec<_>>().join(", ");
    let warning = worst.doubts.first()?;
    let levels = if doubtful.len() > 12 { format!("{} levels", doubtful.len()) } else { format!("n = {levels}") };
    let alone = if worst.trust.better_step_tried && doubtful.len() > 1 { ", which does there" } else { "" };
    Some(format!("at {levels}, worst at n = {}: {warning}{alone}", level(worst.n)))
}
