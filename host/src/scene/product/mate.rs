//! Reads mates: which contacts place which part, in what order, and how it has moved.

use slipfit_tolerance::{
    model::ZoneRule,
    number::ten_digits,
    numeric::lanes::Lanes,
    product::{
        assembly::{Carried, Placement, With},
        contact::Contact,
        contacts::{Joined, Order, Own, PlacementError},
        feature::{Feature, Shape},
        float::{Float, Size},
        pose::Pose,
    },
    unit::{self, Quantity},
};

use crate::scene::{Problem, SceneError, tree::Value, value::Field};

use super::{
    defaults::rule,
    draft::{Draft, Fit},
    float::floating,
    part::{self, Part, direction},
    tables::tables,
};

const POSITION: Quantity = Quantity { units: unit::LENGTH, range: [-1e7, 1e7] };
const ANGLE: Quantity = Quantity { units: unit::ANGLE, range: [-3600.0, 3600.0] };
const CONTACTS: &str =
    "a list of pairs, such as [[\"lid.bottom\", \"box.top\"]]: a feature of the part, and one that it meets";

/// A mate as it is written: names only.
pub(super) struct Mate<'t, 's> {
    /// Index of the part that is placed.
    pub part: usize,
    /// Its kinematic displacement, and the freedom that it is in.
    motion: Option<(Pose, [[f64; 3]; 2])>,
    contacts: Vec<[Field<'t, 's>; 2]>,
    /// How holes lie in their play, if they float.
    float: Play,
    table: Field<'t, 's>,
}

/// How holes lie in their play on pins.
#[derive(Clone, Copy)]
enum Play {
    /// By the scene's rule for zones.
    General,
    /// By this one.
    Rule(ZoneRule),
    /// Centred.
    None,
}

/// Reads the mates, in an order in which each rests on parts that are placed, and sets the nominal poses of `parts`.
pub(super) fn mates<'t, 's>(root: &Field<'t, 's>, parts: &mut [Part<'t, 's>]) -> Result<Vec<Mate<'t, 's>>, SceneError> {
    let mut waiting = Vec::new();
    for table in tables(root, "mate")? {
        let mate = mate(&table, parts)?;
        if mate.part == 0 || waiting.iter().any(|other: &Mate| other.part == mate.part) {
            let field = table.get("part").unwrap_or(table);
            let problem = Problem::PlacedTwice(parts[mate.part].name.to_owned());
            return Err(field.error(problem, "one mate for each part but the first, which stays where it is"));
        }
        waiting.push(mate);
    }
    for (i, part) in parts.iter().enumerate().skip(1) {
        if waiting.iter().all(|mate| mate.part != i) {
            let problem = Problem::NotPlaced(part.name.to_owned());
            return Err(part.field.error(problem, "one mate for each part but the first, which stays where it is"));
        }
    }
    let mut placed = vec![false; parts.len()];
    placed.iter_mut().take(1).for_each(|first| *first = true);
    let mut ordered = Vec::new();
    while !waiting.is_empty() {
        let rests = |mate: &Mate| -> Result<bool, SceneError> {
            let mut parts = mate.contacts.iter().map(|[_, other]| part::part_of(other, parts));
            parts.try_fold(true, |all, part| Ok(all && placed[part?]))
        };
        let ready: Vec<bool> = waiting.iter().map(rests).collect::<Result<_, _>>()?;
        let Some(next) = ready.iter().position(|ready| *ready) else {
            let names: Vec<_> = waiting.iter().map(|mate| parts[mate.part].name).collect();
            let problem = Problem::Loop(names.join(", "));
            return Err(waiting[0].table.error(problem, "mates that lead back to the first part"));
        };
        let mut mate = waiting.remove(next);
        // What the part rests on takes it along.
        let carrier = mate.contacts.first().map_or(Ok(0), |[_, other]| part::part_of(other, parts))?;
        let motion = mate.motion.map_or(Pose::IDENTITY, |(pose, _)| pose);
        if let Some((_, freedom)) = &mut mate.motion {
            *freedom = freedom.map(|vector| parts[carrier].motion.direction(vector));
        }
        let drawn = parts[mate.part].pose;
        parts[mate.part].motion = parts[carrier].motion.after(&motion);
        parts[mate.part].pose = parts[mate.part].motion.after(&drawn);
        placed[mate.part] = true;
        ordered.push(mate);
    }
    Ok(ordered)
}

