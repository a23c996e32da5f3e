//! `slipfit run`: the main job, from tolerances to a flash table and a report. Its first lines are the answer.

use std::{fmt::Write, path::PathBuf};

use clap::Args;
use serde::Serialize;

use super::{
    DRAWING, Failure, JSON_VERSION, SceneArguments, ThreadArguments, check,
    population::{percent, strongest},
    print, print_json, progress, refused,
    simulate::why_undecided,
    sweep::{LevelArguments, LevelReport, answer, doubts, for_machines},
    table,
    tolerance::DEFAULT,
    warn,
};
use crate::{
    answer::{Range, ranges},
    export::sweep_csv,
    figure::{forces, velocities, verdicts},
    files,
    force_table::{self, Demand, ForceTable},
    number::{fixed, per_million},
    outcome::Verdict,
    plot::PlotError,
    population::{
        picture::forces as population, production::Production as DrawnProduction, statistics::Statistics,
        study::Population,
    },
    product::Product,
    report::{Figure, Flash, Production, ReportInput, report},
    scene::Scene,
    self_locking::guide,
    simulate::Settings,
    sweep::{Keep, Sweep, sweep},
    table2::derived,
    tolerance::{
        analysis::conclude,
        picture::pictures,
        report::{Report as Measures, measures_csv, report as of_measures},
        run::RunError,
        study::Study,
    },
};

/// What is written of the mechanism, the page first.
const OUTPUTS: [&str; 9] = [
    "report.html",
    "table.bin",
    "sweep.csv",
    "verdict.svg",
    "opening-velocity.svg",
    "opening-force.svg",
    "stroke-velocity.svg",
    "stroke-force.svg",
    "population.svg",
];
/// The statistics of the product's measures.
const MEASURES: &str = "tolerance.csv";

/// The main job: does the product work, from which tolerance level on not, and what force does it take?
///
/// Starts from the drawing of the paper's slide unless a scene is given. Analyses the tolerances, simulates the opening and
/// the whole stroke at every level, makes the flash table and a page with all pictures.
#[derive(Args)]
#[command(mut_arg("scene", |arg| arg.default_value(DRAWING)))]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Folder for report.html, table.bin, sweep.csv, the figures and what the product's analysis gives.
    #[arg(long, value_name = "DIR", default_value = "slipfit-out")]
    out: PathBuf,
    #[command(flatten)]
    levels: LevelArguments,
    /// Units of the production to simulate one by one; `slipfit population` tells more of them.
    #[arg(long, default_value_t = 256, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    units: u64,
    #[command(flatten)]
    threads: ThreadArguments,
}

#[derive(Serialize)]
struct Report {
    json_version: u32,
    title: String,
    files: Vec<String>,
    table_bytes: usize,
    worst_force_error_n: f64,
    /// The answer: neighbouring levels with the same verdict.
    ranges: Vec<Range>,
    /// The stroke, or the run where no stroke is stated.
    levels: Vec<LevelReport>,
    /// What units drawn one by one do, as `slipfit population --json` shows it.
    population: Statistics,
    /// How the product's measures vary, as `slipfit tolerance --json` shows it.
    tolerance: Option<Measures>,
    warnings: Vec<String>,
}

/// All that was simulated.
struct Simulated {
    table: ForceTable,
    opening: Sweep,
    /// Where the scene states a stroke that the opening does not come to the end of.
    stroke: Option<Sweep>,
    /// Units of the production over the same run.
    population: Population,
}

