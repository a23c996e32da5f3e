//! Characteristics of a QIF model: sizes and geometric tolerances (CharacteristicNominalType, CharacteristicDefinitionType).

use std::collections::HashMap;

use roxmltree::Node;

use super::{
    frame::{Frame, material},
    notes::notes,
    place::direction,
    shape::{ById, by_id},
};
use crate::{
    drawing::{Control, Datum, Geometric, Limits, Material, Range, Reference, Size, Tolerance, Zone},
    error::{Problem, QifError},
    units::Units,
    words,
    xml::{child, children, error_at, ids, is_true, name, path, text, text_of},
};

/// What characteristics refer to.
struct Context<'a, 'i> {
    units: &'a Units,
    features: &'a HashMap<&'a str, usize>,
    datums: &'a [Datum],
    frames: &'a HashMap<&'a str, Frame>,
    definitions: ById<'a, 'i>,
    shown: HashMap<&'a str, String>,
}

/// Why something is not read.
type Reason = String;

/// Shape of the zone, condition of material and datums.
type Segment = (Zone, Material, Vec<Reference>);

/// Elements of a characteristic that say nothing of what it limits.
const HARMLESS: [&str; 13] = [
    "Attributes",
    "Description",
    "Name",
    "CharacteristicDesignator",
    "CharacteristicDefinitionId",
    "FeatureNominalIds",
    "EntityInternalIds",
    "EntityExternalIds",
    "SubstituteFeatureAlgorithm",
    "SizeCharacteristicDefinitionId",
    "ToleranceDualValue",
    // Sizes and forms are independent, and so are zones, in a scene.
    "Independency",
    "SeparateZone",
];
/// Elements that are said in other words already.
const UNSAID: [&str; 10] = [
    "Attributes",
    "Name",
    "CharacteristicDesignator",
    "CharacteristicDefinitionId",
    "FeatureNominalIds",
    "EntityInternalIds",
    "EntityExternalIds",
    "DatumReferenceFrameId",
    "StatisticalCharacteristic",
    "FeatureNominalPairs",
];

/// Reads the characteristics of a document, and what else it says of its tolerances.
pub fn tolerances<'a>(
    root: Node<'a, '_>,
    units: &'a Units,
    features: &'a HashMap<&'a str, usize>,
    datums: &'a [Datum],
    frames: &'a HashMap<&'a str, Frame>,
) -> Result<(Vec<Tolerance>, Vec<String>), QifError> {
    let Some(list) = child(root, "Characteristics") else { return Ok((Vec::new(), Vec::new())) };
    let definitions = by_id(child(list, "CharacteristicDefinitions"));
    let context = Context { units, features, datums, frames, definitions, shown: words::displayed(root) };
    let nominals = child(list, "CharacteristicNominals").into_iter().flat_map(children);
    let mut found = nominals.map(|node| context.read(node)).collect::<Result<Vec<_>, _>>()?;
    for general in ["DefaultCharacteristicDefinitions", "DefaultToleranceDefinitions"] {
        for node in child(list, general).into_iter().flat_map(children) {
            let limits = Limits::NotRead("a general tolerance of the whole part".into());
            found.push(context.tolerance(node, node, Vec::new(), limits));
        }
    }
    let mut remarks: Vec<_> =
        notes(root).into_iter().map(|note| format!("note of the drawing, not read: {note}")).collect();
    remarks.extend(mixed_units(list, units));
    Ok((found, remarks))
}

/// Tells of sizes and geometric tolerances in different units, which drawings hardly have and exports sometimes do.
fn mixed_units(list: Node, units: &Units) -> Option<String> {
    let definitions = || child(list, "CharacteristicDefinitions").into_iter().flat_map(children);
    let in_inch = |value: Node| {
        let unit = units.name_of_tolerance(value);
        units.millimetres(unit).is_some_and(|factor| (factor - 25.4).abs() < 1e-9)
    };
    let zones: Vec<_> = definitions().filter_map(|node| child(node, "ToleranceValue")).map(in_inch).collect();
    let sizes: Vec<_> = definitions().filter_map(|node| path(node, &["Tolerance", "MaxValue"])).map(in_inch).collect();
    let differ = zones.iter().all(|inch| !inch) && sizes.iter().any(|inch| *inch) && !zones.is_empty();
    differ.then(|| {
        "the file states sizes in inch and zones in mm, and both are read so: compare the zones with the drawing".into()
    })
}

