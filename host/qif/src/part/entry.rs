//! What a tolerance is in a part.

use crate::drawing::{Control, Material};

/// What of a feature a tolerance limits. A feature has at most one location and one orientation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// The diameter.
    Size,
    /// Form of a face, an axis or the surface around it.
    Form,
    /// Tilts.
    Orientation,
    /// Place and tilts.
    Location,
}

/// A datum of a tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct DatumRef {
    /// Its feature, or the two that are one datum together.
    pub features: Vec<usize>,
    /// Condition of material at which it is referenced.
    pub material: Material,
}

/// Limits of a diameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Diameter {
    /// Nominal diameter (mm).
    pub nominal: f64,
    /// Lower and upper deviation (mm).
    pub deviations: [f64; 2],
    /// Class of ISO 286 that has these deviations, where the file states it.
    pub class: Option<String>,
}

/// A tolerance of one feature, as a part states it.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Index of the tolerance.
    pub tolerance: usize,
    /// Its key.
    pub key: &'static str,
    /// What it limits.
    pub class: Class,
    /// Width of the zone (mm); 0 of a size.
    pub width: f64,
    /// Condition of material of the zone.
    pub material: Material,
    /// Its datums, the primary first.
    pub datums: Vec<DatumRef>,
    /// Of a composite position: width (mm) and number of datums of the lower segment.
    pub within: Option<(f64, usize)>,
    /// Of a size: its limits.
    pub diameter: Option<Diameter>,
}

impl Entry {
    /// Width (mm) of the zone at a `diameter` (mm) of a hole or a pin with these `limits` (mm).
    pub fn width_at(&self, diameter: f64, limits: [f64; 2], is_hole: bool) -> f64 {
        let [least, greatest] = limits;
        let bonus = match (self.material, is_hole) {
            (Material::None, _) => 0.0,
            (Material::Maximum, true) | (Material::Least, false) => diameter - least,
            (Material::Maximum, false) | (Material::Least, true) => greatest - diameter,
        };
        self.width + bonus
    }
}

/// Key of a tolerance in a part, and what it limits of a face or of another feature.
pub fn key(control: Control, is_face: bool) -> (&'static str, Class) {
    match control {
        Control::Flatness => ("flatness", Class::Form),
        Control::Straightness => ("straightness", Class::Form),
        Control::Roundness => ("roundness", Class::Form),
        Control::Cylindricity => ("cylindricity", Class::Form),
        Control::Parallelism => ("parallelism", Class::Orientation),
        Control::Perpendicularity => ("perpendicularity", Class::Orientation),
        Control::Angularity => ("angularity", Class::Orientation),
        Control::Position => ("position", Class::Location),
        Control::Profile => ("profile", Class::Location),
        Control::Coaxiality => ("coaxiality", Class::Location),
        Control::Concentricity => ("concentricity", Class::Location),
        Control::Symmetry => ("symmetry", Class::Location),
        Control::RunOut if is_face => ("run_out", Class::Orientation),
        Control::TotalRunOut if is_face => ("total_run_out", Class::Orientation),
        Control::RunOut => ("run_out", Class::Location),
        Control::TotalRunOut => ("total_run_out", Class::Location),
    }
}
