//! Many units of one production, several at a time where the machine has registers for that.
//!
//! A unit has the bits that it has alone.

use std::time::Instant;

use slipfit_desk::{
    grouped::Grouped,
    plant::{Allowed, Reported},
    units::{self, Unit},
};

use super::{
    Mechanism, Mounts, RunError,
    bends::bends,
    record::MechanismRun,
    recorder::Recorder,
    run::{PlanarUnit, run},
};

/// One unit of a production.
pub struct Made {
    /// The mechanism with the unit's own parameters.
    pub mechanism: Mechanism,
    /// The unit's gaps (m).
    pub gaps: Vec<f64>,
}

/// The most pieces of a command with which units share their steps: each looks at all of them.
const MOST_PIECES: usize = 16;

/// Runs `made` units and tells of each every `every` (s): what [`run`] says of each.
pub fn run_many(made: &[Made], every: f64) -> Vec<Result<MechanismRun, RunError>> {
    let shared = made.first().and_then(|first| {
        let mechanism = &first.mechanism;
        if made.len() == 1 || !mechanism.planar || !mechanism.drives.iter().all(shares) {
            return None;
        }
        match Mounts::of(mechanism).ok()?.coordinates().len() {
            3 => in_plane::<3>(made, every),
            _ => None,
        }
    });
    shared.unwrap_or_else(|| made.iter().map(|Made { mechanism, gaps }| run(mechanism, gaps, every)).collect())
}

/// Whether units with this drive share their steps: controllers that sample hold what they hold.
fn shares(drive: &super::NamedDrive) -> bool {
    drive.sampling.is_none() && drive.command.as_ref().is_none_or(|command| command.pieces.0.len() <= MOST_PIECES)
}

fn in_plane<const D: usize>(made: &[Made], every: f64) -> Option<Vec<Result<MechanismRun, RunError>>> {
    let ready: Vec<Result<_, RunError>> = made
        .iter()
        .map(|Made { mechanism, gaps }| {
            let mounts = Mounts::of(mechanism)?;
            Ok((PlanarUnit::<D>::new(mechanism, &mounts, gaps)?, mounts, bends(mechanism)))
        })
        .collect();
    let elements: Vec<_> =
        ready.iter().map(|ready| ready.as_ref().ok().map(|(unit, ..)| Grouped::none(unit.elements.clone()))).collect();
    let first = ready.iter().zip(&elements).find_map(|(ready, elements)| Some((&ready.as_ref().ok()?.0.tree, elements.as_ref()?)))?;
    let alike: Vec<bool> = ready
        .iter()
        .zip(&elements)
        .map(|(ready, elements)| match (ready, elements) {
            (Ok((unit, ..)), Some(elements)) => units::are_alike(first, (&unit.tree, elements)),
            _ => false,
        })
        .collect();
    let together = || made.iter().zip(&ready).zip(&alike).filter(|(_, alike)| **alike).filter_map(|((made, ready), _)| Some((made, ready.as_ref().ok()?)));
    let mut recorders: Vec<_> = together()
        .map(|(Made { mechanism, .. }, (unit, mounts, _))| {
            Recorder::new(mechanism, Box::new(unit.told(mechanism, mounts)), &unit.start, &unit.limits)
        })
        .collect();
    let errors: Vec<_> = together()
        .map(|(_, (unit, ..))| {
            let least_mass = slipfit_core::system::Bodies::least_mass(&unit.tree);
            move |step: Reported, length: f64| unit.limits.error(&step, length, least_mass)
        })
        .collect();
    let mut sees: Vec<_> = recorders
        .iter_mut()
        .map(|recorder| move |t: f64, motion: &_, accelerations, gap| recorder.keep(t, motion, accelerations, gap))
        .collect();
    let elements = elements.into_iter().zip(&alike).filter(|(_, alike)| **alike).filter_map(|(elements, _)| elements);
    let mut units: Vec<_> = together()
        .zip(elements)
        .zip(&errors)
        .zip(&mut sees)
        .map(|((((Made { mechanism, .. }, (unit, _, bends)), elements), error), see)| Unit {
            bodies: unit.tree,
            elements,
            start: unit.start,
            duration: mechanism.run.duration,
            allowed: Allowed { error, depth: unit.limits.place(), bends },
            see,
        })
        .collect();
    let clock = Instant::now();
    let efforts = units::move_in_plane(&mut units)?;
    let time = clock.elapsed() / efforts.len().max(1) as u32;
    drop(units);
    drop(sees);
    let mut moved = recorders.into_iter().zip(efforts);
    let found = made.iter().zip(&alike).map(|(Made { mechanism, gaps }, alike)| {
        match if *alike { moved.next() } else { None } {
            Some((recorder, effort)) => Ok(recorder.finished(effort, time, (every, 0))?),
            None => run(mechanism, gaps, every),
        }
    });
    Some(found.collect())
}
