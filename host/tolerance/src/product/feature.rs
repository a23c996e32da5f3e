//! Features: planes, points and axes, where they are nominally and how their tolerances move them.
//!
//! A plane is known by the point at its middle and its outward normal. Its deviation is a small displacement torsor: the
//! height w + αx + βy over its face. In units of its zone of width t that is u = 2w/t, p = αa/t, r = βb/t for extents
//! a × b, so that |u| + |p| + |r| ≤ 1 keeps all four corners in the zone. At maximum or least material condition t goes with
//! the feature's size.

use crate::numeric::lanes::Lanes;

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

/// The width of a zone at maximum or least material condition: what the size has left to that limit adds to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bonus {
    /// Width (m) without a bonus.
    pub width: f64,
    /// The variable of the size (m).
    pub size: usize,
    /// The size (m) at maximum, or least, material.
    pub limit: f64,
    /// 1 where larger sizes have the bonus, −1 where smaller ones have it.
    pub sign: f64,
}

impl Bonus {
    /// The width (m) at a `size` (m): that at which the surface reaches its virtual condition, also beyond the limits.
    pub fn at(&self, size: f64) -> f64 {
        (self.width + self.sign * (size - self.limit)).max(0.0)
    }
}

/// A term whose factor is that of a zone 1 m wide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Widened {
    /// The term.
    pub term: Term,
    /// How wide its zone is.
    pub bonus: Bonus,
}

/// A feature in the assembly's frame, its part where the drawing has it.
#[derive(Clone, Debug)]
pub struct Feature {
    /// What it is.
    pub shape: Shape,
    /// Nominal place (m) and unit direction.
    pub nominal: [[f64; 3]; 2],
    /// Deviations, by component.
    pub terms: Vec<Term>,
    /// Those in zones that go with the size.
    pub widened: Vec<Widened>,
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

    /// Lets the zone of some `variables`, which is `middle` (m) wide so far, go with a size.
    pub fn widen(&mut self, variables: std::ops::Range<usize>, bonus: Bonus, middle: f64) {
        let terms = self.terms.extract_if(.., |term| variables.contains(&term.variable));
        let widened = terms.map(|term| Widened { term: Term { factor: term.factor / middle, ..term }, bonus });
        self.widened.extend(widened);
    }

    /// The components that vary: 0 to 2 of the place, 3 to 5 of the direction.
    pub fn components(&self) -> impl Iterator<Item = usize> {
        self.terms.iter().chain(self.widened.iter().map(|widened| &widened.term)).map(|term| term.component)
    }

    fn add(&mut self, variable: usize, first: usize, vector: [f64; 3], factor: f64) {
        for (i, x) in vector.into_iter().enumerate().filter(|(_, x)| x * factor != 0.0) {
            let component = first + i;
            let place = self.terms.partition_point(|term| term.component <= component);
            self.terms.insert(place, Term { variable, component, factor: x * factor });
        }
    }

    /// Where the drawing has it.
    #[inline(always)]
    pub fn perfect(&self) -> Located {
        let [place, direction] = self.nominal;
        Located { place: Vector::splat(place), direction: Vector::splat(direction) }
    }

    /// Writes where the feature is in the units with these `variables`, before its datums move.
    #[inline(always)]
    pub fn locate(&self, variables: &[Lanes], located: &mut Located) {
        // A sum at a time and from the constant that it starts with, so that it stays in a register.
        let mut terms = self.terms.as_slice();
        for (component, nominal) in self.nominal.as_flattened().iter().enumerate() {
            let mut sum = Lanes::splat(*nominal);
            while let [term, rest @ ..] = terms
                && term.component == component
            {
                sum += variables[term.variable] * term.factor;
                terms = rest;
            }
            *located.component(component) = sum;
        }
        for Widened { term, bonus } in &self.widened {
            let width = variables[bonus.size].map(|size| bonus.at(size));
            *located.component(term.component) += variables[term.variable] * width * term.factor;
        }
    }
}

impl Located {
    #[inline(always)]
    fn component(&mut self, component: usize) -> &mut Lanes {
        let vector = if component < 3 { &mut self.place } else { &mut self.direction };
        &mut vector.0[component % 3]
    }

    /// After a displacement.
    #[inline(always)]
    pub fn displaced(&self, displacement: &Displacement) -> Self {
        Self { place: displacement.apply(self.place), direction: displacement.turn(self.direction) }
    }
}
