//! An analysis as people and machines read it: lengths in mm, angles in degrees.

mod contents;
mod fill;

pub use self::{
    contents::{Defects, Estimates, LossReport, MeasureReport, Quadrature, Report, Rss, SecondOrder, Share, SumReport},
    fill::report,
};
