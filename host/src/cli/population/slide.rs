//! What all units of a slide's production did, for people and machines.

use std::fmt::Write;

use serde::Serialize;
use slipfit_core::slide::CONTACTS;
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
        check,
        failure::Failure,
        simulate::why_undecided,
        terminal::{print, print_json, text_table, warn},
    },
    dynamics::{driven::DriveKind, outcome::Verdict},
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
    setup::Scene,
    show::{
        report::{Figure, units_page},
        units,
    },
};

/// Random combinations at each distance.
const DIRECTIONS: u64 = 512;

#[derive(Serialize)]
struct Report {
    title: String,
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
        scene: &Scene,
        production: &Production,
        tally: Tally<[f64; CONTACTS]>,
        unknown: Option<Answer>,
        product: Option<&Product>,
    ) -> Result<(), Failure> {
        let found = self.threads.install(|| self.find(scene, production, tally, unknown))??;
        let without_run = faults(scene, production, &found.population)?;
        if let Some(path) = &self.plot {
            let svg = units::forces(scene, &found.population.tally, self.force_limit);
            let svg = svg.map_err(anyhow::Error::from)?;
            files::write(path, svg.as_bytes())?;
        }
        if let Some(path) = &self.plot_distance {
            let svg = units::hypothesis(&scene.title, &found.hypothesis).map_err(anyhow::Error::from)?;
            files::write(path, svg.as_bytes())?;
        }
        let mut warnings = check::warnings_of(scene);
        warnings.extend(product.into_iter().flat_map(|product| product.warnings.iter().cloned()));
        warnings.extend(without_run);
        warnings.extend(found.unknown.as_ref().map(uncertain::warnings).transpose()?.unwrap_or_default());
        if let Some(path) = &self.page {
            let (mut units, _) = page::units(scene, production, &found.population, self.force_limit)?;
            let svg = units::hypothesis(&scene.title, &found.hypothesis).map_err(anyhow::Error::from)?;
            units.figures.push(Figure { caption: HYPOTHESIS.into(), svg });
            units.figures.extend(unknown_figure(&scene.title, found.unknown.as_ref())?);
            let words = self.summary(scene, &found);
            files::write(path, units_page(&scene.title, &words, &units, &warnings).into_string().as_bytes())?;
        }
        if self.scene.json {
            let worst = UnitReport::worst(scene, &found.population.tally);
            let Population { statistics, of_force, of_malfunction, .. } = found.population;
            return print_json(&Report {
                title: scene.title.clone(),
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
        print(&self.describe(scene, &found))?;
        warn(&warnings);
        Ok(())
    }

    fn find(
        &self,
        scene: &Scene,
        production: &Production,
        tally: Tally<[f64; CONTACTS]>,
        unknown: Option<Answer>,
    ) -> Result<Found, Failure> {
        let population = Population::of(production, tally, self.duty_of(scene));
        let levels = LevelReport::all(scene, &population.tally)?;
        let hypothesis = Hypothesis::test(scene, DIRECTIONS, self.seed, self.force_limit)?;
        let rare = self.rare.then(|| self.estimate(scene, production, &population)).transpose()?;
        Ok(Found { population, levels, hypothesis, rare, unknown })
    }
}

/// Drivers that are listed.
const DRIVERS: usize = 5;

impl Arguments {
    /// The answer, for people: what the units did together, and the worst of them.
    fn describe(&self, scene: &Scene, found: &Found) -> String {
        let title = worst(&found.population.statistics, "force");
        format!("{}\n{title}\n{}", self.summary(scene, found), worst_units(scene, &found.population.tally.worst))
    }

    /// What the units did together.
    fn summary(&self, scene: &Scene, found: &Found) -> String {
        let Population { statistics, of_force, of_malfunction, .. } = &found.population;
        let Statistics { units, undecided, over_limit, sigma_level, unsolved, out_of_bounds, .. } = *statistics;
        let mut text = format!("{}: {units} units", scene.title);
        let length = match self.duty_of(scene).stroke {
            Some(stroke) => format!("the stroke of {} mm", fixed(stroke * 1e3, 1)),
            None => format!("{} ms", fixed(scene.run.duration * 1e3, 0)),
        };
        let _ = writeln!(text, ", {length}\n");
        text += &found.unknown.as_ref().map(|answer| uncertain::before(answer, DriveKind::Pushes)).unwrap_or_default();
        let _ = writeln!(text, "Malfunction     {}", malfunction(statistics));
        text += &verdicts(statistics);
        // Warnings name the others.
        if undecided.units > unsolved + out_of_bounds {
            let why = match self.opening {
                true => {
                    ": the opening ends before the ramp does; without --opening the whole stroke is simulated".into()
                }
                false => why_undecided(scene, Verdict::Undecided),
            };
            let _ = writeln!(text, "                undecided{why}");
        }
        if let (Some(share), Some(limit)) = (over_limit, self.force_limit) {
            let name = format!("  over {limit} N ");
            let _ = writeln!(text, "{name:16}{}", percent(&share));
        }
        if let Some(level) = sigma_level {
            let _ = writeln!(
                text,
                "Sigma level     {} σ, one-sided: the normal quantile of the share that does its job",
                fixed(level, 2)
            );
        }
        for (name, spread) in [("Peak force", &statistics.peak_force), ("  that run", &statistics.running_force)] {
            if let Some(Spread { quantiles: [least, low, median, high, most], .. }) = spread {
                let _ = writeln!(
                    text,
                    "{name:16}{} N at the median; 90 % of the units {} to {} N, all {} to {} N",
                    fixed(*median, 3),
                    fixed(*low, 3),
                    fixed(*high, 3),
                    fixed(*least, 3),
                    fixed(*most, 3)
                );
            }
        }
        for (name, drivers) in [("Force due to", of_force), ("Failure due to", of_malfunction)] {
            let _ = writeln!(text, "{name:16}{}", strongest(drivers, DRIVERS));
        }
        if scene.has_levels() {
            let _ = writeln!(text, "Levels n        {}", levels(&found.levels));
            let _ = writeln!(text, "Hypothesis      {}", found.hypothesis.verdict());
        }
        text + &found.rare.as_ref().map(rare::describe).unwrap_or_default()
    }
}

/// The table of the worst units.
fn worst_units(scene: &Scene, units: &[Unit]) -> String {
    let row = |unit: &Unit| {
        let outcome = unit.outcome;
        vec![
            unit.number.to_string(),
            level((scene.tightness(&unit.gaps) * 100.0).round() / 100.0),
            outcome.verdict.to_string(),
            or_dash(outcome.peak_force, |force| fixed(force, 3)),
            fixed(outcome.final_velocity * 1e3, 3),
            fixed(outcome.end.z * 1e3, 2),
            or_dash(outcome.breakaway, |t| fixed(t * 1e3, 1)),
            outcome
                .most_loaded
                .map_or("-".into(), |(i, force)| format!("{} ({} N)", scene.contact_names()[i], fixed(force, 2))),
        ]
    };
    let rows: Vec<Vec<String>> = units.iter().map(row).collect();
    let heading =
        ["unit", "tightness", "verdict", "peak, N", "final, mm/s", "travel, mm", "breakaway, ms", "most loaded"];
    text_table(&heading, &rows)
}
