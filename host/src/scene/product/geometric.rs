//! A geometric tolerance of a feature, and what it limits.

use slipfit_tolerance::{
    model::ZoneRule,
    product::{dimension::Toleranced, feature::Bonus},
    unit::{self as units, Quantity},
};

use super::{
    diameter::Material,
    draft::{Datum, Draft, FeatureDraft},
};
use crate::scene::value::Field;

pub(super) const WIDTH: Quantity = Quantity { units: units::LENGTH, range: [0.0, 1e7] };

/// What a geometric tolerance limits.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Limits {
    /// Form: offset and tilts, without a datum.
    Form,
    /// Form along the first extent only.
    Line,
    /// Form of the surface around an axis: what mates with it finds the axis off, and tilted.
    Surface,
    /// Tilts towards a datum.
    Orientation,
    /// Offset and tilts towards datums.
    Location,
}

/// A geometric tolerance as it is read.
pub(super) struct Callout<'t, 's> {
    pub name: &'static str,
    pub limits: Limits,
    /// Width of its zone (m), in the middle of the limits of the size that it goes with.
    pub width: f64,
    /// Its condition of material.
    pub material: Option<Material>,
    /// How it goes with the size there.
    pub bonus: Option<Bonus>,
    /// Its datums; none of a form.
    pub datums: Vec<Datum>,
    pub rule: ZoneRule,
    /// Number of the pattern that it moves with.
    pub pattern: Option<usize>,
    pub field: Field<'t, 's>,
}

impl Callout<'_, '_> {
    /// Its condition of material, and its width (m) there.
    pub fn at_condition(&self) -> Option<(Material, f64)> {
        Some((self.material?, self.bonus?.width))
    }

    /// Whether it holds the surface, its form included, not the axis alone.
    pub fn runs_out(&self) -> bool {
        matches!(self.name, "run_out" | "total_run_out")
    }

    /// Whether all of an axis lies in its zone, which then limits its tilts, too. A concentricity and a roundness are of one
    /// section.
    pub fn holds_tilts(&self) -> bool {
        self.rule != ZoneRule::Translation && !matches!(self.name, "concentricity" | "roundness")
    }
}

/// Lets the feature shift by a toleranced number along a direction.
pub(super) fn shift(made: &mut FeatureDraft, what: &str, size: &Toleranced, along: [f64; 3], draft: &mut Draft) {
    let variable = draft.add(size.contributor(format!("{} {what}", made.name)), &[size.nominal]);
    made.feature.shift(variable, along, 1.0);
}
