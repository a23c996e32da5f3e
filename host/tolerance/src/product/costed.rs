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
    /// How it is written on a drawing.
    pub callout: Callout,
    /// Where it stands in the file (bytes), unless it was set on the command line.
    pub place: Option<Range<usize>>,
}

/// How a tolerance is written on a drawing, and at which feature.
#[derive(Clone, Debug, PartialEq)]
pub struct Callout {
    /// The part; none of a dimension that is of no part.
    pub part: Option<String>,
    /// The feature, or the dimension.
    pub feature: String,
    /// What is limited, such as "position"; none of a dimension.
    pub key: Option<String>,
    /// Nominal size (SI), of a size.
    pub nominal: Option<f64>,
    /// What follows the width of a zone: its condition of material, its datums, the width within a pattern.
    pub frame: String,
}

impl Callout {
    /// The name of the tolerance, such as "hub" or "box.rim flatness".
    pub fn name(&self) -> String {
        let part = self.part.as_ref().map(|part| format!("{part}.")).unwrap_or_default();
        let key = self.key.as_ref().map(|key| if key == "diameter" { ".diameter".into() } else { format!(" {key}") });
        format!("{part}{}{}", self.feature, key.unwrap_or_default())
    }
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
