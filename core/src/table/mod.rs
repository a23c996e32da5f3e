//! The flash table: force and velocity over a grid, read in place.
//!
//! [`Table::open`] checks a table once, completely; what it returns cannot fail any more. Nothing is copied: values are
//! decoded from the flash at each [`Table::lookup`], byte by byte, so that the region needs no alignment.
//!
//! # Layout, version 3
//! Little-endian. Every field lies at a multiple of its own size, or of 4. Offsets in bytes, here and in [`layout`]:
//!
//! | offset | type | field |
//! |---|---|---|
//! | 0 | `[u8; 4]` | magic, "SLFT" |
//! | 4 | u16 | format version, 3 |
//! | 6 | u8 | number of axes, 2 or 3 |
//! | 7 | u8 | how values are stored: 1 f32, 2 i16 |
//! | 8 | u64 | hash of the scene and its laws |
//! | 16 | u32 | length in bytes, from the magic to the end of the checksum |
//! | 20, 36, 52 | axis | three records of 16 bytes; those of absent axes are all zero |
//! | 68, 80 | channel | two records of 12 bytes: force (N), then velocity (m/s) |
//! | 92 | data | a node after the other, the last axis fastest: force and velocity of each; then one more of any values |
//! | behind it | u8 each | the verdict on every motion; then zero bytes up to a multiple of 4 |
//! | length − 4 | u32 | checksum, CRC-32/ISO-HDLC, of all bytes before it |
//!
//! | in an axis | type | field |
//! |---|---|---|
//! | 0 | u8 | what varies: 1 tolerance level n, 2 time t (s), 3 position z (m), 4 commanded speed (m/s), 5 row of a production |
//! | 1 | `[u8; 3]` | zero |
//! | 4 | u32 | number of nodes, 2 to 2¹⁶ |
//! | 8 | f32 | first node |
//! | 12 | f32 | distance between nodes, positive |
//!
//! | in a channel | type | field |
//! |---|---|---|
//! | 0 | f32 | what a stored value is multiplied with: positive; 1 for f32 |
//! | 4 | f32 | worst interpolation error (N or m/s), measured when the table was made |
//! | 8 | f32 | root mean square of that error (N or m/s) in use: after the drive has started, where no slide stops short |
//!
//! A motion proceeds along the second axis, so that there is one for every node of the first and, where there are three, of
//! the third, which is the fastest. Its byte is twice a [`MotionVerdict`], plus 1 if the motion at the next node of the first
//! axis has another one. Where the verdicts of neighbours differ, values between them are those of no unit: one runs and the
//! other jams, and no unit does half of each. [`Lookup::mixed`] says so.
//!
//! A table whose first axis is rows of a production has a record of [`layout::PRODUCTION_SIZE`] bytes between the verdicts and the
//! checksum, see [`production`](crate::production).
//!
//! The node behind the last one is read with the last one, and weighs nothing.
//!
//! No value exceeds 10³⁰ in magnitude. The table may lie in a larger region; what follows it is not looked at, but
//! for the record at the end of a slot, see [`Slots`].
//!
//! *Compatibility:* a reader accepts its own version only. Whatever moves a byte or gives it another meaning raises the
//! version.

mod axis;
mod codes;
mod error;
#[cfg(test)]
pub(crate) mod example;
mod header;
mod integers;
pub mod layout;
mod nodes;
mod scrubber;
mod slots;
#[cfg(test)]
mod tests;
#[cfg(feature = "embedded-storage")]
mod update;
mod verdict;

use layout::{CHANNELS, CHECKSUM_SIZE, HEADER_SIZE};

pub use axis::Axis;
pub(crate) use axis::Place;
pub use codes::{AxisKind, Encoding};
pub use error::TableError;
pub use header::{ChannelRecord, Header};
pub use integers::{IntegerLookup, Integers};
use nodes::Range;
pub use nodes::{AnyNodes, ChannelKind, F32Nodes, I16Nodes, Nodes, Values};
pub use scrubber::Scrubber;
pub use slots::{RECORD_SIZE, Record, Slots, WORD_MOST, Word};
#[cfg(feature = "embedded-storage")]
pub use update::{Update, UpdateError, is_readable};
pub use verdict::{MotionVerdict, motions, verdict_bytes};

/// A checked table over `N` axes, 2 or 3, in the region it was opened from.
///
/// `V` is how values are stored: either way unless [`Table::f32`] or [`Table::i16`] has made sure, after which a lookup
/// need not ask and the other way leaves no code.
#[derive(Clone, Copy, Debug)]
pub struct Table<'a, const N: usize = 2, V = AnyNodes<'a>> {
    /// The table alone, from the magic to the checksum.
    bytes: &'a [u8],
    scene_hash: u64,
    axes: [Axis; N],
    records: [ChannelRecord; CHANNELS],
    /// Of the values when the table was opened.
    ranges: [Range; CHANNELS],
    nodes: V,
    /// A [`MotionVerdict`] each.
    verdicts: &'a [u8],
    /// The record of a production; empty without one.
    production: &'a [u8],
}

