//! What all units of a production did, for people and machines.

use std::fmt::Write;

use serde::Serialize;
use slipfit_system::files;
use slipfit_tolerance::{
    number::{fixed, level, or_dash},
    product::Product,
};

use super::{
    asked::{Arguments, HYPOTHESIS},
    page::{self, unknown_figure},
    rare,
    reports::{LevelReport, UnitReport},
    uncertain,
    words::{faults, levels, malfunction, percent, strongest, verdicts, worst},
};
use crate::{
    cli::{
        by_one_drive::{ByOneDrive, FINER, why_undecided},
        call,
        failure::Failure,
        terminal::{print, print_json, text_table, warn},
    },
    dynamics::driven::DriveKind,
    population::{
        Unit,
        drivers::Driver,
        hypothesis::Hypothesis,
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
        units,
    },
};

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
    population: Population,
    levels: Vec<LevelReport>,
    hypothesis: Hypothesis,
    rare: Option<Rare>,
    /// What the unknowns leave open.
    unknown: Option<Answer>,
}

impl Arguments {
    /// Shows and writes what all units, counted in `tally`, did.
    pub fn conclude(
        &self,
        of: &ByOneDrive,
        production: &Production,
        tally: Tally,
        unknown: Option<Answer>,
        product: Option<&Product>,
    ) -> Result<(), Failure> {
        let subject = of.subject();
        let title = subject.title();
        let found = self.threads.install(|| self.find(subject, production, tally, unknown))??;
        let mut warnings = of.warnings()?;
        warnings.extend(product.into_iter().flat_map(|product| product.warnings.iter().cloned()));
        warnings.extend(faults(subject, production, &found.population)?);
        warnings.extend(found.unknown.as_ref().map(uncertain::warnings).transpose()?.unwrap_or_default());
        call::picture(self.plot.as_deref(), "forces", || {
            units::forces(subject, &found.population.tally, self.force_limit)
        })?;
        let distances = || units::hypothesis(title, &found.hypothesis).map_err(anyhow::Error::from);
        if let Some(path) = &self.plot_distance {
            files::write(path, distances()?.as_bytes())?;
        }
        if let Some(path) = &self.page {
            let drawn = || page::units(of, production, &found.population, self.force_limit);
            let (mut shown, _) = self.threads.install(drawn)??;
            shown.figures.push(Figure { caption: HYPOTHESIS.into(), svg: distances()? });
            shown.figures.extend(unknown_figure(title, found.unknown.as_ref())?);
            let words = self.summary(of, &found);
            files::write(path, units_page(title, &words, &shown, &warnings).into_string().as_bytes())?;
        }
        if self.scene.json {
            let worst = UnitReport::worst(subject, &found.population.tally);
            let Population { statistics, of_force, of_malfunction, .. } = found.population;
            return print_json(&Report {
                title,
                drive: of.drive_name(),
                effort_unit: subject.kind().effort_unit(),
                seed: self.seed,
                statistics,
                force_drivers: of_force,
                malfunction_drivers: of_malfunction,
                uncertain: found.unknown,
                levels: found.levels,
                hypothesis: found.hypothesis,
                rare: found.rare,
                worst,
                warnings,
            });
        }
        let heading = worst(&found.population.statistics, subject.kind().effort());
        let units = worst_units(subject, &found.population.tally.worst);
        print(&format!("{}\n{heading}\n{units}", self.summary(of, &found)))?;
        warn(&warnings);
        Ok(())
    }

    fn find(
        &self,
        subject: &dyn Subject,
        production: &Production,
        tally: Tally,
        unknown: Option<Answer>,
    ) -> Result<Found, Failure> {
        let population = Population::of(production, tally, self.duty_of(subject));
        let levels = LevelReport::all(subject, &population.tally)?;
        let hypothesis = Hypothesis::test(subject, subject.combinations(), self.seed, self.force_limit)?;
        let rare = self.rare.then(|| self.estimate(subject, production, &population)).transpose()?;
        Ok(Found { population, levels, hypothesis, rare, unknown })
    }

