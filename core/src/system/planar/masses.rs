//! Rigid bodies of a tree, summed over once: their masses' moments are constants, of which the mass matrix and all inertial forces
//! are made at any pose, whatever the number of bodies.
//!
//! A body's centre of mass is a sum of vectors, each constant in the axes of one coordinate: the arm that a turn carries, the axis
//! along which a slide moves it (zero where the coordinate does not move the body). Gravity is linear in them, kinetic energy and
//! inertial forces are bilinear. So the sums over the bodies of m·w, of m·wᵢ·wⱼ and of m·wᵢ × wⱼ are all there is to know: the
//! *augmented bodies* of the field.

use super::{
    Placed, Point, left,
    topology::{Carrier, Kind, Topology, Turns},
    turned,
};
use crate::{ParameterError, SMatrix, SVector, Scalar, Vector2, error::bounded};

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

/// Moments of the masses of all bodies: sums over the bodies of mass times vectors w, of which there is one a coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Masses<S, const D: usize> {
    /// Σ m·w (kg·m; kg of slides), in the axes of the coordinate.
    first: [Vector2<S>; D],
    /// Σ m·(wᵢ·wⱼ), and Σ m·(wᵢ × wⱼ), each in the axes of its coordinate.
    dot: SMatrix<S, D, D>,
    cross: SMatrix<S, D, D>,
    /// Whether a body is moved by both coordinates; where not, their products are zero.
    meets: [[bool; D]; D],
    /// Moments of inertia (kg·m²) by the coordinate that turns the bodies.
    inertia: [S; D],
    /// The least mass (kg) of bodies that move as one.
    pub least: S,
    /// How far bodies reach about each coordinate (m).
    pub levers: [S; D],
}

crate::cast::cast!([] [D] Masses: Masses<f64, D> => T Masses<T, D> { first, dot, cross, inertia, least, levers; meets });

impl<S: Scalar + PartialOrd, const D: usize> Masses<S, D> {
    /// Those of `bodies`, whose sliding coordinates go along `axes`.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn of<J: Topology<D>>(
        topology: &J,
        axes: &[Vector2<S>; D],
        bodies: &[Rigid<S, D>],
    ) -> Result<Self, ParameterError<S>> {
        let zero = S::zero();
        let mut masses = Self {
            first: [Vector2::zeros(); D],
            dot: SMatrix::zeros(),
            cross: SMatrix::zeros(),
            meets: [[false; D]; D],
            inertia: [zero; D],
            least: S::from_f64(1e6),
            levers: [S::from_f64(1e-6); D],
        };
        for body in bodies {
            let mass = bounded("mass", body.mass, [1e-9, 1e6])?;
            bounded("inertia", body.inertia, [0.0, 1e9])?;
            let carrier = &body.centre.carrier;
            // Bodies that move as one are one body to what it meets.
            let as_one = bodies.iter().filter(|other| other.centre.carrier == *carrier);
            let whole = as_one.fold(zero, |sum, other| sum + other.mass);
            masses.least = masses.least.select_gt(whole, whole, masses.least);
            let mut vectors = body.centre.arms;
            for (k, (vector, axis)) in vectors.iter_mut().zip(axes).enumerate() {
                let of_kind = if topology.kind(k) == Kind::Turn { *vector } else { *axis };
                *vector = if carrier.moves(k) { of_kind } else { Vector2::zeros() };
                let turns = carrier.turn() == Some(k);
                let gyration = if turns { (body.inertia / mass).sqrt() } else { zero };
                let arm = if topology.kind(k) == Kind::Turn { vector.dot(vector).sqrt() } else { zero };
                masses.levers[k] = masses.levers[k].max_of(arm).max_of(gyration);
                masses.inertia[k] += if turns { body.inertia } else { zero };
            }
            for (i, one) in vectors.iter().enumerate() {
                masses.first[i] += one * mass;
                for (j, other) in vectors.iter().enumerate() {
                    masses.meets[i][j] |= carrier.moves(i) && carrier.moves(j);
                    masses.dot[(i, j)] += one.dot(other) * mass;
                    masses.cross[(i, j)] += left(one).dot(other) * mass;
                }
            }
        }
        // A coordinate that moves nothing has a mass of its own, so that it stands still.
        for (k, moved) in masses.meets.iter().enumerate() {
            if !moved.get(k).copied().unwrap_or(false) {
                masses.dot[(k, k)] = S::one();
            }
        }
        Ok(masses)
    }
}

