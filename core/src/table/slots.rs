//! Two slots for a table, so that a new one can be flashed while the old one stays.
//!
//! A slot is a region of flash that can be erased on its own. The table stands at its start; its last
//! [`RECORD_SIZE`] bytes hold the sequence number (u32, little-endian) and the number's complement, or are erased. An
//! update goes in this order, and a power cut after any byte of it leaves a valid table:
//! 1. take the slot that [`Slots::spare`] names and the number that it gives, and erase that slot;
//! 2. write the table into it and check it there, by [`Table::open`], [`Table::expect_axes`] and [`Table::expect_scene`];
//! 3. write the [`record`] to the slot's end.
//!
//! The record only says which of two valid tables is the newer one. Without it, as flashed in the factory or cut off
//! before the last step, a table is older than any that has one.

use super::{AxisKind, Table, TableError};

/// Size of the record at the end of a slot (bytes), and its alignment: a double word, which is what many flash memories
/// write at once.
pub const RECORD_SIZE: usize = 8;

/// Two regions of flash, each for one table over `N` axes.
#[derive(Clone, Copy, Debug)]
pub struct Slots<'a, const N: usize = 2> {
    tables: [Result<Table<'a, N>, TableError>; 2],
    sequences: [Option<u32>; 2],
}

impl<'a, const N: usize> Slots<'a, N> {
    /// Checks both slots completely; valid is a table over `axes` made for the scene and laws that `scene_hash` stands for.
    pub fn open(slots: [&'a [u8]; 2], axes: [AxisKind; N], scene_hash: u64) -> Self {
        let opened = |slot| Table::open(slot)?.expect_axes(axes)?.expect_scene(scene_hash);
        Self { tables: slots.map(opened), sequences: slots.map(sequence) }
    }

    /// Which slot counts: the valid one, the newer of two, the first if nothing says which that is.
    fn current(&self) -> Option<usize> {
        let valid = |i: usize| self.tables.get(i).is_some_and(Result::is_ok);
        match (valid(0), valid(1)) {
            (true, true) => Some(usize::from(self.is_second_newer())),
            (true, false) => Some(0),
            (false, true) => Some(1),
            (false, false) => None,
        }
    }

    /// Numbers go round, so that newer is what lies less than half a round ahead.
    fn is_second_newer(&self) -> bool {
        match self.sequences {
            [Some(first), Some(second)] => second.wrapping_sub(first).cast_signed() > 0,
            [None, Some(_)] => true,
            [_, None] => false,
        }
    }

    /// The newer valid table.
    ///
    /// # Errors
    /// If neither slot holds one: what is wrong with the first, or with the second if the first holds nothing.
    pub fn newest(&self) -> Result<&Table<'a, N>, TableError> {
        let [first, second] = &self.tables;
        match (self.current(), first) {
            (Some(1), _) | (None, Err(TableError::Magic)) => second.as_ref().map_err(|error| *error),
            _ => first.as_ref().map_err(|error| *error),
        }
    }

    /// Where the next table goes, and its sequence number: never into the slot of [`Slots::newest`].
    pub fn spare(&self) -> (usize, u32) {
        match self.current() {
            Some(current) => {
                let number = self.sequences.get(current).copied().flatten();
                (1 - current, number.map_or(0, |number| number.wrapping_add(1)))
            }
            None => (0, 0),
        }
    }
}

/// The record that ends a slot with the sequence number `sequence`.
pub fn record(sequence: u32) -> [u8; RECORD_SIZE] {
    (u64::from(sequence) | u64::from(!sequence) << 32).to_le_bytes()
}

/// The sequence number of a slot; none if the slot is erased there, or cut off while it was written.
fn sequence(slot: &[u8]) -> Option<u32> {
    let found = slot.last_chunk().copied()?;
    let sequence = u64::from_le_bytes(found) as u32;
    (record(sequence) == found).then_some(sequence)
}
