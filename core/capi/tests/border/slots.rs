//! Two slots of flash, and updates of them.

use std::ptr;

use slipfit_capi::*;
use slipfit_core::table::{AxisKind, layout};

use super::{
    common::zeroed,
    table::{table, table_over},
};

/// Two slots, as long as the first.
pub fn slots(first: &'static [u8], second: &'static [u8], word: u32) -> slipfit_slots {
    slipfit_slots { first: first.as_ptr(), second: second.as_ptr(), length: first.len() as u32, word }
}

/// An update as C does it, on flash of every programming word.
#[test]
fn an_update_of_two_slots() {
    let axes = [(AxisKind::Level, 3, 1.0), (AxisKind::Time, 4, 0.1)];
    for word in [1, 2, 4, 8, 16, 32] {
        let old = table_over(&axes);
        let length = old.len().next_multiple_of(32) + 64;
        let (mut first, mut second) = (vec![0xff; length], vec![0xff; length]);
        first[..old.len()].copy_from_slice(&old);
        let (mut table, mut spare) = (zeroed::<slipfit_table>(), zeroed::<slipfit_spare>());
        let (mut record, mut found) = (zeroed::<slipfit_record>(), zeroed::<slipfit_lookup>());
        // SAFETY: every pointer is to a local of its type, and the bytes outlive the table.
        unsafe {
            let mut open = |first: &[u8], second: &[u8]| {
                let slots =
                    slipfit_slots { first: first.as_ptr(), second: second.as_ptr(), length: length as u32, word };
                assert_eq!(slipfit_slots_open(&mut table, &slots, SLIPFIT_AXIS_TIME, 7, &mut spare), SLIPFIT_OK);
                assert_eq!(slipfit_table_look_up(&table, 0.0, 0.0, &mut found), SLIPFIT_OK);
                (found.force, spare)
            };
            let room = length as u32 - word.max(8);
            assert_eq!(open(&first, &second), (0.0, slipfit_spare { slot: 1, sequence: 0, room }));
            second[..old.len()].copy_from_slice(&old);
            second[layout::HEADER_SIZE..][..4].copy_from_slice(&5.0f32.to_le_bytes());
            let checksum = layout::checksum(&second[..old.len() - 4]).to_le_bytes();
            second[old.len() - 4..old.len()].copy_from_slice(&checksum);
            assert_eq!(open(&first, &second).0, 0.0);
            assert_eq!(slipfit_record_make(&mut record, word, 0), SLIPFIT_OK);
            assert_eq!(record.size, word.max(8));
            second[length - record.size as usize..].copy_from_slice(&record.bytes[..record.size as usize]);
            assert_eq!(open(&first, &second), (5.0, slipfit_spare { slot: 0, sequence: 1, room }));
            // A slot that cannot be read: the other one counts.
            let slots = slipfit_slots { first: first.as_ptr(), second: ptr::null(), length: length as u32, word };
            assert_eq!(slipfit_slots_open(&mut table, &slots, SLIPFIT_AXIS_TIME, 7, &mut spare), SLIPFIT_OK);
            assert_eq!(spare, slipfit_spare { slot: 1, sequence: 0, room });
        }
    }
}

#[test]
fn slots_that_do_not_open_leave_nothing_open_and_say_nothing() {
    let bytes: &'static [u8] = table().leak();
    let (mut table, mut found) = (zeroed::<slipfit_table>(), zeroed::<slipfit_lookup>());
    let untouched = slipfit_spare { slot: 77, sequence: 78, room: 79 };
    let both = slots(bytes, bytes, 8);
    let erased: &'static [u8] = &[0xff; 400];
    let null = ptr::null();
    for (slots, over, hash, status) in [
        // Table and record do not fit.
        (both, SLIPFIT_AXIS_TIME, 7, SLIPFIT_TABLE_SLOT),
        (slots(erased, erased, 8), SLIPFIT_AXIS_TIME, 7, SLIPFIT_TABLE_MAGIC),
        (both, SLIPFIT_AXIS_POSITION, 7, SLIPFIT_TABLE_KIND),
        (both, 0, 7, SLIPFIT_PARAMETER),
        (both, SLIPFIT_AXIS_TIME, 8, SLIPFIT_TABLE_SCENE),
        (slipfit_slots { word: 0, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_PARAMETER),
        (slipfit_slots { word: 24, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_PARAMETER),
        (slipfit_slots { word: 64, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_PARAMETER),
        (slipfit_slots { length: 10, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_TABLE_TRUNCATED),
        (slipfit_slots { first: null, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_TABLE_SLOT),
        (slipfit_slots { second: null, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_TABLE_SLOT),
        (slipfit_slots { first: null, second: null, ..both }, SLIPFIT_AXIS_TIME, 7, SLIPFIT_NULL),
    ] {
        // SAFETY: every pointer is to a local of its type, and the bytes stay.
        unsafe {
            let opened = slipfit_table_open(&mut table, bytes.as_ptr(), bytes.len() as u32, SLIPFIT_AXIS_TIME, 7);
            assert_eq!(opened, SLIPFIT_OK);
            let mut spare = untouched;
            assert_eq!(slipfit_slots_open(&mut table, &slots, over, hash, &mut spare), status);
            assert_eq!(spare, untouched);
            assert_eq!(slipfit_table_look_up(&table, 0.0, 0.0, &mut found), SLIPFIT_NOT_MADE);
            // Nor if what it says has nowhere to go.
            let _ = slipfit_table_open(&mut table, bytes.as_ptr(), bytes.len() as u32, SLIPFIT_AXIS_TIME, 7);
            assert_eq!(slipfit_slots_open(&mut table, &slots, over, hash, ptr::null_mut()), SLIPFIT_NULL);
            assert_eq!(slipfit_table_look_up(&table, 0.0, 0.0, &mut found), SLIPFIT_NOT_MADE);
        }
    }
}
