//! Families of distributions that measured values may follow, fitted by maximum likelihood.

mod family;
mod fit;
mod free;
mod johnson_sb;
mod johnson_su;
mod kind;
mod lognormal;
mod mixture;
mod normal;
mod parameters;
mod posterior;
mod sample;
mod shifted;
#[cfg(test)]
pub(crate) mod tests;
mod weibull;

pub use self::{
    family::Family,
    fit::{Fit, LEAST_TO_CHOOSE, choose, preferred, supported},
    johnson_sb::JohnsonSb,
    johnson_su::JohnsonSu,
    kind::{FitError, Kind},
    lognormal::Lognormal,
    mixture::TwoNormals,
    normal::Normal,
    posterior::Posterior,
    weibull::Weibull,
};
