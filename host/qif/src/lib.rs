//! QIF 3.0 files (Quality Information Framework, ISO 23952:2020; XML).
//!
//! [`model::read`] reads the features, datums and tolerances of a product model into [`drawing::Drawing`], which knows
//! nothing of QIF. [`part::write`] turns a drawing into the text of a `[[part]]`. [`results::read`] reads measurement results
//! into a [`slipfit_measured::table::MeasuredTable`].
//!
//! Input is untrusted: nesting, attributes and nodes are limited before the tree is built, a document type (and with it entities)
//! is refused, and every error names its line and column.
#![forbid(unsafe_code)]

pub mod drawing;
pub mod error;
pub mod file;
mod format;
pub mod model;
pub mod part;
pub mod results;
mod units;
mod words;
mod xml;
