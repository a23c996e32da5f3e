//! The chain of transformations from the parts' deviations to the assembled product (eqs. 2–4 of the paper).
//!
//! r_tot = Π T(q_kin)·T(q_tol)·T(q_as)·r: kinematic displacements q_kin are part of the nominal places; a feature's own
//! deviation and that of its datums make q_tol; q_as, how a part comes to lie on others, is solved for from its contacts.
//! All small ones are shifts with a Gibbs vector, exact for any size of rotation.

use crate::numeric::lanes::Lanes;

use super::{
    common::Common,
    contact::across,
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
    /// Two features that are one datum; they carry nothing.
    Common(Common),
}

/// A feature that goes where a body goes.
#[derive(Clone, Copy, Debug)]
pub struct Carried {
    /// Its index.
    pub feature: usize,
    /// What of it.
    pub with: With,
}

/// What of a feature goes where a body goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum With {
    /// Place and direction.
    All,
    /// The place: another datum holds the direction.
    Place,
    /// The direction: it turns about its own point.
    Direction,
}

impl Carried {
    /// Moves the feature. The direction of a point is of no use once its own tolerance has moved it.
    #[inline(always)]
    fn by(self, displacement: &Displacement, features: &[Feature], located: &mut [Located]) {
        let moved = &mut located[self.feature];
        if self.with != With::Direction {
            moved.place = displacement.apply(moved.place);
        }
        if self.with != With::Place && features[self.feature].shape != Shape::Point {
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
        let mut located = Vec::new();
        assembly.locate(nominal, &mut located);
        let contacts = Contacts::new(&assembly.features, nominal, &located, contacts, fixed)?;
        Ok(Self { support: Support::Contacts(contacts), carried })
    }

    /// The datum that two features are together.
    pub fn common(common: Common) -> Self {
        Self { support: Support::Common(common), carried: Vec::new() }
    }

    /// How far (m) the body is drawn off its contacts, and how far (rad) turned, if it is.
    pub fn drawn_off(&self) -> Option<[f64; 2]> {
        match &self.support {
            Support::Contacts(contacts) => contacts.drawn_off(),
            Support::Plane(_) | Support::Common(_) => None,
        }
    }

    /// Motions that a frame of datums among the `features` is free to make, as shifts (m) and rotations (rad), and the point (m)
    /// about which it turns.
    pub fn free(&self, features: &[Feature]) -> (Vec<[[f64; 3]; 2]>, [f64; 3]) {
        match &self.support {
            Support::Plane(plane) => {
                let [place, normal] = features[*plane].nominal;
                let [one, two] = across(normal);
                (vec![[one, [0.0; 3]], [two, [0.0; 3]], [[0.0; 3], normal]], place)
            }
            Support::Contacts(contacts) => {
                let (motions, centre) = contacts.free();
                (motions.to_vec(), centre)
            }
            Support::Common(_) => (Vec::new(), [0.0; 3]),
        }
    }

    /// Lets the body carry another feature.
    pub fn carry(&mut self, carried: Carried) {
        self.carried.push(carried);
    }

    /// Moves the features that the body carries to where it comes to lie.
    #[inline(always)]
    fn place(&self, features: &[Feature], variables: &[Lanes], located: &mut [Located]) {
        let displacement = match &self.support {
            Support::Plane(plane) => onto_plane(&features[*plane], &located[*plane]),
            Support::Contacts(contacts) => contacts.displacement(features, variables, located),
            Support::Common(common) => return common.locate(located),
        };
        for carried in &self.carried {
            carried.by(&displacement, features, located);
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
    /// Writes all features where they are in the assembled units.
    #[inline(always)]
    pub fn locate(&self, variables: &[Lanes], located: &mut Vec<Located>) {
        if let Some(first) = self.features.first() {
            located.resize_with(self.features.len(), || first.perfect());
        }
        for (feature, located) in self.features.iter().zip(&mut *located) {
            feature.locate(variables, located);
        }
        for placement in &self.placements {
            placement.place(&self.features, variables, located);
        }
    }

    /// What goes wrong in the mates of units: of each fit, by its number, in which units the pin does not go into the hole; and
    /// in which units contacts do not close. `variables` are those of units whose holes are centred on their pins.
    pub fn misfits(&self, variables: &[Lanes], mut fit: impl FnMut(usize, usize)) -> usize {
        let mut located: Vec<_> = self.features.iter().map(Feature::perfect).collect();
        for (feature, located) in self.features.iter().zip(&mut located) {
            feature.locate(variables, located);
        }
        let mut open = 0;
        for placement in &self.placements {
            if let Support::Contacts(contacts) = &placement.support {
                let displacement = contacts.displacement(&self.features, variables, &located);
                contacts.misfits(&self.features, variables, &located, &displacement, &mut fit);
                open += displacement.undefined();
            }
            placement.place(&self.features, variables, &mut located);
        }
        open
    }
}
