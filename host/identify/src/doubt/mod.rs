//! How far an estimate can be trusted: what is determined, deviations with coloured noise, intervals, lack of fit.

pub mod bootstrap;
pub mod covariance;
pub mod determined;
pub mod lack;
pub mod profile;
