//! Reads datums: single ones, common ones (A-B), and systems of them.

use slipfit_tolerance::{
    numeric::lanes::Lanes,
    product::{
        assembly::{Carried, Placement, With},
        common::Common,
        contact::{Contact, cross, norm},
        contacts::{Joined, Own, describe},
        feature::Shape,
        float::{Float, Size},
    },
};

use crate::scene::{Problem, SceneError, tree::Value, value::Field};

use super::{
    draft::{Datum, Draft},
    float::floating,
    material,
};

/// The datums of the list, or the only one: features of the part of `feature` that stand above.
pub(super) fn datums(list: &Field, draft: &mut Draft) -> Result<Vec<Datum>, SceneError> {
    const ALLOWED: &str = "one to three datums, the primary first";
    let nodes = match &list.node.value {
        Value::List(nodes) => nodes.iter().map(|node| Field { key: list.key.clone(), node }).collect(),
        Value::Text(_) => vec![list.clone()],
        _ => return Err(list.wrong_type(ALLOWED)),
    };
    if nodes.is_empty() || nodes.len() > 3 {
        let problem = Problem::Length { key: list.key.clone(), found: nodes.len() };
        return Err(list.error(problem, ALLOWED));
    }
    let mut datums: Vec<Datum> = Vec::new();
    for field in &nodes {
        let datum = one(field, draft)?;
        if datums.iter().any(|known| known.feature == datum.feature) {
            let what = format!("the datum `{}` twice", draft.feature_names[datum.feature]);
            return Err(field.error(Problem::Unsupported { what }, "each feature once"));
        }
        datums.push(datum);
    }
    Ok(datums)
}

/// One datum, of one feature or of two.
fn one(field: &Field, draft: &mut Draft) -> Result<Datum, SceneError> {
    let plain = |feature| Datum { feature, material: None };
    if let Value::List(nodes) = &field.node.value {
        let [one, two] = &nodes[..] else {
            let problem = Problem::Length { key: field.key.clone(), found: nodes.len() };
            return Err(field.error(problem, "two features that are one datum"));
        };
        let [one, two] = [one, two].map(|node| Field { key: field.key.clone(), node });
        let pair = [draft.feature(&one)?, draft.feature(&two)?];
        return common(field, pair, draft).map(plain);
    }
    let (text, material) = material::of_datum(field)?;
    let known = |name: &str| draft.feature_names.iter().position(|known| known == name.trim());
    let of = |feature: usize| {
        if let Some(material) = material {
            let Some(diameter) = draft.diameters[feature] else {
                let what = format!("the datum `{text}` at {}", material.named());
                return Err(field.error(Problem::Unsupported { what }, material::SIZED));
            };
            material.limit(&diameter, text, field)?;
        }
        Ok(Datum { feature, material })
    };
    if let Some(feature) = known(text) {
        return of(feature);
    }
    // A name may have a hyphen itself.
    let pair = text.match_indices('-').find_map(|(at, _)| Some([known(&text[..at])?, known(&text[at + 1..])?]));
    match pair {
        Some(_) if material.is_some() => {
            let problem = Problem::Unsupported { what: "a common datum at a condition of material".into() };
            Err(field.error(problem, "one feature, or no condition"))
        }
        Some(pair) => common(field, pair, draft).map(plain),
        None => of(draft.feature_called(text, field)?),
    }
}

/// The datum that two features are together; it is a feature of their part.
fn common(field: &Field, pair: [usize; 2], draft: &mut Draft) -> Result<usize, SceneError> {
    let name = pair.map(|i| draft.feature_names[i].as_str()).join("-");
    if let Some(known) = draft.feature_names.iter().position(|known| *known == name) {
        return Ok(known);
    }
    let [one, two] = pair.map(|i| draft.parts_of_features[i]);
    if one != two {
        let problem = Problem::Unsupported { what: "a common datum of two parts".into() };
        return Err(field.error(problem, "two features of the same part"));
    }
    let index = draft.assembly.features.len();
    let (datum, feature) = Common::new(&draft.assembly.features, pair, index).map_err(|error| {
        let problem = Problem::Unsupported { what: error.to_string() };
        field.error(problem, "two faces in one plane, or two coaxial axes")
    })?;
    let face = draft.faces[pair[0]];
    draft.faces.push(face);
    draft.assembly.features.push(feature);
    draft.feature_names.push(name);
    draft.parts_of_features.push(one);
    draft.diameters.push(None);
    draft.common.push(index);
    draft.assembly.placements.push(Placement::common(datum));
    Ok(index)
}

