//! What functions return.

use core::ffi::c_char;

use slipfit_core::{ParameterError, monitor::MonitorError, table::TableError};

/// 0 if a function did what it says, or why it did nothing.
pub type slipfit_status = i32;

/// Done.
pub const SLIPFIT_OK: slipfit_status = 0;
/// A pointer is null.
pub const SLIPFIT_NULL: slipfit_status = 1;
/// A pointer is not aligned as its type asks for.
pub const SLIPFIT_MISALIGNED: slipfit_status = 2;
/// A length exceeds the address space, or is not one of whole words.
pub const SLIPFIT_LENGTH: slipfit_status = 3;
/// The object was not made, or making it failed.
pub const SLIPFIT_NOT_MADE: slipfit_status = 4;
/// A parameter is not finite or out of bounds.
pub const SLIPFIT_PARAMETER: slipfit_status = 5;
/// The scene asks for laws or a scheme that the library was not built with.
pub const SLIPFIT_LAW: slipfit_status = 6;
/// The motion left the finite range and was held where it was.
pub const SLIPFIT_NOT_FINITE: slipfit_status = 7;
/// The scene's step is too large for the unit.
pub const SLIPFIT_STEP: slipfit_status = 8;
/// The prediction is behind the clock: what it says holds for an earlier time.
pub const SLIPFIT_BEHIND: slipfit_status = 9;
/// The motion is already predicted for that instant.
pub const SLIPFIT_LATE: slipfit_status = 10;
/// The header that the program was compiled with is not the library's.
pub const SLIPFIT_HEADER: slipfit_status = 11;
/// The region ends before the table does.
pub const SLIPFIT_TABLE_TRUNCATED: slipfit_status = 16;
/// No table starts there.
pub const SLIPFIT_TABLE_MAGIC: slipfit_status = 17;
/// The table has another version of the format.
pub const SLIPFIT_TABLE_VERSION: slipfit_status = 18;
/// The table is damaged.
pub const SLIPFIT_TABLE_CHECKSUM: slipfit_status = 19;
/// A field of the table's header is out of bounds.
pub const SLIPFIT_TABLE_HEADER: slipfit_status = 20;
/// A value of the table is out of bounds; of an open table: it has changed since.
pub const SLIPFIT_TABLE_VALUE: slipfit_status = 21;
/// The table is over another number of axes.
pub const SLIPFIT_TABLE_AXES: slipfit_status = 22;
/// The table was made for another scene or other laws.
pub const SLIPFIT_TABLE_SCENE: slipfit_status = 23;
/// The table is over another quantity than asked for: over position instead of time, say.
pub const SLIPFIT_TABLE_KIND: slipfit_status = 24;
/// The slot has no room for the record behind its table, or does not end between programming words.
pub const SLIPFIT_TABLE_SLOT: slipfit_status = 25;
/// The table's values are f32, where integers are asked for.
pub const SLIPFIT_TABLE_ENCODING: slipfit_status = 26;
/// The table has more levels than a bank.
pub const SLIPFIT_BANK_LEVELS: slipfit_status = 32;
/// Too few samples for an estimate.
pub const SLIPFIT_BANK_SAMPLES: slipfit_status = 33;
/// The estimate is of no unit of the table, not within the band of the level that the monitor was made for, or less certain than
/// that band.
pub const SLIPFIT_MONITOR_BAND: slipfit_status = 34;
/// The table has no unit of the level: those on either side end differently, one runs and one jams, say.
pub const SLIPFIT_MONITOR_MIXED: slipfit_status = 35;
/// No unit was saved there, or by another version.
pub const SLIPFIT_UNIT_MAGIC: slipfit_status = 40;
/// The saved unit is damaged.
pub const SLIPFIT_UNIT_CHECKSUM: slipfit_status = 41;
/// The unit was saved for another scene or other laws.
pub const SLIPFIT_UNIT_SCENE: slipfit_status = 42;
/// Too few strokes to say.
pub const SLIPFIT_UNIT_STROKES: slipfit_status = 43;

/// The version of the library, 10000·major + 100·minor + patch.
pub const SLIPFIT_VERSION: u32 = 200;

/// The version of the library that is linked, to be compared with the header's `SLIPFIT_VERSION`.
#[unsafe(no_mangle)]
pub extern "C" fn slipfit_version() -> u32 {
    SLIPFIT_VERSION
}

