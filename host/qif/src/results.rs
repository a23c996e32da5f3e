//! Measurement results (MeasurementResultsType) as a table of measured parts.

use std::collections::{HashMap, HashSet};

use roxmltree::Node;
use slipfit_measured::{
    table::{Column, MeasuredTable},
    unit::Unit,
};

use crate::{
    error::{Problem, QifError},
    format::twelve_digits,
    units::Units,
    words,
    xml::{self, child, children, error_at, ids, is_true, name, number, path, text, text_of},
};

/// One value of a characteristic of a part: the characteristic item, the measured feature items, and which of the values that
/// the part has of both.
type Key = (String, Vec<String>, usize);

/// Reads the measured characteristics of all parts in a QIF 3.0 results file.
///
/// A column has the name of its characteristic item. Where items share a name, the kind of characteristic follows it; where a
/// part has several values of an item, so does their number. Values are as the file states them, in the unit of the first one.
/// Limits of a position at a condition of material are without its bonus.
///
/// # Errors
/// Text that is not QIF, values that are no numbers, references that lead nowhere, a file without measured values.
pub fn read(text: &str) -> Result<MeasuredTable, QifError> {
    let document = xml::parse(text)?;
    let root = document.root_element();
    if name(root) != "QIFDocument" {
        return Err(error_at(root, Problem::Root(words::one_line(name(root)))));
    }
    let units = Units::read(root)?;
    let set = path(root, &["Results", "MeasurementResultsSet"]);
    let set = set.ok_or_else(|| error_at(root, Problem::Nothing("measurement results")))?;
    let characteristics = Characteristics::of(root, &units);
    let mut table = Table::default();
    for results in children(set) {
        table.add(results, &characteristics)?;
    }
    if let Some((results, problem)) = table.unpaired() {
        let place = children(set).nth(results - 1).unwrap_or(set);
        return Err(error_at(place, problem));
    }
    if table.columns.is_empty() {
        return Err(error_at(set, Problem::Nothing("measured values")));
    }
    table.finish(root, &characteristics).map_err(|problem| error_at(set, problem))
}

/// The elements of the characteristics by their id.
struct Characteristics<'a, 'i> {
    units: &'a Units,
    lists: [HashMap<&'a str, Node<'a, 'i>>; 3],
}

/// What is known of a characteristic item.
struct Item<'a, 'i> {
    item: Node<'a, 'i>,
    nominal: Option<Node<'a, 'i>>,
    definition: Option<Node<'a, 'i>>,
}

impl<'a, 'i> Characteristics<'a, 'i> {
    fn of(root: Node<'a, 'i>, units: &'a Units) -> Self {
        let list = |list: &str| path(root, &["Characteristics", list]).into_iter().flat_map(children);
        let by_id = |name: &str| list(name).filter_map(|node| Some((node.attribute("id")?, node))).collect();
        let lists = ["CharacteristicItems", "CharacteristicNominals", "CharacteristicDefinitions"].map(by_id);
        Self { units, lists }
    }

    fn item(&self, id: &str) -> Option<Item<'a, 'i>> {
        let [items, nominals, definitions] = &self.lists;
        let item = *items.get(id)?;
        let nominal = text_of(item, "CharacteristicNominalId").and_then(|id| nominals.get(id)).copied();
        let of = nominal.and_then(|nominal| text_of(nominal, "CharacteristicDefinitionId"));
        Some(Item { item, nominal, definition: of.and_then(|id| definitions.get(id)).copied() })
    }

    /// Unit of a value or a limit; an angle is recognised by its attribute, or by the kind of its characteristic.
    fn unit(&self, value: Node, is_angle: bool) -> (Unit, f64) {
        let known = |unit: &str| unit.parse().unwrap_or(Unit::None);
        if is_angle || value.attribute("angularUnit").is_some() {
            let unit = value.attribute("angularUnit").unwrap_or(&self.units.angle);
            let unit = if unit.is_empty() { Unit::Radian } else { known(unit) };
            return (unit, 1.0);
        }
        match self.units.scale(value) {
            Ok(scale) => (unit_of(scale), scale),
            Err(_) => (Unit::None, 1.0),
        }
    }
}

/// The unit of which one is `scale` mm.
fn unit_of(scale: f64) -> Unit {
    let units = [(1.0, Unit::Millimetre), (25.4, Unit::Inch), (1e3, Unit::Metre), (1e-3, Unit::Micrometre)];
    let is = |known: f64| (scale - known).abs() <= 1e-9 * known;
    units.iter().find(|(known, _)| is(*known)).map_or(Unit::None, |(_, unit)| *unit)
}

/// A column in the making.
struct Made {
    key: Key,
    kind: String,
    unit: Unit,
    /// mm for one unit of a length.
    scale: f64,
    is_angle: bool,
    values: Vec<Option<f64>>,
}

#[derive(Default)]
struct Table {
    /// Parts: number of the results, and actual component if that is stated.
    parts: Vec<(usize, Option<String>)>,
    results: usize,
    columns: Vec<Made>,
    index: HashMap<Key, usize>,
    /// How many values each part has of an item and measured feature items.
    counts: HashMap<(String, Vec<String>), HashMap<usize, usize>>,
}

impl Table {
    /// A part with fewer values of an item than others have, of which nothing says which of them it lacks: number of its results, and
    /// what is wrong.
    fn unpaired(&self) -> Option<(usize, Problem)> {
        let mut found: Vec<_> = self.counts.iter().filter_map(|((item, _), of_parts)| {
            let most = *of_parts.values().max()?;
            let (part, count) = of_parts.iter().filter(|(_, count)| **count < most).min()?;
            let results = self.parts.get(*part)?.0;
            let item = words::one_line(item);
            let why = format!("the characteristic item {item} has {count} of the {most} values that other parts have, and nothing says which");
            Some((results, why))
        }).collect();
        found.sort();
        found.into_iter().next().map(|(results, why)| (results, Problem::Table(why)))
    }

