//! The measures of assembled units as a function of their variables.

use crate::tolerance::{
    lanes::Lanes,
    loss::Loss,
    model::{Function, Quantity},
    widening::Widening,
};

use super::{
    assembly::Assembly,
    expression::Expression,
    feature::{Located, Shape},
};

/// How one measure is computed.
#[derive(Clone, Debug)]
pub enum Formula {
    /// From dimensions and the measures before it.
    Expression(Expression),
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
    /// One a measure.
    pub formulas: Vec<Formula>,
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

    /// What kind of measure it is.
    pub fn quantity(&self) -> Quantity {
        match self {
            Self::Expression(expression) => expression.quantity(),
            Self::FromPlane(..) | Self::IntoPlane(..) | Self::FromAxis(..) | Self::Points(..) => Quantity::Length,
            Self::Angle(..) => Quantity::Angle,
        }
    }

    #[inline(always)]
    fn evaluate(&self, located: &[Located], variables: &[Lanes], before: &[Lanes]) -> Lanes {
        match self {
            Self::Expression(expression) => expression.evaluate(variables, before),
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
                Lanes(std::array::from_fn(|lane| libm::atan2(sine.0[lane], cosine.0[lane])))
            }
        }
    }
}

/// Signed distance of a point from a plane, positive outside of its material.
#[inline(always)]
fn height(point: &Located, plane: &Located) -> Lanes {
    (point.place - plane.place).dot(plane.direction) / plane.direction.norm()
}

impl Function for Measures {
    fn evaluate(&self, variables: &[Lanes], measures: &mut [Lanes]) {
        let located = self.assembly.locate(variables);
        for (i, formula) in self.formulas.iter().enumerate() {
            let (before, after) = measures.split_at_mut(i);
            after[0] = formula.evaluate(&located, variables, before);
        }
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
