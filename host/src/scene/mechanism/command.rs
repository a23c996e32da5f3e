//! Reading what a drive is commanded: a ramp, segments, or a record.

use nalgebra::Vector3;
use slipfit_core::drive::{Drive, Piece};
use slipfit_desk::drive::{Held, Pieces};
use slipfit_tolerance::unit::{self, Quantity};

use super::{
    recorded::{Recorded, recorded},
    segment::{Commanded, pieces},
};
use crate::{
    mechanism::{Command, Sampling},
    scene::{
        Problem, SceneError,
        parse::choice,
        quantity::{LEAST_RAMP, RAMP},
        value::Field,
    },
};

const PERIOD: Quantity = Quantity { units: unit::SECONDS, range: [1e-6, 1.0] };
const POSITION_GAIN: Quantity = Quantity { units: unit::PER_SECOND, range: [0.0, 1e6] };

/// What is read of a drive beside what it acts on.
pub(super) struct Controls {
    /// Gain, ramp and point.
    pub drive: Drive<f64>,
    /// What is commanded in place of the ramp, if anything is.
    pub command: Option<Command>,
    /// How its controller samples, if it does.
    pub sampling: Option<Sampling>,
}

/// Where a command stands, and how its drive follows it.
pub(super) struct Context<'a> {
    /// Whether the drive turns.
    pub turns: bool,
    /// Whether its body moves as commanded, whatever that takes.
    pub is_prescribed: bool,
    /// Whether it has a drive train, which may act without a command.
    pub has_train: bool,
    /// The scene's file.
    pub file_name: &'a str,
}

/// Reads the command of the drive of `table`, with this `gain`, at the point `point_b`.
pub(super) fn controls(
    table: &Field,
    gain: f64,
    point_b: Vector3<f64>,
    context: &Context,
) -> Result<Controls, SceneError> {
    let units = Commanded::new(context.turns);
    let record = table
        .get("record")
        .map(|field| recorded(&field, [context.turns, context.is_prescribed], context.file_name))
        .transpose()?;
    let mut sampling = sampling(table, context.is_prescribed)?;
    if let (Some(record), Some(field)) = (&record, table.get("record")) {
        let has_loop = sampling.as_ref().is_some_and(|of| of.position_gain.is_some());
        if record.is_position && !has_loop && !context.is_prescribed {
            let what = "recorded positions for a drive that controls its speed".into();
            let allowed =
                "a position loop, `position_gain` with `sampling`; or motion = \"prescribed\"; or recorded speeds";
            return Err(field.error(Problem::Unsupported { what }, allowed));
        }
    }
    let (drive, command) = match (table.get("segment"), record) {
        (Some(segments), None) => {
            let start = table.get("ramp_start").map(|field| field.to_number(&RAMP)).transpose()?.unwrap_or_default();
            refuse(table, &["ramp_end", "speed"], "segments", "the segments alone, each with its own speed")?;
            let pieces = pieces(&segments, table.get("cycles"), start, &units)?;
            (spanning(&segments, &pieces, gain, point_b)?, Some((pieces, false)))
        }
        (None, Some(Recorded { pieces, positions, .. })) => {
            refuse(table, &["ramp_start", "ramp_end", "speed", "cycles"], "a record", "the record alone")?;
            let field = table.get("record").unwrap_or_else(|| table.clone());
            // Positions that jump command no speed that is known.
            let drive = match &positions {
                None => spanning(&field, &pieces, gain, point_b)?,
                Some(positions) => spanning(&field, &jumps(&pieces, positions), gain, point_b)?,
            };
            if let (Some(sampling), Some(positions)) = (&mut sampling, positions) {
                sampling.positions = Some(positions.into());
            }
            (drive, Some((pieces, true)))
        }
        (Some(segments), Some(_)) => {
            return Err(segments.no_effect("beside a record", "one of record and segments"));
        }
        (None, None) => {
            if let Some(field) = table.get("cycles") {
                return Err(field.no_effect("without segments", "tables [[drive.segment]]"));
            }
            // Without a gain nothing is commanded.
            let states = |key: &&str| table.get(key).is_some();
            let is_idle = gain == 0.0 && context.has_train && !["ramp_start", "ramp_end", "speed"].iter().any(states);
            let (ramp_start, ramp_end) = if is_idle { (0.0, 1.0) } else { ramp(table)? };
            let speed = if is_idle { 0.0 } else { table.number("speed", &units.speed)? };
            (Drive { gain, ramp_start, ramp_end, speed, point_b }, None)
        }
    };
    let at_start = match &command {
        Some((pieces, _)) => {
            let begun = pieces.partition_point(|piece| piece.start <= 0.0);
            begun.checked_sub(1).map_or(0.0, |last| pieces[last].speed(0.0))
        }
        None => drive.command(0.0),
    };
    if context.is_prescribed && at_start.abs() > 1e-6 * drive.speed.abs() {
        let what = "a prescribed motion that has begun before the run".into();
        let field = table.get("motion").unwrap_or_else(|| table.clone());
        return Err(field.error(Problem::Unsupported { what }, "a command that begins at 0 s or later, from rest"));
    }
    let command = command.map(|(pieces, is_recorded)| Command { pieces: Pieces(pieces.into()), is_recorded });
    Ok(Controls { drive, command, sampling })
}

