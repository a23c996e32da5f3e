//! Bits that flip by themselves: in a table, in parameters and in states.

use std::{mem, ptr};

use slipfit_capi::*;

use super::{common::zeroed, scene, table::table};

/// Flips that are tried of each.
const FLIPS: u64 = if cfg!(miri) { 20 } else { 10_000 };

/// The `i`-th of numbers that look random.
fn random(i: u64) -> u64 {
    let x = (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb)
}

/// The seal of `object`.
fn seal<T>(object: &T) -> u32 {
    let mut seal = 0;
    // SAFETY: the object is there and is plain memory that was all zeros once.
    let status = unsafe { slipfit_seal(ptr::from_ref(object).cast(), mem::size_of::<T>() as u32, &mut seal) };
    assert_eq!(status, SLIPFIT_OK);
    seal
}

/// Whether each of many flips in `object` changes its seal, and undoing it restores it.
fn every_flip_is_found<T>(object: &mut T) {
    let sealed = seal(object);
    for i in 0..FLIPS {
        let bit = random(i) % (8 * mem::size_of::<T>() as u64);
        let flip = |object: &mut T| {
            // SAFETY: within the object, which nobody uses meanwhile.
            unsafe { *ptr::from_mut(object).cast::<u8>().add((bit / 8) as usize) ^= 1 << (bit % 8) };
        };
        flip(object);
        assert_ne!(seal(object), sealed, "bit {bit}");
        flip(object);
    }
    assert_eq!(seal(object), sealed);
}

#[test]
fn flips_in_parameters_and_states_are_found_at_once() {
    let bytes: &'static [u8] = table().leak();
    let (mut table, mut predictor) = (zeroed::<slipfit_table>(), zeroed::<slipfit_predictor>());
    let (mut monitor, mut unit) = (zeroed::<slipfit_monitor>(), zeroed::<slipfit_unit>());
    let mut limits = zeroed::<slipfit_limits>();
    // SAFETY: every pointer is to a local of its type, and the bytes stay.
    unsafe {
        let length = bytes.len() as u32;
        assert_eq!(slipfit_table_open(&mut table, bytes.as_ptr(), length, SLIPFIT_AXIS_TIME, 7), SLIPFIT_OK);
        assert_eq!(slipfit_predictor_init(&mut predictor, &scene(), 2.5), SLIPFIT_OK);
        assert_eq!(slipfit_limits_for_noise(1e-3, 0.02, &mut limits), SLIPFIT_OK);
        assert_eq!(slipfit_monitor_init(&mut monitor, &table, 1.0, &limits), SLIPFIT_OK);
        assert_eq!(slipfit_unit_init(&mut unit), SLIPFIT_OK);
        for _ in 0..30 {
            let before = seal(&predictor);
            assert_eq!(slipfit_predictor_step(&mut predictor), SLIPFIT_OK);
            assert_ne!(seal(&predictor), before);
        }
    }
    every_flip_is_found(&mut table);
    every_flip_is_found(&mut predictor);
    every_flip_is_found(&mut monitor);
    every_flip_is_found(&mut unit);
}

/// Until the cyclic check comes to it, a flip in a table's flash gives no value beyond the table's own with the status OK.
#[test]
#[cfg_attr(miri, ignore = "flash changes by itself; an interpreter of Rust calls that undefined")]
fn flips_in_a_table_are_found_within_a_round() {
    let mut bytes = table();
    let (pointer, length) = (bytes.as_mut_ptr(), bytes.len() as u64);
    let (mut table, mut scrubber, mut rounds) = (zeroed::<slipfit_table>(), zeroed::<slipfit_scrubber>(), 0);
    let mut found = zeroed::<slipfit_lookup>();
    // SAFETY: every pointer is to a local of its type, and the bytes outlive the table; only a raw pointer changes them, while no call is
    // under way.
    unsafe {
        assert_eq!(slipfit_table_open(&mut table, pointer, length as u32, SLIPFIT_AXIS_TIME, 7), SLIPFIT_OK);
        assert_eq!(slipfit_scrubber_init(&mut scrubber, &table), SLIPFIT_OK);
        for i in 0..FLIPS {
            let bit = random(i) % (8 * length);
            *pointer.add((bit / 8) as usize) ^= 1 << (bit % 8);
            for (n, at) in [(0.0, 0.0), (0.3, 0.12), (1.0, 0.1), (1.7, 0.29), (2.0, 0.3), (9.0, 9.0)] {
                let status = slipfit_table_look_up(&table, n, at, &mut found);
                assert!(status == SLIPFIT_OK || status == SLIPFIT_TABLE_VALUE, "bit {bit}: {status}");
                // Its forces and velocities go from 0 to 23.
                let is_in_range = |value: f32| (-1e-3..=23.001).contains(&value);
                assert!(is_in_range(found.force) && is_in_range(found.velocity), "bit {bit}: {found:?}");
            }
            assert_eq!(
                slipfit_scrubber_check(&mut scrubber, u32::MAX, &mut rounds),
                SLIPFIT_TABLE_CHECKSUM,
                "bit {bit}"
            );
            *pointer.add((bit / 8) as usize) ^= 1 << (bit % 8);
        }
        assert_eq!(slipfit_scrubber_check(&mut scrubber, u32::MAX, &mut rounds), SLIPFIT_OK);
    }
}

/// Two bits, the same one of two words too, as a bad line of data makes them.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn pairs_of_flips_are_found() {
    let mut words: [u32; 64] = std::array::from_fn(|i| random(i as u64) as u32);
    let sealed = seal(&words);
    for bit in 0..32 {
        for one in 0..64 {
            for other in 0..one {
                for more in [bit, (bit + 1) % 32, (bit + 13) % 32] {
                    words[one] ^= 1 << bit;
                    words[other] ^= 1 << more;
                    assert_ne!(seal(&words), sealed, "{one} {other} {bit} {more}");
                    words[one] ^= 1 << bit;
                    words[other] ^= 1 << more;
                }
            }
        }
    }
}

#[test]
fn what_is_no_memory_of_words_is_refused() {
    let (object, mut found) = ([0u32; 4], 0);
    let pointer = ptr::from_ref(&object).cast::<u8>();
    // SAFETY: what is neither null nor misaligned is a local.
    unsafe {
        assert_eq!(slipfit_seal(ptr::null(), 4, &mut found), SLIPFIT_NULL);
        assert_eq!(slipfit_seal(pointer.add(1).cast(), 4, &mut found), SLIPFIT_MISALIGNED);
        assert_eq!(slipfit_seal(pointer.cast(), 6, &mut found), SLIPFIT_LENGTH);
        assert_eq!(slipfit_seal(pointer.cast(), 16, ptr::null_mut()), SLIPFIT_NULL);
        assert_eq!(slipfit_seal(pointer.cast(), 0, &mut found), SLIPFIT_OK);
    }
}
