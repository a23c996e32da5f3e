//! Reads the tolerances of a feature: what moves it, and what it moves with.

use slipfit_tolerance::{
    model::ZoneRule,
    number::{fixed, ten_digits},
    product::{
        assembly::With,
        contact::{cross, unit},
        dimension::{self, Spread, Toleranced},
        feature::Shape,
        iso2768::{self, GeometryClass},
    },
};

use crate::scene::{Problem, SceneError, keys, tree::Value, value::Field};

use super::{
    datum::{carry, datums, left_free},
    defaults::rule,
    diameter::Material,
    draft::{Datum, Draft, FeatureDraft},
    geometric::{Callout, Limits, WIDTH, shift},
    material,
    pattern::{self, Pattern},
    slant::slant,
    symmetric, toleranced, vectorial, zone,
};

const ZONE: &str = "the width of its zone in mm, or { zone = …, datum = [\"…\"], rule = \"…\" }";

/// The geometric tolerances.
pub(super) const CALLOUTS: [&str; 14] = [
    "flatness",
    "straightness",
    "roundness",
    "cylindricity",
    "parallelism",
    "perpendicularity",
    "angularity",
    "position",
    "profile",
    "coaxiality",
    "concentricity",
    "symmetry",
    "run_out",
    "total_run_out",
];

/// Those that may be at a condition of material.
const MATERIAL: [&str; 5] = ["position", "coaxiality", "perpendicularity", "parallelism", "angularity"];

/// What a tolerance limits of a feature. Where a face runs out its place is free.
fn limits(callout: &str, shape: Shape) -> Limits {
    match callout {
        "flatness" => Limits::Form,
        "straightness" => Limits::Line,
        "roundness" | "cylindricity" => Limits::Surface,
        "position" | "profile" | "coaxiality" | "concentricity" | "symmetry" => Limits::Location,
        "run_out" | "total_run_out" if shape != Shape::Plane => Limits::Location,
        _ => Limits::Orientation,
    }
}

