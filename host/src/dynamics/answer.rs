//! The answer to what a sweep was asked for: from which level to which a slide runs, crawls or jams, and with what force.

use serde::Serialize;
use slipfit_tolerance::number::{fixed, level};

use super::{
    driven::DriveKind,
    outcome::{BREAKAWAY_SPEED, JAMMED, Moment, Outcome, Verdict},
    sweep::{Level, Sweep},
};

/// Neighbouring levels with one verdict. For a drive that turns, N and m are N·m and rad.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Range {
    /// What the drive gives.
    #[serde(skip)]
    pub kind: DriveKind,
    /// Loosest level.
    pub first: f64,
    /// Tightest level.
    pub last: f64,
    /// Verdict of all of them.
    pub verdict: Verdict,
    /// Least and greatest peak force (N).
    pub peak_force: Option<[f64; 2]>,
    /// Least and greatest travel (m) at the end.
    pub travel: [f64; 2],
    /// Least and greatest time (s) at the end.
    pub time: [f64; 2],
    /// Whether all come to the stroke's end; `None` where no stroke is stated.
    pub stroke_reached: Option<bool>,
}

fn span(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    values.fold(None, |span, value| Some(span.map_or([value; 2], |[least, most]| [value.min(least), value.max(most)])))
}

/// The levels of a sweep, neighbours with the same verdict taken together.
pub fn ranges(sweep: &Sweep) -> Vec<Range> {
    let groups = sweep.levels.chunk_by(|one, next| one.outcome.verdict == next.outcome.verdict);
    let range = |group: &[Level]| {
        let outcomes = || group.iter().map(|level| &level.outcome);
        Some(Range {
            kind: sweep.kind,
            first: group.first()?.n,
            last: group.last()?.n,
            verdict: group.first()?.outcome.verdict,
            peak_force: span(outcomes().filter_map(|outcome| outcome.peak_force)),
            travel: span(outcomes().map(|outcome| outcome.end.z))?,
            time: span(outcomes().map(|outcome| outcome.end.t))?,
            stroke_reached: outcomes()
                .map(|outcome| outcome.stroke_reached)
                .reduce(|one, other| Some(one? && other?))?,
        })
    };
    groups.filter_map(range).collect()
}

/// `least` to `most`, or one of them where they look the same.
fn between([least, most]: [f64; 2], decimals: usize) -> String {
    let [least, most] = [least, most].map(|value| fixed(value, decimals));
    if least == most { least } else { format!("{least} to {most}") }
}

impl Range {
    /// The range in a line: levels, verdict, travel and force.
    pub fn describe(&self) -> String {
        let levels = if self.first == self.last {
            level(self.first)
        } else {
            format!("{} … {}", level(self.first), level(self.last))
        };
        let kind = self.kind;
        let (travel, unit) = (between(self.travel.map(|z| kind.travel(z)), 1), kind.travel_unit());
        let time = between(self.time, 2);
        let way = match (self.verdict, self.stroke_reached) {
            (_, Some(true)) => format!("the stroke of {travel} {unit} in {time} s"),
            (Verdict::Jammed, _) => format!("gets {travel} {unit} far in {time} s"),
            _ => format!("is at {travel} {unit} after {time} s"),
        };
        let peak = |force| format!(", peak {} {} {}", kind.effort(), between(force, 3), kind.effort_unit());
        let force = self.peak_force.map_or_else(String::new, peak);
        format!("n = {levels:14} {:9} {way}{force}", self.verdict.to_string())
    }
}

/// The mean speed (m/s, rad/s) up to which a unit that jams has not moved.
const STILL: f64 = BREAKAWAY_SPEED;

/// Where a unit is that was never faster than a jammed one since the ramp's start: where it started, behind that, or where it came to
/// before the ramp or at a creep.
fn never_faster(kind: DriveKind, end: Moment) -> String {
    let [far, unit] = [fixed(kind.travel(end.z.abs()), 1), kind.travel_unit().to_owned()];
    if end.z.abs() <= STILL * end.t {
        "never moves".into()
    } else if end.z < 0.0 {
        format!("is pushed back by {far} {unit}")
    } else {
        format!("comes {far} {unit} far, but never at {} % of the command", fixed(100.0 * JAMMED, 0))
    }
}

