//! Something with one unknown value in the whole production.

use crate::setup::{Adjustable, Uncertain};

/// One thing that is unknown of a model `M`: of a slide, of a mechanism, or of whatever units are simulated of.
pub trait Unknown<M>: Sync {
    /// Its name, such as friction.coefficient.
    fn name(&self) -> &str;

    /// How many coordinates a value of it has in the unit cube, in which all points are equally probable.
    fn coordinates(&self) -> usize {
        1
    }

    /// Weights of independent normal scores of the unknowns up to this one, each of one coordinate, in its own score; empty where it is
    /// independent of the others.
    fn weights(&self) -> &[f64] {
        &[]
    }

    /// Gives `model` the value at a `point` of the unit cube.
    fn apply(&self, point: &[f64], model: &mut M);

    /// The number that stands for this value in reports.
    fn shown(&self, point: &[f64]) -> f64;

    /// The unit of that number; empty for none.
    fn unit(&self) -> &str;
}

impl<P: Adjustable> Unknown<P::Of> for Uncertain<P> {
    fn name(&self) -> &str {
        &self.name
    }

    fn apply(&self, point: &[f64], model: &mut P::Of) {
        self.parameter.set(model, self.belief.value(point[0]));
    }

    fn shown(&self, point: &[f64]) -> f64 {
        self.belief.value(point[0]) / self.shown_in.size
    }

    fn unit(&self) -> &str {
        &self.shown_in.unit
    }

    fn weights(&self) -> &[f64] {
        &self.weights
    }
}
