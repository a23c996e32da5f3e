//! Reads the tolerances of a feature: what moves it, and what it moves with.

use crate::{
    product::{
        assembly::{Carried, Placement},
        contact::{Contact, cross, unit},
        contacts::{Joined, Own},
        dimension::Toleranced,
        feature::Shape,
        iso2768,
    },
    scene::{Problem, SceneError, tree::Value, unit as units, unit::Quantity, value::Field},
    tolerance::{
        lanes::Lanes,
        model::{Contributor, Variation, ZoneRule},
    },
};

use super::{Draft, part::FeatureDraft, rule, toleranced};

const WIDTH: Quantity = Quantity { units: units::LENGTH, range: [0.0, 1e7] };
const ZONE: &str = "the width of its zone in mm, or { zone = …, datum = [\"…\"], rule = \"…\" }";

/// What a geometric tolerance limits.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Limits {
    /// Form: offset and tilts, without a datum.
    Form,
    /// Form along the first extent only.
    Line,
    /// Tilts towards a datum.
    Orientation,
    /// Offset and tilts towards datums.
    Location,
}

/// The geometric tolerances.
pub(super) const CALLOUTS: [&str; 7] =
    ["flatness", "straightness", "parallelism", "perpendicularity", "angularity", "position", "profile"];

fn limits(callout: &str) -> Limits {
    match callout {
        "flatness" => Limits::Form,
        "straightness" => Limits::Line,
        "position" | "profile" => Limits::Location,
        _ => Limits::Orientation,
    }
}

/// Reads the tolerances of a feature and adds it to the `draft`.
pub(super) fn read(mut made: FeatureDraft, draft: &mut Draft) -> Result<(), SceneError> {
    let mut frame: Option<(Vec<usize>, Limits)> = None;
    let mut formed = false;
    for callout in CALLOUTS {
        let Some(field) = made.table.get(callout) else { continue };
        let limits = limits(callout);
        refuse_unsupported(callout, &made, &field)?;
        formed |= matches!(limits, Limits::Form | Limits::Location);
        if matches!(&field.node.value, Value::Text(text) if text == "none") {
            continue;
        }
        let datums = datums(&field, limits, draft)?;
        if !datums.is_empty() {
            if frame.as_ref().is_some_and(|(known, _)| *known != datums) {
                let problem = Problem::Unsupported { what: "a second system of datums for one feature".into() };
                return Err(field.error(problem, "the same datums in all tolerances of a feature"));
            }
            let wider = matches!(frame, Some((_, Limits::Location)));
            frame = Some((datums.clone(), if wider { Limits::Location } else { limits }));
        }
        let width = width(&field, callout, &made, &datums, draft)?;
        zone(&mut made, &field, callout, limits, width, draft)?;
    }
    if let Some(field) = made.table.get("offset") {
        let size = toleranced::offset(&field, draft)?;
        let normal = made.feature.nominal[1];
        made.feature.nominal[0] = [0, 1, 2].map(|i| made.feature.nominal[0][i] - size.nominal * normal[i]);
        shift(&mut made, "offset", &size, normal, draft);
    }
    formed |= vectorial(&mut made, draft)?;
    let general = draft.defaults.general.geometry;
    if let Some(class) = general.filter(|_| !formed && made.feature.shape != Shape::Axis) {
        let key = format!("{}.extents", made.table.key);
        let missing =
            || made.table.error(Problem::Missing(key), "extents of its face, flatness, or flatness = \"none\"");
        let [a, b] = made.extents.ok_or_else(missing)?;
        let at = made.table.get("extents").unwrap_or(made.table.clone());
        let width = iso2768::flatness(class, a.max(b)).map_err(|error| toleranced::band(&at, error))?;
        zone(&mut made, &at, "flatness", Limits::Form, width, draft)?;
    }

    let index = draft.assembly.features.len();
    let FeatureDraft { name, feature, part, table, sides, extents, .. } = made;
    draft.faces.push((sides, extents));
    draft.assembly.features.push(feature);
    draft.feature_names.push(name);
    draft.parts_of_features.push(part);
    frame.map_or(Ok(()), |(datums, limits)| carry(index, &datums, limits, &table, draft))
}

/// Refuses a tolerance that a feature of this shape cannot have.
fn refuse_unsupported(callout: &str, made: &FeatureDraft, field: &Field) -> Result<(), SceneError> {
    let known: &[&str] = match made.feature.shape {
        Shape::Plane => &CALLOUTS,
        Shape::Point => &["flatness", "position", "profile"],
        Shape::Axis => &["straightness", "parallelism", "perpendicularity", "angularity", "position"],
    };
    if known.contains(&callout) {
        return Ok(());
    }
    let what = format!("{callout} of {}", made.feature.shape.article());
    Err(field.error(Problem::Unsupported { what }, known.join(", ")))
}