/// Where on its way a unit tips, slows or stops, or that it never was faster, and between which speeds it swings at the end, in
/// words; empty where it runs all the way.
pub fn on_the_way(kind: DriveKind, outcome: &Outcome) -> String {
    let at = |what: &str, moment: Option<Moment>| {
        moment.map(|moment| format!("{what} at {} {}", fixed(kind.travel(moment.z), 1), kind.travel_unit()))
    };
    let slows = match (outcome.verdict, outcome.slows, outcome.stops) {
        (_, _, Some(_)) => at("stops", outcome.stops),
        (Verdict::Jammed, ..) => Some(never_faster(kind, outcome.end)),
        (_, Some(_), _) => at("slows", outcome.slows),
        (Verdict::Crawls, ..) => Some("slow from the start".into()),
        _ => None,
    };
    let swings = outcome.swings.map(|speeds| {
        let speeds = speeds.map(|speed| fixed(kind.speed(speed), 1));
        format!("swings between {} and {} {} at the end", speeds[0], speeds[1], kind.speed_unit())
    });
    [at("tips", outcome.tips), slows, swings].into_iter().flatten().collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::{on_the_way, ranges};
    use crate::{
        dynamics::{
            driven::DriveKind,
            example,
            outcome::{Moment, Verdict},
        },
        setup::LevelRange,
    };

    #[test]
    fn neighbours_with_one_verdict_are_one_range() {
        let mut sweep = example::sweep(LevelRange { first: -1.0, step: 1.0, count: 4 }, 0.1, 0.1);
        let verdicts = [Verdict::Jammed, Verdict::Jammed, Verdict::Runs, Verdict::Jammed];
        for (level, verdict) in sweep.levels.iter_mut().zip(verdicts) {
            level.outcome.verdict = verdict;
        }
        sweep.levels[0].outcome.peak_force = Some(4.0);
        sweep.levels[1].outcome.peak_force = Some(3.0);
        let found = ranges(&sweep);
        let bounds: Vec<_> = found.iter().map(|range| (range.first, range.last, range.verdict)).collect();
        let expected = [(-1.0, 0.0, Verdict::Jammed), (1.0, 1.0, Verdict::Runs), (2.0, 2.0, Verdict::Jammed)];
        assert_eq!(bounds, expected);
        assert_eq!(found[0].peak_force, Some([3.0, 4.0]));
        let line = found[0].describe();
        assert!(line.contains("n = -1 … 0") && line.contains("jammed") && line.contains("3.000 to 4.000 N"), "{line}");
        sweep.levels.clear();
        assert!(ranges(&sweep).is_empty());
    }

    #[test]
    fn tells_what_happens_on_the_way() {
        let mut outcome = example::sweep(LevelRange { first: 0.0, step: 1.0, count: 1 }, 0.1, 0.1).levels[0].outcome;
        let kind = DriveKind::Pushes;
        let moment = |z: f64| Some(Moment { t: 1.0, z });
        outcome.verdict = Verdict::Runs;
        (outcome.tips, outcome.slows, outcome.stops) = (None, None, None);
        outcome.swings = Some([0.004, 0.079]);
        assert_eq!(on_the_way(kind, &outcome), "swings between 4.0 and 79.0 mm/s at the end");
        outcome.swings = None;
        assert_eq!(on_the_way(kind, &outcome), "");
        (outcome.tips, outcome.slows) = (moment(0.0312), moment(0.04));
        assert_eq!(on_the_way(kind, &outcome), "tips at 31.2 mm, slows at 40.0 mm");
        outcome.verdict = Verdict::Jammed;
        outcome.stops = moment(0.05);
        assert_eq!(on_the_way(kind, &outcome), "tips at 31.2 mm, stops at 50.0 mm");
        (outcome.tips, outcome.slows, outcome.stops) = (None, None, None);
        for (z, told) in [
            (1e-4, "never moves"),
            (-1e-4, "never moves"),
            (-0.287, "is pushed back by 287.0 mm"),
            (0.287, "comes 287.0 mm far, but never at 1 % of the command"),
        ] {
            outcome.end = Moment { t: 1.0, z };
            assert_eq!(on_the_way(kind, &outcome), told);
        }
        outcome.verdict = Verdict::Crawls;
        assert_eq!(on_the_way(kind, &outcome), "slow from the start");
    }
}
