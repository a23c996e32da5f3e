//! The flash table's builder: bytes from grids, in the layout that [`slipfit_core::table`] describes and reads.

pub mod export;
#[cfg(test)]
mod tests;

use slipfit_core::{
    production::Record,
    table::{
        Axis, AxisKind, ChannelKind, Encoding, MotionVerdict, TableError,
        layout::{
            AXES_AT, AXES_LEAST, AXES_MOST, AXIS_COUNT_AT, AXIS_FIRST_AT, AXIS_KIND_AT, AXIS_NODES_AT, AXIS_SIZE,
            AXIS_STEP_AT, CHANNEL_RMS_AT, CHANNEL_SCALE_AT, CHANNEL_SIZE, CHANNEL_WORST_AT, CHANNELS, CHANNELS_AT,
            CHECKSUM_SIZE, ENCODING_AT, HEADER_SIZE, I16_MOST, LENGTH_AT, MAGIC, MAGIC_AT, PRODUCTION_SIZE,
            SCENE_HASH_AT, VALUE_MOST, VERSION, VERSION_AT, checksum,
        },
        motions, verdict_bytes,
    },
};

/// Size of the TABLE region of `memory.x` (bytes): the longest table there can be.
pub const TABLE_REGION: usize = 256 * 1024;

/// Where the TABLE region of `memory.x` starts.
pub const TABLE_ADDRESS: u32 = 0x0008_0000;

/// What a table is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct TableSpec {
    /// What [`scene_hash`](crate::setup::scene_hash) gives.
    pub scene_hash: u64,
    /// Two or three axes, slowest first.
    pub axes: Vec<AxisSpec>,
    /// How values are to be stored. I16 keeps a channel to within half a 32,767th of its greatest value.
    pub encoding: Encoding,
    /// Force (N).
    pub force: ChannelSpec,
    /// Velocity (m/s).
    pub velocity: ChannelSpec,
    /// The verdict on every motion: one for each node of all axes but the second, the last fastest.
    pub verdicts: Vec<MotionVerdict>,
    /// How a production was calibrated, if its rows are the first axis.
    pub production: Option<Record>,
}

/// An axis of equidistant nodes, in the unit of its kind. [`Axis::node`] says where f32 puts them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisSpec {
    /// What varies.
    pub kind: AxisKind,
    /// The first node.
    pub first: f32,
    /// The distance between nodes.
    pub step: f32,
    /// The number of nodes, at least 2.
    pub count: usize,
}

/// A quantity at every node of the grid.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelSpec {
    /// Values (N or m/s), the last axis fastest.
    pub values: Vec<f32>,
    /// The worst interpolation error (N or m/s), 0 while it is not measured yet: the table has to be opened for that.
    pub worst_error: f32,
    /// The root mean square of that error after the drive has started, likewise.
    pub rms_error: f32,
}