impl<'a> Context<'a, '_> {
    fn read(&self, node: Node<'a, '_>) -> Result<Tolerance, QifError> {
        let refers =
            |id: &str| error_at(node, Problem::Reference { element: name(node).to_owned(), id: words::one_line(id) });
        let id = text_of(node, "CharacteristicDefinitionId").unwrap_or_default();
        let definition = *self.definitions.get(id).ok_or_else(|| refers(id))?;
        let features = ids(node, "FeatureNominalIds");
        let features = features.into_iter().map(|id| self.features.get(id).copied().ok_or_else(|| refers(id)));
        let features = features.collect::<Result<Vec<_>, _>>()?;
        let limits = self.limits(node, definition)?.unwrap_or_else(Limits::NotRead);
        Ok(self.tolerance(node, definition, features, limits))
    }

    fn tolerance(&self, node: Node, definition: Node, features: Vec<usize>, limits: Limits) -> Tolerance {
        let id = node.attribute("id").unwrap_or_default();
        let mut said = vec![words::kind(name(node)).to_owned()];
        said.extend(self.shown.get(id).cloned());
        let mut stated = vec![words::values(definition, &UNSAID)];
        if node != definition {
            stated.push(words::values(node, &UNSAID));
        }
        let frame = text_of(definition, "DatumReferenceFrameId").and_then(|id| self.frames.get(id));
        stated.extend(frame.map(|frame| match frame {
            Ok(frame) => format!("datums {}", self.letters(frame)),
            Err(reason) => format!("datums: {reason}"),
        }));
        stated.retain(|text| !text.is_empty());
        if !stated.is_empty() {
            said.push(format!("({})", stated.join(", ")));
        }
        Tolerance {
            id: id.to_owned(),
            name: words::one_line(text_of(node, "Name").unwrap_or_default()),
            words: said.join(" "),
            features,
            limits,
        }
    }

    /// A frame as `A|B(M)|C-D`.
    fn letters(&self, frame: &[Reference]) -> String {
        let one = |reference: &Reference| {
            let labels: Vec<_> = reference.datums.iter().map(|i| self.datums[*i].label.as_str()).collect();
            labels.join("-")
                + match reference.material {
                    Material::None => "",
                    Material::Maximum => "(M)",
                    Material::Least => "(L)",
                }
        };
        frame.iter().map(one).collect::<Vec<_>>().join("|")
    }

    fn limits(&self, node: Node, definition: Node) -> Result<Result<Limits, Reason>, QifError> {
        if let Some(kind) = text_of(definition, "DimensionType").or(text_of(definition, "NonTolerance")) {
            return Ok(Ok(Limits::Nothing(format!("a dimension without a tolerance ({kind})"))));
        }
        match name(definition) {
            "DiameterCharacteristicDefinition" => self.size(node, definition),
            _ => self.geometric(node, definition),
        }
    }

    /// DiameterCharacteristicDefinitionType with its LinearToleranceType.
    fn size(&self, node: Node, definition: Node) -> Result<Result<Limits, Reason>, QifError> {
        let handled = ["Tolerance", "LimitsAndFitsSpecification", "TargetValue", "TargetDualValue"];
        if let Some(reason) = not_handled(node, definition, &handled) {
            return Ok(Err(reason));
        }
        let of = |node: Node| self.units.of_tolerance(node);
        let nominal = child(node, "TargetValue").map(of).transpose()?;
        if let Some(fit) = child(definition, "LimitsAndFitsSpecification") {
            let letter = text_of(fit, "FormVariance").unwrap_or_default();
            let grade = text_of(fit, "Grade").unwrap_or_default().trim_start_matches("IT");
            let range = Range::Class(format!("{letter}{grade}"));
            return Ok(Ok(Limits::Diameter(Size { nominal, range })));
        }
        let Some(tolerance) = child(definition, "Tolerance") else { return Ok(Err("a size without limits".into())) };
        let (Some(least), Some(most)) = (child(tolerance, "MinValue"), child(tolerance, "MaxValue")) else {
            return Ok(Err("a size without a lower or an upper limit".into()));
        };
        let limits = [of(least)?, of(most)?];
        let is_absolute = is_true(tolerance, "DefinedAsLimit");
        if !is_absolute && text_of(tolerance, "DefinedAsLimit").is_none() {
            return Ok(Err("limits that are not said to be sizes or deviations".into()));
        }
        let range = if is_absolute { Range::Sizes(limits) } else { Range::Deviations(limits) };
        Ok(Ok(Limits::Diameter(Size { nominal, range })))
    }

    fn geometric(&self, node: Node, definition: Node) -> Result<Result<Limits, Reason>, QifError> {
        let Some(control) = control(name(definition)) else {
            return Ok(Err(format!(
                "the kind {}, which a part of a scene does not have",
                words::kind(name(definition))
            )));
        };
        let handled = [
            "ToleranceValue",
            "DatumReferenceFrameId",
            "MaterialCondition",
            "ZoneShape",
            "Extent",
            "Angle",
            "SecondCompositeSegmentPositionDefinition",
        ];
        if let Some(reason) = not_handled(node, definition, &handled) {
            return Ok(Err(reason));
        }
        if let Some(extent) = child(definition, "Extent")
            && text_of(extent, "ExtentEnum") != Some("UNDEFINED")
        {
            return Ok(Err(format!("the extent {}", words::values(extent, &[]))));
        }
        let Some(value) = child(definition, "ToleranceValue") else { return Ok(Err("no width of a zone".into())) };
        let width = self.units.of_tolerance(value)?;
        let read = || -> Result<Result<Geometric, Reason>, QifError> {
            let segment = match self.segment(definition)? {
                Ok(segment) => segment,
                Err(reason) => return Ok(Err(reason)),
            };
            let (zone, material, frame) = segment;
            let mut within = None;
            if let Some(lower) = child(definition, "SecondCompositeSegmentPositionDefinition") {
                if let Some(reason) = unknown(lower, &handled) {
                    return Ok(Err(format!("a lower segment with {reason}")));
                }
                let Some(value) = child(lower, "ToleranceValue") else {
                    return Ok(Err("a lower segment without a width".into()));
                };
                match self.segment(lower)? {
                    Ok((lower_zone, lower_material, frame)) if (lower_zone, lower_material) == (zone, material) => {
                        within = Some((self.units.of_tolerance(value)?, frame));
                    }
                    Ok(_) => return Ok(Err("a lower segment with another zone or condition of material".into())),
                    Err(reason) => return Ok(Err(format!("a lower segment with {reason}"))),
                }
            }
            Ok(Ok(Geometric { control, width, zone, material, frame, within }))
        };
        Ok(read()?.map(Limits::Geometric))
    }

    /// Shape of the zone, condition of material and datums of a characteristic or of a segment of it.
    fn segment(&self, node: Node) -> Result<Result<Segment, Reason>, QifError> {
        let zone = match child(node, "ZoneShape").map(zone).transpose()? {
            Some(Err(reason)) => return Ok(Err(reason)),
            Some(Ok(zone)) => zone,
            None => Zone::Natural,
        };
        let frame = match text_of(node, "DatumReferenceFrameId") {
            None => Ok(Vec::new()),
            Some(id) => self.frames.get(id).cloned().ok_or_else(|| {
                error_at(node, Problem::Reference { element: name(node).to_owned(), id: words::one_line(id) })
            })?,
        };
        Ok(material(text_of(node, "MaterialCondition")).and_then(|material| Ok((zone, material, frame?))))
    }
}