/// What a status is called, such as `SLIPFIT_OK`; `unknown` for what no function returns. Ends with a zero, and stays.
#[unsafe(no_mangle)]
pub extern "C" fn slipfit_status_name(status: slipfit_status) -> *const c_char {
    let name = match status {
        SLIPFIT_OK => c"SLIPFIT_OK",
        SLIPFIT_NULL => c"SLIPFIT_NULL",
        SLIPFIT_MISALIGNED => c"SLIPFIT_MISALIGNED",
        SLIPFIT_LENGTH => c"SLIPFIT_LENGTH",
        SLIPFIT_NOT_MADE => c"SLIPFIT_NOT_MADE",
        SLIPFIT_PARAMETER => c"SLIPFIT_PARAMETER",
        SLIPFIT_LAW => c"SLIPFIT_LAW",
        SLIPFIT_NOT_FINITE => c"SLIPFIT_NOT_FINITE",
        SLIPFIT_STEP => c"SLIPFIT_STEP",
        SLIPFIT_BEHIND => c"SLIPFIT_BEHIND",
        SLIPFIT_LATE => c"SLIPFIT_LATE",
        SLIPFIT_HEADER => c"SLIPFIT_HEADER",
        SLIPFIT_TABLE_TRUNCATED => c"SLIPFIT_TABLE_TRUNCATED",
        SLIPFIT_TABLE_MAGIC => c"SLIPFIT_TABLE_MAGIC",
        SLIPFIT_TABLE_VERSION => c"SLIPFIT_TABLE_VERSION",
        SLIPFIT_TABLE_CHECKSUM => c"SLIPFIT_TABLE_CHECKSUM",
        SLIPFIT_TABLE_HEADER => c"SLIPFIT_TABLE_HEADER",
        SLIPFIT_TABLE_VALUE => c"SLIPFIT_TABLE_VALUE",
        SLIPFIT_TABLE_AXES => c"SLIPFIT_TABLE_AXES",
        SLIPFIT_TABLE_SCENE => c"SLIPFIT_TABLE_SCENE",
        SLIPFIT_TABLE_KIND => c"SLIPFIT_TABLE_KIND",
        SLIPFIT_TABLE_SLOT => c"SLIPFIT_TABLE_SLOT",
        SLIPFIT_TABLE_ENCODING => c"SLIPFIT_TABLE_ENCODING",
        SLIPFIT_BANK_LEVELS => c"SLIPFIT_BANK_LEVELS",
        SLIPFIT_BANK_SAMPLES => c"SLIPFIT_BANK_SAMPLES",
        SLIPFIT_MONITOR_BAND => c"SLIPFIT_MONITOR_BAND",
        SLIPFIT_MONITOR_MIXED => c"SLIPFIT_MONITOR_MIXED",
        SLIPFIT_UNIT_MAGIC => c"SLIPFIT_UNIT_MAGIC",
        SLIPFIT_UNIT_CHECKSUM => c"SLIPFIT_UNIT_CHECKSUM",
        SLIPFIT_UNIT_SCENE => c"SLIPFIT_UNIT_SCENE",
        SLIPFIT_UNIT_STROKES => c"SLIPFIT_UNIT_STROKES",
        _ => c"unknown",
    };
    name.as_ptr()
}

/// Why a call did nothing.
pub(crate) struct Refusal(pub(crate) slipfit_status);

impl<S> From<ParameterError<S>> for Refusal {
    fn from(_: ParameterError<S>) -> Self {
        Self(SLIPFIT_PARAMETER)
    }
}

impl From<TableError> for Refusal {
    fn from(error: TableError) -> Self {
        Self(match error {
            TableError::Truncated => SLIPFIT_TABLE_TRUNCATED,
            TableError::Magic => SLIPFIT_TABLE_MAGIC,
            TableError::Version { .. } => SLIPFIT_TABLE_VERSION,
            TableError::Checksum => SLIPFIT_TABLE_CHECKSUM,
            TableError::Header(_) => SLIPFIT_TABLE_HEADER,
            TableError::Value(_) => SLIPFIT_TABLE_VALUE,
            TableError::Axes { .. } => SLIPFIT_TABLE_AXES,
            TableError::Kind { .. } => SLIPFIT_TABLE_KIND,
            TableError::Scene { .. } => SLIPFIT_TABLE_SCENE,
            TableError::Slot { .. } => SLIPFIT_TABLE_SLOT,
            // Only a slot given as null cannot be read, and the other one is told of first.
            TableError::Unreadable => SLIPFIT_NULL,
        })
    }
}

impl From<MonitorError> for Refusal {
    fn from(error: MonitorError) -> Self {
        match error {
            MonitorError::Table(error) => error.into(),
            MonitorError::Parameter(error) => error.into(),
            MonitorError::Mixed { .. } => Self(SLIPFIT_MONITOR_MIXED),
        }
    }
}

/// The status of a call that did `work`.
pub(crate) fn status(work: impl FnOnce() -> Result<(), Refusal>) -> slipfit_status {
    match work() {
        Ok(()) => SLIPFIT_OK,
        Err(Refusal(why)) => why,
    }
}
