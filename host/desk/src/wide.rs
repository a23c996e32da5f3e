//! A mechanism's own forces by wide instructions, where the machine has them. The bits are the same.

use pulp::NullaryFnOnce;
use slipfit_core::{
    SVector,
    mechanism::{Differentiated, Mechanism},
};

use crate::out_of_line::Contacts;

/// Instructions for four numbers of double precision at a time.
#[cfg(target_arch = "x86_64")]
pub type Instructions = pulp::x86::V3;

/// There are none that would have to be asked for.
#[cfg(not(target_arch = "x86_64"))]
pub type Instructions = pulp::Scalar;

/// A mechanism's own forces, one contact after the other.
#[derive(Clone, Copy, Debug)]
pub struct Wide(Option<Instructions>);

impl Wide {
    /// With what the machine has.
    pub fn of_machine() -> Self {
        #[cfg(target_arch = "x86_64")]
        return Self(Instructions::try_new());
        #[cfg(not(target_arch = "x86_64"))]
        Self(None)
    }
}

impl<M: Mechanism<f64, D>, const D: usize> Contacts<f64, M, D> for Wide {
    fn forces_by(
        &self,
        mechanism: &M,
        jacobians: &M::Jacobians,
        t: f64,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<f64, D>,
        a: f64,
    ) -> SVector<f64, D> {
        match self.0 {
            Some(instructions) => {
                instructions.vectorize(Forces { mechanism, jacobians, t, pose, internal, velocity, a })
            }
            None => mechanism.forces_by(jacobians, t, pose, internal, velocity, a),
        }
    }

    fn differentiated(
        &self,
        mechanism: &M,
        t: f64,
        pose: &M::Pose,
        internal: &M::Internal,
        velocity: &SVector<f64, D>,
    ) -> Differentiated<f64, M::Jacobians, D> {
        match self.0 {
            Some(instructions) => instructions.vectorize(Derivatives { mechanism, t, pose, internal, velocity }),
            None => mechanism.differentiated(t, pose, internal, velocity),
        }
    }
}

/// Forces, to be computed with wide instructions. A type of its own, not a closure: that is not inlined here.
struct Forces<'a, M: Mechanism<f64, D>, const D: usize> {
    mechanism: &'a M,
    jacobians: &'a M::Jacobians,
    t: f64,
    pose: &'a M::Pose,
    internal: &'a M::Internal,
    velocity: &'a SVector<f64, D>,
    a: f64,
}

/// Forces and their derivatives, likewise.
struct Derivatives<'a, M: Mechanism<f64, D>, const D: usize> {
    mechanism: &'a M,
    t: f64,
    pose: &'a M::Pose,
    internal: &'a M::Internal,
    velocity: &'a SVector<f64, D>,
}

impl<M: Mechanism<f64, D>, const D: usize> NullaryFnOnce for Forces<'_, M, D> {
    type Output = SVector<f64, D>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Self { mechanism, jacobians, t, pose, internal, velocity, a } = self;
        mechanism.forces_by(jacobians, t, pose, internal, velocity, a)
    }
}

impl<M: Mechanism<f64, D>, const D: usize> NullaryFnOnce for Derivatives<'_, M, D> {
    type Output = Differentiated<f64, M::Jacobians, D>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Self { mechanism, t, pose, internal, velocity } = self;
        mechanism.differentiated(t, pose, internal, velocity)
    }
}