/// The datums that a tolerance names: features of the same part that stand above.
fn datums(field: &Field, limits: Limits, draft: &Draft) -> Result<Vec<usize>, SceneError> {
    let Some(list) = field.get("datum") else { return Ok(Vec::new()) };
    if matches!(limits, Limits::Form | Limits::Line) {
        let problem = Problem::Unsupported { what: format!("a datum of {}", field.key) };
        return Err(list.error(problem, "no datum: a form is its own"));
    }
    let nodes = match &list.node.value {
        Value::List(nodes) => nodes.iter().map(|node| Field { key: list.key.clone(), node }).collect(),
        _ => vec![list.clone()],
    };
    if nodes.is_empty() || nodes.len() > 3 {
        let problem = Problem::Length { key: list.key.clone(), found: nodes.len() };
        return Err(list.error(problem, "one to three datums, the primary first"));
    }
    nodes.iter().map(|datum| draft.feature(datum)).collect()
}

/// The width (m) of a zone, stated or general.
fn width(
    field: &Field,
    callout: &str,
    made: &FeatureDraft,
    datums: &[usize],
    draft: &Draft,
) -> Result<f64, SceneError> {
    let stated = match field.node.value {
        Value::Table(_) => field.get("zone"),
        _ => Some(field.clone()),
    };
    if let Some(zone) = stated {
        return toleranced::positive(&zone, &WIDTH);
    }
    let missing = || field.error(Problem::Missing(format!("{}.zone", field.key)), ZONE);
    let class = draft.defaults.general.geometry.ok_or_else(missing)?;
    let [a, b] = made.extents.ok_or_else(missing)?;
    let longer = a.max(b);
    let found = match callout {
        "flatness" | "straightness" => iso2768::flatness(class, longer),
        "perpendicularity" => iso2768::perpendicularity(class, shorter_leg(made, [a, b], datums, draft)),
        "parallelism" => {
            let size = made.table.get("offset").map(|offset| toleranced::offset(&offset, draft)).transpose()?;
            let whole = size.map_or(0.0, |size| size.limits[1] - size.limits[0]);
            iso2768::flatness(class, longer).map(|flatness| iso2768::parallelism(whole, flatness))
        }
        _ => return Err(missing()),
    };
    found.map_err(|error| toleranced::band(field, error))
}

/// The shorter leg (m) of the right angles that a feature with some `extents` makes with its datums: how far either face
/// goes away from the line in which they meet.
fn shorter_leg(made: &FeatureDraft, extents: [f64; 2], datums: &[usize], draft: &Draft) -> f64 {
    let leg = |shape: Shape, line: [f64; 3], sides: [[f64; 3]; 2], extents: [f64; 2]| {
        let across = |side: [f64; 3]| cross(side, line).iter().map(|x| x * x).sum::<f64>();
        let [a, b] = [0, 1].map(|i| extents[i] * libm::sqrt(across(sides[i])));
        if shape == Shape::Axis { extents[0] } else { a + b }
    };
    let of_datum = |datum: &usize| {
        let feature = &draft.assembly.features[*datum];
        let line = unit(cross(made.feature.nominal[1], feature.nominal[1]))?;
        let own = leg(made.feature.shape, line, made.sides, extents);
        let (sides, size) = draft.faces[*datum];
        Some(size.map_or(own, |size| own.min(leg(feature.shape, line, sides, size))))
    };
    datums.iter().filter_map(of_datum).fold(extents[0].max(extents[1]), f64::min)
}

