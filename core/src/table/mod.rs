//! The flash table: force and velocity over a grid, read in place.
//!
//! [`Table::open`] checks a table once, completely; what it returns cannot fail any more. Nothing is copied: values are
//! decoded from the flash at each [`Table::lookup`], byte by byte, so that the region needs no alignment.
//!
//! # Layout, version 1
//! Little-endian. Every field lies at a multiple of its own size. Offsets in bytes, here and in [`layout`]:
//!
//! | offset | type | field |
//! |---|---|---|
//! | 0 | `[u8; 4]` | magic, "SLFT" |
//! | 4 | u16 | format version, 1 |
//! | 6 | u8 | number of axes, 2 or 3 |
//! | 7 | u8 | number of channels, 2 |
//! | 8 | u64 | hash of the scene and its laws |
//! | 16 | u32 | length in bytes, from the magic to the end of the checksum |
//! | 20, 36, 52 | axis | three records of 16 bytes; those of absent axes are all zero |
//! | 68, 80 | channel | two records of 12 bytes: force (N), then velocity (m/s) |
//! | 92 | data | the force's values, zero to three zero bytes, the velocity's values, zero to three zero bytes |
//! | length − 4 | u32 | checksum, CRC-32/ISO-HDLC, of all bytes before it |
//!
//! | in an axis | type | field |
//! |---|---|---|
//! | 0 | u8 | what varies: 1 tolerance level n, 2 time t (s), 3 position z (m), 4 velocity (m/s) |
//! | 1 | `[u8; 3]` | zero |
//! | 4 | u32 | number of nodes, 2 to 2¹⁶ |
//! | 8 | f32 | first node |
//! | 12 | f32 | distance between nodes, positive |
//!
//! | in a channel | type | field |
//! |---|---|---|
//! | 0 | u8 | what it is: 1 force (N), 2 velocity (m/s) |
//! | 1 | u8 | how values are stored: 1 f32, 2 i16 |
//! | 2 | `[u8; 2]` | zero |
//! | 4 | f32 | what a stored value is multiplied with: positive; 1 for f32 |
//! | 8 | f32 | worst interpolation error (N or m/s), measured when the table was made |
//!
//! Values are ordered with the last axis fastest, and each channel starts at a multiple of 4. No value exceeds 10³⁰ in
//! magnitude. The table may lie in a larger region; what follows it is not looked at.
//!
//! *Compatibility:* a reader accepts its own version only. Whatever moves a byte or gives it another meaning raises the
//! version.

mod axis;
mod channel;
mod error;
mod header;
pub mod layout;

use channel::{Channel, Row};
use layout::{CHANNELS, CHECKSUM_SIZE, HEADER_SIZE};

pub use axis::{Axis, AxisKind};
pub use channel::{ChannelKind, Encoding};
pub use error::TableError;
pub use header::{ChannelRecord, Header};

/// A checked table over `N` axes, 2 or 3, in the region it was opened from.
#[derive(Clone, Copy, Debug)]
pub struct Table<'a, const N: usize = 2> {
    scene_hash: u64,
    length: usize,
    axes: [Axis; N],
    /// How many values apart two neighbours along each axis are.
    strides: [usize; N],
    records: [ChannelRecord; CHANNELS],
    channels: [Channel<'a>; CHANNELS],
}

/// What a table says about one point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Lookup {
    /// Force (N).
    pub force: f32,
    /// Velocity (m/s).
    pub velocity: f32,
    /// The point lay outside the grid, or was NaN: these are the values at the grid's nearest point.
    pub clamped: bool,
}

impl<'a, const N: usize> Table<'a, N> {
    /// Checks the table that `region` starts with.
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

        let mut values = 1usize;
        let mut strides = [0; N];
        for (stride, axis) in strides.iter_mut().zip(&axes).rev() {
            *stride = values;
            values = values.checked_mul(axis.count()).ok_or(TableError::Header("length"))?;
        }

        let data = region.get(HEADER_SIZE..header.length.saturating_sub(CHECKSUM_SIZE)).ok_or(TableError::Truncated)?;
        let [force, velocity] = header.channels;
        let (force, data) = Channel::split(&force, values, data)?;
        let (velocity, data) = Channel::split(&velocity, values, data)?;
        if !data.is_empty() {
            return Err(TableError::Header("length"));
        }
        Ok(Self {
            scene_hash: header.scene_hash,
            length: header.length,
            axes,
            strides,
            records: header.channels,
            channels: [force, velocity],
        })
    }

    /// This table, if it was made for the scene and laws that `hash` stands for.
    ///
    /// # Errors
    /// [`TableError::Scene`] if it was made for others.
    pub fn expect_scene(self, hash: u64) -> Result<Self, TableError> {
        if self.scene_hash == hash { Ok(self) } else { Err(TableError::Scene { found: self.scene_hash }) }
    }

    /// Force and velocity at the point `at`, one coordinate an axis, in the axes' order and units.
    ///
    /// Multilinear between the nodes. Outside the grid the nearest point of the grid counts, for NaN the low end. Never
    /// fails and is never NaN. Exact at a node whose distance from the first one, in steps, comes out whole in f32;
    /// elsewhere rounding stays within (6·r + 16)·2⁻²⁴ of the channel's greatest magnitude, where r adds up, over all
    /// axes, the number of nodes and how many steps the end farther from 0 is away from it.
    #[inline]
    pub fn lookup(&self, at: [f32; N]) -> Lookup {
        let mut rows = [Row { index: 0, weight: 1.0 }; ROWS];
        let mut weights = [1.0, 0.0];
        let mut clamped = false;
        for (i, ((axis, stride), x)) in self.axes.iter().zip(self.strides).zip(at).enumerate() {
            let place = axis.locate(x);
            clamped |= place.clamped;
            weights = [1.0 - place.fraction, place.fraction];
            // The last axis picks two neighbours in each row; every other one doubles the number of rows.
            for (k, row) in rows.iter_mut().enumerate() {
                if i + 1 == N {
                    row.index += place.cell;
                } else {
                    let upper = k >> i & 1;
                    row.index += (place.cell + upper) * stride;
                    row.weight *= if upper == 1 { place.fraction } else { 1.0 - place.fraction };
                }
            }
        }
        let rows = rows.get(..rows_of(N)).unwrap_or(&rows);
        let [force, velocity] = self.channels.map(|channel| channel.sum(rows, weights));
        Lookup { force, velocity, clamped }
    }

    /// The axes, slowest first.
    pub fn axes(&self) -> &[Axis; N] {
        &self.axes
    }

    /// The records of force and velocity.
    pub fn channels(&self) -> &[ChannelRecord; CHANNELS] {
        &self.records
    }

    /// Hash of the scene and laws the table was made for.
    pub fn scene_hash(&self) -> u64 {
        self.scene_hash
    }

    /// Length of the table (bytes); the region may be longer.
    pub fn length(&self) -> usize {
        self.length
    }
}

/// Rows of a cell of the greatest number of axes.
const ROWS: usize = rows_of(layout::AXES_MOST);

/// Pairs of neighbours along the last axis, at the corners of a cell over `axes` axes.
const fn rows_of(axes: usize) -> usize {
    1 << (axes - 1)
}
