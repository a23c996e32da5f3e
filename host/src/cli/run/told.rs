//! What `run` says and shows of all that it simulated.

use std::fmt::Write;

use serde::Serialize;
use slipfit_tolerance::{
    number::{fixed, per_million, ten_digits},
    numeric::normal::tail,
    product::Product,
    report::Report as Measures,
};

use super::{
    Arguments,
    advice::{nothing_wrong, remedy},
    answer,
    output::{Output, PAGE, SWEEP, TABLE, captioned, of_production},
    simulated::{OfProduction, Simulated},
    table_line,
};
use crate::{
    cli::{
        by_one_drive::{ByOneDrive, FINER, why_undecided},
        failure::Failure,
        population::uncertain,
        sweep::{LevelReport, doubts, for_machines},
        table,
        terminal::{print, print_json, warn},
    },
    dynamics::{
        answer::{Range, ranges},
        outcome::Verdict,
        sweep::Level,
    },
    mechanism::self_locking::DriveSide,
    population::{statistics::Statistics, uncertain::answer::Answer},
    show::{
        export::of_sweep,
        figure::{forces, velocities, verdicts},
        report::{Figure, Flash, Production, ReportInput, report},
    },
};

#[derive(Serialize)]
struct Report<'a> {
    title: &'a str,
    /// The drive's name.
    drive: &'a str,
    /// N, or N·m of a drive that turns, whose forces, speeds and travel are torques, rad/s and rad.
    effort_unit: &'static str,
    files: Vec<String>,
    table_bytes: usize,
    worst_force_error_n: f64,
    /// The answer: neighbouring levels with the same verdict.
    ranges: Vec<Range>,
    /// The whole stroke, or the run where no longer stroke is stated.
    levels: Vec<LevelReport>,
    /// What units drawn one by one do, as `slipfit population --json` shows it; none where nothing varies.
    population: Option<Statistics>,
    /// What the unknowns leave open of it; none without unknowns.
    uncertain: Option<Answer>,
    /// How the product's measures vary, as `slipfit tolerance --json` shows it.
    tolerance: Option<Measures>,
    warnings: Vec<String>,
}

impl Arguments {
    pub(super) fn fill(
        &self,
        output: &Output,
        of: &ByOneDrive,
        product: Option<&Product>,
        production: Option<Production>,
    ) -> Result<(), Failure> {
        let simulated = self.simulate(of, product)?;
        let subject = of.subject();
        let mut warnings = warnings(of, &simulated)?;
        if self.units.is_some() && simulated.production.is_none() {
            warnings.push("--units: nothing varies, so that no units of the production were simulated".into());
        }
        warnings.extend(product.into_iter().flat_map(|product| product.warnings.clone()));

        let answer = said(of, &simulated, production.as_ref());
        let figures = figures(of, &simulated)?;
        let Simulated { table, production: units, .. } = &simulated;
        let [worst_force_error, worst_velocity_error] = table.worst_error_in_use;
        let page = report(&ReportInput {
            title: &of.title(),
            sweep: simulated.judged(),
            answer: &answer,
            figures: &figures.iter().map(|(_, figure)| figure.clone()).collect::<Vec<_>>(),
            clearances: of.clearances(),
            flash: Some(Flash { bytes: table.bytes.len(), worst_force_error, worst_velocity_error }),
            units: units.as_ref().map(|units| &units.shown.0),
            production: production.as_ref(),
            notes: &warnings,
        });
        let mut files: Vec<(String, Vec<u8>)> = vec![
            (PAGE.into(), page.into_string().into_bytes()),
            (TABLE.into(), table.bytes.clone()),
            (SWEEP.into(), of_sweep(simulated.judged()).to_csv()?),
        ];
        files.extend(figures.into_iter().map(|(name, figure)| (name, figure.svg.into_bytes())));
        if let Some(OfProduction { shown: (units, names), .. }) = units {
            let of_units = names.iter().zip(&units.figures);
            files.extend(of_units.map(|(name, figure)| ((*name).to_owned(), figure.svg.clone().into_bytes())));
        }
        files.extend(of_production(production.as_ref())?);
        warnings.extend(output.strangers(&files));
        let files = output.write(&files)?;
        if self.scene.json {
            let (ranges, levels) = (ranges(simulated.judged()), for_machines(simulated.judged()));
            let (population, uncertain) = simulated.production.map(|of| (of.population.statistics, of.unknown)).unzip();
            return print_json(&Report {
                title: subject.title(),
                drive: of.drive_name(),
                effort_unit: subject.kind().effort_unit(),
                files,
                table_bytes: simulated.table.bytes.len(),
                worst_force_error_n: simulated.table.worst_error[0],
                ranges,
                levels,
                population,
                uncertain: uncertain.flatten(),
                tolerance: production.map(|production| production.report),
                warnings,
            });
        }
        print(&format!("{}\n\n{answer}Look at         {}", of.title(), output.page().display()))?;
        warn(&warnings);
        Ok(())
    }
}

