//! Kinematics of bodies in a plane, free in space, and on ideal joints in space.

use nalgebra::{Matrix3, Vector2, Vector3};
use slipfit_core::{
    SVector,
    pose::Pose,
    system::{
        Bodies, Reduced,
        planar::{At, Placed as PlanarPlaced, PlanarTree},
        spatial::{
            FreeBodies, PlacedBody,
            tree::{Placed as JointedPlaced, SpatialTree},
        },
    },
};
use slipfit_desk::element::next_to;

use super::{
    Mechanism, Mounts,
    columns::{self, BodyMotion, JointedBodies, PlanarBodies},
    element::{PlanarElement, SpatialElement},
    state::{State, half_angle, whole_angle},
};

/// Motions of bodies from poses `P` and velocities of `D` coordinates.
pub(super) trait Kinematics<P, const D: usize> {
    /// Moves the bodies to a `pose` and a `velocity` that come after the last ones.
    fn update(&mut self, pose: &P, velocity: &SVector<f64, D>);

    /// The bodies at the last pose.
    fn bodies(&self) -> &[PlacedBody<f64>];

    /// Rotation (rad) of a body there about the axes of the frame since the drawn pose, see [`BodyMotion::turned`].
    fn rotation(&mut self, body: usize) -> Vector3<f64>;

    /// Acceleration (m/s²) of a body's centre of mass there, for these accelerations of the coordinates.
    fn acceleration(&self, body: usize, of_coordinates: &SVector<f64, D>) -> Vector3<f64>;

    /// The same of its rotation (rad/s²).
    fn angular_acceleration(&self, body: usize, of_coordinates: &SVector<f64, D>) -> Vector3<f64>;

    /// The state at a `pose` and `rates` that come after the last ones.
    fn state(&mut self, pose: &P, rates: [f64; D]) -> State<D>;

    /// Replaces `motions` by those of the bodies in a `state`.
    fn body_motions(&self, state: &State<D>, motions: &mut Vec<BodyMotion>);

    /// The gap (m) of each element that is a contact.
    fn gaps(&self, pose: &P, velocity: &SVector<f64, D>) -> Vec<Option<f64>>;
}

/// Bodies in a plane.
pub(super) struct PlanarKinematics<'a, const D: usize> {
    tree: &'a PlanarTree<f64, D>,
    elements: &'a [PlanarElement<D>],
    bodies: PlanarBodies<'a, D>,
    pose: [[f64; 2]; D],
    placed: PlanarPlaced<f64, D>,
    placed_bodies: Vec<PlacedBody<f64>>,
    /// Coordinates (m, rad) when they were asked for last.
    last: [f64; D],
}

impl<'a, const D: usize> PlanarKinematics<'a, D> {
    /// The bodies of `mechanism`, which start at the coordinates `start` (m, rad).
    pub fn new(
        mechanism: &Mechanism,
        mounts: &Mounts,
        tree: &'a PlanarTree<f64, D>,
        elements: &'a [PlanarElement<D>],
        start: [f64; D],
    ) -> Self {
        let pose = tree.pose(start, half_angle);
        Self {
            tree,
            elements,
            bodies: PlanarBodies::of(mechanism, mounts, tree),
            pose,
            placed: tree.placed(&pose, &SVector::zeros()),
            placed_bodies: Vec::new(),
            last: start,
        }
    }
}

