//! The main job of a slide: opening and stroke at every level, and units of the production.

use std::fmt::Write;

use serde::Serialize;
use slipfit_tolerance::{
    number::{fixed, per_million},
    numeric::normal::tail,
    product::Product,
    report::Report as Measures,
};

use super::{
    Arguments, UNITS,
    advice::{Units, nothing_wrong, remedy},
    answer,
    output::{Output, PAGE, SWEEP, TABLE, captioned, of_production},
    table_line,
};
use crate::{
    cli::{
        check,
        failure::Failure,
        population::{
            page::{self, UNKNOWN_FIGURE, unknown_figure},
            uncertain,
        },
        simulate::why_undecided,
        sweep::{LevelReport, doubts, for_machines},
        table,
        terminal::{print, print_json, progress, warn},
        tolerance::DEFAULT,
    },
    dynamics::{
        answer::{Range, ranges},
        driven::Driven,
        outcome::Verdict,
        sweep::{Keep, Sweep, sweep},
    },
    firmware::force_table::{self, Demand, ForceTable},
    mechanism::{
        closing::{closing_level, derived},
        self_locking::{DriveSide, guide},
    },
    population::{
        production::Production as DrawnProduction,
        statistics::Statistics,
        study::Population,
        tally::Duty,
        uncertain::{answer::Answer, study::of_slide},
    },
    setup::Scene,
    show::{
        export::sweep_csv,
        figure::{forces, velocities, verdicts},
        report::{Clearances, Figure, Flash, Production, ReportInput, Units as UnitsShown, report},
    },
};

/// The pictures.
const FIGURES: [&str; 5] =
    ["verdict.svg", "opening-velocity.svg", "opening-force.svg", "stroke-velocity.svg", "stroke-force.svg"];

#[derive(Serialize)]
struct Report {
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
    /// What the unknowns leave open of it; none without unknowns.
    uncertain: Option<Answer>,
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
    /// The same for the page, and the names of its pictures' files.
    units: (UnitsShown, Vec<&'static str>),
    /// What the unknowns leave open, if there are any.
    unknown: Option<Answer>,
}

impl Simulated {
    /// The units of the production.
    fn of_units(&self) -> Units<'_> {
        let Population { statistics, of_malfunction, .. } = &self.population;
        Units { statistics, of_malfunction, unknown: self.unknown.as_ref() }
    }

    /// What verdicts are given by.
    fn judged(&self) -> &Sweep {
        self.stroke.as_ref().unwrap_or(&self.opening)
    }
}

impl Arguments {
    pub(super) fn run_slide(&self, scene: &Scene, product: Option<&Product>) -> Result<(), Failure> {
        self.written(
            scene,
            product,
            &[FIGURES.as_slice(), &page::FIGURES, &[UNKNOWN_FIGURE]].concat(),
            |output, production| self.fill_with_slide(output, scene, product, production),
        )
    }

    fn fill_with_slide(
        &self,
        output: &Output,
        scene: &Scene,
        product: Option<&Product>,
        production: Option<Production>,
    ) -> Result<(), Failure> {
        let simulated = self.simulate(scene, product)?;
        let mut warnings = check::warnings_of(scene);
        warnings.extend(product.into_iter().flat_map(|product| product.warnings.clone()));
        warnings.extend(doubts(simulated.judged()));
        warnings.extend(simulated.unknown.as_ref().map(uncertain::warnings).transpose()?.unwrap_or_default());
        let undecided = |level: &crate::dynamics::sweep::Level| level.outcome.verdict == Verdict::Undecided;
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
        let page = report(&ReportInput {
            title: &scene.title,
            sweep: simulated.judged(),
            answer: &answer,
            figures: &figures.iter().map(|(_, figure)| figure.clone()).collect::<Vec<_>>(),
            clearances: Clearances::Pins { scene, n: closing_level(scene) },
            flash: Some(Flash { bytes: simulated.table.bytes.len(), worst_force_error, worst_velocity_error }),
            units: Some(&simulated.units.0),
            production: production.as_ref(),
            notes: &warnings,
        });
        let mut files: Vec<(String, Vec<u8>)> = vec![
            (PAGE.into(), page.into_string().into_bytes()),
            (TABLE.into(), simulated.table.bytes.clone()),
            (SWEEP.into(), sweep_csv(simulated.judged())?),
        ];
        files.extend(figures.into_iter().map(|(name, figure)| (name.to_owned(), figure.svg.into_bytes())));
        let (units, names) = &simulated.units;
        let of_units = names.iter().zip(&units.figures);
        files.extend(of_units.map(|(name, figure)| ((*name).to_owned(), figure.svg.clone().into_bytes())));
        files.extend(of_production(production.as_ref())?);
        warnings.extend(output.strangers(&files));
        let files = output.write(&files)?;
        if self.scene.json {
            return print_json(&Report {
                title: scene.title.clone(),
                files,
                table_bytes: simulated.table.bytes.len(),
                worst_force_error_n: simulated.table.worst_error[0],
                ranges: ranges(simulated.judged()),
                levels: for_machines(simulated.judged()),
                population: simulated.population.statistics.clone(),
                uncertain: simulated.unknown,
                tolerance: production.map(|production| production.report),
                warnings,
            });
        }
        let page = output.page();
        print(&format!("{}\n\n{answer}Look at         {}", scene.title, page.display()))?;
        warn(&warnings);
        Ok(())
    }

