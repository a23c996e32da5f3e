//! How many units malfunction with given tolerances.

use indicatif::ProgressBar;
use slipfit_tolerance::allocate::{
    AllocateError,
    confirm::Counted,
    requirement::{Kind, Requirement},
};

use super::tolerances::Tolerances;
use crate::{
    cli::{simulate::why_undecided, terminal::counter},
    dynamics::{driven::Driven, outcome::Verdict, simulate::SimulateError},
    population::{
        production::Production,
        study::{Judgement, judge},
    },
};

/// What units of a scene do with other tolerances.
pub struct Function<'a> {
    scene: &'a Tolerances<'a>,
    limits: Limits,
    bar: ProgressBar,
}

/// A requirement of the function.
#[derive(Clone, Copy)]
pub struct Limits {
    /// The share of units that may malfunction.
    pub allowed: f64,
    /// The motor's greatest force (N), if it has one.
    pub force: Option<f64>,
}

impl Limits {
    /// That of `requirements`, if there is one.
    pub fn of(requirements: &[Requirement]) -> Option<Self> {
        requirements.iter().find_map(|requirement| match requirement.kind {
            Kind::Malfunction { allowed, force_limit } => Some(Self { allowed, force: force_limit }),
            _ => None,
        })
    }
}

impl<'a> Function<'a> {
    /// Of `scene` with these `limits`.
    pub fn new(scene: &'a Tolerances<'a>, limits: Limits) -> Self {
        Self { scene, limits, bar: counter("units simulated") }
    }

    /// How many of the first `units` of the production `seed` with these `tolerances` (SI) malfunction over the whole stroke: crawl, jam
    /// or need more than the motor's force. Those that come to no verdict count, too. The same seed draws the same units, wider or
    /// narrower as their tolerances are.
    ///
    /// # Errors
    /// [`AllocateError`], if the scene is not sound, a unit cannot be simulated, or more units come to no verdict than may malfunction.
    pub fn count(&self, tolerances: &[f64], units: u64, seed: u64) -> Result<Counted, AllocateError> {
        let Limits { allowed, force } = self.limits;
        let file = self.scene.file(tolerances)?;
        let mut slide = file.slide.ok_or_else(|| AllocateError::Model("it has no [slide]".into()))?;
        slide.run.duration = slide.stroke_duration().unwrap_or(slide.run.duration);
        let production = Production::new(&slide, file.product.as_ref(), 0.0, seed)
            .map_err(|error| AllocateError::Function(error.into()))?;
        let found = judge(&slide, &production, units, force, |units| self.bar.inc(units));
        let Judgement { failed, undecided, .. } = found.map_err(|error| match error {
            SimulateError::Interrupted => AllocateError::Interrupted,
            error => AllocateError::Function(error.into()),
        })?;
        if undecided as f64 > allowed * units as f64 {
            let why = why_undecided(&slide, Verdict::Undecided);
            return Err(AllocateError::Unjudged { undecided, units, allowed, why });
        }
        Ok(Counted { failed: failed + undecided, units })
    }

    /// Takes the progress away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
