//! Bodies in space on ideal joints.
//!
//! The joints form a tree. Its coordinates are the displacements and angles that they leave, so that what a joint forbids cannot
//! happen, and no stiffness is to be chosen. With J, the velocities of the free bodies by those of the coordinates (V = J·v), all that
//! acts on free bodies acts on the coordinates: forces as Jᵀ·F, the mass matrix as Jᵀ·M·J. Links and laws know nothing of joints; see
//! [`ThroughJoints`](crate::system::ThroughJoints). Loops close through joints with play.

mod derivatives;
mod joint;
mod motion;
mod numbers;
mod placed;
mod pose;
#[cfg(test)]
mod tests;

use super::{
    FreeBodies, Rigid,
    blocks::{add_column, add_turned},
};
use crate::{
    ParameterError, SMatrix, SVector, Scalar, Vector3,
    error::bounded,
    product::cross,
    system::{Bodies, Lu, Reduced, half_turn, spatial::Placed as PlacedBodies},
};

pub use joint::{Joint, Kind, Mount};
pub use placed::Placed;

/// A coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Coordinate<S> {
    kind: Kind,
    /// See [`Joint::coordinates`].
    axis: Vector3<S>,
    /// Which of the mounts it belongs to.
    mount: usize,
}

/// How a body hangs: [`Mount`] with what is made of it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Hung<S> {
    body: usize,
    on: Option<usize>,
    /// In the nominal pose: from the centre of mass of what it hangs on to the joint, and from there to its own (m).
    arms: [Vector3<S>; 2],
    /// Its coordinates: the first and how many.
    coordinates: [usize; 2],
}

/// `N` bodies with `W` = 6·`N` velocities, on joints that leave `D` coordinates.
///
/// Coordinates are numbered mount by mount, the slides of a joint before its turns. A free body has its displacement and its angular
/// velocity in its own axes, as in [`FreeBodies`]. Coordinates that no joint uses, and bodies that hang on nothing, stand still.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpatialTree<S, const N: usize, const W: usize, const D: usize> {
    free: FreeBodies<S, N, W>,
    mounts: [Option<Hung<S>>; N],
    coordinates: [Coordinate<S>; D],
    /// Whether a coordinate moves a body.
    moves: [[bool; N]; D],
    per_lever: SVector<S, D>,
    least_mass: S,
}

impl<S: Scalar + PartialOrd, const N: usize, const W: usize, const D: usize> SpatialTree<S, N, W, D> {
    /// The bodies of `free` on `mounts`, each body after the one that it hangs on.
    ///
    /// # Errors
    /// [`ParameterError`] names what is out of bounds: a `body` that is not there or hangs twice, an `on` that does not hang yet, more
    /// `coordinates` than there is room for, an `axis` that is not of unit length, a place `at` far away.
    pub fn new(free: FreeBodies<S, N, W>, mounts: &[Mount<S>]) -> Result<Self, ParameterError<S>> {
        let number = |x: usize| S::from_count(u32::try_from(x).unwrap_or(u32::MAX));
        let refused = |parameter, value: usize, most: usize| ParameterError {
            parameter,
            value: number(value),
            least: S::zero(),
            greatest: number(most),
        };
        bounded("mounts", number(mounts.len()), [1.0, N as f64])?;
        let mut hung = [None; N];
        let mut coordinates = [Coordinate { kind: Kind::Still, axis: Vector3::zeros(), mount: 0 }; D];
        let mut moves = [[false; N]; D];
        let mut used = 0;
        for (m, (slot, mount)) in hung.iter_mut().zip(mounts).enumerate() {
            let Mount { body, on, joint } = *mount;
            let before = mounts.get(..m).unwrap_or_default();
            let hangs = |body| before.iter().any(|other| other.body == body);
            let centre = |body: usize| free.bodies().get(body).map(|rigid: &Rigid<S>| rigid.centre_w);
            let own = centre(body).filter(|_| !hangs(body)).ok_or_else(|| refused("body", body, N - 1))?;
            let from = match on {
                Some(on) => centre(on).filter(|_| hangs(on)).ok_or_else(|| refused("on", on, N - 1))?,
                None => Vector3::zeros(),
            };
            let joint = joint.checked()?;
            let at = joint.place().copied().unwrap_or(own);
            let end = used + joint.freedoms();
            let places = coordinates.get_mut(used..end).ok_or_else(|| refused("coordinates", end, D))?;
            for (place, (kind, axis)) in places.iter_mut().zip(joint.coordinates()) {
                *place = Coordinate { kind, axis, mount: m };
            }
            for (k, moves) in moves.iter_mut().enumerate() {
                let carried = on.and_then(|on| moves.get(on).copied()).unwrap_or(false);
                if let Some(moved) = moves.get_mut(body) {
                    *moved = carried || (used..end).contains(&k);
                }
            }
            *slot = Some(Hung { body, on, arms: [at - from, own - at], coordinates: [used, end - used] });
            used = end;
        }
        let mut tree =
            Self { free, mounts: hung, coordinates, moves, per_lever: SVector::zeros(), least_mass: S::from_f64(1e6) };
        tree.per_lever = SVector::from_fn(|k, _| S::one() / tree.reach(k));
        tree.least_mass = tree.least_mass_of(mounts);
        Ok(tree)
    }