/// The moments at a pose, with all vectors in the axes of the frame: of a turn the whole arm, with what slides on it.
pub(super) struct Moments<S, const D: usize> {
    first: [Vector2<S>; D],
    dot: SMatrix<S, D, D>,
    /// Σ m·(cᵢ × cⱼ).
    cross: SMatrix<S, D, D>,
    inertia: [S; D],
}

impl<S: Scalar, const D: usize> Masses<S, D> {
    /// The moments where and as fast as `placed` says.
    #[inline(always)]
    pub fn at<J: Topology<D>>(&self, topology: &J, placed: &Placed<S, D>) -> Moments<S, D> {
        // The coordinate that turns the axes of a vector, and these axes.
        let turn = |k: usize| match topology.kind(k) {
            Kind::Turn => Some(k),
            Kind::Slide { on } => on,
        };
        let axes = |k: usize| turn(k).and_then(|turn| placed.axes.get(turn));
        let (mut dot, mut cross) = (SMatrix::<S, D, D>::zeros(), SMatrix::<S, D, D>::zeros());
        for i in 0..D {
            dot[(i, i)] = self.dot[(i, i)];
            for j in i + 1..D {
                if !self.meets[i][j] {
                    continue;
                }
                let (mut p, mut x) = (self.dot[(i, j)], self.cross[(i, j)]);
                if turn(i) != turn(j) {
                    // Cosine and sine of the angle from the axes of j to those of i.
                    let (cos, sin) = match (axes(i), axes(j)) {
                        (Some(i), Some(j)) => (i.dot(j), i.y * j.x - i.x * j.y),
                        (Some(i), None) => (i.x, i.y),
                        (None, Some(j)) => (j.x, -j.y),
                        (None, None) => (S::one(), S::zero()),
                    };
                    (p, x) = (p * cos + x * sin, x * cos - p * sin);
                }
                (dot[(i, j)], dot[(j, i)]) = (p, p);
                (cross[(i, j)], cross[(j, i)]) = (x, -x);
            }
        }
        let mut first = self.first;
        for (k, first) in first.iter_mut().enumerate() {
            if let Some(axes) = axes(k) {
                *first = turned(axes, first);
            }
        }
        // What slides on a turn lengthens its arm: its vector times its place, in rows and then in columns.
        for k in 0..D {
            if let Kind::Slide { on: Some(on) } = topology.kind(k) {
                let place = placed.places[k];
                let moved = first[k] * place;
                first[on] += moved;
                for matrix in [&mut dot, &mut cross] {
                    for j in 0..D {
                        let moved = matrix[(k, j)] * place;
                        matrix[(on, j)] += moved;
                    }
                    for i in 0..D {
                        let moved = matrix[(i, k)] * place;
                        matrix[(i, on)] += moved;
                    }
                }
            }
        }
        Moments { first, dot, cross, inertia: self.inertia }
    }
}

/// The sums over the bodies that the laws of motion are made of. With c the vectors of the coordinates in the frame, a body's
/// velocity goes by the coordinates as g: c turned to the left of a turn, c itself of a slide.
impl<S: Scalar, const D: usize> Moments<S, D> {
    /// Σ m·(gᵢ·cⱼ).
    #[inline(always)]
    fn along<J: Topology<D>>(&self, topology: &J, i: usize, j: usize) -> S {
        if topology.kind(i) == Kind::Turn { self.cross[(i, j)] } else { self.dot[(i, j)] }
    }

    /// Σ m·(gᵢ·cⱼ turned to the left).
    #[inline(always)]
    fn across<J: Topology<D>>(&self, topology: &J, i: usize, j: usize) -> S {
        if topology.kind(i) == Kind::Turn { self.dot[(i, j)] } else { self.cross[(j, i)] }
    }

    /// The mass matrix Σ m·(gᵢ·gⱼ) + inertia.
    #[inline(always)]
    pub fn matrix<J: Topology<D>>(&self, topology: &J) -> SMatrix<S, D, D> {
        let mut matrix = SMatrix::<S, D, D>::zeros();
        for j in 0..D {
            for i in 0..D {
                matrix[(i, j)] = match topology.kind(j) {
                    Kind::Turn => self.across(topology, i, j),
                    Kind::Slide { .. } => self.along(topology, i, j),
                };
            }
            if topology.kind(j) == Kind::Turn {
                matrix[(j, j)] += self.inertia[j];
            }
        }
        matrix
    }