impl<const D: usize> Kinematics<[[f64; 2]; D], D> for PlanarKinematics<'_, D> {
    fn update(&mut self, pose: &[[f64; 2]; D], velocity: &SVector<f64, D>) {
        self.pose = *pose;
        self.placed = self.tree.placed(pose, velocity);
        let placed = &self.placed;
        let body = |([displacement_w, velocity_w], turn): ([Vector3<f64>; 2], Option<usize>)| {
            let axis = turn.map_or(Vector2::new(1.0, 0.0), |turn| placed.axes[turn]);
            let rotation = Vector3::z() * turn.map_or(0.0, |turn| placed.rates[turn]);
            PlacedBody {
                to_frame: Matrix3::new(axis.x, -axis.y, 0.0, axis.y, axis.x, 0.0, 0.0, 0.0, 1.0),
                displacement_w,
                velocity_w,
                rotation_b: rotation,
                rotation_w: rotation,
            }
        };
        self.placed_bodies.clear();
        self.placed_bodies.extend(self.bodies.moved(placed).map(body));
    }

    fn bodies(&self) -> &[PlacedBody<f64>] {
        &self.placed_bodies
    }

    fn rotation(&mut self, body: usize) -> Vector3<f64> {
        let Some(turn) = self.bodies.bodies[body].2 else { return Vector3::zeros() };
        self.last[turn] = next_to(whole_angle(self.pose[turn]), self.last[turn]);
        Vector3::z() * self.last[turn]
    }

    fn acceleration(&self, body: usize, of_coordinates: &SVector<f64, D>) -> Vector3<f64> {
        let (centre, ..) = &self.bodies.bodies[body];
        let (topology, placed) = (self.tree.topology(), &self.placed);
        let at = At::of(topology, centre, placed);
        let swept = at.swept(topology, placed, &placed.rates);
        let of = at.velocity(of_coordinates);
        let moved = swept.iter().zip(&placed.rates).fold(of, |sum, (column, rate)| sum + column * *rate);
        Vector3::new(moved.x, moved.y, 0.0)
    }

    fn angular_acceleration(&self, body: usize, of_coordinates: &SVector<f64, D>) -> Vector3<f64> {
        let (.., turn) = &self.bodies.bodies[body];
        Vector3::z() * turn.map_or(0.0, |turn| of_coordinates[turn])
    }

    fn state(&mut self, pose: &[[f64; 2]; D], rates: [f64; D]) -> State<D> {
        let state = State::planar(self.tree.topology(), pose, rates, &self.last);
        self.last = state.places;
        state
    }

    fn body_motions(&self, state: &State<D>, motions: &mut Vec<BodyMotion>) {
        self.bodies.tell(state, motions);
    }

    fn gaps(&self, pose: &[[f64; 2]; D], velocity: &SVector<f64, D>) -> Vec<Option<f64>> {
        let placed = self.tree.placed(pose, velocity);
        self.elements.iter().map(|element| element.gap((self.tree, &placed))).collect()
    }
}

/// Free bodies in space.
pub(super) struct FreeKinematics<'a, const N: usize, const D: usize> {
    bodies: &'a FreeBodies<f64, N, D>,
    elements: &'a [SpatialElement],
    at: ([Pose<f64>; N], SVector<f64, D>),
    placed_bodies: [PlacedBody<f64>; N],
    last: State<D>,
}

impl<'a, const N: usize, const D: usize> FreeKinematics<'a, N, D> {
    /// These `bodies`.
    pub fn new(bodies: &'a FreeBodies<f64, N, D>, elements: &'a [SpatialElement]) -> Self {
        let at = (bodies.nominal(), SVector::zeros());
        let placed_bodies = bodies.placed(&at.0, &at.1).bodies;
        Self { bodies, elements, at, placed_bodies, last: State::at_rest([0.0; D]) }
    }
}