fn mate<'t, 's>(table: &Field<'t, 's>, parts: &[Part]) -> Result<Mate<'t, 's>, SceneError> {
    let field = table.require("part", "the name of a part")?;
    let name = field.to_text()?;
    let part = parts.iter().position(|part| part.name == name).ok_or_else(|| {
        let names: Vec<_> = parts.iter().map(|part| part.name).collect();
        field.error(Problem::UnknownName { of: "part".into(), name: name.into() }, names.join(", "))
    })?;
    let list = table.require("contacts", CONTACTS)?;
    let Value::List(nodes) = &list.node.value else { return Err(list.wrong_type(CONTACTS)) };
    let mut contacts = Vec::new();
    for node in nodes {
        let pair = Field { key: list.key.clone(), node };
        let Value::List(nodes) = &pair.node.value else { return Err(pair.wrong_type(CONTACTS)) };
        let [own, other] = &nodes[..] else {
            return Err(pair.error(Problem::Length { key: pair.key.clone(), found: nodes.len() }, CONTACTS));
        };
        contacts.push([own, other].map(|node| Field { key: list.key.clone(), node }));
    }
    let motion = match (table.get("move"), table.get("turn")) {
        (Some(_), Some(turn)) => {
            let problem = Problem::Unsupported { what: "a move and a turn in one mate".into() };
            return Err(turn.error(problem, "one of them; a part between takes the other"));
        }
        (Some(table), None) => {
            let along = direction(&table, "along")?;
            let by = table.number("by", &POSITION)?;
            Some((Pose::shift(along.map(|x| x * by)), [along, [0.0; 3]]))
        }
        (None, Some(table)) => {
            let about = direction(&table, "about")?;
            let at = table.get("at").map(|at| at.to_numbers(&POSITION)).transpose()?.unwrap_or_default();
            Some((Pose::turn(at, about, table.number("by", &ANGLE)?), [[0.0; 3], about]))
        }
        (None, None) => None,
    };
    let float = match table.get("float") {
        None => Play::General,
        Some(field) if matches!(&field.node.value, Value::Text(text) if text == "none") => Play::None,
        Some(field) => Play::Rule(rule(&field)?),
    };
    Ok(Mate { part, motion, contacts, float, table: table.clone() })
}

