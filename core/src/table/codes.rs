//! What a table stores as a code in its header: what varies along an axis, and how values are stored.

/// What varies along an axis; the discriminant is what a table stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum AxisKind {
    /// Tolerance level n.
    Level = 1,
    /// Time t (s).
    Time = 2,
    /// Position z (m).
    Position = 3,
    /// Commanded speed (m/s): the one that the drive's ramp leads to, not the slide's own.
    Velocity = 4,
    /// Rows of a production, see [`production`](crate::production): what varies is the number of the row.
    Row = 5,
}

impl AxisKind {
    /// All kinds.
    pub const ALL: [Self; 5] = [Self::Level, Self::Time, Self::Position, Self::Velocity, Self::Row];

    /// The kind stored as `code`.
    pub fn of(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| *kind as u8 == code)
    }

    /// The quantity's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Level => "level",
            Self::Time => "time",
            Self::Position => "position",
            Self::Velocity => "speed",
            Self::Row => "row",
        }
    }

    /// The quantity's unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Level | Self::Row => "1",
            Self::Time => "s",
            Self::Position => "m",
            Self::Velocity => "m/s",
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
