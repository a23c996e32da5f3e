//! Reads `[measured]`: which dimensions and gaps have the distribution of measured parts.

pub(super) mod columns;
mod doubt;
pub mod file;

use std::path::{Path, PathBuf};

use slipfit_measured::{
    csv::Options,
    families::Kind,
    production::{Assumed, Characteristic, Production, ProductionError},
    table::MeasuredTable,
    unit::Unit,
};
use slipfit_tolerance::{model::Quantity as Measurand, number::ten_digits, unit::Quantity};

use self::columns::{Column, Columns};
use super::{
    Problem, SceneError,
    product::quantity::{of as quantity_of, units},
    tree::Value,
    value::Field,
};

const OF: &str = "the name of a dimension, an offset, a diameter or a gap";
const SHAPES: &str = "smoothed: the values themselves; chosen: the family that fits best; normal, lognormal, shifted-lognormal, \
                      weibull, shifted-weibull, johnson-su, johnson-sb, two-normals";

/// The measured parts.
struct Parts<'t, 's> {
    field: Field<'t, 's>,
    /// A table for each file.
    tables: Vec<MeasuredTable>,
    /// The groups whose parts count; all if none is stated.
    only: Option<Vec<&'t str>>,
    assumed: Assumed,
}

/// Reads the optional table `[measured]` of the scene `root` in the file `file_name`, to whose folder paths are relative.
pub(super) fn columns<'t, 's>(root: &Field<'t, 's>, file_name: &str) -> Result<Option<Columns<'t, 's>>, SceneError> {
    const ALLOWED: &str = "tables [[measured.column]], each with what it is `of`";
    let Some(table) = root.get("measured") else { return Ok(None) };
    table.expect_table()?;
    let list = table.require("column", ALLOWED)?;
    let Value::List(nodes) = &list.node.value else { return Err(list.wrong_type(ALLOWED)) };
    if nodes.is_empty() {
        return Err(list.error(Problem::Length { key: list.key.clone(), found: 0 }, ALLOWED));
    }
    let tables = || nodes.iter().map(|node| Field { key: list.key.clone(), node });
    let headings = tables().map(|own| Ok(heading(&own)?.to_owned())).collect::<Result<Vec<_>, SceneError>>()?;
    let parts = parts(&table, file_name, &headings)?;
    let (mut columns, mut characteristics): (Vec<Column>, Vec<_>) = (Vec::new(), Vec::new());
    for own in tables() {
        let field = own.require("of", OF)?;
        let of = field.to_text()?;
        if columns.iter().any(|column| column.of == of) {
            let problem = Problem::Duplicate { key: field.key.clone(), name: of.into() };
            return Err(field.error(problem, "each dimension or gap once"));
        }
        let found = parts.characteristic(root, &own, of)?;
        doubt::warn(&field, of, &found);
        characteristics.push(found);
        columns.push(Column { of, field });
    }
    let production = Production::new(characteristics).map_err(|(i, error)| {
        let Column { of, field } = &columns[i];
        let why = match (&error, quantity(root, of)) {
            (ProductionError::Bounds { value }, Ok(Quantity { units: [unit, ..], .. })) => {
                let value = ten_digits(value / unit.to_si(1.0));
                format!("one part has {value} {}, which is beyond `least` or `most`", unit.symbol)
            }
            _ => error.to_string(),
        };
        field.error(Problem::Measured { of: (*of).into(), why }, SHAPES)
    })?;
    Ok(Some(Columns::new(production, columns)))
}

/// The files that the scene `root` in the file `file_name` refers to, each with what it is: measured parts and recorded commands.
pub(super) fn files(root: &Field, file_name: &str) -> Vec<(&'static str, PathBuf)> {
    let mut fields = Vec::new();
    let parts = root.get("measured").and_then(|table| table.get("file"));
    fields.extend(parts.map(|field| ("the measured parts", field)));
    if let Some(drives) = root.get("drive") {
        let nodes =
            if let Value::List(nodes) = &drives.node.value { &nodes[..] } else { std::slice::from_ref(drives.node) };
        let records = nodes.iter().filter_map(|node| Field { key: drives.key.clone(), node }.get("record"));
        fields.extend(records.filter_map(|record| Some(("a recorded command", record.get("file")?))));
    }
    let paths = |(what, field): (&'static str, Field)| {
        let paths = texts(&field, "").unwrap_or_default().into_iter().map(|path| folder(file_name).join(path));
        paths.map(|path| (what, path)).collect::<Vec<_>>()
    };
    fields.into_iter().flat_map(paths).collect()
}

/// The folder that paths in a scene's file are relative to.
pub(super) fn folder(file_name: &str) -> &Path {
    Path::new(file_name).parent().unwrap_or(Path::new(""))
}

/// The heading of the column whose table is `own`.
fn heading<'t>(own: &Field<'t, '_>) -> Result<&'t str, SceneError> {
    own.expect_table()?;
    match own.get("heading") {
        Some(field) => field.to_text(),
        None => own.require("of", OF)?.to_text(),
    }
}

