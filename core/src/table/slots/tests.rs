//! Updates of a table in two slots, cut off at any moment, on flash of every programming word.

use std::{vec, vec::Vec};

use super::{AxisKind, RECORD_SIZE, Slots, Table, TableError, Word, numbers};
use crate::table::example;

const AXES: [AxisKind; 2] = [AxisKind::Level, AxisKind::Time];

/// Cuts of the power for each programming word.
const CUTS: u64 = if cfg!(miri) { 2 } else { 10_000 };

/// The power is gone, or the flash has answered with a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fault;

/// xorshift64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }
}

/// Two slots of flash that is written in words of `WORD` bytes, each once after it was erased.
pub(crate) struct Flash<const WORD: usize> {
    bytes: Vec<u8>,
    /// Words whose erasing or writing was cut off.
    torn: Vec<bool>,
    /// Whether such a word cannot be read; else it reads as it was left.
    faults: bool,
    /// Words that can still be erased or written before the power is cut.
    power: usize,
    random: Random,
}

impl<const WORD: usize> Flash<WORD> {
    /// Erased, two slots of `length` bytes each.
    pub(crate) fn new(length: usize, faults: bool, seed: u64) -> Self {
        let words = (2 * length).div_ceil(WORD);
        Self {
            bytes: vec![0xff; words * WORD],
            torn: vec![false; words],
            faults,
            power: usize::MAX,
            random: Random(seed * 2 + 1),
        }
    }

    /// So many words can still be erased or written.
    #[cfg(feature = "embedded-storage")]
    pub(crate) fn power(&mut self, words: usize) {
        self.power = words;
    }

    pub(crate) fn slot_length(&self) -> usize {
        self.bytes.len() / 2
    }

    /// Addresses of a slot.
    pub(crate) fn slot(&self, slot: usize) -> core::ops::Range<usize> {
        slot * self.slot_length()..(slot + 1) * self.slot_length()
    }

    pub(crate) fn erase(&mut self, from: usize, to: usize) -> Result<(), Fault> {
        let words = (to - from) / WORD;
        if self.power >= words {
            self.power -= words;
            self.bytes[from..to].fill(0xff);
            self.torn[from / WORD..to / WORD].fill(false);
            return Ok(());
        }
        // All cells are erased at once: cut off, every word may be as it was, erased, or anything.
        self.power = 0;
        for at in (from..to).step_by(WORD) {
            match self.random.below(3) {
                0 => (),
                1 => self.bytes[at..at + WORD].fill(0xff),
                _ => {
                    self.torn[at / WORD] = true;
                    let random = &mut self.random;
                    self.bytes[at..at + WORD].iter_mut().for_each(|byte| *byte |= random.next() as u8);
                }
            }
        }
        Err(Fault)
    }

    pub(crate) fn write(&mut self, at: usize, bytes: &[u8]) -> Result<(), Fault> {
        assert!(at.is_multiple_of(WORD) && bytes.len().is_multiple_of(WORD), "whole words");
        for (at, word) in (at..).step_by(WORD).zip(bytes.chunks(WORD)) {
            let cells = &mut self.bytes[at..at + WORD];
            assert!(cells.iter().all(|byte| *byte == 0xff) && !self.torn[at / WORD], "a word is written once");
            if self.power == 0 {
                // Some of its bits have become zero.
                self.torn[at / WORD] = true;
                let random = &mut self.random;
                cells.iter_mut().zip(word).for_each(|(cell, byte)| *cell = byte | random.next() as u8);
                return Err(Fault);
            }
            self.power -= 1;
            cells.copy_from_slice(word);
        }
        Ok(())
    }

    pub(crate) fn read(&self, from: usize, to: usize) -> Result<&[u8], Fault> {
        let torn = self.torn[from / WORD..to.div_ceil(WORD)].iter().any(|torn| *torn);
        if self.faults && torn { Err(Fault) } else { Ok(&self.bytes[from..to]) }
    }

