//! The write of a table into a slot, by `embedded-storage`'s traits, in the order that [`Slots`](super::Slots) asks for.

use core::ops::Range;

use embedded_storage::nor_flash::{NorFlash, ReadNorFlash};

use super::{
    TableError, WORD_MOST, Word,
    layout::{EMPTY, LENGTH_AT, MAGIC, MAGIC_AT, continued},
};

/// The checksum's register after any bytes and their checksum.
const WHOLE: u32 = 0xdebb_20e3;

/// Why a table is not written. The slot may be erased or half written then, the other one is as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum UpdateError<E> {
    /// The flash's programming word is not one of 1 to 32 bytes, a power of two.
    Word {
        /// Its size (bytes).
        size: usize,
    },
    /// The table has more bytes than the slot has room for.
    Room {
        /// How many fit.
        room: usize,
    },
    /// What has been written is no whole table.
    Table(TableError),
    /// The flash's own error.
    Flash(E),
}

impl<E: core::fmt::Debug> core::fmt::Display for UpdateError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Word { size } => write!(f, "a programming word of {size} bytes, allowed are 1, 2, 4, 8, 16 and 32"),
            Self::Room { room } => write!(f, "the slot has room for a table of {room} bytes, this one is longer"),
            Self::Table(error) => write!(f, "what was written is no table: {error}"),
            Self::Flash(error) => write!(f, "the flash: {error:?}"),
        }
    }
}

impl<E: core::fmt::Debug> core::error::Error for UpdateError<E> {}

/// A table on its way into a slot, a piece at a time.
///
/// ```
/// # use embedded_storage::nor_flash::NorFlash;
/// # use slipfit_core::table::{Slots, Update, UpdateError};
/// # fn receive<F: NorFlash>(flash: &mut F, slots: &Slots<'_>, pieces: &[&[u8]]) -> Result<(), UpdateError<F::Error>> {
/// let (slot, sequence) = slots.spare();
/// let regions = [0x8_0000..0xa_0000, 0xa_0000..0xc_0000];
/// let mut update = Update::start(flash, regions[slot].clone(), sequence)?; // erases
/// for piece in pieces {
///     update.write(piece)?;
/// }
/// update.finish() // from here on the new table counts
/// # }
/// ```
#[derive(Debug)]
pub struct Update<'f, F> {
    flash: &'f mut F,
    word: Word,
    /// Addresses of the slot.
    slot: Range<u32>,
    sequence: u32,
    /// Bytes of the table so far.
    length: usize,
    /// Its last ones, if they do not fill a block.
    block: [u8; WORD_MOST],
}

impl<'f, F: NorFlash> Update<'f, F> {
    /// Erases `slot`, the addresses of the one that [`Slots::spare`](super::Slots::spare) names together with the number
    /// `sequence`.
    ///
    /// # Errors
    /// [`UpdateError`] if the flash's word is none that a slot may have, or the flash does not erase.
    pub fn start(flash: &'f mut F, slot: Range<u32>, sequence: u32) -> Result<Self, UpdateError<F::Error>> {
        let word = Word::of(F::WRITE_SIZE).ok_or(UpdateError::Word { size: F::WRITE_SIZE })?;
        flash.erase(slot.start, slot.end).map_err(UpdateError::Flash)?;
        Ok(Self { flash, word, slot, sequence, length: 0, block: [0xff; WORD_MOST] })
    }

    /// Writes the next `bytes` of the table.
    ///
    /// # Errors
    /// [`UpdateError`] if the table is longer than the slot has room for, or the flash does not write.
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), UpdateError<F::Error>> {
        let room = self.word.room(self.slot.len());
        if bytes.len() > room.saturating_sub(self.length) {
            return Err(UpdateError::Room { room });
        }
        for byte in bytes {
            if let Some(place) = self.block.get_mut(self.length % WORD_MOST) {
                *place = *byte;
            }
            self.length += 1;
            if self.length.is_multiple_of(WORD_MOST) {
                self.flush(WORD_MOST)?;
            }
        }
        Ok(())
    }

    /// Writes the block whose last byte has just come, its first `size` bytes: whole words.
    fn flush(&mut self, size: usize) -> Result<(), UpdateError<F::Error>> {
        let at = self.slot.start.saturating_add((self.length.saturating_sub(1) / WORD_MOST * WORD_MOST) as u32);
        let bytes = self.block.get(..size).unwrap_or_default();
        self.flash.write(at, bytes).map_err(UpdateError::Flash)?;
        self.block = [0xff; WORD_MOST];
        Ok(())
    }

    /// Writes what is left, reads the whole table back, and makes it the newest.
    ///
    /// # Errors
    /// [`UpdateError`] if what is read is no whole table, or the flash does not read or write. Whether it is over the right
    /// quantities and for the right scene, [`Slots::open`](super::Slots::open) looks: a table that is not never counts.
    pub fn finish(mut self) -> Result<(), UpdateError<F::Error>> {
        let rest = self.length % WORD_MOST;
        if rest > 0 {
            self.flush(self.word.whole(rest))?;
        }
        self.check()?;
        let record = self.word.record(self.sequence);
        let at = self.slot.end.saturating_sub(self.word.record_size() as u32);
        self.flash.write(at, record.bytes()).map_err(UpdateError::Flash)
    }

    /// Whether the flash holds a table as long as what was written.
    fn check(&mut self) -> Result<(), UpdateError<F::Error>> {
        let (mut register, mut left, mut at) = (EMPTY, self.length, self.slot.start);
        while left > 0 {
            let size = left.min(WORD_MOST);
            let mut block = [0; WORD_MOST];
            let whole = block.get_mut(..self.word.whole(size)).unwrap_or_default();
            self.flash.read(at, whole).map_err(UpdateError::Flash)?;
            if at == self.slot.start {
                let length = block.get(LENGTH_AT..).and_then(<[u8]>::first_chunk).copied().unwrap_or_default();
                if block.get(MAGIC_AT..).and_then(<[u8]>::first_chunk) != Some(&MAGIC) {
                    return Err(UpdateError::Table(TableError::Magic));
                }
                if u32::from_le_bytes(length) as usize != self.length {
                    return Err(UpdateError::Table(TableError::Truncated));
                }
            }
            register = continued(register, block.get(..size).unwrap_or_default());
            left -= size;
            at = at.saturating_add(WORD_MOST as u32);
        }
        if register == WHOLE { Ok(()) } else { Err(UpdateError::Table(TableError::Checksum)) }
    }
}