/// Refuses `keys` of the drive of `table` beside what replaces them.
fn refuse(table: &Field, keys: &[&str], beside: &str, allowed: &str) -> Result<(), SceneError> {
    match keys.iter().find_map(|key| table.get(key)) {
        Some(field) => Err(field.no_effect(format!("beside {beside}"), allowed)),
        None => Ok(()),
    }
}

/// How the controller of the drive of `table` samples, if it does.
fn sampling(table: &Field, is_prescribed: bool) -> Result<Option<Sampling>, SceneError> {
    let Some(field) = table.get("sampling") else {
        return match ["position_gain", "measures"].iter().find_map(|key| table.get(key)) {
            Some(field) => Err(field.no_effect("without `sampling`", "the period of the controller beside it")),
            None => Ok(None),
        };
    };
    if is_prescribed {
        return Err(field.no_effect("of a prescribed motion", "no such key, or no motion = \"prescribed\""));
    }
    let measures = table.get("measures").map(|field| choice(&field, [false, true], measured)).transpose()?;
    Ok(Some(Sampling {
        period: field.to_number(&PERIOD)?,
        position_gain: table.get("position_gain").map(|field| field.to_number(&POSITION_GAIN)).transpose()?,
        differentiates: measures.unwrap_or(false),
        positions: None,
        held: Held::default(),
    }))
}

/// What a controller measures that `differentiates` a position, or does not.
fn measured(differentiates: bool) -> &'static str {
    if differentiates { "position" } else { "speed" }
}

/// When the ramp starts and ends (s).
fn ramp(table: &Field) -> Result<(f64, f64), SceneError> {
    let start = table.number("ramp_start", &RAMP)?;
    let field = table.require("ramp_end", &RAMP.units())?;
    let end = field.to_number(&RAMP)?;
    if end - start < LEAST_RAMP {
        return Err(field.out_of_range("s", format!("more than ramp_start, {start} s, by 1 µs or more")));
    }
    Ok((start, end))
}

/// The speeds that lead from each of the `positions` to the next.
fn jumps(pieces: &[Piece<f64>], positions: &[f64]) -> Vec<Piece<f64>> {
    let speed = |i: usize| match (pieces.get(i + 1), positions.get(i + 1)) {
        (Some(next), Some(position)) => (position - positions[i]) / (next.start - pieces[i].start),
        _ => 0.0,
    };
    let at = |(i, piece): (usize, &Piece<f64>)| Piece { coefficients: [speed(i), 0.0, 0.0, 0.0], ..*piece };
    pieces.iter().enumerate().map(at).collect()
}

/// A ramp from the start to the end of the `pieces` that `field` states, to the greatest speed that they command.
fn spanning(field: &Field, pieces: &[Piece<f64>], gain: f64, point_b: Vector3<f64>) -> Result<Drive<f64>, SceneError> {
    let moves = pieces.iter().find(|piece| piece.coefficients.iter().any(|of| *of != 0.0));
    let ramp_start = moves.map_or(0.0, |piece| piece.start);
    // Sums of durations are rounded: a run that is as long as all segments comes to their end.
    let end = pieces.last().map_or(ramp_start, |piece| piece.start * (1.0 - 1e-12));
    let ramp_end = end.max(ramp_start + LEAST_RAMP);
    let ends = pieces.windows(2).map(|two| two[0].speed(two[1].start)).chain(pieces.iter().map(|p| p.coefficients[0]));
    let speed = ends.fold(0.0, |most: f64, speed| if speed.abs() > most.abs() { speed } else { most });
    if speed == 0.0 {
        return Err(field.out_of_range("", "at least one segment with a speed other than 0"));
    }
    Ok(Drive { gain, ramp_start, ramp_end, speed, point_b })
}
