//! Lookups in integers.

use std::ptr;

use slipfit_capi::*;
use slipfit_core::table::{AxisKind, Table, layout};

use super::{
    common::zeroed,
    table::{sealed, table, table_over},
};

/// A table of i16 over 3 levels and 4 instants, in thousandths.
fn bytes() -> Vec<u8> {
    let of_floats = table_over(&[(AxisKind::Level, 3, 1.0), (AxisKind::Time, 4, 0.1)]);
    let (header, data) = of_floats.split_at(layout::HEADER_SIZE);
    let mut bytes = header.to_vec();
    bytes[layout::ENCODING_AT] = 2;
    for channel in 0..layout::CHANNELS {
        let scale = layout::CHANNELS_AT + layout::CHANNEL_SIZE * channel + layout::CHANNEL_SCALE_AT;
        bytes[scale..][..4].copy_from_slice(&1e-3f32.to_le_bytes());
    }
    let values = data.as_chunks::<4>().0.iter().take(2 * (3 * 4 + 1));
    bytes.extend(values.flat_map(|value| ((1000.0 * f32::from_le_bytes(*value)) as i16).to_le_bytes()));
    bytes.extend(&data[8 * (3 * 4 + 1)..data.len() - layout::CHECKSUM_SIZE]);
    let length = (bytes.len() + layout::CHECKSUM_SIZE) as u32;
    bytes[layout::LENGTH_AT..][..4].copy_from_slice(&length.to_le_bytes());
    sealed(bytes)
}

#[test]
fn integers_are_rusts_and_the_floats_of_the_table() {
    let bytes: &'static [u8] = bytes().leak();
    let length = bytes.len() as u32;
    let rust = Table::<2>::open(bytes).unwrap().i16().unwrap();
    let (mut table, mut integers) = (zeroed::<slipfit_table>(), zeroed::<slipfit_integers>());
    let (mut found, mut float) = (zeroed::<slipfit_integer_lookup>(), zeroed::<slipfit_lookup>());
    // SAFETY: every pointer is to a local of its type, and the bytes stay.
    unsafe {
        assert_eq!(slipfit_integers_look_up(&integers, 0, &mut found), SLIPFIT_NOT_MADE);
        assert_eq!(slipfit_table_open(&mut table, bytes.as_ptr(), length, SLIPFIT_AXIS_TIME, 7), SLIPFIT_OK);
        for n in [-1.0, 0.0, 0.25, 1.9, 2.0] {
            assert_eq!(slipfit_integers_init(&mut integers, &table, n, 1e-3), SLIPFIT_OK);
            let (mut force_scale, mut velocity_scale) = (0.0, 0.0);
            assert_eq!(slipfit_integers_scales(&integers, &mut force_scale, &mut velocity_scale), SLIPFIT_OK);
            assert_eq!([force_scale, velocity_scale], [1e-3; 2]);
            let in_rust = rust.integers(n, 1e-3).unwrap();
            for at in [i32::MIN, -1, 0, 1, 57, 100, 299, 300, 301, i32::MAX] {
                assert_eq!(slipfit_integers_look_up(&integers, at, &mut found), SLIPFIT_OK);
                let expected = in_rust.lookup(at);
                assert_eq!([found.force, found.velocity], [expected.force, expected.velocity]);
                assert_eq!([found.clamped, found.mixed], [expected.clamped, expected.mixed].map(u32::from));
                assert_eq!(slipfit_table_look_up(&table, n, at as f32 * 1e-3, &mut float), SLIPFIT_OK);
                assert!((found.force as f32 * 1e-3 - float.force).abs() < 5e-3, "{n} {at}: {found:?} {float:?}");
            }
        }
        for unit in [0.0, -1.0, 0.11, 1e-9, f32::NAN, f32::INFINITY] {
            assert_eq!(slipfit_integers_init(&mut integers, &table, 1.0, unit), SLIPFIT_PARAMETER);
            assert_eq!(slipfit_integers_look_up(&integers, 0, &mut found), SLIPFIT_NOT_MADE);
        }
        assert_eq!(slipfit_integers_init(ptr::null_mut(), &table, 1.0, 1e-3), SLIPFIT_NULL);
        assert_eq!(slipfit_integers_init(&mut integers, ptr::null(), 1.0, 1e-3), SLIPFIT_NULL);
        assert_eq!(slipfit_integers_init(&mut integers, &table, 1.0, 1e-3), SLIPFIT_OK);
        assert_eq!(slipfit_integers_look_up(&integers, 0, ptr::null_mut()), SLIPFIT_NULL);
        let mut scale = 0.0;
        assert_eq!(slipfit_integers_scales(&integers, &mut scale, ptr::null_mut()), SLIPFIT_NULL);
    }
}

#[test]
fn a_table_of_floats_is_refused() {
    let bytes: &'static [u8] = table().leak();
    let (mut table, mut integers) = (zeroed::<slipfit_table>(), zeroed::<slipfit_integers>());
    // SAFETY: every pointer is to a local of its type, and the bytes stay.
    unsafe {
        let length = bytes.len() as u32;
        assert_eq!(slipfit_table_open(&mut table, bytes.as_ptr(), length, SLIPFIT_AXIS_TIME, 7), SLIPFIT_OK);
        assert_eq!(slipfit_integers_init(&mut integers, &table, 1.0, 1e-3), SLIPFIT_TABLE_ENCODING);
    }
}