    /// How far bodies reach (m) about the coordinate `k`; 1 for a slide.
    fn reach(&self, k: usize) -> S {
        let Some(Coordinate { kind, axis, mount }) = self.coordinates.get(k) else { return S::one() };
        if !kind.turns() {
            return S::one();
        }
        let hung = self.mounts.get(*mount).copied().flatten();
        let at = hung.map_or(Vector3::zeros(), |hung| self.centre(hung.body) - hung.arms[1]);
        let mut farthest = S::from_f64(1e-6);
        for (body, rigid) in self.free.bodies().iter().enumerate() {
            if self.is_moved(k, body) {
                let arm = rigid.centre_w - at;
                let away = if *kind == Kind::Turn { cross(axis, &arm) } else { arm };
                let moment = rigid.inertia_b.iter().fold(S::zero(), |most, moment| most.max_of(*moment));
                farthest = farthest.max_of(away.dot(&away).sqrt() + (moment / rigid.mass).sqrt());
            }
        }
        farthest
    }

    /// The least mass (kg) of bodies that move as one.
    fn least_mass_of(&self, mounts: &[Mount<S>]) -> S {
        let bodies = self.free.bodies();
        let moving = mounts.iter().filter(|mount| (0..D).any(|k| self.is_moved(k, mount.body)));
        moving.fold(self.least_mass, |least, mount| {
            let as_one =
                |other: &&Mount<S>| (0..D).all(|k| self.is_moved(k, mount.body) == self.is_moved(k, other.body));
            let masses = mounts.iter().filter(as_one).filter_map(|other| bodies.get(other.body));
            let whole = masses.fold(S::zero(), |sum, body| sum + body.mass);
            least.select_gt(whole, whole, least)
        })
    }
}

impl<S: Scalar, const N: usize, const W: usize, const D: usize> SpatialTree<S, N, W, D> {
    /// The bodies, as free ones.
    pub fn free_bodies(&self) -> &FreeBodies<S, N, W> {
        &self.free
    }

    /// By which length (m) the angle `k` is compared with displacements; 1 for a displacement.
    pub fn lever(&self, k: usize) -> S {
        self.per_lever.get(k).map_or(S::one(), |per_lever| S::one() / *per_lever)
    }

    /// What the coordinate `k` does, and along or about which axis of what its joint hangs on; of a ball, of the body.
    pub fn coordinate(&self, k: usize) -> (Kind, Vector3<S>) {
        self.coordinates.get(k).map_or((Kind::Still, Vector3::zeros()), |found| (found.kind, found.axis))
    }

    /// Whether the coordinate `k` moves a body.
    #[inline(always)]
    pub fn is_moved(&self, k: usize, body: usize) -> bool {
        self.moves.get(k).and_then(|moves| moves.get(body)).copied().unwrap_or(false)
    }

    /// The centre of mass (m) of a body in the nominal pose.
    #[inline(always)]
    fn centre(&self, body: usize) -> Vector3<S> {
        self.free.bodies().get(body).map_or(Vector3::zeros(), |body| body.centre_w)
    }
}

impl<S: Scalar, const N: usize, const W: usize, const D: usize> Bodies<S, D> for SpatialTree<S, N, W, D> {
    /// Of a slide the displacement (m) and 0, of a turn cosine and sine of half the angle, of a ball the four parts of a quaternion
    /// and two zeros; turns near unit length.
    type Pose = [[S; 2]; D];
    type Placed = Placed<S, N, W, D>;
    type Mass = SMatrix<S, D, D>;
    type Axes = ();
    type Jacobian = SMatrix<S, D, D>;

    const MASS_IS_CONSTANT: bool = false;

