//! Bodies whose joints reduce what acts on them to their coordinates.

use super::Bodies;
use crate::{SVector, Scalar};

/// Bodies on ideal joints with `D` coordinates, which as free ones have `W` velocities.
pub trait Reduced<S: Scalar, const D: usize, const W: usize>: Bodies<S, D> {
    /// The bodies without their joints.
    type Free: Bodies<S, W>;

    /// The free bodies, as they are `placed`.
    fn free<'a>(&'a self, placed: &'a Self::Placed) -> (&'a Self::Free, &'a <Self::Free as Bodies<S, W>>::Placed);

    /// The generalised force (N, N·m) of forces and torques on the free bodies, in the axes in which their elements add up.
    fn reduced_force(&self, placed: &Self::Placed, force: &SVector<S, W>) -> SVector<S, D>;

    /// Adds to `sum` how a `force` on the free bodies goes by the coordinates, where the matrix tells how it goes by those of the free
    /// bodies; see [`Link::add_impedance`](super::Link::add_impedance).
    fn add_reduced_impedance(
        &self,
        placed: &Self::Placed,
        of_free: (&SVector<S, W>, &<Self::Free as Bodies<S, W>>::Jacobian),
        a: S,
        sum: &mut Self::Jacobian,
    );

    /// The same by velocity and place; see [`Link::add_derivatives`](super::Link::add_derivatives).
    fn add_reduced_derivatives(
        &self,
        placed: &Self::Placed,
        force: &SVector<S, W>,
        of_free: [&<Self::Free as Bodies<S, W>>::Jacobian; 2],
        damping: &mut Self::Jacobian,
        stiffness: &mut Self::Jacobian,
    );
}
