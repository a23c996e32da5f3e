//! Where bodies on joints are, how they move, and how forces and masses go through the joints.

use nalgebra::Matrix3;

use super::{
    SpatialTree,
    joint::Kind,
    numbers::{pair, set, three},
    placed::{Placed, PlacedJoint},
    pose::ball,
};
use crate::{
    SMatrix, SVector, Scalar, Vector3,
    linear::{cross_columns, cross_matrix},
    product::{columns, cross, dot, product, times as of_three, transposed_times},
    system::{
        half_turn::less_and_sine,
        spatial::{Placed as PlacedBodies, PlacedBody, blocks::add_pair},
    },
};

/// A vector of each body: of its centre of mass, and of its turning.
pub type Pairs<S, const N: usize> = [[Vector3<S>; 2]; N];

impl<S: Scalar, const N: usize, const W: usize, const D: usize> SpatialTree<S, N, W, D> {
    /// Where the bodies are in `pose`, and how fast they move by the `rates` of the coordinates.
    #[inline(never)] // For size, as below.
    pub(super) fn moving(&self, pose: &[[S; 2]; D], rates: &SVector<S, D>) -> Placed<S, N, W, D> {
        let zero = Vector3::zeros();
        let still = PlacedJoint { arms: [zero; 2], sliding: zero, turning: zero };
        let mut placed = Placed {
            free: PlacedBodies { bodies: [PlacedBody::still(); N] },
            joints: [still; N],
            axes: [zero; D],
            transform: SMatrix::zeros(),
        };
        for (m, mount) in self.mounts.iter().enumerate() {
            let Some(hung) = mount else { continue };
            let from = hung.on.map_or(PlacedBody::still(), |on| placed.free.body(on));
            let lever = of_three(&from.to_frame, &hung.arms[0]);
            let mut joint = PlacedJoint { arms: [lever, zero], ..still };
            let mut to_frame = from.to_frame;
            let mut slid = zero;
            let [first, count] = hung.coordinates;
            for k in first..first + count {
                let (Some(coordinate), Some(half)) = (self.coordinates.get(k), pose.get(k)) else { continue };
                let rate = rates.data.0[0].get(k).copied().unwrap_or(S::zero());
                match coordinate.kind {
                    Kind::Slide => {
                        let axis = of_three(&from.to_frame, &coordinate.axis);
                        set(&mut placed.axes, k, axis);
                        slid += axis * half[0];
                        joint.sliding += axis * rate;
                    }
                    Kind::Turn => {
                        set(&mut placed.axes, k, of_three(&from.to_frame, &coordinate.axis));
                        joint.turning += of_three(&from.to_frame, &(coordinate.axis * rate));
                        to_frame = product(&from.to_frame, &turn_about(&coordinate.axis, *half));
                    }
                    Kind::Ball => {
                        let turned = ball(pose, k).to_body().matrix().transpose();
                        to_frame = product(&from.to_frame, &turned);
                        joint.turning += of_three(&to_frame, &three(rates, k));
                        for (i, axis) in columns(&to_frame).into_iter().enumerate() {
                            set(&mut placed.axes, k + i, axis);
                        }
                    }
                    Kind::OfBall | Kind::Still => {}
                }
            }
            joint.arms = [lever + slid, of_three(&to_frame, &hung.arms[1])];
            let rotation_w = from.rotation_w + joint.turning;
            let body = PlacedBody {
                to_frame,
                // Of displacements, not places, so that the distance from the frame's origin costs no digits.
                displacement_w: from.displacement_w + (lever - hung.arms[0]) + slid + (joint.arms[1] - hung.arms[1]),
                velocity_w: from.velocity_w
                    + cross(&from.rotation_w, &joint.arms[0])
                    + joint.sliding
                    + cross(&rotation_w, &joint.arms[1]),
                rotation_b: transposed_times(&to_frame, &rotation_w),
                rotation_w,
            };
            set(&mut placed.free.bodies, hung.body, body);
            set(&mut placed.joints, m, joint);
        }
        placed.transform = self.transform(&placed);
        placed
    }

