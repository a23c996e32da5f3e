//! A scene file as a whole: a product with its tolerances, a slide that moves, or both.

use slipfit_core::clearance::GapStatistics;
use slipfit_tolerance::{product::Product, theory::moments};

use crate::mechanism::Mechanism;

use super::{
    Override, Problem, SceneError,
    diagnostic::Found,
    identify, keys, mechanism,
    parse::{scene, title},
    pins::{fill, pins, sums},
    product::product,
    tree::{Node, Source},
    value::Field,
};
use crate::setup::{Identification, Scene};

/// What a scene file describes.
pub struct SceneFile {
    /// Title, for plots and reports.
    pub title: String,
    /// Parts, tolerances and measures, if it has any.
    pub product: Option<Product>,
    /// The mechanism, if it has one. Gaps that are measures of the product have the moments that [`moments::of_measures`]
    /// finds.
    pub slide: Option<Scene>,
    /// The mechanism, if it is made of bodies and joints of its own.
    pub mechanism: Option<Mechanism>,
    /// What is sought in measured motion, if it says so.
    pub identify: Option<Identification>,
}

impl SceneFile {
    /// Reads the `text` of the scene file `file_name` with the `overrides` applied in order.
    ///
    /// # Errors
    /// [`SceneError`] points at every value, in the file or in an override, that makes no scene.
    pub fn parse(file_name: &str, text: &str, overrides: &[Override]) -> Result<Self, SceneError> {
        let found = Found::default();
        let mut tree = Source { name: file_name, text, found: &found }.document()?;
        for change in overrides {
            tree.set(change)?;
        }
        keys::note_unfit(&tree);
        let mut read = Self::read(&tree, file_name);
        if let Ok(file) = &mut read {
            if !found.any() {
                keys::note_unread(&tree);
            }
            file.warn(found.take_warnings());
        }
        found.conclude(read)
    }

    /// Gives `warnings` to what moves, else to the product.
    fn warn(&mut self, warnings: Vec<String>) {
        let slide = self.slide.as_mut().map(|slide| &mut slide.warnings);
        let moving = slide.or(self.mechanism.as_mut().map(|mechanism| &mut mechanism.warnings));
        if let Some(all) = moving.or(self.product.as_mut().map(|product| &mut product.warnings)) {
            all.extend(warnings);
        }
    }

    /// Reads the scene from its `tree`. What is wrong with single values is noted there.
    pub(super) fn read(tree: &Node<'_>, file_name: &str) -> Result<Self, SceneError> {
        let root = Field { key: String::new(), node: tree };
        let title = title(&root, file_name)?;
        if let Some(identify) = identify::drive_train(&root)? {
            return Ok(Self { title, product: None, slide: None, mechanism: None, identify: Some(identify) });
        }
        let mut product = ["dimension", "part", "measure"]
            .iter()
            .any(|key| root.get(key).is_some())
            .then(|| product(&root))
            .transpose()?;
        let of_slide = ["slide", "contact", "friction", "drive", "run", "controller", "sweep", "pin", "vary"];
        if product.is_some() && !mechanism::is_mechanism(&root) && of_slide.iter().all(|key| root.get(key).is_none()) {
            return Ok(Self { title, product, slide: None, mechanism: None, identify: None });
        }
        if mechanism::is_mechanism(&root) {
            mechanism::refuse_slide(&root)?;
            let mechanism = mechanism::mechanism(&root, title.clone(), product.as_ref())?;
            return Ok(Self { title, product, slide: None, mechanism: Some(mechanism), identify: None });
        }
        if product.is_some()
            && root.get("slide").is_none()
            && let Some(alone) = of_slide.iter().find_map(|key| root.get(key))
        {
            let allowed = "[slide] and [[pin]], or [[body]] and [[joint]], beside it";
            return Err(alone.no_effect("without a [slide] or bodies", allowed));
        }
        root.table("slide")?;
        let (mut pins, gap_measures) = pins(&root, product.as_ref().map(|product| &product.model))?;
        // With values that stand for wrong ones there is nothing to compute.
        let sound = !tree.place.found().any();
        if let Some(product) = product.as_mut().filter(|_| sound && gap_measures.iter().flatten().any(Option::is_some))
        {
            let moments = moments::of_measures(&product.model);
            let statistics: Vec<_> =
                moments.iter().map(|of| GapStatistics { mean: of.mean, deviation: of.deviation }).collect();
            fill(&mut pins, &gap_measures, &statistics);
            product.model.sums.extend(sums(&pins, &gap_measures));
        }
        let slide = scene(&root, title.clone(), pins, gap_measures)?;
        let identify = identify::slide(&root, &slide)?;
        Ok(Self { title, product, slide: Some(slide), mechanism: None, identify })
    }

    /// The slide of the scene file `file_name` and the product it belongs to, if the scene has one.
    ///
    /// # Errors
    /// As [`Scene::parse`].
    pub fn parse_with_slide(
        file_name: &str,
        text: &str,
        overrides: &[Override],
    ) -> Result<(Scene, Option<Product>), SceneError> {
        Self::parse(file_name, text, overrides)?.into_slide(file_name, text)
    }

    /// The slide and the product it belongs to, of a scene that was read from the `text` of `file_name`.
    ///
    /// # Errors
    /// [`SceneError`] says that there is no slide.
    pub fn into_slide(self, file_name: &str, text: &str) -> Result<(Scene, Option<Product>), SceneError> {
        if self.mechanism.is_some() {
            let wanted = "a scene with [slide] and [[pin]]; check, simulate, sweep, run, table, kernel, fmu and, with a product, \
                          tolerance and allocate work on this one";
            return Err(no_slide(file_name, text, Problem::NotASlide, wanted));
        }
        match self.slide {
            Some(slide) => Ok((slide, self.product)),
            None => {
                let wanted = "a scene with [slide] and [[pin]], or with [[body]] and [[joint]]; check, tolerance and allocate \
                              work on this one";
                Err(no_slide(file_name, text, Problem::NoSlide, wanted))
            }
        }
    }
}

impl Scene {
    /// Reads the slide of the scene file `file_name` from its `text`, with the `overrides` applied in order.
    ///
    /// # Errors
    /// [`SceneError`] points at the first value, in the file or in an override, that makes no scene, or says that it
    /// has no slide.
    pub fn parse(file_name: &str, text: &str, overrides: &[Override]) -> Result<Self, SceneError> {
        SceneFile::parse_with_slide(file_name, text, overrides).map(|(scene, _)| scene)
    }
}

/// There is no slide in the scene; `wanted` says what has one, and what works without.
fn no_slide(file_name: &str, text: &str, problem: Problem, wanted: &str) -> SceneError {
    let first_line = 0..text.find('\n').unwrap_or(text.len());
    SceneError::new(problem, wanted.to_owned(), file_name, text, first_line)
}