/// The first element of a characteristic that is neither handled nor harmless, as a reason.
fn not_handled(node: Node, definition: Node, handled: &[&str]) -> Option<Reason> {
    unknown(definition, handled).or_else(|| unknown(node, handled))
}

/// The first element that is neither handled nor harmless nor a modifier that is off.
fn unknown(node: Node, handled: &[&str]) -> Option<Reason> {
    let mut others = children(node).filter(|element| {
        let known = handled.contains(&name(*element)) || HARMLESS.contains(&name(*element));
        !known && !matches!(text(*element), "false" | "0")
    });
    others.next().map(|element| name(element).to_owned())
}

/// Shape of a zone (PositionZoneShapeType, OrientationZoneShapeType and the like).
fn zone(node: Node) -> Result<Result<Zone, Reason>, QifError> {
    let Some(shape) = children(node).next() else { return Ok(Ok(Zone::Natural)) };
    let mut normal = None;
    for element in children(shape) {
        match name(element) {
            "ZoneOrientationVector" => normal = Some(direction(element)?),
            "Attributes" => {}
            _ if matches!(text(element), "false" | "0") => {}
            other => return Ok(Err(format!("a zone with {other}"))),
        }
    }
    Ok(match (name(shape), normal) {
        ("DiametricalZone", None) => Ok(Zone::Cylinder),
        ("SphericalZone", None) => Ok(Zone::Sphere),
        ("PlanarZone" | "NonDiametricalZone", normal) => Ok(Zone::Slab(normal)),
        (other, _) => Err(format!("a zone of the shape {other}")),
    })
}

/// The tolerance that an element defines.
fn control(element: &str) -> Option<Control> {
    Some(match words::kind(element) {
        "Flatness" => Control::Flatness,
        "Straightness" => Control::Straightness,
        "Circularity" => Control::Roundness,
        "Cylindricity" => Control::Cylindricity,
        "Parallelism" => Control::Parallelism,
        "Perpendicularity" => Control::Perpendicularity,
        "Angularity" => Control::Angularity,
        "Position" => Control::Position,
        "SurfaceProfile" | "PointProfile" => Control::Profile,
        "Coaxiality" => Control::Coaxiality,
        "Concentricity" => Control::Concentricity,
        "Symmetry" => Control::Symmetry,
        "CircularRunout" => Control::RunOut,
        "TotalRunout" => Control::TotalRunOut,
        _ => return None,
    })
}
