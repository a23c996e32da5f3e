//! How many units malfunction with given tolerances.

use indicatif::ProgressBar;
use slipfit_tolerance::{
    allocate::{
        AllocateError,
        confirm::Counted,
        requirement::{Kind, Requirement},
    },
    product::Product,
};

use super::tolerances::Tolerances;
use crate::{
    cli::{simulate::why_undecided, terminal::counter},
    dynamics::{driven::Driven, outcome::Verdict, simulate::SimulateError},
    population::{
        production::Production,
        study::{Judgement, judge},
        tally::Duty,
        uncertain::{answer::Answer, design::Design, study::of_slide},
    },
    setup::Scene,
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
        let (slide, product) = self.slide(tolerances)?;
        let production = production(&slide, product.as_ref(), seed)?;
        let found = judge(&slide, &production, units, force, |units| self.bar.inc(units));
        let Judgement { failed, undecided, .. } = found.map_err(stopped)?;
        if undecided as f64 > allowed * units as f64 {
            let why = why_undecided(&slide, Verdict::Undecided);
            return Err(AllocateError::Unjudged { undecided, units, allowed, why });
        }
        Ok(Counted { failed: failed + undecided, units })
    }

    /// What the units do with these `tolerances` (SI) over all unknowns, beside `units` that were counted; none where everything
    /// is known.
    ///
    /// # Errors
    /// [`AllocateError`], if the scene is not sound or a unit cannot be simulated.
    pub fn unknown(&self, tolerances: &[f64], units: u64, seed: u64) -> Result<Option<Answer>, AllocateError> {
        let (slide, product) = self.slide(tolerances)?;
        let Some(design) = Design::beside(units, seed).filter(|_| slide.has_unknowns()) else {
            return Ok(None);
        };
        let production = production(&slide, product.as_ref(), seed)?;
        let duty = Duty { limit: self.limits.force, stroke: slide.run.stroke };
        of_slide(&slide, &production, design, duty, |units| self.bar.inc(units)).map(Some).map_err(stopped)
    }

    /// The slide with these `tolerances` (SI), which runs its whole stroke, and its product.
    fn slide(&self, tolerances: &[f64]) -> Result<(Scene, Option<Product>), AllocateError> {
        let file = self.scene.file(tolerances)?;
        let mut slide = file.slide.ok_or_else(|| AllocateError::Model("it has no [slide]".into()))?;
        slide.run.duration = slide.stroke_duration().unwrap_or(slide.run.duration);
        Ok((slide, file.product))
    }

    /// Takes the progress away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

fn production<'p>(slide: &Scene, product: Option<&'p Product>, seed: u64) -> Result<Production<'p>, AllocateError> {
    Production::new(slide, product, 0.0, seed).map_err(|error| AllocateError::Function(error.into()))
}

fn stopped(error: SimulateError) -> AllocateError {
    match error {
        SimulateError::Interrupted => AllocateError::Interrupted,
        error => AllocateError::Function(error.into()),
    }
}
