//! What `population` says of a mechanism.

use std::fmt::Write;

use serde::Serialize;
use slipfit_system::files;
use slipfit_tolerance::{
    number::{fixed, level, or_dash, ten_digits},
    product::Product,
};

use super::warnings_of;
use crate::{
    cli::{
        failure::Failure,
        population::{
            asked::{Arguments, HYPOTHESIS},
            page::{units_of_mechanism, unknown_figure},
            rare,
            reports::{LevelReport, UnitReport},
            uncertain,
            words::{faults, levels, malfunction, percent, strongest, verdicts, worst},
        },
        terminal::{print, print_json, text_table, warn},
    },
    dynamics::driven::{DriveKind, Driven},
    mechanism::ByDrive,
    population::{
        Unit,
        drivers::Driver,
        hypothesis::Hypothesis,
        mechanism::MechanismPopulation,
        production::Production,
        rare::Rare,
        statistics::{Spread, Statistics},
        study::Population,
        subject::Subject,
        tally::Tally,
        uncertain::answer::Answer,
    },
    show::{
        report::{Figure, units_page},
        units::{forces, hypothesis},
    },
};

/// Random combinations at each distance: fewer than of a slide, whose units take less time.
const DIRECTIONS: u64 = 128;
/// Drivers that are listed.
const DRIVERS: usize = 5;

#[derive(Serialize)]
struct Report<'a> {
    title: &'a str,
    drive: &'a str,
    /// N, or N·m of a drive that turns.
    effort_unit: &'static str,
    seed: u64,
    statistics: Statistics,
    force_drivers: Vec<Driver>,
    malfunction_drivers: Vec<Driver>,
    /// None if everything is known.
    uncertain: Option<Answer>,
    levels: Vec<LevelReport>,
    hypothesis: Hypothesis,
    /// None if it was not asked for.
    rare: Option<Rare>,
    worst: Vec<UnitReport>,
    warnings: Vec<String>,
}

/// All that was found.
struct Found {
    population: MechanismPopulation,
    levels: Vec<LevelReport>,
    hypothesis: Hypothesis,
    rare: Option<Rare>,
    /// What the unknowns leave open.
    unknown: Option<Answer>,
}

impl Found {
    /// Of all units of a `production`, counted in `tally`.
    fn of(
        asked: &Arguments,
        driven: &ByDrive,
        production: &Production<Vec<f64>>,
        tally: Tally<Vec<f64>>,
        unknown: Option<Answer>,
    ) -> Result<Self, Failure> {
        let population = Population::of(production, tally, asked.duty_of_mechanism(driven.mechanism()));
        let levels = LevelReport::all(driven, &population.tally)?;
        let hypothesis = Hypothesis::test(driven, DIRECTIONS, asked.seed, asked.force_limit)?;
        let rare = asked.rare.then(|| asked.estimate(driven, production, &population)).transpose()?;
        Ok(Self { population, levels, hypothesis, rare, unknown })
    }
}

/// Shows and writes what all units of a mechanism, counted in `tally`, did.
pub fn conclude(
    asked: &Arguments,
    driven: &ByDrive,
    production: &Production<Vec<f64>>,
    tally: Tally<Vec<f64>>,
    unknown: Option<Answer>,
    product: Option<&Product>,
) -> Result<(), Failure> {
    let mechanism = driven.mechanism();
    let limit = asked.force_limit;
    let found = asked.threads.install(|| Found::of(asked, driven, production, tally, unknown))??;
    let mut warnings = warnings_of(mechanism)?;
    warnings.extend(product.into_iter().flat_map(|product| product.warnings.iter().cloned()));
    warnings.extend(faults(driven, production, &found.population)?);
    warnings.extend(found.unknown.as_ref().map(uncertain::warnings).transpose()?.unwrap_or_default());
    if let Some(path) = &asked.plot {
        let svg = forces(driven, &found.population.tally, limit).map_err(anyhow::Error::from)?;
        files::write(path, svg.as_bytes())?;
    }
    if let Some(path) = &asked.plot_distance {
        let svg = hypothesis(driven.title(), &found.hypothesis).map_err(anyhow::Error::from)?;
        files::write(path, svg.as_bytes())?;
    }
    if let Some(path) = &asked.page {
        let (mut page, _) =
            asked.threads.install(|| units_of_mechanism(driven, production, &found.population, limit))??;
        let svg = hypothesis(driven.title(), &found.hypothesis);
        page.figures.push(Figure { caption: HYPOTHESIS.into(), svg: svg.map_err(anyhow::Error::from)? });
        page.figures.extend(unknown_figure(driven.title(), found.unknown.as_ref())?);
        let words = summary(driven, &found, limit);
        files::write(path, units_page(&mechanism.title, &words, &page, &warnings).into_string().as_bytes())?;
    }
    if asked.scene.json {
        return print_json(&Report {
            title: &mechanism.title,
            drive: driven.name(),
            effort_unit: driven.kind().effort_unit(),
            seed: asked.seed,
            worst: UnitReport::worst(driven, &found.population.tally),
            levels: found.levels,
            hypothesis: found.hypothesis,
            rare: found.rare,
            statistics: found.population.statistics,
            force_drivers: found.population.of_force,
            malfunction_drivers: found.population.of_malfunction,
            uncertain: found.unknown,
            warnings,
        });
    }
    print(&described(driven, &found, limit))?;
    warn(&warnings);
    Ok(())
}

