//! What `check` says of a mechanism.

use std::{fmt::Write, path::Path};

use serde::Serialize;
use slipfit_tolerance::number::{fixed, level, or_dash, ten_digits};

use super::{GapReport, gap_reports};
use crate::{
    cli::{
        arguments::SceneArguments,
        call,
        failure::Failure,
        self_locking::self_locking,
        terminal::{print, print_json, text_table, warn},
    },
    mechanism::{
        Freedom, Mechanism, Spring, SpringKind,
        feedback::{Reversal, reversals},
        self_locking::{DriveSide, Locked, locked},
    },
};

#[derive(Serialize)]
struct CheckReport<'a> {
    title: &'a str,
    freedom: Freedom,
    n: f64,
    gaps: Vec<GapReport<'a>>,
    warnings: &'a [String],
}

/// `check`; `of_product` are the warnings about the product that the mechanism belongs to.
pub fn check(
    mechanism: &Mechanism,
    n: f64,
    of_product: Vec<String>,
    scene: &SceneArguments,
    plot: Option<&Path>,
) -> Result<(), Failure> {
    if let Some(path) = plot {
        scene.check_outputs(&[("--plot", path)])?;
    }
    let gaps = mechanism.gaps_at(&[n])?;
    let freedom = Freedom::of(mechanism)?;
    let mut warnings = warnings(mechanism, &freedom);
    warnings.extend(of_product);
    call::picture(plot, "mechanism", || Ok(mechanism.drawing()))?;
    if scene.json {
        let gaps = gap_reports(mechanism, &gaps);
        let title = &mechanism.title;
        return print_json(&CheckReport { title, freedom, n, gaps, warnings: &warnings });
    }
    let mut text = format!("{}\n\nDegrees of freedom  {}\n\n", mechanism.title, freedom.describe());
    let joints: Vec<_> = mechanism
        .joints
        .iter()
        .map(|joint| {
            let [first, second] = joint.between.map(|port| mechanism.name_of(port).to_owned());
            let play = if joint.kind.is_ideal() { "none" } else { "yes" };
            vec![joint.name.clone(), joint.kind.name().into(), first, second, play.into()]
        })
        .collect();
    text += &text_table(&["joint", "kind", "of", "and", "play"], &joints);
    let rows: Vec<_> = gap_reports(mechanism, &gaps)
        .into_iter()
        .map(|gap| vec![gap.name.to_owned(), fixed(gap.mm, 4), or_dash(gap.closes_at_n, |n| fixed(n, 2))])
        .collect();
    if !rows.is_empty() {
        let _ = write!(text, "\n{}", text_table(&[&format!("gap at n = {}", level(n)), "mm", "closes at n"], &rows));
    }
    for (what, units) in [("torsion spring", ["N·m/rad", "N·m·s/rad", "N·m"]), ("spring", ["N/mm", "N·s/mm", "N"])]
    {
        let rows: Vec<_> = mechanism.springs.iter().filter_map(|spring| spring_row(mechanism, spring, what)).collect();
        if !rows.is_empty() {
            let [stiffness, damping, preload] = units;
            let numbers = [("stiffness", stiffness), ("damping", damping), ("preload", preload)];
            let numbers = numbers.map(|(of, unit)| format!("{of}, {unit}"));
            let heading: Vec<_> = [what, "of", "and"].into_iter().chain(numbers.iter().map(String::as_str)).collect();
            let _ = write!(text, "\n{}", text_table(&heading, &rows));
        }
    }
    print(&text)?;
    warn(&warnings);
    Ok(())
}

/// The row of a `spring` in the table of what is called `of`; `None` if it is of the other kind.
fn spring_row(mechanism: &Mechanism, spring: &Spring, of: &str) -> Option<Vec<String>> {
    let (is_torsion, preload) = match spring.kind {
        SpringKind::Torsion { rest } => (true, spring.stiffness * rest),
        SpringKind::Line { ends: [first, second], free_length } => {
            let squares = first.iter().zip(second).map(|(a, b)| (a - b) * (a - b));
            (false, spring.stiffness * (libm::sqrt(squares.sum()) - free_length))
        }
    };
    let scale = if is_torsion { 1.0 } else { 1e-3 };
    let numbers = [spring.stiffness * scale, spring.damping * scale, preload];
    let names = spring.between.map(|port| mechanism.name_of(port).to_owned());
    let row = std::iter::once(spring.name.clone()).chain(names).chain(numbers.map(ten_digits)).collect();
    (is_torsion == (of == "torsion spring")).then_some(row)
}

/// What a designer should know before trusting a run.
pub fn warnings_of(mechanism: &Mechanism) -> Result<Vec<String>, Failure> {
    Ok(warnings(mechanism, &Freedom::of(mechanism)?))
}

fn warnings(mechanism: &Mechanism, freedom: &Freedom) -> Vec<String> {
    let mut warnings = mechanism.warnings.clone();
    let driven = mechanism.drives.len() as i64;
    let free = freedom.degrees_of_freedom;
    if free < driven {
        warnings.push(format!("{free} degrees of freedom are left for {driven} drives: the joints hold the mechanism"));
        return warnings;
    }
    let word = |locked: &Locked| {
        let meaning = match locked.side {
            DriveSide::Edge => format!(
                "\"{}\" passes on the line of the other resistances, so that the least offset outwards locks \"{}\" on \"{}\"",
                locked.drive, locked.body, locked.on
            ),
            _ => format!("no force of \"{}\" moves \"{}\" on \"{}\"", locked.drive, locked.body, locked.on),
        };
        let levers: Vec<_> = locked.levers.iter().map(|lever| ([lever.length, lever.distance], "beside")).collect();
        self_locking(locked.friction, locked.critical_friction, locked.angle, &levers, &meaning)
    };
    let reversed = |found: &Reversal| {
        let Reversal { drive, body, pivot, angle } = found;
        let when = match *angle > 0.0 {
            true => format!("once {body} has turned by {}°", fixed(angle.to_degrees(), 1)),
            false => "from the start".into(),
        };
        format!(
            "{drive} pushes {body} at a point away from its centre of mass, whose speed it controls: {when} the two are on different sides \
             of {pivot}, and the drive runs away from its command"
        )
    };
    warnings.extend(locked(mechanism).iter().map(word));
    warnings.extend(reversals(mechanism).iter().map(reversed));
    warnings
}