/// Reads the tolerances of a feature and adds it to the `draft`.
pub(super) fn read<'t, 's>(
    mut made: FeatureDraft<'t, 's>,
    patterns: &mut Vec<Pattern<'t, 's>>,
    draft: &mut Draft,
) -> Result<(), SceneError> {
    let none = |field: &Field| matches!(&field.node.value, Value::Text(text) if text == "none");
    let mut callouts = Vec::new();
    let mut formed = false;
    // A key that the feature cannot have is told of by then.
    let known = keys::of_feature(made.feature.shape);
    for name in CALLOUTS.into_iter().filter(|name| known.iter().any(|key| key.name == *name)) {
        let Some(field) = made.table.get(name) else { continue };
        // A straight line leaves the flatness of its face open.
        formed |= limits(name, made.feature.shape) != Limits::Line;
        if !none(&field) {
            callouts.push(callout(name, field, &made, patterns, draft)?);
        }
    }
    if let Some(field) = made.table.get("offset").filter(|field| !none(field)) {
        let size = toleranced::offset(&field, draft)?;
        let normal = made.feature.nominal[1];
        let along = made.coordinates[0];
        if size.nominal * along < 0.0 {
            let [along, offset] = [along, size.nominal].map(|x| ten_digits((x * 1e12).round() / 1e9));
            made.table.get("normal").unwrap_or(field).warn(&format!(
                "{} lies {along} mm along its normal from the origin of its part, and its offset is {offset} mm: the normal \
                 points into the material, or the offset has the wrong sign",
                made.name
            ));
        }
        made.feature.nominal[0] = [0, 1, 2].map(|i| made.feature.nominal[0][i] - size.nominal * normal[i]);
        shift(&mut made, "offset", &size, normal, draft);
    }
    formed |= vectorial::read(&mut made, draft)?;
    if let Some(class) = draft.defaults.general.geometry.filter(|_| !formed && made.feature.shape != Shape::Axis) {
        callouts.push(general_flatness(class, &made, draft)?);
    }
    let one = |of: fn(&Limits) -> bool| -> Result<Option<&Callout>, SceneError> {
        let mut found = callouts.iter().filter(|callout| of(&callout.limits));
        match (found.next(), found.next()) {
            (Some(first), Some(second)) => {
                let what = format!("{} beside {} of one feature", second.name, first.name);
                Err(second.field.error(Problem::Unsupported { what }, "one of them: the narrower one"))
            }
            (first, _) => Ok(first),
        }
    };
    let location = one(|limits| *limits == Limits::Location)?;
    let orientation = one(|limits| *limits == Limits::Orientation)?;
    let surfaces = callouts.iter().filter(|callout| callout.limits == Limits::Surface);
    let forms: Vec<_> =
        callouts.iter().filter(|callout| matches!(callout.limits, Limits::Form | Limits::Line)).collect();
    if let Some(location) = location {
        zone::located(&mut made, location, orientation, draft)?;
    } else if let Some(orientation) = orientation {
        zone::oriented(&mut made, orientation, draft);
    }
    if location.is_none() {
        general_place(&mut made, draft);
    }
    for surface in surfaces {
        match location.filter(|location| location.runs_out()) {
            None => zone::located(&mut made, surface, None, draft)?,
            Some(wider) => told_within(surface, wider, &made, draft),
        }
    }
    let flat = forms.iter().find(|form| form.limits == Limits::Form).copied();
    for form in &forms {
        let wider = location.or(orientation).or(flat.filter(|_| form.limits == Limits::Line));
        match wider {
            None => zone::formed(&mut made, form, draft),
            // What lies within a wider zone moves only what that leaves open.
            Some(wider) if wider.limits == Limits::Orientation && made.feature.shape == Shape::Plane => {
                zone::offset_within(&mut made, form, wider.width, draft);
            }
            Some(wider) => told_within(form, wider, &made, draft),
        }
    }

    if let Some(diameter) = &mut made.diameter {
        // What turns with the datums has the narrower zone.
        for (material, width) in
            [location, orientation].into_iter().flatten().filter_map(|callout| callout.at_condition())
        {
            diameter.own[material as usize] = width;
        }
    }

    let index = draft.assembly.features.len();
    if let Some(pattern) = location.and_then(|location| location.pattern) {
        patterns[pattern].add(index);
    }
    let frames =
        [location, orientation].map(|callout| callout.map(|callout| callout.datums.clone()).unwrap_or_default());
    let FeatureDraft { name, feature, part, table, sides, extents, diameter, .. } = made;
    draft.faces.push((sides, extents));
    draft.assembly.features.push(feature);
    draft.feature_names.push(name);
    draft.parts_of_features.push(part);
    draft.diameters.push(diameter);
    let [places, turns] = frames;
    if !places.is_empty() {
        let with = if turns.is_empty() || turns == places { With::All } else { With::Place };
        carry(index, &places, with, &table, draft)?;
    }
    if !turns.is_empty() && turns != places {
        carry(index, &turns, With::Direction, &table, draft)?;
    }
    warn_of_frames(index, location, orientation, draft);
    if let Some(orientation) = orientation {
        warn_of_angle(index, orientation, draft);
    }
    Ok(())
}

/// Warns of a parallelism or a perpendicularity between features that are drawn at another angle.
fn warn_of_angle(index: usize, callout: &Callout, draft: &Draft) {
    let Some(datum) = callout.datums.first().map(|datum| datum.feature) else { return };
    let is_parallel = callout.name == "parallelism";
    if !is_parallel && callout.name != "perpendicularity" {
        return;
    }
    if let Some(angle) = slant([index, datum].map(|feature| &draft.assembly.features[feature]), is_parallel) {
        let [own, datum] = [index, datum].map(|feature| &draft.feature_names[feature]);
        let angle = fixed(angle, 1);
        callout.field.warn(&format!("the {} of {own}: it is drawn at {angle}° to its datum {datum}", callout.name));
    }
}

