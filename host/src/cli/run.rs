//! `slipfit run`: the main job, from tolerances to a flash table and a report.

use std::{fmt::Write, path::PathBuf};

use clap::Args;
use serde::Serialize;

use super::{
    DRAWING, Failure, SceneArguments, ThreadArguments, check, print, print_json, progress, refused,
    simulate::why_undecided,
    sweep::{LevelArguments, LevelReport, for_machines, for_people},
    table,
    tolerance::{DEFAULT, PAPER_LEVEL},
};
use crate::{
    export::sweep_csv,
    figure::{figure_8, figure_9, required_force},
    files,
    force_table::{self, Demand},
    mobility::{contacts, rank_of_normals},
    outcome::Verdict,
    plot::PlotError,
    product::Product,
    report::{Figure, Flash, Production, ReportInput, report},
    self_locking::guide,
    simulate::ScalarKind,
    tolerance::{
        analysis::conclude,
        picture::pictures,
        report::{Report as Measures, measures_csv, report as of_measures},
        run::RunError,
        study::Study,
    },
};

/// What is written of the slide.
const OUTPUTS: [&str; 5] = ["table.bin", "sweep.csv", "fig8.svg", "fig9.svg", "report.html"];
/// The statistics of the product's measures.
const MEASURES: &str = "tolerance.csv";

/// The main job: tolerances, sweep over n, flash table, figures, report.
///
/// Starts from the drawing of the paper's slide unless a scene is given. Of a scene with a product, the tolerance analysis is
/// written, too: tolerance.csv, contributors.svg, correlation.svg and a histogram for every measure.
#[derive(Args)]
#[command(mut_arg("scene", |arg| arg.default_value(DRAWING)))]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Folder for table.bin, sweep.csv, fig8.svg, fig9.svg, report.html and what the product's analysis gives.
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
    /// How the product's measures vary, as `slipfit tolerance --json` shows it.
    tolerance: Option<Measures>,
    warnings: Vec<String>,
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let overrides: Vec<_> = self.levels.overrides().into_iter().collect();
        let (scene, product) = self.scene.load_with_product(&overrides)?;
        force_table::check(&scene, Demand::Full).map_err(|error| Failure::Input(error.to_string()))?;
        let production = product.as_ref().map(|product| self.analyse(&scene.title, product)).transpose()?;
        let of_production = production.iter().flat_map(|production| {
            [MEASURES].into_iter().chain(production.pictures.iter().map(|picture| picture.file.as_str()))
        });
        files::prepare_folder(&self.out).map_err(refused)?;
        let paths: Vec<_> = OUTPUTS.into_iter().chain(of_production).map(|name| self.out.join(name)).collect();
        let outputs: Vec<_> = paths.iter().map(|path| ("--out", path.as_path())).collect();
        self.scene.check_outputs(&outputs)?;

        let bar = progress("simulating", force_table::levels(&scene.sweep).count);
        let made = self.threads.install(|| force_table::make(&scene, ScalarKind::F64, Demand::Full, || bar.inc(1)))?;
        bar.finish_and_clear();
        let (table, sweep) = made?;
        let mut warnings = check::warnings(&scene, rank_of_normals(&contacts(&scene)), guide(&scene, 0.0).as_ref());
        warnings.extend(product.into_iter().flat_map(|product| product.warnings));
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
            production: production.as_ref(),
            notes: &warnings,
        });
        let [velocity, force] = [&figures[0], &figures[1]].map(|figure| figure.svg.clone().into_bytes());
        let mut contents = vec![table.bytes.clone(), sweep_csv(&scene, &sweep)?, velocity, force, page.into_bytes()];
        if let Some(Production { report, pictures }) = &production {
            contents.push(measures_csv(report)?);
            contents.extend(pictures.iter().map(|picture| picture.svg.clone().into_bytes()));
        }
        for (path, bytes) in paths.iter().zip(&contents) {
            files::write(path, bytes)?;
        }
        let files: Vec<_> = paths.iter().map(|path| path.display().to_string()).collect();
        if self.scene.json {
            return print_json(&Report {
                title: scene.title.clone(),
                files,
                table_bytes: table.bytes.len(),
                worst_force_error_n: table.worst_error[0],
                levels: for_machines(&scene, &sweep),
                tolerance: production.map(|production| production.report),
                warnings,
            });
        }
        let mut text = format!("{}\n\n{}\n", scene.title, for_people(&scene, &sweep));
        let _ = writeln!(text, "{}", table::describe(&table));
        if let Some(Production { report, .. }) = &production {
            let _ = writeln!(text, "{} measures of {} units analysed\n", report.measures.len(), report.samples);
        }
        for warning in &warnings {
            let _ = writeln!(text, "warning: {warning}\n");
        }
        let _ = writeln!(text, "Wrote {}", files.join(" "));
        print(&text)
    }

    /// Draws and analyses as `slipfit tolerance` does unless it is asked for something else.
    fn analyse(&self, title: &str, product: &Product) -> Result<Production, Failure> {
        let study = Study::new(&product.model, DEFAULT).map_err(RunError::from)?;
        let mut tallies = study.empty();
        let bar = progress("drawing", DEFAULT.samples as usize);
        let found = self.threads.install(|| {
            study.add(0..DEFAULT.blocks(), &mut tallies, |units| bar.inc(units));
            conclude(&study, &tallies)
        })?;
        bar.finish_and_clear();
        let report = of_measures(title, &product.model, &found.map_err(RunError::from)?);
        let pictures = pictures(&report, &study, &tallies).map_err(anyhow::Error::from)?;
        Ok(Production { report, pictures })
    }
}
