//! Free rigid bodies: poses, inertia and gravity.

mod lanes;

use nalgebra::Matrix3;

use super::blocks::{TURNING, VELOCITY, add_block, add_column, add_turned, add_wrench};
use crate::{
    ParameterError, SMatrix, SVector, Scalar, Vector3,
    error::bounded,
    linear::{cross_columns, cross_matrix},
    pose::{Pose, turn_rate, turned_over},
    product::{columns, cross, product, times, transposed_times},
    system::{Axes, Bodies},
};

/// A rigid body in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid<S> {
    /// Mass (kg).
    pub mass: S,
    /// Principal moments of inertia about the centre of mass (kg·m²), along the body's axes.
    pub inertia_b: Vector3<S>,
    /// The centre of mass (m) at the nominal pose, where the body's axes are those of the frame.
    pub centre_w: Vector3<S>,
}

/// `N` free bodies with `D` = 6·`N` coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBodies<S, const N: usize, const D: usize> {
    bodies: [Rigid<S>; N],
    gravity_w: Vector3<S>,
    per_lever: SVector<S, D>,
    least_mass: S,
}

impl<S: Scalar + PartialOrd, const N: usize, const D: usize> FreeBodies<S, N, D> {
    /// The dimension that belongs to `N`; any other does not compile.
    const CHECKED: () = assert!(D == 6 * N, "a free body has six coordinates");

    /// `bodies` under `gravity_w` (m/s²).
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn new(bodies: [Rigid<S>; N], gravity_w: Vector3<S>) -> Result<Self, ParameterError<S>> {
        let () = Self::CHECKED;
        for component in gravity_w.iter() {
            bounded("gravity", *component, [-1e4, 1e4])?;
        }
        let mut per_lever = SVector::<S, D>::from_element(S::one());
        let mut least_mass = S::from_f64(1e6);
        for (i, body) in bodies.iter().enumerate() {
            let mass = bounded("mass", body.mass, [1e-9, 1e6])?;
            least_mass = least_mass.select_gt(mass, mass, least_mass);
            let mut radius = S::from_f64(1e-6);
            for moment in body.inertia_b.iter() {
                bounded("inertia", *moment, [1e-15, 1e9])?;
                radius = radius.max_of((*moment / mass).sqrt());
            }
            for component in body.centre_w.iter() {
                bounded("centre of mass", *component, [-1e3, 1e3])?;
            }
            for weight in per_lever.iter_mut().skip(6 * i + 3).take(3) {
                *weight = S::one() / radius;
            }
        }
        Ok(Self { bodies, gravity_w, per_lever, least_mass })
    }
}

impl<S: Scalar, const N: usize, const D: usize> FreeBodies<S, N, D> {
    /// The bodies.
    pub fn bodies(&self) -> &[Rigid<S>; N] {
        &self.bodies
    }

    /// Gravity (m/s²).
    pub fn gravity_w(&self) -> &Vector3<S> {
        &self.gravity_w
    }

    /// All bodies in their nominal poses.
    pub fn nominal(&self) -> [Pose<S>; N] {
        [Pose::nominal(); N]
    }

    /// The diagonal of the mass matrix.
    #[inline(always)]
    fn moments(&self) -> impl Iterator<Item = S> {
        self.bodies.iter().flat_map(|Rigid { mass, inertia_b: j, .. }| [*mass, *mass, *mass, j.x, j.y, j.z])
    }

    /// By which length (m) angles of body `i` are compared with displacements.
    pub fn lever(&self, i: usize) -> S {
        self.per_lever.get(6 * i + 3).map_or(S::one(), |per_lever| S::one() / *per_lever)
    }
}

/// The six numbers of each body: velocities and angular velocities, or displacements and turns.
#[inline(always)]
fn each<S: Scalar, const D: usize>(of: &SVector<S, D>) -> impl Iterator<Item = (Vector3<S>, Vector3<S>)> {
    let split = |[vx, vy, vz, wx, wy, wz]: &[S; 6]| (Vector3::new(*vx, *vy, *vz), Vector3::new(*wx, *wy, *wz));
    of.data.0[0].as_chunks::<6>().0.iter().map(split)
}

/// The same to be written.
#[inline(always)]
fn each_mut<S: Scalar, const D: usize>(of: &mut SVector<S, D>) -> impl Iterator<Item = &mut [S; 6]> {
    of.data.0[0].as_chunks_mut::<6>().0.iter_mut()
}

/// A body at a pose and motion.
#[derive(Clone, Copy, Debug)]
pub struct PlacedBody<S> {
    /// From the body's axes into the frame's.
    pub to_frame: Matrix3<S>,
    /// Displacement of the centre of mass (m).
    pub displacement_w: Vector3<S>,
    /// Velocity of the centre of mass (m/s).
    pub velocity_w: Vector3<S>,
    /// Angular velocity (rad/s).
    pub rotation_b: Vector3<S>,
    /// The same in the frame.
    pub rotation_w: Vector3<S>,
}

