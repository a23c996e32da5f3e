//! Models whose units cannot be drawn: impossible correlations, or nothing to draw.

/// Why no unit of a model can be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DrawError {
    /// No joint distribution has these correlations.
    #[error("the correlations are not positive definite: `{0}` depends on those before it")]
    NotPositiveDefinite(String),
    /// A correlation with a contributor that is not one variable.
    #[error("`{0}` cannot be correlated: it is not a scalar")]
    NotScalar(String),
    /// Nothing varies or nothing is measured.
    #[error("the model has no {0}")]
    Empty(&'static str),
}
