//! A product in the making, and what it is put together from: features, datums, holes on pins.

use slipfit_tolerance::{
    model::{Contributor, Quantity as Measured, widening::Widening},
    product::{
        assembly::Assembly,
        expression::{Kind, Source},
        feature::Feature,
        pose::Pose,
    },
};

use super::{
    defaults::Defaults,
    diameter::{Diameter, Material},
};
use crate::scene::{Problem, SceneError, value::Field};

/// Directions in which a feature extends, and how far (m), if it says so.
pub(super) type Face = ([[f64; 3]; 2], Option<[f64; 2]>);

/// A product in the making.
pub(super) struct Draft {
    pub defaults: Defaults,
    pub contributors: Vec<Contributor>,
    /// Variables at their nominal values.
    pub nominal: Vec<f64>,
    /// What kinds of numbers they are, those of zones left at lengths.
    pub quantities: Vec<Measured>,
    /// What expressions can use.
    pub names: Vec<(String, Source, Kind)>,
    pub assembly: Assembly,
    /// Names with the parts'.
    pub feature_names: Vec<String>,
    pub parts_of_features: Vec<usize>,
    /// How they extend.
    pub faces: Vec<Face>,
    /// Their diameters.
    pub diameters: Vec<Option<Diameter>>,
    /// Those that are two others together.
    pub common: Vec<usize>,
    /// Datums that go together, and what they place.
    pub datum_systems: Vec<(Vec<Datum>, usize)>,
    /// Holes on pins.
    pub fits: Vec<Fit>,
    /// Zones that go with sizes.
    pub widenings: Vec<Widening>,
    /// Variables that expressions use.
    pub used: Vec<usize>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// A hole on a pin.
pub(super) struct Fit {
    /// As "lid.hole on box.pin".
    pub name: String,
    /// The variables in which it floats.
    pub float: std::ops::Range<usize>,
    /// The least play (m) that the diameters' limits leave.
    pub least: f64,
}

impl Draft {
    /// Adds a `contributor` with its nominal value, or values, and gives its first variable.
    pub fn add(&mut self, contributor: Contributor, nominal: &[f64]) -> usize {
        self.contributors.push(contributor);
        self.nominal.extend(nominal);
        self.quantities.resize(self.nominal.len(), Measured::Length);
        self.nominal.len() - nominal.len()
    }

    /// The feature that `field` names, as PART.FEATURE.
    pub fn feature(&self, field: &Field) -> Result<usize, SceneError> {
        self.feature_called(field.to_text()?, field)
    }

    /// The feature of this `name`, which stands in `field`.
    pub fn feature_called(&self, name: &str, field: &Field) -> Result<usize, SceneError> {
        self.feature_names.iter().position(|known| known == name).ok_or_else(|| {
            let near = self.feature_names.iter().map(|known| (strsim::osa_distance(known, name), known)).min();
            let hint = near.map(|(_, known)| format!(", such as {known}")).unwrap_or_default();
            let problem = Problem::UnknownName { of: "feature".into(), name: name.into() };
            field.error(problem, format!("PART.FEATURE of a part that stands further up{hint}"))
        })
    }

    /// Gives `name` to `source`, unless something else has it.
    pub fn name(&mut self, field: &Field, name: &str, source: Source, kind: Kind) -> Result<(), SceneError> {
        if self.names.iter().any(|(known, ..)| known == name) {
            let problem = Problem::Duplicate { key: field.key.clone(), name: name.into() };
            return Err(field.error(problem, "a name of its own for each dimension and measure"));
        }
        self.names.push((name.into(), source, kind));
        Ok(())
    }
}

/// A feature in the making.
pub(super) struct FeatureDraft<'t, 's> {
    /// Name of part and feature.
    pub name: String,
    /// Its table.
    pub table: Field<'t, 's>,
    /// The feature.
    pub feature: Feature,
    /// Its directions of extent, across its direction.
    pub sides: [[f64; 3]; 2],
    /// Its extents (m): of a plane, and of a point if it says on which face it is; the length of an axis, twice.
    pub extents: Option<[f64; 2]>,
    /// Its place in the part's own frame (m): along its direction and along its sides.
    pub coordinates: [f64; 3],
    /// Its diameter, of an axis that has one.
    pub diameter: Option<Diameter>,
    /// From its part's frame to the assembly's.
    pub pose: Pose,
    /// Index of its part.
    pub part: usize,
}

/// A datum of a feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Datum {
    /// Its feature.
    pub feature: usize,
    /// The condition of material at which it is referenced.
    pub material: Option<Material>,
}