/// What the units did together.
fn summary(driven: &ByDrive, found: &Found, limit: Option<f64>) -> String {
    let (mechanism, kind) = (driven.mechanism(), driven.kind());
    let (effort, unit) = (kind.effort(), kind.effort_unit());
    let statistics = &found.population.statistics;
    let mut text = format!(
        "{}: {} units, {} ms, by {}\n\n",
        mechanism.title,
        statistics.units,
        fixed(mechanism.run.duration * 1e3, 0),
        driven.name(),
    );
    text += &found.unknown.as_ref().map(|answer| uncertain::before(answer, kind)).unwrap_or_default();
    let _ = writeln!(text, "Malfunction     {}", malfunction(statistics));
    text += &verdicts(statistics);
    let Statistics { undecided, unsolved, out_of_bounds, .. } = *statistics;
    // Warnings name the others.
    if undecided.units > unsolved + out_of_bounds {
        let _ = writeln!(text, "                undecided{}", why_undecided(driven));
    }
    if let (Some(share), Some(limit)) = (statistics.over_limit, limit) {
        let name = format!("  over {limit} {unit} ");
        let _ = writeln!(text, "{name:16}{}", percent(&share));
    }
    if let Some(level) = statistics.sigma_level {
        let _ = writeln!(text, "Sigma level     {} σ, one-sided", fixed(level, 2));
    }
    let peak = format!("Peak {effort}");
    for (name, spread) in [(peak.as_str(), &statistics.peak_force), ("  that run", &statistics.running_force)] {
        if let Some(Spread { quantiles: [least, low, median, high, most], .. }) = spread {
            let [least, low, median, high, most] = [least, low, median, high, most].map(|value| fixed(*value, 4));
            let _ = writeln!(
                text,
                "{name:16}{median} {unit} at the median; 90 % of the units {low} to {high} {unit}, all {least} to {most} {unit}"
            );
        }
    }
    for (name, drivers) in [
        (if kind == DriveKind::Turns { "Torque due to" } else { "Force due to" }, &found.population.of_force),
        ("Failure due to", &found.population.of_malfunction),
    ] {
        let _ = writeln!(text, "{name:16}{}", strongest(drivers, DRIVERS));
    }
    if driven.has_levels() {
        let _ = writeln!(text, "Levels n        {}", levels(&found.levels));
        let _ = writeln!(text, "Hypothesis      {}", found.hypothesis.verdict());
    }
    text + &found.rare.as_ref().map(rare::describe).unwrap_or_default()
}

/// A remark behind undecided units.
fn why_undecided(driven: &ByDrive) -> String {
    let mechanism = driven.mechanism();
    let setpoint = mechanism.drives[driven.index()].setpoint();
    let [ends, command] = [mechanism.run.duration, setpoint.end()].map(|t| ten_digits(t * 1e3));
    if mechanism.run.duration < setpoint.end() {
        let longer = ten_digits((setpoint.end() + 0.5) * 1e3);
        format!(": the run ends at {ends} ms, what is commanded at {command} ms; --set run.duration={longer} runs on")
    } else if setpoint.settled_at(mechanism.run.duration) == 0.0 {
        ": nothing is commanded at the end of the run".into()
    } else {
        ": a finer run came to another verdict; take a tenth of run.error".into()
    }
}

/// The answer, for people: what the units did together, and the worst of them.
fn described(driven: &ByDrive, found: &Found, limit: Option<f64>) -> String {
    let kind = driven.kind();
    let (effort, unit) = (kind.effort(), kind.effort_unit());
    let heading = worst(&found.population.statistics, effort);
    let row = |one: &Unit<Vec<f64>>| {
        let outcome = one.outcome;
        vec![
            one.number.to_string(),
            level((driven.tightness(&one.gaps) * 100.0).round() / 100.0),
            outcome.verdict.to_string(),
            or_dash(outcome.peak_force, |force| fixed(force, 4)),
            fixed(kind.speed(outcome.final_velocity), 3),
            fixed(kind.travel(outcome.end.z), 2),
        ]
    };
    let rows: Vec<_> = found.population.tally.worst.iter().map(row).collect();
    let columns = [
        "unit",
        "tightness",
        "verdict",
        &format!("peak, {unit}"),
        &format!("final, {}", kind.speed_unit()),
        &format!("travel, {}", kind.travel_unit()),
    ];
    format!("{}\n{heading}\n{}", summary(driven, found, limit), text_table(&columns, &rows))
}