impl<S: Scalar> PlacedBody<S> {
    /// In the nominal pose, at rest.
    #[inline(always)]
    pub(super) fn still() -> Self {
        Self {
            to_frame: Matrix3::identity(),
            displacement_w: Vector3::zeros(),
            velocity_w: Vector3::zeros(),
            rotation_b: Vector3::zeros(),
            rotation_w: Vector3::zeros(),
        }
    }

    /// Principal moments of inertia as a matrix in the axes of the frame (kg·m²).
    #[inline(always)]
    pub(super) fn in_frame(&self, inertia_b: &Vector3<S>) -> Matrix3<S> {
        let [x, y, z] = columns(&self.to_frame);
        let scaled = Matrix3::from_columns(&[x * inertia_b.x, y * inertia_b.y, z * inertia_b.z]);
        product(&scaled, &self.to_frame.transpose())
    }
}

/// Axes in which elements of free bodies add up: those of the frame, for torques too. Velocities and turns of a body are in its own
/// axes, so this holds what leads from these into the frame's. Derivatives are R·(∂τ_b/∂θ_b)·Rᵀ: of the torque *as the body sees
/// it*, with the angular velocity held in the body, only written in the frame's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InFrame<S, const N: usize>([Matrix3<S>; N]);

impl<S: Scalar, const N: usize> Default for InFrame<S, N> {
    #[inline(always)]
    fn default() -> Self {
        Self([Matrix3::identity(); N])
    }
}

impl<S: Scalar, const N: usize> InFrame<S, N> {
    /// `v` with the last three numbers of each body `turned`.
    #[inline(always)]
    fn turned<const D: usize>(
        &self,
        v: &SVector<S, D>,
        turn: impl Fn(&Matrix3<S>, &Vector3<S>) -> Vector3<S>,
    ) -> SVector<S, D> {
        let mut result = *v;
        for ([.., x, y, z], axes) in each_mut(&mut result).zip(&self.0) {
            let turned = turn(axes, &Vector3::new(*x, *y, *z));
            (*x, *y, *z) = (turned.x, turned.y, turned.z);
        }
        result
    }
}

impl<S: Scalar, const N: usize, const D: usize> Axes<S, D> for InFrame<S, N> {
    #[inline(always)]
    fn to_sum(&self, v: &SVector<S, D>) -> SVector<S, D> {
        self.turned(v, times)
    }

    #[inline(always)]
    fn to_velocities(&self, v: &SVector<S, D>) -> SVector<S, D> {
        self.turned(v, transposed_times)
    }
}

impl<S: Scalar, const N: usize> Placed<S, N> {
    /// The body of this number; one that is not there stands still.
    #[inline(always)]
    pub(super) fn body(&self, number: usize) -> PlacedBody<S> {
        self.bodies.get(number).copied().unwrap_or(PlacedBody::still())
    }
}

/// All bodies at a pose and motion.
#[derive(Clone, Copy, Debug)]
pub struct Placed<S, const N: usize> {
    /// Body by body.
    pub bodies: [PlacedBody<S>; N],
}

impl<S: Scalar, const N: usize, const D: usize> Bodies<S, D> for FreeBodies<S, N, D> {
    type Pose = [Pose<S>; N];
    type Placed = Placed<S, N>;
    /// Moments of inertia, in the axes of the frame (kg·m²).
    type Mass = [Matrix3<S>; N];
    type Axes = InFrame<S, N>;
    type Jacobian = SMatrix<S, D, D>;

    const MASS_IS_CONSTANT: bool = true;