/// Adds the placement of a mate to the assembly in the `draft`.
pub(super) fn place(mate: &Mate, parts: &[Part], draft: &mut Draft) -> Result<(), SceneError> {
    let mut contacts = Vec::new();
    for [own_field, other_field] in &mate.contacts {
        let (own, other) = (draft.feature(own_field)?, draft.feature(other_field)?);
        if part::part_of(own_field, parts)? != mate.part {
            let name = parts[mate.part].name;
            let problem =
                Problem::UnknownName { of: format!("feature of `{name}`"), name: own_field.to_text()?.into() };
            return Err(own_field.error(problem, CONTACTS));
        }
        if part::part_of(other_field, parts)? == mate.part {
            let problem = Problem::Loop(parts[mate.part].name.to_owned());
            return Err(other_field.error(problem, "a feature of another part"));
        }
        let features = &draft.assembly.features;
        let (one, two) = (&features[own], &features[other]);
        let contact = Contact::new(one.shape, two.shape, two.nominal[1], one.reach).ok_or_else(|| {
            let what = format!("a contact of {} and {}", one.shape.article(), two.shape.article());
            other_field.error(
                Problem::Unsupported { what },
                "plane and plane, plane and point, axis and axis, point and point",
            )
        })?;
        if point_the_same_way(one, two) {
            let [own, other] = [own, other].map(|feature| draft.feature_names[feature].as_str());
            own_field.warn(&format!(
                "the normals of {own} and {other}, which meet, point the same way: one of them points into the material"
            ));
        }
        let float = float(mate.float, [own, other], contacts.is_empty(), draft);
        contacts.push(Joined::new(contact, Own::Made(own), other, float, Order::LeastSquares));
    }
    if let Some(field) = mate.table.get("float").filter(|_| contacts.iter().all(|joined| joined.float.is_none())) {
        return Err(field.no_effect("in this mate", "a mate of a hole on a pin, both with a diameter"));
    }
    let fixed: Vec<_> = mate.motion.iter().map(|(_, freedom)| *freedom).collect();
    let members = draft.parts_of_features.iter().enumerate().filter(|(_, part)| **part == mate.part);
    let carried = members.map(|(feature, _)| Carried { feature, with: With::All }).collect();
    let nominal: Vec<_> = draft.nominal.iter().map(|value| Lanes::splat(*value)).collect();
    let placement = Placement::on_contacts(&draft.assembly, &nominal, contacts, &fixed, carried).map_err(|error| {
        let field = match error {
            PlacementError::Over(i) => match mate.contacts.get(i) {
                Some([own, _]) => own.clone(),
                None => mate.table.get("move").or(mate.table.get("turn")).unwrap_or(mate.table.clone()),
            },
            _ => mate.table.get("part").unwrap_or(mate.table.clone()),
        };
        let allowed = match error {
            PlacementError::Over(_) => {
                "contacts that each hold something: 3, 2 and 1 freedoms of three planes, 1 of a point"
            }
            PlacementError::Open => "features that meet where the drawing has them, or nearly",
            _ => "contacts that hold all six, or a `move` or `turn` for the one that is meant to be free",
        };
        let part = parts[mate.part].name.to_owned();
        field.error(Problem::Placement { part, error }, allowed)
    })?;
    if let Some([shift, turn]) = placement.drawn_off() {
        let [shift, turn] = [shift * 1e3, turn.to_degrees()].map(|x| ten_digits((x * 1e6).round() / 1e6));
        mate.table.get("part").unwrap_or(mate.table.clone()).warn(&format!(
            "the part {} is drawn off the features that place it, shifted by {shift} mm and turned by {turn}°: also the \
             nominal values are those where it meets them",
            parts[mate.part].name
        ));
    }
    draft.assembly.placements.push(placement);
    Ok(())
}

/// Whether the outward normals of two faces, or of a face and a point on a face, that meet point to the same side.
fn point_the_same_way(one: &Feature, two: &Feature) -> bool {
    let along: f64 = one.nominal[1].iter().zip(two.nominal[1]).map(|(a, b)| a * b).sum();
    let is_face = [one.shape, two.shape].contains(&Shape::Plane);
    is_face && along > 1e-3
}

/// The play of two axes that both have a diameter: a contributor of its own. The `first` contact of a mate also holds tilts, which
/// have the same play.
fn float(play: Play, [own, other]: [usize; 2], first: bool, draft: &mut Draft) -> Option<Float> {
    let [one, two] = [own, other].map(|feature| draft.diameters[feature]);
    let (one, two) = (one?, two?);
    let own_is_hole = one.hole.or(two.hole.map(|hole| !hole)).unwrap_or(one.middle() >= two.middle());
    let (hole, pin) = if own_is_hole { (one, two) } else { (two, one) };
    let name = [own, other].map(|feature| draft.feature_names[feature].as_str());
    let name = if own_is_hole { name.join(" on ") } else { name.join(" in ") };
    let rule = match play {
        Play::General => Some(draft.defaults.rule),
        Play::Rule(rule) => Some(rule),
        Play::None => None,
    };
    let [reach, least] = [own, other].map(|feature| draft.assembly.features[feature].reach);
    let tilt = if first { reach / reach.min(least) } else { 0.0 };
    let diameters = [hole, pin].map(|diameter| (Size::Actual(diameter.variable), diameter.middle()));
    let float = floating(format!("{name} play"), Some(draft.fits.len()), diameters, rule, tilt, draft);
    let variables = float.first.map_or(0..0, |at| at..draft.nominal.len());
    draft.fits.push(Fit { name, float: variables, least: hole.limits[0] - pin.limits[1] });
    Some(float)
}