    pub(crate) fn open(&self) -> Slots<'_> {
        let slots = [0, 1].map(|slot| self.slot(slot)).map(|slot| self.read(slot.start, slot.end).ok());
        Slots::open(slots, Word::of(WORD).unwrap(), AXES, example::SCENE)
    }

    /// The number of the table that counts.
    pub(crate) fn newest(&self) -> Result<f32, TableError> {
        self.open().newest().map(|table| table.lookup([0.0; 2]).force)
    }

    /// A table at the start of a slot, as the factory flashes it: without a record.
    pub(crate) fn write_table(&mut self, slot: usize, table: &[u8]) -> Result<(), Fault> {
        let word = Word::of(WORD).unwrap();
        let mut padded = Vec::from(table);
        padded.resize(word.whole(table.len()), 0xff);
        self.write(self.slot(slot).start, &padded)
    }

    /// An update as the documentation of the slots has it; none where the table is too long.
    fn update(&mut self, table: &[u8]) -> Result<(), Fault> {
        let word = Word::of(WORD).unwrap();
        let (slot, sequence) = self.open().spare();
        let addresses = self.slot(slot);
        if table.len() > word.room(addresses.len()) {
            return Ok(());
        }
        self.erase(addresses.start, addresses.end)?;
        self.write_table(slot, table)?;
        let written = self.read(addresses.start, addresses.end)?;
        let opened = Table::<2>::open(written).and_then(|table| table.expect_axes(AXES)?.expect_scene(example::SCENE));
        if opened.is_ok() {
            self.write(addresses.end - word.record_size(), word.record(sequence).bytes())?;
        }
        Ok(())
    }
}

/// A table that can be told from others by its first value; one of several lengths.
pub(crate) fn numbered(number: u16, instants: u32) -> Vec<u8> {
    let axes = [(AxisKind::Level, 2, 1.0), (AxisKind::Time, instants, 1.0)];
    example::table(&axes, |node| if node == 0 { f32::from(number) } else { 0.5 })
}

/// The least length of a slot for `table`.
pub(crate) fn least(word: usize, table: &[u8]) -> usize {
    let word = Word::of(word).unwrap();
    word.whole(table.len()) + word.record_size()
}

#[test]
fn words_are_powers_of_two() {
    let sizes = (0..=100).filter_map(Word::of).map(Word::size).collect::<Vec<_>>();
    assert_eq!(sizes, [1, 2, 4, 8, 16, 32]);
    for word in (0..=100).filter_map(Word::of) {
        let record = word.record(0x0123_4567);
        let (padding, end) = record.bytes().split_at(word.record_size() - RECORD_SIZE);
        assert!(padding.iter().all(|byte| *byte == 0xff));
        assert_eq!(end, [0x67, 0x45, 0x23, 0x01, 0x98, 0xba, 0xdc, 0xfe]);
        assert_eq!(word.record_size(), word.size().max(RECORD_SIZE));
        assert_eq!(word.room(0), 0);
        assert_eq!(word.room(1024), 1024 - word.record_size());
        assert_eq!(word.room(1023) > 0, word.size() == 1);
    }
}

#[test]
fn the_newer_valid_table_counts() {
    let mut flash = Flash::<8>::new(320, false, 1);
    assert_eq!(flash.newest(), Err(TableError::Magic));
    assert_eq!(flash.open().spare(), (0, 0));
    // As the factory leaves it: without a record.
    flash.write_table(0, &numbered(1, 4)).unwrap();
    assert_eq!((flash.newest(), flash.open().spare()), (Ok(1.0), (1, 0)));
    for round in 2..7 {
        flash.update(&numbered(round, 4)).unwrap();
        assert_eq!(flash.newest(), Ok(f32::from(round)));
    }
    assert_eq!(flash.open().spare(), (0, 5));

    // The older one again as soon as the newer one is damaged, or for another scene or over other quantities.
    flash.bytes[320 + 100] ^= 1;
    assert_eq!(flash.newest(), Ok(5.0));
    let mut of_another_scene = numbered(9, 4);
    of_another_scene[super::super::layout::SCENE_HASH_AT] ^= 1;
    let over_position = example::table(&[(AxisKind::Level, 2, 1.0), (AxisKind::Position, 4, 1.0)], |_| 9.0);
    for foreign in [of_another_scene, over_position] {
        flash.update(&foreign).unwrap();
        assert_eq!((flash.newest(), flash.open().spare()), (Ok(5.0), (1, 4)));
    }
    flash.bytes[100] ^= 1;
    assert_eq!(flash.newest(), Err(TableError::Checksum));
}

#[test]
fn sequence_numbers_go_round() {
    for (first, second, newest) in [(u32::MAX, 0, 2.0), (0, u32::MAX, 1.0), (5, 4, 1.0), (4, 5, 2.0)] {
        let mut flash = Flash::<1>::new(320, false, 1);
        for (slot, sequence) in [first, second].into_iter().enumerate() {
            flash.write_table(slot, &numbered(slot as u16 + 1, 4)).unwrap();
            flash.write(flash.slot(slot).end - RECORD_SIZE, &numbers(sequence)).unwrap();
        }
        assert_eq!(flash.newest(), Ok(newest));
    }
}

