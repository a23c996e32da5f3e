//! The cyclic check of a table in use: its checksum again and again, a bounded piece at a time.

use super::{
    Table, TableError,
    layout::{CHECKSUM_SIZE, EMPTY, continued},
};

/// Goes round a table for ever and finds what has changed since it was opened.
///
/// ```
/// # use slipfit_core::table::{Patrol, Table, TableError};
/// # fn idle(region: &[u8], table: &Table<'_>) -> Result<(), TableError> {
/// let mut patrol = Patrol::new(table);
/// while !patrol.check(region, 64)? { /* whatever else there is to do */ }
/// # Ok(()) }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Patrol {
    at: usize,
    end: usize,
    checksum: u32,
    register: u32,
}

impl Patrol {
    /// A patrol that starts at the table's first byte.
    pub fn new<const N: usize>(table: &Table<'_, N>) -> Self {
        // An open table is longer than its checksum.
        let (body, checksum) = table.bytes.split_last_chunk().unwrap_or((&[], &[0; CHECKSUM_SIZE]));
        Self { at: 0, end: body.len(), checksum: u32::from_le_bytes(*checksum), register: EMPTY }
    }

    /// Looks at the next bytes, `most` at most, of the `region` that the table was opened from; true at the end of a
    /// round, after which the next call starts another.
    ///
    /// # Errors
    /// [`TableError::Checksum`] at the end of a round in which a byte differed; [`TableError::Truncated`] if `region`
    /// is too short.
    pub fn check(&mut self, region: &[u8], most: usize) -> Result<bool, TableError> {
        let next = self.at.saturating_add(most).min(self.end);
        self.register = continued(self.register, region.get(self.at..next).ok_or(TableError::Truncated)?);
        self.at = next;
        if next < self.end {
            return Ok(false);
        }
        self.at = 0;
        let found = !core::mem::replace(&mut self.register, EMPTY);
        if found == self.checksum { Ok(true) } else { Err(TableError::Checksum) }
    }
}
