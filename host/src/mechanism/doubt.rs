//! Warnings of a run that a run at a tenth of the tolerance does not confirm, or whose parts sink deep into each other.

use slipfit_tolerance::number::{fixed, three_digits};

use super::{ENERGY, Mechanism, MechanismRun, NamedDrive, Sunk, agreement::Agreement};
use crate::dynamics::outcome::{Outcome, Verdict};

/// What speaks against the `desk`'s run of `mechanism`, by a `finer` one with which it has this `agreement`.
pub fn doubts(mechanism: &Mechanism, desk: &MechanismRun, finer: &MechanismRun, agreement: &Agreement) -> Vec<String> {
    let unconfirmed = undecided(mechanism, desk, finer).or_else(|| coarse(agreement));
    unconfirmed.into_iter().chain(desk.sunk.as_ref().map(sunk)).collect()
}

/// The warning of a contact that yields too much to stand for parts that touch.
fn sunk(Sunk { joint, depth, usual }: &Sunk) -> String {
    let [depth, usual] = [depth, usual].map(|length| three_digits(length * 1e3));
    format!(
        "in \"{joint}\" the parts sink {depth} mm into each other, usual is up to {usual} mm: is its contact.stiffness in the unit that \
         is meant, and are drives, speeds and masses of their true size?"
    )
}

/// Why a verdict of the desk's run is undecided that a `finer` one would have, if one is.
fn undecided(mechanism: &Mechanism, desk: &MechanismRun, finer: &MechanismRun) -> Option<String> {
    let mut drives = mechanism.drives.iter().zip(desk.outcomes.iter().zip(&finer.outcomes));
    let is_doubtful = |of: &(&NamedDrive, (&Outcome, &Outcome))| {
        of.1.0.verdict == Verdict::Undecided && of.1.1.verdict != Verdict::Undecided
    };
    let (named, (_, better)) = drives.find(is_doubtful)?;
    if desk.energy_excess.is_nan() || desk.energy_excess > ENERGY {
        let excess = fixed(desk.energy_excess * 100.0, 1);
        let name = &named.name;
        return Some(format!(
            "{name}: no verdict, because the run has up to {excess} % more energy than its start, gravity and its drives supplied; take a \
             tenth of run.error"
        ));
    }
    Some(format!(
        "{}: no verdict, because a run at a tenth of the tolerance ({}) differs by more than 1 % in peak, final speed or travel; take a \
         tenth of run.error",
        named.name, better.verdict
    ))
}

/// Difference (share of the peak) to a run at a tenth of the tolerance from which on a warning says so.
const COARSE: f64 = 0.01;

/// The warning of a column that a run at a tenth of the tolerance does not confirm.
fn coarse(agreement: &Agreement) -> Option<String> {
    let column = agreement.column.as_ref().filter(|_| agreement.share.is_nan() || agreement.share > COARSE)?;
    let percent = agreement.share * 100.0;
    Some(format!(
        "a run at a tenth of the tolerance differs by {percent:.1} % of {} in {column}: take a tenth of run.error",
        agreement.whole
    ))
}
