//! The cyclic check of a table in use: an object of its own, so that the table itself is only ever read.

use slipfit_core::table::{Scrubber, Table};

use crate::{
    border::{Storage, input, make, object, object_mut},
    production::slipfit_watch,
    status::{Refusal, SLIPFIT_TABLE_CHECKSUM, slipfit_status, status},
    table::{slipfit_table, slipfit_table3},
};

/// Memory of a cyclic check; opaque.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_scrubber {
    words: [u64; 8],
}

pub(crate) struct Scrubbing {
    scrubber: Scrubber,
    region: &'static [u8],
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_scrubber {
    type Object = Scrubbing;
    const MARK: u32 = 0x534c_4331;
}

fn scrubbing<const N: usize>(table: &Table<'static, N>) -> Scrubbing {
    Scrubbing { scrubber: Scrubber::new(table), region: table.bytes() }
}

/// Makes a cyclic check of an open table in `*storage`. The table is only read, at any time and by anybody.
///
/// # Safety
/// Pointers that are neither null nor misaligned point at what their types say; the table has been written before; nobody
/// else uses `*storage` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_scrubber_init(
    storage: *mut slipfit_scrubber,
    table: *const slipfit_table,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe { make(storage, || Ok(scrubbing(object(table)?))) })
}

/// As slipfit_scrubber_init, of a table over three axes.
///
/// # Safety
/// As for slipfit_scrubber_init.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_scrubber_init3(
    storage: *mut slipfit_scrubber,
    table: *const slipfit_table3,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe { make(storage, || Ok(scrubbing(object(table)?))) })
}

/// As slipfit_scrubber_init, of the table of a production that a watch was made by.
///
/// # Safety
/// As for slipfit_scrubber_init.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_scrubber_init_watch(
    storage: *mut slipfit_scrubber,
    watch: *const slipfit_watch,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe { make(storage, || Ok(scrubbing(object(watch)?.watch.production().table()))) })
}

/// Looks at the next bytes of the table, `most` at most but at least one, and sets `*rounds` one up at the end of a round,
/// whatever was found in it. SLIPFIT_TABLE_CHECKSUM at the end of a round in which a byte differed; call it again and again.
///
/// # Safety
/// As for slipfit_scrubber_init; the memory has been written before; nobody else uses `*rounds` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_scrubber_check(
    storage: *mut slipfit_scrubber,
    most: u32,
    rounds: *mut u32,
) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        let (Scrubbing { scrubber, region }, so_far) = unsafe { (object_mut(storage)?, *input(rounds)?) };
        let is_over = scrubber.check(region, usize::try_from(most).unwrap_or(usize::MAX));
        if is_over != Ok(false) {
            // SAFETY: it has just been read, and the caller's promise.
            unsafe { rounds.write(so_far.wrapping_add(1)) };
        }
        is_over.map(drop).map_err(|_| Refusal(SLIPFIT_TABLE_CHECKSUM))
    })
}
