//! The watch over a unit by a table of its production, and what is known of the unit.

use slipfit_core::{
    production::{Production, ProductionError, Sample, SavedError, Stroke, Unit, Watch},
    table::AnyNodes,
};

use crate::{
    border::{Storage, bytes, input, make, object, object_mut, output},
    monitor::code,
    status::{
        Refusal, SLIPFIT_TABLE_VALUE, SLIPFIT_UNIT_CHECKSUM, SLIPFIT_UNIT_MAGIC, SLIPFIT_UNIT_SCENE,
        SLIPFIT_UNIT_STROKES, slipfit_status, status,
    },
    table::axes,
};

/// Size of a saved unit (bytes).
pub const SLIPFIT_UNIT_SIZE: u32 = 112;

const _: () = assert!(SLIPFIT_UNIT_SIZE as usize == slipfit_core::production::SAVED_SIZE);

/// What the drive measures once a period, for a watch by a production. What it fails to measure is NAN.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_production_sample {
    /// Time since the motion's start (s), or position (m), as the table has it.
    pub at: f32,
    /// The drive's force (N).
    pub force: f32,
    /// The speed along the drive (m/s).
    pub speed: f32,
    /// The commanded speed (m/s).
    pub command: f32,
}

/// What a watch by a production says of a sample.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_production_report {
    /// SLIPFIT_BLIND, SLIPFIT_FREE, SLIPFIT_TIGHT, SLIPFIT_JAM, SLIPFIT_NO_DATA or SLIPFIT_ENDED.
    pub verdict: u32,
    /// The force (N) that is expected of this unit now, with what this stroke has told of its friction so far.
    pub expected: f32,
    /// The force (N) that was expected before the stroke: before the unit is taught that of the mean.
    pub own: f32,
    /// The speed (m/s) that is expected.
    pub speed: f32,
    /// By how much (N) the smoothed force exceeds the expected one, in the direction of the command.
    pub excess: f32,
    /// By how much (N) it may.
    pub limit: f32,
}

/// What a whole stroke says.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_stroke_end {
    /// SLIPFIT_JAM or SLIPFIT_TIGHT if a sample said so, SLIPFIT_TIGHT if the friction has risen, SLIPFIT_NO_DATA if pieces of the stroke are
    /// missing, else SLIPFIT_FREE.
    pub verdict: u32,
    /// 1 if the unit was learned from it, 0 if not.
    pub learned: u32,
    /// By what share the friction is above that of the unit's first strokes; 0 before the fourth.
    pub rise: f32,
    /// The standard deviation of that; infinite before the fourth.
    pub deviation: f32,
}

/// How the friction of a unit changes over its strokes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_wear {
    /// Rise of the friction now, as a share of that of the first strokes.
    pub rise: f32,
    /// Rise a stroke.
    pub slope: f32,
    /// Standard deviation of the slope.
    pub deviation: f32,
    /// Strokes until one unit in a hundred would not complete its stroke, by the slope; infinite where it does not rise.
    pub strokes_left: f32,
    /// The same by the steepest slope that is as likely as 1 in 20.
    pub strokes_left_least: f32,
}

/// Memory of a watch by a production and of its stroke; opaque. The table itself stays where it is.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_watch {
    words: [u64; 96],
}

/// Memory of what is known of a unit; opaque.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_unit {
    words: [u64; 16],
}

#[derive(Clone, Copy)]
pub(crate) struct Watching {
    pub(crate) watch: Watch<'static, AnyNodes<'static>>,
    stroke: Stroke,
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_watch {
    type Object = Watching;
    const MARK: u32 = 0x534c_5731;
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_unit {
    type Object = Unit;
    const MARK: u32 = 0x534c_5531;
}

impl From<ProductionError> for Refusal {
    fn from(error: ProductionError) -> Self {
        match error {
            ProductionError::Table(error) => error.into(),
            ProductionError::Parameter(error) => error.into(),
        }
    }
}

impl From<SavedError> for Refusal {
    fn from(error: SavedError) -> Self {
        Self(match error {
            SavedError::Magic => SLIPFIT_UNIT_MAGIC,
            SavedError::Checksum => SLIPFIT_UNIT_CHECKSUM,
            SavedError::Scene { .. } => SLIPFIT_UNIT_SCENE,
        })
    }
}

/// Checks the table of a production at `region` completely and makes a watch by it in `*storage`, at the start of a stroke. The table must be over
/// `over`, SLIPFIT_AXIS_TIME or SLIPFIT_AXIS_POSITION, and made for `scene_hash`. Of the strokes of units that complete them the watch gives
/// a false alarm in a share `rate`, 1e-6 to 1e-2.
///
/// # Safety
/// Pointers that are neither null nor misaligned point at what their types say; `length` bytes are at `region` and stay
/// as they are for as long as the watch is used; nobody else uses `*storage` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_watch_init(
    storage: *mut slipfit_watch,
    region: *const u8,
    length: u32,
    over: u32,
    scene_hash: u64,
    rate: f32,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        make(storage, || {
            let [_, over] = axes(over)?;
            let production = Production::open(bytes(region, length)?)?.expect_over(over)?.expect_scene(scene_hash)?;
            let watch = Watch::new(production, rate)?;
            Ok(Watching { watch, stroke: watch.start() })
        })
    })
}