/// Why there is no table.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FlashError {
    /// Too few or too many axes.
    #[error("a table has {AXES_LEAST} or {AXES_MOST} axes, not {found}")]
    Axes {
        /// How many there are.
        found: usize,
    },
    /// An axis with a single node, or none.
    #[error("an axis needs at least 2 levels, the {axis:?} axis has {count}")]
    TooFewLevels {
        /// Which axis.
        axis: AxisKind,
        /// How many it has.
        count: usize,
    },
    /// An axis that the format cannot hold.
    #[error("the {axis:?} axis: {source}")]
    Axis {
        /// Which axis.
        axis: AxisKind,
        /// What is wrong with it.
        source: TableError,
    },
    /// Not one value a node.
    #[error("{} has {found} values for {expected} nodes", channel.name())]
    Size {
        /// Which channel.
        channel: ChannelKind,
        /// How many values it has.
        found: usize,
        /// How many nodes the grid has.
        expected: usize,
    },
    /// Not one verdict a motion.
    #[error("{found} verdicts for {expected} motions")]
    Verdicts {
        /// How many verdicts there are.
        found: usize,
        /// How many motions the grid has.
        expected: usize,
    },
    /// A value that is not finite, or too great.
    #[error("{} at node {index} is {value}, allowed is -{VALUE_MOST:e} to {VALUE_MOST:e}", channel.name())]
    Value {
        /// Which channel.
        channel: ChannelKind,
        /// Which of its values.
        index: usize,
        /// The value (N or m/s).
        value: f32,
    },
    /// A production whose first axis is no rows, or rows without one.
    #[error("a record of a production goes with an axis of rows, and the other way round")]
    Production,
    /// A record of a production that is out of bounds.
    #[error("{0}")]
    Record(TableError),
    /// An interpolation error that is negative or not finite, or a mean above the worst.
    #[error("the interpolation error of {} is {worst} at worst and {rms} in the mean", channel.name())]
    InterpolationError {
        /// Which channel.
        channel: ChannelKind,
        /// The worst error (N or m/s).
        worst: f32,
        /// Its root mean square (N or m/s).
        rms: f32,
    },
    /// It does not fit.
    #[error(
        "the table takes {bytes} bytes, the TABLE region has {region}: take fewer levels, or --max-error of `slipfit table`"
    )]
    TooLarge {
        /// Length of the table.
        bytes: usize,
        /// Length of the region, [`TABLE_REGION`].
        region: usize,
    },
}

/// Length of a table (bytes) over axes of so many nodes: header, nodes and the one behind them, verdicts, checksum.
pub fn length(counts: impl IntoIterator<Item = usize> + Clone, encoding: Encoding) -> usize {
    let nodes = counts.clone().into_iter().fold(1, usize::saturating_mul).saturating_add(1);
    let verdicts = motions(counts).and_then(|motions| motions.checked_next_multiple_of(4)).unwrap_or(usize::MAX);
    let data = nodes.saturating_mul(CHANNELS * encoding.size()).saturating_add(verdicts);
    data.saturating_add(HEADER_SIZE + CHECKSUM_SIZE)
}

