//! Reading a recorded command: a column of a CSV file.

use slipfit_core::drive::Piece;
use slipfit_identify::record::{Columns, Needs, Record, read_file};

use super::super::measured::folder;
use crate::scene::{Problem, SceneError, parse::choice, value::Field};

/// A recorded command.
pub struct Recorded {
    /// The speed over time.
    pub pieces: Vec<Piece<f64>>,
    /// Distances from the start that are held over each piece, of positions that are not interpolated.
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
pub fn recorded(
    table: &Field,
    [turns, is_prescribed]: [bool; 2],
    file_name: &str,
) -> Result<Recorded, SceneError> {
    table.expect_table()?;
    let file = table.require("file", "a CSV file with a column of positions or speeds over time")?;
    let text = |key: &str| table.get(key).map(|field| field.to_text().map(str::to_owned)).transpose();
    let columns = Columns {
        time: text("time")?,
        position: text("position")?,
        speed: text("speed")?,
        turns,
        ..Columns::default()
    };
    let is_position = match (&columns.position, &columns.speed) {
        (Some(_), None) => true,
        (None, Some(_)) => false,
        _ => {
            let problem = Problem::Missing("drive.record.position".into());
            return Err(table.error(problem, "one of position and speed: the heading of the column that is commanded"));
        }
    };
    let all = [Interpolation::Linear, Interpolation::Cubic, Interpolation::Held];
    let between = table.get("interpolation").map(|field| choice(&field, all, Interpolation::name)).transpose()?;
    let path = folder(file_name).join(file.to_text()?);
    let record = read_file(&path, &columns, Needs::Motion)
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
    let values = values.as_deref().unwrap_or_default();
    let (pieces, positions) = match (is_position, between) {
        (true, Interpolation::Held) => {
            let pieces = commanded(&record, |_| [0.0; 4]);
            (pieces, Some(values.iter().map(|value| value - values[0]).collect()))
        }
        (true, Interpolation::Linear) => {
            let speed = |i: usize| values.get(i + 1).map_or(0.0, |next| (next - values[i]) / record.step);
            (commanded(&record, |i| [speed(i), 0.0, 0.0, 0.0]), None)
        }
        (true, Interpolation::Cubic) => {
            let spline = spline(values, record.step);
            let derivative = |[_, b, c, d]: [f64; 4]| [b, 2.0 * c, 3.0 * d, 0.0];
            let last = spline.last().map_or(0.0, |[_, b, c, d]| b + record.step * (2.0 * c + 3.0 * d * record.step));
            // After the last sample its speed.
            (commanded(&record, |i| spline.get(i).map_or([last, 0.0, 0.0, 0.0], |of| derivative(*of))), None)
        }
        (false, Interpolation::Held) => (commanded(&record, |i| [values[i], 0.0, 0.0, 0.0]), None),
        (false, Interpolation::Linear) => {
            let slope = |i: usize| values.get(i + 1).map_or(0.0, |next| (next - values[i]) / record.step);
            (commanded(&record, |i| [values[i], slope(i), 0.0, 0.0]), None)
        }
        (false, Interpolation::Cubic) => {
            let spline = spline(values, record.step);
            (commanded(&record, |i| spline.get(i).copied().unwrap_or([values[i], 0.0, 0.0, 0.0])), None)
        }
    };
    Ok(Recorded { pieces, positions, is_position })
}

/// A piece from each sample of a `record` on, with these coefficients of the speed.
fn commanded(record: &Record, coefficients: impl Fn(usize) -> [f64; 4]) -> Vec<Piece<f64>> {
    let start = |i: usize| record.start + record.step * i as f64;
    (0..record.samples).map(|i| Piece { start: start(i), coefficients: coefficients(i).map(|of| of + 0.0) }).collect()
}

/// The natural cubic spline through `values` at equal distances `step`: its coefficients from each value to the next.
pub fn spline(values: &[f64], step: f64) -> Vec<[f64; 4]> {
    let last = values.len() - 1;
    // Second derivatives times step²/6, by elimination of M(i−1) + 4·M(i) + M(i+1) = second difference, zero at both ends.
    let (mut upper, mut second) = (vec![0.0; last + 1], vec![0.0; last + 1]);
    for i in 1..last {
        let pivot = 4.0 - upper[i - 1];
        upper[i] = 1.0 / pivot;
        second[i] = (values[i + 1] - 2.0 * values[i] + values[i - 1] - second[i - 1]) / pivot;
    }
    for i in (1..last).rev() {
        second[i] -= upper[i] * second[i + 1];
    }
    let coefficients = |i: usize| {
        let slope = values[i + 1] - values[i] - 2.0 * second[i] - second[i + 1];
        let [square, cube] = [3.0 * second[i], second[i + 1] - second[i]];
        [values[i], slope / step, square / (step * step), cube / (step * step * step)]
    };
    (0..last).map(coefficients).collect()
}

#[cfg(test)]
mod tests {
    use super::spline;

    #[test]
    fn a_spline_goes_through_its_values_and_is_smooth() {
        let h = 0.05;
        let values: Vec<f64> = (0..100).map(|i| libm::sin(3.0 * h * f64::from(i))).collect();
        let spline = spline(&values, h);
        let at = |i: usize, s: f64| {
            let [a, b, c, d] = spline[i];
            [((d * s + c) * s + b) * s + a, (3.0 * d * s + 2.0 * c) * s + b, 6.0 * d * s + 2.0 * c]
        };
        for i in 0..98 {
            for (end, start) in at(i, h).into_iter().zip(at(i + 1, 0.0)) {
                assert!((end - start).abs() < 1e-9, "{i}: {end} {start}");
            }
        }
        // Away from its ends, where it has no curvature.
        for i in 20..80 {
            let t = h * (i as f64 + 0.5);
            let [value, slope, _] = at(i, 0.5 * h);
            assert!((value - libm::sin(3.0 * t)).abs() < 1e-5 && (slope - 3.0 * libm::cos(3.0 * t)).abs() < 1e-4);
        }
    }
}
