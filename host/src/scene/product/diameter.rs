//! Diameters of axes, and their sizes at conditions of material.

use crate::scene::{Problem, SceneError, value::Field};

/// The diameter of an axis.
#[derive(Clone, Copy)]
pub(super) struct Diameter {
    /// Its variable.
    pub variable: usize,
    /// Least and greatest (m).
    pub limits: [f64; 2],
    /// Whether it is a hole's, if that is said.
    pub hole: Option<bool>,
    /// Widths (m) of the axis's own tolerance at maximum and at least material condition.
    pub own: [f64; 2],
}

impl Diameter {
    /// The middle of its limits (m).
    pub fn middle(&self) -> f64 {
        0.5 * (self.limits[0] + self.limits[1])
    }
}

/// A condition of material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Material {
    /// The largest pin, the smallest hole: Ⓜ.
    Maximum,
    /// The smallest pin, the largest hole: Ⓛ.
    Least,
}

impl Material {
    /// In a sentence.
    pub fn named(self) -> &'static str {
        match self {
            Self::Maximum => "maximum material condition",
            Self::Least => "least material condition",
        }
    }

    /// The size (m) of the feature called `name` at the condition.
    pub fn limit(self, diameter: &Diameter, name: &str, field: &Field) -> Result<f64, SceneError> {
        let hole = diameter.hole.ok_or_else(|| {
            field.error(
                Problem::Missing(format!("{name}.kind")),
                "kind = \"hole\" or \"pin\", or an ISO 286 class of the diameter",
            )
        })?;
        Ok(diameter.limits[usize::from(hole == (self == Self::Least))])
    }
}