/// A motion in words that the `datums` leave a frame and that moves the feature `index` in its zone; `None` where there is none.
/// Its tilts count if `tilts`, and of its place only the shift `along` a direction where that is given.
pub(super) fn left_free(
    index: usize,
    datums: &[Datum],
    tilts: bool,
    along: Option<[f64; 3]>,
    draft: &Draft,
) -> Option<String> {
    let (_, placement) = draft.datum_systems.iter().find(|(known, _)| known == datums)?;
    let (motions, centre) = draft.assembly.placements[*placement].free(&draft.assembly.features);
    let feature = &draft.assembly.features[index];
    let [place, direction] = feature.nominal;
    let arm = [0, 1, 2].map(|i| place[i] - centre[i]);
    let moves = |[shift, turn]: &[[f64; 3]; 2]| {
        let size = norm(*shift) + norm(*turn) * (norm(arm) + feature.reach);
        let turned = cross(*turn, arm);
        let shift = [0, 1, 2].map(|i| shift[i] + turned[i]);
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let off = match (along, feature.shape) {
            (Some(along), _) => dot(shift, along).abs(),
            (None, Shape::Axis) => norm(cross(shift, direction)),
            (None, _) => dot(shift, direction).abs(),
        };
        let tilted = norm(cross(*turn, direction)) * feature.reach;
        off > NEGLIGIBLE * size || tilts && tilted > NEGLIGIBLE * size
    };
    motions.iter().find(|motion| moves(motion)).map(|motion| describe(motion.as_flattened()))
}

/// The part of a motion that is none.
const NEGLIGIBLE: f64 = 1e-6;

/// Lets the feature `index` go where its datums go.
pub(super) fn carry(
    index: usize,
    datums: &[Datum],
    with: With,
    table: &Field,
    draft: &mut Draft,
) -> Result<(), SceneError> {
    let carried = Carried { feature: index, with };
    let part = draft.parts_of_features[index];
    if let Some(foreign) = datums.iter().find(|datum| draft.parts_of_features[datum.feature] != part) {
        let what = format!("the datum `{}` of another part", draft.feature_names[foreign.feature]);
        return Err(table.error(Problem::Unsupported { what }, "a datum of the same part"));
    }
    if let Some((_, placement)) = draft.datum_systems.iter().find(|(known, _)| known == datums) {
        draft.assembly.placements[*placement].carry(carried);
        return Ok(());
    }
    let placement = match datums {
        [plane] if draft.assembly.features[plane.feature].shape == Shape::Plane => {
            Placement::on_plane(plane.feature, carried)
        }
        _ => {
            let mut contacts = Vec::new();
            for (number, Datum { feature: datum, .. }) in datums.iter().enumerate() {
                let float = shift(*datum, datums, table, draft)?;
                let feature = &draft.assembly.features[*datum];
                let contact = Contact::new(feature.shape, feature.shape, feature.nominal[1], feature.reach);
                let order = draft.defaults.frames.order(number);
                contacts
                    .extend(contact.map(|contact| Joined::new(contact, Own::Perfect(*datum), *datum, float, order)));
            }
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

/// How a datum shifts in its boundary, in a system of `datums`, if it is referenced at a condition of material.
fn shift(datum: usize, datums: &[Datum], table: &Field, draft: &mut Draft) -> Result<Option<Float>, SceneError> {
    let at = |datum: &&Datum| datum.material.is_some();
    let Some(material) = datums.iter().find(|known| known.feature == datum).filter(at).and_then(|d| d.material) else {
        return Ok(None);
    };
    let Some(diameter) = draft.diameters[datum] else { return Ok(None) };
    let name = &draft.feature_names[datum];
    let diameters = material::boundary(table, name, material, &diameter)?;
    let names: Vec<_> = datums.iter().map(|datum| draft.feature_names[datum.feature].as_str()).collect();
    let name = format!("{name} shift in {}", names.join("|"));
    let tilt = if datums[0].feature == datum { 1.0 } else { 0.0 };
    let middles = diameters.map(|size| match size {
        Size::Actual(_) => diameter.middle(),
        Size::Boundary(size) => size,
    });
    let rule = Some(draft.defaults.rule);
    Ok(Some(floating(name, None, [0, 1].map(|i| (diameters[i], middles[i])), rule, tilt, draft)))
}
