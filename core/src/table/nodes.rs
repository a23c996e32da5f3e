//! The table's values: force and velocity of a node side by side, decoded where they lie.

use super::{
    ChannelRecord, Encoding, TableError,
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

/// Force (N) and velocity (m/s).
pub type Values = [f32; CHANNELS];

/// The values that a channel (N or m/s) has between its nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    low: f32,
    high: f32,
}

impl Range {
    /// From the least to the greatest value of nodes.
    ///
    /// Rounding may lead interpolation past its ends by some units in the last place of the greatest magnitude, 2⁻²⁴ of it each.
    fn of(low: f32, high: f32) -> Self {
        let greatest = if -low > high { -low } else { high };
        let slack = greatest * (1.0 / 1_048_576.0);
        Self { low: low - slack, high: high + slack }
    }

    /// `value`, or the end of the range that it is beyond; the lower one for NaN.
    #[inline(always)]
    pub fn held(&self, value: f32) -> f32 {
        let value = if value >= self.low { value } else { self.low };
        if value <= self.high { value } else { self.high }
    }

    /// The integers that are multiplied with `scale` within it: every one that a node has.
    fn of_integers(&self, scale: f32) -> [i32; 2] {
        // Half a unit, so that no rounding loses the ends.
        [libm::floorf(self.low / scale + 0.5) as i32, libm::ceilf(self.high / scale - 0.5) as i32]
    }

    /// Whether `value` is within it.
    #[inline(always)]
    pub fn contains(&self, value: f32) -> bool {
        (value >= self.low) & (value <= self.high)
    }
}

/// The ranges of all `nodes`, of which there is at least one.
fn ranges(nodes: impl Iterator<Item = Values>) -> [Range; CHANNELS] {
    let mut ends = [[f32::INFINITY, f32::NEG_INFINITY]; CHANNELS];
    for values in nodes {
        for ([low, high], value) in ends.iter_mut().zip(values) {
            *low = if value < *low { value } else { *low };
            *high = if value > *high { value } else { *high };
        }
    }
    ends.map(|[low, high]| Range::of(low, high))
}

/// Every node of a table where it lies, however it is stored.
pub trait Nodes: Copy {
    /// Force and velocity (N, m/s) at the `fractions` of the cell whose lowest node is `first`; `strides` says how far the
    /// next node is along each axis, the slowest first, or 0 where there is none. Along the last axis it is the node that
    /// follows, whatever it is: where there is none on the axis its fraction is 0. `None` outside the grid, where an open
    /// table never looks.
    fn within<const N: usize>(&self, first: usize, strides: &[usize; N], fractions: &[f32; N]) -> Option<Values>;

    /// Force and velocity (N, m/s) `fraction` of the way from the node `first` to the one that follows it.
    fn between(&self, first: usize, fraction: f32) -> Values;
}

/// Nodes of two f32.
#[derive(Clone, Copy, Debug)]
pub struct F32Nodes<'a>(&'a [[u8; 8]]);

/// Nodes of two i16.
#[derive(Clone, Copy, Debug)]
pub struct I16Nodes<'a> {
    nodes: &'a [[u8; 4]],
    /// What integers are multiplied with.
    scales: [f32; CHANNELS],
}

/// Nodes of either kind, known when the table is opened.
#[derive(Clone, Copy, Debug)]
pub enum AnyNodes<'a> {
    /// Two f32 each.
    F32(F32Nodes<'a>),
    /// Two i16 each.
    I16(I16Nodes<'a>),
}

impl<'a> AnyNodes<'a> {
    /// The nodes that `data` consists of and one more that is read but does not count, and the ranges of their values.
    ///
    /// # Errors
    /// If a value is out of bounds.
    pub(super) fn new(
        encoding: Encoding,
        records: &[ChannelRecord; CHANNELS],
        data: &'a [u8],
    ) -> Result<(Self, [Range; CHANNELS]), TableError> {
        let made = Self::unchecked(encoding, records, data);
        // The scale bounds integers.
        if let Self::F32(F32Nodes(nodes)) = made {
            for node in nodes {
                for (value, channel) in floats(node).into_iter().zip(ChannelKind::ALL) {
                    if value.is_nan() || value.abs() > VALUE_MOST {
                        return Err(TableError::Value(channel.name()));
                    }
                }
            }
        }
        let ranges = match &made {
            Self::F32(F32Nodes(nodes)) => ranges(counted(nodes).map(floats)),
            Self::I16(nodes) => ranges(counted(nodes.nodes).map(|node| nodes.scaled(integers(node)))),
        };
        Ok((made, ranges))
    }

    /// The nodes that `data` consists of, whatever their values.
    pub(super) fn unchecked(encoding: Encoding, records: &[ChannelRecord; CHANNELS], data: &'a [u8]) -> Self {
        match encoding {
            Encoding::F32 => Self::F32(F32Nodes(data.as_chunks().0)),
            Encoding::I16 => {
                Self::I16(I16Nodes { nodes: data.as_chunks().0, scales: records.map(|record| record.scale) })
            }
        }
    }
}

/// All `nodes` but the last one, which weighs nothing.
fn counted<T>(nodes: &[T]) -> impl Iterator<Item = &T> {
    nodes.split_last().map_or(nodes, |(_, counted)| counted).iter()
}

impl Nodes for AnyNodes<'_> {
    #[inline(always)]
    fn within<const N: usize>(&self, first: usize, strides: &[usize; N], fractions: &[f32; N]) -> Option<Values> {
        match self {
            Self::F32(nodes) => nodes.within(first, strides, fractions),
            Self::I16(nodes) => nodes.within(first, strides, fractions),
        }
    }

    // Called for every level of a bank: one copy of either way will do.
    #[inline(never)]
    fn between(&self, first: usize, fraction: f32) -> Values {
        match self {
            Self::F32(nodes) => nodes.between(first, fraction),
            Self::I16(nodes) => nodes.between(first, fraction),
        }
    }
}

