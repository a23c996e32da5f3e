//! The reader, on bytes laid out by hand: whatever the machine's own byte order.

use std::vec::Vec;

use super::{AnyNodes, AxisKind, Encoding, Lookup, MotionVerdict, Table, TableError, example, layout, verdict_bytes};

const PLANE: [(AxisKind, u32, f32); 2] = [(AxisKind::Level, 3, 1.0), (AxisKind::Time, 4, 0.5)];
const SPACE: [(AxisKind, u32, f32); 3] =
    [(AxisKind::Level, 3, 1.0), (AxisKind::Position, 4, 0.5), (AxisKind::Velocity, 2, 0.25)];

#[test]
fn the_layout_is_little_endian() {
    let bytes = example::table(&PLANE, |node| node as f32);
    assert_eq!(bytes[..8], [b'S', b'L', b'F', b'T', layout::VERSION as u8, 0, 2, 1]);
    assert_eq!(bytes[layout::SCENE_HASH_AT..][..8], [7, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(bytes[layout::AXES_AT..][..16], [1, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0x3f]);
    // The second node's force and velocity.
    assert_eq!(bytes[layout::HEADER_SIZE + 8..][..8], [0, 0, 0x80, 0x3f, 0xcd, 0xcc, 0xcc, 0x3d]);
    // The checksum of "123456789", as its specification has it.
    assert_eq!(layout::checksum(b"123456789"), 0xcbf4_3926);
}

#[test]
fn reads_values_of_either_kind() {
    let single = example::table(&PLANE, |node| node as f32);
    let integers = example::table_of_integers(&PLANE, |node| 1000 * node as i16 - 300);
    let [single, integers] = [&single, &integers].map(|bytes| Table::<2>::open(bytes).unwrap());
    assert_eq!([single.encoding(), integers.encoding()], [Encoding::F32, Encoding::I16]);
    for (at, force) in [([0.0, 0.0], 0.0), ([1.0, 0.5], 5.0), ([1.5, 0.75], 7.5), ([9.0, 9.0], 11.0)] {
        assert_eq!(single.lookup(at).force, force);
        assert!((single.lookup(at).velocity - 0.1 * force).abs() < 1e-6);
        assert!((integers.lookup(at).force - (force - 0.3)).abs() < 1e-5);
        assert!((integers.lookup(at).velocity - 0.1 * (force - 0.3)).abs() < 1e-5);
    }
    let forces: Vec<f32> = single.forces(0.25).unwrap().collect();
    assert_eq!(forces, [0.5, 4.5, 8.5]);
    let bytes = example::table(&SPACE, |node| node as f32);
    assert_eq!(Table::<3>::open(&bytes).unwrap().lookup([1.0, 0.5, 0.25]).force, 11.0);
}

#[test]
fn refuses_every_flipped_bit_and_every_short_length() {
    let mut bytes = example::table_of_integers(&PLANE, |node| node as i16);
    assert!(Table::<2>::open(&bytes).is_ok());
    for length in 0..bytes.len() {
        let error = Table::<2>::open(&bytes[..length]).unwrap_err();
        assert!(matches!(error, TableError::Truncated), "{length}: {error}");
    }
    for bit in (0..bytes.len() * 8).step_by(if cfg!(miri) { 11 } else { 1 }) {
        bytes[bit / 8] ^= 1 << (bit % 8);
        assert!(Table::<2>::open(&bytes).is_err(), "{bit}");
        bytes[bit / 8] ^= 1 << (bit % 8);
    }
}

/// The table with the bytes `stored` for its motions, and the checksum put right.
fn judged(mut bytes: Vec<u8>, stored: &[u8]) -> Vec<u8> {
    let body = bytes.len() - layout::CHECKSUM_SIZE;
    bytes.truncate(body);
    bytes[body - stored.len().next_multiple_of(4)..][..stored.len()].copy_from_slice(stored);
    bytes.extend(layout::checksum(&bytes).to_le_bytes());
    bytes
}

#[test]
fn says_where_neighbours_did_different_things() {
    let [undecided, runs, _, jammed] = MotionVerdict::ALL;
    let plain = example::table(&PLANE, |node| node as f32);
    assert!(Table::<2>::open(&plain).unwrap().verdict([2, 3]) == Some(undecided));
    // Two that run, one that jams.
    let bytes = judged(plain, &verdict_bytes(&[runs, runs, jammed], 1).collect::<Vec<_>>());
    let table = Table::<2>::open(&bytes).unwrap();
    assert_eq!([0, 1, 2, 3].map(|i| table.verdict([i, 0])), [Some(runs), Some(runs), Some(jammed), None]);
    for (n, mixed) in [(0.0, false), (0.5, false), (1.0, false), (1.000_001, true), (1.5, true), (1.999_999, true)] {
        assert_eq!(table.lookup([n, 0.3]).mixed, mixed, "{n}");
        assert_eq!(table.lookup([n, 99.0]), Lookup { clamped: true, ..table.lookup([n, 1.5]) });
    }
    // At an end and beyond it there is one unit.
    for n in [2.0, 2.1, -0.1, f32::MAX, f32::INFINITY, -f32::INFINITY, f32::NAN, -f32::NAN] {
        assert!(!table.lookup([n, 0.3]).mixed, "{n}");
    }
    // One level, one speed, jams: between it and its neighbours along either axis, wherever along the motion.
    let verdicts: Vec<_> = verdict_bytes(&[runs, runs, runs, jammed, runs, runs], 2).collect();
    let bytes = judged(example::table(&SPACE, |node| node as f32), &verdicts);
    let table = Table::<3>::open(&bytes).unwrap();
    assert_eq!(table.verdict([1, 3, 1]), Some(jammed));
    for (n, speed, mixed) in [
        (1.0, 0.25, false),
        (1.0, 0.24, true),
        (1.0, 0.0, false),
        (0.5, 0.0, false),
        (0.5, 0.25, true),
        (1.5, 0.25, true),
        (1.5, 0.1, true),
        (0.0, 0.1, false),
        (2.0, 0.1, false),
    ] {
        assert_eq!(table.lookup([n, 0.7, speed]).mixed, mixed, "{n} {speed}");
    }
}

#[test]
fn refuses_verdicts_that_there_are_not() {
    let table = || example::table(&PLANE, |node| node as f32);
    assert!(verdict_bytes(&[MotionVerdict::Runs, MotionVerdict::Jammed], 1).eq([3, 6]));
    assert!(Table::<2>::open(&judged(table(), &[3, 6, 6])).is_ok());
    // None such, one that does not differ, one that does, one that has no next one, and what follows them.
    for stored in [[8, 8, 8, 0], [3, 2, 2, 0], [2, 6, 6, 0], [2, 2, 3, 0], [2, 2, 2, 2]] {
        let bytes = judged(table(), &stored);
        assert_eq!(Table::<2>::open(&bytes).unwrap_err(), TableError::Value("verdicts"), "{stored:?}");
    }
}

/// The open `table`, whose nodes are read from `bytes` instead: what flash has become since.
fn flipped<'a>(table: &Table<'a>, bytes: &'a [u8]) -> Table<'a> {
    let data = bytes[layout::HEADER_SIZE..].split_at(13 * layout::CHANNELS * table.encoding().size()).0;
    Table { nodes: AnyNodes::unchecked(table.encoding(), table.channels(), data), ..*table }
}

#[test]
fn no_flip_since_it_was_opened_leads_out_of_the_tables_own_range() {
    let singles = example::table(&PLANE, |node| node as f32 - 3.0);
    let integers = example::table_of_integers(&PLANE, |node| 1000 * node as i16 - 3000);
    for bytes in [singles, integers] {
        let table = Table::<2>::open(&bytes).unwrap();
        let points = || (0..9).flat_map(|n| (0..13).map(move |t| [0.25 * n as f32, 0.125 * t as f32]));
        assert!(points().all(|at| !table.lookup(at).damaged));
        let data = layout::HEADER_SIZE..bytes.len() - layout::CHECKSUM_SIZE;
        let mut found = 0;
        for bit in (8 * data.start..8 * data.end).step_by(if cfg!(miri) { 61 } else { 1 }) {
            let mut changed = bytes.clone();
            changed[bit / 8] ^= 1 << (bit % 8);
            let other = flipped(&table, &changed);
            for at in points() {
                let (good, bad) = (table.lookup(at), other.lookup(at));
                assert!((-3.000_02..=8.000_02).contains(&bad.force), "{bit} {at:?} {bad:?}");
                assert!((-0.300_002..=0.800_002).contains(&bad.velocity), "{bit} {at:?} {bad:?}");
                // What is held is flagged; what is flagged differs.
                assert!(!bad.damaged || bad != Lookup { damaged: true, ..good }, "{bit} {at:?}");
                found += u32::from(bad.damaged);
            }
            let forces = other.forces(0.7).map(Vec::from_iter);
            assert!(forces.is_none_or(|forces| forces.iter().all(|force| (-3.000_02..=8.000_02).contains(force))));
        }
        // An interpreter has time for a few flips alone.
        assert!(cfg!(miri) || found > 1000, "{found}");
    }
}

#[test]
fn no_rounding_leads_out_of_the_tables_own_range() {
    // Greatest and least values, equal ones, and those that no f32 sum of two of them holds.
    for scale in [1.0, -1.0, 5e29, -5e29, 1e-38, 3.3e-3, 0.0] {
        let odd = |node: u32| (1.0 + (node.wrapping_mul(2_654_435_761) >> 9) as f32 / 8_388_608.0) * scale;
        for force in [&odd as &dyn Fn(u32) -> f32, &|_| scale] {
            let (plane, space) = (example::table(&PLANE, force), example::table(&SPACE, force));
            let (plane, space) = (Table::<2>::open(&plane).unwrap(), Table::<3>::open(&space).unwrap());
            for i in 0..if cfg!(miri) { 20 } else { 5000 } {
                let [n, t, speed] = [0.37, 0.229, 0.0131].map(|step| step * i as f32);
                let at = [n % 2.0, t % 1.5, speed % 0.25];
                assert!(!plane.lookup([at[0], at[1]]).damaged, "{scale} {at:?}");
                assert!(plane.forces(at[1]).is_some(), "{scale} {at:?}");
                assert!(!space.lookup(at).damaged, "{scale} {at:?}");
            }
        }
    }
}

#[test]
fn refuses_other_axes_and_scenes() {
    let bytes = example::table(&PLANE, |node| node as f32);
    let table = Table::<2>::open(&bytes).unwrap();
    assert_eq!((table.scene_hash(), table.length(), table.bytes()), (7, bytes.len(), &*bytes));
    assert!(table.expect_scene(7).is_ok() && table.expect_axes([AxisKind::Level, AxisKind::Time]).is_ok());
    assert_eq!(table.expect_scene(8).unwrap_err(), TableError::Scene { found: 7 });
    for (kinds, axis) in [([AxisKind::Level, AxisKind::Position], 1), ([AxisKind::Row, AxisKind::Time], 0)] {
        let error = table.expect_axes(kinds).unwrap_err();
        assert_eq!(error, TableError::Kind { axis, found: PLANE[axis].0, asked: kinds[axis] });
    }
    assert!(matches!(Table::<3>::open(&bytes).unwrap_err(), TableError::Axes { found: 2 }));
    assert!(table.i16().is_none() && table.f32().is_some());
}