    /// See [`Placed::transform`].
    #[inline(always)]
    fn transform(&self, placed: &Placed<S, N, W, D>) -> SMatrix<S, W, D> {
        let mut transform = SMatrix::<S, W, D>::zeros();
        for (k, (column, coordinate)) in transform.data.0.iter_mut().zip(&self.coordinates).enumerate() {
            let axis = placed.axes.get(k).copied().unwrap_or(Vector3::zeros());
            for body in 0..N {
                if self.is_moved(k, body) {
                    let moved = if coordinate.kind.turns() {
                        [cross(&axis, &self.arm(placed, k, body)), axis]
                    } else {
                        [axis, Vector3::zeros()]
                    };
                    add_pair(column, body, moved.each_ref());
                }
            }
        }
        transform
    }

    /// From the joint of the turning coordinate `k` to the centre of mass of a body that it moves (m).
    #[inline(always)]
    pub(super) fn arm(&self, placed: &Placed<S, N, W, D>, k: usize, body: usize) -> Vector3<S> {
        let Some(mount) = self.coordinates.get(k).map(|coordinate| coordinate.mount) else { return Vector3::zeros() };
        let Some(hung) = self.mounts.get(mount).copied().flatten() else { return Vector3::zeros() };
        let own = placed.joints.get(mount).map_or(Vector3::zeros(), |joint| joint.arms[1]);
        if body == hung.body { own } else { self.between(placed, Some(hung.body), body) + own }
    }

    /// From the centre of mass of a body, or the frame's origin, to that of another body (m).
    #[inline(always)]
    pub(super) fn between(&self, placed: &Placed<S, N, W, D>, from: Option<usize>, to: usize) -> Vector3<S> {
        let nominal = self.centre(to) - from.map_or(Vector3::zeros(), |from| self.centre(from));
        let moved = from.map_or(Vector3::zeros(), |from| placed.free.body(from).displacement_w);
        nominal + (placed.free.body(to).displacement_w - moved)
    }

    /// Accelerations of the centres of mass (m/s²) and of turning (rad/s²), where those of the coordinates are `of_coordinates`.
    #[inline(never)]
    pub fn accelerations(&self, placed: &Placed<S, N, W, D>, of_coordinates: &SVector<S, D>) -> Pairs<S, N> {
        let mut found = [[Vector3::zeros(); 2]; N];
        for (mount, joint) in self.mounts.iter().zip(&placed.joints) {
            let Some(hung) = mount else { continue };
            let [sliding, turning] = self.relative(placed, hung.coordinates, of_coordinates);
            let from = hung.on.map_or(PlacedBody::still(), |on| placed.free.body(on));
            let [from_centre, from_turning] =
                hung.on.and_then(|on| found.get(on).copied()).unwrap_or([Vector3::zeros(); 2]);
            let rotation = from.rotation_w + joint.turning;
            let turned = from_turning + cross(&from.rotation_w, &joint.turning) + turning;
            let carried = |spin: &Vector3<S>, turned: &Vector3<S>, arm: &Vector3<S>| {
                cross(turned, arm) + cross(spin, &cross(spin, arm))
            };
            let coriolis = cross(&from.rotation_w, &joint.sliding) * S::from_f64(2.0);
            let centre = from_centre
                + carried(&from.rotation_w, &from_turning, &joint.arms[0])
                + (coriolis + sliding)
                + carried(&rotation, &turned, &joint.arms[1]);
            set(&mut found, hung.body, [centre, turned]);
        }
        found
    }

    /// What the coordinates `first`, and `count` of them, of one joint make of `values`: along slides, and about turns.
    #[inline(always)]
    pub(super) fn relative(
        &self,
        placed: &Placed<S, N, W, D>,
        [first, count]: [usize; 2],
        values: &SVector<S, D>,
    ) -> [Vector3<S>; 2] {
        let mut found = [Vector3::zeros(); 2];
        let all = self.coordinates.iter().zip(&placed.axes).zip(&values.data.0[0]);
        for ((coordinate, axis), value) in all.skip(first).take(count) {
            let [sliding, turning] = &mut found;
            let sum = if coordinate.kind.turns() { turning } else { sliding };
            *sum += axis * *value;
        }
        found
    }

