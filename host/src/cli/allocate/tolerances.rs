//! A scene file with tolerances to choose.

use slipfit_tolerance::{allocate::AllocateError, model::Model, product::costed::Costed};

use crate::scene::{Override, SceneFile, with_tolerances};

/// Digits of a tolerance that is written, and of one that is looked at.
pub const DIGITS: usize = 6;
const ALL_DIGITS: usize = 17;

/// A scene file with tolerances to choose.
pub struct Tolerances<'a> {
    pub name: &'a str,
    pub text: &'a str,
    pub overrides: &'a [Override],
    pub costed: &'a [Costed],
}

impl Tolerances<'_> {
    /// The scene with these tolerances (SI).
    pub fn file(&self, tolerances: &[f64]) -> Result<SceneFile, AllocateError> {
        let text = with_tolerances(self.text, self.costed, tolerances, ALL_DIGITS);
        SceneFile::parse(self.name, &text, self.overrides).map_err(|error| AllocateError::Model(error.into()))
    }

    /// The model of the scene with these tolerances (SI).
    pub fn model(&self, tolerances: &[f64]) -> Result<Model, AllocateError> {
        let product = self.file(tolerances)?.product;
        Ok(product.ok_or_else(|| AllocateError::Model("it has no product".into()))?.model)
    }
}
