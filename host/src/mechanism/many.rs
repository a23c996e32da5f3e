//! Units of one production, simulated several at a time on the lanes of vector registers.
//!
//! The results are equal, bit for bit, to those of units simulated one by one.

use std::{ops::ControlFlow, time::Duration};

use slipfit_core::{
    SVector,
    integrator::Motion,
    system::{Bodies as _, planar::PlanarTree},
};
use slipfit_desk::{
    error_control::{Effort, Stopped},
    plant::{Allowed, Reported},
    units::{self, OnLanes, Unit, UnitObserver},
};

use super::{
    Mechanism, Mounts, RunError,
    bends::bends,
    element::PlanarElement,
    record::MechanismRun,
    recorder::Recorder,
    run::{PlanarUnit, run_without_output},
};

/// One unit of a production.
pub struct ProductionUnit {
    /// The mechanism with the unit's own parameters.
    pub mechanism: Mechanism,
    /// The unit's gaps (m).
    pub gaps: Vec<f64>,
}

/// The result of each unit.
type Found = Vec<Result<MechanismRun, RunError>>;

/// Units of `mechanism` that one thread runs in a batch: many enough that few lanes are idle at its end, few enough that all threads
/// have work.
pub fn batch_size(mechanism: &Mechanism) -> usize {
    if mechanism.planar && units::lane_count(usize::MAX).is_some() { 32 } else { 1 }
}

/// Runs `made` units, at most `lanes` at a time on one thread. The results have no motion.
pub fn run_units(made: &[ProductionUnit], lanes: usize) -> Found {
    let mounts = |made: &ProductionUnit| made.mechanism.planar.then(|| Mounts::of(&made.mechanism).ok()).flatten();
    match units::lane_count(lanes).zip(made.iter().map(mounts).collect::<Option<Vec<_>>>()) {
        None => made.iter().map(run_alone).collect(),
        Some((lanes, mounts)) => match mounts.first().map_or(0, |mounts| mounts.coordinates().len()) {
            ..=3 => in_plane::<3>(made, &mounts, lanes),
            _ => in_plane::<6>(made, &mounts, lanes),
        },
    }
}

fn run_alone(ProductionUnit { mechanism, gaps }: &ProductionUnit) -> Result<MechanismRun, RunError> {
    run_without_output(mechanism, gaps)
}

fn in_plane<const D: usize>(made: &[ProductionUnit], mounts: &[Mounts], lanes: usize) -> Found
where
    PlanarTree<f64, D>: OnLanes<D, Pose = [[f64; 2]; D], Element = PlanarElement<D>>,
{
    let unit =
        |(made, mounts): (&ProductionUnit, &Mounts)| PlanarUnit::<D>::new(&made.mechanism, mounts, &made.gaps).ok();
    let mut ready: Vec<_> = made.iter().zip(mounts).map(unit).collect();
    // Units with another structure than the first, or with elements that lanes do not have, run alone.
    let first = ready.iter().flatten().next().map(|first| (first.tree, first.elements.clone()));
    for ready in &mut ready {
        let is_like = |unit: &PlanarUnit<D>| {
            let first = first.as_ref().map(|(tree, elements)| (tree, &elements[..]));
            unit.elements.iter().all(PlanarElement::runs_on_lanes)
                && first.is_some_and(|first| units::same_structure(first, (&unit.tree, &unit.elements)))
        };
        *ready = ready.take().filter(is_like);
    }
    let error = |unit: &PlanarUnit<D>| {
        let (limits, least_mass) = (unit.limits, unit.tree.least_mass());
        move |step: Reported, length: f64| limits.error(&step, length, least_mass)
    };
    let errors: Vec<_> = ready.iter().map(|unit| unit.as_ref().map(error)).collect();
    let bends: Vec<_> = made.iter().map(|made| bends(&made.mechanism)).collect();
    let all = made.iter().zip(mounts).zip(&ready);
    let runs = all.map(|((ProductionUnit { mechanism, .. }, mounts), unit)| {
        let unit = unit.as_ref()?;
        let kinematics = Box::new(unit.kinematics(mechanism, mounts));
        Some(UnitRun::Running(Some(Recorder::new(mechanism, kinematics, &unit.start, &unit.limits, false))))
    });
    let mut runs: Vec<_> = runs.collect();
    let mut units = Vec::new();
    for (k, run) in runs.iter_mut().enumerate() {
        if let (Some(unit), Some(error), Some(observer)) = (&ready[k], &errors[k], run) {
            units.push(Unit {
                bodies: unit.tree,
                elements: unit.elements.clone(),
                start: unit.start,
                duration: made[k].mechanism.run.duration,
                allowed: Allowed { error, depth: unit.limits.place(), bends: &bends[k] },
                observer,
            });
        }
    }
    PlanarTree::integrate_on_lanes(lanes, &mut units);
    drop(units);
    let found = made.iter().zip(runs).map(|(made, run)| match run {
        Some(UnitRun::Finished(found)) => Ok(found?),
        _ => run_alone(made),
    });
    found.collect()
}

