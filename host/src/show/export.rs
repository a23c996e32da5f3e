//! Results as CSV.

use std::{io, io::Write};

use slipfit_core::{clearance::GapClass, slide::ABSENT};
use slipfit_tolerance::number::ten_digits;

use crate::{
    dynamics::{
        driven::DriveKind,
        outcome::{Moment, Outcome},
        sweep::Sweep,
        trajectory::Trajectory,
    },
    mechanism::Samples,
    population::{Unit, unit::Fault},
    quality::{precision, stability},
};

/// Time, speed and force along the drive, displacement of the centre of mass; ten digits.
///
/// # Errors
/// Those of the writer, none in memory.
pub fn trajectory_csv(trajectory: &Trajectory) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["t (s)", "vz (m/s)", "force (N)", "x (m)", "y (m)", "z (m)"])?;
    for (i, t) in trajectory.t.iter().enumerate() {
        let Trajectory { vz, force, x, y, z, .. } = trajectory;
        let columns = [*t, vz[i], force[i], x[i], y[i], z[i]];
        writer.write_record(columns.map(ten_digits))?;
    }
    Ok(writer.into_inner()?)
}

/// Rows under named columns, ten digits; empty where a value is not a number.
///
/// # Errors
/// Those of the writer, none in memory.
pub fn rows_csv(samples: &Samples) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&samples.columns)?;
    for row in &samples.rows {
        writer.write_record(row.iter().map(|x| if x.is_nan() { String::new() } else { ten_digits(*x) }))?;
    }
    Ok(writer.into_inner()?)
}

/// Units of a population as CSV, one line each: number, tightness, figures and gaps, ten digits; empty where there is none.
pub struct UnitRows<W: Write>(csv::Writer<W>);

impl<W: Write> UnitRows<W> {
    /// Into `writer`, with the heading for a drive of this `kind` and gaps of these names.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn new(writer: W, kind: DriveKind, gaps: &[String]) -> io::Result<Self> {
        let [breakaway, peak, settled, speed, end, travel, ..] = figure_names(kind);
        let figures = ["unit", "tightness", breakaway, peak, settled, speed, end, travel, "verdict", "at_desk"]
            .map(str::to_owned);
        let gaps = gaps.iter().map(|name| format!("{name} (m)"));
        let mut writer = csv::Writer::from_writer(writer);
        writer.write_record(figures.into_iter().chain(gaps))?;
        Ok(Self(writer))
    }

    /// Adds a unit of this `tightness`.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn add(&mut self, tightness: f64, unit: &Unit) -> io::Result<()> {
        let Unit { number, gaps, outcome } = unit;
        let optional = |value: Option<f64>| value.map_or(String::new(), ten_digits);
        // A unit without a run has no figures; one that cannot be assembled stands still.
        let runs = matches!(outcome.fault, None | Some(Fault::Unassembled));
        let figure = |value: f64| optional(runs.then_some(value));
        let own = [
            number.to_string(),
            ten_digits(tightness),
            optional(outcome.breakaway),
            optional(outcome.peak_force),
            optional(outcome.settled_force),
            figure(outcome.final_velocity),
            figure(outcome.end.t),
            figure(outcome.end.z),
            outcome.verdict.to_string(),
            outcome.at_desk.to_string(),
        ];
        let gaps = gaps.iter().map(|gap| optional((*gap != ABSENT).then_some(*gap)));
        Ok(self.0.write_record(own.into_iter().chain(gaps))?)
    }

    /// The writer, with everything in it.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn finish(self) -> io::Result<W> {
        self.0.into_inner().map_err(csv::IntoInnerError::into_error)
    }
}

/// Names of a run's figures, with their units; of a drive of this `kind`.
pub fn figure_names(kind: DriveKind) -> [&'static str; 9] {
    [
        "breakaway_s",
        kind.choose("peak_force_N", "peak_torque_N_m"),
        kind.choose("settled_force_N", "settled_torque_N_m"),
        kind.choose("final_velocity_m_per_s", "final_velocity_rad_per_s"),
        "end_s",
        kind.choose("travel_m", "travel_rad"),
        kind.choose("tips_m", "tips_rad"),
        kind.choose("slows_m", "slows_rad"),
        kind.choose("stops_m", "stops_rad"),
    ]
}

/// The figures of an `outcome` in the order of [`figure_names`], ten digits; empty where there is none.
pub fn figures(outcome: &Outcome) -> [String; 9] {
    let optional = |x: Option<f64>| x.map_or_else(String::new, ten_digits);
    let place = |moment: Option<Moment>| optional(moment.map(|moment| moment.z));
    [
        optional(outcome.breakaway),
        optional(outcome.peak_force),
        optional(outcome.settled_force),
        ten_digits(outcome.final_velocity),
        ten_digits(outcome.end.t),
        ten_digits(outcome.end.z),
        place(outcome.tips),
        place(outcome.slows),
        place(outcome.stops),
    ]
}

/// Figures and the class of each gap over n, one line a level; empty where there is none.
///
/// # Errors
/// Those of the writer, none in memory.
pub fn sweep_csv(sweep: &Sweep) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let gaps = sweep.gaps.iter().map(String::as_str);
    writer.write_record(["n"].into_iter().chain(figure_names(sweep.kind)).chain(["verdict"]).chain(gaps))?;
    for level in &sweep.levels {
        let class = |class: &Option<GapClass>| class.map_or_else(String::new, |class| class.to_string());
        let verdict = level.outcome.verdict.to_string();
        let own = [ten_digits(level.n)].into_iter().chain(figures(&level.outcome)).chain([verdict]);
        writer.write_record(own.chain(level.classes.iter().map(class)))?;
    }
    Ok(writer.into_inner()?)
}

/// Errors and run times, one line a point; empty where a run blew up.
///
/// # Errors
/// Those of the writer, none in memory.
pub fn precision_csv(points: &[precision::Point]) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for point in points {
        writer.serialize(point)?;
    }
    Ok(writer.into_inner()?)
}

/// The stability map, one line a point; the indicators are empty where the motion left the finite range.
///
/// # Errors
/// Those of the writer, none in memory.
pub fn stability_csv<'a>(points: impl Iterator<Item = &'a stability::Point>) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "integrator",
        "factor",
        "values",
        "grade",
        "error",
        "defect",
        "filling",
        "rise",
        "imbalance",
        "doubtful_force",
        "difference",
    ])?;
    for point in points {
        let values: Vec<String> = point.values.iter().map(|value| ten_digits(*value)).collect();
        let names = [point.integrator.into(), point.factor.into(), values.join(" "), format!("{:?}", point.grade())];
        let numbers = point.indicators.map(|at| {
            let [error, defect, filling, rise, imbalance, doubt] =
                [at.error, at.defect, at.filling, at.rise, at.imbalance, at.doubtful_force].map(ten_digits);
            let difference = at.difference.map(ten_digits).unwrap_or_default();
            [error, defect, filling, rise, imbalance, doubt, difference]
        });
        writer.write_record(names.iter().chain(&numbers.unwrap_or_default()))?;
    }
    Ok(writer.into_inner()?)
}
