//! The main job of a mechanism: its run at every level.

use std::fmt::Write;

use serde::Serialize;
use slipfit_tolerance::{
    number::{fixed, per_million, ten_digits},
    numeric::normal,
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
        failure::Failure,
        mechanism,
        population::{
            page::{MECHANISM_FIGURES, UNKNOWN_FIGURE, units_of_mechanism, unknown_figure},
            uncertain::{design, warnings as warnings_of},
        },
        sweep::{LevelReport, doubts, for_machines},
        table,
        terminal::{print, print_json, progress, warn},
        tolerance::DEFAULT,
    },
    dynamics::{
        answer::{Range, ranges},
        driven::Driven,
        sweep::Sweep,
    },
    firmware::force_table::{self, Demand, ForceTable},
    mechanism::ByDrive,
    population::{
        mechanism::MechanismPopulation,
        production::Production as DrawnProduction,
        statistics::Statistics,
        study::Population,
        tally::Duty,
        uncertain::{answer::Answer, study::of_mechanism},
    },
    show::{
        export::sweep_csv,
        figure::{forces, velocities, verdicts},
        report::{Clearances, Figure, Flash, Production, ReportInput, report},
    },
};

/// The pictures: of a force, and of a torque.
const FIGURES: [&str; 5] = ["verdict.svg", "velocity.svg", "force.svg", "torque.svg", "mechanism.svg"];

#[derive(Serialize)]
struct Report {
    title: String,
    /// The drive's name.
    drive: String,
    /// N, or N·m of a drive that turns, whose forces, speeds and travel are torques, rad/s and rad.
    effort_unit: &'static str,
    files: Vec<String>,
    table_bytes: usize,
    worst_force_error_n: f64,
    /// The answer: neighbouring levels with the same verdict.
    ranges: Vec<Range>,
    levels: Vec<LevelReport>,
    /// What units drawn one by one do; none where no gap varies.
    population: Option<Statistics>,
    /// What the unknowns leave open of it; none without unknowns, or if no unit is drawn.
    uncertain: Option<Answer>,
    /// How the product's measures vary, as `slipfit tolerance --json` shows it.
    tolerance: Option<Measures>,
    warnings: Vec<String>,
}

impl Arguments {
    pub(super) fn run_mechanism(&self, driven: &ByDrive, product: Option<&Product>) -> Result<(), Failure> {
        self.written(
            driven,
            product,
            &[FIGURES.as_slice(), &MECHANISM_FIGURES, &[UNKNOWN_FIGURE]].concat(),
            |output, production| self.fill_with_mechanism(output, driven, product, production),
        )
    }

    fn fill_with_mechanism(
        &self,
        output: &Output,
        driven: &ByDrive,
        product: Option<&Product>,
        production: Option<Production>,
    ) -> Result<(), Failure> {
        let mechanism = driven.mechanism();
        let varies = mechanism.gaps.iter().any(|gap| gap.statistics.deviation > 0.0) || mechanism.has_unknowns();
        let units = if varies { self.units.unwrap_or(UNITS) } else { 0 };
        let drawn = DrawnProduction::of_mechanism(mechanism, product, 0.0, DEFAULT.seed)
            .map_err(|error| Failure::Input(error.to_string()))?;
        let design = design(mechanism.has_unknowns(), units, DEFAULT.seed)?;
        let all = units + design.map_or(0, |design| design.units());
        let bar = progress("simulating", force_table::levels(driven.levels()).count + all as usize);
        let ((table, sweep), found) = self.threads.install(|| {
            let made = force_table::make(driven, Demand::Full, || bar.inc(1))?;
            let duty = Duty { limit: None, stroke: mechanism.run.stroke };
            let found = varies.then(|| {
                let population = Population::study(driven, &drawn, units, duty, |units| bar.inc(units))?;
                let answer = |design| of_mechanism(driven, &drawn, design, duty, |units| bar.inc(units));
                let unknown = design.map(answer).transpose()?;
                let (mut shown, mut names) = units_of_mechanism(driven, &drawn, &population, None)?;
                if let Some(figure) = unknown_figure(driven.title(), unknown.as_ref())? {
                    shown.figures.push(figure);
                    names.push(UNKNOWN_FIGURE);
                }
                Ok::<_, Failure>(((population, unknown), (shown, names)))
            });
            Ok::<_, Failure>((made, found.transpose()?))
        })??;
        let (population, shown) = found.unzip();
        let (population, unknown) = population.unzip();
        let unknown: Option<Answer> = unknown.flatten();
        bar.finish_and_clear();
        let mut warnings = mechanism::warnings_of(driven.mechanism())?;
        warnings.extend(product.into_iter().flat_map(|product| product.warnings.clone()));
        warnings.extend(doubts(&sweep));
        warnings.extend(unknown.as_ref().map(warnings_of).transpose()?.unwrap_or_default());

        let answer = said(driven, &table, &sweep, population.as_ref(), unknown.as_ref());
        let figures = figures(driven, &sweep)?;
        let page = report(&ReportInput {
            title: driven.title(),
            sweep: &sweep,
            answer: &answer,
            figures: &figures.iter().map(|(_, figure)| figure.clone()).collect::<Vec<_>>(),
            clearances: Clearances::Joints(driven.mechanism()),
            flash: Some(Flash {
                bytes: table.bytes.len(),
                worst_force_error: table.worst_error_in_use[0],
                worst_velocity_error: table.worst_error_in_use[1],
            }),
            units: shown.as_ref().map(|(units, _)| units),
            production: production.as_ref(),
            notes: &warnings,
        });
        let mut files: Vec<(String, Vec<u8>)> = vec![
            (PAGE.into(), page.into_string().into_bytes()),
            (TABLE.into(), table.bytes.clone()),
            (SWEEP.into(), sweep_csv(&sweep)?),
        ];
        files.extend(figures.into_iter().map(|(name, figure)| (name.to_owned(), figure.svg.into_bytes())));
        if let Some((units, names)) = shown {
            let own = names.into_iter().zip(units.figures);
            files.extend(own.map(|(name, figure)| (name.to_owned(), figure.svg.into_bytes())));
        }
        files.extend(of_production(production.as_ref())?);
        warnings.extend(output.strangers(&files));
        let files = output.write(&files)?;
        if self.scene.json {
            return print_json(&Report {
                title: driven.title().to_owned(),
                drive: driven.name().to_owned(),
                effort_unit: driven.kind().effort_unit(),
                files,
                table_bytes: table.bytes.len(),
                worst_force_error_n: table.worst_error[0],
                ranges: ranges(&sweep),
                levels: for_machines(&sweep),
                population: population.map(|population| population.statistics),
                uncertain: unknown,
                tolerance: production.map(|production| production.report),
                warnings,
            });
        }
        print(&format!("{}\n\n{answer}Look at         {}", driven.title(), output.page().display()))?;
        warn(&warnings);
        Ok(())
    }
}