    /// What `gravity` (m/s²) does less what turning resists: Σ m·gᵢ·(gravity − J̇·V).
    #[inline(always)]
    pub fn force<J: Topology<D>>(&self, topology: &J, gravity: &Vector2<S>, rates: &SVector<S, D>) -> SVector<S, D> {
        let mut force = SVector::<S, D>::zeros();
        for i in 0..D {
            force[i] = match topology.kind(i) {
                Kind::Turn => left(&self.first[i]).dot(gravity),
                Kind::Slide { .. } => self.first[i].dot(gravity),
            };
            for k in 0..D {
                match topology.kind(k) {
                    // A vector has no lever about itself.
                    Kind::Turn if k == i => {}
                    Kind::Turn => force[i] += self.along(topology, i, k) * (rates[k] * rates[k]),
                    Kind::Slide { on: Some(on) } => {
                        let turning = rates[on] * rates[k];
                        force[i] -= self.across(topology, i, k) * (turning + turning);
                    }
                    Kind::Slide { on: None } => {}
                }
            }
        }
        force
    }

    /// Adds how that force less M·`acceleration` goes by velocity and by place, negated.
    #[inline(always)]
    pub fn add_jacobians<J: Topology<D>>(
        &self,
        topology: &J,
        rates: &SVector<S, D>,
        (gravity, acceleration): (&Vector2<S>, &SVector<S, D>),
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let two = S::one() + S::one();
        for j in 0..D {
            match topology.kind(j) {
                Kind::Turn => {
                    let (rate, squared, turning) = (two * rates[j], rates[j] * rates[j], acceleration[j]);
                    for i in 0..D {
                        let (along, across) = (self.along(topology, i, j), self.across(topology, i, j));
                        damping[(i, j)] -= along * rate;
                        stiffness[(i, j)] -= along * turning + across * squared;
                    }
                }
                Kind::Slide { on: Some(on) } => {
                    let (by_on, by_slide) = (two * rates[on], two * rates[j]);
                    let (turning, squared) = (acceleration[on], rates[on] * rates[on]);
                    for i in 0..D {
                        let (along, across) = (self.along(topology, i, j), self.across(topology, i, j));
                        damping[(i, j)] += across * by_on;
                        damping[(i, on)] += across * by_slide;
                        stiffness[(i, j)] += across * turning - along * squared;
                        stiffness[(i, on)] += across * acceleration[j] - along * (by_slide * rates[on]);
                    }
                }
                Kind::Slide { on: None } => {}
            }
        }
        for k in 0..D {
            match topology.kind(k) {
                Kind::Turn => stiffness[(k, k)] -= self.resisted(topology, rates, (gravity, acceleration), k, false),
                Kind::Slide { on: Some(on) } => {
                    let across = self.resisted(topology, rates, (gravity, acceleration), k, true);
                    stiffness[(on, k)] += across;
                    stiffness[(k, on)] += across;
                }
                Kind::Slide { on: None } => {}
            }
        }
    }

