//! Which columns results have, and tables of points as CSV.

use slipfit_core::slide::ABSENT;
use slipfit_tolerance::number::ten_digits;

use super::columns::{Column, Columns, Values};
use crate::{
    dynamics::{
        driven::DriveKind,
        outcome::Outcome,
        sweep::{Level, Sweep},
        trajectory::Trajectory,
    },
    mechanism::Samples,
    population::{Unit, subject::Subject, unit::Fault},
    quality::{precision, stability},
};

/// Time, speed and force along the drive, displacement of the centre of mass.
pub fn of_trajectory(trajectory: &Trajectory) -> Columns {
    let Trajectory { t, vz, force, x, y, z, .. } = trajectory;
    let all = [("t (s)", t), ("vz (m/s)", vz), ("force (N)", force), ("x (m)", x), ("y (m)", y), ("z (m)", z)];
    Columns(all.map(|(name, values)| Column::numbers(name, values.iter().copied())).into())
}

/// Samples of a mechanism.
pub fn of_samples(samples: &Samples) -> Columns {
    let column = |(k, name): (usize, &String)| Column::numbers(name, samples.rows.iter().map(|row| row[k]));
    Columns(samples.columns.iter().enumerate().map(column).collect())
}

/// Units of a population of `subject`, a row each: number, tightness, figures and gaps.
pub fn of_units(subject: &dyn Subject, units: &[Unit]) -> Columns {
    let column = |name: &str, unit: &str, value: fn(&Unit) -> Option<f64>| {
        Column::optional(name, units.iter().map(value)).in_unit(unit)
    };
    // A unit without a run has no figures; one that cannot be assembled stands still.
    fn runs(unit: &Unit, value: f64) -> Option<f64> {
        matches!(unit.outcome.fault, None | Some(Fault::Unassembled)).then_some(value)
    }
    let figures: [fn(&Unit) -> Option<f64>; 6] = [
        |unit| unit.outcome.breakaway,
        |unit| unit.outcome.peak_force,
        |unit| unit.outcome.settled_force,
        |unit| runs(unit, unit.outcome.final_velocity),
        |unit| runs(unit, unit.outcome.end.t),
        |unit| runs(unit, unit.outcome.end.z),
    ];
    let mut all = vec![
        Column::new("unit", Values::Counts(units.iter().map(|unit| unit.number).collect())),
        Column::numbers("tightness", units.iter().map(|unit| subject.tightness(&unit.gaps))),
    ];
    all.extend(
        figure_names(subject.kind()).into_iter().zip(figures).map(|((name, unit), value)| column(name, unit, value)),
    );
    all.push(Column::words("verdict", units.iter().map(|unit| Some(unit.outcome.verdict.to_string()))));
    all.push(Column::new("at_desk", Values::Flags(units.iter().map(|unit| unit.outcome.at_desk).collect())));
    all.extend(subject.gap_names().iter().enumerate().map(|(k, name)| {
        let gap = |unit: &Unit| (unit.gaps[k] != ABSENT).then_some(unit.gaps[k]);
        Column::optional(format!("{name} (m)"), units.iter().map(gap))
    }));
    Columns(all)
}

/// Names of a run's figures and their units; of a drive of this `kind`.
fn figure_names(kind: DriveKind) -> [(&'static str, &'static str); 9] {
    let choose = |name: [&'static str; 2], unit: [&'static str; 2]| {
        (kind.choose(name[0], name[1]), kind.choose(unit[0], unit[1]))
    };
    let (effort, travel) = (["N", "N·m"], ["m", "rad"]);
    [
        ("breakaway_s", "s"),
        choose(["peak_force_N", "peak_torque_N_m"], effort),
        choose(["settled_force_N", "settled_torque_N_m"], effort),
        choose(["final_velocity_m_per_s", "final_velocity_rad_per_s"], ["m/s", "rad/s"]),
        ("end_s", "s"),
        choose(["travel_m", "travel_rad"], travel),
        choose(["tips_m", "tips_rad"], travel),
        choose(["slows_m", "slows_rad"], travel),
        choose(["stops_m", "stops_rad"], travel),
    ]
}

/// The figures of `outcomes` as columns.
pub fn of_figures<'a>(kind: DriveKind, outcomes: impl Iterator<Item = &'a Outcome> + Clone) -> Vec<Column> {
    let values: [fn(&Outcome) -> Option<f64>; 9] = [
        |outcome| outcome.breakaway,
        |outcome| outcome.peak_force,
        |outcome| outcome.settled_force,
        |outcome| Some(outcome.final_velocity),
        |outcome| Some(outcome.end.t),
        |outcome| Some(outcome.end.z),
        |outcome| outcome.tips.map(|moment| moment.z),
        |outcome| outcome.slows.map(|moment| moment.z),
        |outcome| outcome.stops.map(|moment| moment.z),
    ];
    let column = |((name, unit), value)| Column::optional(name, outcomes.clone().map(value)).in_unit(unit);
    figure_names(kind).into_iter().zip(values).map(column).collect()
}

/// Figures and the class of each gap over n, a row a level.
pub fn of_sweep(sweep: &Sweep) -> Columns {
    let Sweep { levels, gaps, kind } = sweep;
    let mut all = vec![Column::numbers("n", levels.iter().map(|level| level.n))];
    all.extend(of_figures(*kind, levels.iter().map(|level| &level.outcome)));
    all.push(Column::words("verdict", levels.iter().map(|level| Some(level.outcome.verdict.to_string()))));
    all.extend(gaps.iter().enumerate().map(|(k, gap)| {
        let class = |level: &Level| level.classes[k].map(|class| class.to_string());
        Column::words(gap, levels.iter().map(class))
    }));
    Columns(all)
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
