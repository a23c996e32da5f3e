//! A population, for people.

use std::fmt::Write;

use slipfit_tolerance::number::{self, fixed, level, or_dash};

use super::{Arguments, Found, LevelReport, rare};
use crate::{
    cli::{failure::Failure, simulate::why_undecided, terminal::text_table},
    dynamics::outcome::Verdict,
    population::{
        Unit,
        drivers::{Driver, LEAST_OUTCOMES, LEAST_UNITS},
        production::Production,
        statistics::{Share, Spread, Statistics},
        study::Population,
        subject::Subject,
        unit::Fault,
    },
    setup::Scene,
};

/// Drivers that are listed.
const DRIVERS: usize = 5;

impl Arguments {
    /// The answer, for people: what the units did together, and the worst of them.
    pub(super) fn describe(&self, scene: &Scene, found: &Found) -> String {
        let title = match found.population.statistics.malfunctions.units {
            0 => "None malfunctions; the greatest forces",
            _ => "The worst",
        };
        format!("{}\n{title}\n{}", self.summary(scene, found), worst_units(scene, &found.population.tally.worst))
    }

    /// What the units did together.
    pub(super) fn summary(&self, scene: &Scene, found: &Found) -> String {
        let Population { statistics, of_force, of_malfunction, .. } = &found.population;
        let Statistics { units, undecided, malfunctions, over_limit, sigma_level, unsolved, out_of_bounds, .. } =
            *statistics;
        let mut text = format!("{}: {units} units", scene.title);
        let length = match self.duty_of(scene).stroke {
            Some(stroke) => format!("the stroke of {} mm", fixed(stroke * 1e3, 1)),
            None => format!("{} ms", fixed(scene.run.duration * 1e3, 0)),
        };
        let _ = writeln!(text, ", {length}\n");
        let _ = writeln!(text, "Malfunction     {}", percent(&malfunctions));
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

/// How many units have which verdict, in lines; those without any are left out.
pub(in crate::cli) fn verdicts(statistics: &Statistics) -> String {
    let Statistics { runs, short, crawls, jammed, overruns, undecided, .. } = *statistics;
    let mut text = String::new();
    let mut line = |name: &str, share: Share, note: &str| {
        if share.units > 0 {
            let _ = writeln!(text, "  {name:14}{}{note}", percent(&share));
        }
    };
    line("runs", runs, "");
    if let Some(short) = short {
        line("  too slowly", short, ": short of the end of the stroke when their time is over");
    }
    line("crawls", crawls, "");
    line("jammed", jammed, "");
    line("overruns", overruns, "");
    line("undecided", undecided, "");
    text
}

/// The greatest share of units that may be out of bounds: beyond, what varies does so too much.
const OUT_OF_BOUNDS: f64 = 0.01;

/// Warnings of units without a run.
///
/// # Errors
/// Where so many have a parameter that is out of bounds that the scene is to blame.
pub(in crate::cli) fn faults<S: Subject>(
    subject: &S,
    production: &Production<S::Gaps>,
    population: &Population<S::Gaps>,
) -> Result<Vec<String>, Failure> {
    let Statistics { units, unassembled, unsolved, out_of_bounds, .. } = population.statistics;
    let first = |fault: Fault| {
        let kept = population.tally.first.iter().flatten().filter(|unit| unit.outcome.fault == Some(fault));
        let number = kept.map(|unit| unit.number).min()?;
        let (drawn, i) = production.draw_one(number);
        let why = subject.trouble(&drawn, i).map_or_else(String::new, |why| format!(": {why}"));
        Some(format!("; the first is unit {number}{why}"))
    };
    let told = |count: u64, what: &str, fault: Option<Fault>| {
        let first = fault.and_then(first).unwrap_or_default();
        (count > 0).then(|| format!("{count} of {units} units {what}{first}"))
    };
    let fits = "cannot be assembled, because a pin is wider than its hole: they count as jammed";
    let no_step = "come to no verdict, since no step meets the tolerance";
    let bounds = "come to no verdict, since one of their parameters is out of bounds";
    let bounds = told(out_of_bounds, bounds, Some(Fault::OutOfBounds));
    if out_of_bounds as f64 > OUT_OF_BOUNDS * units as f64 {
        return Err(Failure::Input(bounds.unwrap_or_default()));
    }
    let all = [told(unassembled, fits, None), told(unsolved, no_step, Some(Fault::Unsolved)), bounds];
    Ok(all.into_iter().flatten().collect())
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

/// The strongest of `drivers`, at most `most`, as far as chance does not explain them.
pub fn strongest(drivers: &[Driver], most: usize) -> String {
    if drivers.is_empty() {
        return format!(
            "not known: that takes {LEAST_UNITS} units with a force, and for failure {LEAST_OUTCOMES} each that do and do not fail"
        );
    }
    let shown = drivers.iter().filter(|driver| driver.is_significant()).take(most);
    let shown: Vec<String> = shown
        .map(|driver| {
            let [share, error] = [driver.share, driver.error].map(|x| fixed(x * 100.0, 1));
            format!("{} {share} ± {error} %", driver.name)
        })
        .collect();
    if shown.is_empty() { "nothing alone, as far as so many units show".to_owned() } else { shown.join(", ") }
}

/// A share with its interval.
pub fn percent(share: &Share) -> String {
    let [low, high] = share.interval.map(|end| number::percent(end, 2));
    format!("{} %  ({low} to {high} %)", number::percent(share.share, 2))
}

/// Which levels do what, as ranges.
pub fn levels(levels: &[LevelReport]) -> String {
    let mut parts: Vec<(Verdict, f64, f64)> = Vec::new();
    for at in levels {
        match parts.last_mut() {
            Some((verdict, _, last)) if *verdict == at.verdict => *last = at.n,
            _ => parts.push((at.verdict, at.n, at.n)),
        }
    }
    let part = |(verdict, first, last): &(Verdict, f64, f64)| match first == last {
        true => format!("{} {verdict}", level(*first)),
        false => format!("{} to {} {verdict}", level(*first), level(*last)),
    };
    parts.iter().map(part).collect::<Vec<_>>().join(", ")
}
