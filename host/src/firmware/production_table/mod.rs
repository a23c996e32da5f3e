//! The table of a production: what units that complete their stroke need, in which modes they differ, and limits for a watch over them,
//! in the layout that [`slipfit_core::production`] describes and reads.
//!
//! Many units make two strokes each: their mean and modes. Some of them make six more, with a friction that differs from stroke to stroke: the code
//! of the controller itself learns from the first three and is judged by the others, so that limits hold for what it computes.

mod calibration;
mod margin;
mod modes;
mod response;
mod rows;
mod samples;
mod tail;
mod widths;
mod wish;

use slipfit_core::{
    production::{MODES_MOST, Production as Reader, Record, Row},
    table::{Encoding, layout::PRODUCTION_SIZE},
};

use self::{
    calibration::{Basis, Calibration},
    modes::Grid,
    rows::Rows,
    samples::Samples,
};
use super::flash::{self, AxisSpec};
use crate::population::{production::Production, strokes::Strokes, subject::Subject};

pub use margin::MARGIN_MOST;
pub use samples::Over;
pub use wish::{ProductionTableError, UNITS_LEAST, Wish};

/// A table of a production, and what there is to say of it.
#[derive(Clone, Debug)]
pub struct ProductionTable {
    /// The table.
    pub bytes: Vec<u8>,
    /// Its axes: rows, then places.
    pub axes: Vec<AxisSpec>,
    /// How it was calibrated.
    pub record: Record,
    /// Units that were simulated, and how many of them complete their stroke.
    pub units: [u64; 2],
    /// Root mean square (N) of the difference of a stroke's force from the mean, from what is expected of a taught unit before the stroke, and
    /// from what is expected with what the stroke has told so far.
    pub differences: [f64; 3],
    /// The same for mean and modes that fit the stroke itself: what the table cannot show.
    pub fit: f64,
    /// The greatest mean force (N), either sign.
    pub greatest: f64,
    /// Noise (N).
    pub noise: f64,
    /// Places, the mean force (N) there, and by how much the band is above and below it (N).
    pub band: Vec<[f64; 4]>,
}

/// Nodes of the shortest table and of the longest one: more show no more, and their modes take minutes.
const NODES: [usize; 2] = [16, 512];

/// Size (bytes) of a table of so many modes and nodes.
fn size(modes: usize, nodes: usize) -> usize {
    flash::length([Row::Mode as usize + modes, nodes], Encoding::I16) + PRODUCTION_SIZE
}

/// The most nodes with which so many `modes` fit into `bytes`; none if they do not.
fn nodes(modes: usize, bytes: usize) -> Option<usize> {
    let [least, most] = NODES;
    (least..=most).rev().find(|nodes| size(modes, *nodes) <= bytes)
}

/// Whether a table of the size that is wished for can be, found out before any run.
///
/// # Errors
/// [`ProductionTableError::Bytes`] if not.
pub fn check(wish: &Wish) -> Result<(), ProductionTableError> {
    let least = size(1, NODES[0]);
    if wish.bytes >= least { Ok(()) } else { Err(ProductionTableError::Bytes { bytes: wish.bytes, least }) }
}

/// How often `make` calls `done`, at most.
pub fn work(wish: &Wish) -> u64 {
    wish.units + wish.units.min(calibration::TAUGHT_UNITS as u64) + wish.units.min(margin::UNITS)
}

/// Makes the table of the `production` of `subject` that is wished for; `done` is called after each unit.
///
/// # Errors
/// [`ProductionTableError`] says why there is none.
pub fn make(
    subject: &dyn Subject,
    production: &Production,
    wish: &Wish,
    done: impl Fn() + Sync,
) -> Result<ProductionTable, ProductionTableError> {
    check(wish)?;
    let drive = subject.drive();
    let sign = if drive.speed < 0.0 { -1.0 } else { 1.0 };
    let strokes =
        Strokes { seed: wish.seed, numbers: 0..calibration::FIRSTS, friction: wish.friction, every: wish.period };
    let numbers: Vec<u64> = (0..wish.units).collect();
    let kept = strokes.simulate(
        subject,
        production,
        &numbers,
        |unit, strokes| {
            let complete = strokes.iter().filter(|(_, stroke)| stroke.is_complete());
            let samples = complete.map(|(friction, stroke)| Samples::of(*friction, stroke, wish.over, sign));
            let is_first = strokes.first().is_some_and(|(_, stroke)| stroke.is_complete());
            (is_first.then_some(unit), samples.collect::<Vec<_>>())
        },
        &done,
    )?;
    let (complete, firsts): (Vec<_>, Vec<_>) = kept.into_iter().unzip();
    let complete: Vec<u64> = complete.into_iter().flatten().collect();
    let firsts: Vec<Samples> = firsts.into_iter().flatten().collect();
    if complete.len() < UNITS_LEAST {
        return Err(ProductionTableError::TooFew { complete: complete.len(), units: wish.units });
    }
    let end = f64::from(firsts.iter().map(Samples::end).fold(f32::INFINITY, f32::min));
    let start = match wish.over {
        Over::Time => drive.ramp_start.max(0.0),
        // Where it stands it has no place of its own.
        Over::Position => end / 100.0,
    };
    if !(end > start * 1.01 && end > 0.0) {
        return Err(ProductionTableError::TooShort { start, end });
    }

    // As many modes, and as close nodes, as together show the strokes best.
    let mut best: Option<Rows> = None;
    for count in [MODES_MOST, 6, 4, 2, 1] {
        let Some(nodes) = nodes(count, wish.bytes) else { continue };
        let most = ((end - start) / wish.period) as usize + 1;
        let count_of_nodes = match wish.over {
            Over::Time => nodes.min(most.max(2)),
            Over::Position => nodes,
        };
        let step = (end - start) / (count_of_nodes - 1) as f64;
        // As f32 has it, and not beyond the end.
        let grid = Grid {
            first: f64::from(start as f32),
            step: f64::from((step * (1.0 - 1e-6)) as f32),
            count: count_of_nodes,
        };
        let rows = Rows::of(grid, wish.over, &firsts, count);
        if best.as_ref().is_none_or(|best| rows.fit < best.fit) {
            best = Some(rows);
        }
    }
    let rows = best.expect("one mode fits, as was checked");
    let greatest = rows.modes.mean[0].iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let noise = wish.noise * greatest;
    let basis =
        Basis { subject, production, wish, noise, sign, greatest, complete: &complete, firsts: &firsts, rows: &rows };
    let Calibration { widths, weight, record, differences } = basis.calibrated(&done)?;
    let spec = rows.spec(subject.hash(), widths, weight, record);
    let bytes = flash::encode(&spec)?;
    let opened = Reader::open(&bytes).expect("the encoder's own table");
    let band = rows.grid.places().into_iter().map(|at| {
        let row = |row: Row| f64::from(opened.row(row as usize, at as f32).map_or(0.0, |[force, _]| force));
        [at, row(Row::Mean), f64::from(record.band) * row(Row::Above), f64::from(record.band) * row(Row::Below)]
    });
    let band = band.collect();
    Ok(ProductionTable {
        bytes,
        axes: spec.axes,
        record,
        units: [wish.units, complete.len() as u64],
        differences,
        fit: rows.fit,
        greatest,
        noise,
        band,
    })
}
