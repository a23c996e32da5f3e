//! What opening a table refuses.

use super::{AxisKind, layout::VERSION};

/// Why bytes are not the table asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum TableError {
    /// The region ends before the table does.
    Truncated,
    /// The region does not start with a table.
    Magic,
    /// Another version of the format.
    Version {
        /// The version found.
        found: u16,
    },
    /// The bytes are not those that were written.
    Checksum,
    /// The named field of the header is out of bounds or contradicts another one.
    Header(&'static str),
    /// The data of the named channel holds a value that is not finite or exceeds the format's limit, or the verdicts one that
    /// there is not.
    Value(&'static str),
    /// A table over another number of axes.
    Axes {
        /// The number found.
        found: usize,
    },
    /// A table over other quantities.
    Kind {
        /// Which axis, from 0 on.
        axis: usize,
        /// What it is over.
        found: AxisKind,
        /// What is asked for.
        asked: AxisKind,
    },
    /// A table for another scene or other laws.
    Scene {
        /// The hash found.
        found: u64,
    },
    /// A slot that has no room for the record behind its table, or does not end between programming words.
    Slot {
        /// Its length (bytes).
        length: usize,
        /// The least length for this table.
        least: usize,
    },
    /// A slot that cannot be read.
    Unreadable,
}

impl core::fmt::Display for TableError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Truncated => f.write_str("the region ends before the table does"),
            Self::Magic => f.write_str("no table starts here"),
            Self::Version { found } => write!(f, "format version {found}, this reader knows {VERSION}"),
            Self::Checksum => f.write_str("the checksum does not match: the table is damaged"),
            Self::Header(field) => write!(f, "bad {field}"),
            Self::Value(channel) => write!(f, "a value of the {channel} is out of bounds"),
            Self::Axes { found } => write!(f, "a table over {found} axes, another number is asked for"),
            Self::Kind { axis, found, asked } => {
                write!(f, "axis {axis} is over {}, asked for is {}", found.name(), asked.name())
            }
            Self::Slot { length, least } => {
                write!(f, "a slot of {length} bytes, table and record take {least}, in whole programming words")
            }
            Self::Unreadable => f.write_str("the slot cannot be read"),
            Self::Scene { found } => write!(f, "made for another scene or other laws (hash {found:#018x})"),
        }
    }
}

impl core::error::Error for TableError {}
