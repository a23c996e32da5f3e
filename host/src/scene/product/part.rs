//! Reads parts and where their features are; [`super::callout`] reads what the features' tolerances are.

use slipfit_tolerance::{
    product::{
        contact::{cross, unit},
        feature::{Feature, Shape},
        pose::Pose,
    },
    unit::{self as units, Quantity},
};

use crate::scene::{Problem, SceneError, tree::Value, value::Field};

use super::{
    callout,
    draft::{Draft, FeatureDraft},
    pattern::Pattern,
    tables::{name, tables},
    toleranced,
};

const POSITION: Quantity = Quantity { units: units::LENGTH, range: [-1e7, 1e7] };
const SIZE: Quantity = Quantity { units: units::LENGTH, range: [1e-6, 1e7] };
const ANGLE: Quantity = Quantity { units: units::ANGLE, range: [-3600.0, 3600.0] };
const COMPONENT: Quantity = Quantity { units: units::ONE, range: [-1e9, 1e9] };
const DIRECTION: &str = "a list of 3 numbers, not all 0, or an axis: \"+x\", \"-x\", … \"-z\"";

/// A part: its name and where it is.
pub(super) struct Part<'t, 's> {
    /// Name.
    pub name: &'t str,
    /// Its name's place.
    pub field: Field<'t, 's>,
    /// From its own frame to the assembly's.
    pub pose: Pose,
    /// How kinematic displacements have moved it, its own after those of what it rests on.
    pub motion: Pose,
    table: Field<'t, 's>,
}

/// The parts' names and nominal places, before they are mated.
pub(super) fn parts<'t, 's>(root: &Field<'t, 's>) -> Result<Vec<Part<'t, 's>>, SceneError> {
    let mut parts: Vec<Part> = Vec::new();
    for table in tables(root, "part")? {
        let (name, field) = name(&table)?;
        if parts.iter().any(|part| part.name == name) {
            let problem = Problem::Duplicate { key: field.key.clone(), name: name.into() };
            return Err(field.error(problem, "a name of its own for each part"));
        }
        let at = table.get("at").map(|at| at.to_numbers(&POSITION)).transpose()?.unwrap_or_default();
        let turned = table.get("turned").map(|turned| turned.to_numbers(&ANGLE)).transpose()?.unwrap_or_default();
        let pose = Pose::shift(at).after(&Pose::euler(turned));
        parts.push(Part { name, field, pose, motion: Pose::IDENTITY, table });
    }
    Ok(parts)
}

/// Reads the features of all parts into the `draft`.
pub(super) fn features<'t, 's>(parts: &[Part<'t, 's>], draft: &mut Draft) -> Result<(), SceneError> {
    let mut patterns = Vec::new();
    for (index, part) in parts.iter().enumerate() {
        // In the order of the text, so that a datum stands above what refers to it.
        let mut tables = Vec::new();
        for (key, shape) in [("plane", Shape::Plane), ("point", Shape::Point), ("axis", Shape::Axis)] {
            tables.extend(super::tables::tables(&part.table, key)?.into_iter().map(|table| (shape, table)));
        }
        tables.sort_by_key(|(_, table)| table.node.place.start());
        for (shape, table) in tables {
            feature(part, index, shape, table, &mut patterns, draft)?;
        }
    }
    patterns.iter().try_for_each(|pattern| pattern.place(draft))
}

fn feature<'t, 's>(
    part: &Part,
    index: usize,
    shape: Shape,
    table: Field<'t, 's>,
    patterns: &mut Vec<Pattern<'t, 's>>,
    draft: &mut Draft,
) -> Result<(), SceneError> {
    let (short_name, name_field) = name(&table)?;
    let name = format!("{}.{short_name}", part.name);
    if draft.feature_names.contains(&name) {
        let problem = Problem::Duplicate { key: name_field.key.clone(), name: short_name.into() };
        return Err(name_field.error(problem, "a name of its own for each feature of a part"));
    }
    let at = part.pose.point(table.numbers("at", &POSITION)?);
    let key = if shape == Shape::Axis { "along" } else { "normal" };
    let own_direction = direction(&table, key)?;
    let towards = part.pose.direction(own_direction);
    let (extents, along) = match shape {
        Shape::Plane => (Some(table.numbers("extents", &SIZE)?), direction(&table, "along")?),
        Shape::Point => {
            let extents = table.get("extents").map(|extents| extents.to_numbers(&SIZE)).transpose()?;
            (extents, slipfit_tolerance::product::contact::across(own_direction)[0])
        }
        Shape::Axis => {
            (Some([table.number("length", &SIZE)?; 2]), slipfit_tolerance::product::contact::across(own_direction)[0])
        }
    };
    if cross(own_direction, along).iter().map(|x| x * x).sum::<f64>() < 1.0 - 1e-9 {
        let field = table.require("along", DIRECTION)?;
        let problem = Problem::OutOfRange { key: field.key.clone(), written: field.written("") };
        return Err(field.error(problem, "a direction in the plane, at a right angle to its normal"));
    }
    let own_at: [f64; 3] = table.numbers("at", &POSITION)?;
    let dot = |side: [f64; 3]| (0..3).map(|i| own_at[i] * side[i]).sum::<f64>();
    let coordinates = [own_direction, along, cross(own_direction, along)].map(dot);
    let along = part.pose.direction(along);
    let reach = extents.map_or(0.0, |[a, b]: [f64; 2]| a.max(b) / 2.0);
    let feature = Feature { shape, nominal: [at, towards], terms: Vec::new(), widened: Vec::new(), reach };
    let diameter = if shape == Shape::Axis { toleranced::diameter(&table, &name, draft)? } else { None };
    let sides = [along, cross(towards, along)];
    let pose = part.pose;
    let made = FeatureDraft { name, table, feature, sides, extents, coordinates, diameter, pose, part: index };
    callout::read(made, patterns, draft)
}

/// The unit vector `key` of a table.
pub(super) fn direction(table: &Field, key: &str) -> Result<[f64; 3], SceneError> {
    let field = table.require(key, DIRECTION)?;
    let text = match &field.node.value {
        Value::Text(text) => text,
        Value::List(_) => {
            let vector = field.to_numbers(&COMPONENT)?;
            return unit(vector).ok_or_else(|| field.out_of_range("", DIRECTION));
        }
        _ => return Err(field.wrong_type(DIRECTION)),
    };
    let mut vector = [0.0; 3];
    let (sign, axis) = text.split_at(text.len().min(1));
    match (sign, "xyz".find(axis).filter(|_| axis.len() == 1)) {
        ("+", Some(axis)) => vector[axis] = 1.0,
        ("-", Some(axis)) => vector[axis] = -1.0,
        _ => {
            let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
            return Err(field.error(problem, DIRECTION));
        }
    }
    Ok(vector)
}

/// The part of the feature that `field` names.
pub(super) fn part_of(field: &Field, parts: &[Part]) -> Result<usize, SceneError> {
    let name = field.to_text()?;
    let of = |part: &Part| name.strip_prefix(part.name).is_some_and(|rest| rest.starts_with('.'));
    parts.iter().position(of).ok_or_else(|| {
        let names: Vec<_> = parts.iter().map(|part| part.name).collect();
        let problem = Problem::UnknownName { of: "part of the feature".into(), name: name.into() };
        field.error(problem, format!("PART.FEATURE, the part one of {}", names.join(", ")))
    })
}