    /// Σ m·c·(J·`acceleration` + J̇·V − gravity) with c = cₖ, or cₖ turned to the left.
    #[inline(always)]
    fn resisted<J: Topology<D>>(
        &self,
        topology: &J,
        rates: &SVector<S, D>,
        (gravity, acceleration): (&Vector2<S>, &SVector<S, D>),
        k: usize,
        is_left: bool,
    ) -> S {
        let first = if is_left { left(&self.first[k]) } else { self.first[k] };
        let mut sum = -first.dot(gravity);
        for j in 0..D {
            // By cⱼ, and by cⱼ turned to the left.
            let (along, across) =
                if is_left { (self.cross[(k, j)], self.dot[(k, j)]) } else { (self.dot[(k, j)], self.cross[(j, k)]) };
            match topology.kind(j) {
                Kind::Turn => sum += across * acceleration[j] - along * (rates[j] * rates[j]),
                Kind::Slide { on } => {
                    sum += along * acceleration[j];
                    if let Some(on) = on {
                        let turning = rates[on] * rates[j];
                        sum += across * (turning + turning);
                    }
                }
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        SMatrix, SVector, Vector2,
        system::{
            Bodies,
            planar::{
                Coordinate, PlanarTree,
                example::{Linkage, linkage},
            },
        },
    };

    #[test]
    fn refuses_what_makes_no_tree() {
        let Linkage { mut coordinates, bodies, .. } = linkage();
        let gravity = Vector2::new(0.0, -9.81);
        assert_eq!(PlanarTree::new(coordinates, &[], gravity).unwrap_err().parameter, "bodies");
        for on in [3, 6, usize::MAX] {
            coordinates[2] = Coordinate::Slide { on: Some(on), axis: Vector2::new(1.0, 0.0) };
            assert_eq!(PlanarTree::new(coordinates, &bodies, gravity).unwrap_err().parameter, "on", "{on}");
        }
    }

    #[test]
    fn bodies_that_move_as_one_are_one() {
        let Linkage { coordinates, bodies, .. } = linkage();
        let tree = PlanarTree::new(coordinates, &bodies, Vector2::new(0.0, -9.81)).unwrap();
        // The slider is the lightest; the two of the lift are 0.4 kg together.
        assert_eq!(tree.least_mass(), 0.2);
        let lift = PlanarTree::new(coordinates, &bodies[4..], Vector2::new(0.0, -9.81)).unwrap();
        assert_eq!(lift.least_mass(), 0.4);
    }

    /// Desks have trees with room for more coordinates than a scene has.
    #[test]
    fn coordinates_that_move_nothing_stand_still() {
        let Linkage { coordinates, bodies, .. } = linkage();
        let tree = PlanarTree::new(coordinates, &bodies[4..], Vector2::new(1.0, -9.81)).unwrap();
        let is_moved = |k: usize| bodies[4..].iter().any(|body| body.centre.carrier.moves[k]);
        let pose = tree.pose([0.3, -0.4, 0.05, 0.02, 0.1, -0.04], |x| [libm::cos(x / 2.0), libm::sin(x / 2.0)]);
        let rates = SVector::from_fn(|k, _| if is_moved(k) { 0.7 } else { 0.0 });
        let (mass, force) = tree.mass_and_own_force(&tree.placed(&pose, &rates));
        let acceleration = tree.velocity(&mass, &force);
        assert!((0..6).any(is_moved) && !(0..6).all(is_moved));
        for k in 0..6 {
            assert_eq!(acceleration[k] != 0.0, is_moved(k), "{k}: {acceleration}");
        }
    }

    /// What a planar body's mass does, by its definition: m·gᵀg and m·g·(gravity − J̇·V), J̇·V by a difference along the motion.
    #[test]
    fn moments_add_up_to_what_body_by_body_does() {
        let Linkage { coordinates, bodies, .. } = linkage();
        let gravity = Vector2::new(1.0, -9.81);
        let tree = PlanarTree::new(coordinates, &bodies, gravity).unwrap();
        let pose = tree.pose([0.3, -0.4, 0.05, 0.02, 0.1, -0.04], |x| [libm::cos(x / 2.0), libm::sin(x / 2.0)]);
        let v = SVector::<f64, 6>::new(0.7, -1.1, 0.4, 0.3, 2.0, -0.6);
        let mut matrix = SMatrix::<f64, 6, 6>::zeros();
        let mut force = SVector::<f64, 6>::zeros();
        let h = 1e-5;
        for body in &bodies {
            let velocity =
                |dt: f64| tree.motion_of(&body.centre, &tree.placed(&tree.explicit_update(&pose, &v, dt), &v))[1];
            let resists = (velocity(h) - velocity(-h)) / (2.0 * h);
            let gradient = tree.at(&body.centre, &tree.placed(&pose, &v)).gradient;
            for i in 0..6 {
                force[i] += gradient[i].dot(&(gravity - resists)) * body.mass;
                for j in 0..6 {
                    matrix[(i, j)] += gradient[i].dot(&gradient[j]) * body.mass;
                }
            }
            let turn = body.centre.carrier.turn.unwrap();
            matrix[(turn, turn)] += body.inertia;
        }
        let (found, found_force) = tree.mass_and_own_force(&tree.placed(&pose, &v));
        assert!((found - matrix).norm() < 1e-14, "{found} {matrix}");
        assert!((found_force - force).norm() < 1e-8, "{found_force} {force}");
    }
}
