//! Two slots for a table, and what an update writes.

use slipfit_core::table::{Slots, WORD_MOST, Word};

use crate::{
    border::{bytes, input, make, output},
    status::{Refusal, SLIPFIT_NULL, SLIPFIT_PARAMETER, slipfit_status, status},
    table::{axes, slipfit_table},
};

/// The greatest programming word (bytes).
pub const SLIPFIT_WORD_MOST: u32 = 32;

const _: () = assert!(SLIPFIT_WORD_MOST as usize == WORD_MOST);

/// Two slots of flash, of which each can be erased on its own.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct slipfit_slots {
    /// The first slot; null if it cannot be read: flash with an error-correcting code faults where a word was cut off. Such a
    /// slot holds no finished update.
    pub first: *const u8,
    /// The second slot, likewise.
    pub second: *const u8,
    /// Length of each (bytes).
    pub length: u32,
    /// The programming word of the flash (bytes): 1, 2, 4, 8, 16 or 32.
    pub word: u32,
}

/// Where an update goes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_spare {
    /// The slot, 0 or 1.
    pub slot: u32,
    /// The sequence number of its record, for slipfit_record_make.
    pub sequence: u32,
    /// How long the table may be (bytes).
    pub room: u32,
}

/// The end of a slot, which says that the table in it is the newest.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct slipfit_record {
    /// How many bytes it has: whole programming words.
    pub size: u32,
    /// The bytes, to be written to the last `size` bytes of the slot.
    pub bytes: [u8; 32],
}

fn word(bytes: u32) -> Result<Word, Refusal> {
    usize::try_from(bytes).ok().and_then(Word::of).ok_or(Refusal(SLIPFIT_PARAMETER))
}

/// Opens the newer valid table, as slipfit_table_open has it, of two slots, and says where the next update goes: erase that
/// slot, write the table to its start, open it there, then write what slipfit_record_make gives to its end. A power cut at any
/// moment of it leaves a valid table.
///
/// If it fails no table is open, and `*spare` is as it was. Without any valid table an update goes to slot 0 with number 0.
///
/// # Safety
/// As for slipfit_table_open; nobody else uses `*spare` meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_slots_open(
    storage: *mut slipfit_table,
    slots: *const slipfit_slots,
    over: u32,
    scene_hash: u64,
    spare: *mut slipfit_spare,
) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        make(storage, || {
            let mut opened = None;
            output(spare, || {
                let slipfit_slots { first, second, length, word } = *input(slots)?;
                if first.is_null() && second.is_null() {
                    return Err(Refusal(SLIPFIT_NULL));
                }
                let slot = |slot: *const u8| if slot.is_null() { Ok(None) } else { bytes(slot, length).map(Some) };
                let (regions, word) = ([slot(first)?, slot(second)?], self::word(word)?);
                let slots = Slots::<2>::open(regions, word, axes(over)?, scene_hash);
                let (slot, sequence) = slots.spare();
                let ([first, second], table) = (regions, *slots.newest()?);
                // The newest table is never in the spare slot.
                let region = if slot == 0 { second } else { first }.unwrap_or_default();
                opened = Some(table);
                Ok(slipfit_spare { slot: slot as u32, sequence, room: word.room(region.len()) as u32 })
            })?;
            opened.ok_or(Refusal(SLIPFIT_NULL))
        })
    })
}

/// The record of a sequence number for flash with programming words of `word` bytes.
///
/// # Safety
/// If `record` is neither null nor misaligned, memory for it is there, and nobody else uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slipfit_record_make(record: *mut slipfit_record, word: u32, sequence: u32) -> slipfit_status {
    // SAFETY: the caller's promise.
    status(|| unsafe {
        output(record, || {
            let made = self::word(word)?.record(sequence);
            let mut bytes = [0xff; SLIPFIT_WORD_MOST as usize];
            bytes.iter_mut().zip(made.bytes()).for_each(|(to, from)| *to = *from);
            Ok(slipfit_record { size: made.bytes().len() as u32, bytes })
        })
    })
}
