//! The flash table over tolerance level and time or position, and the one over position and commanded speed.

use slipfit_core::table::{AxisKind, Lookup, Table};

use crate::{
    border::{Storage, bytes, make, object, output},
    status::{Refusal, SLIPFIT_PARAMETER, SLIPFIT_TABLE_VALUE, slipfit_status, status},
};

/// The second axis of a table is time (s).
pub const SLIPFIT_AXIS_TIME: u32 = 2;
/// The second axis of a table is position (m), from the motion's start on.
pub const SLIPFIT_AXIS_POSITION: u32 = 3;

/// Memory of an open table over two axes; opaque. The table itself stays where it is.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_table {
    words: [u64; 40],
}

/// Memory of an open table over three axes; opaque. The table itself stays where it is.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_table3 {
    words: [u64; 48],
}

/// What a table says about one point.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_lookup {
    /// Force (N).
    pub force: f32,
    /// Velocity (m/s).
    pub velocity: f32,
    /// 1 if the point lay outside the grid or was not a number, 0 if not.
    pub clamped: u32,
    /// 1 if the point lies between motions whose verdicts differ, such as a unit that runs and one that jams, so that these are
    /// values of no unit; 0 if not.
    pub mixed: u32,
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_table {
    type Object = Table<'static, 2>;
    const MARK: u32 = 0x534c_5431;
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_table3 {
    type Object = Table<'static, 3>;
    const MARK: u32 = 0x534c_5433;
}

/// Writes what the open table in `storage` has `at` a point to `lookup`.
///
/// # Safety
/// As for slipfit_table_look_up.
unsafe fn look_up<S: Storage<Object = Table<'static, N>>, const N: usize>(
    storage: *const S,
    at: [f32; N],
    lookup: *mut slipfit_lookup,
) -> Result<(), Refusal> {
    let mut is_damaged = false;
    // SAFETY: the caller's promise.
    unsafe {
        output(lookup, || {
            let Lookup { force, velocity, clamped, mixed, damaged } = object(storage)?.lookup(at);
            is_damaged = damaged;
            Ok(slipfit_lookup { force, velocity, clamped: clamped.into(), mixed: mixed.into() })
        })?;
    }
    if is_damaged { Err(Refusal(SLIPFIT_TABLE_VALUE)) } else { Ok(()) }
}

/// The axes of a table whose second one is `over`.
pub(crate) fn axes(over: u32) -> Result<[AxisKind; 2], Refusal> {
    match over {
        SLIPFIT_AXIS_TIME => Ok([AxisKind::Level, AxisKind::Time]),
        SLIPFIT_AXIS_POSITION => Ok([AxisKind::Level, AxisKind::Position]),
        _ => Err(Refusal(SLIPFIT_PARAMETER)),
    }
}

/// Checks the table at `region` completely and opens it in `*storage`. It must be over tolerance level and `over`,
/// SLIPFIT_AXIS_TIME or SLIPFIT_AXIS_POSITION, and made for `scene_hash`: SLIPFIT_SCENE_HASH of the scene's header.
///
/// # Safety
/// Pointers that are neither null nor misaligned point at what their types say; `length` bytes are at `region` and stay
/// as they are for as long as the table is used; nobody else uses `*storage` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_table_open(
    storage: *mut slipfit_table,
    region: *const u8,
    length: u32,
    over: u32,
    scene_hash: u64,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        make(storage, || Ok(Table::open(bytes(region, length)?)?.expect_axes(axes(over)?)?.expect_scene(scene_hash)?))
    })
}

/// As slipfit_table_open, a table over tolerance level, position and commanded speed.
///
/// # Safety
/// As for slipfit_table_open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_table3_open(
    storage: *mut slipfit_table3,
    region: *const u8,
    length: u32,
    scene_hash: u64,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        make(storage, || {
            let axes = [AxisKind::Level, AxisKind::Position, AxisKind::Velocity];
            Ok(Table::open(bytes(region, length)?)?.expect_axes(axes)?.expect_scene(scene_hash)?)
        })
    })
}

/// Force and velocity of a unit of tolerance level `n` at `at`, the time (s) or position (m) since the motion's start.
/// SLIPFIT_TABLE_VALUE if one of them lay outside the range of the table's own values, so that the table has changed since it was
/// opened; then `*lookup` has the end of that range. What changes within it, a slipfit_scrubber alone finds.
///
/// # Safety
/// As for slipfit_table_open; the memory has been written before; nobody else uses `*lookup` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_table_look_up(
    storage: *const slipfit_table,
    n: f32,
    at: f32,
    lookup: *mut slipfit_lookup,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe { look_up(storage, [n, at], lookup) })
}

/// Force and velocity of a unit of tolerance level `n` at the position `z` (m), commanded to `speed` (m/s). As
/// slipfit_table_look_up.
///
/// # Safety
/// As for slipfit_table_look_up.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_table3_look_up(
    storage: *const slipfit_table3,
    n: f32,
    z: f32,
    speed: f32,
    lookup: *mut slipfit_lookup,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe { look_up(storage, [n, z, speed], lookup) })
}
