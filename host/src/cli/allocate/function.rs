//! The share of units that malfunction with given tolerances.

use indicatif::ProgressBar;

use super::Tolerances;
use crate::{
    cli::counter,
    dynamics::{driven::Driven, simulate::SimulateError},
    population::{production::Production, statistics::Share, study::share_of_malfunctions},
    tolerance::allocate::{
        AllocateError,
        requirement::{Kind, Requirement},
    },
};

/// What units of a scene do with other tolerances.
pub struct Function<'a> {
    scene: &'a Tolerances<'a>,
    units: u64,
    bar: ProgressBar,
}

/// The motor's greatest force (N), if there is one, that a requirement of the function has; `None` without such a requirement.
pub fn limit(requirements: &[Requirement]) -> Option<Option<f64>> {
    requirements.iter().find_map(|requirement| match requirement.kind {
        Kind::Malfunction { force_limit, .. } => Some(force_limit),
        _ => None,
    })
}

impl<'a> Function<'a> {
    /// Of `scene`, by so many `units` of each production.
    pub fn new(scene: &'a Tolerances<'a>, units: u64) -> Self {
        Self { scene, units, bar: counter("units simulated") }
    }

    /// The share of the production `seed` with these `tolerances` (SI) that malfunctions over the whole stroke: crawls, jams or
    /// needs more than `limit` (N). The same seed draws the same units, wider or narrower as their tolerances are.
    ///
    /// # Errors
    /// [`AllocateError`], if the scene is not sound or a unit cannot be simulated.
    pub fn share(&self, tolerances: &[f64], limit: Option<f64>, seed: u64) -> Result<Share, AllocateError> {
        let file = self.scene.file(tolerances)?;
        let mut slide = file.slide.ok_or_else(|| AllocateError::Model("it has no [slide]".into()))?;
        slide.run.duration = slide.stroke_duration().unwrap_or(slide.run.duration);
        let production = Production::new(&slide, file.product.as_ref(), 0.0, seed)
            .map_err(|error| AllocateError::Function(error.into()))?;
        share_of_malfunctions(&slide, &production, self.units, limit, |units| self.bar.inc(units)).map_err(|error| {
            match error {
                SimulateError::Interrupted => AllocateError::Interrupted,
                error => AllocateError::Function(error.into()),
            }
        })
    }

    /// Takes the progress away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