/// A unit in motion, then its result: made as soon as the motion ends, so that only the units on lanes occupy memory.
enum UnitRun<'a, P, const D: usize> {
    Running(Option<Recorder<'a, P, D>>),
    Finished(Result<MechanismRun, Stopped>),
}

impl<P: Copy, const D: usize> UnitObserver<P, D> for UnitRun<'_, P, D> {
    fn observe(
        &mut self,
        t: f64,
        motion: &Motion<f64, P, (), D>,
        accelerations: Option<[SVector<f64, D>; 2]>,
        least_gap: f64,
    ) -> ControlFlow<()> {
        match self {
            Self::Running(Some(recorder)) => recorder.keep(t, motion, accelerations, Some(least_gap)),
            _ => ControlFlow::Break(()),
        }
    }

    fn finish(&mut self, steps: Result<Effort, Stopped>) {
        if let Self::Running(recorder) = self
            && let Some(recorder) = recorder.take()
        {
            *self = Self::Finished(recorder.finished(steps, Duration::ZERO, None));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Found, ProductionUnit, run_alone, run_units};
    use crate::{
        mechanism::{
            MechanismRun, Mounts, Parameter, SlidingData, Spring, SpringKind, element::PlanarElement, run::PlanarUnit,
        },
        scene::{Override, SceneFile, shipped},
        setup::Adjustable as _,
    };

    /// `count` units of a shipped mechanism with these settings, each with gaps, friction and masses of its own.
    fn units(name: &str, set: &[&str], count: usize) -> Vec<ProductionUnit> {
        let set: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
        let mechanism = SceneFile::parse(name, shipped(name).unwrap(), &set).unwrap().mechanism.unwrap();
        let mut seed = 5u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            3.0 * (f64::from(seed) / 4_294_967_296.0 - 0.5)
        };
        let unit = |_| {
            let levels: Vec<f64> = mechanism.gaps.iter().map(|_| next()).collect();
            let mut own = mechanism.clone();
            Parameter::Friction.vary(&mut own, 0.01 * next());
            Parameter::Mass(0).vary(&mut own, 0.05 * mechanism.bodies[0].mass * next());
            ProductionUnit { gaps: own.gaps_at(&levels).unwrap(), mechanism: own }
        };
        (0..count).map(unit).collect()
    }

    /// All that is found of units but the time that it took.
    fn without_time(found: Found) -> Vec<String> {
        let one = |run: MechanismRun| {
            let MechanismRun { outcomes, energy_excess, sunk, effort, .. } = run;
            format!("{outcomes:?} {energy_excess:?} {sunk:?} {effort:?}")
        };
        found.into_iter().map(|run| one(run.unwrap())).collect()
    }

    /// What is found of units depends neither on how many run at a time, nor on which run together.
    fn compare(name: &str, set: &[&str]) {
        let mut made = units(name, set, 19);
        // One that is not like the others.
        made[7].mechanism.joints.iter_mut().for_each(|joint| joint.laws.friction = SlidingData::NONE);
        assert!(run_on_lanes(&made[0]), "{name}");
        compare_units(&made);
    }

    fn compare_units(made: &[ProductionUnit]) {
        let expected = without_time(made.iter().map(run_alone).collect());
        for lanes in [1, 4, 8] {
            assert_eq!(without_time(run_units(made, lanes)), expected, "{lanes}");
            assert_eq!(without_time(run_units(&made[3..6], lanes)), expected[3..6], "{lanes}");
        }
        assert_ne!(expected[0], expected[1]);
    }

    /// Whether lanes have all elements of a unit.
    fn run_on_lanes(ProductionUnit { mechanism, gaps }: &ProductionUnit) -> bool {
        let mounts = Mounts::of(mechanism).unwrap();
        let unit = PlanarUnit::<6>::new(mechanism, &mounts, gaps).unwrap();
        unit.elements.iter().all(PlanarElement::runs_on_lanes)
    }

    /// What lanes do not have is not left out.
    #[test]
    fn units_with_other_elements_run_one_by_one() {
        let mut made = units("slider-crank", &["run.duration=0.1"], 6);
        for ProductionUnit { mechanism, .. } in &mut made {
            let kind = SpringKind::Line { ends: [[0.0; 3], [0.1, 0.1, 0.0]], free_length: 0.05 };
            let name = "spring".to_owned();
            mechanism.springs.push(Spring { name, between: [Some(2), None], stiffness: 50.0, damping: 0.0, kind });
        }
        assert!(!run_on_lanes(&made[0]));
        compare_units(&made);
    }

    #[test]
    fn units_that_run_together_have_the_bits_that_they_have_alone() {
        compare("slider-crank", &["run.duration=0.3"]);
        compare("four-bar", &["run.duration=0.3"]);
        compare("slider-crank-guide", &["run.duration=0.3"]);
        compare("woodpecker-toy", &["run.duration=0.3"]);
    }

    #[test]
    fn so_have_those_with_a_drive_train() {
        let train =
            ["limit=0.4", "viscous=1e-3", "coulomb=0.02", "stick_band=1"].map(|key| format!("drive.motor.{key}"));
        let set: Vec<&str> = train.iter().map(String::as_str).chain(["run.duration=0.3"]).collect();
        compare("slider-crank", &set);
    }
}
