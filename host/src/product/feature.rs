//! Features: planes, points and axes, where they are nominally and how their tolerances move them.
//!
//! A plane is known by the point at its middle and its outward normal. Its deviation is a small displacement torsor: the
//! height w + αx + βy over its face. In units of its zone of width t that is u = 2w/t, p = αa/t, r = βb/t for extents
//! a × b, so that |u| + |p| + |r| ≤ 1 keeps all four corners in the zone.

use crate::tolerance::lanes::Lanes;

use super::vector::{Displacement, Vector};

/// What a feature is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A plane; its direction is the outward normal.
    Plane,
    /// A point on a surface; its direction is the surface's outward normal.
    Point,
    /// The axis of a pin or hole; its direction points along it, its place is its middle.
    Axis,
}

impl Shape {
    /// In a sentence.
    pub fn article(self) -> &'static str {
        match self {
            Self::Plane => "a plane",
            Self::Point => "a point",
            Self::Axis => "an axis",
        }
    }
}

/// Place and direction of a feature in several units. The direction's length is about 1.
#[derive(Clone, Copy, Debug)]
pub struct Located {
    /// The feature's point (m).
    pub place: Vector,
    /// Normal or axis.
    pub direction: Vector,
}

/// `factor` · variable, added to one component: 0 to 2 of the place, 3 to 5 of the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// Index of the variable.
    pub variable: usize,
    /// Index of the component.
    pub component: usize,
    /// Component per variable.
    pub factor: f64,
}

/// A feature in the assembly's frame, its part where the drawing has it.
#[derive(Clone, Debug)]
pub struct Feature {
    /// What it is.
    pub shape: Shape,
    /// Nominal place (m) and unit direction.
    pub nominal: [[f64; 3]; 2],
    /// Deviations.
    pub terms: Vec<Term>,
    /// Half of its size (m), by which tilts are weighed against shifts.
    pub reach: f64,
}

impl Feature {
    /// Adds `factor` · `variable` along a `vector` to the place.
    pub fn shift(&mut self, variable: usize, vector: [f64; 3], factor: f64) {
        self.add(variable, 0, vector, factor);
    }

    /// Adds `factor` · `variable` along a `vector` to the direction.
    pub fn tilt(&mut self, variable: usize, vector: [f64; 3], factor: f64) {
        self.add(variable, 3, vector, factor);
    }

    fn add(&mut self, variable: usize, first: usize, vector: [f64; 3], factor: f64) {
        let factors = vector.into_iter().enumerate().map(|(i, x)| (first + i, x * factor));
        let terms = factors.filter(|(_, factor)| *factor != 0.0);
        self.terms.extend(terms.map(|(component, factor)| Term { variable, component, factor }));
    }

    /// Where the drawing has it.
    #[inline(always)]
    pub fn perfect(&self) -> Located {
        let [place, direction] = self.nominal;
        Located { place: Vector::splat(place), direction: Vector::splat(direction) }
    }

    /// Adds the deviations of the units with these `variables` to where the feature is.
    #[inline(always)]
    pub fn deviate(&self, variables: &[Lanes], located: &mut Located) {
        for term in &self.terms {
            let Located { place, direction } = &mut *located;
            let vector = if term.component < 3 { place } else { direction };
            vector.0[term.component % 3] += variables[term.variable] * term.factor;
        }
    }
}

impl Located {
    /// After a displacement.
    #[inline(always)]
    pub fn displaced(&self, displacement: &Displacement) -> Self {
        Self { place: displacement.apply(self.place), direction: displacement.turn(self.direction) }
    }
}