/// What a table says about one point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Lookup {
    /// Force (N).
    pub force: f32,
    /// Velocity (m/s).
    pub velocity: f32,
    /// The point lay outside the grid, or was NaN: these are the values at the grid's nearest point.
    pub clamped: bool,
    /// The point lies between motions whose verdicts differ, such as a unit that runs and one that jams: these are values
    /// of no unit.
    pub mixed: bool,
    /// A value lay outside the range of the channel's nodes, as they were when the table was opened: the flash has changed
    /// since. It is held to that range. A change that stays within the range is found by [`Scrubber`] alone.
    pub damaged: bool,
}

impl Lookup {
    /// Whether its values must not be used: it is clamped, mixed or damaged.
    pub fn is_unusable(&self) -> bool {
        self.clamped || self.mixed || self.damaged
    }
}

impl<'a, const N: usize> Table<'a, N> {
    /// Checks the table that `region` starts with. The number of axes must be said: `Table::<2>::open(region)`.
    ///
    /// Any single flipped bit is refused. Takes time in proportion to the table's length, most of it for the checksum.
    ///
    /// # Errors
    /// [`TableError`] says what is wrong, for tables over another number of axes than `N` too.
    pub fn open(region: &'a [u8]) -> Result<Self, TableError> {
        const { assert!(N >= layout::AXES_LEAST && N <= layout::AXES_MOST) };
        let header = Header::read(region)?;
        let found = header.axes.len();
        let axes = header.axes.into_array::<N>().map_err(|_| TableError::Axes { found })?;

        let mut count = 1usize;
        for axis in &axes {
            count = count.checked_mul(axis.count()).ok_or(TableError::Header("length"))?;
        }

        let bytes = region.get(..header.length).ok_or(TableError::Truncated)?;
        let data = bytes.get(HEADER_SIZE..header.length.saturating_sub(CHECKSUM_SIZE)).ok_or(TableError::Truncated)?;
        let size = count.checked_add(1).and_then(|count| count.checked_mul(CHANNELS * header.encoding.size()));
        let (nodes, rest) = size.and_then(|size| data.split_at_checked(size)).ok_or(TableError::Header("length"))?;
        let (nodes, ranges) = AnyNodes::new(header.encoding, &header.channels, nodes)?;
        let record = if axes[0].kind() == AxisKind::Row { layout::PRODUCTION_SIZE } else { 0 };
        let verdict_bytes = rest.len().checked_sub(record).ok_or(TableError::Header("length"))?;
        let (rest, production) = rest.split_at_checked(verdict_bytes).ok_or(TableError::Header("length"))?;
        let speeds = axes.get(2).map_or(1, Axis::count);
        let verdicts = verdict::checked(rest, axes[0].count().saturating_mul(speeds), speeds)?;
        let (scene_hash, records) = (header.scene_hash, header.channels);
        Ok(Self { bytes, scene_hash, axes, records, ranges, nodes, verdicts, production })
    }

    /// This table, if its values are f32.
    pub fn f32(self) -> Option<Table<'a, N, F32Nodes<'a>>> {
        match self.nodes {
            AnyNodes::F32(nodes) => Some(self.with(nodes)),
            AnyNodes::I16(_) => None,
        }
    }

    /// This table, if its values are i16.
    pub fn i16(self) -> Option<Table<'a, N, I16Nodes<'a>>> {
        match self.nodes {
            AnyNodes::I16(nodes) => Some(self.with(nodes)),
            AnyNodes::F32(_) => None,
        }
    }

    fn with<V>(self, nodes: V) -> Table<'a, N, V> {
        let Self { bytes, scene_hash, axes, records, ranges, verdicts, production, .. } = self;
        Table { bytes, scene_hash, axes, records, ranges, nodes, verdicts, production }
    }

    /// How values are stored.
    pub fn encoding(&self) -> Encoding {
        match self.nodes {
            AnyNodes::F32(_) => Encoding::F32,
            AnyNodes::I16(_) => Encoding::I16,
        }
    }
}

