//! Reading `[identify]`: what is sought in measured motion.

mod law;
mod sought;

use slipfit_identify::{
    fit::{Loss, Options},
    record::{Columns, ForceConstant},
};
use slipfit_tolerance::unit::{self, Quantity};

use self::sought::{Gaps, delay, levels, parameters};
use super::{Problem, SceneError, parameter::Named, parse::choice, slide_parameters::named, value::Field};
use crate::{
    dynamics::driven::DriveKind,
    identify::{Along, Compared, Identification, OfRecord, Sought, Subject},
    mechanism::{self, JointKind, Mechanism},
    setup::{Adjustable, SURFACES, Scene},
};

const DRIVE_TRAIN: &str = "drive-train";
const MODELS: &str = "drive-train, or no such key: the slide or mechanism of the scene";
const CUTOFF: Quantity = Quantity { units: unit::FREQUENCY, range: [1e-3, 1e6] };
/// Greatest force for 1 A or 1 V (N).
const FORCE_CONSTANT: f64 = 1e9;

/// Reads the table of a drive train without a mechanism; `None` if the scene is none.
pub(super) fn drive_train(root: &Field) -> Result<Option<Identification>, SceneError> {
    let Some(table) = root.get("identify") else { return Ok(None) };
    table.expect_table()?;
    let Some(field) = table.get("model") else { return Ok(None) };
    if field.to_text()? != DRIVE_TRAIN {
        return Err(field.error(Problem::Choice { key: field.key.clone(), written: field.written("") }, MODELS));
    }
    const OTHERS: [&str; 5] = ["slide", "mechanism", "part", "dimension", "measure"];
    if let Some(other) = OTHERS.iter().find_map(|key| root.get(key)) {
        return Err(other.no_effect("in the scene of a drive train alone", "a scene with only title and [identify]"));
    }
    let law = table.get("law").map(|field| law::law(&field)).transpose()?;
    let columns = Columns { position: text(&table, "position")?, speed: text(&table, "speed")?, ..columns(&table)? };
    let options = Options { loss: loss(&table)?.unwrap_or(Loss::Squares), ..Options::default() };
    Ok(Some(Identification { columns, options, subject: Subject::DriveTrain { law, cutoff: cutoff(&table)? } }))
}

/// Reads the table of a `scene` that has a slide; `None` where there is none.
pub(super) fn slide(root: &Field, scene: &Scene) -> Result<Option<Identification>, SceneError> {
    let Some(table) = root.get("identify") else { return Ok(None) };
    table.expect_table()?;
    let names = scene.contact_names().to_vec();
    let varies = |i: usize| scene.pins[i / 4].gaps[i % 4].is_some_and(|gap| gap.deviation > 0.0);
    let is_meant = |name: &str, i: usize| name == SURFACES[i % 4] || name == scene.pins[i / 4].name || name == names[i];
    let groups = format!("all, {}, a pin, or one gap such as {:?}", SURFACES.join(", "), names[0]);
    let names = names.iter().map(String::as_str).collect();
    let possible = |_| [f64::NEG_INFINITY, f64::INFINITY];
    let gaps = Gaps { names, varies: &varies, possible: &possible, is_meant: &is_meant, groups };
    let parameters = named(root, "identify", scene)?;
    let unit = OfUnit { drive: 0, turns: false, list: |_| None };
    let (options, columns, of) = of_record(&table, &parameters, &gaps, &unit)?;
    Ok(Some(Identification { columns, options, subject: Subject::Slide(of) }))
}

/// Reads the table of a scene with a `mechanism`, of which it names the `parameters`; `None` where there is none.
pub(super) fn mechanism(
    root: &Field,
    parameters: &[Named<mechanism::Parameter>],
    mechanism: &Mechanism,
) -> Result<Option<Identification>, SceneError> {
    use mechanism::Parameter::{Coulomb, Gain, Limit, Mass, Offset, RampEnd, Slope, Viscous};
    let Some(table) = root.get("identify") else { return Ok(None) };
    table.expect_table()?;
    let drive = recorded_drive(&table, mechanism)?;
    let turns = mechanism.drives.get(drive).is_some_and(|named| named.action.kind() == DriveKind::Turns);
    let varies = |i: usize| mechanism.gaps[i].statistics.deviation > 0.0;
    let of_joint = |name: &str, i: usize| {
        let joint = mechanism.joints.iter().find(|joint| joint.name == name);
        joint.is_some_and(|joint| joint.gaps().any(|gap| gap == i))
    };
    // A surface means that of every track, at all places.
    let of_surface = |name: &str, i: usize| {
        let Some(k) = SURFACES.iter().position(|surface| *surface == name) else { return false };
        mechanism.joints.iter().any(|joint| {
            let JointKind::Track { gaps } = joint.kind else { return false };
            let at = |place| gaps[k].map(|own| joint.walls.gap_at(k, place, own));
            (0..joint.walls.places()).any(|place| at(place) == Some(i))
        })
    };
    let possible = |i: usize| {
        let [least, greatest] = mechanism.allowed_gap(i);
        let statistics = mechanism.gaps[i].statistics;
        [statistics.level(greatest), statistics.level(least)]
    };
    let is_meant = |name: &str, i: usize| name == mechanism.gaps[i].name || of_joint(name, i) || of_surface(name, i);
    let names: Vec<&str> = mechanism.gaps.iter().map(|gap| gap.name.as_str()).collect();
    let groups = if names.is_empty() { "none: no joint has play".into() } else { format!("all, {}", names.join(", ")) };
    let gaps = Gaps { names, varies: &varies, possible: &possible, is_meant: &is_meant, groups };
    let list = |parameter: mechanism::Parameter| match parameter {
        Mass(_) => Some("body"),
        Gain(_) | RampEnd(_) | Limit(_) | Coulomb(_) | Viscous(_) | Offset(_) => Some("drive"),
        Slope(_) => Some("joint"),
        _ => None,
    };
    if table.get("along").is_some() {
        let is_idle = |named: &&Named<_>| [Gain(drive), Limit(drive), RampEnd(drive)].contains(&named.parameter);
        if let Some(named) = parameters.iter().find(is_idle) {
            let allowed = "what the motion depends on, not what makes it";
            return Err(named.field.no_effect("along the measured motion", allowed));
        }
    }
    let unit = OfUnit { drive, turns, list };
    let (options, columns, of) = of_record(&table, parameters, &gaps, &unit)?;
    Ok(Some(Identification { columns, options, subject: Subject::Mechanism(of) }))
}

