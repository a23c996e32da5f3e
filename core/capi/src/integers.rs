//! Lookups in integers, for cores without a floating-point unit.

use slipfit_core::table::{IntegerLookup, Integers};

use crate::{
    border::{Storage, make, object, output},
    status::{Refusal, SLIPFIT_TABLE_ENCODING, SLIPFIT_TABLE_VALUE, slipfit_status, status},
    table::slipfit_table,
};

/// Memory of a table at one level, for lookups in integers; opaque. The table itself stays where it is.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_integers {
    words: [u64; 16],
}

/// What a table says about one point, in its own integers.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_integer_lookup {
    /// Force, in the units of the table's forces.
    pub force: i32,
    /// Velocity, in the units of its velocities.
    pub velocity: i32,
    /// 1 if the point or the level lay outside the grid, 0 if not.
    pub clamped: u32,
    /// 1 if the level lies between motions whose verdicts differ, 0 if not.
    pub mixed: u32,
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_integers {
    type Object = Integers<'static>;
    const MARK: u32 = 0x534c_4931;
}

/// Makes a table of i16 at the tolerance level `n` in `*storage`, for counts of `unit` along its second axis (s or m): 0.001 for
/// milliseconds. It must be no greater than the distance of two nodes. Only this call uses floating point. SLIPFIT_TABLE_ENCODING if the
/// table's values are f32: `slipfit table --max-error` makes one of i16.
///
/// # Safety
/// Pointers that are neither null nor misaligned point at what their types say; the table has been written before, and its bytes stay as
/// they are for as long as this is used; nobody else uses `*storage` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_integers_init(
    storage: *mut slipfit_integers,
    table: *const slipfit_table,
    n: f32,
    unit: f32,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        make(storage, || {
            let table = object(table)?.i16().ok_or(Refusal(SLIPFIT_TABLE_ENCODING))?;
            Ok(table.integers(n, unit)?)
        })
    })
}

/// Writes to `*force` (N) and `*velocity` (m/s) what an integer of 1 stands for.
///
/// # Safety
/// As for slipfit_integers_look_up.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_integers_scales(
    storage: *const slipfit_integers,
    force: *mut f32,
    velocity: *mut f32,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        let [of_force, of_velocity] = object(storage)?.scales();
        output(force, || Ok(of_force))?;
        output(velocity, || Ok(of_velocity))
    })
}

/// Force and velocity `at` so many counts of the unit. SLIPFIT_TABLE_VALUE as for slipfit_table_look_up.
///
/// # Safety
/// As for slipfit_integers_init; the memory has been written before; nobody else uses `*lookup` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_integers_look_up(
    storage: *const slipfit_integers,
    at: i32,
    lookup: *mut slipfit_integer_lookup,
) -> slipfit_status {
    let mut is_damaged = false;
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(lookup, || {
            let IntegerLookup { force, velocity, clamped, mixed, damaged } = object(storage)?.lookup(at);
            is_damaged = damaged;
            Ok(slipfit_integer_lookup { force, velocity, clamped: clamped.into(), mixed: mixed.into() })
        })?;
        if is_damaged { Err(Refusal(SLIPFIT_TABLE_VALUE)) } else { Ok(()) }
    })
}
