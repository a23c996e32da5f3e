//! What people look at: charts, pictures, pages, and results as CSV.

pub(crate) mod bars;
pub(crate) mod chart;
pub mod export;
pub mod figure;
pub(crate) mod layout;
pub mod measures_csv;
pub(crate) mod palette;
pub mod player;
pub mod plot;
pub mod report;
pub(crate) mod svg;
pub mod tolerances;
pub(crate) mod xml;