/// What the reader has to know of a unit.
struct OfUnit<L> {
    /// The drive that was recorded.
    drive: usize,
    /// Whether it turns.
    turns: bool,
    /// In which list of the scene a parameter is stated.
    list: L,
}

/// The drive of a `mechanism` that was recorded: the one that is named, else the first.
fn recorded_drive(table: &Field, mechanism: &Mechanism) -> Result<usize, SceneError> {
    if mechanism.drives.is_empty() {
        let what = "a record of a mechanism without a drive".into();
        return Err(table.error(Problem::Unsupported { what }, "a scene with a [[drive]]"));
    }
    let Some(field) = table.get("recorded") else { return Ok(0) };
    let name = field.to_text()?;
    mechanism.drives.iter().position(|named| named.name == name).ok_or_else(|| {
        let known: Vec<&str> = mechanism.drives.iter().map(|named| named.name.as_str()).collect();
        field.error(Problem::UnknownName { of: "drive".into(), name: name.into() }, known.join(", "))
    })
}

/// Reads what is sought of a unit, and how.
fn of_record<P: Adjustable>(
    table: &Field,
    named: &[Named<P>],
    gaps: &Gaps,
    unit: &OfUnit<impl Fn(P) -> Option<&'static str>>,
) -> Result<(Options, Columns, OfRecord<P>), SceneError> {
    let mut sought: Vec<Sought<P>> = parameters(named, &unit.list)?;
    sought.extend(levels(table, gaps)?);
    sought.extend(delay(table)?);
    if sought.is_empty() {
        let allowed = "friction.coefficient or another parameter, or gaps, each with two bounds";
        return Err(table.error(Problem::Missing("identify: what is sought".into()), allowed));
    }
    let grid = table.get("search").map(|field| choice(&field, [false, true], search)).transpose()?.unwrap_or_default();
    let compared = [Compared::Force, Compared::Speed, Compared::Position];
    let compared = table.get("compare").map(|field| choice(&field, compared, Compared::name)).transpose()?;
    let along = along(table, compared)?;
    let columns = Columns {
        position: text(table, "position")?,
        speed: text(table, "speed")?,
        turns: unit.turns,
        ..columns(table)?
    };
    let compared = compared.unwrap_or_default();
    if along.is_none() && compared == Compared::Force {
        let fields = ["position", "speed"].iter().find_map(|key| table.get(key));
        if let Some(field) = fields {
            return Err(
                field.no_effect("where only the force is compared", "compare, or along = \"motion\", beside it")
            );
        }
    }
    // Spikes of a measured motion are replaced before.
    let usual = if along.is_some() { Loss::Squares } else { Loss::default() };
    let options = Options { loss: loss(table)?.unwrap_or(usual), grid, ..Options::default() };
    Ok((options, columns, OfRecord { sought, drive: unit.drive, compared, along }))
}

/// Whether the drive moves as it was measured.
fn along(table: &Field, compared: Option<Compared>) -> Result<Option<Along>, SceneError> {
    let Some(field) = table.get("along") else {
        return match table.get("cutoff") {
            Some(field) => Err(field.no_effect("where the motion is computed", "along = \"motion\" beside it")),
            None => Ok(None),
        };
    };
    if field.to_text()? != "motion" {
        let problem = Problem::Choice { key: field.key.clone(), written: field.written("") };
        return Err(field.error(problem, "motion, or no such key: the motion is computed"));
    }
    if let Some(field) = compared.and_then(|_| table.get("compare")) {
        return Err(field.no_effect("along the measured motion", "the force, which is what is left to compare"));
    }
    Ok(Some(Along { cutoff: cutoff(table)? }))
}

fn cutoff(table: &Field) -> Result<Option<f64>, SceneError> {
    table.get("cutoff").map(|field| field.to_number(&CUTOFF)).transpose()
}

fn search(grid: bool) -> &'static str {
    if grid { "grid" } else { "gradient" }
}

fn loss(table: &Field) -> Result<Option<Loss>, SceneError> {
    table.get("loss").map(|field| choice(&field, Loss::ALL, Loss::name)).transpose()
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
