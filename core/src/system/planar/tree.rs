//! The tree: coordinates, bodies, and how they resist.

use super::{Point, left, point::At};
use crate::{ParameterError, SMatrix, SVector, Scalar, Vector2, error::bounded, system::Bodies};

/// A generalised coordinate of ideal joints in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coordinate<S> {
    /// An angle in the frame.
    Turn,
    /// A displacement along `axis`, of unit length, fixed in the axes of the turning coordinate `on`, or of the frame.
    Slide {
        /// Which coordinate turns the axis.
        on: Option<usize>,
        /// Direction.
        axis: Vector2<S>,
    },
}

/// A rigid body of the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid<S, const D: usize> {
    /// Mass (kg).
    pub mass: S,
    /// Moment of inertia about the centre of mass (kg·m²); of no effect where the body does not turn.
    pub inertia: S,
    /// The centre of mass.
    pub centre: Point<S, D>,
}

/// Bodies in a plane with `D` coordinates, of which there are at most as many bodies.
///
/// Body by body the accelerations are J·V̇ + J̇·V; the mass matrix is Σ m·JᵀJ + inertia, exact at every pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarTree<S, const D: usize> {
    coordinates: [Coordinate<S>; D],
    bodies: [Rigid<S, D>; D],
    count: usize,
    gravity: Vector2<S>,
    least_mass: S,
    per_lever: SVector<S, D>,
}

impl<S: Scalar + PartialOrd, const D: usize> PlanarTree<S, D> {
    /// A tree of `coordinates` and `bodies` under `gravity` (m/s²).
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds, or that there are more bodies than
    /// coordinates.
    pub fn new(
        coordinates: [Coordinate<S>; D],
        bodies: &[Rigid<S, D>],
        gravity: Vector2<S>,
    ) -> Result<Self, ParameterError<S>> {
        bounded("bodies", S::from_count(bodies.len() as u32), [1.0, D as f64])?;
        for component in gravity.iter() {
            bounded("gravity", *component, [-1e4, 1e4])?;
        }
        let none = Rigid { mass: S::zero(), inertia: S::zero(), centre: Point::fixed(Vector2::zeros()) };
        let mut all = [none; D];
        let mut least_mass = S::from_f64(1e6);
        let mut levers = [S::from_f64(1e-6); D];
        for (slot, body) in all.iter_mut().zip(bodies) {
            let mass = bounded("mass", body.mass, [1e-9, 1e6])?;
            bounded("inertia", body.inertia, [0.0, 1e9])?;
            least_mass = least_mass.select_gt(mass, mass, least_mass);
            for (k, (lever, arm)) in levers.iter_mut().zip(&body.centre.arms).enumerate() {
                let turns = body.centre.turn == Some(k);
                let gyration = if turns { (body.inertia / mass).sqrt() } else { S::zero() };
                *lever = lever.max_of(arm.dot(arm).sqrt()).max_of(gyration);
            }
            *slot = *body;
        }
        let mut per_lever = SVector::<S, D>::zeros();
        for ((weight, coordinate), lever) in per_lever.iter_mut().zip(&coordinates).zip(levers) {
            *weight = match coordinate {
                Coordinate::Turn => S::one() / lever,
                Coordinate::Slide { .. } => S::one(),
            };
        }
        Ok(Self { coordinates, bodies: all, count: bodies.len(), gravity, least_mass, per_lever })
    }
}

impl<S: Scalar, const D: usize> PlanarTree<S, D> {
    /// The coordinates.
    pub fn coordinates(&self) -> &[Coordinate<S>; D] {
        &self.coordinates
    }

    /// The bodies.
    pub fn bodies(&self) -> &[Rigid<S, D>] {
        self.bodies.split_at_checked(self.count).map_or(&[], |(bodies, _)| bodies)
    }

    /// Where a point is (m) and how fast it moves (m/s).
    pub fn motion_of(&self, point: &Point<S, D>, placed: &Placed<S, D>) -> [Vector2<S>; 2] {
        let at = At::of(self, point, placed);
        [at.place, at.gradient * placed.rates]
    }

    /// By which length (m) the angle `k` is compared with displacements; 1 for a displacement.
    pub fn lever(&self, k: usize) -> S {
        self.per_lever.get(k).map_or(S::one(), |per_lever| S::one() / *per_lever)
    }

    /// The pose with the given angles (rad) and displacements (m).
    pub fn pose(&self, values: [S; D], half_angle: impl Fn(S) -> [S; 2]) -> [[S; 2]; D] {
        let mut pose = [[S::zero(); 2]; D];
        for ((pose, value), coordinate) in pose.iter_mut().zip(values).zip(&self.coordinates) {
            *pose = match coordinate {
                Coordinate::Turn => half_angle(value),
                Coordinate::Slide { .. } => [value, S::zero()],
            };
        }
        pose
    }
}

/// The tree at a pose and motion.
#[derive(Clone, Copy, Debug)]
pub struct Placed<S, const D: usize> {
    /// Cosine and sine of turning coordinates; of sliding ones the axis in the frame.
    pub axes: [Vector2<S>; D],
    /// Displacements of sliding coordinates (m).
    pub places: [S; D],
    /// Generalised velocities.
    pub rates: SVector<S, D>,
}

impl<S: Scalar, const D: usize> Bodies<S, D> for PlanarTree<S, D> {
    /// Of a turn cosine and sine of half the angle, near unit length; of a slide the displacement (m) and 0.
    type Pose = [[S; 2]; D];
    type Placed = Placed<S, D>;

    const MASS_IS_CONSTANT: bool = false;

