//! Rigid bodies of a tree: one, several by type, or several by a count.

use super::{
    Placed, Point,
    point::At,
    topology::{Carrier, Chain, Topology},
};
use crate::{ParameterError, SMatrix, SVector, Scalar, Vector2, error::bounded};

/// A rigid body of the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid<S, const D: usize, C = Chain<D>> {
    /// Mass (kg).
    pub mass: S,
    /// Moment of inertia about the centre of mass (kg·m²); of no effect where the body does not turn.
    pub inertia: S,
    /// The centre of mass.
    pub centre: Point<S, D, C>,
}

/// As many bodies as are found at run time, at most `D`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Many<S, const D: usize> {
    bodies: [Rigid<S, D>; D],
    count: usize,
}

/// Bodies on `D` coordinates of topology `J`: one, or a tuple of such.
pub trait Rigids<S: Scalar, J, const D: usize>: Copy {
    /// Finds the least mass (kg), and how far bodies reach about each coordinate (m).
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    fn measure(&self, least_mass: &mut S, levers: &mut [S; D]) -> Result<(), ParameterError<S>>
    where
        S: PartialOrd;

    /// Adds to the `mass` matrix, and what `gravity` (m/s²) does and what turning resists to the `force`.
    fn add(
        &self,
        at: (&J, &Placed<S, D>),
        gravity: &Vector2<S>,
        mass: Option<&mut SMatrix<S, D, D>>,
        force: Option<&mut SVector<S, D>>,
    );

    /// Adds how that force less M·`acceleration` goes by velocity and by place, negated.
    fn add_slopes(
        &self,
        at: (&J, &Placed<S, D>),
        by: (&Vector2<S>, &SVector<S, D>),
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    );
}

impl<S: Scalar, J: Topology<D>, C: Carrier<D>, const D: usize> Rigids<S, J, D> for Rigid<S, D, C> {
    fn measure(&self, least_mass: &mut S, levers: &mut [S; D]) -> Result<(), ParameterError<S>>
    where
        S: PartialOrd,
    {
        let mass = bounded("mass", self.mass, [1e-9, 1e6])?;
        bounded("inertia", self.inertia, [0.0, 1e9])?;
        *least_mass = least_mass.select_gt(mass, mass, *least_mass);
        for (k, (lever, arm)) in levers.iter_mut().zip(&self.centre.arms).enumerate() {
            let turns = self.centre.carrier.turn() == Some(k);
            let gyration = if turns { (self.inertia / mass).sqrt() } else { S::zero() };
            *lever = lever.max_of(arm.dot(arm).sqrt()).max_of(gyration);
        }
        Ok(())
    }

    #[inline(always)]
    fn add(
        &self,
        (topology, placed): (&J, &Placed<S, D>),
        gravity: &Vector2<S>,
        mass: Option<&mut SMatrix<S, D, D>>,
        force: Option<&mut SVector<S, D>>,
    ) {
        let carrier = self.centre.carrier;
        let at = At::of(topology, &self.centre, placed);
        if let Some(mass) = mass {
            for j in 0..D {
                for i in 0..=j {
                    if carrier.moves(i) && carrier.moves(j) {
                        let entry = at.gradient[i].dot(&at.gradient[j]) * self.mass;
                        mass[(i, j)] += entry;
                        if i != j {
                            mass[(j, i)] += entry;
                        }
                    }
                }
            }
            if let Some(turn) = carrier.turn() {
                mass[(turn, turn)] += self.inertia;
            }
        }
        if let Some(force) = force {
            at.add_force(&((gravity - at.resisted(topology, placed)) * self.mass), force);
        }
    }

    #[inline(always)]
    fn add_slopes(
        &self,
        (topology, placed): (&J, &Placed<S, D>),
        (gravity, acceleration): (&Vector2<S>, &SVector<S, D>),
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let at = At::of(topology, &self.centre, placed);
        let resists = at.velocity(acceleration) + at.resisted(topology, placed) - gravity;
        let [by_rate, mut by_place] = at.swept_slopes(topology, placed);
        for (column, swept) in by_place.iter_mut().zip(at.swept(topology, placed, acceleration)) {
            *column += swept;
        }
        at.add_product(&by_rate.map(|column| column * self.mass), damping);
        at.add_product(&by_place.map(|column| column * self.mass), stiffness);
        at.add_curvature(topology, placed, &(resists * self.mass), stiffness);
    }
}

impl<S: Scalar, J, A: Rigids<S, J, D>, B: Rigids<S, J, D>, const D: usize> Rigids<S, J, D> for (A, B) {
    fn measure(&self, least_mass: &mut S, levers: &mut [S; D]) -> Result<(), ParameterError<S>>
    where
        S: PartialOrd,
    {
        self.0.measure(least_mass, levers)?;
        self.1.measure(least_mass, levers)
    }

    #[inline(always)]
    fn add(
        &self,
        at: (&J, &Placed<S, D>),
        gravity: &Vector2<S>,
        mut mass: Option<&mut SMatrix<S, D, D>>,
        mut force: Option<&mut SVector<S, D>>,
    ) {
        self.0.add(at, gravity, mass.as_deref_mut(), force.as_deref_mut());
        self.1.add(at, gravity, mass, force);
    }

    #[inline(always)]
    fn add_slopes(
        &self,
        at: (&J, &Placed<S, D>),
        by: (&Vector2<S>, &SVector<S, D>),
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        self.0.add_slopes(at, by, damping, stiffness);
        self.1.add_slopes(at, by, damping, stiffness);
    }
}

impl<S: Scalar, const D: usize> Many<S, D> {
    /// These `bodies`.
    ///
    /// # Errors
    /// If there are none, or more than coordinates.
    pub fn new(bodies: &[Rigid<S, D>]) -> Result<Self, ParameterError<S>>
    where
        S: PartialOrd,
    {
        bounded("bodies", S::from_count(bodies.len() as u32), [1.0, D as f64])?;
        let none = Rigid { mass: S::zero(), inertia: S::zero(), centre: Point::fixed(Vector2::zeros()) };
        let mut all = [none; D];
        for (slot, body) in all.iter_mut().zip(bodies) {
            *slot = *body;
        }
        Ok(Self { bodies: all, count: bodies.len() })
    }

    /// The bodies.
    pub fn iter(&self) -> impl Iterator<Item = &Rigid<S, D>> {
        self.bodies.iter().take(self.count)
    }
}

impl<S: Scalar, J: Topology<D>, const D: usize> Rigids<S, J, D> for Many<S, D> {
    fn measure(&self, least_mass: &mut S, levers: &mut [S; D]) -> Result<(), ParameterError<S>>
    where
        S: PartialOrd,
    {
        self.iter().try_for_each(|body| Rigids::<S, J, D>::measure(body, least_mass, levers))
    }

    #[inline(always)]
    fn add(
        &self,
        at: (&J, &Placed<S, D>),
        gravity: &Vector2<S>,
        mut mass: Option<&mut SMatrix<S, D, D>>,
        mut force: Option<&mut SVector<S, D>>,
    ) {
        self.iter().for_each(|body| body.add(at, gravity, mass.as_deref_mut(), force.as_deref_mut()));
    }

    fn add_slopes(
        &self,
        at: (&J, &Placed<S, D>),
        by: (&Vector2<S>, &SVector<S, D>),
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        self.iter().for_each(|body| body.add_slopes(at, by, damping, stiffness));
    }
}
