//! Many units of one production, several at a time where the machine has registers for that.
//!
//! A unit has the bits that it has alone.

use std::{ops::ControlFlow, time::Duration};

use slipfit_core::{
    SVector,
    integrator::Motion,
    system::{Bodies as _, planar::PlanarTree},
};
use slipfit_desk::{
    error_control::{Effort, Stopped},
    grouped::Grouped,
    plant::{Allowed, Reported},
    units::{self, Together, Unit, Witness},
};

use super::{
    Mechanism, Mounts, NamedDrive, RunError,
    bends::bends,
    element::PlanarElement,
    record::MechanismRun,
    recorder::Recorder,
    run::{PlanarUnit, judged},
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

/// Runs `made` units, at most `lanes` at a time on one thread. Of none is told how it moves.
pub fn run_many(made: &[Made], lanes: usize) -> Vec<Result<MechanismRun, RunError>> {
    let lanes = made.first().filter(|first| shares(&first.mechanism)).and_then(|_| units::lanes(lanes));
    let together = lanes.and_then(|lanes| in_plane_by_dimension(made, lanes));
    together.unwrap_or_else(|| made.iter().map(alone).collect())
}

fn alone(Made { mechanism, gaps }: &Made) -> Result<MechanismRun, RunError> {
    judged(mechanism, gaps)
}

/// Whether units of `mechanism` share their steps: what a controller that samples holds is not known to others.
fn shares(mechanism: &Mechanism) -> bool {
    mechanism.planar
        && mechanism.drives.iter().all(|NamedDrive { sampling, command, .. }| {
            sampling.is_none() && command.as_ref().is_none_or(|command| command.pieces.0.len() <= MOST_PIECES)
        })
}

/// Runs units in a plane; `None` where none of them has coordinates.
fn in_plane_by_dimension(made: &[Made], lanes: usize) -> Option<Vec<Result<MechanismRun, RunError>>> {
    let mounts: Vec<Mounts> = made.iter().map(|made| Mounts::of(&made.mechanism).ok()).collect::<Option<_>>()?;
    Some(match mounts.first()?.coordinates().len() {
        ..=3 => in_plane::<3>(made, &mounts, lanes),
        _ => in_plane::<6>(made, &mounts, lanes),
    })
}

fn in_plane<const D: usize>(made: &[Made], mounts: &[Mounts], lanes: usize) -> Vec<Result<MechanismRun, RunError>>
where
    PlanarTree<f64, D>: Together<D, Pose = [[f64; 2]; D], Contact = (), Element = PlanarElement<D>>,
{
    let all = || made.iter().zip(mounts);
    let ready: Vec<_> =
        all().map(|(made, mounts)| PlanarUnit::<D>::new(&made.mechanism, mounts, &made.gaps).ok()).collect();
    let bends: Vec<_> = made.iter().map(|made| bends(&made.mechanism)).collect();
    let error = |unit: &PlanarUnit<D>| {
        let (speed, least_mass) = (unit.limits, unit.tree.least_mass());
        move |step: Reported, length: f64| speed.error(&step, length, least_mass)
    };
    let errors: Vec<_> = ready.iter().map(|ready| ready.as_ref().map(error)).collect();
    let mut witnesses: Vec<Option<Judge<_, D>>> = all()
        .zip(&ready)
        .map(|((Made { mechanism, .. }, mounts), ready)| {
            let unit = ready.as_ref()?;
            let told = Box::new(unit.told(mechanism, mounts));
            Some(Judge::Watches(Some(Recorder::new(mechanism, told, &unit.start, &unit.limits, false))))
        })
        .collect();
    let mut units: Vec<Unit<_, (), _, D>> = Vec::new();
    for (k, (((ready, error), witness), bends)) in ready.iter().zip(&errors).zip(&mut witnesses).zip(&bends).enumerate() {
        let (Some(unit), Some(error), Some(witness)) = (ready, error, witness) else { continue };
        let elements = Grouped::none(unit.elements.clone());
        // What is not like the others runs alone.
        if units.first().is_none_or(|first| units::are_alike((&first.bodies, &first.elements), (&unit.tree, &elements))) {
            units.push(Unit {
                bodies: unit.tree,
                elements,
                start: unit.start,
                duration: made[k].mechanism.run.duration,
                allowed: Allowed { error, depth: unit.limits.place(), bends },
                witness,
            });
        }
    }
    PlanarTree::move_together(lanes, &mut units);
    drop(units);
    let found = made.iter().zip(witnesses).map(|(made, witness)| match witness {
        Some(Judge::Has(run)) => Ok(run?),
        _ => alone(made),
    });
    found.collect()
}

/// What makes a run of a motion as soon as it has ended, so that no more of it is kept than of a few units.
enum Judge<'a, P, const D: usize> {
    Watches(Option<Recorder<'a, P, D>>),
    Has(Result<MechanismRun, Stopped>),
}

impl<P: Copy, const D: usize> Witness<P, D> for Judge<'_, P, D> {
    fn see(
        &mut self,
        t: f64,
        motion: &Motion<f64, P, (), D>,
        accelerations: Option<[SVector<f64, D>; 2]>,
        least_gap: f64,
    ) -> ControlFlow<()> {
        match self {
            Self::Watches(Some(recorder)) => recorder.keep(t, motion, accelerations, Some(least_gap)),
            _ => ControlFlow::Break(()),
        }
    }

    fn hear(&mut self, steps: Result<Effort, Stopped>) {
        if let Self::Watches(recorder) = self
            && let Some(recorder) = recorder.take()
        {
            *self = Self::Has(recorder.finished(steps, Duration::ZERO, None));
        }
    }
}
