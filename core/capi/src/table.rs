//! The flash table over tolerance level and time.

use slipfit_core::table::{Patrol, Slots, Table};

use crate::{
    border::{Storage, bytes, make, object, object_mut, output},
    status::{Refusal, SLIPFIT_TABLE_CHECKSUM, slipfit_status, status},
};

/// Memory of an open table; opaque. The table itself stays where it is.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct slipfit_table {
    words: [u64; 40],
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
}

/// Where an update goes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_spare {
    /// The slot, 0 or 1.
    pub slot: u32,
    /// The sequence number of its record: that number, then its complement, in the slot's last 8 bytes.
    pub sequence: u32,
}

pub(crate) struct Opened {
    pub(crate) table: Table<'static>,
    region: &'static [u8],
    /// Bytes of the table that the cyclic check has seen.
    patrol: Patrol,
}

// SAFETY: plain words.
unsafe impl Storage for slipfit_table {
    type Object = Opened;
    const MARK: u32 = 0x534c_5431;
}

fn opened(table: Table<'static>, region: &'static [u8]) -> Opened {
    Opened { patrol: Patrol::new(&table), table, region }
}

/// Checks the table at `region` completely and opens it in `*storage`. `scene_hash` is what the table must have been
/// made for, SLIPFIT_TABLE_SCENE_HASH of its header.
///
/// # Safety
/// Pointers that are neither null nor misaligned point at what their types say; `length` bytes are at `region` and stay
/// as they are for as long as the table is used; nobody else uses `*storage` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_table_open(
    storage: *mut slipfit_table,
    region: *const u8,
    length: u32,
    scene_hash: u64,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        make(storage, || {
            let region = bytes(region, length)?;
            Ok(opened(Table::open(region)?.expect_scene(scene_hash)?, region))
        })
    })
}

/// Opens the newer valid table of two slots of `length` bytes each, and says where the next update goes.
///
/// # Safety
/// As for slipfit_table_open; nobody else uses `*spare` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_slots_open(
    storage: *mut slipfit_table,
    first: *const u8,
    second: *const u8,
    length: u32,
    scene_hash: u64,
    spare: *mut slipfit_spare,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        let regions = [bytes(first, length)?, bytes(second, length)?];
        let slots = Slots::<2>::open(regions, scene_hash);
        let (slot, sequence) = slots.spare();
        output(spare, || Ok(slipfit_spare { slot: slot as u32, sequence }))?;
        let [first, second] = regions;
        // The newest table is never in the spare slot.
        make(storage, || Ok(opened(*slots.newest()?, if slot == 0 { second } else { first })))
    })
}

/// Force and velocity of a unit of tolerance level `n` at the time `t` (s).
///
/// # Safety
/// As for slipfit_table_open; the memory has been written before; nobody else uses `*lookup` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_table_look_up(
    storage: *const slipfit_table,
    n: f32,
    t: f32,
    lookup: *mut slipfit_lookup,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(lookup, || {
            let found = object(storage)?.table.lookup([n, t]);
            Ok(slipfit_lookup { force: found.force, velocity: found.velocity, clamped: found.clamped.into() })
        })
    })
}

/// The cyclic check: looks at the next bytes, `most` at most. SLIPFIT_TABLE_CHECKSUM at the end of a round in which a
/// byte differed; call it again and again.
///
/// # Safety
/// As for slipfit_table_open; the memory has been written before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_table_check(storage: *mut slipfit_table, most: u32) -> slipfit_status {
    status(|| {
        // SAFETY: the caller's promise.
        let opened = unsafe { object_mut(storage)? };
        let most = usize::try_from(most).unwrap_or(usize::MAX);
        opened.patrol.check(opened.region, most).map(drop).map_err(|_| Refusal(SLIPFIT_TABLE_CHECKSUM))
    })
}
