//! The pins of a scene and their gaps: statistics as they stand, or the name of a measure that has them.

use slipfit_core::{clearance::GapStatistics, slide::PINS};
use slipfit_tolerance::model::{Model, Quantity as Kind, Sum};
use slipfit_tolerance::unit::{self, Quantity};

use super::{Problem, SceneError, quantity::POINT, tree::Value, value::Field};
use crate::setup::{GapMeasures, PinSpec, SURFACES};

/// The mean of a gap.
pub(super) const MEAN: Quantity = Quantity { units: unit::LENGTH, range: [-100.0, 100.0] };
const DEVIATION: Quantity = Quantity { units: unit::LENGTH, range: [0.0, 100.0] };

/// Gives the gaps that are measures the measures' `statistics`.
pub(super) fn fill(pins: &mut [PinSpec; PINS], measures: &GapMeasures, statistics: &[GapStatistics<f64>]) {
    for (gap, measure) in pins.iter_mut().flat_map(|pin| &mut pin.gaps).zip(measures.iter().flatten()) {
        if let Some(index) = measure {
            *gap = statistics.get(*index).copied();
        }
    }
}

/// The two gaps of a pin that face each other and are measures, as sums that must stay positive.
pub(super) fn sums<'a>(pins: &'a [PinSpec; PINS], measures: &'a GapMeasures) -> impl Iterator<Item = Sum> + 'a {
    pins.iter().zip(measures).flat_map(|(pin, &[left, right, rail, wall])| {
        [("across", left, right), ("up-down", rail, wall)].into_iter().filter_map(|(direction, one, two)| {
            Some(Sum { name: format!("{} {direction}", pin.name), measures: vec![one?, two?] })
        })
    })
}

/// Reads the pins. Gaps that are measures of `model` are left out of them.
pub(super) fn pins(root: &Field, model: Option<&Model>) -> Result<([PinSpec; PINS], GapMeasures), SceneError> {
    const ALLOWED: &str = "one to four tables [[pin]]";
    let list = root.require("pin", ALLOWED)?;
    let Value::List(nodes) = &list.node.value else { return Err(list.wrong_type(ALLOWED)) };
    let wrong_length = |node: Field| node.error(Problem::Length { key: "pin".into(), found: nodes.len() }, ALLOWED);
    if nodes.is_empty() {
        return Err(wrong_length(list));
    }
    let mut pins = std::array::from_fn(|_| PinSpec { name: String::new(), position: [0.0; 3], gaps: [None; 4] });
    let mut measures = [[None; 4]; PINS];
    for (i, node) in nodes.iter().enumerate() {
        let table = Field { key: "pin".into(), node };
        let (found, of_measures) = match pin(&table, model) {
            Ok(read) => read,
            Err(error) => {
                // Reading goes on, with a pin somewhere else in its place.
                table.found().note(error);
                (PinSpec { position: [1.0 + i as f64, 0.0, 0.0], name: format!("\0{i}"), gaps: [None; 4] }, [None; 4])
            }
        };
        if pins.iter().take(i).any(|other| other.name == found.name) {
            let name = table.get("name").unwrap_or(table.clone());
            let problem = Problem::OutOfRange { key: "pin.name".into(), written: format!("\"{}\" again", found.name) };
            name.found().note(name.error(problem, "a name of its own for each pin"));
        }
        if let Some(other) = pins.iter().take(i).find(|other| other.position == found.position) {
            let position = table.get("position").unwrap_or(table);
            let written = format!("{}, where the pin \"{}\" is", position.written("mm"), other.name);
            let problem = Problem::OutOfRange { key: "pin.position".into(), written };
            position.found().note(position.error(problem, "a place of its own for each pin"));
        }
        *pins.get_mut(i).ok_or_else(|| wrong_length(Field { key: "pin".into(), node }))? = found;
        measures[i] = of_measures;
    }
    Ok((pins, measures))
}

fn pin(table: &Field, model: Option<&Model>) -> Result<(PinSpec, [Option<usize>; 4]), SceneError> {
    table.expect_table()?;
    let name = table.require("name", "a text in quotes, such as \"left front\"")?.to_text()?.into();
    let (mut gaps, mut measures) = ([None; 4], [None; 4]);
    for ((gap, measure), surface) in gaps.iter_mut().zip(&mut measures).zip(SURFACES) {
        match table.get(surface) {
            Some(field) if matches!(field.node.value, Value::Text(_)) => *measure = Some(length(&field, model)?),
            Some(field) => *gap = Some(statistics(&field, &MEAN)?),
            None => {}
        }
    }
    Ok((PinSpec { name, position: table.numbers("position", &POINT)?, gaps }, measures))
}

/// The index of the measure that `field` names, a length.
pub(super) fn length(field: &Field, model: Option<&Model>) -> Result<usize, SceneError> {
    let name = field.to_text()?;
    let measures = model.map(|model| &model.measures[..]).unwrap_or_default();
    let at = measures.iter().position(|measure| measure.name == name && measure.quantity == Kind::Length);
    at.ok_or_else(|| {
        let lengths = measures.iter().filter(|measure| measure.quantity == Kind::Length);
        let names: Vec<_> = lengths.map(|measure| measure.name.as_str()).collect();
        let measures = match names.is_empty() {
            true => "a measure, of which the scene has none that is a length".to_owned(),
            false => format!("a measure that is a length: {}", names.join(", ")),
        };
        let allowed = format!("[mean, standard deviation] in mm, or {measures}");
        field.error(Problem::UnknownName { of: "measure".into(), name: name.into() }, allowed)
    })
}

/// Reads mean, a `quantity`, and standard deviation of a gap.
pub(super) fn statistics(field: &Field, quantity: &Quantity) -> Result<GapStatistics<f64>, SceneError> {
    const ALLOWED: &str = "[mean, standard deviation] in mm";
    let Value::List(nodes) = &field.node.value else { return Err(field.wrong_type(ALLOWED)) };
    let [mean, deviation] = &nodes[..] else {
        return Err(field.error(Problem::Length { key: field.key.clone(), found: nodes.len() }, ALLOWED));
    };
    let number = |node, quantity| Field { key: field.key.clone(), node }.to_number(quantity);
    Ok(GapStatistics { mean: number(mean, quantity)?, deviation: number(deviation, &DEVIATION)? })
}