/// Warns of datums that are missing, or do not hold the place that they are for. An orientation to a face leaves the turn about
/// the face's normal free by its nature.
fn warn_of_frames(index: usize, location: Option<&Callout>, orientation: Option<&Callout>, draft: &Draft) {
    let name = &draft.feature_names[index];
    let shape = draft.assembly.features[index].shape;
    let datums = |callout: Option<&Callout>| callout.is_some_and(|callout| !callout.datums.is_empty());
    let needs =
        |callout: &&Callout| callout.name == "position" || (callout.limits == Limits::Orientation && !datums(location));
    for callout in
        [location, orientation].into_iter().flatten().filter(needs).filter(|callout| callout.datums.is_empty())
    {
        callout.field.warn(&format!(
            "the {} of {name} has no datum: its zone lies where the drawing has it in the frame of the part",
            callout.name
        ));
    }
    let Some(location) = location.filter(|location| !location.datums.is_empty()) else { return };
    let along = (location.name == "symmetry" && shape == Shape::Axis)
        .then(|| draft.assembly.features[location.datums[0].feature].nominal[1]);
    // An orientation with datums of its own holds the tilts.
    let tilts = !datums(orientation)
        && along.is_none()
        && (shape == Shape::Plane || (shape == Shape::Axis && location.holds_tilts()));
    if let Some(motion) = left_free(index, &location.datums, tilts, along, draft) {
        location.field.warn(&format!(
            "the datums of the {} of {name} are an incomplete frame: they leave it free to {motion}, where the zone lies as drawn",
            location.name
        ));
    }
}

/// Warns of a form that moves nothing.
fn told_within(form: &Callout, wider: &Callout, made: &FeatureDraft, draft: &mut Draft) {
    draft.warnings.push(format!(
        "{}: {} beside {} moves nothing more: the feature moves as {} allows",
        made.name, form.name, wider.name, wider.name
    ));
}

/// Reads the tolerance `name` of a feature.
fn callout<'t, 's>(
    name: &'static str,
    field: Field<'t, 's>,
    made: &FeatureDraft,
    patterns: &mut Vec<Pattern<'t, 's>>,
    draft: &mut Draft,
) -> Result<Callout<'t, 's>, SceneError> {
    let limits = limits(name, made.feature.shape);
    let is_form = matches!(limits, Limits::Form | Limits::Line | Limits::Surface);
    let list = field.get("datum");
    if let Some(list) = list.as_ref().filter(|_| is_form) {
        let problem = Problem::Unsupported { what: format!("a datum of {}", field.key) };
        return Err(list.error(problem, "no datum: a form is its own"));
    }
    let datums = list.map_or(Ok(Vec::new()), |list| datums(&list, draft))?;
    let material = material::of_zone(&field)?;
    let width = width(&field, name, made, &datums, material, draft)?;
    symmetric::check(name, &field, &datums, made, draft)?;
    let rule_field = field.get("rule");
    let rule = rule_field.as_ref().map_or(Ok(draft.defaults.rule), rule)?;
    let mut read = Callout { name, limits, width, material, bonus: None, datums, rule, pattern: None, field };
    if let Some((pattern, within)) = pattern::of_callout(&read, width, made, patterns, draft)? {
        (read.pattern, read.width) = (Some(pattern), within);
    }
    let field = &read.field;
    read.bonus = match material {
        Some(_) if !MATERIAL.contains(&name) => {
            let problem = Problem::Unsupported { what: format!("{name} at a condition of material") };
            return Err(field.error(problem, MATERIAL.join(", ")));
        }
        Some(material) => Some(material::bonus(field, name, read.width, material, made)?),
        None => None,
    };
    let middle = made.diameter.map_or(0.0, |diameter| diameter.middle());
    read.width = read.bonus.map_or(read.width, |bonus| bonus.at(middle));
    if rule == ZoneRule::Translation && limits == Limits::Orientation && made.feature.shape == Shape::Plane {
        let what = format!("{name} by the rule translation");
        let allowed = "a rule with tilts: sigma-zone, truncated, uniform-in-zone";
        return Err(rule_field.as_ref().unwrap_or(field).error(Problem::Unsupported { what }, allowed));
    }
    Ok(read)
}