#[test]
fn a_slot_that_cannot_be_read_holds_nothing() {
    let table = numbered(1, 4);
    let open = |slots| Slots::<2>::open(slots, Word::of(8).unwrap(), AXES, example::SCENE);
    let mut slot = table.clone();
    slot.resize(320, 0xff);
    assert_eq!(open([None, None]).newest().unwrap_err(), TableError::Unreadable);
    for (slots, spare) in [([Some(&slot[..]), None], 1), ([None, Some(&slot[..])], 0)] {
        assert!(open(slots).newest().is_ok());
        assert_eq!(open(slots).spare(), (spare, 0));
    }
}

/// From too short up: a slot without room is refused, by its name, and an update into one with room takes effect.
fn every_length<const WORD: usize>() {
    let table = numbered(1, 4);
    let least = least(WORD, &table);
    // An interpreter has time for the lengths about the least only.
    let (first, beyond) = if cfg!(miri) { (least - 2 * WORD, WORD + 1) } else { (0, 3 * WORD + 40) };
    for length in (first..least + beyond).step_by(WORD) {
        let mut flash = Flash::<WORD>::new(length, true, 1);
        if length < table.len() {
            assert!(flash.newest().is_err() && flash.update(&numbered(2, 4)).is_ok(), "{length}");
            assert!(flash.bytes.iter().all(|byte| *byte == 0xff), "{length}");
            continue;
        }
        // What a factory may have done.
        flash.write_table(0, &table).unwrap();
        if length < least {
            assert_eq!(flash.newest(), Err(TableError::Slot { length, least }));
            flash.update(&numbered(2, 4)).unwrap();
            assert_eq!(flash.newest(), Err(TableError::Slot { length, least }));
        } else {
            assert_eq!(flash.newest(), Ok(1.0));
            for round in 2..5 {
                flash.update(&numbered(round, 4)).unwrap();
                assert_eq!(flash.newest(), Ok(f32::from(round)), "{length}");
            }
        }
    }
    // Nor does a slot that ends within a word hold anything.
    let mut slot = table.clone();
    slot.resize(least + WORD, 0xff);
    for length in least + 1..least + WORD {
        let open = |word| Slots::open([Some(&slot[..length]), None], Word::of(word).unwrap(), AXES, example::SCENE);
        assert_eq!(open(WORD).newest().unwrap_err(), TableError::Slot { length, least });
        assert!(open(1).newest().is_ok());
    }
}

#[test]
fn slots_of_every_length() {
    every_length::<1>();
    if !cfg!(miri) {
        every_length::<2>();
        every_length::<4>();
        every_length::<8>();
        every_length::<16>();
    }
    every_length::<32>();
}

/// Nothing is lost and nothing is stuck, whenever the power is cut: while a table is erased or written, and while what the
/// cut left is.
pub(crate) fn power_cuts<const WORD: usize>(update: impl Fn(&mut Flash<WORD>, &[u8]) -> Result<(), Fault>) {
    let longest = least(WORD, &numbered(0, 9));
    let mut seen = [0; 2];
    for seed in 0..CUTS {
        let mut random = Random(seed * 0x9e37_79b9 + 1);
        let length = longest + WORD * random.below(6);
        let mut flash = Flash::<WORD>::new(length, random.below(2) == 0, seed);
        flash.write_table(0, &numbered(100, 4)).unwrap();
        for earlier in 0..random.below(4) as u16 {
            update(&mut flash, &numbered(101 + earlier, 5)).unwrap();
        }
        let mut old = flash.newest().unwrap();
        for round in 0..2u16 {
            let table = numbered(200 + round, 4 + random.below(6) as u32);
            let all = 2 * length / WORD;
            flash.power = random.below(all);
            let done = update(&mut flash, &table);
            let found = flash.newest().expect("nothing is lost");
            let is_new = found == f32::from(200 + round);
            assert!(is_new || found == old, "{seed}: {found}");
            // Where bytes are words, a record that ends in ones is whole before its last one is written.
            assert!(if done.is_ok() { is_new } else { !is_new || WORD == 1 && !flash.faults }, "{seed}");
            seen[usize::from(is_new)] += 1;
            old = found;
        }
        // The next update succeeds, whatever the cuts left behind.
        flash.power = usize::MAX;
        update(&mut flash, &numbered(300, 6)).unwrap();
        assert_eq!(flash.newest(), Ok(300.0), "{seed}");
    }
    assert!(cfg!(miri) || seen.iter().all(|count| *count > CUTS / 10), "{seen:?}");
}

#[test]
fn power_cuts_with_words_of_1_byte() {
    power_cuts(Flash::<1>::update);
}

#[test]
fn power_cuts_with_words_of_8_bytes() {
    power_cuts(Flash::<8>::update);
}

#[test]
fn power_cuts_with_words_of_16_bytes() {
    power_cuts(Flash::<16>::update);
}

#[test]
fn power_cuts_with_words_of_32_bytes() {
    power_cuts(Flash::<32>::update);
}