    #[inline(always)]
    fn implicit_update(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose {
        self.updated(pose, velocity, dt, true)
    }

    #[inline(always)]
    fn explicit_update(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose {
        self.updated(pose, velocity, dt, false)
    }

    #[inline(always)]
    fn shifted(&self, base: &Self::Pose, from: &Self::Pose, to: &Self::Pose, weight: S) -> Self::Pose {
        half_turn::shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn normalised(&self, pose: &Self::Pose) -> Self::Pose {
        self.at_unit_length(pose)
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
        self.rate_at(displacement, velocity)
    }

    #[inline(always)]
    fn displacement(&self, velocity: &SVector<S, D>, rate: &SVector<S, D>, a: S) -> SVector<S, D> {
        self.displaced(velocity, rate, a)
    }

    #[inline(always)]
    fn stiffened(
        &self,
        mut matrix: SMatrix<S, D, D>,
        stiffness: &SMatrix<S, D, D>,
        ((), velocity): (&(), &SVector<S, D>),
        a: S,
    ) -> SMatrix<S, D, D> {
        for (k, coordinate) in self.coordinates.iter().enumerate() {
            match coordinate.kind {
                Kind::Slide | Kind::Turn => add_column(&mut matrix, stiffness, k, a),
                Kind::Ball => add_turned(&mut matrix, stiffness, (k, &numbers::three(velocity, k)), a),
                Kind::OfBall | Kind::Still => {}
            }
        }
        matrix
    }

    #[inline(always)]
    fn placed(&self, pose: &Self::Pose, velocity: &SVector<S, D>) -> Self::Placed {
        self.moving(pose, velocity)
    }

    #[inline(always)]
    fn axes(&self, _: &Self::Placed) {}

    #[inline(always)]
    fn mass(&self, placed: &Self::Placed) -> SMatrix<S, D, D> {
        self.reduced_mass(placed)
    }

    #[inline(always)]
    fn inertia(&self, mass: &SMatrix<S, D, D>, rate: S) -> SMatrix<S, D, D> {
        mass * rate
    }

    #[inline(always)]
    fn momentum(&self, mass: &SMatrix<S, D, D>, velocity: &SVector<S, D>) -> SVector<S, D> {
        numbers::times(mass, velocity)
    }

    #[inline(always)]
    fn velocity(&self, mass: &SMatrix<S, D, D>, momentum: &SVector<S, D>) -> SVector<S, D> {
        Lu::of(*mass).solve(momentum)
    }

    #[inline(always)]
    fn own_force(&self, placed: &Self::Placed) -> SVector<S, D> {
        self.reduced(placed, &self.own_wrench(placed, &self.accelerations(placed, &SVector::zeros())))
    }

    #[inline(always)]
    fn own_jacobians(
        &self,
        placed: &Self::Placed,
        _: &SMatrix<S, D, D>,
        acceleration: &SVector<S, D>,
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        self.add_own_jacobians(placed, acceleration, damping, stiffness);
    }

    #[inline(always)]
    fn least_mass(&self) -> S {
        self.least_mass
    }

    #[inline(always)]
    fn per_lever(&self) -> SVector<S, D> {
        self.per_lever
    }

    /// Summed in order, so that coordinates that stand still change no bit.
    #[inline(always)]
    fn impulse(&self, imbalance: &SVector<S, D>) -> S {
        numbers::length(&imbalance.component_mul(&self.per_lever))
    }

    /// Likewise.
    #[inline(always)]
    fn weighed(&self, change: &SVector<S, D>) -> S {
        self.least_mass * numbers::length(&change.component_div(&self.per_lever))
    }
}

impl<S: Scalar, const N: usize, const W: usize, const D: usize> Reduced<S, D, W> for SpatialTree<S, N, W, D> {
    type Free = FreeBodies<S, N, W>;

    #[inline(always)]
    fn free<'a>(&'a self, placed: &'a Self::Placed) -> (&'a FreeBodies<S, N, W>, &'a PlacedBodies<S, N>) {
        (&self.free, &placed.free)
    }

    #[inline(always)]
    fn reduced_force(&self, placed: &Self::Placed, force: &SVector<S, W>) -> SVector<S, D> {
        self.reduced(placed, force)
    }

    #[inline(always)]
    fn add_reduced_impedance(
        &self,
        placed: &Self::Placed,
        of_free: (&SVector<S, W>, &SMatrix<S, W, W>),
        a: S,
        sum: &mut SMatrix<S, D, D>,
    ) {
        self.add_impedance(placed, of_free, a, sum);
    }

    #[inline(always)]
    fn add_reduced_derivatives(
        &self,
        placed: &Self::Placed,
        force: &SVector<S, W>,
        of_free: [&SMatrix<S, W, W>; 2],
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        self.add_derivatives(placed, force, of_free, damping, stiffness);
    }
}
