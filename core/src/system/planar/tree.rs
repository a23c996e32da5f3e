//! The tree: coordinates, bodies, and how they resist.

use super::{
    Coordinate, Placed, Point,
    masses::{Masses, Rigid},
    point::At,
    topology::{Carrier, Kind, Topology},
    turned,
};
use crate::{
    ParameterError, SMatrix, SVector, Scalar, Vector2,
    error::bounded,
    product::applied,
    system::{Bodies, ByCoordinate, Lu, half_turn},
};

/// Bodies in a plane with `D` coordinates. The topology `J` may be a type, so that what a scene does not have leaves no code.
///
/// Body by body the accelerations are J·V̇ + J̇·V; the mass matrix is Σ m·JᵀJ + inertia, exact at every pose. The sums over the bodies
/// are made once, when the tree is. What moves along an axis of a turning body must be moved by that turn, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarTree<S, const D: usize, J = [Kind; D]> {
    topology: J,
    /// Directions of sliding coordinates, see [`Coordinate`].
    axes: [Vector2<S>; D],
    masses: Masses<S, D>,
    gravity: Vector2<S>,
    per_lever: SVector<S, D>,
}

crate::cast::cast!([] [D] PlanarTree: PlanarTree<f64, D> => T PlanarTree<T, D> { axes, masses, gravity, per_lever; topology });

impl<S: Scalar + PartialOrd, const D: usize> PlanarTree<S, D> {
    /// A tree of `coordinates` and `bodies` under `gravity` (m/s²).
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn new(
        coordinates: [Coordinate<S>; D],
        bodies: &[Rigid<S, D>],
        gravity: Vector2<S>,
    ) -> Result<Self, ParameterError<S>> {
        let axes = coordinates.map(|coordinate| match coordinate {
            Coordinate::Turn => Vector2::zeros(),
            Coordinate::Slide { axis, .. } => axis,
        });
        let kinds = coordinates.map(|coordinate| match coordinate {
            Coordinate::Turn => Kind::Turn,
            Coordinate::Slide { on, .. } => Kind::Slide { on },
        });
        Self::of(kinds, axes, bodies, gravity)
    }
}

impl<S: Scalar + PartialOrd, J: Topology<D>, const D: usize> PlanarTree<S, D, J> {
    /// A tree of `topology` and `bodies` under `gravity` (m/s²); sliding coordinates go along `axes`, of unit length.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn of(
        topology: J,
        axes: [Vector2<S>; D],
        bodies: &[Rigid<S, D>],
        gravity: Vector2<S>,
    ) -> Result<Self, ParameterError<S>> {
        for component in gravity.iter() {
            bounded("gravity", *component, [-1e4, 1e4])?;
        }
        bounded("bodies", S::from_count(bodies.len() as u32), [1.0, 1e6])?;
        for k in 0..D {
            if let Kind::Slide { on: Some(on) } = topology.kind(k) {
                let (last, number) = (D as f64 - 1.0, u32::try_from(on).unwrap_or(u32::MAX));
                let found = bounded("on", S::from_count(number), [0.0, last])?;
                if topology.kind(on) != Kind::Turn {
                    let [least, greatest] = [0.0, last].map(S::from_f64);
                    return Err(ParameterError { parameter: "on", value: found, least, greatest });
                }
            }
        }
        let masses = Masses::of(&topology, &axes, bodies)?;
        let mut per_lever = SVector::<S, D>::zeros();
        for (k, (weight, lever)) in per_lever.iter_mut().zip(masses.levers).enumerate() {
            *weight = if topology.kind(k) == Kind::Turn { S::one() / lever } else { S::one() };
        }
        Ok(Self { topology, axes, masses, gravity, per_lever })
    }
}

impl<S: Scalar, J: Topology<D>, const D: usize> PlanarTree<S, D, J> {
    /// Which coordinates there are.
    pub fn topology(&self) -> &J {
        &self.topology
    }

    /// Directions of sliding coordinates; of no effect for turning ones.
    pub fn axes(&self) -> &[Vector2<S>; D] {
        &self.axes
    }

    /// Where a point is (m) and how fast it moves (m/s).
    pub fn motion_of<C: Carrier<D>>(&self, point: &Point<S, D, C>, placed: &Placed<S, D>) -> [Vector2<S>; 2] {
        let at = self.at(point, placed);
        [at.place, at.velocity(&placed.rates)]
    }

    /// `point` where and as fast as `placed` says.
    #[inline(always)]
    pub(super) fn at<C: Carrier<D>>(&self, point: &Point<S, D, C>, placed: &Placed<S, D>) -> At<S, D, C> {
        At::of(&self.topology, point, placed)
    }

    /// By which length (m) the angle `k` is compared with displacements; 1 for a displacement.
    pub fn lever(&self, k: usize) -> S {
        self.per_lever.get(k).map_or(S::one(), |per_lever| S::one() / *per_lever)
    }

    /// The pose with the given angles (rad) and displacements (m).
    pub fn pose(&self, values: [S; D], half_angle: impl Fn(S) -> [S; 2]) -> [[S; 2]; D] {
        let mut pose = [[S::zero(); 2]; D];
        for (k, (pose, value)) in pose.iter_mut().zip(values).enumerate() {
            *pose = match self.topology.kind(k) {
                Kind::Turn => half_angle(value),
                Kind::Slide { .. } => [value, S::zero()],
            };
        }
        pose
    }
}

