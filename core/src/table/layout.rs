//! Where everything lies in a table (bytes), for the reader, for whoever writes one, and for a C header made from it.

/// What a table starts with.
pub const MAGIC: [u8; 4] = *b"SLFT";
/// The format version this crate reads.
pub const VERSION: u16 = 3;

/// Offset of the magic.
pub const MAGIC_AT: usize = 0;
/// Offset of the format version, u16.
pub const VERSION_AT: usize = 4;
/// Offset of the number of axes, u8.
pub const AXIS_COUNT_AT: usize = 6;
/// Offset of how values are stored, u8, see [`Encoding`](super::Encoding).
pub const ENCODING_AT: usize = 7;
/// Offset of the scene hash, u64.
pub const SCENE_HASH_AT: usize = 8;
/// Offset of the length in bytes, u32.
pub const LENGTH_AT: usize = 16;

/// Offset of the first axis record.
pub const AXES_AT: usize = 20;
/// The least number of axes.
pub const AXES_LEAST: usize = 2;
/// The greatest number of axes; a table has room for as many records.
pub const AXES_MOST: usize = 3;
/// Size of an axis record.
pub const AXIS_SIZE: usize = 16;
/// In an axis record: what varies, u8, see [`AxisKind`](super::AxisKind).
pub const AXIS_KIND_AT: usize = 0;
/// In an axis record: the number of nodes, u32.
pub const AXIS_NODES_AT: usize = 4;
/// In an axis record: the first node, f32.
pub const AXIS_FIRST_AT: usize = 8;
/// In an axis record: the distance between nodes, f32.
pub const AXIS_STEP_AT: usize = 12;

/// Offset of the force's record; the velocity's follows.
pub const CHANNELS_AT: usize = AXES_AT + AXES_MOST * AXIS_SIZE;
/// Number of channels: force, then velocity.
pub const CHANNELS: usize = 2;
/// Size of a channel record.
pub const CHANNEL_SIZE: usize = 12;
/// In a channel record: what a stored value is multiplied with, f32.
pub const CHANNEL_SCALE_AT: usize = 0;
/// In a channel record: the worst interpolation error, f32.
pub const CHANNEL_WORST_AT: usize = 4;
/// In a channel record: the root mean square of the interpolation error in use, f32.
pub const CHANNEL_RMS_AT: usize = 8;

/// Size of the header, and offset of the data.
pub const HEADER_SIZE: usize = CHANNELS_AT + CHANNELS * CHANNEL_SIZE;
/// Size of the record of a production, before the checksum of a table of one.
pub const PRODUCTION_SIZE: usize = 4 * PRODUCTION_NUMBERS;
/// Numbers in that record, f32 each.
pub const PRODUCTION_NUMBERS: usize = 51;

/// Size of the checksum at the end.
pub const CHECKSUM_SIZE: usize = 4;

/// The greatest number of nodes of an axis: among so many, f32 tells where a point lies to about 1 % of a step.
pub const NODES_MOST: usize = 1 << 16;
/// The greatest magnitude of a value, so that no interpolation overflows.
pub const VALUE_MOST: f32 = 1e30;
/// The greatest magnitude of a stored i16, either sign.
pub const I16_MOST: i16 = i16::MAX;

/// The checksum, CRC-32/ISO-HDLC, of `bytes`.
pub fn checksum(bytes: &[u8]) -> u32 {
    !continued(EMPTY, bytes)
}

/// The checksum's register before the first byte; its complement after the last one is the checksum.
pub(super) const EMPTY: u32 = !0;

/// The checksum's register after `bytes`.
///
/// Four bits at a time: eight would take a table of 1 KB. One copy in the code serves opening and the cyclic check.
#[inline(never)]
pub(super) fn continued(register: u32, bytes: &[u8]) -> u32 {
    bytes.iter().fold(register, |register, byte| {
        let register = register ^ u32::from(*byte);
        let register = register >> 4 ^ NIBBLES[(register & 15) as usize];
        register >> 4 ^ NIBBLES[(register & 15) as usize]
    })
}

/// What four bits shifted out of the register do to it.
static NIBBLES: [u32; 16] = {
    let mut nibbles = [0; 16];
    let mut i = 0;
    while i < 16 {
        let mut register = i as u32;
        let mut bit = 0;
        while bit < 4 {
            register = register >> 1 ^ if register & 1 == 1 { 0xedb8_8320 } else { 0 };
            bit += 1;
        }
        nibbles[i] = register;
        i += 1;
    }
    nibbles
};
