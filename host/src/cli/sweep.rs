//! `slipfit sweep`: the slide over tolerance levels.

use std::{collections::BTreeMap, fmt::Write, path::PathBuf};

use clap::Args;
use serde::Serialize;

use super::{
    Failure, SceneArguments, ThreadArguments, print, print_json, progress,
    simulate::{SteppingArguments, why_undecided},
    text_table,
};
use crate::{
    export::sweep_csv,
    files,
    number::{fixed, level, or_dash},
    outcome::{Outcome, Verdict},
    scene::{Override, Scene},
    simulate::Settings,
    sweep::{Sweep, sweep},
    trust::Trust,
};

/// Simulates the slide at many tolerance levels: breakaway, required force, does it jam.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    levels: LevelArguments,
    /// Writes the figures over n as CSV.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    #[command(flatten)]
    stepping: SteppingArguments,
    #[command(flatten)]
    threads: ThreadArguments,
}

/// Tolerance levels, where they differ from the scene's.
#[derive(Args)]
pub(super) struct LevelArguments {
    /// Tolerance levels, first:last:step; positive is tighter.
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
    trust: Trust,
    compressed: usize,
    zero: usize,
    free: usize,
    /// Class of each gap by name.
    classes: BTreeMap<String, String>,
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let overrides: Vec<_> = self.stepping.overrides().into_iter().chain(self.levels.overrides()).collect();
        let scene = self.scene.load(&overrides)?;
        if let Some(path) = &self.csv {
            self.scene.check_output(path)?;
        }
        // Samples are not shown: only the run's ends are kept.
        let settings = Settings::fixed(scene.run, scene.run.duration, self.stepping.scalar);
        let levels = scene.sweep.levels();
        let bar = progress("simulating", levels.len());
        let result = self.threads.install(|| sweep(&scene, &levels, &settings, || bar.inc(1)))??;
        bar.finish_and_clear();
        if let Some(path) = &self.csv {
            files::write(path, &sweep_csv(&scene, &result)?)?;
        }
        if self.scene.json {
            print_json(&for_machines(&scene, &result))
        } else {
            print(&format!("{}\n\n{}", scene.title, for_people(&scene, &result)))
        }
    }
}

/// The levels of a sweep as JSON wants them.
pub(super) fn for_machines(scene: &Scene, sweep: &Sweep) -> Vec<LevelReport> {
    let report = |level: &crate::sweep::Level| {
        let [compressed, zero, free] = level.class_counts();
        let named = scene.contact_names().into_iter().zip(level.classes);
        let classes = named.filter_map(|(name, class)| Some((name, class?.to_string()))).collect();
        LevelReport { n: level.n, outcome: level.outcome, trust: level.trust, compressed, zero, free, classes }
    };
    sweep.levels.iter().map(report).collect()
}

/// The levels of a sweep as a table.
pub(super) fn for_people(scene: &Scene, sweep: &Sweep) -> String {
    let rows: Vec<Vec<String>> = sweep
        .levels
        .iter()
        .map(|at| {
            let Outcome { breakaway, peak_force, settled_force, final_velocity, verdict } = at.outcome;
            let [compressed, zero, free] = at.class_counts();
            vec![
                level(at.n),
                or_dash(breakaway, |t| fixed(t * 1e3, 2)),
                or_dash(peak_force, |f| fixed(f, 4)),
                or_dash(settled_force, |f| fixed(f, 4)),
                fixed(final_velocity * 1e3, 3),
                verdict.to_string(),
                format!("{compressed}/{zero}/{free}"),
            ]
        })
        .collect();
    let heading =
        ["n", "breakaway, ms", "peak, N", "settled, N", "final, mm/s", "verdict", "gaps compressed/zero/free"];
    let mut text = text_table(&heading, &rows);
    if sweep.levels.iter().any(|level| level.outcome.verdict == Verdict::Undecided) {
        let _ = writeln!(text, "\nundecided{}", why_undecided(scene, Verdict::Undecided));
    }
    let doubtful: Vec<_> = sweep.levels.iter().filter(|level| !level.trust.is_sound()).map(|at| level(at.n)).collect();
    if let Some(step) = better_step(sweep) {
        text += &too_large(&format!(" at n = {}", doubtful.join(", ")), step);
    }
    text
}

/// A step (s) that should do for every level, where one is too large.
pub(super) fn better_step(sweep: &Sweep) -> Option<f64> {
    sweep.levels.iter().filter_map(|level| level.trust.better_step).reduce(f64::min)
}

/// A warning that the step is too large `wherever`, and that `better` (s) should do.
pub(super) fn too_large(wherever: &str, better: f64) -> String {
    format!("\nwarning: the step is too large{wherever}; take --step {}us\n", (better * 1e6).max(1.0))
}
