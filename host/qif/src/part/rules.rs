//! Which tolerances a part of a scene has, and how it states them; everything else is refused with a reason.

use slipfit_tolerance::product::iso286;

use super::{
    entry::{Class, DatumRef, Diameter, Entry, key},
    geometry::{are_common, each_holds, is_in_middle, is_normal, turns_about},
};
use crate::{
    drawing::{Axis, Control, Drawing, Geometric, Material, Plane, Range, Reference, Shape, Size, Zone},
    format::{rounded, twelve_digits},
};

/// Share of a diameter by which a stated size may differ from the model: drawings round, but another unit or feature differs more.
const MISMATCH: f64 = 0.05;

/// The size of an `axis` as its part states it.
pub fn size(tolerance: usize, size: &Size, axis: &Axis) -> Result<Entry, String> {
    let nominal = size.nominal.unwrap_or(axis.diameter);
    let (deviations, class) = match &size.range {
        Range::Deviations(deviations) => (*deviations, None),
        Range::Sizes(sizes) => (sizes.map(|size| rounded(twelve_digits(size - nominal))), None),
        Range::Class(class) => {
            let unknown = || format!("the class {class}, which is not read as one of ISO 286");
            let read: iso286::Class = class.parse().map_err(|_| unknown())?;
            if axis.is_hole.is_some_and(|is_hole| is_hole != read.is_hole()) {
                return Err(format!("the class {class} of the other kind of feature"));
            }
            (read.deviations(nominal).map_err(|_| unknown())?, Some(class.clone()))
        }
    };
    let [lower, upper] = deviations;
    if lower >= upper || nominal + lower <= 0.0 {
        return Err("limits of a diameter that are not above 0 and in order".into());
    }
    let middle = nominal + 0.5 * (lower + upper);
    if [nominal, middle].iter().any(|size| (size - axis.diameter).abs() > MISMATCH * axis.diameter) {
        return Err(format!("a size that does not fit the diameter {} mm of the model", axis.diameter));
    }
    Ok(Entry {
        tolerance,
        key: "diameter",
        class: Class::Size,
        width: 0.0,
        material: Material::None,
        datums: Vec::new(),
        within: None,
        diameter: Some(Diameter { nominal, deviations, class }),
    })
}

/// A geometric tolerance of the feature with this index as its part states it. `sizes` has the diameters that the part states.
pub fn geometric(
    tolerance: usize,
    geometric: &Geometric,
    feature: usize,
    drawing: &Drawing,
    sizes: &[Option<Diameter>],
) -> Result<Entry, String> {
    let shape = drawing.features[feature].shape.as_ref().map_err(String::clone)?;
    let (key, class) = key(geometric.control, matches!(shape, Shape::Plane(_)));
    allowed(geometric, shape)?;
    let is_held = |feature: usize| {
        let hole = match &drawing.features[feature].shape {
            Ok(Shape::Axis(axis)) => axis.is_hole,
            _ => None,
        };
        sizes[feature].is_some() && hole.is_some()
    };
    if geometric.material != Material::None {
        let can = ["position", "coaxiality", "perpendicularity", "parallelism", "angularity"].contains(&key);
        if !can || !matches!(shape, Shape::Axis(_)) {
            return Err("a condition of material, which only an axis has".into());
        }
        if !is_held(feature) {
            return Err("a condition of material without a diameter with limits in the part".into());
        }
    }
    if !(geometric.width > 0.0 || (geometric.width == 0.0 && geometric.material != Material::None)) {
        return Err("a zone without a width".into());
    }
    let datums = frame(&geometric.frame, feature, drawing, &is_held)?;
    match class {
        Class::Form if !datums.is_empty() => return Err("a form with datums".into()),
        _ => {}
    }
    let first = datums.first().and_then(|datum| drawing.features[datum.features[0]].shape.as_ref().ok());
    let lies = match geometric.control {
        Control::RunOut | Control::TotalRunOut | Control::Coaxiality | Control::Concentricity => {
            first.is_some_and(|datum| turns_about(shape, datum))
        }
        Control::Symmetry => first.is_some_and(|datum| is_in_middle(shape, datum)),
        _ => true,
    };
    if !lies {
        return Err("a first datum that the feature does not turn about, or is not symmetric to".into());
    }
    let within = match &geometric.within {
        None => None,
        Some((width, lower)) => {
            if key != "position" || !matches!(shape, Shape::Axis(_)) {
                return Err("a composite frame of something other than axes".into());
            }
            if !geometric.frame.starts_with(lower) || *width >= geometric.width || *width < 0.0 {
                return Err(
                    "a lower segment that is not narrower, or whose datums are not the first of the upper one".into()
                );
            }
            if *width == 0.0 && geometric.material == Material::None {
                return Err("a lower segment without a width".into());
            }
            Some((*width, lower.len()))
        }
    };
    Ok(Entry {
        tolerance,
        key,
        class,
        width: geometric.width,
        material: geometric.material,
        datums,
        within,
        diameter: None,
    })
}

