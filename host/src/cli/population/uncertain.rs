//! Unknowns of a production: how they are asked for, and the answer in words.

use std::fmt::Write;

use slipfit_tolerance::number::{fixed, three_digits};

use super::asked::Arguments;
use crate::{
    cli::failure::Failure,
    dynamics::driven::DriveKind,
    population::uncertain::{
        answer::{Answer, Expected},
        design::{Design, LEAST_UNITS},
    },
};

/// The greatest share of units that may be out of bounds.
const OUT_OF_BOUNDS: f64 = 0.01;

/// The design beside a population of so many `units`, where something is `unknown`; none where all is known.
///
/// # Errors
/// Too few units.
pub fn design(unknown: bool, units: u64, seed: u64) -> Result<Option<Design>, Failure> {
    if !unknown {
        return Ok(None);
    }
    let few =
        || format!("--units {units}: with [uncertain] or [measured] in the scene at least {LEAST_UNITS} are allowed");
    Design::beside(units, seed).map(Some).ok_or_else(|| Failure::Input(few()))
}

impl Arguments {
    /// The design for a scene of which something is `unknown`.
    ///
    /// # Errors
    /// What cannot be done of such a scene, or too few units.
    pub fn design(&self, unknown: bool) -> Result<Option<Design>, Failure> {
        let asked = [("--shard", self.shard.is_some()), ("--out", self.out.is_some()), ("--rare", self.rare)];
        if let Some((option, _)) = asked.into_iter().find(|(_, asked)| unknown && *asked) {
            let message = format!(
                "{option} takes the values that the scene states for the unknowns: allowed is a scene without [uncertain] and [measured]"
            );
            return Err(Failure::Input(message));
        }
        design(unknown, self.units, self.seed)
    }
}

/// Warnings about units without a verdict.
///
/// # Errors
/// Where so many have a parameter that is out of bounds that the scene is to blame.
pub fn warnings(answer: &Answer) -> Result<Vec<String>, Failure> {
    let (units, out) = (answer.units(), answer.out_of_bounds);
    let told = |count: u64, why: &str| format!("over the unknowns {count} of {units} units come to no verdict{why}");
    let out_of_bounds = ", since one of their parameters is out of bounds";
    if out as f64 > OUT_OF_BOUNDS * units as f64 {
        return Err(Failure::Input(told(out, out_of_bounds)));
    }
    let others = answer.undecided - out;
    let all = [(others > 0).then(|| told(others, "")), (out > 0).then(|| told(out, out_of_bounds))];
    Ok(all.into_iter().flatten().collect())
}

/// Digits after the point of shares up to `high` in percent: whole percent are enough of what unknowns decide.
fn decimals(high: f64) -> usize {
    match high {
        0.1.. => 0,
        0.01.. => 1,
        _ => 3,
    }
}

/// A share of the whole production, and what it may be.
pub fn share(of: &Expected) -> String {
    let [low, high] = of.interval;
    let [low, high, expected] = [low, high, of.expected].map(|share| fixed(100.0 * share, decimals(of.interval[1])));
    let ends = if low == high { low } else { format!("{low} to {high}") };
    format!("{ends} % of the units, {expected} % expected")
}

/// What decides, and what to do about it.
pub fn decided(answer: &Answer) -> String {
    let [first, others @ ..] = &answer.decides[..] else {
        return "nothing that is unknown, as far as so many units show".into();
    };
    if answer.unknowns.len() == 1 && answer.measured.is_empty() {
        return format!("{}, the only unknown: measure it", first.name);
    }
    let of = |share: f64, error: f64| format!("{} ± {} %", fixed(share * 100.0, 0), fixed(error * 100.0, 0));
    let more: String =
        others.iter().map(|other| format!(", {} {}", other.name, of(other.share, other.error))).collect();
    format!("{} {} of the variance: measure it{more}", first.name, of(first.share, first.error))
}

/// What the production does, a line each, by a drive of this `kind`.
pub fn describe(answer: &Answer, kind: DriveKind) -> String {
    let (effort, unit) = (kind.effort(), kind.effort_unit());
    let mut text = format!("Malfunction     {}  (95 %)\n", share(&answer.malfunctions));
    // What parts leave open has no value that could be held against what the units do.
    if !answer.unknowns.is_empty() {
        let _ = writeln!(text, "  decided by    {}", decided(answer));
    }
    let over = answer.over_limit.iter().map(|over| ("over the limit", over));
    let verdicts = [("crawls", &answer.crawls), ("jammed", &answer.jammed), ("overruns", &answer.overruns)];
    for (name, of) in verdicts.into_iter().chain(over).filter(|(_, of)| of.expected > 0.0) {
        let _ = writeln!(text, "  {name:14}{}", share(of));
    }
    if let Some((median, high)) = answer.median_force.zip(answer.high_force) {
        let ends = |of: Expected| {
            let [low, high] = of.interval.map(three_digits);
            if low == high { low } else { format!("{low} to {high}") }
        };
        let name = format!("Peak {effort}");
        let _ = writeln!(
            text,
            "{name:16}{} {unit} at the median; 95 % of the units below {} {unit}",
            ends(median),
            ends(high)
        );
    }
    let known = |unknown: &crate::population::uncertain::answer::UnknownReport| {
        let [low, high] = unknown.tried.map(three_digits);
        format!("{} {low} to {high} {}", unknown.name, unknown.unit).trim_end().to_owned()
    };
    let mut names: Vec<String> = answer.unknowns.iter().map(known).collect();
    if !answer.measured.is_empty() {
        names.push(format!("what measured parts leave open of {}", answer.measured.join(", ")));
    }
    let _ = writeln!(text, "Not known       {}", names.join(", "));
    let _ = writeln!(text, "                {} values, {} units of each", answer.values.len(), answer.units_each);
    text
}

/// The same before what units do with the values that the scene states.
pub fn before(answer: &Answer, kind: DriveKind) -> String {
    describe(answer, kind) + "\nWith the values that the scene states:\n"
}