    /// Adds the values of a MeasurementResults: those of one part, or of several actual components.
    fn add(&mut self, results: Node, known: &Characteristics) -> Result<(), QifError> {
        self.results += 1;
        let features = child(results, "MeasuredFeatures").into_iter().flat_map(children);
        let features: HashMap<&str, &str> =
            features.filter_map(|node| Some((node.attribute("id")?, text_of(node, "FeatureItemId")?))).collect();
        let of_all = ids(results, "ActualComponentIds");
        let of_all = if let [only] = of_all[..] { Some(only) } else { None };
        let mut seen: HashMap<(usize, String, Vec<String>), usize> = HashMap::new();
        let measured = path(results, &["MeasuredCharacteristics", "CharacteristicMeasurements"]);
        for measurement in measured.into_iter().flat_map(children) {
            let Some(value) = child(measurement, "Value") else { continue };
            let id = text(xml::require(measurement, "CharacteristicItemId")?);
            let component = text_of(measurement, "ActualComponentId").or(of_all).map(str::to_owned);
            let part = (self.results, component);
            let part = match self.parts.iter().rposition(|known| *known == part) {
                Some(part) => part,
                None => {
                    self.parts.push(part);
                    self.parts.len() - 1
                }
            };
            let items = ids(measurement, "FeatureMeasurementIds");
            let items: Vec<String> = items.iter().map(|id| (*features.get(id).unwrap_or(id)).to_owned()).collect();
            let count = seen.entry((part, id.to_owned(), items.clone())).or_default();
            let key = (id.to_owned(), items, *count);
            *count += 1;
            self.counts.entry((key.0.clone(), key.1.clone())).or_default().insert(part, *count);
            let kind = words::kind(name(measurement));
            if known.item(id).is_none() {
                let problem = Problem::Reference { element: name(measurement).to_owned(), id: words::one_line(id) };
                return Err(error_at(measurement, problem));
            }
            self.put(part, key, kind, value, known)?;
        }
        Ok(())
    }

    fn put(&mut self, part: usize, key: Key, kind: &str, value: Node, known: &Characteristics) -> Result<(), QifError> {
        let is_angle = kind.starts_with("Angle") || kind.starts_with("Angular") && kind != "Angularity";
        let is_length = !kind.starts_with("UserDefined") || kind == "UserDefinedLinear";
        if is_length && !is_angle && value.attribute("linearUnit").is_some() {
            known.units.scale(value)?;
        }
        let (unit, scale) = if is_length { known.unit(value, is_angle) } else { (Unit::None, 1.0) };
        let column = *self.index.entry(key.clone()).or_insert_with(|| {
            let made = Made { key, kind: kind.to_owned(), unit, scale, is_angle, values: Vec::new() };
            self.columns.push(made);
            self.columns.len() - 1
        });
        let column = &mut self.columns[column];
        let stated = number(value)?;
        let stated = match (column.unit == unit, is_angle) {
            (true, _) => stated,
            (false, false) if column.unit != Unit::None && unit != Unit::None => {
                twelve_digits(stated * scale / column.scale)
            }
            _ => {
                let unit = value.attribute("linearUnit").or(value.attribute("angularUnit")).unwrap_or_default();
                return Err(error_at(value, Problem::Unit(words::one_line(unit))));
            }
        };
        column.values.resize(part.max(column.values.len()), None);
        match column.values.get_mut(part) {
            Some(place) => *place = Some(stated),
            None => column.values.push(Some(stated)),
        }
        Ok(())
    }