impl<const N: usize, V: Nodes> Table<'_, N, V> {
    /// This table, if it was made for the scene and laws that `hash` stands for.
    ///
    /// # Errors
    /// [`TableError::Scene`] if it was made for others.
    pub fn expect_scene(self, hash: u64) -> Result<Self, TableError> {
        if self.scene_hash == hash { Ok(self) } else { Err(TableError::Scene { found: self.scene_hash }) }
    }

    /// This table, if its axes are over the quantities `kinds`, slowest first: a point's coordinates are bare numbers, and
    /// a time would be looked up among positions.
    ///
    /// # Errors
    /// [`TableError::Kind`] names the first axis that is over another quantity.
    pub fn expect_axes(self, kinds: [AxisKind; N]) -> Result<Self, TableError> {
        let found = self.axes.iter().map(Axis::kind);
        let other = found.zip(kinds).enumerate().find(|(_, (found, asked))| found != asked);
        match other {
            None => Ok(self),
            Some((axis, (found, asked))) => Err(TableError::Kind { axis, found, asked }),
        }
    }

    /// Force and velocity at the point `at`, one coordinate an axis, in the axes' order and units.
    ///
    /// Multilinear between the nodes. Outside the grid the nearest point of the grid counts, for NaN either end of the
    /// axis. Never fails and is never NaN, whatever became of the flash since. Exact at a node whose distance from the first one, in steps, comes out whole
    /// in f32; elsewhere rounding stays within (6·r + 16)·2⁻²⁴ of the channel's greatest
    /// magnitude, where r adds up, over all axes, the number of nodes and how many steps the end farther from 0 is away
    /// from it.
    #[inline]
    pub fn lookup(&self, at: [f32; N]) -> Lookup {
        let mut places = [Place::default(); N];
        for ((axis, x), place) in self.axes.iter().zip(at).zip(&mut places) {
            *place = axis.locate(x);
        }
        self.lookup_at(&places)
    }

    /// [`lookup`](Self::lookup) at `places`, one an axis.
    #[inline(always)]
    pub(crate) fn lookup_at(&self, places: &[Place; N]) -> Lookup {
        let (mut first, mut outside) = (0, 0);
        for (axis, place) in self.axes.iter().zip(places) {
            first = first * axis.count() + place.node;
            outside |= place.outside;
        }
        let (mut strides, mut stride) = ([0; N], 1);
        for ((axis, place), next) in self.axes.iter().zip(places).zip(&mut strides).rev() {
            *next = if place.has_next { stride } else { 0 };
            stride *= axis.count();
        }
        let fractions = places.map(|place| place.fraction);
        let flags = Lookup { clamped: outside != 0, mixed: self.is_mixed(places), ..Lookup::default() };
        let Some(values) = self.nodes.within(first, &strides, &fractions) else { return flags };
        let [force, velocity] = [self.ranges[0].held(values[0]), self.ranges[1].held(values[1])];
        let changes = (force.to_bits() ^ values[0].to_bits()) | (velocity.to_bits() ^ values[1].to_bits());
        Lookup { force, velocity, damaged: changes != 0, ..flags }
    }

    /// Whether `places` lie between motions whose verdicts differ.
    #[inline(always)]
    pub(crate) fn is_mixed(&self, places: &[Place; N]) -> bool {
        verdict::differ(self.verdicts, &self.axes, places)
    }

    /// The axes, slowest first.
    pub fn axes(&self) -> &[Axis; N] {
        &self.axes
    }

    /// The records of force and velocity.
    pub fn channels(&self) -> &[ChannelRecord; CHANNELS] {
        &self.records
    }

    /// The verdict on the motion of the nodes `at`, one an axis: which node the second one names is all the same. `None`
    /// beyond the grid.
    pub fn verdict(&self, at: [usize; N]) -> Option<MotionVerdict> {
        let axes = self.axes.iter().zip(at).enumerate().filter(|(axis, _)| *axis != 1);
        let place = axes.map(|(_, pair)| pair).try_fold(0usize, |place, (axis, i)| {
            (i < axis.count()).then(|| place.wrapping_mul(axis.count()).wrapping_add(i))
        });
        MotionVerdict::of(verdict::code(*self.verdicts.get(place?)?))
    }

    /// The record of a production; empty in other tables.
    pub(crate) fn production(&self) -> &[u8] {
        self.production
    }

    /// Hash of the scene and laws the table was made for.
    pub fn scene_hash(&self) -> u64 {
        self.scene_hash
    }

    /// Length of the table (bytes); the region may be longer.
    pub fn length(&self) -> usize {
        self.bytes.len()
    }
}

impl<'a, const N: usize, V> Table<'a, N, V> {
    /// The table alone, from the magic to the checksum.
    pub fn bytes(&self) -> &'a [u8] {
        self.bytes
    }
}

impl<V: Nodes> Table<'_, 2, V> {
    /// Force and velocity (N, m/s) of the `row`-th node of the first axis at `place` on the second.
    #[inline(always)]
    pub(crate) fn of_row(&self, row: usize, place: &Place) -> Values {
        self.nodes.between(place.node + row * self.axes[1].count(), place.fraction)
    }

    /// Whether `force` (N) is within the range that forces had when the table was opened.
    #[inline(always)]
    pub(crate) fn is_in_range(&self, force: f32) -> bool {
        self.ranges[0].contains(force)
    }

    /// The force (N) at every node of the first axis, at `x` on the second. None outside of it, or if one of them lies outside of
    /// the range of all, see [`Lookup::damaged`].
    #[inline]
    pub fn forces(&self, x: f32) -> Option<impl Iterator<Item = f32>> {
        let [nodes, axis] = &self.axes;
        let place = axis.locate(x);
        let forces = || {
            let firsts = (0..nodes.count()).map(move |i| place.node + i * axis.count());
            firsts.map(move |first| self.nodes.between(first, place.fraction)[0])
        };
        // All are looked at, so that the work is the same whichever is bad.
        let good = forces().fold(place.outside == 0, |good, force| good & self.ranges[0].contains(force));
        good.then(forces)
    }
}
