//! What `sweep` says of a mechanism.

use std::fmt::Write;

use serde::Serialize;
use slipfit_system::{files, parallel};
use slipfit_tolerance::number::{fixed, level, or_dash};

use super::{DriveReport, Wanted, doubt, shown, units};
use crate::{
    cli::{
        arguments::ThreadArguments,
        failure::Failure,
        terminal::{print, print_json, progress, text_table, warn},
    },
    dynamics::{answer::ranges_of, outcome::Outcome},
    mechanism::{Action, Mechanism, RunError, confirmed},
    show::{export::rows_csv, figure::drives_over_n},
};

#[derive(Serialize)]
struct SweepReport<'a> {
    title: &'a str,
    levels: Vec<LevelReport<'a>>,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct LevelReport<'a> {
    n: f64,
    drives: Vec<DriveReport<'a>>,
}

/// `sweep` over the mechanism's levels.
pub fn sweep(mechanism: &Mechanism, wanted: &Wanted, threads: &ThreadArguments) -> Result<(), Failure> {
    wanted.check_outputs()?;
    if mechanism.drives.is_empty() {
        return Err(Failure::Input("the mechanism has no [[drive]], whose force a sweep tells".into()));
    }
    let n = mechanism.sweep.levels();
    let units_of: Vec<_> =
        n.iter().map(|n| mechanism.gaps_at(&[*n]).map(|gaps| (*n, gaps))).collect::<Result<_, _>>()?;
    let bar = progress("simulating", n.len());
    let one = |(n, gaps): &(f64, Vec<f64>)| -> Result<_, RunError> {
        let [one, finer] = confirmed(mechanism, gaps, 1e-3)?;
        bar.inc(1);
        let doubts = doubt::warnings(mechanism, &one, &finer, &one.agreement(&finer, mechanism));
        Ok(((*n, one.outcomes), doubts))
    };
    let levels = threads.install(|| parallel::try_map(&units_of, one))?;
    bar.finish_and_clear();
    let (levels, doubts): (Vec<_>, Vec<_>) = levels?.into_iter().unzip();
    if let Some(path) = wanted.csv {
        files::write(path, &rows_csv(&table(mechanism, &levels))?)?;
    }
    if let Some(path) = wanted.plot {
        let judged = |k: usize| levels.iter().map(|(n, all)| (*n, all[k].verdict, all[k].peak_force)).collect();
        let named = mechanism.drives.iter().enumerate();
        let drives: Vec<_> =
            named.map(|(k, drive)| (format!("{} ({})", drive.name, units(drive.action)[0]), judged(k))).collect();
        let svg = drives_over_n(&drives, &mechanism.title).map_err(anyhow::Error::from)?;
        files::write(path, svg.as_bytes())?;
    }
    let mut warnings = wanted.warnings(mechanism)?;
    warnings.extend(doubtful(&levels, &doubts));
    if wanted.scene.json {
        let level = |(n, outcomes): &(f64, Vec<Outcome>)| {
            let drives = mechanism.drives.iter().zip(outcomes).map(|(drive, outcome)| DriveReport {
                name: &drive.name,
                unit: units(drive.action)[0],
                outcome: *outcome,
            });
            LevelReport { n: *n, drives: drives.collect() }
        };
        let levels = levels.iter().map(level).collect();
        return print_json(&SweepReport { title: &mechanism.title, levels, warnings });
    }
    let mut text = format!("{}\n", mechanism.title);
    for (k, drive) in mechanism.drives.iter().enumerate() {
        let [force, speed] = units(drive.action);
        let verdicts: Vec<_> = levels.iter().map(|(n, outcomes)| (*n, outcomes[k].verdict)).collect();
        let _ = write!(text, "\n{}: {}\n\n", drive.name, ranges_of(&verdicts).join("; "));
        let rows: Vec<_> = levels
            .iter()
            .map(|(n, outcomes)| {
                let outcome = &outcomes[k];
                vec![
                    level(*n),
                    or_dash(outcome.peak_force, |f| fixed(f, 4)),
                    or_dash(outcome.settled_force, |f| fixed(f, 4)),
                    fixed(outcome.final_velocity * shown(drive.action), 3),
                    outcome.verdict.to_string(),
                ]
            })
            .collect();
        let heading =
            ["n", &format!("peak, {force}"), &format!("settled, {force}"), &format!("final, {speed}"), "verdict"];
        text += &text_table(&heading, &rows);
    }
    print(&text)?;
    warn(&warnings);
    Ok(())
}

/// What speaks against the runs of `levels`, of the first of which it does.
fn doubtful(levels: &[(f64, Vec<Outcome>)], doubts: &[Vec<String>]) -> Option<String> {
    let mut doubted = levels.iter().zip(doubts).filter_map(|((n, _), doubts)| Some((*n, doubts.first()?)));
    let (n, doubt) = doubted.next()?;
    let others = match doubted.count() {
        0 => String::new(),
        1 => " (and at another level)".into(),
        more => format!(" (and at {more} other levels)"),
    };
    Some(format!("at n = {}{others}: {doubt}", level(n)))
}

/// The figures of all drives over n.
fn table(mechanism: &Mechanism, levels: &[(f64, Vec<Outcome>)]) -> crate::mechanism::Samples {
    let of_drive = mechanism.drives.iter().flat_map(|drive| {
        let [force, speed] =
            if matches!(drive.action, Action::Pushes { .. }) { ["N", "m/s"] } else { ["N·m", "rad/s"] };
        let name = &drive.name;
        [format!("{name}.peak ({force})"), format!("{name}.settled ({force})"), format!("{name}.final ({speed})")]
    });
    let columns = std::iter::once("n".to_owned()).chain(of_drive).collect();
    let row = |(n, outcomes): &(f64, Vec<Outcome>)| {
        let of_drive = outcomes.iter().flat_map(|outcome| {
            let known = |x: Option<f64>| x.unwrap_or(f64::NAN);
            [known(outcome.peak_force), known(outcome.settled_force), outcome.final_velocity]
        });
        std::iter::once(*n).chain(of_drive).collect()
    };
    crate::mechanism::Samples { columns, rows: levels.iter().map(row).collect() }
}
