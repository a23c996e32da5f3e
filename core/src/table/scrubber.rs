//! The cyclic check of a table in use: its checksum again and again, a bounded piece at a time.

use super::{
    Table, TableError,
    layout::{CHECKSUM_SIZE, EMPTY, continued},
};

/// Goes round a table for ever and finds what has changed since it was opened, in its checksum too.
///
/// ```
/// # use slipfit_core::table::{Scrubber, Table, TableError};
/// # fn idle(region: &[u8], table: &Table<'_>) -> Result<(), TableError> {
/// let mut scrubber = Scrubber::new(table);
/// while !scrubber.check(region, 64)? { /* whatever else there is to do */ }
/// # Ok(()) }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Scrubber {
    at: usize,
    /// Where the checksum lies.
    end: usize,
    /// As it was when the table was opened.
    checksum: u32,
    register: u32,
}

impl Scrubber {
    /// A scrubber that starts at the table's first byte.
    pub fn new<const N: usize>(table: &Table<'_, N>) -> Self {
        // An open table is longer than its checksum.
        let (body, checksum) = table.bytes.split_last_chunk().unwrap_or((&[], &[0; CHECKSUM_SIZE]));
        Self { at: 0, end: body.len(), checksum: u32::from_le_bytes(*checksum), register: EMPTY }
    }

    /// Looks at the next bytes, `most` at most but at least one, of the `region` that the table was opened from; true at
    /// the end of a round, after which the next call starts another.
    ///
    /// # Errors
    /// [`TableError::Checksum`] at the end of a round in which a byte differed; [`TableError::Truncated`] if `region`
    /// is too short.
    pub fn check(&mut self, region: &[u8], most: usize) -> Result<bool, TableError> {
        let next = self.at.saturating_add(most.max(1)).min(self.end);
        self.register = continued(self.register, region.get(self.at..next).ok_or(TableError::Truncated)?);
        self.at = next;
        if next < self.end {
            return Ok(false);
        }
        let stored = region.get(next..).and_then(<[u8]>::first_chunk).ok_or(TableError::Truncated)?;
        self.at = 0;
        let found = !core::mem::replace(&mut self.register, EMPTY);
        // The stored one too: by a checksum that has changed the next start would refuse the table.
        if [found, u32::from_le_bytes(*stored)] == [self.checksum; 2] { Ok(true) } else { Err(TableError::Checksum) }
    }
}

#[cfg(test)]
mod tests {
    use super::{Scrubber, Table, TableError};
    use crate::table::{AxisKind, example};

    #[test]
    fn goes_round_and_finds_every_flipped_bit() {
        let mut bytes = example::table(&[(AxisKind::Level, 2, 1.0), (AxisKind::Time, 3, 1.0)], |node| node as f32);
        let body = bytes.len() - super::CHECKSUM_SIZE;
        for most in [0, 1, 5, 64, 1000] {
            let mut scrubber = Scrubber::new(&Table::<2>::open(&bytes).unwrap());
            let calls = body.div_ceil(most.max(1));
            assert!((1..=3 * calls).all(|call| scrubber.check(&bytes, most) == Ok(call % calls == 0)));
            // Those of the checksum too.
            for bit in (0..bytes.len() * 8).step_by(if cfg!(miri) { 97 } else { 1 }) {
                bytes[bit / 8] ^= 1 << (bit % 8);
                assert!((1..calls).all(|_| scrubber.check(&bytes, most) == Ok(false)));
                assert_eq!(scrubber.check(&bytes, most), Err(TableError::Checksum), "{bit}");
                bytes[bit / 8] ^= 1 << (bit % 8);
            }
            assert_eq!(scrubber.check(&bytes[..0], most), Err(TableError::Truncated));
        }
    }
}
