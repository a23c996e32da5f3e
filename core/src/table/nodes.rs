//! The table's values: force and velocity of a node side by side, decoded where they lie.

use super::{
    ChannelRecord, TableError,
    layout::{CHANNELS, VALUE_MOST},
};

/// What a channel is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ChannelKind {
    /// Force (N).
    Force,
    /// Velocity (m/s).
    Velocity,
}

impl ChannelKind {
    /// All kinds, in the order in which a table has them.
    pub const ALL: [Self; CHANNELS] = [Self::Force, Self::Velocity];

    /// The quantity's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::Velocity => "velocity",
        }
    }
}

/// How values are stored; the discriminant is what a table stores.
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

    /// The type's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::I16 => "i16",
        }
    }

    /// Size of a stored value (bytes).
    pub fn size(self) -> usize {
        match self {
            Self::F32 => size_of::<f32>(),
            Self::I16 => size_of::<i16>(),
        }
    }
}

/// Every node where it lies.
#[derive(Clone, Copy, Debug)]
pub(super) enum Nodes<'a> {
    F32(&'a [[u8; 8]]),
    I16(&'a [[u8; 4]], [f32; CHANNELS]),
}

impl<'a> Nodes<'a> {
    /// The `count` nodes that `data` consists of.
    ///
    /// # Errors
    /// If `data` has another length, or a value is out of bounds.
    pub(super) fn new(
        encoding: Encoding,
        records: &[ChannelRecord; CHANNELS],
        count: usize,
        data: &'a [u8],
    ) -> Result<Self, TableError> {
        if count.checked_mul(CHANNELS * encoding.size()) != Some(data.len()) {
            return Err(TableError::Header("length"));
        }
        // The scale bounds integers.
        Ok(match encoding {
            Encoding::F32 => {
                let nodes = data.as_chunks().0;
                for node in nodes {
                    for (value, channel) in floats(*node).into_iter().zip(ChannelKind::ALL) {
                        if value.is_nan() || value.abs() > VALUE_MOST {
                            return Err(TableError::Value(channel.name()));
                        }
                    }
                }
                Self::F32(nodes)
            }
            Encoding::I16 => Self::I16(data.as_chunks().0, [records[0].scale, records[1].scale]),
        })
    }

    /// Force and velocity at the `fractions` of the cell whose lowest node is `first`; nodes along an axis are its
    /// stride apart.
    #[inline(always)]
    pub(super) fn within<const N: usize>(&self, first: usize, strides: &[usize; N], fractions: &[f32; N]) -> [f32; 2] {
        match self {
            Self::F32(nodes) => cell(nodes, floats, first, strides, fractions),
            Self::I16(nodes, scales) => {
                let [force, velocity] = cell(nodes, integers, first, strides, fractions);
                [scales[0] * force, scales[1] * velocity]
            }
        }
    }
}

#[inline(always)]
fn floats([a, b, c, d, e, f, g, h]: [u8; 8]) -> [f32; CHANNELS] {
    [f32::from_le_bytes([a, b, c, d]), f32::from_le_bytes([e, f, g, h])]
}

#[inline(always)]
fn integers([a, b, c, d]: [u8; 4]) -> [f32; CHANNELS] {
    [f32::from(i16::from_le_bytes([a, b])), f32::from(i16::from_le_bytes([c, d]))]
}

/// What [`Nodes::within`] gives, before scaling.
///
/// Every node is there, since the grid's size was checked; but the compiler does not know and would add a panic.
#[inline(always)]
fn cell<T: Copy>(
    nodes: &[T],
    decode: fn(T) -> [f32; CHANNELS],
    first: usize,
    strides: &[usize],
    fractions: &[f32],
) -> [f32; CHANNELS] {
    let found = match (strides, fractions) {
        ([row, _], [across, along]) => {
            nodes.get(first..first + row + 2).and_then(|face| bilinear(face, decode, *across, *along))
        }
        ([layer, row, _], [up, across, along]) => nodes.get(first..first + layer + row + 2).and_then(|body| {
            let lower = bilinear(body.get(..row + 2)?, decode, *across, *along)?;
            let upper = bilinear(body.get(*layer..)?, decode, *across, *along)?;
            Some(blended(lower, upper, *up))
        }),
        _ => None,
    };
    found.unwrap_or_default()
}

/// Between the first two and the last two of `nodes`, and between the two of each.
#[inline(always)]
fn bilinear<T: Copy>(
    nodes: &[T],
    decode: fn(T) -> [f32; CHANNELS],
    across: f32,
    along: f32,
) -> Option<[f32; CHANNELS]> {
    let ([a, b], [c, d]) = (nodes.first_chunk()?, nodes.last_chunk()?);
    Some(blended(blended(decode(*a), decode(*b), along), blended(decode(*c), decode(*d), along), across))
}

/// `fraction` of the way from `a` to `b`, exactly either at its ends.
#[inline(always)]
fn blended(a: [f32; CHANNELS], b: [f32; CHANNELS], fraction: f32) -> [f32; CHANNELS] {
    let rest = 1.0 - fraction;
    [rest * a[0] + fraction * b[0], rest * a[1] + fraction * b[1]]
}