/// The general tolerance of the place of a feature whose drawing says nothing of it: that of its distance from the origin of its
/// part, in which drawings count. What lies in the origin is where it is.
fn general_place(made: &mut FeatureDraft, draft: &mut Draft) {
    let Some(class) = draft.defaults.general.size else { return };
    let vectorial = made.table.get("vectorial").is_some_and(|table| table.get("position").is_some());
    if vectorial || made.table.get("offset").is_some() {
        return;
    }
    let ([along, one, two], [first, second]) = (made.coordinates, made.sides);
    let across: &[_] = match made.feature.shape {
        Shape::Axis => &[("place 1", one, first), ("place 2", two, second)],
        _ => &[("place", along, made.feature.nominal[1])],
    };
    for (name, distance, direction) in across {
        // The digits that turning made up would push a length over the end of its band.
        let distance = (distance.abs() * 1e12).round() / 1e12;
        let shape = dimension::Shape::Normal(Spread::sigmas(draft.defaults.sigma));
        let half = iso2768::linear(class, distance).ok();
        if let Some(Ok(place)) = half.map(|half| Toleranced::new(0.0, [-half, half], &shape)) {
            shift(made, name, &place, *direction, draft);
        }
    }
}

/// The general flatness of a feature whose drawing says nothing.
fn general_flatness<'t, 's>(
    class: GeometryClass,
    made: &FeatureDraft<'t, 's>,
    draft: &Draft,
) -> Result<Callout<'t, 's>, SceneError> {
    let key = format!("{}.extents", made.table.key);
    let missing = || made.table.error(Problem::Missing(key), "extents of its face, flatness, or flatness = \"none\"");
    let [a, b] = made.extents.ok_or_else(missing)?;
    let field = made.table.get("extents").unwrap_or(made.table.clone());
    let width = iso2768::flatness(class, a.max(b)).map_err(|error| toleranced::band(&field, error))?;
    let rule = draft.defaults.rule;
    Ok(Callout {
        name: "flatness",
        limits: Limits::Form,
        width,
        material: None,
        bonus: None,
        datums: Vec::new(),
        rule,
        pattern: None,
        field,
    })
}

/// The width (m) of a zone, stated or general.
fn width(
    field: &Field,
    callout: &str,
    made: &FeatureDraft,
    datums: &[Datum],
    material: Option<Material>,
    draft: &Draft,
) -> Result<f64, SceneError> {
    let stated = match field.node.value {
        Value::Table(_) => field.get("zone"),
        _ => Some(field.clone()),
    };
    if let Some(zone) = stated {
        material::refuse_in_width(&zone)?;
        // Zero at maximum material: all that the axis may vary is bonus.
        return if material.is_some() { zone.to_number(&WIDTH) } else { toleranced::positive(&zone, &WIDTH) };
    }
    let missing = || field.error(Problem::Missing(format!("{}.zone", field.key)), ZONE);
    let class = draft.defaults.general.geometry.ok_or_else(missing)?;
    if callout == "run_out" {
        return Ok(iso2768::run_out(class));
    }
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
fn shorter_leg(made: &FeatureDraft, extents: [f64; 2], datums: &[Datum], draft: &Draft) -> f64 {
    let leg = |shape: Shape, line: [f64; 3], sides: [[f64; 3]; 2], extents: [f64; 2]| {
        let across = |side: [f64; 3]| cross(side, line).iter().map(|x| x * x).sum::<f64>();
        let [a, b] = [0, 1].map(|i| extents[i] * libm::sqrt(across(sides[i])));
        if shape == Shape::Axis { extents[0] } else { a + b }
    };
    let of_datum = |Datum { feature: datum, .. }: &Datum| {
        let feature = &draft.assembly.features[*datum];
        let line = unit(cross(made.feature.nominal[1], feature.nominal[1]))?;
        let own = leg(made.feature.shape, line, made.sides, extents);
        let (sides, size) = draft.faces[*datum];
        Some(size.map_or(own, |size| own.min(leg(feature.shape, line, sides, size))))
    };
    datums.iter().filter_map(of_datum).fold(extents[0].max(extents[1]), f64::min)
}
