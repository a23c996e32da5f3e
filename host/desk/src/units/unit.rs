//! A unit to simulate, and its numbers on a lane.

use std::ops::ControlFlow;

use slipfit_core::{SVector, integrator::Motion, system::Bodies};

use crate::{
    error_control::{Accelerations, Effort, Stopped},
    pack::Pack,
    plant::Allowed,
    real::Real,
};

/// A unit to simulate: its bodies and what acts on them, its start, and who observes it.
pub struct Unit<'a, B: Bodies<f64, D>, E, const D: usize> {
    /// The bodies.
    pub bodies: B,
    /// What acts on them.
    pub elements: Vec<E>,
    /// Pose and velocities at the start.
    pub start: (B::Pose, SVector<f64, D>),
    /// Simulated time (s).
    pub duration: f64,
    /// What a step may err by.
    pub allowed: Allowed<'a>,
    /// Observes its motion.
    pub observer: &'a mut dyn UnitObserver<B::Pose, D>,
}

/// Observes the motion of a unit.
pub trait UnitObserver<P, const D: usize> {
    /// Called at the start and at the end of every step with the time `t` (s), the motion, the accelerations (m/s², rad/s²) at both ends of the
    /// step, and the least gap (m) of a contact, infinite without contacts; says whether to go on.
    fn observe(
        &mut self,
        t: f64,
        motion: &Motion<f64, P, (), D>,
        accelerations: Option<Accelerations<D>>,
        least_gap: f64,
    ) -> ControlFlow<()>;

    /// Called at the end with the steps of the whole motion, or why it was stopped.
    fn finish(&mut self, effort: Result<Effort, Stopped>);
}

/// Poses of as many units as there are lanes.
pub trait WidePose<P> {
    /// All units at the same `pose`.
    fn everywhere(pose: &P) -> Self;

    /// The pose of the unit on a `lane`.
    fn of_unit(&self, lane: usize) -> P;

    /// Sets the pose of the unit on a `lane`.
    fn put(&mut self, lane: usize, pose: &P);
}

impl<S: Real, const D: usize> WidePose<[[f64; 2]; D]> for [[S; 2]; D] {
    fn everywhere(pose: &[[f64; 2]; D]) -> Self {
        pose.map(|pair| pair.map(S::from_f64))
    }

    #[inline(always)]
    fn of_unit(&self, lane: usize) -> [[f64; 2]; D] {
        self.map(|pair| pair.map(|number| number.get(lane)))
    }

    fn put(&mut self, lane: usize, pose: &[[f64; 2]; D]) {
        for (numbers, pair) in self.iter_mut().zip(pose) {
            numbers.iter_mut().zip(pair).for_each(|(number, x)| number.set(lane, *x));
        }
    }
}

/// Numbers of some units in the registers of the instructions `V`.
pub type Wide<V> = Pack<V, f64>;
