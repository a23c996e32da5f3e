//! What a lookup takes on one core after another: of a table of i16 over level and time, with floating point and in integers.

use core::{fmt, hint::black_box};

use slipfit_core::table::{AxisKind, Encoding, I16Nodes, IntegerLookup, Integers, Lookup, Table, layout};

use crate::{
    count::{Count, Range},
    machine::Machine,
};

/// Levels, instants, and milliseconds between two instants.
const GRID: [u32; 3] = [3, 20, 10];

/// Bytes of the table, with its padding.
const LENGTH: usize = layout::HEADER_SIZE + 4 * (3 * 20 + 1) + 4 + layout::CHECKSUM_SIZE;

/// Instructions of the two.
#[derive(Clone, Copy, Debug)]
pub struct Lookups {
    /// With floating point.
    pub float: Option<Range>,
    /// In integers.
    pub integers: Option<Range>,
}

/// Writes `bytes` into the table at `place`.
fn put<const N: usize>(table: &mut [u8; LENGTH], place: usize, bytes: [u8; N]) {
    for (byte, value) in table.iter_mut().skip(place).zip(bytes) {
        *byte = value;
    }
}

/// A table whose forces differ from node to node.
fn table() -> [u8; LENGTH] {
    let mut table = [0; LENGTH];
    put(&mut table, 0, layout::MAGIC);
    put(&mut table, 4, layout::VERSION.to_le_bytes());
    put(&mut table, 6, [2, Encoding::I16 as u8]);
    put(&mut table, layout::LENGTH_AT, (LENGTH as u32).to_le_bytes());
    let [levels, instants, apart] = GRID;
    for (axis, (kind, count, step)) in
        [(AxisKind::Level, levels, 0.5), (AxisKind::Time, instants, apart as f32 * 1e-3)].into_iter().enumerate()
    {
        let place = layout::AXES_AT + 16 * axis;
        put(&mut table, place, [kind as u8, 0, 0, 0]);
        put(&mut table, place + 4, count.to_le_bytes());
        put(&mut table, place + 12, f32::to_le_bytes(step));
    }
    for channel in 0..layout::CHANNELS {
        put(&mut table, layout::CHANNELS_AT + 12 * channel, f32::to_le_bytes(1e-3));
    }
    for node in 0..levels * instants {
        let force = (node.wrapping_mul(40_503) >> 3) as i16;
        let place = layout::HEADER_SIZE + 4 * node as usize;
        put(&mut table, place, force.to_le_bytes());
        put(&mut table, place + 2, (force / 10).to_le_bytes());
    }
    let body = LENGTH - layout::CHECKSUM_SIZE;
    let checksum = layout::checksum(table.split_at(body).0);
    put(&mut table, body, checksum.to_le_bytes());
    table
}

#[inline(never)]
fn in_float(table: &Table<'_, 2, I16Nodes<'_>>, at: f32) -> Lookup {
    table.lookup([0.7, at])
}

#[inline(never)]
fn in_integers(table: &Integers<'_>, at: i32) -> IntegerLookup {
    table.lookup(at)
}

impl Lookups {
    /// Looks up, at and between nodes and beyond the ends.
    ///
    /// # Panics
    /// If a lookup in integers is not the one with floating point.
    pub fn on(machine: &mut impl Machine) -> Self {
        let bytes = black_box(table());
        let table = Table::<2>::open(&bytes).expect("a table").i16().expect("of i16");
        let integers = table.integers(0.7, 1e-3).expect("milliseconds are finer than the nodes");
        let [mut of_float, mut of_integers] = [Count::default(); 2];
        for at in -5..205 {
            let mut found = (Lookup::default(), IntegerLookup::default());
            let seconds = at as f32 * 1e-3;
            of_float.add(machine.instructions(|| found.0 = black_box(in_float(&table, black_box(seconds)))));
            of_integers.add(machine.instructions(|| found.1 = black_box(in_integers(&integers, black_box(at)))));
            let difference = found.0.force * 1e3 - found.1.force as f32;
            assert!((-8.0..8.0).contains(&difference) && found.0.mixed == found.1.mixed, "{at}: {found:?}");
        }
        Self { float: of_float.range(), integers: of_integers.range() }
    }
}

/// The least and the greatest number of instructions of either.
impl fmt::Display for Lookups {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [float, integers] = [self.float, self.integers].map(|range| range.map(Range::ends).unwrap_or_default());
        write!(f, "{} {} {} {}", float.0, float.1, integers.0, integers.1)
    }
}
