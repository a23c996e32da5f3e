//! What the builder writes, as the reader on the target sees it.

use proptest::prelude::*;
use slipfit_core::table::{AxisKind, Encoding, Header, Lookup, MotionVerdict, Table, TableError, layout, motions};

use super::{AxisSpec, ChannelSpec, FlashError, TABLE_REGION, TableSpec, encode};

const BOTH: [Encoding; 2] = [Encoding::F32, Encoding::I16];

fn axis(kind: AxisKind, first: f32, step: f32, count: usize) -> AxisSpec {
    AxisSpec { kind, first, step, count }
}

/// Values without a pattern that an exchange of axes or channels would keep.
fn channel(count: usize, greatest: f32) -> ChannelSpec {
    let values = (0..count).map(|i| ((i * i * 37 + i * 11 + 5) % 65_535) as f32 / 32_767.0 - 1.0);
    let values = values.map(|value| value * greatest).collect();
    ChannelSpec { values, worst_error: greatest * 1e-3, rms_error: greatest * 1e-4 }
}

fn grid(axes: Vec<AxisSpec>, encoding: Encoding) -> TableSpec {
    let count = axes.iter().map(|axis| axis.count).product();
    let motions = motions(axes.iter().map(|axis| axis.count)).unwrap();
    let verdicts = (0..motions).map(|i| MotionVerdict::ALL[i * i % 4]).collect();
    TableSpec {
        scene_hash: 0x0123_4567_89ab_cdef,
        axes,
        encoding,
        force: channel(count, 4.0),
        velocity: channel(count, 0.1),
        verdicts,
        production: None,
    }
}

/// A table over 2 or 3 axes whose nodes f32 holds exactly, with an odd number of them.
pub(super) fn small(axes: usize, encoding: Encoding) -> TableSpec {
    let mut all = vec![
        axis(AxisKind::Level, -1.0, 0.5, 3),
        axis(AxisKind::Time, 0.25, 0.125, 5),
        axis(AxisKind::Position, 0.0, 2.0, 3),
    ];
    all.truncate(axes);
    grid(all, encoding)
}

/// Force and velocity at `at` in f64, by the definition: one axis after the other, from the nodes of the specification.
fn naive(spec: &TableSpec, at: &[f32]) -> [f64; 2] {
    fn blend(axes: &[AxisSpec], at: &[f32], values: &[f32]) -> f64 {
        let ([axis, axes @ ..], [x, at @ ..]) = (axes, at) else { return values[0].into() };
        let u = (f64::from(*x) - f64::from(axis.first)) / f64::from(axis.step);
        let u = u.clamp(0.0, (axis.count - 1) as f64);
        let slabs: Vec<_> = values.chunks(values.len() / axis.count).collect();
        let (lower, upper) = (u.floor() as usize, u.ceil() as usize);
        let (a, b) = (blend(axes, at, slabs[lower]), blend(axes, at, slabs[upper]));
        a + (b - a) * (u - u.floor())
    }
    [&spec.force, &spec.velocity].map(|channel| blend(&spec.axes, at, &channel.values))
}

fn lookup<const N: usize>(bytes: &[u8], at: &[f32]) -> Lookup {
    Table::<N>::open(bytes).unwrap().lookup(at.try_into().unwrap())
}

/// The greatest difference (N or m/s) from [`naive`] that rounding, and storing as i16, may make.
fn tolerance(spec: &TableSpec, channel: &ChannelSpec) -> f64 {
    let greatest = channel.values.iter().fold(0.0, |greatest: f32, value| greatest.max(value.abs()));
    let r = spec.axes.iter().fold(0.0, |r, axis| {
        let (first, step, count) = (f64::from(axis.first), f64::from(axis.step), axis.count as f64);
        r + count + first.abs().max((first + step * (count - 1.0)).abs()) / step
    });
    let rounding = (6.0 * r + 16.0) / f64::from(1 << 24);
    let storing = if spec.encoding == Encoding::I16 { 0.500_001 / 32_767.0 } else { 0.0 };
    f64::from(greatest) * (rounding + storing)
}

