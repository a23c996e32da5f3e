//! Measured characteristics while a scene is read: what each of them is there is found as its parts are read.

use std::cell::RefCell;

use slipfit_core::clearance::GapStatistics;
use slipfit_measured::production::Production;
use slipfit_tolerance::{
    distribution::quadrature::mean_and_deviation,
    model::{Contributor, Variation},
    product::costed::Costed,
};

use super::doubt::warn_of_shift;
use crate::{
    scene::{Problem, SceneError, value::Field},
    setup::{Measured, Place},
};

/// Measured characteristics and what they are in the scene, as far as it has been read.
pub struct Columns<'t, 's> {
    production: Production,
    columns: Vec<Column<'t, 's>>,
    places: RefCell<Vec<Option<Place>>>,
}

/// A measured characteristic.
pub struct Column<'t, 's> {
    /// Its name in the scene.
    pub of: &'t str,
    /// Where that is written.
    pub field: Field<'t, 's>,
}

impl<'t, 's> Columns<'t, 's> {
    /// Of a `production` of these `columns`.
    pub fn new(production: Production, columns: Vec<Column<'t, 's>>) -> Self {
        let places = RefCell::new(vec![None; columns.len()]);
        Self { production, columns, places }
    }

    /// Gives measured contributors their distributions, and correlates them.
    ///
    /// # Errors
    /// A contributor of several variables.
    pub fn apply(&self, contributors: &mut [Contributor]) -> Result<Vec<(usize, usize, f64)>, SceneError> {
        let joint = self.production.joint();
        for (i, column) in self.columns.iter().enumerate() {
            let Some(number) = contributors.iter().position(|contributor| contributor.name == column.of) else {
                continue;
            };
            let Variation::Scalar { distribution, limits } = &mut contributors[number].variation else {
                let what = format!("the measured zone `{}`", column.of);
                let allowed = "a dimension, an offset, a diameter or a gap, which have one measured value a part";
                return Err(column.field.error(Problem::Unsupported { what }, allowed));
            };
            warn_of_shift(&column.field, column.of, self.production.values(i), *limits);
            distribution.clone_from(&joint.distributions[i]);
            self.places.borrow_mut()[i] = Some(Place::Contributor(number));
        }
        let places = self.places.borrow();
        let number = |i: usize| match places[i] {
            Some(Place::Contributor(number)) => Some(number),
            _ => None,
        };
        let pair = |(row, column, r): &(usize, usize, f64)| Some((number(*row)?, number(*column)?, *r));
        Ok(joint.correlations.iter().filter_map(pair).collect())
    }

    /// Refuses a cost of a measured tolerance, as another tolerance would not change what was measured.
    ///
    /// # Errors
    /// The first that is measured and has a cost.
    pub fn refuse_costs(&self, costed: &[Costed]) -> Result<(), SceneError> {
        let has_cost = |column: &&Column| costed.iter().any(|costed| costed.name == column.of);
        let Some(column) = self.columns.iter().find(has_cost) else { return Ok(()) };
        let why = "its tolerance has a cost, and choosing another tolerance does not change measured parts".into();
        let problem = Problem::Measured { of: column.of.into(), why };
        Err(column.field.error(problem, "either the cost or the measured column"))
    }

    /// Mean and standard deviation (m) of the gap of this `name`, the mechanism's `number`, if it is measured.
    pub fn gap(&self, name: &str, number: usize) -> Option<GapStatistics<f64>> {
        let i = self.columns.iter().position(|column| column.of == name)?;
        self.places.borrow_mut()[i] = Some(Place::Gap(number));
        let distribution = self.production.joint().distributions[i].clone();
        let variation = Variation::Scalar { distribution, limits: [0.0; 2] };
        let [mean, deviation] = *mean_and_deviation(&variation).first()?;
        Some(GapStatistics { mean, deviation })
    }

    /// All of them, when the scene has been read; `known` are the names that a measured characteristic can have.
    ///
    /// # Errors
    /// One that is nothing in the scene.
    pub fn found(self, known: &[String]) -> Result<Measured, SceneError> {
        let missing = self.places.borrow().iter().position(Option::is_none);
        if let Some(column) = missing.map(|i| &self.columns[i]) {
            let of = "dimension or gap that could be measured".into();
            let problem = Problem::UnknownName { of, name: column.of.into() };
            return Err(column.field.error(problem, known.join(", ")));
        }
        let measured = Measured {
            production: self.production,
            places: self.places.into_inner().into_iter().flatten().collect(),
            names: self.columns.iter().map(|column| column.of.to_owned()).collect(),
        };
        if let Some(column) = self.columns.first().filter(|_| measured.is_divided()) {
            column.field.warn(
                "some of the measured characteristics are gaps, others are dimensions of the product: these are drawn \
                 independently of each other",
            );
        }
        Ok(measured)
    }
}