impl<S: Scalar, J: Topology<D>, const D: usize> Bodies<S, D> for PlanarTree<S, D, J> {
    /// Of a turn cosine and sine of half the angle, near unit length; of a slide the displacement (m) and 0.
    type Pose = [[S; 2]; D];
    type Placed = Placed<S, D>;

    type Mass = SMatrix<S, D, D>;
    type Axes = ();
    type Jacobian = SMatrix<S, D, D>;

    const MASS_IS_CONSTANT: bool = false;

    #[inline(always)]
    fn implicit_update(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose {
        let mut next = self.explicit_update(pose, velocity, dt);
        for (k, (pose, rate)) in next.iter_mut().zip(&velocity.data.0[0]).enumerate() {
            if self.topology.kind(k) == Kind::Turn {
                *pose = half_turn::shortened(*pose, *rate * dt * S::from_f64(0.5));
            }
        }
        next
    }

    #[inline(always)]
    fn explicit_update(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose {
        let mut next = *pose;
        for (k, (pose, rate)) in next.iter_mut().zip(&velocity.data.0[0]).enumerate() {
            let [w, v] = *pose;
            *pose = match self.topology.kind(k) {
                Kind::Turn => half_turn::turned_on(*pose, *rate * dt * S::from_f64(0.5)),
                Kind::Slide { .. } => [w + *rate * dt, v],
            };
        }
        next
    }

    #[inline(always)]
    fn shifted(&self, base: &Self::Pose, from: &Self::Pose, to: &Self::Pose, weight: S) -> Self::Pose {
        half_turn::shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn normalised(&self, pose: &Self::Pose) -> Self::Pose {
        let mut normalised = *pose;
        for (k, pose) in normalised.iter_mut().enumerate() {
            if self.topology.kind(k) == Kind::Turn {
                *pose = half_turn::normalised(*pose);
            }
        }
        normalised
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &Self::Pose, kept: &mut Self::Pose) {
        half_turn::accept(condition, next, kept);
    }

    #[inline(always)]
    fn finiteness_probe(&self, pose: &Self::Pose) -> S {
        half_turn::finiteness_probe(pose)
    }

    #[inline(always)]
    fn rate(&self, displacement: &SVector<S, D>, velocity: &SVector<S, D>) -> SVector<S, D> {
        let mut rate = *velocity;
        for (k, (rate, place)) in rate.data.0[0].iter_mut().zip(&displacement.data.0[0]).enumerate() {
            if self.topology.kind(k) == Kind::Turn {
                *rate = half_turn::angle_rate(*place, *rate);
            }
        }
        rate
    }

    #[inline(always)]
    fn placed(&self, pose: &Self::Pose, velocity: &SVector<S, D>) -> Placed<S, D> {
        let (mut axes, mut places) = (self.axes, [S::zero(); D]);
        for (k, ((axis, place), pose)) in axes.iter_mut().zip(&mut places).zip(pose).enumerate() {
            match self.topology.kind(k) {
                Kind::Turn => *axis = half_turn::whole(*pose),
                Kind::Slide { .. } => *place = pose[0],
            }
        }
        for k in 0..D {
            if let Kind::Slide { on: Some(on) } = self.topology.kind(k) {
                axes[k] = turned(&axes[on], &axes[k]);
            }
        }
        Placed { axes, places, rates: *velocity }
    }

    #[inline(always)]
    fn axes(&self, _: &Placed<S, D>) {}

    #[inline(always)]
    fn inertia(&self, mass: &SMatrix<S, D, D>, rate: S) -> SMatrix<S, D, D> {
        mass * rate
    }

    #[inline(always)]
    fn momentum(&self, mass: &SMatrix<S, D, D>, velocity: &SVector<S, D>) -> SVector<S, D> {
        applied(mass, velocity)
    }

    #[inline(always)]
    fn velocity(&self, mass: &SMatrix<S, D, D>, momentum: &SVector<S, D>) -> SVector<S, D> {
        Lu::of(*mass).solve(momentum)
    }

    #[inline(always)]
    fn mass(&self, placed: &Placed<S, D>) -> SMatrix<S, D, D> {
        self.masses.at(&self.topology, placed).matrix(&self.topology)
    }

    #[inline(always)]
    fn own_force(&self, placed: &Placed<S, D>) -> SVector<S, D> {
        self.masses.at(&self.topology, placed).force(&self.topology, &self.gravity, &placed.rates)
    }

    #[inline(always)]
    fn mass_and_own_force(&self, placed: &Placed<S, D>) -> (SMatrix<S, D, D>, SVector<S, D>) {
        let moments = self.masses.at(&self.topology, placed);
        (moments.matrix(&self.topology), moments.force(&self.topology, &self.gravity, &placed.rates))
    }

    #[inline(always)]
    fn own_jacobians(
        &self,
        placed: &Placed<S, D>,
        _: &SMatrix<S, D, D>,
        acceleration: &SVector<S, D>,
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let moments = self.masses.at(&self.topology, placed);
        moments.add_jacobians(&self.topology, &placed.rates, (&self.gravity, acceleration), damping, stiffness);
    }

    #[inline(always)]
    fn least_mass(&self) -> S {
        self.masses.least
    }

    #[inline(always)]
    fn per_lever(&self) -> SVector<S, D> {
        self.per_lever
    }
}

impl<S, const D: usize, J> ByCoordinate for PlanarTree<S, D, J> {}
