//! An analysis as people and machines read it: lengths in mm, angles in degrees.

mod contents;
mod fill;
mod possible;

pub use self::{
    contents::{Defects, Estimates, LossReport, MeasureReport, Quadrature, Report, Rss, SecondOrder, Share, SumReport},
    fill::report,
    possible::widen,
};
