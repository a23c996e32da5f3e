//! A record from the text of a file.

use std::path::Path;

use slipfit_measured::csv::{CsvError, FileError, Place, series::Series};

use super::{
    Columns, ForceConstant, Record, RecordError, RecordProblem,
    check::interval,
    columns::{Found, Role},
};

/// What a fit needs of a record, beside the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// The force; the motion is computed.
    Force,
    /// Position or speed; without a force the drive coasts.
    Motion,
    /// The position alone.
    Position,
    /// The speed alone.
    Speed,
}

impl Needs {
    fn roles(self) -> &'static [Role] {
        match self {
            Self::Force => &[Role::Time, Role::Force, Role::Current, Role::Voltage],
            Self::Position => &[Role::Time, Role::Position],
            Self::Speed => &[Role::Time, Role::Speed],
            Self::Motion => &[Role::Time, Role::Position, Role::Speed, Role::Force, Role::Current, Role::Voltage],
        }
    }
}

/// Reads the record of a file.
///
/// # Errors
/// [`RecordError`] names file, line and column.
pub fn read_file(path: &Path, columns: &Columns, needs: Needs) -> Result<Record, RecordError> {
    let name = path.display().to_string();
    let mut found = Vec::new();
    let series = Series::read_file(path, |heads| {
        found = columns.find(heads, needs.roles())?;
        Ok(found.iter().map(|found| found.index).collect())
    });
    let series = series.map_err(|error| RecordError::of_file(&name, error))?;
    record(&name, series, &found, columns, needs)
}

/// The same from the bytes of a file called `name`.
///
/// # Errors
/// As [`read_file`].
pub fn read(name: &str, bytes: Vec<u8>, columns: &Columns, needs: Needs) -> Result<Record, RecordError> {
    let mut found = Vec::new();
    let series = Series::read(bytes, |heads| {
        found = columns.find(heads, needs.roles())?;
        Ok(found.iter().map(|found| found.index).collect())
    });
    let series = series.map_err(|error: CsvError| RecordError::of_file(name, FileError::Csv(error)))?;
    record(name, series, &found, columns, needs)
}

/// Checks the columns and turns them into SI units.
fn record(
    name: &str,
    mut series: Series,
    found: &[Found],
    columns: &Columns,
    needs: Needs,
) -> Result<Record, RecordError> {
    for (column, found) in series.columns.iter_mut().zip(found) {
        column.iter_mut().for_each(|value| *value = found.unit.to_si(*value));
    }
    let wrong = |column: usize, sample: Option<usize>, problem: RecordProblem| RecordError::Content {
        name: name.to_owned(),
        place: series.place(column, sample),
        problem,
    };
    let at = |role: Role| found.iter().position(|found| found.role == role);
    let missing = |role: Role, hint| RecordError::Content {
        name: name.to_owned(),
        place: Place { line: 1, column: 1, span: 0..0 },
        problem: RecordProblem::Missing { role: role.name(), hint },
    };
    let time = at(Role::Time).ok_or_else(|| missing(Role::Time, "call it t or time, or name it"))?;
    let times = &series.columns[time];
    let step = interval(times).map_err(|(sample, problem)| wrong(time, Some(sample), problem))?;
    let varying = |role: Role| -> Result<Option<&Vec<f64>>, RecordError> {
        let Some(column) = at(role) else { return Ok(None) };
        let values = &series.columns[column];
        let value = values[0];
        if values.iter().all(|other| *other == value) && (role == Role::Position || value == 0.0) {
            return Err(wrong(column, Some(0), RecordProblem::Constant { role: role.name(), value }));
        }
        Ok(Some(values))
    };
    let position = varying(Role::Position)?.cloned();
    let speed = varying(Role::Speed)?.cloned();
    let mut force = varying(Role::Force)?.cloned();
    if force.is_none() {
        for (role, constant) in [(Role::Current, per_ampere(columns)), (Role::Voltage, per_volt(columns))] {
            let Some(values) = varying(role)? else { continue };
            let column = at(role).unwrap_or_default();
            let constant =
                constant.ok_or_else(|| wrong(column, None, RecordProblem::NoForceConstant { role: role.name() }))?;
            force = Some(values.iter().map(|value| constant * value).collect());
        }
    }
    match needs {
        Needs::Force if force.is_none() => {
            return Err(missing(Role::Force, "call it force, or name it as identify.force, or give a current"));
        }
        Needs::Motion if position.is_none() && speed.is_none() => {
            return Err(missing(Role::Position, "call it position or speed, or name it as identify.position"));
        }
        Needs::Position if position.is_none() => {
            return Err(missing(Role::Position, "call it position, or name it"));
        }
        Needs::Speed if speed.is_none() => return Err(missing(Role::Speed, "call it speed, or name it")),
        Needs::Force | Needs::Motion | Needs::Position | Needs::Speed => {}
    }
    let (start, samples) = (times[0], times.len());
    Ok(Record { name: name.to_owned(), start, step, samples, position, speed, force })
}

fn per_ampere(columns: &Columns) -> Option<f64> {
    columns.force_constant.and_then(|constant| match constant {
        ForceConstant::PerAmpere(constant) => Some(constant),
        ForceConstant::PerVolt(_) => None,
    })
}

fn per_volt(columns: &Columns) -> Option<f64> {
    columns.force_constant.and_then(|constant| match constant {
        ForceConstant::PerVolt(constant) => Some(constant),
        ForceConstant::PerAmpere(_) => None,
    })
}
