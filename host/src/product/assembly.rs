//! The chain of transformations from the parts' deviations to the assembled product (eqs. 2–4 of the paper).
//!
//! r_tot = Π T(q_kin)·T(q_tol)·T(q_as)·r: kinematic displacements q_kin are part of the nominal places; a feature's own
//! deviation and that of its datums make q_tol; q_as, how a part comes to lie on others, is solved for from its contacts.
//! All small ones are shifts with a Gibbs vector, exact for any size of rotation.

use crate::tolerance::lanes::Lanes;

use super::{
    contacts::{Contacts, Joined, PlacementError},
    feature::{Feature, Located, Shape},
    vector::{Displacement, Vector},
};

/// Features and what displaces them, in order.
#[derive(Clone, Debug, Default)]
pub struct Assembly {
    /// All features, those of later parts later; a feature's datums come before it.
    pub features: Vec<Feature>,
    /// What is displaced by what, in order.
    pub placements: Vec<Placement>,
}

/// How a body comes to lie, a part on others or a frame of datums on its features, and what it carries.
#[derive(Clone, Debug)]
pub struct Placement {
    support: Support,
    carried: Vec<Carried>,
}

#[derive(Clone, Debug)]
enum Support {
    /// A datum that is one plane: a perfect plane on the actual one.
    Plane(usize),
    /// Contacts whose conditions are solved for.
    Contacts(Contacts),
}

/// A feature that goes where a body goes.
#[derive(Clone, Copy, Debug)]
pub struct Carried {
    /// Its index.
    pub feature: usize,
    /// Whether it turns only, about its own point.
    pub turns_only: bool,
}

impl Carried {
    /// Moves the feature. The direction of a point is of no use once its own tolerance has moved it.
    #[inline(always)]
    fn by(self, displacement: &Displacement, features: &[Feature], located: &mut [Located]) {
        let moved = &mut located[self.feature];
        if !self.turns_only {
            moved.place = displacement.apply(moved.place);
        }
        if features[self.feature].shape != Shape::Point {
            moved.direction = displacement.turn(moved.direction);
        }
    }
}

impl Placement {
    /// What goes with a plane that is the only datum. The plane holds a shift along its normal and two rotations; it
    /// leads to no other motion.
    pub fn on_plane(plane: usize, carried: Carried) -> Self {
        Self { support: Support::Plane(plane), carried: vec![carried] }
    }

    /// A body that `contacts` place, the first with precedence over the next, and that carries the features `carried`.
    /// Other freedoms are `fixed`: directions of shifts, and of rotations about the centre.
    ///
    /// # Errors
    /// [`PlacementError`].
    pub fn on_contacts(
        assembly: &Assembly,
        nominal: &[Lanes],
        contacts: Vec<Joined>,
        fixed: &[[[f64; 3]; 2]],
        carried: Vec<Carried>,
    ) -> Result<Self, PlacementError> {
        let support = Support::Contacts(Contacts::new(assembly, nominal, contacts, fixed)?);
        Ok(Self { support, carried })
    }

    /// Lets the body carry another feature.
    pub fn carry(&mut self, carried: Carried) {
        self.carried.push(carried);
    }

    /// Moves the features that the body carries to where it comes to lie.
    #[inline(always)]
    fn place(&self, assembly: &Assembly, located: &mut [Located]) {
        let displacement = match &self.support {
            Support::Plane(plane) => onto_plane(&assembly.features[*plane], &located[*plane]),
            Support::Contacts(contacts) => contacts.displacement(assembly, located),
        };
        for carried in &self.carried {
            carried.by(&displacement, &assembly.features, located);
        }
    }
}

/// The displacement that brings a nominal plane onto the actual one, by the shortest way.
#[inline(always)]
fn onto_plane(nominal: &Feature, actual: &Located) -> Displacement {
    let [place, normal] = nominal.nominal;
    let perfect = nominal.perfect();
    // 2·tan(θ/2) of the angle between n and m is 2·|n × m|/(|m| + n·m).
    let cosine = actual.direction.along(normal);
    let turn = perfect.direction.cross(actual.direction) * (Lanes::splat(2.0) / (actual.direction.norm() + cosine));
    let height = actual.direction.dot(actual.place - perfect.place) / cosine;
    let (shift, Vector([a, b, c])) = (perfect.direction * height, turn);
    let Vector([x, y, z]) = shift;
    Displacement::new(&[x, y, z, a, b, c], place)
}

impl Assembly {
    /// All features where they are in the assembled units.
    pub fn locate(&self, variables: &[Lanes]) -> Vec<Located> {
        let mut located: Vec<_> = self.features.iter().map(Feature::perfect).collect();
        for (feature, located) in self.features.iter().zip(&mut located) {
            feature.deviate(variables, located);
        }
        for placement in &self.placements {
            placement.place(self, &mut located);
        }
        located
    }
}
