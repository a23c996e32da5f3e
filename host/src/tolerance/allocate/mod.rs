//! Tolerance synthesis: the cheapest tolerances with which a product meets its requirements.
//!
//! Every tolerance has processes with costs ([`cost`]). Requirements are figures of the tolerances ([`requirement`]), whatever they
//! come from ([`search::Figures`]). Around some tolerances they are rows of a separable program ([`program`]), which is solved by
//! branch and bound ([`branch`]) over Lagrangian bounds; its solution is where the figures are looked at next ([`search`]).

pub mod branch;
pub mod check;
pub mod cost;
pub mod curve;
mod dual;
mod figure;
mod nearest;
pub mod program;
pub mod requirement;
pub mod search;
#[cfg(test)]
mod search_tests;
pub mod slopes;
#[cfg(test)]
mod tests;

use super::counting::study::StudyError;

/// Why there are no cheapest tolerances.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AllocateError {
    /// The tightest tolerances of all do not meet the requirements.
    #[error("the tightest tolerances do not meet the requirements")]
    Infeasible {
        /// These tolerances (SI).
        tightest: Vec<f64>,
        /// The figures at them; those above 1 are not met.
        figures: Vec<f64>,
    },
    /// RSS is required of a measure that slopes do not describe.
    #[error(
        "slopes do not describe the measure `{0}`, so that RSS says nothing of it: require ppm, ppk or the worst case"
    )]
    NotLinear(String),
    /// No product with these tolerances.
    #[error("at other tolerances the scene is not sound: {0}")]
    Model(Box<dyn std::error::Error + Send + Sync>),
    /// The model cannot be drawn.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// What units do is not known.
    #[error("the units cannot be simulated: {0}")]
    Function(Box<dyn std::error::Error + Send + Sync>),
    /// The steps came to no end.
    #[error("no tolerances were found that meet all requirements, though the tightest ones do")]
    NotFound,
    /// Somebody asked to stop.
    #[error("interrupted")]
    Interrupted,
}
