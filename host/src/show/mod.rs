//! What people look at: charts, pictures, pages, and results as CSV.

pub(crate) mod bars;
pub mod capability;
pub mod causes;
pub(crate) mod chart;
pub mod columns;
pub mod drawing;
pub mod export;
pub mod figure;
pub mod force_table;
pub(crate) mod layout;
pub mod measures_csv;
pub(crate) mod palette;
pub mod player;
pub mod plot;
pub mod precision;
pub mod report;
pub mod stability;
pub(crate) mod svg;
pub mod tolerances;
pub mod uncertain;
pub mod units;