    #[inline(always)]
    fn implicit_update(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose {
        let mut next = *pose;
        next.iter_mut().zip(each(velocity)).for_each(|(pose, (v, w))| *pose = pose.implicit_update(v, w, dt));
        next
    }

    #[inline(always)]
    fn explicit_update(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose {
        let mut next = *pose;
        next.iter_mut().zip(each(velocity)).for_each(|(pose, (v, w))| *pose = pose.explicit_update(v, w, dt));
        next
    }

    #[inline(always)]
    fn shifted(&self, base: &Self::Pose, from: &Self::Pose, to: &Self::Pose, weight: S) -> Self::Pose {
        let mut shifted = *base;
        for ((base, from), to) in shifted.iter_mut().zip(from).zip(to) {
            *base = base.shifted(from, to, weight);
        }
        shifted
    }

    #[inline(always)]
    fn normalised(&self, pose: &Self::Pose) -> Self::Pose {
        let mut normalised = *pose;
        normalised.iter_mut().for_each(|pose| *pose = pose.normalised());
        normalised
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &Self::Pose, kept: &mut Self::Pose) {
        for (kept, next) in kept.iter_mut().zip(next) {
            *kept = next.or_old(condition, kept);
        }
    }

    #[inline(always)]
    fn finiteness_probe(&self, pose: &Self::Pose) -> S {
        pose.iter().fold(S::zero(), |sum, pose| sum + pose.finiteness_probe())
    }

    #[inline(always)]
    fn rate(&self, displacement: &SVector<S, D>, velocity: &SVector<S, D>) -> SVector<S, D> {
        let mut rate = *velocity;
        for ((_, turn), [.., x, y, z]) in each(displacement).zip(each_mut(&mut rate)) {
            let turning = turn_rate(&turn, &Vector3::new(*x, *y, *z));
            (*x, *y, *z) = (turning.x, turning.y, turning.z);
        }
        rate
    }

    #[inline(always)]
    fn displacement(&self, velocity: &SVector<S, D>, rate: &SVector<S, D>, a: S) -> SVector<S, D> {
        let mut displaced = rate * a;
        for (((_, spin), (_, rate)), [.., x, y, z]) in each(velocity).zip(each(rate)).zip(each_mut(&mut displaced)) {
            let turned = turned_over(&spin, &rate, a);
            (*x, *y, *z) = (turned.x, turned.y, turned.z);
        }
        displaced
    }

    #[inline(always)]
    fn stiffened(
        &self,
        mut matrix: SMatrix<S, D, D>,
        stiffness: &SMatrix<S, D, D>,
        (axes, velocity): (&InFrame<S, N>, &SVector<S, D>),
        a: S,
    ) -> SMatrix<S, D, D> {
        for (i, (_, spin)) in each(&axes.to_sum(velocity)).enumerate() {
            (6 * i..6 * i + 3).for_each(|k| add_column(&mut matrix, stiffness, k, a));
            add_turned(&mut matrix, stiffness, (6 * i + 3, &spin), a);
        }
        matrix
    }

    #[inline(always)]
    fn placed(&self, pose: &Self::Pose, velocity: &SVector<S, D>) -> Self::Placed {
        let mut bodies = [PlacedBody::still(); N];
        for ((body, pose), (velocity_w, rotation_b)) in bodies.iter_mut().zip(pose).zip(each(velocity)) {
            let to_frame = pose.to_body().matrix().transpose();
            let rotation_w = times(&to_frame, &rotation_b);
            *body = PlacedBody { to_frame, displacement_w: pose.displacement_w, velocity_w, rotation_b, rotation_w };
        }
        Placed { bodies }
    }

    #[inline(always)]
    fn axes(&self, placed: &Self::Placed) -> InFrame<S, N> {
        InFrame(placed.bodies.each_ref().map(|at| at.to_frame))
    }

    #[inline(always)]
    fn mass(&self, placed: &Self::Placed) -> [Matrix3<S>; N] {
        let mut inertia = [Matrix3::zeros(); N];
        for ((inertia, body), at) in inertia.iter_mut().zip(&self.bodies).zip(&placed.bodies) {
            *inertia = at.in_frame(&body.inertia_b);
        }
        inertia
    }

    #[inline(always)]
    fn inertia(&self, mass: &[Matrix3<S>; N], rate: S) -> SMatrix<S, D, D> {
        let mut sum = SMatrix::<S, D, D>::zeros();
        for (i, (body, inertia)) in self.bodies.iter().zip(mass).enumerate() {
            add_block(&mut sum, [[i, VELOCITY]; 2], &Matrix3::from_diagonal_element(body.mass * rate));
            add_block(&mut sum, [[i, TURNING]; 2], &(inertia * rate));
        }
        sum
    }

    #[inline(always)]
    fn momentum(&self, _: &[Matrix3<S>; N], velocity: &SVector<S, D>) -> SVector<S, D> {
        let mut momentum = *velocity;
        momentum.data.0[0].iter_mut().zip(self.moments()).for_each(|(x, moment)| *x *= moment);
        momentum
    }

    #[inline(always)]
    fn velocity(&self, _: &[Matrix3<S>; N], momentum: &SVector<S, D>) -> SVector<S, D> {
        let mut velocity = *momentum;
        velocity.data.0[0].iter_mut().zip(self.moments()).for_each(|(x, moment)| *x /= moment);
        velocity
    }

    #[inline(always)]
    fn own_force(&self, placed: &Self::Placed) -> SVector<S, D> {
        let mut force = SVector::<S, D>::zeros();
        for (i, (body, at)) in self.bodies.iter().zip(&placed.bodies).enumerate() {
            let torque_b = cross(&at.rotation_b.component_mul(&body.inertia_b), &at.rotation_b);
            add_wrench(&mut force, i, [&(self.gravity_w * body.mass), &times(&at.to_frame, &torque_b)]);
        }
        force
    }

    #[inline(always)]
    fn own_jacobians(
        &self,
        placed: &Self::Placed,
        mass: &[Matrix3<S>; N],
        _: &SVector<S, D>,
        damping: &mut SMatrix<S, D, D>,
        _: &mut SMatrix<S, D, D>,
    ) {
        for (i, (inertia, at)) in mass.iter().zip(&placed.bodies).enumerate() {
            let momentum = times(inertia, &at.rotation_w);
            let gyroscopic = cross_columns(&at.rotation_w, inertia) - cross_matrix(&momentum);
            add_block(damping, [[i, TURNING]; 2], &gyroscopic);
        }
    }

    #[inline(always)]
    fn least_mass(&self) -> S {
        self.least_mass
    }

    #[inline(always)]
    fn per_lever(&self) -> SVector<S, D> {
        self.per_lever
    }
}
