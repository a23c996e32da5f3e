//! Reading `[identify]`: what is sought in measured motion.

use slipfit_core::slide::CONTACTS;
use slipfit_identify::{
    drive_train::{LAWS, Term},
    fit::{Loss, Options},
    record::{Columns, ForceConstant},
};
use slipfit_tolerance::unit::{self, Quantity};

use super::{
    Problem, SceneError,
    parameter::{Kind, Named},
    parse::choice,
    slide_parameters::named,
    tree::Value,
    value::Field,
};
use crate::setup::{Identification, Law, SURFACES, Scene, Sought, SoughtValue, Subject};

const DRIVE_TRAIN: &str = "drive-train";
const SLIDE: &str = "slide";
const MODELS: &str = "slide, drive-train";
const CUTOFF: Quantity = Quantity { units: unit::FREQUENCY, range: [1e-3, 1e6] };
const LEVEL: Quantity = Quantity { units: unit::ONE, range: [-100.0, 100.0] };
/// Greatest force for 1 A or 1 V (N).
const FORCE_CONSTANT: f64 = 1e9;

/// Reads the table of a drive train without a mechanism; `None` if the scene is none.
pub(super) fn drive_train(root: &Field) -> Result<Option<Identification>, SceneError> {
    let Some(table) = root.get("identify") else { return Ok(None) };
    table.expect_table()?;
    match table.get("model").as_ref().map(model).transpose()? {
        Some(true) => {}
        _ => return Ok(None),
    }
    const OTHERS: [&str; 5] = ["slide", "mechanism", "part", "dimension", "measure"];
    if let Some(other) = OTHERS.iter().find_map(|key| root.get(key)) {
        return Err(other.no_effect("in the scene of a drive train alone", "a scene with only title and [identify]"));
    }
    let law = table.get("law").map(|field| law(&field)).transpose()?;
    let cutoff = table.get("cutoff").map(|field| field.to_number(&CUTOFF)).transpose()?;
    let columns = Columns { position: text(&table, "position")?, speed: text(&table, "speed")?, ..columns(&table)? };
    let options = Options { loss: loss(&table)?.unwrap_or(Loss::Squares), ..Options::default() };
    Ok(Some(Identification { columns, options, subject: Subject::DriveTrain { law, cutoff } }))
}

/// Reads the table of a `scene` that has a slide; `None` where there is none.
pub(super) fn slide(root: &Field, scene: &Scene) -> Result<Option<Identification>, SceneError> {
    let Some(table) = root.get("identify") else { return Ok(None) };
    table.expect_table()?;
    table.get("model").as_ref().map(model).transpose()?;
    let mut sought = Vec::new();
    for Named { parameter, name, kind, field } in named(root, "identify", scene)? {
        sought.push(Sought { value: SoughtValue::Parameter(parameter), name, bounds: bounds(&field, kind)? });
    }
    sought.extend(levels(&table, scene)?);
    if sought.is_empty() {
        let allowed = "friction.coefficient, contact.stiffness, slide.mass or gaps, each with two bounds";
        return Err(table.error(Problem::Missing("identify: what is sought".into()), allowed));
    }
    let grid = table.get("search").map(|field| choice(&field, [false, true], search)).transpose()?.unwrap_or_default();
    let options = Options { loss: loss(&table)?.unwrap_or_default(), grid, ..Options::default() };
    Ok(Some(Identification { columns: columns(&table)?, options, subject: Subject::Slide(sought) }))
}

fn search(grid: bool) -> &'static str {
    if grid { "grid" } else { "gradient" }
}

/// Whether the model is a drive train.
fn model(field: &Field) -> Result<bool, SceneError> {
    match field.to_text()? {
        DRIVE_TRAIN => Ok(true),
        SLIDE => Ok(false),
        _ => Err(field.error(Problem::Choice { key: field.key.clone(), written: field.written("") }, MODELS)),
    }
}

fn loss(table: &Field) -> Result<Option<Loss>, SceneError> {
    table.get("loss").map(|field| choice(&field, Loss::ALL, Loss::name)).transpose()
}

/// A law by its name, or its terms as a list.
fn law(field: &Field) -> Result<Law, SceneError> {
    let names = || LAWS.map(|(name, _)| name).join(", ");
    let terms = || Term::ALL.map(Term::name).join(", ");
    let allowed = || format!("{}; or a list of terms: {}", names(), terms());
    let wrong =
        |field: &Field| field.error(Problem::Choice { key: field.key.clone(), written: field.written("") }, allowed());
    match &field.node.value {
        Value::Text(text) => {
            let found = LAWS.iter().find(|(name, _)| name == text).ok_or_else(|| wrong(field))?;
            Ok(Law { name: found.0.into(), terms: found.1.to_vec() })
        }
        Value::List(nodes) if !nodes.is_empty() => {
            let mut found = Vec::new();
            for node in nodes {
                let field = Field { key: field.key.clone(), node };
                let text = field.to_text()?;
                let term = Term::ALL.into_iter().find(|term| term.name() == text).ok_or_else(|| wrong(&field))?;
                if found.contains(&term) {
                    return Err(field.error(Problem::Duplicate { key: field.key.clone(), name: text.into() }, terms()));
                }
                found.push(term);
            }
            Ok(Law { name: found.iter().map(|term| term.name()).collect::<Vec<_>>().join(", "), terms: found })
        }
        _ => Err(field.wrong_type(allowed())),
    }
}

