//! How bodies of each kind are kept and told of: in a plane, free in space, and on ideal joints in space.

use slipfit_core::{
    SVector,
    pose::Pose,
    system::{Bodies, Reduced, planar::PlanarTree, spatial::{FreeBodies, tree::SpatialTree}},
};

use super::{
    Mechanism, Mounts,
    columns::{self, BodyMotion, JointedBodies, PlanarBodies},
    element::{PlanarElement, SpatialElement},
    state::State,
};

/// What is made of the poses `P` of some bodies with `D` coordinates.
pub(super) trait Told<P, const D: usize> {
    /// The state at a `pose` and `rates` that come after the last ones.
    fn state(&mut self, pose: &P, rates: [f64; D]) -> State<D>;

    /// Puts how the bodies move in place of what was `told`.
    fn tell(&self, state: &State<D>, told: &mut Vec<BodyMotion>);

    /// The gap (m) of each element that is a contact.
    fn gaps(&self, pose: &P, velocity: &SVector<f64, D>) -> Vec<Option<f64>>;
}

/// Bodies in a plane.
pub(super) struct InPlane<'a, const D: usize> {
    tree: &'a PlanarTree<f64, D>,
    elements: &'a [PlanarElement<D>],
    bodies: PlanarBodies<'a, D>,
    last: [f64; D],
}

impl<'a, const D: usize> InPlane<'a, D> {
    /// The bodies of `mechanism`, which start at the coordinates `start` (m, rad).
    pub fn new(
        mechanism: &Mechanism,
        mounts: &Mounts,
        tree: &'a PlanarTree<f64, D>,
        elements: &'a [PlanarElement<D>],
        start: [f64; D],
    ) -> Self {
        Self { tree, elements, bodies: PlanarBodies::of(mechanism, mounts, tree), last: start }
    }
}

impl<const D: usize> Told<[[f64; 2]; D], D> for InPlane<'_, D> {
    fn state(&mut self, pose: &[[f64; 2]; D], rates: [f64; D]) -> State<D> {
        let state = State::planar(self.tree.topology(), pose, rates, &self.last);
        self.last = state.places;
        state
    }

    fn tell(&self, state: &State<D>, told: &mut Vec<BodyMotion>) {
        self.bodies.tell(state, told);
    }

    fn gaps(&self, pose: &[[f64; 2]; D], velocity: &SVector<f64, D>) -> Vec<Option<f64>> {
        let placed = self.tree.placed(pose, velocity);
        self.elements.iter().map(|element| element.gap((self.tree, &placed))).collect()
    }
}

/// Free bodies in space.
pub(super) struct InSpace<'a, const N: usize, const D: usize> {
    bodies: &'a FreeBodies<f64, N, D>,
    elements: &'a [SpatialElement],
    last: State<D>,
}

impl<'a, const N: usize, const D: usize> InSpace<'a, N, D> {
    /// These `bodies`.
    pub fn new(bodies: &'a FreeBodies<f64, N, D>, elements: &'a [SpatialElement]) -> Self {
        Self { bodies, elements, last: State::at_rest([0.0; D]) }
    }
}

impl<const N: usize, const D: usize> Told<[Pose<f64>; N], D> for InSpace<'_, N, D> {
    fn state(&mut self, poses: &[Pose<f64>; N], rates: [f64; D]) -> State<D> {
        self.last = State::spatial(poses, rates, &self.last);
        self.last
    }

    fn tell(&self, state: &State<D>, told: &mut Vec<BodyMotion>) {
        columns::spatial(state, told);
    }

    fn gaps(&self, poses: &[Pose<f64>; N], velocity: &SVector<f64, D>) -> Vec<Option<f64>> {
        let placed = self.bodies.placed(poses, velocity);
        self.elements.iter().map(|element| element.gap((self.bodies, &placed))).collect()
    }
}

/// Bodies in space on ideal joints.
pub(super) struct OnJoints<'a, const N: usize, const W: usize, const D: usize> {
    tree: &'a SpatialTree<f64, N, W, D>,
    elements: &'a [SpatialElement],
    bodies: &'a JointedBodies<N, W, D>,
    last: State<D>,
}

impl<'a, const N: usize, const W: usize, const D: usize> OnJoints<'a, N, W, D> {
    /// These `bodies` of `tree`, which start at the coordinates `start` (m, rad).
    pub fn new(
        tree: &'a SpatialTree<f64, N, W, D>,
        elements: &'a [SpatialElement],
        bodies: &'a JointedBodies<N, W, D>,
        start: [f64; D],
    ) -> Self {
        Self { tree, elements, bodies, last: State::at_rest(start) }
    }
}

impl<const N: usize, const W: usize, const D: usize> Told<[[f64; 2]; D], D> for OnJoints<'_, N, W, D> {
    fn state(&mut self, pose: &[[f64; 2]; D], rates: [f64; D]) -> State<D> {
        self.last = State::on_joints(self.tree, pose, rates, &self.last);
        self.last
    }

    fn tell(&self, state: &State<D>, told: &mut Vec<BodyMotion>) {
        self.bodies.tell(state, told);
    }

    fn gaps(&self, pose: &[[f64; 2]; D], velocity: &SVector<f64, D>) -> Vec<Option<f64>> {
        let placed = self.tree.placed(pose, velocity);
        self.elements.iter().map(|element| element.gap(self.tree.free(&placed))).collect()
    }
}
