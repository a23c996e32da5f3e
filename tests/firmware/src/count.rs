//! The least and the greatest of many counts.

use core::fmt;

/// Counts of a work that was done many times.
#[derive(Clone, Copy, Debug, Default)]
pub struct Count(Option<Range>);

/// From the least count to the greatest.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    least: u32,
    greatest: u32,
}

impl Count {
    /// Adds a `count`, if there is one.
    pub fn add(&mut self, count: Option<u32>) {
        if let Some(count) = count {
            let Range { least, greatest } = self.0.unwrap_or(Range { least: count, greatest: count });
            self.0 = Some(Range { least: least.min(count), greatest: greatest.max(count) });
        }
    }

    /// Their range, if anything was counted.
    pub fn range(&self) -> Option<Range> {
        self.0
    }
}

impl Range {
    /// The least and the greatest count.
    pub fn ends(self) -> (u32, u32) {
        (self.least, self.greatest)
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.least == self.greatest {
            write!(f, "{}, the same every time", self.least)
        } else {
            write!(f, "{} to {}", self.least, self.greatest)
        }
    }
}
