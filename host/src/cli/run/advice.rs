//! What goes wrong at which levels and with which units, and what to change: of slides and of mechanisms.

use std::fmt::Write;

use crate::{
    cli::population::{
        uncertain::{decided, share},
        words::{percent, strongest},
    },
    dynamics::{
        outcome::Verdict,
        sweep::{Level, Sweep},
    },
    population::{drivers::Driver, statistics::Statistics, uncertain::answer::Answer},
};

/// Units of the production, as far as advice needs them.
#[derive(Clone, Copy)]
pub struct Units<'a> {
    /// What they do.
    pub statistics: &'a Statistics,
    /// What drives malfunction, the strongest first.
    pub of_malfunction: &'a [Driver],
    /// What the unknowns leave open, if there are any.
    pub unknown: Option<&'a Answer>,
}

impl Units<'_> {
    /// How many malfunction, and from what: a line each.
    pub fn describe(&self) -> String {
        let Statistics { units, undecided, malfunctions, .. } = self.statistics;
        if undecided.units == *units {
            return format!("Production      none of {units} units comes to a verdict\n");
        }
        let unknown =
            if undecided.units > 0 { format!("; {} come to no verdict", undecided.units) } else { String::new() };
        let mut text = String::new();
        let mut title = "Production";
        if let Some(answer) = self.unknown {
            let share = share(&answer.malfunctions);
            let _ = writeln!(text, "Production      {share} malfunction (95 %); decided by {}", decided(answer));
            title = "  as stated";
        }
        let _ = writeln!(text, "{title:16}{} of {units} units malfunction{unknown}", percent(malfunctions));
        if malfunctions.units > 0 {
            let _ = writeln!(text, "Failure due to  {}", strongest(self.of_malfunction, 2));
        }
        text
    }
}

/// The level nearest to nominal at which something goes wrong, and "loose" or "tight" units.
fn first_to_go_wrong(sweep: &Sweep) -> Option<(&Level, &'static str)> {
    let bad = |level: &&Level| level.outcome.verdict.is_malfunction();
    let worst = sweep.levels.iter().filter(bad).min_by(|one, other| one.n.abs().total_cmp(&other.n.abs()))?;
    let first = sweep.levels.iter().find(|level| level.outcome.verdict == Verdict::Runs);
    let looser = first.is_none_or(|first| worst.n < first.n);
    Some((worst, if looser { "loose" } else { "tight" }))
}

/// What to change where neither a level nor one of the `units` malfunctions; `longer` is how runs come to verdicts. `None` if
/// one does.
pub fn nothing_wrong(sweep: &Sweep, units: Option<Units>, longer: &str) -> Option<String> {
    let failed = units.is_some_and(|units| units.statistics.malfunctions.units > 0);
    if failed || first_to_go_wrong(sweep).is_some() {
        return None;
    }
    let undecided = sweep.levels.iter().any(|level| level.outcome.verdict == Verdict::Undecided)
        || units.is_some_and(|units| units.statistics.undecided.units > 0);
    Some(match (undecided, units) {
        (true, _) => format!("the run: it ends before there are verdicts; {longer}"),
        (false, Some(_)) => "nothing: every level runs, and every unit that was drawn".into(),
        (false, None) => "nothing: every level runs, and no gap varies".into(),
    })
}

/// What to change where levels or units malfunction.
pub fn remedy(sweep: &Sweep, units: Option<Units>) -> String {
    // What levels do tells little of units, each of which has gaps of its own.
    if sweep.levels.iter().any(|level| level.n.abs() < 1e-9 && level.outcome.verdict.is_malfunction()) {
        return "a nominal value, the friction or the drive: the mean unit itself malfunctions".into();
    }
    let strongest = units.and_then(|units| units.of_malfunction.first());
    let first = strongest
        .filter(|driver| driver.is_significant())
        .map_or_else(|| "no single tolerance stands out".to_owned(), |driver| format!("start with {}", driver.name));
    let failed = units.is_some_and(|units| units.statistics.malfunctions.units > 0);
    match first_to_go_wrong(sweep) {
        Some((worst, side)) if !failed => {
            format!("nothing for these units: only {side} levels malfunction, from n = {} on", worst.n)
        }
        Some((worst, side)) => format!("{first}; {side} levels malfunction from n = {} on", worst.n),
        None => format!("{first}: no level malfunctions, but units do whose gaps differ from each other"),
    }
}
