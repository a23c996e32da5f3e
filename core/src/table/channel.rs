//! A channel of the table: one quantity at every node, decoded where it lies.

use super::{
    ChannelRecord, TableError,
    layout::{DATA_ALIGNMENT, VALUE_MOST},
};

/// What a channel is; the discriminant is what a table stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum ChannelKind {
    /// Force (N).
    Force = 1,
    /// Velocity (m/s).
    Velocity = 2,
}

impl ChannelKind {
    /// All kinds, in the order in which a table has them.
    pub const ALL: [Self; 2] = [Self::Force, Self::Velocity];

    /// The quantity's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::Velocity => "velocity",
        }
    }
}

/// How a channel's values are stored; the discriminant is what a table stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Encoding {
    /// As they are.
    F32 = 1,
    /// As multiples of the channel's scale.
    I16 = 2,
}

impl Encoding {
    /// All encodings.
    pub const ALL: [Self; 2] = [Self::F32, Self::I16];

    /// The encoding stored as `code`.
    pub fn of(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|encoding| *encoding as u8 == code)
    }

    /// Size of a stored value (bytes).
    pub fn size(self) -> usize {
        match self {
            Self::F32 => size_of::<f32>(),
            Self::I16 => size_of::<i16>(),
        }
    }
}

/// Two neighbours along the last axis, from `index` on, and what they count for.
#[derive(Clone, Copy)]
pub(super) struct Row {
    pub(super) index: usize,
    pub(super) weight: f32,
}

/// A channel's values where they lie.
#[derive(Clone, Copy, Debug)]
pub(super) enum Channel<'a> {
    F32(&'a [[u8; 4]]),
    I16(&'a [[u8; 2]], f32),
}

impl<'a> Channel<'a> {
    /// The channel of `count` values that `data` starts with, and what follows its padding.
    ///
    /// # Errors
    /// If `data` is too short, the padding is not zero, or a value out of bounds.
    pub(super) fn split(record: &ChannelRecord, count: usize, data: &'a [u8]) -> Result<(Self, &'a [u8]), TableError> {
        let size = count.checked_mul(record.encoding.size()).ok_or(TableError::Header("length"))?;
        let padded = size.checked_next_multiple_of(DATA_ALIGNMENT).ok_or(TableError::Header("length"))?;
        let (values, data) = data.split_at_checked(padded).ok_or(TableError::Header("length"))?;
        let (values, padding) = values.split_at_checked(size).ok_or(TableError::Header("length"))?;
        if padding.iter().any(|byte| *byte != 0) {
            return Err(TableError::Header("padding"));
        }
        let channel = match record.encoding {
            Encoding::F32 => Self::F32(values.as_chunks().0),
            Encoding::I16 => Self::I16(values.as_chunks().0, record.scale),
        };
        // The scale bounds integers.
        if let Self::F32(values) = channel
            && !values.iter().all(|value| float(*value).abs() <= VALUE_MOST)
        {
            return Err(TableError::Value(record.kind.name()));
        }
        Ok((channel, data))
    }

    /// The sum over `rows` of the two neighbours in each, which count for `weights`.
    #[inline(always)]
    pub(super) fn sum(&self, rows: &[Row], weights: [f32; 2]) -> f32 {
        match self {
            Self::F32(values) => sum(values, float, rows, weights),
            Self::I16(values, scale) => *scale * sum(values, integer, rows, weights),
        }
    }
}

#[inline(always)]
fn float(bytes: [u8; 4]) -> f32 {
    f32::from_le_bytes(bytes)
}

#[inline(always)]
fn integer(bytes: [u8; 2]) -> f32 {
    f32::from(i16::from_le_bytes(bytes))
}

#[inline(always)]
fn sum<T: Copy>(values: &[T], decode: fn(T) -> f32, rows: &[Row], [lower, upper]: [f32; 2]) -> f32 {
    // Adding to −0 changes nothing, and the compiler knows.
    let mut total = -0.0;
    for row in rows {
        // Always there, since the grid's size was checked; but the compiler does not know and would add a panic.
        if let Some([a, b]) = values.get(row.index..).and_then(<[T]>::first_chunk) {
            total += row.weight * (lower * decode(*a) + upper * decode(*b));
        }
    }
    total
}
