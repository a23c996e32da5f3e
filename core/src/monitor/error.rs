//! What making a monitor refuses.

use crate::{ParameterError, table::TableError};

/// Why there is no monitor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MonitorError {
    /// The table is not one over tolerance level and time.
    Table(TableError),
    /// The level or a limit is out of bounds.
    Parameter(ParameterError<f32>),
    /// The table has no unit of that level, see [`Lookup::mixed`](crate::table::Lookup::mixed).
    Mixed {
        /// The level.
        level: f32,
        /// Levels of the table on either side, of units of which one runs and the other jams, say.
        between: [f32; 2],
    },
}

impl core::fmt::Display for MonitorError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Table(error) => write!(f, "no table over tolerance level and time: {error}"),
            Self::Parameter(error) => error.fmt(f),
            Self::Mixed { level, between: [low, high] } => {
                write!(
                    f,
                    "monitor.level is {level}, the table has no unit between its levels {low} and {high}, which end differently"
                )
            }
        }
    }
}

impl core::error::Error for MonitorError {}

impl From<ParameterError<f32>> for MonitorError {
    fn from(error: ParameterError<f32>) -> Self {
        Self::Parameter(error)
    }
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use super::MonitorError;
    use crate::{error::bounded, table::TableError};

    #[test]
    fn errors_say_what_is_wrong() {
        let bounds = bounded("monitor.hold", 11.0f32, [0.0, 10.0]).unwrap_err();
        for (error, text) in [
            (MonitorError::Table(TableError::Magic), "no table over tolerance level and time: no table starts here"),
            (MonitorError::from(bounds), &*bounds.to_string()),
            (
                MonitorError::Mixed { level: 2.5, between: [2.0, 3.0] },
                "monitor.level is 2.5, the table has no unit between its levels 2 and 3, which end differently",
            ),
        ] {
            assert_eq!(error.to_string(), text);
        }
    }
}
