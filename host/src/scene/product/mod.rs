//! Reads a product: dimensions, parts, mates, measures, correlations.
//!
//! ```toml
//! [tolerance]                  # all of it may be left out
//! general = "mH"               # ISO 2768 classes: sizes f m c v, geometry H K L
//! rule = "sigma-zone"          # planes in their zones: or truncated, uniform-in-zone, translation
//! sigma = 3                    # a tolerance of ±t is this many standard deviations
//! datums = "least-squares"     # how frames of datums lie on features that do not fit them: or "iso-5459"
//! correlation = "pearson"      # what a [[correlation]] is of: values, or "spearman", their ranks
//!
//! [[dimension]]
//! name = "height"
//! value = 20                   # mm, or a text with its unit: "30°"
//! tolerance = 0.1              # ±; or [-0.1, 0.3]; or an ISO 2768-1 class, such as "m"; or the general one
//! distribution = "uniform"     # normal if left out; or { kind = "weibull", shape = 2, scale = 0.02 }
//!
//! [[dimension]]
//! name = "load"
//! value = "5 N"                # its unit says what it is; or quantity = "number" and a bare one
//! tolerance = 0.5
//!
//! [[measure]]
//! name = "gap"
//! is = "30 mm - height"        # names with spaces in single quotes
//! lower = 9.8
//! loss = { cost = 50, at = 0.4, target = 10, repair = 2 }   # Taguchi's: 0.4 mm off the target cost 50, to put right 2
//!
//! [[part]]                     # the first stays where it is, a mate places each other
//! name = "box"                 # features in the part's frame; `at`, `turned` (z-x-z) place that in the assembly's
//! plane = [                    # middle of the face, outward normal, direction of the first extent, extents in mm
//!   { name = "rim", at = [0, 0, 20], normal = "+z", along = "+x", extents = [100, 60], flatness = 0.05 },
//! ]
//! point = [{ name = "tip", at = [9, 0, 20], normal = "+z", profile = { zone = 0.1, datum = "box.rim" } }]
//! axis = [{ name = "pin", at = [0, 0, 22], along = "+z", length = 6, diameter = 4, position = 0.1 }]
//!
//! [[mate]]                     # the first contact has precedence over the next, as a first datum has
//! part = "lid"
//! contacts = [["lid.bottom", "box.rim"], ["lid.hole", "box.pin"]]
//! float = "sigma-zone"         # how holes lie in their play on pins: a rule of zones, or "none"
//! turn = { about = "+z", by = "30°" }     # or move = { along, by }: holds a freedom that is meant to move
//!
//! [[measure]]                  # distances from a plane are positive outside of its material
//! name = "height"
//! distance = ["lid.tip", "box.rim"]       # or angle = [PLANE, PLANE]
//! ```
//!
//! Tolerances of a feature: `flatness`, `straightness`, `roundness`, `cylindricity`, `parallelism`, `perpendicularity`, `angularity`,
//! `position`, `profile`, `coaxiality`, `concentricity`, `symmetry`, `run_out`, `total_run_out` (the width of the zone, or zone, datum,
//! rule, `within` a `pattern`, and `material`, "maximum" or "least"; a datum at such a condition is "PART.B (M)" or "PART.B (L)"), `offset` (± along the normal), `vectorial` (each component of
//! the position and of the orientation vector). A plane or a point with none has the general flatness, if there is a
//! class, unless it says `flatness = "none"`. A feature whose place nothing tolerates has the general tolerance of its distance
//! from the origin of its part, unless it says `offset = "none"`. An orientation narrows the tilts of a location, a form lies within both; each has
//! datums of its own. Costs of tolerances and requirements of measures: see `cost`. Two datums that are one (A-B on a drawing) are "PART.A-PART.B", or a list in the list.

#[cfg(test)]
mod allocate_tests;
#[cfg(test)]
mod assembly_tests;
mod callout;
mod correlations;
mod cost;
mod datum;
#[cfg(test)]
mod datum_tests;
mod defaults;
mod diameter;
#[cfg(test)]
mod dimension_tests;
mod distribution;
#[cfg(test)]
mod doubtful_tests;
mod draft;
mod fit;
mod float;
mod geometric;
#[cfg(test)]
mod geometry_tests;
#[cfg(test)]
mod judgement_tests;
mod mate;
mod material;
#[cfg(test)]
mod material_tests;
mod measure;
mod part;
mod pattern;
pub(super) mod quantity;
#[cfg(test)]
mod refused_tests;
mod slant;
mod symmetric;
#[cfg(test)]
mod symmetric_tests;
mod tables;
#[cfg(test)]
mod tests;
mod toleranced;
#[cfg(test)]
mod trade_tests;
mod vectorial;
mod zone;
#[cfg(test)]
mod zone_tests;

pub(super) use defaults::SIGMA_DEFAULT;
#[cfg(test)]
pub(super) use distribution::SHAPES;
pub(super) use toleranced::deviation;

use std::sync::Arc;

