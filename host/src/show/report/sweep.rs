//! What a sweep comes to: its levels as a table, and in short how it was computed.

use maud::{Markup, html};

use super::{
    clearances::{Clearances, first_to_close},
    html::{columns, group, marked, optional, real, table, tall, typed},
};
use crate::dynamics::{
    answer::on_the_way,
    driven::DriveKind,
    outcome::Verdict,
    sweep::{Level, Sweep},
};

/// Every level.
pub fn levels(sweep: &Sweep) -> Markup {
    let caption = "n > 0 tightens every gap, n < 0 loosens it. A dash: no breakaway, or a force that has not settled.";
    let rows = sweep.levels.iter().map(|of| level(sweep.kind, of));
    html! {
        h2 { "Levels" }
        details {
            summary { "All " (sweep.levels.len()) " levels" }
            (table(caption, head(sweep.kind), rows))
        }
    }
}

fn head(kind: DriveKind) -> Markup {
    let measured = |what: &str, unit: &str| tall(html! { (what) br; "(" (unit) ")" });
    let of_effort = |which: &str| measured(&format!("{which} {}", kind.effort()), kind.effort_unit());
    html! {
        tr {
            (tall("n"))
            (tall("verdict"))
            (measured("breakaway", "ms"))
            (of_effort("peak"))
            (of_effort("settled"))
            (measured("final velocity", kind.speed_unit()))
            (measured("travel", kind.travel_unit()))
            (group("gaps", 3))
            (tall("on the way"))
        }
        tr.sub { (columns(&["compressed", "zero", "free"])) }
    }
}

fn level(kind: DriveKind, level: &Level) -> Markup {
    let Level { n, outcome, .. } = level;
    let numbers = [
        optional(outcome.breakaway.map(|t| t * 1e3), 1),
        optional(outcome.peak_force, 4),
        optional(outcome.settled_force, 4),
        real(kind.speed(outcome.final_velocity), 2),
        real(kind.travel(outcome.end.z), 1),
    ];
    html! {
        tr {
            th scope="row" { (typed(*n)) }
            td { (marked(outcome.verdict)) }
            @for number in numbers { td { (number) } }
            @for count in level.class_counts() { td { (count) } }
            td { (on_the_way(kind, outcome)) }
        }
    }
}

/// In short, with what of the `clearances` closes first.
pub fn summary(sweep: &Sweep, clearances: &Clearances) -> Markup {
    let peaks = || sweep.levels.iter().filter_map(|level| level.outcome.peak_force);
    html! {
        h2 { "What was done" }
        dl {
            @if let (Some(first), Some(last)) = (sweep.levels.first(), sweep.levels.last()) {
                dt { "Sweep" }
                dd { (sweep.levels.len()) " levels, n = " (typed(first.n)) " to " (typed(last.n)) }
                @if let (Some(low), Some(high)) = (peaks().reduce(f64::min), peaks().reduce(f64::max)) {
                    dt { (sweep.kind.choose("Peak drive force", "Peak drive torque")) }
                    dd { (real(low, 3)) " to " (real(high, 3)) " " (sweep.kind.effort_unit()) }
                }
                dt { "Verdicts" }
                dd { (verdicts(sweep)) }
                dt { "Computed by" }
                dd { (first.solved.describe()) ", each level held against a run at a tenth of that" }
            }
            @if let Some((what, first)) = first_to_close(clearances) {
                dt { (what) }
                dd { (first) }
            }
        }
    }
}

fn verdicts(sweep: &Sweep) -> Markup {
    let count = |verdict| sweep.levels.iter().filter(|level| level.outcome.verdict == verdict).count();
    let all = [Verdict::Runs, Verdict::Crawls, Verdict::Jammed, Verdict::Overruns, Verdict::Undecided];
    let counted = all.map(|verdict| (verdict, count(verdict))).into_iter().filter(|(_, count)| *count > 0);
    html! {
        @for (i, (verdict, count)) in counted.enumerate() {
            @if i > 0 { ", " }
            (count) " " (marked(verdict))
        }
    }
}