/// Lets the feature vary in a zone of `width` (m).
fn zone(
    made: &mut FeatureDraft,
    field: &Field,
    callout: &str,
    limits: Limits,
    width: f64,
    draft: &mut Draft,
) -> Result<(), SceneError> {
    let ([_, direction], sides) = (made.feature.nominal, made.sides);
    let extents = made.extents.unwrap_or([1.0; 2]);
    let sixth = Toleranced::in_zone(width);
    match made.feature.shape {
        Shape::Point => shift(made, callout, &sixth, direction, draft),
        Shape::Axis => {
            let rule = field.get("rule").as_ref().map_or(Ok(draft.defaults.rule), rule)?;
            let name = format!("{} {callout}", made.name);
            let first = draft.add(Contributor { name, variation: Variation::Disc(rule) }, &[0.0; 2]);
            for (variable, side) in (first..).zip(sides) {
                if limits == Limits::Location {
                    made.feature.shift(variable, side, width / 2.0);
                } else {
                    // As far as the end of the axis leaves its nominal line.
                    made.feature.tilt(variable, side, width / extents[0]);
                }
            }
        }
        Shape::Plane => {
            let rule_field = field.get("rule");
            let rule = rule_field.as_ref().map_or(Ok(draft.defaults.rule), rule)?;
            if rule == ZoneRule::Translation && limits == Limits::Orientation {
                let what = format!("{callout} by the rule translation");
                return Err(rule_field.unwrap_or(field.clone()).error(
                    Problem::Unsupported { what },
                    "a rule with tilts: sigma-zone, truncated, uniform-in-zone",
                ));
            }
            let variables = if rule == ZoneRule::Translation { 1 } else { 3 };
            let contributor =
                Contributor { name: format!("{} {callout}", made.name), variation: Variation::Zone(rule) };
            let first = draft.add(contributor, &[0.0; 3][..variables]);
            if limits != Limits::Orientation {
                made.feature.shift(first, direction, width / 2.0);
            }
            // A height that grows along a side tilts the normal against it.
            let tilted = if limits == Limits::Line { 1 } else { 2 };
            let tilts = first + 1..first + variables;
            for (variable, (side, extent)) in tilts.zip(sides.into_iter().zip(extents)).take(tilted) {
                made.feature.tilt(variable, side, -width / extent);
            }
        }
    }
    Ok(())
}

/// Lets the feature shift by a toleranced number along a direction.
fn shift(made: &mut FeatureDraft, what: &str, size: &Toleranced, along: [f64; 3], draft: &mut Draft) {
    let variable = draft.add(size.contributor(format!("{} {what}", made.name)), &[size.nominal]);
    made.feature.shift(variable, along, 1.0);
}

/// Vectorial tolerances: components of the position vector and the orientation vector, each with its own, in the part's
/// frame. Gives whether there are any.
fn vectorial(made: &mut FeatureDraft, draft: &mut Draft) -> Result<bool, SceneError> {
    let Some(table) = made.table.get("vectorial") else { return Ok(false) };
    table.expect_table()?;
    for (key, quantity) in [("position", &toleranced::LENGTH), ("orientation", &toleranced::RATIO)] {
        let Some(vector) = table.get(key) else { continue };
        vector.expect_table()?;
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let Some(field) = vector.get(axis) else { continue };
            let size = toleranced::deviation(&field, quantity, draft)?;
            let variable = draft.add(size.contributor(format!("{} {key} {axis}", made.name)), &[0.0]);
            let mut component = [0.0; 3];
            component[i] = 1.0;
            let component = made.pose.direction(component);
            if key == "position" {
                made.feature.shift(variable, component, 1.0);
            } else {
                made.feature.tilt(variable, component, 1.0);
            }
        }
    }
    Ok(true)
}

/// Lets a feature go where its datums go: all of it, or its direction only.
fn carry(index: usize, datums: &[usize], limits: Limits, table: &Field, draft: &mut Draft) -> Result<(), SceneError> {
    let carried = Carried { feature: index, turns_only: limits == Limits::Orientation };
    let part = draft.parts_of_features[index];
    if let Some(foreign) = datums.iter().find(|datum| draft.parts_of_features[**datum] != part) {
        let what = format!("the datum `{}` of another part", draft.feature_names[*foreign]);
        return Err(table.error(Problem::Unsupported { what }, "a datum of the same part"));
    }
    if let Some((_, placement)) = draft.datum_systems.iter().find(|(known, _)| known == datums) {
        draft.assembly.placements[*placement].carry(carried);
        return Ok(());
    }
    let features = &draft.assembly.features;
    let placement = match datums {
        [plane] if features[*plane].shape == Shape::Plane => Placement::on_plane(*plane, carried),
        _ => {
            let contact = |datum: &usize| {
                let feature = &features[*datum];
                let contact = Contact::new(feature.shape, feature.shape, feature.nominal[1], feature.reach)?;
                Some(Joined { contact, own: Own::Perfect(*datum), other: *datum })
            };
            let contacts = datums.iter().filter_map(contact).collect();
            let nominal: Vec<_> = draft.nominal.iter().map(|value| Lanes::splat(*value)).collect();
            let placed = Placement::on_contacts(&draft.assembly, &nominal, contacts, &[], vec![carried]);
            placed.map_err(|error| {
                let part = draft.feature_names[index].clone();
                table.error(Problem::Placement { part, error }, "datums that each hold something more")
            })?
        }
    };
    draft.datum_systems.push((datums.to_vec(), draft.assembly.placements.len()));
    draft.assembly.placements.push(placement);
    Ok(())
}
