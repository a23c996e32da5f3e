//! A figure with its interval.

use serde::Serialize;

/// A figure with its interval of 95 %; an end may be infinite.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The figure.
    pub value: f64,
    /// The interval.
    pub interval: [f64; 2],
}

impl Estimate {
    /// With a rising `function` of it.
    pub(super) fn map(self, function: impl Fn(f64) -> f64) -> Self {
        Self { value: function(self.value), interval: self.interval.map(function) }
    }
}