impl Nodes for F32Nodes<'_> {
    #[inline(always)]
    fn within<const N: usize>(&self, first: usize, strides: &[usize; N], fractions: &[f32; N]) -> Option<Values> {
        cell(self.0, first, strides, fractions, Self::blend)
    }

    #[inline(always)]
    fn between(&self, first: usize, fraction: f32) -> Values {
        pair(self.0, first).map(|pair| Self::blend(pair, fraction)).unwrap_or_default()
    }
}

impl F32Nodes<'_> {
    #[inline(always)]
    fn blend([a, b]: &[[u8; 8]; 2], fraction: f32) -> Values {
        blended(floats(a), floats(b), fraction)
    }
}

impl Nodes for I16Nodes<'_> {
    #[inline(always)]
    fn within<const N: usize>(&self, first: usize, strides: &[usize; N], fractions: &[f32; N]) -> Option<Values> {
        cell(self.nodes, first, strides, fractions, Self::blend).map(|found| self.scaled(found))
    }

    #[inline(always)]
    fn between(&self, first: usize, fraction: f32) -> Values {
        self.scaled(pair(self.nodes, first).map(|pair| Self::blend(pair, fraction)).unwrap_or_default())
    }
}

impl<'a> I16Nodes<'a> {
    /// The nodes, what integers are multiplied with, and the integers of the `ranges`.
    pub(super) fn parts(&self, ranges: &[Range; CHANNELS]) -> (&'a [[u8; 4]], [f32; CHANNELS], [[i32; 2]; CHANNELS]) {
        let mut ends = [[0; 2]; CHANNELS];
        for ((ends, range), scale) in ends.iter_mut().zip(ranges).zip(self.scales) {
            *ends = range.of_integers(scale);
        }
        (self.nodes, self.scales, ends)
    }

    /// The integer of a node's force, `channel` 0, or velocity.
    #[inline(always)]
    pub(super) fn integer(node: &[u8; 4], channel: usize) -> i32 {
        let [a, b, c, d] = *node;
        i16::from_le_bytes(if channel == 0 { [a, b] } else { [c, d] }).into()
    }
}

impl I16Nodes<'_> {
    #[inline(always)]
    fn blend([a, b]: &[[u8; 4]; 2], fraction: f32) -> Values {
        blended(integers(a), integers(b), fraction)
    }

    #[inline(always)]
    fn scaled(&self, [force, velocity]: Values) -> Values {
        [self.scales[0] * force, self.scales[1] * velocity]
    }
}

#[inline(always)]
fn pair<T>(nodes: &[T], first: usize) -> Option<&[T; 2]> {
    nodes.get(first..)?.first_chunk()
}

/// What [`Nodes::within`] gives, with `blend` between two neighbours along the last axis.
///
/// Every node is there, since the grid's size was checked; but the compiler does not know and would add a panic.
#[inline(always)]
fn cell<T: Copy>(
    nodes: &[T],
    first: usize,
    strides: &[usize],
    fractions: &[f32],
    blend: impl Fn(&[T; 2], f32) -> Values,
) -> Option<Values> {
    let face = |first: usize, row: usize, across, along| {
        let rest = nodes.get(first..)?;
        let upper = rest.get(row..)?.first_chunk()?;
        Some(blended(blend(rest.first_chunk()?, along), blend(upper, along), across))
    };
    match (strides, fractions) {
        ([row, _], [across, along]) => face(first, *row, *across, *along),
        ([layer, row, _], [up, across, along]) => {
            let lower = face(first, *row, *across, *along);
            let upper = face(first.wrapping_add(*layer), *row, *across, *along);
            lower.zip(upper).map(|(lower, upper)| blended(lower, upper, *up))
        }
        _ => None,
    }
}

#[inline(always)]
fn floats(&[a, b, c, d, e, f, g, h]: &[u8; 8]) -> Values {
    [f32::from_le_bytes([a, b, c, d]), f32::from_le_bytes([e, f, g, h])]
}

#[inline(always)]
fn integers(&[a, b, c, d]: &[u8; 4]) -> Values {
    [f32::from(i16::from_le_bytes([a, b])), f32::from(i16::from_le_bytes([c, d]))]
}

/// `fraction` of the way from `a` to `b`.
#[inline(always)]
fn blended(a: Values, b: Values, fraction: f32) -> Values {
    [a[0] + fraction * (b[0] - a[0]), a[1] + fraction * (b[1] - a[1])]
}
