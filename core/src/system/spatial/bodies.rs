//! Free rigid bodies: poses, inertia and gravity.

use nalgebra::Matrix3;

use crate::{
    ParameterError, SMatrix, SVector, Scalar, Vector3, error::bounded, linear::cross_matrix, pose::Pose, system::Bodies,
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

    /// All bodies in their nominal poses.
    pub fn nominal(&self) -> [Pose<S>; N] {
        [Pose::nominal(); N]
    }

    /// By which length (m) angles of body `i` are compared with displacements.
    pub fn lever(&self, i: usize) -> S {
        self.per_lever.get(6 * i + 3).map_or(S::one(), |per_lever| S::one() / *per_lever)
    }

    #[inline(always)]
    fn each(&self, velocity: &SVector<S, D>, mut act: impl FnMut(usize, Vector3<S>, Vector3<S>)) {
        for (i, [vx, vy, vz, wx, wy, wz]) in velocity.data.0[0].as_chunks::<6>().0.iter().enumerate() {
            act(i, Vector3::new(*vx, *vy, *vz), Vector3::new(*wx, *wy, *wz));
        }
    }
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
}

/// All bodies at a pose and motion.
#[derive(Clone, Copy, Debug)]
pub struct Placed<S, const N: usize, const D: usize> {
    /// Body by body.
    pub bodies: [PlacedBody<S>; N],
    /// Generalised velocities.
    pub rates: SVector<S, D>,
}

impl<S: Scalar, const N: usize, const D: usize> Bodies<S, D> for FreeBodies<S, N, D> {
    type Pose = [Pose<S>; N];
    type Placed = Placed<S, N, D>;

    const MASS_IS_CONSTANT: bool = true;

    #[inline(always)]
    fn advanced(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose {
        let mut next = *pose;
        self.each(velocity, |i, v, w| next[i] = pose[i].advanced(v, w, dt));
        next
    }

    #[inline(always)]
    fn moved(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose {
        let mut next = *pose;
        self.each(velocity, |i, v, w| next[i] = pose[i].moved(v, w, dt));
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
        pose.map(|pose| pose.normalised())
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &Self::Pose, kept: &mut Self::Pose) {
        for (kept, next) in kept.iter_mut().zip(next) {
            *kept = next.or_old(condition, kept);
        }
    }

    #[inline(always)]
    fn finiteness_probe(&self, pose: &Self::Pose) -> S {
        pose.iter().fold(S::zero(), |sum, Pose { displacement_w: r, orientation: q }| {
            sum + (r.x + r.y + r.z + q.w + q.v.x + q.v.y + q.v.z) * S::zero()
        })
    }

    /// With the turn θ of [`Pose::moved`], the orientation is that of the quaternion (1, θ/2) after the pose's, so that
    /// θ̇ = ω + ½·θ×ω + ¼·θ(θ·ω).
    #[inline(always)]
    fn rate(&self, displacement: &SVector<S, D>, velocity: &SVector<S, D>) -> SVector<S, D> {
        let mut rate = *velocity;
        self.each(displacement, |i, _, turn| {
            let half = turn * S::from_f64(0.5);
            let w = Vector3::new(velocity[6 * i + 3], velocity[6 * i + 4], velocity[6 * i + 5]);
            let turning = w + half.cross(&w) + half * half.dot(&w);
            rate.fixed_rows_mut::<3>(6 * i + 3).copy_from(&turning);
        });
        rate
    }

    #[inline(always)]
    fn placed(&self, pose: &Self::Pose, velocity: &SVector<S, D>) -> Self::Placed {
        let still = PlacedBody {
            to_frame: Matrix3::identity(),
            displacement_w: Vector3::zeros(),
            velocity_w: Vector3::zeros(),
            rotation_b: Vector3::zeros(),
        };
        let mut bodies = [still; N];
        self.each(velocity, |i, velocity_w, rotation_b| {
            let to_frame = pose[i].to_body().matrix().transpose();
            bodies[i] = PlacedBody { to_frame, displacement_w: pose[i].displacement_w, velocity_w, rotation_b };
        });
        Placed { bodies, rates: *velocity }
    }

    #[inline(always)]
    fn mass(&self, _: &Self::Placed) -> SMatrix<S, D, D> {
        let mut mass = SMatrix::<S, D, D>::zeros();
        for (i, body) in self.bodies.iter().enumerate() {
            for k in 0..3 {
                mass[(6 * i + k, 6 * i + k)] = body.mass;
                mass[(6 * i + 3 + k, 6 * i + 3 + k)] = body.inertia_b[k];
            }
        }
        mass
    }

    #[inline(always)]
    fn own_force(&self, placed: &Self::Placed) -> SVector<S, D> {
        let mut force = SVector::<S, D>::zeros();
        for (i, (body, at)) in self.bodies.iter().zip(&placed.bodies).enumerate() {
            let momentum = at.rotation_b.component_mul(&body.inertia_b);
            force.fixed_rows_mut::<3>(6 * i).copy_from(&(self.gravity_w * body.mass));
            force.fixed_rows_mut::<3>(6 * i + 3).copy_from(&momentum.cross(&at.rotation_b));
        }
        force
    }

    #[inline(always)]
    fn own_slopes(
        &self,
        placed: &Self::Placed,
        _: &SVector<S, D>,
        damping: &mut SMatrix<S, D, D>,
        _: &mut SMatrix<S, D, D>,
    ) {
        for (i, (body, at)) in self.bodies.iter().zip(&placed.bodies).enumerate() {
            let momentum = at.rotation_b.component_mul(&body.inertia_b);
            let gyroscopic =
                cross_matrix(&at.rotation_b) * Matrix3::from_diagonal(&body.inertia_b) - cross_matrix(&momentum);
            let mut block = damping.fixed_view_mut::<3, 3>(6 * i + 3, 6 * i + 3);
            block += gyroscopic;
        }
    }

    #[inline(always)]
    fn least_mass(&self) -> S {
        self.least_mass
    }

    #[inline(always)]
    fn per_lever(&self) -> &SVector<S, D> {
        &self.per_lever
    }
}