/// Reads the columns `headings` of the files, and what holds for all of them.
fn parts<'t, 's>(table: &Field<'t, 's>, file_name: &str, headings: &[String]) -> Result<Parts<'t, 's>, SceneError> {
    const FILES: &str = "a file of measured parts, CSV or QIF results, or a list of such files";
    let field = table.require("file", FILES)?;
    let (group, only) = match (table.get("group"), table.get("only")) {
        (Some(group), None) => return Err(group.no_effect("without `only`", "the groups whose parts count, as `only`")),
        (None, Some(only)) => {
            return Err(only.no_effect("without a `group`", "the column that divides the parts, as `group`"));
        }
        (group, only) => (group, only),
    };
    let group = group.map(|field| field.to_text()).transpose()?;
    let groups = only.as_ref().map(|field| texts(field, "a group, or a list of groups")).transpose()?;
    let options = Options {
        groups: group.into_iter().map(str::to_owned).collect(),
        values: Some(headings.to_vec()),
        ..Options::default()
    };
    let mut tables = Vec::new();
    let paths = texts(&field, FILES)?;
    for (i, path) in paths.iter().enumerate() {
        if paths[..i].contains(path) {
            let problem = Problem::Duplicate { key: field.key.clone(), name: (*path).into() };
            return Err(field.error(problem, "each file once"));
        }
        let read = file::load(&folder(file_name).join(path), &options);
        let read =
            read.map_err(|why| field.error(Problem::Measured { of: (*path).into(), why: why.to_string() }, FILES))?;
        tables.push(read);
    }
    let assumed = table.get("distribution").map_or(Ok(Assumed::Smoothed), |field| assumed(&field))?;
    let parts = Parts { field, tables, only: groups, assumed };
    if let Some(only) = only {
        parts.check_groups(&only)?;
    }
    Ok(parts)
}

/// One text, or a list of them.
fn texts<'t>(field: &Field<'t, '_>, allowed: &str) -> Result<Vec<&'t str>, SceneError> {
    match &field.node.value {
        Value::List(nodes) if !nodes.is_empty() => {
            nodes.iter().map(|node| Field { key: field.key.clone(), node }.to_text()).collect()
        }
        Value::Text(text) => Ok(vec![text]),
        _ => Err(field.wrong_type(allowed)),
    }
}

fn assumed(field: &Field) -> Result<Assumed, SceneError> {
    let name = field.to_text()?;
    match name {
        "smoothed" => Ok(Assumed::Smoothed),
        "chosen" => Ok(Assumed::Chosen),
        _ => {
            let family = Kind::ALL.into_iter().find(|kind| kind.name() == name).map(Assumed::Family);
            let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
            family.ok_or_else(|| field.error(problem, SHAPES))
        }
    }
}

impl Parts<'_, '_> {
    /// Refuses groups that no file has.
    fn check_groups(&self, field: &Field) -> Result<(), SceneError> {
        let groups = || self.tables.iter().flat_map(|table| table.groupings()).flat_map(|grouping| &grouping.groups);
        let unknown = self.only.iter().flatten().find(|name| groups().all(|group| group != *name));
        let Some(name) = unknown else { return Ok(()) };
        let mut known: Vec<&str> = groups().map(String::as_str).collect();
        known.sort_unstable();
        known.dedup();
        let problem = Problem::UnknownName { of: "group of parts".into(), name: (*name).into() };
        Err(field.error(problem, known.join(", ")))
    }

    /// The characteristic `of` the scene, whose table is `own`.
    fn characteristic(&self, root: &Field, own: &Field, of: &str) -> Result<Characteristic, SceneError> {
        let heading = heading(own)?;
        let quantity = quantity(root, of)?;
        let mut values = Vec::new();
        for table in &self.tables {
            let Some(column) = table.column(heading) else {
                let known: Vec<&str> = table.columns().iter().map(|column| column.name.as_str()).collect();
                let problem = Problem::UnknownName { of: "measured column".into(), name: heading.into() };
                let field = own.get("heading").or(own.get("of")).unwrap_or_else(|| own.clone());
                return Err(field.error(problem, known.join(", ")));
            };
            let unit =
                quantity.units.iter().find(|unit| column.unit != Unit::None && unit.symbol == column.unit.symbol());
            let unit = unit.or(quantity.units.first().filter(|_| column.unit == Unit::None));
            let unit = unit.ok_or_else(|| {
                let why = format!("the column \"{heading}\" is in {}", column.unit);
                self.field.error(Problem::Measured { of: of.into(), why }, quantity.units())
            })?;
            let grouping = table.groupings().first();
            let counts = |part: usize| {
                let group = grouping.and_then(|grouping| grouping.groups.get(grouping.group_of[part]? as usize));
                self.only.as_ref().is_none_or(|only| group.is_some_and(|group| only.contains(&group.as_str())))
            };
            let parts = column.values.iter().enumerate().filter(|(part, _)| counts(*part));
            values.extend(parts.map(|(_, value)| value.map(|value| unit.to_si(value))));
        }
        let assumed = own.get("distribution").map_or(Ok(self.assumed), |field| assumed(&field))?;
        let mut bounds = [f64::NEG_INFINITY, f64::INFINITY];
        for (k, key) in ["least", "most"].into_iter().enumerate() {
            let Some(field) = own.get(key) else { continue };
            if assumed != Assumed::Smoothed {
                let place = "with a family, which has its own bounds";
                return Err(field.no_effect(place, "distribution = \"smoothed\" beside it"));
            }
            bounds[k] = field.to_number(quantity)?;
            if bounds[0] >= bounds[1] {
                return Err(field.out_of_range("", "`least` below `most`"));
            }
        }
        Ok(Characteristic { values, assumed, bounds })
    }
}

/// What kind of number the dimension or gap `of` the scene is.
fn quantity(root: &Field, of: &str) -> Result<&'static Quantity, SceneError> {
    let Some(Value::List(nodes)) = root.get("dimension").map(|list| &list.node.value) else {
        return Ok(units(Measurand::Length));
    };
    let tables = nodes.iter().map(|node| Field { key: "dimension".into(), node });
    let is_named = |table: &Field| table.get("name").is_some_and(|name| name.to_text().is_ok_and(|name| name == of));
    match tables.into_iter().find(is_named).and_then(|table| Some((table.get("value")?, table))) {
        Some((value, table)) => Ok(units(quantity_of(&table, &value)?)),
        None => Ok(units(Measurand::Length)),
    }
}