impl Simulated {
    /// What verdicts are given by.
    fn judged(&self) -> &Sweep {
        self.stroke.as_ref().unwrap_or(&self.opening)
    }
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let overrides: Vec<_> = self.levels.overrides().into_iter().collect();
        let (scene, product) = self.scene.load_with_product(&overrides)?;
        force_table::check(&scene, Demand::Full).map_err(|error| Failure::Input(error.to_string()))?;
        let production = product.as_ref().map(|product| self.analyse(&scene.title, product)).transpose()?;
        let made = !self.out.exists();
        files::prepare_folder(&self.out).map_err(refused)?;
        let pictures = production.iter().flat_map(|production| &production.pictures);
        let names = OUTPUTS.into_iter().chain([MEASURES]).chain(pictures.map(|picture| picture.file.as_str()));
        let paths: Vec<_> = names.map(|name| self.out.join(name)).collect();
        let named: Vec<_> = paths.iter().map(|path| ("--out", path.as_path())).collect();
        self.scene.check_outputs(&named)?;
        let done = self.fill(&scene, product, production);
        if made && done.is_err() {
            // Only if nothing was written.
            let _ = std::fs::remove_dir(&self.out);
        }
        done
    }

    fn fill(&self, scene: &Scene, product: Option<Product>, production: Option<Production>) -> Result<(), Failure> {
        let simulated = self.simulate(scene, product.as_ref())?;
        let mut warnings = check::warnings_of(scene);
        warnings.extend(product.into_iter().flat_map(|product| product.warnings));
        warnings.extend(doubts(simulated.judged()));
        let undecided = |level: &crate::sweep::Level| level.outcome.verdict == Verdict::Undecided;
        if simulated.judged().levels.iter().any(undecided) {
            warnings.push(format!("not every level comes to a verdict{}", why_undecided(scene, Verdict::Undecided)));
        }
        if simulated.stroke.is_none() && scene.run.stroke.is_none() {
            warnings.push(
                "the scene states no stroke, so that its verdicts depend on run.duration; state one, such as run.stroke = 80"
                    .into(),
            );
        }

        let answer = self.answer(scene, &simulated, production.as_ref());
        let figures = figures(scene, &simulated)?;
        let ForceTable { worst_error_in_use: [worst_force_error, worst_velocity_error], .. } = simulated.table;
        let mut notes = warnings.clone();
        notes.extend(check::clearance_notes(scene));
        let page = report(&ReportInput {
            scene,
            sweep: simulated.judged(),
            answer: &answer,
            figures: &figures.iter().map(|(_, figure)| figure.clone()).collect::<Vec<_>>(),
            n: derived(scene, 0.0).tightest().map_or(0.0, |tightest| (tightest.n * 100.0).round() / 100.0),
            flash: Some(Flash { bytes: simulated.table.bytes.len(), worst_force_error, worst_velocity_error }),
            production: production.as_ref(),
            notes: &notes,
        });
        let mut files: Vec<(String, Vec<u8>)> = vec![
            (OUTPUTS[0].into(), page.into_bytes()),
            (OUTPUTS[1].into(), simulated.table.bytes.clone()),
            (OUTPUTS[2].into(), sweep_csv(scene, simulated.judged())?),
        ];
        files.extend(figures.into_iter().map(|(name, figure)| (name.to_owned(), figure.svg.into_bytes())));
        if let Some(Production { report, pictures }) = &production {
            files.push((MEASURES.into(), measures_csv(report)?));
            files.extend(pictures.iter().map(|picture| (picture.file.clone(), picture.svg.clone().into_bytes())));
        }
        warnings.extend(self.strangers(&files));
        let paths: Vec<_> = files.iter().map(|(name, _)| self.out.join(name)).collect();
        for (path, (_, bytes)) in paths.iter().zip(&files) {
            files::write(path, bytes)?;
        }
        if self.scene.json {
            return print_json(&Report {
                json_version: JSON_VERSION,
                title: scene.title.clone(),
                files: paths.iter().map(|path| path.display().to_string()).collect(),
                table_bytes: simulated.table.bytes.len(),
                worst_force_error_n: simulated.table.worst_error[0],
                ranges: ranges(simulated.judged()),
                levels: for_machines(scene, simulated.judged()),
                population: simulated.population.statistics.clone(),
                tolerance: production.map(|production| production.report),
                warnings,
            });
        }
        let page = self.out.join(OUTPUTS[0]);
        print(&format!("{}\n\n{answer}Look at         {}", scene.title, page.display()))?;
        warn(&warnings);
        Ok(())
    }

    /// The opening with its table, and the stroke.
    fn simulate(&self, scene: &Scene, product: Option<&Product>) -> Result<Simulated, Failure> {
        let duration = scene.stroke_duration().filter(|duration| *duration > scene.run.duration);
        let levels = scene.sweep.levels();
        let opening = force_table::levels(&scene.sweep).count;
        let production = DrawnProduction::new(scene, product, 0.0, DEFAULT.seed)
            .map_err(|error| Failure::Input(error.to_string()))?;
        let runs = opening + duration.map_or(0, |_| levels.len());
        let bar = progress("simulating", runs + self.units as usize);
        let made = self.threads.install(|| {
            let (table, opening) = force_table::make(scene, Demand::Full, || bar.inc(1))?;
            let mut whole = scene.clone();
            whole.run.duration = duration.unwrap_or(scene.run.duration);
            let stroke =
                duration.map(|_| sweep(&whole, &levels, &Settings::desk(&whole, 1e-3), Keep::Samples, || bar.inc(1)));
            let population = Population::study(&whole, &production, self.units, None, |units| bar.inc(units))?;
            Ok::<_, Failure>(Simulated { table, opening, stroke: stroke.transpose()?, population })
        })??;
        bar.finish_and_clear();
        Ok(made)
    }

    /// At most fifteen lines: what the product does at which levels, what closes first and how probable that is, what to
    /// change, and where to look.
    fn answer(&self, scene: &Scene, simulated: &Simulated, production: Option<&Production>) -> String {
        let mut text = answer(simulated.judged());
        text.push('\n');
        let Population { statistics, of_malfunction, .. } = &simulated.population;
        let _ = writeln!(
            text,
            "Production      {} of {} units malfunction",
            percent(&statistics.malfunctions),
            statistics.units
        );
        if statistics.malfunctions.units > 0 {
            let _ = writeln!(text, "Drives failure  {}", strongest(of_malfunction, 2));
        }
        let derived = derived(scene, 0.0);
        let closes = derived.tightest();
        if let Some(tightest) = closes {
            let (pin, direction) = (tightest.pin, tightest.direction);
            let _ = writeln!(text, "Closes first    {pin} {direction}, at n* = {}", fixed(tightest.n, 3));
        }
        let sums = production.map(|production| &production.report.sums[..]).unwrap_or_default();
        let likeliest = sums.iter().max_by(|one, other| one.model.dpm.total_cmp(&other.model.dpm));
        if let Some(sum) = likeliest {
            let [drawn, together] = [sum.model.dpm, sum.eq9_ppm].map(|ppm| per_million(ppm) + " ppm");
            let _ = writeln!(
                text,
                "How probable    {drawn} by the drawing ({}); {together} if its gaps move together (eq. 9)",
                sum.name
            );
        }
        let _ = writeln!(
            text,
            "What to change  {}",
            advice(scene, simulated.judged(), closes.map(|at| at.pin), production)
        );
        let error = simulated.table.worst_error_in_use[0];
        let _ = writeln!(
            text,
            "Flash table     {} bytes, {} ms, force within {} mN from the ramp's start on",
            simulated.table.bytes.len(),
            fixed(scene.run.duration * 1e3, 0),
            fixed(error * 1e3, 2)
        );
        if let Some(warning) = table::coarse(scene, &simulated.table) {
            let _ = writeln!(text, "                {warning}");
        }
        text
    }

    /// A warning of files in the output folder that this run did not write.
    fn strangers(&self, files: &[(String, Vec<u8>)]) -> Option<String> {
        let mut names: Vec<String> = std::fs::read_dir(&self.out)
            .ok()?
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .filter(|name| !files.iter().any(|(own, _)| own == name))
            .collect();
        names.sort();
        let out = self.out.display();
        (!names.is_empty()).then(|| format!("{out} also holds what this run did not write: {}", names.join(", ")))
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

/// What to change, by what goes wrong at which levels.
fn advice(scene: &Scene, sweep: &Sweep, closes: Option<&str>, production: Option<&Production>) -> String {
    let bad = |level: &&crate::sweep::Level| matches!(level.outcome.verdict, Verdict::Crawls | Verdict::Jammed);
    let runs = || sweep.levels.iter().filter(|level| level.outcome.verdict == Verdict::Runs);
    let Some(worst) = sweep.levels.iter().filter(bad).min_by(|one, other| one.n.abs().total_cmp(&other.n.abs())) else {
        return "nothing: it runs at every level".into();
    };
    if let Some(critical) = guide(scene, 0.0).filter(|guide| guide.warn).and_then(|guide| guide.critical_friction) {
        return format!(
            "bring friction below {} (it is {}), lengthen the guide, or drive nearer to it: it self-locks",
            fixed(critical, 3),
            scene.friction.coefficient()
        );
    }
    let looser = runs().next().is_none_or(|first| worst.n < first.n);
    let side = if looser { "loose" } else { "tight" };
    let gap = |measure: &&crate::tolerance::report::MeasureReport| closes.is_some_and(|pin| measure.name.contains(pin));
    let widest = production.and_then(|production| {
        let measures = production.report.measures.iter().filter(gap);
        measures.max_by(|one, other| one.sd.total_cmp(&other.sd))?.contributors.first()
    });
    match widest {
        Some(widest) => {
            format!("{side} units go wrong first, from n = {}; start with the tolerance of {}", worst.n, widest.name)
        }
        None => format!("{side} units go wrong first, from n = {}", worst.n),
    }
}

/// The pictures of the page and the files they go to.
fn figures(scene: &Scene, simulated: &Simulated) -> Result<Vec<(&'static str, Figure)>, Failure> {
    let captioned = |caption: &str, svg: Result<String, PlotError>| -> Result<Figure, Failure> {
        Ok(Figure { caption: caption.into(), svg: svg.map_err(anyhow::Error::from)? })
    };
    let title = &scene.title;
    let mut figures = Vec::new();
    if simulated.judged().levels.iter().any(|level| level.outcome.peak_force.is_some()) {
        let caption = "Each mark is a tolerance level: its shape says whether the slide runs, its height what force that takes. \
                       Behind: how many units of the production are drawn at that level, if its gaps move together.";
        figures.push((OUTPUTS[3], captioned(caption, verdicts(simulated.judged(), title))?));
    }
    let caption = "Every mark is a unit of the production, drawn with gaps of its own, over the same run. No level stands for it: \
                   units of the same mean tightness run, crawl and jam.";
    let units = population(scene, &simulated.population.units, None);
    figures.push((OUTPUTS[8], captioned(caption, units)?));
    let caption = "The opening: how fast the slide moves while the drive starts. Compressed gaps are released in the first \
                   milliseconds; from the ramp's start on the slide breaks away, the earlier the less it takes.";
    figures.push((OUTPUTS[4], captioned(caption, velocities(&simulated.opening, title))?));
    let caption = "The opening: the force of the drive, which the flash table holds.";
    figures.push((OUTPUTS[5], captioned(caption, forces(&simulated.opening, title))?));
    if let Some(stroke) = &simulated.stroke {
        let caption = "The whole stroke: how fast the slide moves. A line that falls away is a slide that tips, slows or jams; \
                       one that ends early has come to the end of the stroke.";
        figures.push((OUTPUTS[6], captioned(caption, velocities(stroke, title))?));
        let caption = "The whole stroke: the force of the drive. It rises where the slide is slower than commanded.";
        figures.push((OUTPUTS[7], captioned(caption, forces(stroke, title))?));
    }
    Ok(figures)
}
