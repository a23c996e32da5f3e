//! What is said of a table, in words.

use std::fmt::Write;

use slipfit_core::table::{AxisKind, MotionVerdict};
use slipfit_tolerance::number::{fixed, level, ten_digits};

use crate::{
    dynamics::{
        driven::{DriveKind, Driven},
        outcome::Verdict,
    },
    firmware::{
        flash::{AxisSpec, TABLE_REGION},
        force_table::{ForceTable, position::Reach},
    },
};

/// Share of what units that run need from which a table's error is worth a warning.
const COARSE: f64 = 0.05;

/// A warning where the table errs by much of what units that run need.
pub fn coarse(driven: &dyn Driven, table: &ForceTable) -> Option<String> {
    let ([error, _], greatest) = (table.worst_error_in_use, table.running_force);
    let kind = driven.kind();
    let [error_words, share] = [fixed(error, 3), fixed(error / greatest * 100.0, 0)];
    let advice = if table.worst_at_levels > 0.5 * error {
        let over_time = table.axes.get(1).is_none_or(|axis| axis.kind == AxisKind::Time);
        let (nodes, apart) = if over_time {
            ("time steps", "take fewer levels or a shorter run, so that these are finer")
        } else {
            ("positions", "they cannot be closer, so never decide by a single sample")
        };
        format!("the {} changes too fast for the {nodes} of the table: {apart}", kind.effort())
    } else {
        let one_side = table.longest(MotionVerdict::Runs).filter(|_| !table.mixed().is_empty());
        let or = one_side.map_or_else(String::new, |ends| {
            let [first, last] = ends.map(|n| ten_digits((f64::from(n) * 1e4).round() / 1e4));
            format!(", or those of one verdict, --n {first}:{last}:{}", ten_digits(driven.levels().step))
        });
        format!("neighbouring levels differ by more than can be interpolated: take finer ones{or}")
    };
    // Where none runs the greatest is that of all.
    let of = if table.longest(MotionVerdict::Runs).is_some() { "of units that run" } else { "there is" };
    (error > COARSE * greatest).then(|| {
        format!(
            "the table errs by up to {error_words} {} where it is used, {share} % of the greatest {} {of}: {advice}",
            kind.effort_unit(),
            kind.effort()
        )
    })
}

/// Size and interpolation error in words.
pub fn describe(kind: DriveKind, table: &ForceTable) -> String {
    let nodes = |axis: &AxisSpec| {
        let what = match axis.kind {
            AxisKind::Level => "levels of n",
            AxisKind::Time => "instants",
            AxisKind::Position => "positions",
            AxisKind::Velocity => "speeds",
            AxisKind::Row => "rows",
        };
        format!("{} {what}", axis.count)
    };
    let errors = |[force, velocity]: [f64; 2]| {
        let [effort, speed] = [fixed(force, 6), fixed(kind.speed(velocity), 4)];
        format!("{} {effort} {}, velocity {speed} {}", kind.effort(), kind.effort_unit(), kind.speed_unit())
    };
    let [in_use, rms, whole] = if table.axes.iter().any(|axis| axis.kind == AxisKind::Time) {
        [
            " from the ramp's start on: ",
            "Its root mean square:                             ",
            ", release included:        ",
        ]
    } else {
        [
            " up to where all units come: ",
            "Its root mean square:                                ",
            ", the rest included:          ",
        ]
    };
    let mixed = match table.mixed() {
        pairs if pairs.is_empty() => String::new(),
        pairs => {
            let between: Vec<_> = pairs.iter().map(|pair| pair.map(|n| level(f64::from(n))).join(" and ")).collect();
            format!("The verdict changes between n = {}: a lookup there is no unit's and says so\n", between.join(", "))
        }
    };
    format!(
        "{} bytes of the {TABLE_REGION} in the TABLE region: {}, {}\n\
         Worst interpolation error{in_use}{}\n\
         {rms}{}\n\
         Worst interpolation error{whole}{}\n{mixed}",
        table.bytes.len(),
        table.axes.iter().map(nodes).collect::<Vec<_>>().join(" by "),
        table.encoding.name(),
        errors(table.worst_error_in_use),
        errors(table.rms_error),
        errors(table.worst_error),
    )
}

/// Which units come short, in words: a line for neighbouring levels with the same verdict.
pub fn describe_short(driven: &dyn Driven, short: &[Reach]) -> String {
    let (kind, mut text) = (driven.kind(), String::new());
    let mut by_speed = short.to_vec();
    // Stable: by level within a speed.
    by_speed.sort_by(|one, other| one.speed.total_cmp(&other.speed));
    let belong = |one: &Reach, other: &Reach| {
        one.speed == other.speed && one.verdict == other.verdict && other.n - one.n < 1.5 * driven.levels().step
    };
    let range = |[one, other]: [String; 2]| if one == other { one } else { format!("{one} to {other}") };
    for group in by_speed.chunk_by(belong) {
        let ends = [group[0], group[group.len() - 1]];
        let (least, most) =
            group.iter().fold((f64::MAX, f64::MIN), |(least, most), at| (at.z.min(least), at.z.max(most)));
        let levels = range(ends.map(|end| level(end.n)));
        let places = range([least, most].map(|z| fixed(kind.travel(z), 2))) + " " + kind.travel_unit();
        let speed = fixed(kind.speed(ends[0].speed), 1) + " " + kind.speed_unit();
        let what = match ends[0].verdict {
            Verdict::Jammed => format!("jams at z = {places}"),
            other => format!("{other} and is at z = {places} after {} ms", fixed(driven.run().duration * 1e3, 0)),
        };
        let _ = writeln!(text, "n = {levels} at {speed} {what}");
    }
    if !short.is_empty() {
        text += "Beyond, the table holds the last force and velocity 0.\n";
    }
    text
}