/// Whether a shape can have the tolerance with this zone.
fn allowed(geometric: &Geometric, shape: &Shape) -> Result<(), String> {
    use Control::{
        Angularity, Coaxiality, Concentricity, Cylindricity, Flatness, Parallelism, Perpendicularity, Position,
        Profile, Roundness, RunOut, Straightness, Symmetry, TotalRunOut,
    };
    let zone = geometric.zone;
    let ok = match (shape, geometric.control) {
        (Shape::Plane(plane), Position | Parallelism | Perpendicularity | Angularity | Symmetry) => match zone {
            Zone::Natural => true,
            Zone::Slab(normal) => is_normal(normal, plane.normal),
            Zone::Cylinder | Zone::Sphere => false,
        },
        (Shape::Plane(Plane { width: None, .. }), Flatness | Profile | RunOut | TotalRunOut) => zone == Zone::Natural,
        (Shape::Plane(Plane { width: Some(_), .. }), Flatness | Profile | RunOut | TotalRunOut) => {
            return Err("a tolerance of both faces, which the part has only the middle plane of".into());
        }
        (Shape::Plane(_), Straightness) => {
            return Err("straightness of a face in a direction that is not stated".into());
        }
        (Shape::Point(_), Profile) => zone == Zone::Natural,
        (Shape::Axis(_), Position | Straightness | Parallelism | Perpendicularity | Angularity) => {
            zone == Zone::Cylinder
        }
        (Shape::Axis(_), Coaxiality | Concentricity) => matches!(zone, Zone::Cylinder | Zone::Natural),
        (Shape::Axis(_), Roundness | Cylindricity | RunOut | TotalRunOut) => zone == Zone::Natural,
        (Shape::Axis(_), Symmetry) => matches!(zone, Zone::Natural | Zone::Slab(None)),
        _ => return Err("a tolerance that such a feature of a part does not have".into()),
    };
    if ok {
        Ok(())
    } else {
        Err("a zone of a shape that the tolerance of such a feature does not have in a part".into())
    }
}

/// The datums of a frame, which must be planes or axes of the part that each hold something.
fn frame(
    frame: &[Reference],
    feature: usize,
    drawing: &Drawing,
    is_held: &dyn Fn(usize) -> bool,
) -> Result<Vec<DatumRef>, String> {
    if frame.len() > 3 {
        return Err("more than three datums".into());
    }
    let mut found = Vec::new();
    let mut shapes = Vec::new();
    for reference in frame {
        let labels: Vec<_> = reference.datums.iter().map(|i| drawing.datums[*i].label.as_str()).collect();
        let label = labels.join("-");
        if reference.datums.iter().any(|i| drawing.datums[*i].targets > 0) {
            return Err(format!("the datum {label}, which has datum targets"));
        }
        let features: Vec<usize> =
            reference.datums.iter().flat_map(|i| drawing.datums[*i].features.iter().copied()).collect();
        let of: Result<Vec<_>, _> =
            features.iter().map(|i| drawing.features[*i].shape.as_ref().map_err(String::as_str)).collect();
        let of = of.map_err(|reason| format!("the datum {label}: {reason}"))?;
        let is_one = match of[..] {
            [Shape::Plane(_) | Shape::Axis(_)] => true,
            [one, two] => are_common(one, two) && reference.material == Material::None,
            _ => false,
        };
        if !is_one {
            return Err(format!("the datum {label}, which is not one face or axis of the part, or two on one line"));
        }
        if features.contains(&feature) {
            return Err(format!("the datum {label}, which is the feature itself"));
        }
        if reference.material != Material::None && !features.iter().all(|feature| is_held(*feature)) {
            return Err(format!(
                "the datum {label} at a condition of material, without a diameter with limits in the part"
            ));
        }
        shapes.extend(of.first().map(|shape| **shape));
        found.push(DatumRef { features, material: reference.material });
    }
    let all: Vec<_> = found.iter().flat_map(|datum| &datum.features).collect();
    if all.iter().enumerate().any(|(i, feature)| all[..i].contains(feature)) {
        return Err("a feature that is a datum twice".into());
    }
    if !each_holds(&shapes) {
        return Err("a datum that holds nothing more than those before it".into());
    }
    Ok(found)
}