/// Whether every byte of `slot` can be read, so that [`Slots::open`](super::Slots::open) may: a driver answers with an error
/// where flash with an error-correcting code would fault.
pub fn is_readable<F: ReadNorFlash>(flash: &mut F, slot: Range<u32>) -> bool {
    let mut at = slot.start;
    while at < slot.end {
        let mut block = [0; WORD_MOST];
        let size = WORD_MOST.min((slot.end - at) as usize);
        if flash.read(at, block.get_mut(..size).unwrap_or_default()).is_err() {
            return false;
        }
        at = at.saturating_add(size as u32);
    }
    true
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};

    use super::{Update, UpdateError, is_readable};
    use crate::table::{
        TableError,
        slots::tests::{Fault, Flash, least, numbered, power_cuts},
    };

    impl NorFlashError for Fault {
        fn kind(&self) -> NorFlashErrorKind {
            NorFlashErrorKind::Other
        }
    }

    impl<const WORD: usize> ErrorType for Flash<WORD> {
        type Error = Fault;
    }

    impl<const WORD: usize> ReadNorFlash for Flash<WORD> {
        const READ_SIZE: usize = 1;

        fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Fault> {
            let from = offset as usize;
            bytes.copy_from_slice(Flash::read(self, from, from + bytes.len())?);
            Ok(())
        }

        fn capacity(&self) -> usize {
            2 * self.slot_length()
        }
    }

    impl<const WORD: usize> NorFlash for Flash<WORD> {
        const WRITE_SIZE: usize = WORD;
        const ERASE_SIZE: usize = WORD;

        fn erase(&mut self, from: u32, to: u32) -> Result<(), Fault> {
            Flash::erase(self, from as usize, to as usize)
        }

        fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Fault> {
            Flash::write(self, offset as usize, bytes)
        }
    }

    /// An update in pieces of `piece` bytes.
    fn updated<const WORD: usize>(
        flash: &mut Flash<WORD>,
        table: &[u8],
        piece: usize,
    ) -> Result<(), UpdateError<Fault>> {
        let (slot, sequence) = flash.open().spare();
        let addresses = flash.slot(slot);
        let mut update = Update::start(flash, addresses.start as u32..addresses.end as u32, sequence)?;
        table.chunks(piece).try_for_each(|piece| update.write(piece))?;
        update.finish()
    }

    fn survives_power_cuts<const WORD: usize>() {
        power_cuts(|flash: &mut Flash<WORD>, table| match updated(flash, table, 50) {
            Ok(()) => Ok(()),
            Err(error) => {
                assert_eq!(error, UpdateError::Flash(Fault));
                Err(Fault)
            }
        });
    }

    #[test]
    fn power_cuts_of_every_word() {
        survives_power_cuts::<1>();
        survives_power_cuts::<8>();
        survives_power_cuts::<16>();
        survives_power_cuts::<32>();
    }

    #[test]
    fn pieces_of_any_size_make_the_same_slot() {
        let table = numbered(7, 5);
        let written = |piece| {
            let mut flash = Flash::<16>::new(320, true, 1);
            updated(&mut flash, &table, piece).unwrap();
            assert_eq!(flash.newest(), Ok(7.0));
            let bytes = flash.read(0, 640).map(Vec::from);
            bytes.unwrap()
        };
        for piece in [2, 3, 31, 32, 33, 1000] {
            assert!(written(piece) == written(1), "{piece}");
        }
    }

    #[test]
    fn refuses_what_never_counts() {
        let table = numbered(7, 5);
        let room = 320 - 8;
        let mut long = table.clone();
        long.resize(room + 1, 0);
        let mut damaged = table.clone();
        damaged[100] ^= 1;
        for (bytes, error) in [
            (&long[..], UpdateError::Room { room }),
            (&table[..table.len() - 1], UpdateError::Table(TableError::Truncated)),
            (&[][..], UpdateError::Table(TableError::Checksum)),
            (&[0; 40][..], UpdateError::Table(TableError::Magic)),
            (&damaged[..], UpdateError::Table(TableError::Checksum)),
        ] {
            let mut flash = Flash::<8>::new(320, false, 1);
            updated(&mut flash, &numbered(1, 4), 16).unwrap();
            assert_eq!(updated(&mut flash, bytes, 64), Err(error));
            assert_eq!(flash.newest(), Ok(1.0));
        }
        let mut flash = Flash::<3>::new(3 * least(1, &table), false, 1);
        assert_eq!(Update::start(&mut flash, 0..30, 0).map(drop), Err(UpdateError::Word { size: 3 }));
    }

    #[test]
    fn a_torn_word_makes_a_slot_unreadable() {
        let mut flash = Flash::<32>::new(320, true, 1);
        assert!(is_readable(&mut flash, 0..320));
        flash.power(12);
        assert!(updated(&mut flash, &numbered(1, 4), 16).is_err());
        assert!(!is_readable(&mut flash, 0..320) && is_readable(&mut flash, 320..640));
    }
}
