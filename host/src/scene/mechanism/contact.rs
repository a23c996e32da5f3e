//! Gaps of joints, and the laws of their contacts.

use slipfit_core::{clearance::GapStatistics, menu::ContactData};
use slipfit_tolerance::{product::Product, unit::Quantity};

use crate::{
    mechanism::{Gap, Laws, NormalData, SlidingData},
    scene::{SceneError, contact, friction, measured::columns::Columns, pins, tree::Value, value::Field},
};

/// The gaps met so far.
pub(super) struct Gaps<'p, 't, 's> {
    pub gaps: Vec<Gap>,
    pub product: Option<&'p Product>,
    pub measured: Option<&'p Columns<'t, 's>>,
}

impl Gaps<'_, '_, '_> {
    /// The index of a new gap with the statistics that `field` gives, by itself or as a measure of the product; its mean is a `quantity`.
    pub fn add(&mut self, name: String, field: &Field, quantity: &Quantity) -> Result<usize, SceneError> {
        let (statistics, measure) = match field.node.value {
            Value::Text(_) => self.of_product(field)?,
            _ => (pins::statistics(field, quantity)?, None),
        };
        let measured = self.measured.and_then(|columns| columns.gap(&name, self.gaps.len()));
        let (statistics, measure) = measured.map_or((statistics, measure), |measured| (measured, None));
        self.gaps.push(Gap { name, statistics, measure });
        Ok(self.gaps.len() - 1)
    }

    fn of_product(&self, field: &Field) -> Result<(GapStatistics<f64>, Option<usize>), SceneError> {
        let model = self.product.map(|product| &product.model);
        let index = pins::length(field, model)?;
        let moments = model.map(slipfit_tolerance::theory::moments::of_measures).unwrap_or_default();
        let of = moments.get(index).map(|of| GapStatistics { mean: of.mean, deviation: of.deviation });
        of.map(|of| (of, Some(index))).ok_or_else(|| field.wrong_type("a measure of the product"))
    }
}

/// The normal law of a joint without contacts.
pub(super) const NO_CONTACT: NormalData =
    NormalData::Impact(ContactData { stiffness: 0.0, exponent: 1.0, damping: 0.0, depth: 1.0 });

/// Reads the laws of `table`, where it states none of its own `otherwise`; the friction law alone may be missing. A mistake in one law is
/// noted, and another law stands for it.
pub(super) fn laws(table: &Field, otherwise: Option<Laws>) -> Result<Option<Laws>, SceneError> {
    let found = table.found();
    let contact = match table.get("contact") {
        None => otherwise.map(|laws| laws.contact),
        Some(_) => Some(found.recover(table.table("contact").and_then(|table| contact::normal(&table)), NO_CONTACT)),
    };
    let friction = match table.get("friction") {
        None => otherwise.map_or(SlidingData::NONE, |laws| laws.friction),
        Some(_) => {
            found.recover(table.table("friction").and_then(|table| friction::sliding(&table)), SlidingData::NONE)
        }
    };
    Ok(contact.map(|contact| Laws { contact, friction }))
}
