//! How a drive's controller samples.

use std::sync::Arc;

use slipfit_desk::drive::Held;

/// A controller that measures at equal intervals and holds its effort in between, as processors do.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampling {
    /// Time between two samples (s).
    pub period: f64,
    /// Gain (1/s) of the position loop around the speed loop; `None` if there is none.
    pub position_gain: Option<f64>,
    /// Whether its speed is the difference of two measured positions over the period.
    pub differentiates: bool,
    /// Commanded distances (m, rad) from the start, each held from the start of a piece of the command to that of the next.
    pub positions: Option<Arc<[f64]>>,
    /// What acts between two samples.
    pub held: Held,
}
