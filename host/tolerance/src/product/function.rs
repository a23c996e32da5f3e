//! The measures of assembled units as a function of their variables.

use std::cell::Cell;

use crate::{
    model::{Function, Quantity, linear::Linear, loss::Loss, widening::Widening},
    numeric::lanes::{Lanes, widest},
};

use super::{
    assembly::Assembly,
    expression::{Affine, Expression, Tape},
    feature::{Located, Shape},
};

/// How one measure is computed.
#[derive(Clone, Debug)]
pub enum Formula {
    /// From dimensions and the measures before it.
    Expression(Expression),
    /// From where two features are.
    Features(Between),
}

/// What is measured between two features.
#[derive(Clone, Copy, Debug)]
pub enum Between {
    /// Signed distance of the place of the first feature from the second, a plane; positive outside of its material.
    FromPlane(usize, usize),
    /// Distance of the first feature, a plane, to the second, a point; positive into its material, as a thickness is.
    IntoPlane(usize, usize),
    /// Distance of the place of the first feature from the second, an axis.
    FromAxis(usize, usize),
    /// Distance of two points.
    Points(usize, usize),
    /// Angle between the directions of two features, 0 to π.
    Angle(usize, usize),
}

/// All measures of a product, in order.
#[derive(Clone, Debug, Default)]
pub struct Measures {
    /// Where the features are.
    pub assembly: Assembly,
    /// Those between features, by their numbers.
    features: Vec<(usize, Between)>,
    /// Those that are linear in the variables.
    linear: Linear,
    /// Other expressions.
    tape: Tape,
    /// One a measure: what it is, if it is linear.
    affine: Vec<Option<Affine>>,
    /// The variables (SI) as the drawing has them.
    pub nominal: Vec<f64>,
    /// What kinds of numbers they are.
    pub quantities: Vec<Quantity>,
    /// One a measure: what it costs to be off its target, if that is said.
    pub losses: Vec<Option<Loss>>,
    /// Zones that go with sizes.
    pub widenings: Vec<Widening>,
}

impl Formula {
    /// What kind of measure it is.
    pub fn quantity(&self) -> Quantity {
        match self {
            Self::Expression(expression) => expression.quantity(),
            Self::Features(Between::Angle(..)) => Quantity::Angle,
            Self::Features(_) => Quantity::Length,
        }
    }
}

impl Between {
    /// The distance of feature `from` to feature `to`, by what they are.
    pub fn distance(assembly: &Assembly, from: usize, to: usize) -> Self {
        match (assembly.features[from].shape, assembly.features[to].shape) {
            (_, Shape::Plane) => Self::FromPlane(from, to),
            (Shape::Plane, _) => Self::IntoPlane(from, to),
            (_, Shape::Axis) => Self::FromAxis(from, to),
            (Shape::Axis, Shape::Point) => Self::FromAxis(to, from),
            (Shape::Point, Shape::Point) => Self::Points(from, to),
        }
    }

    #[inline(always)]
    fn evaluate(&self, located: &[Located]) -> Lanes {
        match self {
            Self::FromPlane(point, plane) => height(&located[*point], &located[*plane]),
            Self::IntoPlane(plane, point) => -height(&located[*point], &located[*plane]),
            Self::FromAxis(point, axis) => {
                let axis = &located[*axis];
                (located[*point].place - axis.place).cross(axis.direction).norm() / axis.direction.norm()
            }
            Self::Points(one, two) => (located[*one].place - located[*two].place).norm(),
            Self::Angle(one, two) => {
                let (one, two) = (located[*one].direction, located[*two].direction);
                let (sine, cosine) = (one.cross(two).norm(), one.dot(two));
                sine.zip(cosine, libm::atan2)
            }
        }
    }
}

impl Measures {
    /// None yet, of parts with these features.
    pub fn new(assembly: Assembly) -> Self {
        Self { assembly, ..Self::default() }
    }

    /// Adds the next measure.
    pub fn push(&mut self, formula: Formula) {
        let measure = self.affine.len();
        let affine = match &formula {
            Formula::Expression(expression) => {
                let affine = Affine::of(expression, &self.affine);
                match &affine {
                    Some(Affine { constant, terms }) => self.linear.push(measure, *constant, terms),
                    None => self.tape.push(measure, expression),
                }
                affine
            }
            Formula::Features(between) => {
                self.features.push((measure, *between));
                None
            }
        };
        self.affine.push(affine);
    }

    /// How many measures there are.
    pub fn count(&self) -> usize {
        self.affine.len()
    }
}

/// Signed distance of a point from a plane, positive outside of its material.
#[inline(always)]
fn height(point: &Located, plane: &Located) -> Lanes {
    (point.place - plane.place).dot(plane.direction) / plane.direction.norm()
}

thread_local! {
    /// Room for features, so that units are not waiting for memory.
    static LOCATED: Cell<Vec<Located>> = const { Cell::new(Vec::new()) };
}

impl Function for Measures {
    fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
        self.linear.evaluate(variables, measures);
        widest(
            #[inline(always)]
            || {
                if !self.features.is_empty() {
                    let mut located = LOCATED.take();
                    self.assembly.locate(variables, &mut located);
                    for (measure, between) in &self.features {
                        measures[*measure] = between.evaluate(&located);
                    }
                    LOCATED.set(located);
                }
                self.tape.evaluate(variables, measures);
                for measure in measures.iter_mut() {
                    *measure = measure.map(|value| if value.is_finite() { value } else { f64::NAN });
                }
            },
        );
    }

    fn is_linear(&self, measure: usize) -> bool {
        self.affine[measure].is_some()
    }

    fn kinks(&self, variables: &[Lanes]) -> Vec<Lanes> {
        let mut measures = vec![Lanes::ZERO; self.count()];
        self.evaluate(variables, &mut measures);
        self.tape.kinks(variables, &measures)
    }

    fn nominal(&self) -> Option<&[f64]> {
        Some(&self.nominal)
    }

    fn quantity(&self, variable: usize) -> Quantity {
        self.quantities[variable]
    }

    fn loss(&self, measure: usize) -> Option<Loss> {
        self.losses[measure]
    }

    fn widenings(&self) -> &[Widening] {
        &self.widenings
    }
}
