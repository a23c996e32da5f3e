//! What all units of a production did, for people: of slides and mechanisms.

use std::fmt::Write;

use slipfit_tolerance::number::{self, fixed, level};

use super::reports::LevelReport;
use crate::{
    cli::failure::Failure,
    dynamics::outcome::Verdict,
    population::{
        drivers::{Driver, LEAST_OUTCOMES, LEAST_UNITS},
        production::Production,
        statistics::{Share, Statistics},
        study::Population,
        subject::Subject,
        unit::Fault,
    },
};

/// How many units have which verdict, in lines; those without any are left out.
pub fn verdicts(statistics: &Statistics) -> String {
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
pub fn faults(subject: &dyn Subject, production: &Production, population: &Population) -> Result<Vec<String>, Failure> {
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

/// The share that malfunctions. Units without a verdict may do, too.
pub fn malfunction(statistics: &Statistics) -> String {
    let Statistics { units, undecided, malfunctions, .. } = statistics;
    match undecided.units {
        0 => percent(malfunctions),
        all if all == *units && malfunctions.units == 0 => {
            format!("not known: none of {units} units comes to a verdict")
        }
        1 => format!("{} at least: a unit comes to no verdict", percent(malfunctions)),
        some => format!("{} at least: {some} units come to no verdict", percent(malfunctions)),
    }
}

/// The heading over the units that need the greatest `effort`.
pub fn worst(statistics: &Statistics, effort: &str) -> String {
    match (statistics.malfunctions.units, statistics.undecided.units) {
        (0, 0) => format!("None malfunctions; the greatest {effort}s"),
        (0, _) => format!("None is known to malfunction; the greatest {effort}s"),
        _ => "The worst".into(),
    }
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
