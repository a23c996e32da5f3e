//! Tolerance synthesis: the cheapest tolerances with which a product meets its requirements.
//!
//! Every tolerance has processes with costs ([`cost`]). Requirements are figures of the tolerances ([`requirement`]), whatever they
//! come from ([`figures::Figures`]). Around some tolerances they are rows of a separable program ([`program`]), which is solved by
//! branch and bound ([`branch`]) over Lagrangian bounds; its solution is where the figures are looked at next ([`search`]). Figures with
//! kinks are followed by trading tolerances against each other (`exchange`).

pub mod branch;
pub mod check;
pub mod confirm;
pub mod cost;
pub mod curve;
mod dual;
mod exchange;
pub mod figures;
mod full_model;
mod nearest;
pub mod program;
pub mod requirement;
pub mod search;
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
    /// Units without a verdict: more of them than may malfunction.
    #[error("{undecided} of {units} units come to no verdict{why}, so that nobody knows whether they malfunction; {:.4} % may", 100.0 * .allowed)]
    Unjudged {
        /// Those without.
        undecided: u64,
        /// All.
        units: u64,
        /// The share that may malfunction.
        allowed: f64,
        /// Why, in brackets; empty if that is not known.
        why: String,
    },
    /// Other units malfunction more often than those of the search.
    #[error(
        "no tolerances were found of which other units confirm that {:.4} % malfunction at most: of the last ones {} of {} units \
         malfunction, {:.4} % at most with 95 % confidence; simulate more with --units",
        100.0 * .allowed, .counted.failed, .counted.units, 100.0 * .at_most
    )]
    NotConfirmed {
        /// The share that may malfunction.
        allowed: f64,
        /// The units that were counted last.
        counted: Counted,
        /// What their share is at most.
        at_most: f64,
    },
    /// Somebody asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// Fresh units that were counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counted {
    /// Those that malfunction.
    pub failed: u64,
    /// All.
    pub units: u64,
}
