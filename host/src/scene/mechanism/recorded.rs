//! Reading a recorded command: a column of a CSV file.

use slipfit_core::drive::Piece;
use slipfit_identify::record::{Columns, Needs, read_file};

use super::super::measured::folder;
use crate::{
    dynamics::command::spline,
    scene::{Problem, SceneError, parse::choice, value::Field},
};

/// A recorded command.
pub struct Recorded {
    /// The speed (m/s, rad/s) over time.
    pub pieces: Vec<Piece<f64>>,
    /// Distances (m, rad) from the start that are held over each piece, of positions that are not interpolated.
    pub positions: Option<Vec<f64>>,
    /// Whether positions were recorded, not speeds.
    pub is_position: bool,
}

/// What a command is between two samples.
#[derive(Clone, Copy, PartialEq)]
enum Interpolation {
    Linear,
    Cubic,
    Held,
}

impl Interpolation {
    fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Cubic => "cubic",
            Self::Held => "held",
        }
    }
}

/// Reads the `table` of a recorded command of a drive that `turns` or pushes, and whose motion is prescribed or not; `file_name` is that of
/// the scene.
pub fn recorded(table: &Field, [turns, is_prescribed]: [bool; 2], file_name: &str) -> Result<Recorded, SceneError> {
    table.expect_table()?;
    let text = |key: &str| table.get(key).map(|field| field.to_text().map(str::to_owned)).transpose();
    let columns = Columns {
        time: text("time")?,
        position: text("position")?,
        speed: text("speed")?,
        turns,
        ..Columns::default()
    };
    let all = [Interpolation::Linear, Interpolation::Cubic, Interpolation::Held];
    let between = table.get("interpolation").map(|field| choice(&field, all, Interpolation::name)).transpose()?;
    let file = table.require("file", "a CSV file with a column of positions or speeds over time")?;
    let path = folder(file_name).join(file.to_text()?);
    let is_position = match (&columns.position, &columns.speed) {
        (Some(_), None) => true,
        (None, Some(_)) => false,
        _ => {
            let problem = Problem::Missing("drive.record.position".into());
            return Err(table.error(problem, "one of position and speed: the heading of the column that is commanded"));
        }
    };
    let needs = if is_position { Needs::Position } else { Needs::Speed };
    let record = read_file(&path, &columns, needs)
        .map_err(|error| file.error(Problem::Record { why: error.to_string() }, "a record at equal intervals"))?;
    if record.start < 0.0 {
        let why = format!("the record begins at {} s", record.start);
        return Err(file.error(Problem::Record { why }, "a record that begins at 0 s or later"));
    }
    let usual = if is_prescribed { Interpolation::Cubic } else { Interpolation::Linear };
    let between = between.unwrap_or(usual);
    let jumps = between == Interpolation::Held || (between == Interpolation::Linear && is_position);
    if let Some(field) = table.get("interpolation").filter(|_| is_prescribed && jumps) {
        let what = "a prescribed motion whose speed jumps".into();
        return Err(field.error(Problem::Unsupported { what }, "cubic; of speeds also linear"));
    }
    let values = if is_position { &record.position } else { &record.speed };
    let mut values = values.clone().unwrap_or_default();
    if is_prescribed {
        let fastest = fastest(&values, is_position, record.step);
        let first = if is_position { (values[1] - values[0]) / record.step } else { values[0] };
        if first.abs() > AT_REST * fastest {
            let why = "it begins in motion, and the body at rest".to_owned();
            let allowed = format!("a record that begins with less than {} % of its greatest speed", 100.0 * AT_REST);
            return Err(file.error(Problem::Record { why }, allowed));
        }
        // What is left of a speed is noise.
        if !is_position {
            values[0] = 0.0;
        }
    }
    let values = &values[..];
    let start = (is_prescribed && is_position).then_some(0.0);
    let curve = interpolated(values, record.step, between, start);
    // After the last sample a speed stays, and so does a position, unless its slope is known.
    let last = match (is_position && between == Interpolation::Cubic, curve.last()) {
        (true, Some([_, b, c, d])) => b + record.step * (2.0 * c + 3.0 * d * record.step),
        _ => 0.0,
    };
    let end = [values.last().copied().unwrap_or_default(), last, 0.0, 0.0];
    let speed = |[a, b, c, d]: [f64; 4]| if is_position { [b, 2.0 * c, 3.0 * d, 0.0] } else { [a, b, c, d] };
    let piece = |(i, of): (usize, [f64; 4])| Piece {
        start: record.start + record.step * i as f64,
        // Without a negative zero.
        coefficients: speed(of).map(|of| of + 0.0),
    };
    let pieces = curve.into_iter().chain([end]).enumerate().map(piece).collect();
    let is_held = is_position && between == Interpolation::Held;
    let positions = is_held.then(|| values.iter().map(|value| value - values[0]).collect());
    Ok(Recorded { pieces, positions, is_position })
}

/// Coefficients from each of `values` at intervals of `step` (s) to the next; a spline may have a slope at its `start`.
fn interpolated(values: &[f64], step: f64, between: Interpolation, start: Option<f64>) -> Vec<[f64; 4]> {
    match between {
        Interpolation::Held => values.windows(2).map(|two| [two[0], 0.0, 0.0, 0.0]).collect(),
        Interpolation::Linear => values.windows(2).map(|two| [two[0], (two[1] - two[0]) / step, 0.0, 0.0]).collect(),
        Interpolation::Cubic => spline(values, step, start),
    }
}

/// Share of its greatest speed below which a recorded motion is at rest.
const AT_REST: f64 = 0.05;

/// The greatest speed of `values`, positions or speeds, at intervals of `step` (s).
fn fastest(values: &[f64], is_position: bool, step: f64) -> f64 {
    match is_position {
        true => values.windows(2).fold(0.0, |most: f64, two| most.max(((two[1] - two[0]) / step).abs())),
        false => values.iter().fold(0.0, |most: f64, value| most.max(value.abs())),
    }
}
