//! The cyclic check.

use std::ptr;

use slipfit_capi::*;
use slipfit_core::table::layout;

use super::{common::zeroed, table::table};

/// The check is an object of its own: the table is only read, while an interrupt looks it up as well as by the check itself.
#[test]
fn a_scrubber_finds_what_changes_and_counts_its_rounds() {
    let mut bytes = table();
    let length = bytes.len();
    let (mut table, mut scrubber, mut rounds) = (zeroed::<slipfit_table>(), zeroed::<slipfit_scrubber>(), 41u32);
    let pointer = bytes.as_mut_ptr();
    // SAFETY: every pointer is to a local of its type, and the bytes outlive the table; only a raw pointer changes them, while
    // no call is under way.
    unsafe {
        assert_eq!(slipfit_table_open(&mut table, pointer, length as u32, SLIPFIT_AXIS_TIME, 7), SLIPFIT_OK);
        assert_eq!(slipfit_scrubber_check(&mut scrubber, 1, &mut rounds), SLIPFIT_NOT_MADE);
        assert_eq!(slipfit_scrubber_init(&mut scrubber, &table), SLIPFIT_OK);
        let mut found = zeroed::<slipfit_lookup>();
        let mut round = |most: u32| {
            let before = rounds;
            loop {
                assert_eq!(slipfit_table_look_up(&table, 1.0, 0.1, &mut found), SLIPFIT_OK);
                let status = slipfit_scrubber_check(&mut scrubber, most, &mut rounds);
                if rounds != before {
                    assert_eq!(rounds, before + 1);
                    return status;
                }
                assert_eq!(status, SLIPFIT_OK);
            }
        };
        for most in [0, 1, 64, u32::MAX] {
            assert_eq!(round(most), SLIPFIT_OK);
        }
        // In the data, and in the stored checksum. Flash changes by itself; an interpreter of Rust calls that undefined.
        for place in [layout::HEADER_SIZE, length - 1].into_iter().take(if cfg!(miri) { 0 } else { 2 }) {
            *pointer.add(place) ^= 1;
            assert_eq!(round(64), SLIPFIT_TABLE_CHECKSUM);
            *pointer.add(place) ^= 1;
            assert_eq!(round(64), SLIPFIT_OK);
        }
        assert_eq!(rounds, 41 + if cfg!(miri) { 4 } else { 8 });
        assert_eq!(slipfit_scrubber_check(&mut scrubber, 1, ptr::null_mut()), SLIPFIT_NULL);
    }
}
