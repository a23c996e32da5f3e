//! Tolerances that may be chosen, and how they stand in a scene.

use std::ops::Range;

use crate::{allocate::cost::Process, model::Quantity};

/// A tolerance that may be chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Costed {
    /// Name, such as "hub" or "box.rim flatness".
    pub name: String,
    /// What the scene has now (SI): half the distance of the limits, or the width of a zone.
    pub stated: f64,
    /// How it can be made.
    pub processes: Vec<Process>,
    /// What kind of number it is.
    pub quantity: Quantity,
    /// How it is written.
    pub written: Written,
    /// Where it stands in the file (bytes), unless it was set on the command line.
    pub place: Option<Range<usize>>,
}

/// How a tolerance stands in a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// Its key: `tolerance` or `zone`.
    pub key: &'static str,
    /// Symbol of its unit; none for mm or °.
    pub unit: Option<&'static str>,
    /// Units in one SI unit.
    pub per_si: f64,
    /// The middle of the limits from the nominal value (SI); 0 for a single number.
    pub middle: f64,
}
