//! A scene file as a whole: a product with its tolerances, a slide that moves, or both.

use std::{path::PathBuf, sync::Arc};

use slipfit_core::{clearance::GapStatistics, slide::PINS};
use slipfit_tolerance::{model::Variation, product::Product, theory::moments};

use crate::mechanism::Mechanism;

use super::{
    Override, Problem, SceneError,
    diagnostic::Found,
    identify, include, key_checks,
    measured::{self, columns::Columns},
    mechanism,
    parse::{scene, title},
    pins::{fill, pins, sums},
    product::product,
    short_form,
    tree::{Node, Source},
    value::Field,
};
use crate::{
    identify::Identification,
    setup::{GapMeasures, Measured, PinSpec, SURFACES, Scene},
};

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
    /// What of it was measured, if anything was.
    pub measured: Option<Arc<Measured>>,
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
        let source = Source { name: file_name, text, found: &found };
        let mut first = source.document()?;
        // An override may be of `include`; the others are applied to the whole scene.
        overrides.iter().for_each(|change| drop(first.set(change)));
        let included = include::read(&first, file_name)?;
        let mut tree = source.document()?;
        for file in &included {
            include::add(&mut tree, file)?;
        }
        for change in overrides {
            tree.set(change)?;
        }
        tree.entry("include").iter().for_each(|entry| entry.read.set(true));
        key_checks::note_unfit(&tree);
        if let Err(error) = short_form::write_out(&mut tree) {
            return found.conclude(Err(error));
        }
        let mut read = Self::read(&tree, file_name);
        if let Ok(file) = &mut read {
            if !found.any() {
                key_checks::note_unread(&tree);
            }
            file.warn(found.take_warnings());
        }
        found.conclude(read)
    }

    /// The files that a scene refers to, each with what it is; none where its text cannot be read.
    pub fn files(file_name: &str, text: &str, overrides: &[Override]) -> Vec<(&'static str, PathBuf)> {
        let found = Found::default();
        let source = Source { name: file_name, text, found: &found };
        let Ok(mut first) = source.document() else { return Vec::new() };
        // Reading the scene reports what is wrong with an override or an included file.
        overrides.iter().for_each(|change| drop(first.set(change)));
        let paths = include::paths(&first, file_name).unwrap_or_default();
        let mut files: Vec<_> = paths.into_iter().map(|(_, path)| ("an included file", path.into())).collect();
        let included = include::read(&first, file_name).unwrap_or_default();
        let Ok(mut tree) = source.document() else { return files };
        included.iter().for_each(|file| drop(include::add(&mut tree, file)));
        overrides.iter().for_each(|change| drop(tree.set(change)));
        files.extend(measured::files(&Field { key: String::new(), node: &tree }, file_name));
        files
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
            let (product, slide, mechanism, measured) = (None, None, None, None);
            return Ok(Self { title, product, slide, mechanism, measured, identify: Some(identify) });
        }
        let measured = measured::columns(&root, file_name)?;
        let mut product = ["dimension", "part", "measure"]
            .iter()
            .any(|key| root.get(key).is_some())
            .then(|| product(&root, measured.as_ref()))
            .transpose()?;
        let of_slide =
            ["slide", "contact", "friction", "drive", "run", "controller", "sweep", "pin", "vary", "uncertain"];
        if product.is_some() && !mechanism::is_mechanism(&root) && of_slide.iter().all(|key| root.get(key).is_none()) {
            let measured = found(measured, product.as_ref(), Vec::new())?;
            return Ok(Self { title, product, slide: None, mechanism: None, measured, identify: None });
        }
        if mechanism::is_mechanism(&root) {
            mechanism::refuse_slide(&root)?;
            let (mut mechanism, identify) =
                mechanism::mechanism(&root, (title.clone(), file_name), product.as_ref(), measured.as_ref())?;
            let names = mechanism.gaps.iter().map(|gap| gap.name.clone()).collect();
            let measured = found(measured, product.as_ref(), names)?;
            mechanism.measured.clone_from(&measured);
            return Ok(Self { title, product, slide: None, mechanism: Some(mechanism), measured, identify });
        }
        if product.is_some()
            && root.get("slide").is_none()
            && let Some(alone) = of_slide.iter().find_map(|key| root.get(key))
        {
            let allowed = "[slide] and [[pin]], or [[body]] and [[joint]], beside it";
            return Err(alone.no_effect("without a [slide] or bodies", allowed));
        }
        root.table("slide")?;
        let (mut pins, mut gap_measures) = pins(&root, product.as_ref().map(|product| &product.model))?;
        let names = measure_pins(&mut pins, &mut gap_measures, measured.as_ref());
        let measured = found(measured, product.as_ref(), names)?;
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
        let mut slide = scene(&root, title.clone(), pins, gap_measures)?;
        slide.measured.clone_from(&measured);
        let identify = identify::slide(&root, &slide)?;
        Ok(Self { title, product, slide: Some(slide), mechanism: None, measured, identify })
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

/// What of a scene was measured, whose gaps have these `names`.
fn found(
    columns: Option<Columns>,
    product: Option<&Product>,
    mut names: Vec<String>,
) -> Result<Option<Arc<Measured>>, SceneError> {
    let contributors = product.into_iter().flat_map(|product| &product.model.contributors);
    let scalars = contributors.filter(|of| matches!(of.variation, Variation::Scalar { .. }));
    names.extend(scalars.map(|contributor| contributor.name.clone()));
    columns.map(|columns| columns.found(&names).map(Arc::new)).transpose()
}

/// Gives measured gaps of the `pins` their statistics; they are measures of the product no more. The names of all gaps.
fn measure_pins(pins: &mut [PinSpec; PINS], measures: &mut GapMeasures, columns: Option<&Columns>) -> Vec<String> {
    let mut names = Vec::new();
    for (p, (pin, measures)) in pins.iter_mut().zip(measures).enumerate() {
        for (s, surface) in SURFACES.into_iter().enumerate() {
            let name = format!("{} {surface}", pin.name);
            if pin.gaps[s].is_none() && measures[s].is_none() {
                continue;
            }
            if let Some(statistics) = columns.and_then(|columns| columns.gap(&name, SURFACES.len() * p + s)) {
                (pin.gaps[s], measures[s]) = (Some(statistics), None);
            }
            names.push(name);
        }
    }
    names
}

/// There is no slide in the scene; `wanted` says what has one, and what works without.
fn no_slide(file_name: &str, text: &str, problem: Problem, wanted: &str) -> SceneError {
    let first_line = 0..text.find('\n').unwrap_or(text.len());
    SceneError::new(problem, wanted.to_owned(), file_name, text, first_line)
}
