//! Updates of a table in two slots, cut off at every byte, and the cyclic check.

use slipfit_core::table::{AxisKind, Encoding, Patrol, Slots, Table, TableError, layout, record};

use super::{TableSpec, encode, small};

const HASH: u64 = 0x0123_4567_89ab_cdef;
const AXES: [AxisKind; 2] = [AxisKind::Level, AxisKind::Time];

/// Size of a slot in these tests (bytes).
const SLOT: usize = 320;

/// Flash as it is: erased to ones, written to zeros.
struct Flash {
    slots: [[u8; SLOT]; 2],
    /// Bytes that can still be erased or written before the power is cut.
    power: usize,
}

impl Flash {
    fn new() -> Self {
        Self { slots: [[0xff; SLOT]; 2], power: usize::MAX }
    }

    fn open(&self) -> Slots<'_> {
        Slots::open(self.slots.each_ref().map(|slot| slot.as_slice()), AXES, HASH)
    }

    /// One byte, unless the power is gone.
    fn change(&mut self, slot: usize, at: usize, change: impl Fn(u8) -> u8) {
        if self.power > 0 {
            self.power -= 1;
            self.slots[slot][at] = change(self.slots[slot][at]);
        }
    }

    fn write(&mut self, slot: usize, at: usize, bytes: &[u8]) {
        for (i, byte) in bytes.iter().enumerate() {
            self.change(slot, at + i, |old| old & byte);
        }
    }

    /// An update as the documentation of the slots has it; erasing goes backwards where `backwards` says so.
    fn update(&mut self, table: &[u8], backwards: bool) {
        let (slot, sequence) = self.open().spare();
        for i in 0..SLOT {
            self.change(slot, if backwards { SLOT - 1 - i } else { i }, |_| 0xff);
        }
        self.write(slot, 0, table);
        if Table::<2>::open(&self.slots[slot]).and_then(|table| table.expect_scene(HASH)).is_ok() {
            self.write(slot, SLOT - 8, &record(sequence));
        }
    }
}

/// A table that can be told from others by its first value.
fn numbered(number: u16) -> Vec<u8> {
    let mut spec: TableSpec = small(2, Encoding::F32);
    spec.force.values[0] = f32::from(number);
    encode(&spec).unwrap()
}

fn number(table: &Table<'_>) -> f32 {
    table.lookup([-1.0, 0.25]).force
}

#[test]
fn the_newer_valid_table_counts() {
    let mut flash = Flash::new();
    assert_eq!(flash.open().newest().unwrap_err(), TableError::Magic);
    assert_eq!(flash.open().spare(), (0, 0));
    // As the factory leaves it: without a record.
    flash.write(0, 0, &numbered(1));
    assert_eq!((number(flash.open().newest().unwrap()), flash.open().spare()), (1.0, (1, 0)));
    for round in 2..7 {
        flash.update(&numbered(round), false);
        assert_eq!(number(flash.open().newest().unwrap()), f32::from(round));
    }
    assert_eq!(flash.open().spare(), (0, 5));

    // The older one again as soon as the newer one is damaged, or for another scene or over other quantities.
    flash.slots[1][100] ^= 1;
    assert_eq!(number(flash.open().newest().unwrap()), 5.0);
    let of_another_scene = TableSpec { scene_hash: 1, ..small(2, Encoding::F32) };
    let mut over_position = small(2, Encoding::F32);
    over_position.axes[1].kind = AxisKind::Position;
    for foreign in [of_another_scene, over_position] {
        flash.update(&encode(&foreign).unwrap(), false);
        assert_eq!((number(flash.open().newest().unwrap()), flash.open().spare()), (5.0, (1, 4)));
    }
    flash.slots[0][100] ^= 1;
    assert_eq!(flash.open().newest().unwrap_err(), TableError::Checksum);
}

#[test]
fn sequence_numbers_go_round() {
    for (first, second, newest) in [(u32::MAX, 0, 2.0), (0, u32::MAX, 1.0), (5, 4, 1.0), (4, 5, 2.0)] {
        let mut flash = Flash::new();
        for (slot, sequence) in [first, second].into_iter().enumerate() {
            flash.write(slot, 0, &numbered(slot as u16 + 1));
            flash.write(slot, SLOT - 8, &record(sequence));
        }
        assert_eq!(number(flash.open().newest().unwrap()), newest);
    }
}

#[test]
fn a_power_cut_after_any_byte_leaves_a_valid_table() {
    let updates = SLOT + numbered(0).len() + 8;
    for (recorded, backwards) in [(0, false), (0, true), (1, false), (1, true), (2, false), (2, true)] {
        let mut seen = [false; 2];
        for power in 0..=updates {
            let mut flash = Flash::new();
            flash.write(0, 0, &numbered(100));
            for earlier in 0..recorded {
                flash.update(&numbered(101 + earlier), false);
            }
            let old = number(flash.open().newest().unwrap());
            flash.power = power;
            flash.update(&numbered(200), backwards);
            let found = number(flash.open().newest().unwrap());
            assert!(found == old || found == 200.0, "{power} {found}");
            // A record that ends in ones is whole before its last bytes are written.
            assert!(if found == 200.0 { power > updates - 8 } else { power < updates }, "{power}");
            seen[usize::from(found == 200.0)] = true;
            // The next update succeeds, whatever the cut left behind.
            flash.power = usize::MAX;
            flash.update(&numbered(300), backwards);
            assert_eq!(number(flash.open().newest().unwrap()), 300.0, "{power}");
        }
        assert_eq!(seen, [true; 2]);
    }
}

#[test]
fn a_patrol_goes_round_and_finds_every_flipped_bit() {
    let mut bytes = numbered(7);
    let body = bytes.len() - layout::CHECKSUM_SIZE;
    for most in [1, 5, 64, 1000] {
        let mut patrol = Patrol::new(&Table::<2>::open(&bytes).unwrap());
        let calls = body.div_ceil(most);
        assert!((1..=3 * calls).all(|call| patrol.check(&bytes, most) == Ok(call % calls == 0)));
        let rest = [Ok(false); 1000];
        for bit in 0..body * 8 {
            bytes[bit / 8] ^= 1 << (bit % 8);
            let found: Vec<_> = (0..calls).map(|_| patrol.check(&bytes, most)).collect();
            assert_eq!(found[..calls - 1], rest[..calls - 1]);
            assert_eq!(found[calls - 1], Err(TableError::Checksum), "{bit}");
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        assert_eq!(patrol.check(&bytes[..0], most), Err(TableError::Truncated));
    }
}