fn assert_near(spec: &TableSpec, found: &Lookup, at: &[f32]) {
    let [force, velocity] = naive(spec, at);
    assert!((f64::from(found.force) - force).abs() <= tolerance(spec, &spec.force), "{at:?} {found:?} {force}");
    let difference = (f64::from(found.velocity) - velocity).abs();
    assert!(difference <= tolerance(spec, &spec.velocity), "{at:?} {found:?} {velocity}");
}

#[test]
fn says_what_was_written() {
    for encoding in BOTH {
        let spec = small(2, encoding);
        let bytes = encode(&spec).unwrap();
        let table = Table::open(&bytes).unwrap().expect_scene(spec.scene_hash).unwrap();
        for (found, axis) in table.axes().iter().zip(&spec.axes) {
            let found = AxisSpec { kind: found.kind(), first: found.first(), step: found.step(), count: found.count() };
            assert_eq!(found, *axis);
        }
        assert_eq!(table.channels().map(|record| record.worst_error), [4.0 * 1e-3, 0.1 * 1e-3]);
        assert_eq!(table.channels().map(|record| record.rms_error), [4.0 * 1e-4, 0.1 * 1e-4]);
        assert_eq!(table.encoding(), encoding);
        assert_eq!((table.scene_hash(), table.length()), (spec.scene_hash, bytes.len()));
        assert_eq!(Header::read(&bytes).unwrap().axes.as_slice(), table.axes());
        let _ = table.lookup([0.0, 0.0]);
    }
}

#[test]
fn layout_is_what_is_written_down() {
    let bytes = encode(&small(2, Encoding::I16)).unwrap();
    assert_eq!(bytes[..12], *b"SLFT\x03\0\x02\x02\xef\xcd\xab\x89");
    assert_eq!(bytes[16..24], [164, 0, 0, 0, 1, 0, 0, 0]);
    assert_eq!(bytes[52..68], [0; 16]);
    assert_eq!(bytes[72..76], (4.0f32 * 1e-3).to_le_bytes());
    assert_eq!(bytes[84..88], (0.1f32 * 1e-3).to_le_bytes());
    assert_eq!(bytes.len(), 92 + 16 * 4 + 4 + 4);
    // Undecided, runs, undecided; each differs from the next one.
    assert_eq!(bytes[152..160], [0, 0, 0, 0, 1, 3, 0, 0]);
    // The first node's force and velocity are the same part of their channels' greatest.
    assert_eq!(bytes[92..94], bytes[94..96]);
    // The target computes the checksum bit by bit, this by a table.
    let checksum = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&bytes[..160]);
    assert_eq!(bytes[160..], checksum.to_le_bytes());
}

#[test]
fn exact_at_nodes_and_linear_between() {
    let spec = small(3, Encoding::F32);
    let bytes = encode(&spec).unwrap();
    let table = Table::<3>::open(&bytes).unwrap();
    let node = |axis: usize, i: usize| spec.axes[axis].first + spec.axes[axis].step * i as f32;
    for (i, j, k) in (0..45).map(|i| (i / 15, i / 3 % 5, i % 3)) {
        let index = (i * 5 + j) * 3 + k;
        let at = [node(0, i), node(1, j), node(2, k)];
        let (force, velocity) = (spec.force.values[index], spec.velocity.values[index]);
        let found = table.lookup(at);
        assert!(!found.clamped);
        assert_near(&spec, &found, &at);
        assert_eq!(found, Lookup { force, velocity, clamped: false, mixed: false, damaged: false });
        if i < 2 && j < 4 && k < 2 {
            let half = table.lookup([at[0], at[1], at[2] + 1.0]);
            assert_eq!(half.force, force + 0.5 * (spec.force.values[index + 1] - force));
        }
    }
}

#[test]
fn clamps_and_says_so() {
    let bytes = encode(&small(2, Encoding::F32)).unwrap();
    let table = Table::open(&bytes).unwrap();
    let (low, high) = ([-1.0, 0.25], [0.0, 0.75]);
    for outside in [f32::INFINITY, f32::MAX, 1.0, 0.750_000_1] {
        assert_eq!(table.lookup([0.0, outside]), Lookup { clamped: true, ..table.lookup(high) });
    }
    for outside in [f32::NEG_INFINITY, f32::MIN, -0.0, 0.249_999_9] {
        assert_eq!(table.lookup([-1.0, outside]), Lookup { clamped: true, ..table.lookup(low) });
    }
    for outside in [f32::NAN, -f32::NAN] {
        let Lookup { force, velocity, clamped, mixed, .. } = table.lookup([outside, outside]);
        assert!(clamped && !mixed && force.abs() <= 4.0 && velocity.abs() <= 0.1);
    }
    assert_eq!(table.lookup([-0.0, 0.75]), table.lookup(high));
    assert!(!table.lookup(low).clamped && !table.lookup(high).clamped);
}

