//! What `population` says of a mechanism.

use std::{fmt::Write, path::PathBuf};

use rayon::prelude::*;
use serde::Serialize;

use super::warnings_of;
use crate::{
    cli::{
        Failure, SceneArguments, ThreadArguments, given,
        population::{LEVELS, LevelReport, UnitReport, WORST, percent, strongest},
        print, print_json, progress, text_table, warn,
    },
    dynamics::{answer::ranges_of, driven::Driven},
    mechanism::{ByDrive, Mechanism},
    population::{
        Unit, UnitOutcome,
        drivers::Driver,
        mechanism::{MechanismPopulation, study, unit},
        picture::{forces, joint_tightness},
        production::Production,
        statistics::{Share, Spread, Statistics},
        telling::worst,
    },
    product::Product,
    show::{
        export::population_csv,
        number::{fixed, level, or_dash},
        plot::PlotError,
    },
    system::files,
};

/// What is asked for.
pub struct Asked<'a> {
    pub scene: &'a SceneArguments,
    pub units: u64,
    pub seed: u64,
    pub limit: Option<f64>,
    pub correlation: f64,
    pub csv: &'a Option<PathBuf>,
    pub plot: &'a Option<PathBuf>,
    pub threads: &'a ThreadArguments,
}

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
    /// Units that cannot be assembled.
    misfits: Share,
    levels: Vec<LevelReport>,
    worst: Vec<UnitReport>,
    warnings: Vec<String>,
}

/// The `units` of `mechanism`, each with its tightness.
pub fn placed<'u>(
    mechanism: &Mechanism,
    units: impl IntoIterator<Item = &'u Unit<Vec<f64>>>,
) -> Vec<(f64, &'u Unit<Vec<f64>>)> {
    units.into_iter().map(|unit| (joint_tightness(mechanism.levels_of(&unit.gaps)), unit)).collect()
}

/// The greatest force or torque of the `placed` units over their tightness; `limit` (N, N·m) is the motor's greatest.
pub fn picture(driven: &ByDrive, placed: &[(f64, &Unit<Vec<f64>>)], limit: Option<f64>) -> Result<String, PlotError> {
    let effort = format!("greatest {} ({})", driven.kind().effort(), driven.kind().effort_unit());
    forces(driven.title(), &effort, placed, limit)
}

/// `population`.
pub fn population(driven: &ByDrive, product: Option<&Product>, asked: &Asked) -> Result<(), Failure> {
    let mechanism = driven.mechanism();
    let Asked { units, seed, limit, correlation, .. } = *asked;
    asked.scene.check_outputs(&given([("--csv", asked.csv), ("--plot", asked.plot)]))?;
    let production = Production::of_mechanism(mechanism, product, correlation, seed)
        .map_err(|error| Failure::Input(error.to_string()))?;
    let bar = progress("simulating", units as usize);
    let (found, levels) = asked.threads.install(|| {
        let found = study(driven, &production, units, limit, |units| bar.inc(units))?;
        let at = |n: &f64| {
            // A level at which a pin is wider than its hole is no unit.
            let gaps = mechanism.gaps_at(&[*n]).ok()?;
            Some(unit(driven, &gaps).map(|outcome| (*n, outcome)))
        };
        let levels: Vec<_> = LEVELS.par_iter().filter_map(at).collect::<Result<_, _>>()?;
        Ok::<_, Failure>((found, levels))
    })??;
    bar.finish_and_clear();
    let misfits = found.units.iter().filter(|unit| mechanism.misfit(&unit.gaps).is_some()).count() as u64;
    let misfits = Share::new(misfits, units);
    let mut warnings = warnings_of(mechanism)?;
    warnings.extend(product.into_iter().flat_map(|product| product.warnings.iter().cloned()));
    if misfits.units > 0 {
        warnings.push(format!(
            "{} of {units} units cannot be assembled, because a pin is wider than its hole: they count as jammed",
            misfits.units
        ));
    }
    let placed = placed(mechanism, &found.units);
    if let Some(path) = asked.csv {
        files::write(path, &population_csv(driven.kind(), &driven.gap_names(), &placed)?)?;
    }
    if let Some(path) = asked.plot {
        let svg = picture(driven, &placed, limit).map_err(anyhow::Error::from)?;
        files::write(path, svg.as_bytes())?;
    }
    if asked.scene.json {
        let of_unit = |unit: &Unit<Vec<f64>>| UnitReport {
            number: unit.number,
            tightness: joint_tightness(mechanism.levels_of(&unit.gaps)),
            outcome: unit.outcome,
        };
        return print_json(&Report {
            title: &mechanism.title,
            drive: driven.name(),
            effort_unit: driven.kind().effort_unit(),
            seed,
            levels: levels.iter().map(|(n, outcome)| LevelReport::new(*n, outcome, &found.units)).collect(),
            worst: worst(&found.units, WORST).into_iter().map(of_unit).collect(),
            statistics: found.statistics,
            force_drivers: found.of_force,
            malfunction_drivers: found.of_malfunction,
            misfits,
            warnings,
        });
    }
    print(&described(driven, &found, &levels, limit))?;
    warn(&warnings);
    Ok(())
}

fn described(
    driven: &ByDrive,
    found: &MechanismPopulation,
    levels: &[(f64, UnitOutcome)],
    limit: Option<f64>,
) -> String {
    let (mechanism, kind) = (driven.mechanism(), driven.kind());
    let (effort, unit) = (kind.effort(), kind.effort_unit());
    let statistics = &found.statistics;
    let mut text = format!(
        "{}: {} units, {} ms, by {}\n\nMalfunction     {}\n",
        mechanism.title,
        statistics.units,
        fixed(mechanism.run.duration * 1e3, 0),
        driven.name(),
        percent(&statistics.malfunctions)
    );
    let Statistics { runs, crawls, jammed, undecided, .. } = *statistics;
    for (name, share) in [("runs", runs), ("crawls", crawls), ("jammed", jammed), ("undecided", undecided)] {
        if share.units > 0 {
            let _ = writeln!(text, "  {name:14}{}", percent(&share));
        }
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
    for (name, drivers) in
        [(format!("Drives {effort}"), &found.of_force), ("Drives failure".into(), &found.of_malfunction)]
    {
        let _ = writeln!(text, "{name:16}{}", strongest(drivers, DRIVERS));
    }
    let verdicts: Vec<_> = levels.iter().map(|(n, outcome)| (*n, outcome.verdict)).collect();
    let _ = writeln!(text, "Levels          {}", ranges_of(&verdicts).join("; "));
    let heading = match statistics.malfunctions.units {
        0 => format!("None malfunctions; the greatest {effort}s"),
        _ => "The worst".to_owned(),
    };
    let row = |one: &Unit<Vec<f64>>| {
        let outcome = one.outcome;
        vec![
            one.number.to_string(),
            level((joint_tightness(mechanism.levels_of(&one.gaps)) * 100.0).round() / 100.0),
            outcome.verdict.to_string(),
            or_dash(outcome.peak_force, |force| fixed(force, 4)),
            fixed(kind.speed(outcome.final_velocity), 3),
            fixed(kind.travel(outcome.end.z), 2),
        ]
    };
    let rows: Vec<_> = worst(&found.units, WORST).into_iter().map(row).collect();
    let columns = [
        "unit",
        "n",
        "verdict",
        &format!("peak, {unit}"),
        &format!("final, {}", kind.speed_unit()),
        &format!("travel, {}", kind.travel_unit()),
    ];
    text + &format!("\n{heading}\n{}", text_table(&columns, &rows))
}