    fn finish(self, root: Node, known: &Characteristics) -> Result<MeasuredTable, Problem> {
        let names = names(&self.columns, known);
        let parts = self.parts.len();
        let mut columns = Vec::new();
        for (mut made, name) in self.columns.into_iter().zip(names) {
            made.values.resize(parts, None);
            let (nominal, limits) =
                known.item(&made.key.0).map_or((None, [None; 2]), |item| limits(&item, &made, known));
            columns.push(Column { name, unit: made.unit, nominal, limits, values: made.values });
        }
        let serial = serial_numbers(root);
        let label = |(_, component): &(usize, Option<String>)| {
            component.as_ref().and_then(|id| serial.get(id.as_str()).copied()).unwrap_or_default().to_owned()
        };
        let labels: Vec<_> = self.parts.iter().map(label).collect();
        let wrong = |error: slipfit_measured::table::TableError| Problem::Table(error.to_string());
        let table = MeasuredTable::new(columns).map_err(wrong)?;
        if labels.iter().any(|label| !label.is_empty()) { table.with_labels(labels).map_err(wrong) } else { Ok(table) }
    }
}

/// Serial numbers of the actual components by their id.
fn serial_numbers<'a>(root: Node<'a, '_>) -> HashMap<&'a str, &'a str> {
    let sets = path(root, &["Results", "ActualComponentSets"]).into_iter().flat_map(children);
    sets.flat_map(children).filter_map(|node| Some((node.attribute("id")?, text_of(node, "SerialNumber")?))).collect()
}

/// Names of the columns, each without a second.
fn names(columns: &[Made], known: &Characteristics) -> Vec<String> {
    let of_item = |id: &str| {
        let item = known.item(id)?.item;
        let designator = path(item, &["CharacteristicDesignator", "Designator"]).map(text);
        Some(words::one_line(text_of(item, "Name").or(designator)?)).filter(|name| !name.is_empty())
    };
    let own: Vec<_> = columns
        .iter()
        .map(|made| of_item(&made.key.0).unwrap_or_else(|| format!("{} {}", made.kind, made.key.0)))
        .collect();
    let mut items: HashMap<&str, HashSet<&str>> = HashMap::new();
    let mut values: HashMap<&str, usize> = HashMap::new();
    for (made, own) in columns.iter().zip(&own) {
        items.entry(own).or_default().insert(&made.key.0);
        *values.entry(&made.key.0).or_default() += 1;
    }
    let (mut numbers, mut taken) = (HashMap::<&str, usize>::new(), HashSet::new());
    let mut names = Vec::new();
    for (made, own) in columns.iter().zip(&own) {
        let is_shared = items[own.as_str()].len() > 1;
        let mut name = if is_shared { format!("{own} {}", made.kind) } else { own.clone() };
        let number = numbers.entry(&made.key.0).or_default();
        *number += 1;
        if values[made.key.0.as_str()] > 1 {
            name = format!("{name} ({number})");
        }
        if !taken.insert(name.clone()) {
            name = format!("{name} [{}]", made.key.0);
            taken.insert(name.clone());
        }
        names.push(name);
    }
    names
}

/// Nominal value and limits of a characteristic, in the unit of its column.
fn limits(item: &Item, made: &Made, known: &Characteristics) -> (Option<f64>, [Option<f64>; 2]) {
    let of = |node: Option<Node>| {
        let node = node?;
        let value = number(node).ok()?;
        if made.is_angle {
            return (known.unit(node, true).0 == made.unit).then_some(value);
        }
        if made.unit == Unit::None {
            return Some(value);
        }
        let mm = known.units.of_tolerance(node).ok()?;
        // A value in the unit of the column keeps all of its digits.
        let is_same = (known.units.millimetres(known.units.name_of_tolerance(node))? - made.scale).abs() < 1e-12;
        Some(if is_same { value } else { twelve_digits(mm / made.scale) })
    };
    let nominal = of(item.nominal.and_then(|nominal| child(nominal, "TargetValue")));
    let Some(definition) = item.definition else { return (nominal, [None; 2]) };
    if let Some(tolerance) = child(definition, "Tolerance") {
        let range = ["MinValue", "MaxValue"].map(|limit| of(child(tolerance, limit)));
        let is_absolute = is_true(tolerance, "DefinedAsLimit");
        let limits = range.map(|limit| if is_absolute { limit } else { Some(twelve_digits(nominal? + limit?)) });
        return (nominal, in_order(limits));
    }
    let Some(width) = of(child(definition, "ToleranceValue")) else { return (nominal, [None; 2]) };
    let limits = match name(definition) {
        // The value is the deviation along the normal.
        "PointProfileCharacteristicDefinition" => match child(definition, "UnequallyDisposedZone") {
            Some(_) => [None; 2],
            None => {
                let outer = child(definition, "OuterDisposition").map_or(Some(0.5 * width), |outer| of(Some(outer)));
                [outer.map(|outer| outer - width), outer]
            }
        },
        _ => [None, Some(width)],
    };
    let nominal = nominal.or((name(definition) == "PointProfileCharacteristicDefinition").then_some(0.0));
    (nominal, in_order(limits))
}

/// Limits that a value can keep.
fn in_order(limits: [Option<f64>; 2]) -> [Option<f64>; 2] {
    match limits {
        [Some(lower), Some(upper)] if lower >= upper => [None; 2],
        limits => limits,
    }
}
