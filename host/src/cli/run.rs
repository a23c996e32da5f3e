//! `slipfit run`: the main job, from tolerances to a flash table and a report.

use std::{fmt::Write, path::PathBuf};

use clap::Args;
use serde::Serialize;

use super::{
    Failure, SceneArguments, ThreadArguments, check, print, print_json, progress, refused,
    simulate::why_undecided,
    sweep::{LevelArguments, LevelReport, for_machines, for_people},
    table,
};
use crate::{
    export::sweep_csv,
    figure::{figure_8, figure_9, required_force},
    files,
    force_table::{self, Demand},
    mobility::{contacts, rank_of_normals},
    outcome::Verdict,
    plot::PlotError,
    report::{Figure, Flash, ReportInput, report},
    self_locking::guide,
    simulate::ScalarKind,
};

/// The tolerance level of the report's Table 2: the paper's, which just closes the tightest pair.
const PAPER_LEVEL: f64 = 3.43;

/// What is written.
const OUTPUTS: [&str; 5] = ["table.bin", "sweep.csv", "fig8.svg", "fig9.svg", "report.html"];

/// The main job: tolerances, sweep over n, flash table, figures, report.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Folder for table.bin, sweep.csv, fig8.svg, fig9.svg and report.html.
    #[arg(long, value_name = "DIR", default_value = "slipfit-out")]
    out: PathBuf,
    #[command(flatten)]
    levels: LevelArguments,
    #[command(flatten)]
    threads: ThreadArguments,
}

#[derive(Serialize)]
struct Report {
    title: String,
    files: Vec<String>,
    table_bytes: usize,
    worst_force_error_n: f64,
    levels: Vec<LevelReport>,
    warnings: Vec<String>,
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let overrides: Vec<_> = self.levels.overrides().into_iter().collect();
        let scene = self.scene.load(&overrides)?;
        force_table::check(&scene, Demand::Full).map_err(|error| Failure::Input(error.to_string()))?;
        files::prepare_folder(&self.out).map_err(refused)?;
        for name in OUTPUTS {
            self.scene.check_output(&self.out.join(name))?;
        }

        let bar = progress("simulating", force_table::levels(&scene.sweep).count);
        let made = self.threads.install(|| force_table::make(&scene, ScalarKind::F64, Demand::Full, || bar.inc(1)))?;
        bar.finish_and_clear();
        let (table, sweep) = made?;
        let mut warnings = check::warnings(&scene, rank_of_normals(&contacts(&scene)), guide(&scene, 0.0).as_ref());

        if sweep.levels.iter().all(|level| level.outcome.verdict == Verdict::Undecided) {
            warnings.push(format!("no level comes to a verdict{}", why_undecided(&scene, Verdict::Undecided)));
        }

        let captioned = |caption: &str, svg: Result<String, PlotError>| -> Result<Figure, Failure> {
            Ok(Figure { caption: caption.into(), svg: svg.map_err(anyhow::Error::from)? })
        };
        let mut figures = vec![
            captioned("Velocity of the slide over time (Fig. 8 of the paper).", figure_8(&sweep, &scene.title))?,
            captioned("Drive force over time (Fig. 9 of the paper).", figure_9(&sweep, &scene.title))?,
        ];
        if sweep.levels.iter().any(|level| level.outcome.peak_force.is_some()) {
            let caption = "Peak drive force and breakaway over the level.";
            figures.push(captioned(caption, required_force(&sweep, &scene.title))?);
        }
        let [worst_force_error, worst_velocity_error] = table.worst_error;
        let page = report(&ReportInput {
            scene: &scene,
            sweep: &sweep,
            figures: &figures,
            n: PAPER_LEVEL,
            flash: Some(Flash { bytes: table.bytes.len(), worst_force_error, worst_velocity_error }),
            notes: &warnings,
        });
        let [velocity, force] = [&figures[0], &figures[1]].map(|figure| figure.svg.clone().into_bytes());
        let contents = [table.bytes.clone(), sweep_csv(&scene, &sweep)?, velocity, force, page.into_bytes()];
        let paths = OUTPUTS.map(|name| self.out.join(name));
        for (path, bytes) in paths.iter().zip(&contents) {
            files::write(path, bytes)?;
        }
        let files = paths.map(|path| path.display().to_string()).to_vec();
        if self.scene.json {
            return print_json(&Report {
                title: scene.title.clone(),
                files,
                table_bytes: table.bytes.len(),
                worst_force_error_n: table.worst_error[0],
                levels: for_machines(&scene, &sweep),
                warnings,
            });
        }
        let mut text = format!("{}\n\n{}\n", scene.title, for_people(&scene, &sweep));
        let _ = writeln!(text, "{}", table::describe(&table));
        for warning in &warnings {
            let _ = writeln!(text, "warning: {warning}\n");
        }
        let _ = writeln!(text, "Wrote {}", files.join(" "));
        print(&text)
    }
}