    /// The opening with its table, and the stroke.
    fn simulate(&self, scene: &Scene, product: Option<&Product>) -> Result<Simulated, Failure> {
        let units = self.units.unwrap_or(UNITS);
        let duration = scene.stroke_duration().filter(|duration| *duration > scene.run.duration);
        let levels = scene.sweep.levels();
        let opening = force_table::levels(&scene.sweep).count;
        let production = DrawnProduction::new(scene, product, 0.0, DEFAULT.seed)
            .map_err(|error| Failure::Input(error.to_string()))?;
        let runs = opening + duration.map_or(0, |_| levels.len());
        let design = uncertain::design(scene.has_unknowns(), units, DEFAULT.seed)?;
        let all = units + design.map_or(0, |design| design.units());
        let bar = progress("simulating", runs + all as usize);
        let made = self.threads.install(|| {
            let (table, opening) = force_table::make(scene, Demand::Full, || bar.inc(1))?;
            let mut whole = scene.clone();
            whole.run.duration = duration.unwrap_or(scene.run.duration);
            let unit = |n| whole.level(n, whole.motion(1e-3));
            let stroke = duration.map(|_| sweep(&whole, &levels, Keep::Samples, unit, || bar.inc(1)));
            let duty = Duty { limit: None, stroke: whole.run.stroke };
            let population = Population::study(&whole, &production, units, duty, |units| bar.inc(units))?;
            let answer = |design| of_slide(&whole, &production, design, duty, |units| bar.inc(units));
            let unknown = design.map(answer).transpose()?;
            let mut units = page::units(&whole, &production, &population, None)?;
            if let Some(figure) = unknown_figure(&whole.title, unknown.as_ref())? {
                units.0.figures.push(figure);
                units.1.push(UNKNOWN_FIGURE);
            }
            Ok::<_, Failure>(Simulated { table, opening, stroke: stroke.transpose()?, population, units, unknown })
        })??;
        bar.finish_and_clear();
        Ok(made)
    }

    /// At most fifteen lines: what the product does at which levels, what closes first and how probable that is, what to
    /// change, and where to look.
    fn answer(&self, scene: &Scene, simulated: &Simulated, production: Option<&Production>) -> String {
        let mut text = answer(simulated.judged());
        text.push('\n');
        let units = simulated.of_units();
        text += &units.describe();
        let derived = derived(scene, 0.0);
        let closes = derived.first_to_close();
        if let Some((n, pairs)) = &closes {
            let _ = writeln!(text, "Closes first    {pairs}, at n* = {}", fixed(*n, 3));
        }
        let sums = production.map(|production| &production.report.sums[..]).unwrap_or_default();
        let likeliest = sums.iter().max_by(|one, other| one.model.dpm.total_cmp(&other.model.dpm));
        if let Some(sum) = likeliest {
            let [drawn, together] = [sum.model.dpm, sum.eq9_ppm].map(|ppm| per_million(ppm) + " ppm");
            let _ = writeln!(
                text,
                "No play left    {drawn} of the units by the drawing ({}); {together} if its gaps moved together (eq. 9)",
                sum.name
            );
        } else if let Some((n, _)) = closes {
            let together = per_million(1e6 * tail(n));
            let _ = writeln!(text, "No play left    {together} ppm of the units, if all gaps moved together (eq. 9)");
        }
        let _ = writeln!(text, "What to change  {}", advice(scene, simulated.judged(), units));
        let _ = writeln!(text, "Flash table     {}", table_line(scene, &simulated.table));
        if let Some(warning) = table::coarse(scene, &simulated.table) {
            let _ = writeln!(text, "                {warning}");
        }
        text
    }
}

/// What to change, by what goes wrong at which levels and with which `units`.
fn advice(scene: &Scene, sweep: &Sweep, units: Units) -> String {
    let guide = guide(scene, 0.0).filter(|guide| guide.warn);
    let how = match guide.map(|guide| guide.side) {
        Some(DriveSide::Edge) => "is on the edge of self-locking",
        _ => "self-locks",
    };
    let locks = guide.and_then(|guide| guide.critical_friction);
    match (nothing_wrong(sweep, Some(units), "state a stroke, such as run.stroke = 80"), locks) {
        (Some(nothing), _) => nothing,
        (None, Some(critical)) => format!(
            "bring friction well below {} (it is {}), lengthen the guide, or drive nearer to it: it {how}",
            fixed(critical, 3),
            scene.friction.coefficient()
        ),
        (None, None) => remedy(sweep, Some(units)),
    }
}

/// The pictures of the page and the files they go to.
fn figures(scene: &Scene, simulated: &Simulated) -> Result<Vec<(&'static str, Figure)>, Failure> {
    let title = &scene.title;
    let mut figures = Vec::new();
    if simulated.judged().levels.iter().any(|level| level.outcome.peak_force.is_some()) {
        let caption = "Each mark is a tolerance level: its shape says whether the slide runs, its height what force that takes. \
                       Behind: how a single gap of the production is distributed over n.";
        figures.push((FIGURES[0], captioned(caption, verdicts(simulated.judged(), title))?));
    }
    let caption = "The opening: how fast the slide moves while the drive starts. Compressed gaps are released in the first \
                   milliseconds; from the ramp's start on the slide breaks away, the earlier the less it takes.";
    figures.push((FIGURES[1], captioned(caption, velocities(&simulated.opening, title))?));
    let caption = "The opening: the force of the drive, which the flash table holds.";
    figures.push((FIGURES[2], captioned(caption, forces(&simulated.opening, title))?));
    if let Some(stroke) = &simulated.stroke {
        let caption = "The whole stroke: how fast the slide moves. A line that falls away is a slide that tips, slows or jams; \
                       one that ends early has come to the end of the stroke.";
        figures.push((FIGURES[3], captioned(caption, velocities(stroke, title))?));
        let caption = "The whole stroke: the force of the drive. It rises where the slide is slower than commanded.";
        figures.push((FIGURES[4], captioned(caption, forces(stroke, title))?));
    }
    Ok(figures)
}