    /// What the units did together.
    fn summary(&self, of: &ByOneDrive, found: &Found) -> String {
        let (subject, kind) = (of.subject(), of.subject().kind());
        let Population { statistics, of_force, of_malfunction, .. } = &found.population;
        let Statistics { units, undecided, over_limit, sigma_level, unsolved, out_of_bounds, .. } = *statistics;
        let length = match self.duty_of(subject).stroke {
            Some(stroke) => format!("the stroke of {} {}", fixed(kind.travel(stroke), 1), kind.travel_unit()),
            None => format!("{} ms", fixed(subject.run().duration * 1e3, 0)),
        };
        let mut text = format!("{}: {units} units, {length}", subject.title());
        if of.has_other_drives() {
            let _ = write!(text, ", by {}", of.drive_name());
        }
        text += "\n\n";
        text += &found.unknown.as_ref().map(|answer| uncertain::before(answer, kind)).unwrap_or_default();
        let _ = writeln!(text, "Malfunction     {}", malfunction(statistics));
        text += &verdicts(statistics);
        // Warnings name the others.
        if undecided.units > unsolved + out_of_bounds {
            let why = match self.opening {
                true => {
                    ": the opening ends before the ramp does; without --opening the whole stroke is simulated".into()
                }
                false => why_undecided(subject, None, FINER),
            };
            let _ = writeln!(text, "                undecided{why}");
        }
        let unit = kind.effort_unit();
        if let (Some(share), Some(limit)) = (over_limit, self.force_limit) {
            let name = format!("  over {limit} {unit} ");
            let _ = writeln!(text, "{name:16}{}", percent(&share));
        }
        if let Some(level) = sigma_level {
            let _ = writeln!(
                text,
                "Sigma level     {} σ, one-sided: the normal quantile of the share that does its job",
                fixed(level, 2)
            );
        }
        let peak = format!("Peak {}", kind.effort());
        for (name, spread) in [(peak.as_str(), &statistics.peak_force), ("  that run", &statistics.running_force)] {
            if let Some(Spread { quantiles, .. }) = spread {
                let [least, low, median, high, most] = quantiles.map(|value| fixed(value, decimals(kind)));
                let _ = writeln!(
                    text,
                    "{name:16}{median} {unit} at the median; 90 % of the units {low} to {high} {unit}, all {least} to {most} {unit}"
                );
            }
        }
        for (name, drivers) in
            [(kind.choose("Force due to", "Torque due to"), of_force), ("Failure due to", of_malfunction)]
        {
            let _ = writeln!(text, "{name:16}{}", strongest(drivers, DRIVERS));
        }
        if subject.has_levels() {
            let _ = writeln!(text, "Levels n        {}", levels(&found.levels));
            let _ = writeln!(text, "Hypothesis      {}", found.hypothesis.verdict());
        }
        text + &found.rare.as_ref().map(rare::describe).unwrap_or_default()
    }
}

/// Digits after the point of forces (N) and torques (N·m).
fn decimals(kind: DriveKind) -> usize {
    kind.choose(3, 4)
}

/// The table of the worst units.
fn worst_units(subject: &dyn Subject, units: &[Unit]) -> String {
    let (kind, names) = (subject.kind(), subject.gap_names());
    let has_contacts = units.iter().any(|unit| unit.outcome.most_loaded.is_some());
    let row = |unit: &Unit| {
        let outcome = unit.outcome;
        let name = |gap: usize| names.get(gap).map_or("-", String::as_str);
        let loaded = |(gap, force): (usize, f64)| format!("{} ({} N)", name(gap), fixed(force, 2));
        let mut row = vec![
            unit.number.to_string(),
            level((subject.tightness(&unit.gaps) * 100.0).round() / 100.0),
            outcome.verdict.to_string(),
            or_dash(outcome.peak_force, |force| fixed(force, decimals(kind))),
            fixed(kind.speed(outcome.final_velocity), 3),
            fixed(kind.travel(outcome.end.z), 2),
            or_dash(outcome.breakaway, |t| fixed(t * 1e3, 1)),
        ];
        row.extend(has_contacts.then(|| outcome.most_loaded.map_or("-".into(), loaded)));
        row
    };
    let rows: Vec<Vec<String>> = units.iter().map(row).collect();
    let [peak, speed, travel] = [
        format!("peak, {}", kind.effort_unit()),
        format!("final, {}", kind.speed_unit()),
        format!("travel, {}", kind.travel_unit()),
    ];
    let mut heading = vec!["unit", "tightness", "verdict", &peak, &speed, &travel, "breakaway, ms"];
    heading.extend(has_contacts.then_some("most loaded"));
    text_table(&heading, &rows)
}