/// The table's bytes.
///
/// # Errors
/// [`FlashError`] says what the format or the target cannot hold.
pub fn encode(spec: &TableSpec) -> Result<Vec<u8>, FlashError> {
    let found = spec.axes.len();
    if !(AXES_LEAST..=AXES_MOST).contains(&found) {
        return Err(FlashError::Axes { found });
    }
    for &AxisSpec { kind: axis, first, step, count } in &spec.axes {
        if count < 2 {
            return Err(FlashError::TooFewLevels { axis, count });
        }
        Axis::new(axis, first, step, count).map_err(|source| FlashError::Axis { axis, source })?;
    }
    let nodes = spec.axes.iter().fold(1usize, |nodes, axis| nodes.saturating_mul(axis.count));

    let mut bytes = vec![0; HEADER_SIZE];
    put(&mut bytes, MAGIC_AT, &MAGIC);
    put(&mut bytes, VERSION_AT, &VERSION.to_le_bytes());
    put(&mut bytes, AXIS_COUNT_AT, &[found as u8]);
    put(&mut bytes, ENCODING_AT, &[spec.encoding as u8]);
    put(&mut bytes, SCENE_HASH_AT, &spec.scene_hash.to_le_bytes());
    for (i, axis) in spec.axes.iter().enumerate() {
        let at = AXES_AT + i * AXIS_SIZE;
        put(&mut bytes, at + AXIS_KIND_AT, &[axis.kind as u8]);
        put(&mut bytes, at + AXIS_NODES_AT, &(axis.count as u32).to_le_bytes());
        put(&mut bytes, at + AXIS_FIRST_AT, &axis.first.to_le_bytes());
        put(&mut bytes, at + AXIS_STEP_AT, &axis.step.to_le_bytes());
    }
    let channels = [&spec.force, &spec.velocity];
    for (i, (kind, channel)) in ChannelKind::ALL.into_iter().zip(channels).enumerate() {
        channel.check(kind, nodes)?;
        let at = CHANNELS_AT + i * CHANNEL_SIZE;
        put(&mut bytes, at + CHANNEL_SCALE_AT, &channel.scale(spec.encoding).to_le_bytes());
        put(&mut bytes, at + CHANNEL_WORST_AT, &channel.worst_error.to_le_bytes());
        put(&mut bytes, at + CHANNEL_RMS_AT, &channel.rms_error.to_le_bytes());
    }
    let expected = motions(spec.axes.iter().map(|axis| axis.count)).unwrap_or(usize::MAX);
    if spec.verdicts.len() != expected {
        return Err(FlashError::Verdicts { found: spec.verdicts.len(), expected });
    }
    let is_of_rows = spec.axes.first().is_some_and(|axis| axis.kind == AxisKind::Row);
    if is_of_rows != spec.production.is_some() {
        return Err(FlashError::Production);
    }
    let record = spec.production.map(Record::checked).transpose().map_err(FlashError::Record)?;
    let record_size = record.map_or(0, |_| PRODUCTION_SIZE);
    let length = length(spec.axes.iter().map(|axis| axis.count), spec.encoding) + record_size;
    if length > TABLE_REGION {
        return Err(FlashError::TooLarge { bytes: length, region: TABLE_REGION });
    }
    put(&mut bytes, LENGTH_AT, &(length as u32).to_le_bytes());
    let scales = channels.map(|channel| f64::from(channel.scale(spec.encoding)));
    for (force, velocity) in spec.force.values.iter().zip(&spec.velocity.values) {
        for (value, scale) in [force, velocity].into_iter().zip(scales) {
            match spec.encoding {
                Encoding::F32 => bytes.extend(value.to_le_bytes()),
                // The scale is rounded, by so little that no value leaves the integers: `as` saturates beyond.
                Encoding::I16 => bytes.extend(((f64::from(*value) / scale).round() as i16).to_le_bytes()),
            }
        }
    }
    bytes.resize(bytes.len() + CHANNELS * spec.encoding.size(), 0);
    bytes.extend(verdict_bytes(&spec.verdicts, spec.axes.get(2).map_or(1, |axis| axis.count)));
    bytes.resize(length - CHECKSUM_SIZE - record_size, 0);
    bytes.extend(record.iter().flat_map(Record::numbers).flat_map(f32::to_le_bytes));
    let sum = checksum(&bytes);
    bytes.extend(sum.to_le_bytes());
    Ok(bytes)
}

fn put(bytes: &mut [u8], at: usize, field: &[u8]) {
    bytes[at..at + field.len()].copy_from_slice(field);
}

impl ChannelSpec {
    fn check(&self, channel: ChannelKind, expected: usize) -> Result<(), FlashError> {
        let (found, worst, rms) = (self.values.len(), self.worst_error, self.rms_error);
        if found != expected {
            return Err(FlashError::Size { channel, found, expected });
        }
        if let Some((index, &value)) = self.values.iter().enumerate().find(|(_, v)| v.is_nan() || v.abs() > VALUE_MOST)
        {
            return Err(FlashError::Value { channel, index, value });
        }
        if worst.is_finite() && rms >= 0.0 && rms <= worst {
            Ok(())
        } else {
            Err(FlashError::InterpolationError { channel, worst, rms })
        }
    }

    /// What stored values are multiplied with: for i16 such that the greatest value takes the greatest integer.
    fn scale(&self, encoding: Encoding) -> f32 {
        let greatest = self.values.iter().fold(0.0, |greatest: f32, value| greatest.max(value.abs()));
        match encoding {
            Encoding::F32 => 1.0,
            Encoding::I16 if greatest == 0.0 => 1.0,
            // A subnormal scale would keep too few digits.
            Encoding::I16 => (greatest / f32::from(I16_MOST)).max(f32::MIN_POSITIVE),
        }
    }
}