/// Starts another stroke.
///
/// # Safety
/// As for slipfit_watch_init; the watch has been written before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_watch_start(storage: *mut slipfit_watch) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        let watching = unsafe { object_mut(storage)? };
        watching.stroke = watching.watch.start();
        Ok(())
    })
}

/// What a sample says of the stroke of `*unit`, after those before it. SLIPFIT_TABLE_VALUE if the table has changed since it was opened; the
/// report is written then, too.
///
/// # Safety
/// As for slipfit_watch_start; the unit has been written before; nobody else uses `*report` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_watch_step(
    storage: *mut slipfit_watch,
    unit: *const slipfit_unit,
    sample: *const slipfit_production_sample,
    report: *mut slipfit_production_report,
) -> slipfit_status {
    let mut is_damaged = false;
    // SAFETY: the caller's promise.
    let done = status(|| unsafe {
        output(report, || {
            let slipfit_production_sample { at, force, speed, command } = *input(sample)?;
            let unit = object(unit)?;
            let Watching { watch, stroke } = object_mut(storage)?;
            let report = watch.step(unit, stroke, &Sample { at, force, speed, command });
            is_damaged = report.damaged;
            Ok(slipfit_production_report {
                verdict: code(report.verdict),
                expected: report.expected,
                own: report.own,
                speed: report.speed,
                excess: report.excess,
                limit: report.limit,
            })
        })
    });
    if is_damaged { SLIPFIT_TABLE_VALUE } else { done }
}

/// What the stroke says as a whole, after its last sample, and what `*unit` learns from it. Call it once a stroke, then
/// slipfit_watch_start.
///
/// # Safety
/// As for slipfit_watch_step; nobody else uses `*unit` and `*end` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_watch_finish(
    storage: *const slipfit_watch,
    unit: *mut slipfit_unit,
    end: *mut slipfit_stroke_end,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(end, || {
            let Watching { watch, stroke } = object(storage)?;
            let end = watch.finish(object_mut(unit)?, stroke);
            Ok(slipfit_stroke_end {
                verdict: code(end.verdict),
                learned: end.is_learned.into(),
                rise: end.rise,
                deviation: end.deviation,
            })
        })
    })
}

/// How the friction of `*unit` changes over its strokes. SLIPFIT_UNIT_STROKES before the third stroke after its reference of twenty.
///
/// # Safety
/// As for slipfit_watch_step; nobody else uses `*wear` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_watch_wear(
    storage: *const slipfit_watch,
    unit: *const slipfit_unit,
    wear: *mut slipfit_wear,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(wear, || {
            let record = object(storage)?.watch.production().record();
            let line = object(unit)?.drift().trend().line(record.deviation).ok_or(Refusal(SLIPFIT_UNIT_STROKES))?;
            let [strokes_left, strokes_left_least] = line.strokes_until(record.margin);
            let (rise, slope, deviation) = (line.rise, line.slope, line.deviation);
            Ok(slipfit_wear { rise, slope, deviation, strokes_left, strokes_left_least })
        })
    })
}

/// Makes a unit in `*storage` that has made no stroke: the mean of its production.
///
/// # Safety
/// If the pointer is neither null nor misaligned, memory for a unit is there, and nobody else uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_unit_init(storage: *mut slipfit_unit) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe { make(storage, || Ok(Unit::default())) })
}

/// Writes what is known of a unit to the SLIPFIT_UNIT_SIZE bytes at `saved`, with a checksum, for non-volatile memory.
///
/// # Safety
/// As for slipfit_unit_init; the unit has been written before; if `saved` is not null, nobody else uses those bytes meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_unit_save(
    storage: *const slipfit_unit,
    scene_hash: u64,
    saved: *mut u8,
) -> slipfit_status {
    // SAFETY: the caller's promise; an array of bytes is aligned everywhere.
    status(|| unsafe {
        output(saved.cast::<[u8; SLIPFIT_UNIT_SIZE as usize]>(), || Ok(object(storage)?.to_bytes(scene_hash)))
    })
}

/// Makes the unit in `*storage` that was saved in the SLIPFIT_UNIT_SIZE bytes at `saved`. SLIPFIT_UNIT_MAGIC if none was, SLIPFIT_UNIT_CHECKSUM
/// if they have changed, SLIPFIT_UNIT_SCENE if it was saved for another scene.
///
/// # Safety
/// As for slipfit_unit_init; if `saved` is not null, the bytes are there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_unit_load(
    storage: *mut slipfit_unit,
    scene_hash: u64,
    saved: *const u8,
) -> slipfit_status {
    // SAFETY: the caller's promise; an array of bytes is aligned everywhere.
    status(|| unsafe {
        make(storage, || {
            let saved = input(saved.cast::<[u8; SLIPFIT_UNIT_SIZE as usize]>())?;
            Ok(Unit::from_bytes(saved, scene_hash)?)
        })
    })
}