    /// Gravity and what resists the `accelerations` of the bodies: force (N) and torque (N·m) of each.
    #[inline(never)]
    pub(super) fn own_wrench(&self, placed: &Placed<S, N, W, D>, accelerations: &Pairs<S, N>) -> SVector<S, W> {
        let mut wrench = SVector::<S, W>::zeros();
        let bodies = self.free.bodies().iter().zip(&placed.free.bodies).zip(accelerations);
        for (i, ((body, at), [centre, turning])) in bodies.enumerate() {
            let inertia = at.in_frame(&body.inertia_b);
            let gyroscopic = cross(&at.rotation_w, &of_three(&inertia, &at.rotation_w));
            let force = (self.free.gravity_w() - centre) * body.mass;
            add_pair(&mut wrench.data.0[0], i, [&force, &-(of_three(&inertia, turning) + gyroscopic)]);
        }
        wrench
    }

    /// Jᵀ·`wrench`: what forces (N) and torques (N·m) on the bodies, in the axes of the frame, are by the coordinates.
    #[inline(always)]
    pub(super) fn reduced(&self, placed: &Placed<S, N, W, D>, wrench: &SVector<S, W>) -> SVector<S, D> {
        let mut force = SVector::<S, D>::zeros();
        for (k, (sum, column)) in force.data.0[0].iter_mut().zip(&placed.transform.data.0).enumerate() {
            for body in 0..N {
                if self.is_moved(k, body) {
                    let [moved, turned] = pair(column, body);
                    let [force, torque] = pair(&wrench.data.0[0], body);
                    *sum += dot(&moved, &force) + dot(&turned, &torque);
                }
            }
        }
        force
    }

    /// What `matrix` makes of the velocities by the coordinate `k`.
    #[inline(always)]
    pub(super) fn by_column(&self, placed: &Placed<S, N, W, D>, matrix: &SMatrix<S, W, W>, k: usize) -> SVector<S, W> {
        let mut product = SVector::<S, W>::zeros();
        let Some(velocities) = placed.transform.data.0.get(k) else { return product };
        let of_bodies = matrix.data.0.as_chunks::<6>().0.iter().zip(velocities.as_chunks::<6>().0);
        for (body, (columns, velocities)) in of_bodies.enumerate() {
            if self.is_moved(k, body) {
                for (column, velocity) in columns.iter().zip(velocities) {
                    for (sum, entry) in product.data.0[0].iter_mut().zip(column) {
                        *sum += *entry * *velocity;
                    }
                }
            }
        }
        product
    }

    /// Jᵀ·M·J; 1 on the diagonal of coordinates that no joint uses.
    #[inline(never)]
    pub(super) fn reduced_mass(&self, placed: &Placed<S, N, W, D>) -> SMatrix<S, D, D> {
        let mut inertia = [Matrix3::zeros(); N];
        for ((inertia, body), at) in inertia.iter_mut().zip(self.free.bodies()).zip(&placed.free.bodies) {
            *inertia = at.in_frame(&body.inertia_b);
        }
        let mut mass = SMatrix::<S, D, D>::zeros();
        for (k, (column, coordinate)) in mass.data.0.iter_mut().zip(&self.coordinates).enumerate() {
            let mut momentum = [S::zero(); W];
            for (i, (body, inertia)) in self.free.bodies().iter().zip(&inertia).enumerate() {
                if !self.is_moved(k, i) {
                    continue;
                }
                let [moved, turned] = placed.column(k, i);
                add_pair(&mut momentum, i, [&(moved * body.mass), &of_three(inertia, &turned)]);
            }
            *column = self.reduced(placed, &SVector::from(momentum)).data.0[0];
            if let Some(own) = column.get_mut(k).filter(|_| coordinate.kind == Kind::Still) {
                *own = S::one();
            }
        }
        mass
    }
}

/// The rotation about the unit vector `axis` by the angle whose half has the cosine and sine `half`.
#[inline(always)]
fn turn_about<S: Scalar>(axis: &Vector3<S>, half: [S; 2]) -> Matrix3<S> {
    let [less, sine] = less_and_sine(half);
    // 1 + sin·[a]× + (1 − cos)·[a]×²
    let crossed = cross_matrix(axis);
    Matrix3::identity() + crossed * sine + cross_columns(axis, &crossed) * less
}
