//! Contacts of bodies in space side by side, as the desk computes them, against the same one after the other.

use std::ops::ControlFlow;

use slipfit_core::{
    SVector,
    integrator::{Motion, Rodas4},
    pose::Pose,
    system::{Bodies, System, spatial::FreeBodies},
};
use slipfit_desk::{
    element::SpatialElement,
    error_control::{Watched, integrate},
    out_of_line::{Contacts, InTurn, OutOfLine},
    plant::Reported,
    side_by_side::SideBySide,
};

use super::{Mechanism, joint_elements::joints_of_elements, limits::Limits, spatial};
use crate::scene::{SceneFile, shipped};

/// Free bodies with what acts on them.
type Free<'a, const N: usize, const D: usize> = System<FreeBodies<f64, N, D>, &'a [SpatialElement]>;

/// Times (s) and velocities at the ends of the steps of `mechanism`, its contacts computed as `contacts` does.
fn steps<C, const N: usize, const D: usize>(mechanism: &Mechanism, contacts: C) -> Vec<(f64, SVector<f64, D>)>
where
    C: for<'a> Contacts<f64, Free<'a, N, D>, D>,
    for<'a> Free<'a, N, D>: slipfit_core::mechanism::Mechanism<f64, D, Pose = [Pose<f64>; N], Internal = ()>,
{
    let bodies = spatial::bodies::<N, D>(mechanism).unwrap();
    let limits = Limits::of(mechanism, |body| bodies.lever(body));
    let elements = spatial::elements(mechanism, &mechanism.gaps_at(&[0.5]).unwrap(), limits.stick_band()).unwrap();
    let zero = SVector::zeros();
    let start = Motion { pose: bodies.nominal(), velocity: zero, acceleration: zero, internal: () };
    let least_mass = bodies.least_mass();
    let desk = OutOfLine::by(System::new(bodies, &elements[..]), contacts);
    let mut steps = Vec::new();
    let error = |step: &slipfit_core::integrator::Step<f64, _, _, D>, length: f64| {
        let reported = Reported { residual: step.residual, error: step.error, drift: step.drift };
        limits.error(&reported, length, least_mass)
    };
    let unwatched = Watched { gaps: |_: &_, _: &mut _| (), depth: 0.0, bends: &[] };
    integrate::<Rodas4, _, D>(&desk, start, 0.2, error, unwatched, |t, motion, _, _| {
        steps.push((t, motion.velocity));
        ControlFlow::Continue(())
    })
    .unwrap();
    steps
}

/// `quads` times four contacts side by side move the bodies as those one after the other do, except for the order of sums; and lane by
/// lane they have the bits of the machine's registers.
fn compare<const N: usize, const D: usize>(name: &str, quads: usize) {
    let mechanism = SceneFile::parse(name, shipped(name).unwrap(), &[]).unwrap().mechanism.unwrap();
    let bodies = spatial::bodies::<N, D>(&mechanism).unwrap();
    let band = Limits::of(&mechanism, |body| bodies.lever(body)).stick_band();
    let elements = spatial::elements(&mechanism, &mechanism.gaps_at(&[0.5]).unwrap(), band).unwrap();
    let laws = || joints_of_elements(&mechanism).map(|joint| joint.map(|joint| joint.laws));
    let by_lane = SideBySide::<N, D>::by_lane(&elements, laws());
    assert_eq!(by_lane.counts(), (quads, elements.len() - 4 * quads), "{name}");
    let by_lane = steps::<_, N, D>(&mechanism, by_lane);
    let wide = steps::<_, N, D>(&mechanism, SideBySide::new(&bodies, &elements, laws(), band));
    assert!(by_lane == wide, "{name}: {} and {} steps", by_lane.len(), wide.len());
    let in_turn = steps::<_, N, D>(&mechanism, InTurn);
    let most = in_turn.iter().fold(0.0f64, |most, (_, velocity)| most.max(velocity.amax()));
    let ends = [&by_lane, &in_turn].map(|steps| steps.last().unwrap().1);
    assert!((ends[0] - ends[1]).amax() < 1e-5 * most, "{name}: {} {}", ends[0], ends[1]);
}

#[test]
fn contacts_side_by_side_are_those_in_turn() {
    compare::<1, 6>("linear-guide", 2);
    compare::<1, 6>("hatch", 1);
    compare::<2, 12>("telescopic-drawer", 2);
}
