//! Products: parts, features, tolerances and mates, and the measures that follow from them.
//!
//! A scene file states them (see `scenes/three-part-stack.toml` for the simplest); they become a
//! [`Model`] of independent or correlated variables. SI units inside.

pub mod assembly;
pub mod common;
pub mod contact;
pub mod contacts;
pub mod correlation;
pub mod costed;
pub mod dimension;
pub mod expression;
pub mod feature;
pub mod float;
pub mod function;
pub mod iso2768;
pub mod iso286;
pub mod pose;
pub mod vector;

use crate::{allocate::requirement::Requirement, model::Model, numeric::lanes::Lanes};

use costed::Costed;

/// What a scene file says of a product.
pub struct Product {
    /// Contributors, measures, and the function from one to the other.
    pub model: Model,
    /// The variables at the drawing's nominal values (SI), which need not be the middles of the tolerances.
    pub nominal: Vec<f64>,
    /// Tolerances that have a cost, and so may be chosen.
    pub costed: Vec<Costed>,
    /// What is required of the measures.
    pub requirements: Vec<Requirement>,
    /// What the user should know before trusting a result.
    pub warnings: Vec<String>,
}

impl Product {
    /// The measures (SI) at the drawing's nominal values.
    pub fn nominal_measures(&self) -> Vec<f64> {
        let variables: Vec<_> = self.nominal.iter().map(|value| Lanes::splat(*value)).collect();
        let mut measures = vec![Lanes::ZERO; self.model.measures.len()];
        self.model.function.evaluate(&variables, &mut measures);
        measures.iter().map(|measure| measure.0[0]).collect()
    }
}