impl<const N: usize, const D: usize> Kinematics<[Pose<f64>; N], D> for FreeKinematics<'_, N, D> {
    fn update(&mut self, poses: &[Pose<f64>; N], velocity: &SVector<f64, D>) {
        self.at = (*poses, *velocity);
        self.placed_bodies = self.bodies.placed(poses, velocity).bodies;
    }

    fn bodies(&self) -> &[PlacedBody<f64>] {
        &self.placed_bodies
    }

    fn rotation(&mut self, body: usize) -> Vector3<f64> {
        let (poses, velocity) = self.at;
        let state = self.state(&poses, velocity.into());
        Vector3::from_column_slice(&state.places[6 * body + 3..6 * body + 6])
    }

    fn acceleration(&self, body: usize, of_coordinates: &SVector<f64, D>) -> Vector3<f64> {
        of_coordinates.fixed_rows::<3>(6 * body).into()
    }

    fn angular_acceleration(&self, body: usize, of_coordinates: &SVector<f64, D>) -> Vector3<f64> {
        self.placed_bodies[body].to_frame * of_coordinates.fixed_rows::<3>(6 * body + 3)
    }

    fn state(&mut self, poses: &[Pose<f64>; N], rates: [f64; D]) -> State<D> {
        self.last = State::spatial(poses, rates, &self.last);
        self.last
    }

    fn body_motions(&self, state: &State<D>, motions: &mut Vec<BodyMotion>) {
        columns::spatial(state, motions);
    }

    fn gaps(&self, poses: &[Pose<f64>; N], velocity: &SVector<f64, D>) -> Vec<Option<f64>> {
        let placed = self.bodies.placed(poses, velocity);
        self.elements.iter().map(|element| element.gap((self.bodies, &placed))).collect()
    }
}

/// Bodies in space on ideal joints.
pub(super) struct JointedKinematics<'a, const N: usize, const W: usize, const D: usize> {
    tree: &'a SpatialTree<f64, N, W, D>,
    elements: &'a [SpatialElement],
    bodies: &'a JointedBodies<N, W, D>,
    at: ([[f64; 2]; D], SVector<f64, D>),
    placed: JointedPlaced<f64, N, W, D>,
    motions: Vec<BodyMotion>,
    last: State<D>,
}

impl<'a, const N: usize, const W: usize, const D: usize> JointedKinematics<'a, N, W, D> {
    /// These `bodies` of `tree`, which start at the coordinates `start` (m, rad).
    pub fn new(
        tree: &'a SpatialTree<f64, N, W, D>,
        elements: &'a [SpatialElement],
        bodies: &'a JointedBodies<N, W, D>,
        start: [f64; D],
    ) -> Self {
        let at = (tree.nominal(), SVector::zeros());
        let placed = tree.placed(&at.0, &at.1);
        Self { tree, elements, bodies, at, placed, motions: Vec::new(), last: State::at_rest(start) }
    }
}

impl<const N: usize, const W: usize, const D: usize> Kinematics<[[f64; 2]; D], D> for JointedKinematics<'_, N, W, D> {
    fn update(&mut self, pose: &[[f64; 2]; D], velocity: &SVector<f64, D>) {
        self.at = (*pose, *velocity);
        self.placed = self.tree.placed(pose, velocity);
    }

    fn bodies(&self) -> &[PlacedBody<f64>] {
        &self.placed.free.bodies
    }

    fn rotation(&mut self, body: usize) -> Vector3<f64> {
        let (pose, velocity) = self.at;
        let state = self.state(&pose, velocity.into());
        let mut motions = std::mem::take(&mut self.motions);
        self.body_motions(&state, &mut motions);
        self.motions = motions;
        self.motions[body].turned
    }

    fn acceleration(&self, body: usize, of_coordinates: &SVector<f64, D>) -> Vector3<f64> {
        self.tree.accelerations(&self.placed, of_coordinates)[body][0]
    }

    fn angular_acceleration(&self, body: usize, of_coordinates: &SVector<f64, D>) -> Vector3<f64> {
        self.tree.accelerations(&self.placed, of_coordinates)[body][1]
    }

    fn state(&mut self, pose: &[[f64; 2]; D], rates: [f64; D]) -> State<D> {
        self.last = State::on_joints(self.tree, pose, rates, &self.last);
        self.last
    }

    fn body_motions(&self, state: &State<D>, motions: &mut Vec<BodyMotion>) {
        self.bodies.tell(state, motions);
    }

    fn gaps(&self, pose: &[[f64; 2]; D], velocity: &SVector<f64, D>) -> Vec<Option<f64>> {
        let placed = self.tree.placed(pose, velocity);
        self.elements.iter().map(|element| element.gap(self.tree.free(&placed))).collect()
    }
}
