//! What is known of a unit, as bytes for non-volatile memory.

use super::{Unit, drift::Drift};
use crate::table::layout::checksum;

/// Size of a saved unit (bytes): magic and version, hash of the scene, 23 numbers, checksum. Little-endian.
pub const SAVED_SIZE: usize = 8 + 8 + 4 * NUMBERS + 4;

const NUMBERS: usize = 23;

/// "SLFU", and the version of the format.
const MAGIC: [u8; 8] = [b'S', b'L', b'F', b'U', 1, 0, 0, 0];

/// Why bytes are no saved unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SavedError {
    /// They do not begin like a saved unit of this version.
    Magic,
    /// They are not those that were saved.
    Checksum,
    /// The unit was saved for another scene or other laws.
    Scene {
        /// The hash found.
        found: u64,
    },
}

impl core::fmt::Display for SavedError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Magic => f.write_str("no unit of this version was saved here"),
            Self::Checksum => f.write_str("the checksum does not match: the saved unit is damaged"),
            Self::Scene { found } => write!(f, "saved for another scene or other laws (hash {found:#018x})"),
        }
    }
}

impl core::error::Error for SavedError {}

impl Unit {
    /// This unit as bytes, for the scene that `hash` stands for.
    pub fn to_bytes(&self, hash: u64) -> [u8; SAVED_SIZE] {
        let Drift { reference, strokes, recent, count, trend } = self.drift;
        let counts = [self.strokes, strokes, count].into_iter();
        let sums = trend.weights.into_iter().chain(trend.squares).chain(trend.rises);
        let numbers = self.means.into_iter().chain([reference]).chain(recent).chain(sums).map(f32::to_bits);
        let words = MAGIC.into_iter().chain(hash.to_le_bytes()).chain(counts.chain(numbers).flat_map(u32::to_le_bytes));
        let mut bytes = [0; SAVED_SIZE];
        bytes.iter_mut().zip(words).for_each(|(byte, word)| *byte = word);
        if let Some((body, end)) = bytes.split_last_chunk_mut() {
            *end = checksum(body).to_le_bytes();
        }
        bytes
    }

    /// The unit that was saved as `bytes` for the scene that `hash` stands for. Any single flipped bit is refused.
    ///
    /// # Errors
    /// [`SavedError`] says what is wrong.
    pub fn from_bytes(bytes: &[u8; SAVED_SIZE], hash: u64) -> Result<Self, SavedError> {
        let (body, sum) = bytes.split_last_chunk().ok_or(SavedError::Checksum)?;
        let (magic, rest) = body.split_first_chunk().ok_or(SavedError::Magic)?;
        if *magic != MAGIC {
            return Err(SavedError::Magic);
        }
        if checksum(body) != u32::from_le_bytes(*sum) {
            return Err(SavedError::Checksum);
        }
        let (found, rest) = rest.split_first_chunk().ok_or(SavedError::Checksum)?;
        let found = u64::from_le_bytes(*found);
        if found != hash {
            return Err(SavedError::Scene { found });
        }
        let mut words = rest.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word));
        let mut next = || words.next().unwrap_or(0);
        let mut unit = Self { strokes: next(), ..Self::default() };
        unit.drift.strokes = next();
        unit.drift.count = next();
        let drift = &mut unit.drift;
        let trend = &mut drift.trend;
        let first = unit.means.iter_mut().chain([&mut drift.reference]).chain(&mut drift.recent);
        for number in first.chain(&mut trend.weights).chain(&mut trend.squares).chain(&mut trend.rises) {
            *number = f32::from_bits(next());
        }
        Ok(unit)
    }
}

/// All that is known of a unit is saved.
const _: () = assert!(size_of::<Unit>() == 4 * NUMBERS);

#[cfg(test)]
mod tests {
    use super::{SAVED_SIZE, SavedError, Unit};

    #[test]
    fn what_is_known_of_a_unit_is_saved_whole() {
        let mut unit = Unit { strokes: 7, means: core::array::from_fn(|k| 0.5 - k as f32), ..Unit::default() };
        unit.drift.reference = 2.5;
        unit.drift.strokes = 11;
        unit.drift.recent = [1.0, 2.0, 3.0];
        unit.drift.count = 2;
        unit.drift.trend.weights = [4.0, 5.0, 6.0];
        unit.drift.trend.squares = [7.0, 8.0, 9.0];
        unit.drift.trend.rises = [-1.0, -2.0];
        let saved = unit.to_bytes(7);
        // Little-endian everywhere.
        assert_eq!((&saved[..8], saved[8], saved[16], saved[20]), (&b"SLFU\x01\0\0\0"[..], 7, 7, 11));
        assert_eq!(Unit::from_bytes(&saved, 7), Ok(unit));
        assert_eq!(Unit::from_bytes(&saved, 8), Err(SavedError::Scene { found: 7 }));
        assert_eq!(Unit::from_bytes(&[0xff; SAVED_SIZE], 7), Err(SavedError::Magic));
        for bit in 0..SAVED_SIZE * 8 {
            let mut flipped = saved;
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert!(Unit::from_bytes(&flipped, 7).is_err(), "{bit}");
        }
    }
}