/// Two bounds (SI) of a value of this `kind`.
fn bounds(field: &Field, kind: Kind) -> Result<[f64; 2], SceneError> {
    const BOUNDS: &str = "a lower and a higher bound";
    let Value::List(nodes) = &field.node.value else { return Err(field.wrong_type(BOUNDS)) };
    let [low, high] = &nodes[..] else {
        return Err(field.error(Problem::Length { key: field.key.clone(), found: nodes.len() }, BOUNDS));
    };
    kind.range(field, [low, high], BOUNDS)
}

/// The tolerance levels that are sought.
fn levels(table: &Field, scene: &Scene) -> Result<Vec<Sought>, SceneError> {
    let Some(list) = table.get("gaps") else { return Ok(Vec::new()) };
    const LIST: &str = "a list such as [{ of = \"rail\", n = [-3, 3] }]";
    let Value::List(nodes) = &list.node.value else { return Err(list.wrong_type(LIST)) };
    let mut sought: Vec<Sought> = Vec::new();
    for node in nodes {
        let entry = Field { key: list.key.clone(), node };
        entry.expect_table()?;
        let of = entry.require("of", "all, a surface, a pin or one gap")?;
        let name = of.to_text()?;
        let contacts = contacts(scene, name);
        if contacts.is_empty() {
            let names = scene.contact_names();
            let allowed = format!("all, {}, a pin, or one gap such as {:?}", SURFACES.join(", "), names[0]);
            return Err(of.error(Problem::UnknownName { of: "varying gap".into(), name: name.into() }, allowed));
        }
        let is_taken = |other: &Sought| matches!(&other.value, SoughtValue::Level(taken) if taken.iter().any(|one| contacts.contains(one)));
        if sought.iter().any(is_taken) {
            let problem = Problem::Duplicate { key: of.key.clone(), name: name.into() };
            return Err(of.error(problem, "gaps of which none is sought twice"));
        }
        let n = entry.require("n", "a list of 2 levels")?;
        let bounds = bounds(&n, Kind::Number(&LEVEL))?;
        sought.push(Sought { value: SoughtValue::Level(contacts), name: format!("n of {name}"), bounds });
    }
    Ok(sought)
}

/// The contacts of a `scene` that vary and are meant by a `name`: all, those of a surface or a pin, or one.
fn contacts(scene: &Scene, name: &str) -> Vec<usize> {
    let names = scene.contact_names();
    let varies = |i: usize| scene.pins[i / 4].gaps[i % 4].is_some_and(|gap| gap.deviation > 0.0);
    let is_meant =
        |i: usize| name == "all" || name == SURFACES[i % 4] || name == scene.pins[i / 4].name || name == names[i];
    (0..CONTACTS).filter(|i| varies(*i) && is_meant(*i)).collect()
}

/// Names of the columns of every record.
fn columns(table: &Field) -> Result<Columns, SceneError> {
    let force_constant = table.get("force_constant").map(|field| force_constant(&field)).transpose()?;
    let current = text(table, "current")?;
    Ok(Columns {
        time: text(table, "time")?,
        force: text(table, "force")?,
        current,
        force_constant,
        ..Columns::default()
    })
}

fn text(table: &Field, key: &str) -> Result<Option<String>, SceneError> {
    table.get(key).map(|field| field.to_text().map(str::to_owned)).transpose()
}

fn force_constant(field: &Field) -> Result<ForceConstant, SceneError> {
    const UNITS: &str = "a text with its unit: \"12 N/A\", \"35 N/V\"";
    let measure = field.measure(UNITS)?;
    if measure.number.abs() > FORCE_CONSTANT || measure.number == 0.0 {
        return Err(field.out_of_range("", format!("up to {FORCE_CONSTANT:e} N/A or N/V, and not 0")));
    }
    match measure.unit {
        Some("N/A") => Ok(ForceConstant::PerAmpere(measure.number)),
        Some("N/V") => Ok(ForceConstant::PerVolt(measure.number)),
        _ => Err(field.error(Problem::Unit { key: field.key.clone(), written: field.written("") }, UNITS)),
    }
}