/// Opens `bytes` over 2 and over 3 axes; the error, if both fail.
fn refusal(bytes: &[u8]) -> Option<TableError> {
    let (two, three) = (Table::<2>::open(bytes).err(), Table::<3>::open(bytes).err());
    if matches!(two, Some(TableError::Axes { .. })) { three } else { two }
}

#[test]
fn refuses_every_flipped_bit() {
    for (axes, encoding) in [(2, BOTH[0]), (2, BOTH[1]), (3, BOTH[0]), (3, BOTH[1])] {
        let table = encode(&small(axes, encoding)).unwrap();
        for rest in [0, 300] {
            let mut region = [table.as_slice(), &vec![0xff; rest]].concat();
            assert_eq!(refusal(&region), None);
            for bit in 0..table.len() * 8 {
                region[bit / 8] ^= 1 << (bit % 8);
                assert!(refusal(&region).is_some(), "bit {bit}");
                region[bit / 8] ^= 1 << (bit % 8);
            }
        }
    }
}

#[test]
fn refuses_flipped_bits_of_a_great_table() {
    let axes = vec![axis(AxisKind::Level, -3.0, 0.1, 61), axis(AxisKind::Time, 0.0, 1e-3, 500)];
    let mut table = encode(&grid(axes, Encoding::F32)).unwrap();
    const LENGTH: usize = 92 + (61 * 500 + 1) * 8 + 64 + 4;
    table.resize(TABLE_REGION, 0xff);
    let mut random = 1u64;
    for _ in 0..300 {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let bit = (random >> 33) as usize % (LENGTH * 8);
        table[bit / 8] ^= 1 << (bit % 8);
        assert!(refusal(&table).is_some(), "bit {bit}");
        table[bit / 8] ^= 1 << (bit % 8);
    }
    assert_eq!(Table::<2>::open(&table).unwrap().length(), LENGTH);
}

#[test]
fn refuses_every_truncation() {
    for (axes, encoding) in [(2, BOTH[0]), (3, BOTH[1])] {
        let table = encode(&small(axes, encoding)).unwrap();
        for length in 0..table.len() {
            assert_eq!(refusal(&table[..length]), Some(TableError::Truncated), "{length}");
        }
    }
}

#[test]
fn refuses_other_scenes_axes_versions_and_no_table() {
    let mut bytes = encode(&small(3, Encoding::F32)).unwrap();
    assert_eq!(Table::<2>::open(&bytes).unwrap_err(), TableError::Axes { found: 3 });
    let scene = Table::<3>::open(&bytes).unwrap().expect_scene(1).unwrap_err();
    assert_eq!(scene, TableError::Scene { found: 0x0123_4567_89ab_cdef });
    let kinds = [AxisKind::Level, AxisKind::Position, AxisKind::Time];
    let kind = Table::<3>::open(&bytes).unwrap().expect_axes(kinds).unwrap_err();
    assert_eq!(kind, TableError::Kind { axis: 1, found: AxisKind::Time, asked: AxisKind::Position });
    assert_eq!(kind.to_string(), "axis 1 is over time, asked for is position");
    let kinds = [AxisKind::Level, AxisKind::Time, AxisKind::Position];
    assert!(Table::<3>::open(&bytes).unwrap().expect_axes(kinds).is_ok());
    for found in [2, 4] {
        bytes[layout::VERSION_AT] = found as u8;
        assert_eq!(refusal(&bytes), Some(TableError::Version { found }));
    }
    assert_eq!(refusal(&[0xff; 4096]), Some(TableError::Magic));
}

/// The table with `field` written over what is at `at`, and the checksum put right.
fn forged(table: &[u8], at: usize, field: &[u8]) -> Vec<u8> {
    let mut table = table.to_vec();
    table[at..at + field.len()].copy_from_slice(field);
    let body = table.len() - layout::CHECKSUM_SIZE;
    let checksum = layout::checksum(&table[..body]).to_le_bytes();
    table[body..].copy_from_slice(&checksum);
    table
}