fn warnings(of: &ByOneDrive, simulated: &Simulated) -> Result<Vec<String>, Failure> {
    let (subject, judged) = (of.subject(), simulated.judged());
    let mut warnings = of.warnings()?;
    warnings.extend(doubts(judged));
    let unknown = simulated.units().and_then(|units| units.unknown);
    warnings.extend(unknown.map(uncertain::warnings).transpose()?.unwrap_or_default());
    // Doubts say why the others have none.
    let is_unexplained = |level: &Level| level.outcome.verdict == Verdict::Undecided && level.doubts.is_empty();
    if judged.levels.iter().any(is_unexplained) {
        let longer = of.longer();
        let why = why_undecided(of.or_longer(&longer).subject(), None, FINER);
        warnings.push(format!("not every level comes to a verdict{why}"));
    }
    if subject.run().stroke.is_none() && of.has_opening() {
        warnings.push(
            "the scene states no stroke, so that its verdicts depend on run.duration; state one, such as run.stroke = 80"
                .into(),
        );
    }
    Ok(warnings)
}

/// At most fifteen lines: what the product does at which levels, what closes first and how probable that is, what to
/// change, and where to look.
fn said(of: &ByOneDrive, simulated: &Simulated, production: Option<&Production>) -> String {
    let (subject, judged) = (of.subject(), simulated.judged());
    let mut text = answer(judged);
    text.push('\n');
    let units = simulated.units();
    text += &units.map(|units| units.describe()).unwrap_or_default();
    let closes = of.first_to_close();
    if let Some((n, which)) = &closes {
        let _ = writeln!(text, "Closes first    {which}, at n* = {}", fixed(*n, 3));
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
    let locks = of.locks();
    let change = match (nothing_wrong(judged, units, of.how_to_run_longer()), locks) {
        (Some(nothing), _) => nothing,
        (None, Some((friction, critical, side))) => {
            let how = if side == DriveSide::Edge { "is on the edge of self-locking" } else { "self-locks" };
            format!(
                "bring friction well below {} (it is {friction}), lengthen the guide, or drive nearer to it: it {how}",
                fixed(critical, 3)
            )
        }
        (None, None) => remedy(judged, units),
    };
    let _ = writeln!(text, "What to change  {change}");
    let _ = writeln!(text, "Flash table     {}", table_line(subject, &simulated.table));
    if let Some(warning) = table::coarse(subject, &simulated.table) {
        let _ = writeln!(text, "                {warning}");
    }
    text
}

/// The pictures of the page and the files they go to.
fn figures(of: &ByOneDrive, simulated: &Simulated) -> Result<Vec<(String, Figure)>, Failure> {
    let subject = of.subject();
    let (title, kind) = (subject.title(), subject.kind());
    let effort = kind.effort();
    let mut figures = Vec::new();
    let mut add = |name: &str, caption: &str, svg| {
        figures.push((format!("{name}.svg"), captioned(caption, svg)?));
        Ok::<_, Failure>(())
    };
    if simulated.judged().levels.iter().any(|level: &Level| level.outcome.peak_force.is_some()) {
        let caption = format!(
            "Each mark is a tolerance level: its shape says whether the unit runs, its height what {effort} that takes. Behind: how a \
             single gap of the production is distributed over n."
        );
        add("verdict", &caption, verdicts(simulated.judged(), title))?;
    }
    let (opening, whose) = match simulated.stroke {
        Some(_) => ("opening-", "The opening: "),
        None => ("", ""),
    };
    let starts = ten_digits(subject.drive().ramp_start * 1e3);
    let caption = format!(
        "{whose}how fast the drive moves what it drives. Compressed gaps are released in the first milliseconds; from the ramp's start \
         at {starts} ms on it breaks away, the earlier the less it takes."
    );
    add(&format!("{opening}velocity"), &sentence(&caption), velocities(&simulated.tabled, title))?;
    let caption = format!("{whose}the {effort} of the drive over time, which the flash table holds.");
    add(&format!("{opening}{effort}"), &sentence(&caption), forces(&simulated.tabled, title))?;
    if let Some(stroke) = &simulated.stroke {
        let caption = "The whole stroke: how fast the slide moves. A line that falls away is a slide that tips, slows or jams; \
                       one that ends early has come to the end of the stroke.";
        add("stroke-velocity", caption, velocities(stroke, title))?;
        let caption =
            format!("The whole stroke: the {effort} of the drive. It rises where the slide is slower than commanded.");
        add(&format!("stroke-{effort}"), &caption, forces(stroke, title))?;
    }
    if let Some(drawing) = of.drawing() {
        let caption = "Bodies, joints and drives in the drawn pose, bodies by their letters and joints by their numbers; a hole around \
                       a pin, or walls beside one, are joints with play.";
        add("mechanism", caption, Ok(drawing))?;
    }
    Ok(figures)
}

/// With a capital letter.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + letters.as_str())
}
