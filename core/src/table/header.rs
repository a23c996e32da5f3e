//! The header of a table over any number of axes.

use heapless::Vec;

use super::{
    Axis, AxisKind, Encoding, TableError,
    layout::{
        AXES_AT, AXES_LEAST, AXES_MOST, AXIS_COUNT_AT, AXIS_FIRST_AT, AXIS_KIND_AT, AXIS_NODES_AT, AXIS_SIZE,
        AXIS_STEP_AT, CHANNEL_RMS_AT, CHANNEL_SCALE_AT, CHANNEL_SIZE, CHANNEL_WORST_AT, CHANNELS, CHANNELS_AT,
        CHECKSUM_SIZE, ENCODING_AT, HEADER_SIZE, I16_MOST, LENGTH_AT, MAGIC, MAGIC_AT, SCENE_HASH_AT, VALUE_MOST,
        VERSION, VERSION_AT, checksum,
    },
};

/// What a table says about itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Hash of the scene and laws the table was made for.
    pub scene_hash: u64,
    /// Length of the whole table (bytes).
    pub length: usize,
    /// The axes, slowest first.
    pub axes: Vec<Axis, AXES_MOST>,
    /// How values are stored.
    pub encoding: Encoding,
    /// Force and velocity.
    pub channels: [ChannelRecord; CHANNELS],
}

/// What a table says about a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ChannelRecord {
    /// What a stored value is multiplied with (N or m/s); 1 for [`Encoding::F32`].
    pub scale: f32,
    /// The worst interpolation error (N or m/s), measured when the table was made.
    pub worst_error: f32,
    /// The root mean square of the interpolation error (N or m/s) where the table is used: after the drive has started and,
    /// over position, where no slide stops short.
    pub rms_error: f32,
}

impl Header {
    /// The header of the table that `region` starts with. The checksum is checked, the data is not looked into.
    ///
    /// # Errors
    /// [`TableError`] says what is wrong.
    pub fn read(region: &[u8]) -> Result<Self, TableError> {
        if field(region, MAGIC_AT)? != MAGIC {
            return Err(TableError::Magic);
        }
        let found = u16::from_le_bytes(field(region, VERSION_AT)?);
        if found != VERSION {
            return Err(TableError::Version { found });
        }
        let length = u32::from_le_bytes(field(region, LENGTH_AT)?) as usize;
        let body = length.checked_sub(CHECKSUM_SIZE).filter(|body| *body >= HEADER_SIZE);
        let body = body.ok_or(TableError::Header("length"))?;
        let found = u32::from_le_bytes(field(region, body)?);
        if checksum(region.get(..body).ok_or(TableError::Truncated)?) != found {
            return Err(TableError::Checksum);
        }

        let [axis_count] = field(region, AXIS_COUNT_AT)?;
        let axis_count = usize::from(axis_count);
        if !(AXES_LEAST..=AXES_MOST).contains(&axis_count) {
            return Err(TableError::Header("number of axes"));
        }
        let [encoding] = field(region, ENCODING_AT)?;
        let encoding = Encoding::of(encoding).ok_or(TableError::Header("encoding"))?;
        let mut axes = Vec::new();
        for i in 0..AXES_MOST {
            let record: [u8; AXIS_SIZE] = field(region, AXES_AT + i * AXIS_SIZE)?;
            if i >= axis_count {
                zero(&record, "absent axis")?;
            } else if axes.push(axis(&record)?).is_err() {
                return Err(TableError::Header("number of axes"));
            }
        }
        let channels = [
            channel(encoding, &field(region, CHANNELS_AT)?)?,
            channel(encoding, &field(region, CHANNELS_AT + CHANNEL_SIZE)?)?,
        ];
        let scene_hash = u64::from_le_bytes(field(region, SCENE_HASH_AT)?);
        Ok(Self { scene_hash, length, axes, encoding, channels })
    }
}

fn field<const N: usize>(bytes: &[u8], at: usize) -> Result<[u8; N], TableError> {
    bytes.get(at..).and_then(<[u8]>::first_chunk).copied().ok_or(TableError::Truncated)
}

fn zero(bytes: &[u8], what: &'static str) -> Result<(), TableError> {
    if bytes.iter().all(|byte| *byte == 0) { Ok(()) } else { Err(TableError::Header(what)) }
}

fn axis(record: &[u8; AXIS_SIZE]) -> Result<Axis, TableError> {
    let [kind, reserved @ ..] = field::<4>(record, AXIS_KIND_AT)?;
    zero(&reserved, "reserved byte of an axis")?;
    Axis::new(
        AxisKind::of(kind).ok_or(TableError::Header("kind of axis"))?,
        f32::from_le_bytes(field(record, AXIS_FIRST_AT)?),
        f32::from_le_bytes(field(record, AXIS_STEP_AT)?),
        u32::from_le_bytes(field(record, AXIS_NODES_AT)?) as usize,
    )
}

fn channel(encoding: Encoding, record: &[u8; CHANNEL_SIZE]) -> Result<ChannelRecord, TableError> {
    let number = |at| field(record, at).map(f32::from_le_bytes);
    let (scale, worst_error, rms_error) =
        (number(CHANNEL_SCALE_AT)?, number(CHANNEL_WORST_AT)?, number(CHANNEL_RMS_AT)?);
    let scale_is_good = match encoding {
        Encoding::F32 => scale == 1.0,
        Encoding::I16 => scale > 0.0 && scale <= VALUE_MOST / f32::from(I16_MOST),
    };
    if !scale_is_good {
        return Err(TableError::Header("scale"));
    }
    if !(worst_error >= 0.0 && worst_error.is_finite()) {
        return Err(TableError::Header("worst error"));
    }
    if !(rms_error >= 0.0 && rms_error <= worst_error) {
        return Err(TableError::Header("mean error"));
    }
    Ok(ChannelRecord { scale, worst_error, rms_error })
}