    #[inline(always)]
    fn advanced(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose {
        let mut next = self.moved(pose, velocity, dt);
        for ((pose, rate), coordinate) in next.iter_mut().zip(velocity).zip(&self.coordinates) {
            if let Coordinate::Turn = coordinate {
                let half = *rate * dt * S::from_f64(0.5);
                let scale = S::one() / (S::one() + half * half);
                *pose = pose.map(|x| x * scale);
            }
        }
        next
    }

    #[inline(always)]
    fn moved(&self, pose: &Self::Pose, velocity: &SVector<S, D>, dt: S) -> Self::Pose {
        let mut next = *pose;
        for ((pose, rate), coordinate) in next.iter_mut().zip(velocity).zip(&self.coordinates) {
            let [w, v] = *pose;
            *pose = match coordinate {
                Coordinate::Turn => {
                    let half = *rate * dt * S::from_f64(0.5);
                    [w - v * half, v + w * half]
                }
                Coordinate::Slide { .. } => [w + *rate * dt, v],
            };
        }
        next
    }

    #[inline(always)]
    fn shifted(&self, base: &Self::Pose, from: &Self::Pose, to: &Self::Pose, weight: S) -> Self::Pose {
        let mut shifted = *base;
        for ((base, from), to) in shifted.iter_mut().zip(from).zip(to) {
            *base = [base[0] + (to[0] - from[0]) * weight, base[1] + (to[1] - from[1]) * weight];
        }
        shifted
    }

    #[inline(always)]
    fn normalised(&self, pose: &Self::Pose) -> Self::Pose {
        let mut normalised = *pose;
        for (pose, coordinate) in normalised.iter_mut().zip(&self.coordinates) {
            if let Coordinate::Turn = coordinate {
                let [w, v] = *pose;
                let scale = S::from_f64(0.5) * (S::from_f64(3.0) - (w * w + v * v));
                *pose = [w * scale, v * scale];
            }
        }
        normalised
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &Self::Pose, kept: &mut Self::Pose) {
        for (kept, next) in kept.as_flattened_mut().iter_mut().zip(next.as_flattened()) {
            *kept = next.or_old(condition, *kept);
        }
    }

    #[inline(always)]
    fn finiteness_probe(&self, pose: &Self::Pose) -> S {
        pose.as_flattened().iter().fold(S::zero(), |sum, x| sum + *x * S::zero())
    }

    /// With the angle θ of [`moved`](Bodies::moved), tan(θ/2) is what it adds, so that θ̇ = ω·(1 + θ²/4).
    #[inline(always)]
    fn rate(&self, displacement: &SVector<S, D>, velocity: &SVector<S, D>) -> SVector<S, D> {
        let mut rate = *velocity;
        for ((rate, place), coordinate) in rate.iter_mut().zip(displacement).zip(&self.coordinates) {
            if let Coordinate::Turn = coordinate {
                *rate *= S::one() + *place * *place * S::from_f64(0.25);
            }
        }
        rate
    }

    #[inline(always)]
    fn placed(&self, pose: &Self::Pose, velocity: &SVector<S, D>) -> Placed<S, D> {
        let mut axes = [Vector2::new(S::one(), S::zero()); D];
        let mut places = [S::zero(); D];
        for (((axis, place), pose), coordinate) in axes.iter_mut().zip(&mut places).zip(pose).zip(&self.coordinates) {
            let [w, v] = *pose;
            match coordinate {
                Coordinate::Turn => {
                    let twice = v * (S::from_f64(2.0) / (w * w + v * v));
                    *axis = Vector2::new(S::one() - twice * v, twice * w);
                }
                Coordinate::Slide { axis: along, .. } => {
                    *axis = *along;
                    *place = w;
                }
            }
        }
        for k in 0..D {
            if let Coordinate::Slide { on: Some(on), .. } = self.coordinates[k] {
                axes[k] = turned(&axes[on], &axes[k]);
            }
        }
        Placed { axes, places, rates: *velocity }
    }

    #[inline(always)]
    fn mass(&self, placed: &Placed<S, D>) -> SMatrix<S, D, D> {
        let mut mass = SMatrix::<S, D, D>::zeros();
        for body in self.bodies() {
            let gradient = At::of(self, &body.centre, placed).gradient;
            mass += gradient.tr_mul(&gradient) * body.mass;
            if let Some(turn) = body.centre.turn {
                mass[(turn, turn)] += body.inertia;
            }
        }
        mass
    }

    #[inline(always)]
    fn own_force(&self, placed: &Placed<S, D>) -> SVector<S, D> {
        let mut force = SVector::<S, D>::zeros();
        for body in self.bodies() {
            let at = At::of(self, &body.centre, placed);
            let resists = at.swept(self, &body.centre, placed, &placed.rates) * placed.rates;
            force += at.gradient.tr_mul(&((self.gravity - resists) * body.mass));
        }
        force
    }

    #[inline(always)]
    fn own_slopes(
        &self,
        placed: &Placed<S, D>,
        acceleration: &SVector<S, D>,
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        for body in self.bodies() {
            let at = At::of(self, &body.centre, placed);
            let swept = at.swept(self, &body.centre, placed, &placed.rates);
            let resists = at.gradient * acceleration + swept * placed.rates - self.gravity;
            let [by_rate, by_place] = at.swept_slopes(self, &body.centre, placed);
            *damping += at.gradient.tr_mul(&by_rate) * body.mass;
            let by_place = by_place + at.swept(self, &body.centre, placed, acceleration);
            *stiffness += at.gradient.tr_mul(&by_place) * body.mass;
            at.add_curvature(self, &body.centre, placed, &(resists * body.mass), stiffness);
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

/// `p` turned by the angle whose cosine and sine `by` holds.
#[inline(always)]
pub(super) fn turned<S: Scalar>(by: &Vector2<S>, p: &Vector2<S>) -> Vector2<S> {
    p * by.x + left(p) * by.y
}
