//! Two slots for a table, so that a new one can be flashed while the old one stays.
//!
//! A slot is a region of flash that can be erased on its own, and whose ends lie between programming words. The table stands
//! at its start; its last [`RECORD_SIZE`] bytes hold the sequence number (u32, little-endian) and the number's complement,
//! or are erased. The record has its own programming words at the slot's end, erased but for these bytes, see [`Word`]. An
//! update goes in this order, and a power cut at any moment of it leaves a valid table:
//! 1. take the slot that [`Slots::spare`] names and the number that it gives; if the table is longer than [`Word::room`]
//!    says, it does not fit: stop here; erase that slot;
//! 2. write the table into it and check it there, by [`Table::open`], [`Table::expect_axes`] and [`Table::expect_scene`];
//! 3. write the [`record`](Word::record) to the slot's end.
//!
//! The record only says which of two valid tables is the newer one. Without it, as flashed in the factory or cut off
//! before the last step, a table is older than any that has one.
//!
//! *Flash with an error-correcting code* faults when a word is read whose writing or erasing was cut off. A slot that faults
//! holds no finished update: say `None` for it, and it is the one that is erased next. Whether it faults must be found out
//! before [`Slots::open`], by reading it once where a fault is survived (from a driver that answers with an error, or with
//! the bus fault masked), which is what [`Slots::open`] cannot do.

use super::{AxisKind, Table, TableError};

/// Size of the sequence number and its complement at the end of a slot (bytes).
pub const RECORD_SIZE: usize = 8;

/// The greatest programming word (bytes).
pub const WORD_MOST: usize = 32;

/// What the flash writes at once: aligned, it is erased, written or cut off as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Word {
    /// Its size less one: a mask of the offsets within it.
    mask: u8,
}

impl Word {
    /// A programming word of `bytes`; none unless that is 1, 2, 4, 8, 16 or 32.
    pub const fn of(bytes: usize) -> Option<Self> {
        if bytes.is_power_of_two() && bytes <= WORD_MOST { Some(Self { mask: (bytes - 1) as u8 }) } else { None }
    }

    /// Its size (bytes).
    pub const fn size(self) -> usize {
        self.mask as usize + 1
    }

    /// The whole words (bytes) that `length` bytes take.
    pub const fn whole(self, length: usize) -> usize {
        length.saturating_add(self.mask as usize) & !(self.mask as usize)
    }

    /// How many bytes a slot's record takes: whole words.
    pub const fn record_size(self) -> usize {
        self.whole(RECORD_SIZE)
    }

    /// How long a table may be (bytes) in a slot of `length` bytes; 0 if the slot does not end between words.
    pub const fn room(self, length: usize) -> usize {
        if self.whole(length) == length { length.saturating_sub(self.record_size()) } else { 0 }
    }

    /// The record of the sequence number `sequence`: what to write to the end of a slot.
    pub fn record(self, sequence: u32) -> Record {
        let mut bytes = [0xff; WORD_MOST];
        if let Some(end) = bytes.last_chunk_mut() {
            *end = numbers(sequence);
        }
        Record { bytes, size: self.record_size() }
    }
}

/// The end of a slot, whole programming words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Record {
    bytes: [u8; WORD_MOST],
    size: usize,
}

impl Record {
    /// Its bytes, the last ones of the slot.
    pub fn bytes(&self) -> &[u8] {
        self.bytes.get(WORD_MOST.saturating_sub(self.size)..).unwrap_or_default()
    }
}

/// Two regions of flash, each for one table over `N` axes.
#[derive(Clone, Copy, Debug)]
pub struct Slots<'a, const N: usize = 2> {
    tables: [Result<Table<'a, N>, TableError>; 2],
    sequences: [Option<u32>; 2],
}

impl<'a, const N: usize> Slots<'a, N> {
    /// Checks both slots of a flash with the programming word `word` completely; `None` is one that cannot be read. Valid is
    /// a table over `axes` made for the scene and laws that `scene_hash` stands for, which leaves room for the record.
    pub fn open(slots: [Option<&'a [u8]>; 2], word: Word, axes: [AxisKind; N], scene_hash: u64) -> Self {
        let opened = |slot: Option<&'a [u8]>| {
            let slot = slot.ok_or(TableError::Unreadable)?;
            let table = Table::open(slot)?.expect_axes(axes)?.expect_scene(scene_hash)?;
            if table.length() > word.room(slot.len()) {
                let least = word.whole(table.length()).saturating_add(word.record_size());
                return Err(TableError::Slot { length: slot.len(), least });
            }
            Ok(table)
        };
        Self { tables: slots.map(opened), sequences: slots.map(|slot| slot.and_then(sequence)) }
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
            (Some(1), _) | (None, Err(TableError::Magic | TableError::Unreadable)) => {
                second.as_ref().map_err(|error| *error)
            }
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

/// The sequence number and its complement.
fn numbers(sequence: u32) -> [u8; RECORD_SIZE] {
    (u64::from(sequence) | u64::from(!sequence) << 32).to_le_bytes()
}

/// The sequence number of a slot; none if the slot is erased there, or cut off while it was written.
fn sequence(slot: &[u8]) -> Option<u32> {
    let found = slot.last_chunk().copied()?;
    let sequence = u64::from_le_bytes(found) as u32;
    (numbers(sequence) == found).then_some(sequence)
}

#[cfg(test)]
pub(crate) mod tests;