use slipfit_tolerance::{
    model::Model,
    product::{
        Product,
        assembly::Assembly,
        contacts::PlacementError,
        expression::{Kind, Source},
        feature::Feature,
        function::Measures,
        iso2768::WITHDRAWN,
    },
};

use self::{
    correlations::correlations,
    defaults::defaults,
    draft::Draft,
    tables::{name, tables},
};

use super::{Problem, SceneError, measured::columns::Columns, value::Field};

/// Reads the product in `root`.
pub(super) fn product(root: &Field, measured: Option<&Columns>) -> Result<Product, SceneError> {
    let mut draft = Draft {
        defaults: defaults(root)?,
        contributors: Vec::new(),
        nominal: Vec::new(),
        quantities: Vec::new(),
        names: Vec::new(),
        assembly: Assembly::default(),
        feature_names: Vec::new(),
        parts_of_features: Vec::new(),
        faces: Vec::new(),
        diameters: Vec::new(),
        common: Vec::new(),
        datum_systems: Vec::new(),
        fits: Vec::new(),
        widenings: Vec::new(),
        used: Vec::new(),
        warnings: Vec::new(),
    };
    for table in tables(root, "dimension")? {
        if let Err(error) = toleranced::dimension(&table, &mut draft) {
            // Reading goes on: what uses its name is not wrong as well.
            table.found().note(error);
            toleranced::stand_in(&table, &mut draft);
        }
    }
    let mut parts = part::parts(root)?;
    let mates = mate::mates(root, &mut parts)?;
    part::features(&parts, &mut draft)?;
    mates.iter().try_for_each(|mate| mate::place(mate, &parts, &mut draft))?;
    let together = measured.map_or(Ok(Vec::new()), |columns| columns.apply(&mut draft.contributors))?;
    let correlations = correlations(root, &draft.contributors, together)?;
    draft.warnings.extend(untoleranced(&draft));
    let mut function = Measures::new(std::mem::take(&mut draft.assembly));
    let measures = measure::measures(root, &mut draft, &mut function)?;
    warn_of_unused(root, &draft)?;
    let sums = measure::sums(root, &measures)?;
    let costed = cost::costs(root, &draft.contributors)?;
    measured.map_or(Ok(()), |columns| columns.refuse_costs(&costed))?;
    let requirements = cost::requirements(root, &measures)?;
    let mut warnings = Vec::new();
    if draft.defaults.general.geometry.is_some() {
        warnings.push(WITHDRAWN.to_owned());
    }
    function.widenings = std::mem::take(&mut draft.widenings);
    let Draft { contributors, nominal, quantities, fits, warnings: told, .. } = draft;
    warnings.extend(told);
    warnings.extend(root.found().take_warnings());
    let assembly = function.assembly.clone();
    function.nominal.clone_from(&nominal);
    function.quantities = quantities;
    let model = Model { contributors, correlations, measures, sums, function: Arc::new(function) };
    let tried = fit::try_out(&model, &assembly, &fits);
    warnings.extend(tried.told);
    if tried.open > fit::OPEN_MOST {
        let error = PlacementError::OpenUnits { units: tried.open, of: fit::UNITS };
        let part = mates.first().map_or("", |mate| parts[mate.part].name).to_owned();
        let field = root.get("mate").unwrap_or(root.clone());
        return Err(field.error(Problem::Placement { part, error }, "features that meet within their tolerances"));
    }
    Ok(Product { model, nominal, costed, requirements, warnings })
}

/// Sentences about the features that vary in nothing, and those whose place does not.
fn untoleranced(draft: &Draft) -> Vec<String> {
    let features = draft.assembly.features.iter().zip(&draft.feature_names).enumerate();
    let own = features.filter(|(index, _)| !draft.common.contains(index)).map(|(_, feature)| feature);
    let (bare, toleranced): (Vec<_>, Vec<_>) = own.partition(|(feature, _)| feature.components().next().is_none());
    let placed = |feature: &Feature| feature.components().any(|component| component < 3);
    let unplaced: Vec<_> = toleranced.into_iter().filter(|(feature, _)| !placed(feature)).collect();
    let tell = |what: &str, features: Vec<(&Feature, &String)>| {
        let names: Vec<_> = features.into_iter().map(|(_, name)| name.as_str()).collect();
        (!names.is_empty()).then(|| format!("{what}: {}", names.join(", ")))
    };
    let told = [tell("without a tolerance", bare), tell("without a tolerance of their place", unplaced)];
    told.into_iter().flatten().collect()
}

/// Warns of every dimension that no measure uses.
fn warn_of_unused(root: &Field, draft: &Draft) -> Result<(), SceneError> {
    for table in tables(root, "dimension")? {
        let Ok((name, field)) = name(&table) else { continue };
        let unused = |(known, source, _): &(String, Source, Kind)| match source {
            Source::Variable(variable) => known == name && !draft.used.contains(variable),
            Source::Measure(_) => false,
        };
        if draft.names.iter().any(unused) {
            field.warn(&format!("no measure uses the dimension `{name}`"));
        }
    }
    Ok(())
}