#[test]
fn refuses_contradictions_under_a_right_checksum() {
    let table = encode(&small(2, Encoding::I16)).unwrap();
    let one = 1u32.to_le_bytes();
    let many = u32::MAX.to_le_bytes();
    let nan = f32::NAN.to_le_bytes();
    for (at, field, what) in [
        (6, &[1][..], "number of axes"),
        (6, &[4], "number of axes"),
        (6, &[3], "kind of axis"),
        (7, &[3], "encoding"),
        (7, &[1], "scale"),
        (20, &[9], "kind of axis"),
        (21, &[1], "reserved byte of an axis"),
        (24, &one, "number of nodes"),
        (24, &many, "number of nodes"),
        (24, &[4], "length"),
        (24, &[2], "length"),
        (28, &nan, "first or last node"),
        (32, &[0; 4], "step between nodes"),
        (52, &[1], "absent axis"),
        (68, &nan, "scale"),
        (72, &nan, "worst error"),
        (76, &nan, "mean error"),
        (88, &1f32.to_le_bytes(), "mean error"),
    ] {
        assert_eq!(refusal(&forged(&table, at, field)), Some(TableError::Header(what)), "{at}");
    }
    let table = encode(&small(2, Encoding::F32)).unwrap();
    assert_eq!(refusal(&forged(&table, 92, &nan)), Some(TableError::Value("force")));
    assert_eq!(refusal(&forged(&table, 96, &1e31f32.to_le_bytes())), Some(TableError::Value("velocity")));
    // The node behind the last one, which is read with it.
    assert_eq!(refusal(&forged(&table, 212, &nan)), Some(TableError::Value("force")));
    assert_eq!(refusal(&forged(&table, 220, &[8])), Some(TableError::Value("verdicts")));
}

#[test]
fn builder_names_what_is_wrong() {
    type Change = fn(&mut TableSpec);
    let cases: [(Change, &str); 8] = [
        (|spec| spec.verdicts.truncate(2), "2 verdicts for 3 motions"),
        (|spec| spec.axes.truncate(1), "a table has 2 or 3 axes, not 1"),
        (|spec| spec.axes[0].count = 1, "an axis needs at least 2 levels, the Level axis has 1"),
        (|spec| spec.axes[1].step = 0.0, "the Time axis: bad step between nodes"),
        (|spec| spec.force.values.truncate(14), "force has 14 values for 15 nodes"),
        (|spec| spec.axes[1].count = 1 << 16, "force has 15 values for 196608 nodes"),
        (|spec| spec.velocity.values[7] = f32::NAN, "velocity at node 7 is NaN, allowed is -1e30 to 1e30"),
        (
            |spec| spec.velocity.worst_error = -1.0,
            "the interpolation error of velocity is -1 at worst and 0.00001 in the mean",
        ),
    ];
    for (change, message) in cases {
        let mut spec = small(2, Encoding::F32);
        change(&mut spec);
        assert_eq!(encode(&spec).unwrap_err().to_string(), message);
    }
    let axes = |times| vec![axis(AxisKind::Level, 0.0, 1.0, 4), axis(AxisKind::Time, 0.0, 1e-3, times)];
    assert_eq!(encode(&grid(axes(8188), Encoding::F32)).unwrap().len(), TABLE_REGION - 20);
    let error = encode(&grid(axes(8189), Encoding::F32)).unwrap_err();
    assert_eq!(error, FlashError::TooLarge { bytes: TABLE_REGION + 12, region: TABLE_REGION });
}

#[test]
fn i16_takes_half_the_bytes_and_any_magnitude() {
    for greatest in [1e30f32, 1.0, 1e-30, 1e-42, 0.0] {
        let mut spec = small(2, Encoding::I16);
        spec.force = channel(15, greatest);
        let bytes = encode(&spec).unwrap();
        assert_eq!(bytes.len() + 16 * 4, encode(&small(2, Encoding::F32)).unwrap().len());
        let found = lookup::<2>(&bytes, &[-0.5, 0.5]);
        if greatest != 1e-42 {
            assert_near(&spec, &found, &[-0.5, 0.5]);
        }
        assert!(found.force.is_finite());
    }
}