/// What the mechanism does at which levels, what closes first, what to change, and the table.
fn said(
    driven: &ByDrive,
    table: &ForceTable,
    sweep: &Sweep,
    population: Option<&MechanismPopulation>,
    unknown: Option<&Answer>,
) -> String {
    let mut text = answer(sweep);
    text.push('\n');
    let units =
        population.map(|found| Units { statistics: &found.statistics, of_malfunction: &found.of_malfunction, unknown });
    text += &units.map(|units| units.describe()).unwrap_or_default();
    if let Some((joint, n)) = driven.mechanism().first_to_close() {
        let closed = per_million(normal::tail(n) * 1e6);
        let _ = writeln!(
            text,
            "Closes first    {}, at n* = {}: {closed} ppm of the units, if all gaps moved together (eq. 9)",
            joint,
            fixed(n, 3)
        );
    }
    let change = nothing_wrong(sweep, units, "take a longer run.duration").unwrap_or_else(|| remedy(sweep, units));
    let _ = writeln!(text, "What to change  {change}");
    let _ = writeln!(text, "Flash table     {}", table_line(driven, table));
    if let Some(warning) = table::coarse(driven, table) {
        let _ = writeln!(text, "                {warning}");
    }
    text
}

/// The pictures of the page and the files they go to.
fn figures(driven: &ByDrive, sweep: &Sweep) -> Result<Vec<(&'static str, Figure)>, Failure> {
    let title = driven.title();
    let (name, kind) = (driven.name(), driven.kind());
    let mut figures = Vec::new();
    if sweep.levels.iter().any(|level| level.outcome.peak_force.is_some()) {
        let caption = format!(
            "Each mark is a tolerance level: its shape says whether \"{name}\" runs, its height what {} that takes. \
             Behind: how a single gap of the production is distributed over n.",
            kind.effort()
        );
        figures.push((FIGURES[0], captioned(&caption, verdicts(sweep, title))?));
    }
    let caption = format!("How fast \"{name}\" moves what it drives, over time.");
    figures.push((FIGURES[1], captioned(&caption, velocities(sweep, title))?));
    let effort = kind.effort();
    let caption = format!(
        "The {effort} of \"{name}\" over time, which the flash table holds. Peaks count from the ramp's start at {} ms on; before \
         it the bodies settle in their gaps.",
        ten_digits(driven.drive().ramp_start * 1e3)
    );
    figures.push((kind.choose(FIGURES[2], FIGURES[3]), captioned(&caption, forces(sweep, title))?));
    let caption = "Bodies, joints and drives in the drawn pose, bodies by their letters and joints by their numbers; a hole around \
                   a pin, or walls beside one, are joints with play.";
    figures.push((FIGURES[4], captioned(caption, Ok(driven.mechanism().drawing()))?));
    Ok(figures)
}