/// A specification with arbitrary axes and values.
fn any_spec(axes: usize) -> impl Strategy<Value = TableSpec> {
    let axis = (-10.0f32..10.0, 0.01f32..3.0, 2usize..9).prop_map(|(first, step, count)| (first, step, count));
    (prop::collection::vec(axis, axes), prop::bool::ANY).prop_flat_map(|(axes, wide)| {
        let count: usize = axes.iter().map(|(_, _, count)| count).product();
        let values = || prop::collection::vec(-100.0f32..100.0, count);
        let encoding = BOTH[usize::from(wide)];
        let motions = motions(axes.iter().map(|(.., count)| *count)).unwrap();
        (values(), values()).prop_map(move |(force, velocity)| TableSpec {
            verdicts: vec![MotionVerdict::Runs; motions],
            production: None,
            scene_hash: 1,
            axes: axes
                .iter()
                .zip(AxisKind::ALL)
                .map(|(&(first, step, count), kind)| AxisSpec { kind, first, step, count })
                .collect(),
            encoding,
            force: ChannelSpec { values: force, worst_error: 0.0, rms_error: 0.0 },
            velocity: ChannelSpec { values: velocity, worst_error: 0.0, rms_error: 0.0 },
        })
    })
}

/// Coordinates from a little below to a little above each axis.
fn points(spec: &TableSpec, parts: &[f32]) -> Vec<f32> {
    let span = |axis: &AxisSpec| axis.step * (axis.count - 1) as f32;
    spec.axes.iter().zip(parts).map(|(axis, part)| axis.first + part * span(axis)).collect()
}

proptest! {
    #[test]
    fn agrees_with_the_definition_over_two_axes(spec in any_spec(2), parts in prop::array::uniform2(-0.2f32..1.2)) {
        let (bytes, at) = (encode(&spec).unwrap(), points(&spec, &parts));
        let found = lookup::<2>(&bytes, &at);
        assert_near(&spec, &found, &at);
        prop_assert!(found.clamped || parts.iter().all(|part| (-1e-6..1.000_001).contains(part)));
        prop_assert!(!found.clamped || parts.iter().any(|part| !(1e-6..0.999_999).contains(part)));
    }

    #[test]
    fn agrees_with_the_definition_over_three_axes(spec in any_spec(3), parts in prop::array::uniform3(-0.2f32..1.2)) {
        let (bytes, at) = (encode(&spec).unwrap(), points(&spec, &parts));
        assert_near(&spec, &lookup::<3>(&bytes, &at), &at);
    }

    #[test]
    fn beyond_an_end_is_at_the_end(spec in any_spec(2), x in -20.0f32..20.0, beyond in 1e-3f32..1e9) {
        let bytes = encode(&spec).unwrap();
        let table = Table::open(&bytes).unwrap();
        let [_, axis] = table.axes();
        for (end, outside) in [(axis.first(), axis.first() - beyond), (axis.last(), axis.last() + beyond)] {
            let (found, at_end) = (table.lookup([x, outside]), table.lookup([x, end]));
            // As f32 has it, the last node may be a rounding away from a whole number of steps.
            prop_assert!((found.force - at_end.force).abs() <= tolerance(&spec, &spec.force) as f32);
            prop_assert!((found.velocity - at_end.velocity).abs() <= tolerance(&spec, &spec.velocity) as f32);
            prop_assert!(found.clamped);
        }
    }

    #[test]
    fn any_coordinate_gives_numbers(x: u32, y: u32, z: u32) {
        let at = [x, y, z].map(f32::from_bits);
        for encoding in BOTH {
            let found = lookup::<3>(&encode(&small(3, encoding)).unwrap(), &at);
            prop_assert!(found.force.abs() <= 4.000_001 && found.velocity.abs() <= 0.100_001);
        }
    }

    #[test]
    fn any_bytes_are_answered(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        prop_assert!(refusal(&bytes).is_some());
    }

    #[test]
    fn any_header_is_answered(at in 4usize..152, field in prop::collection::vec(any::<u8>(), 1..8)) {
        let bytes = forged(&encode(&small(2, Encoding::F32)).unwrap(), at, &field);
        if let Ok(table) = Table::open(&bytes) {
            let found = table.lookup([-0.3, 0.4]);
            prop_assert!(found.force.is_finite() && found.velocity.is_finite());
        }
    }
}
