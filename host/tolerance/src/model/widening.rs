//! Zones that grow with a size: bonus tolerances, datum shift, and the play of holes on pins.

/// A zone whose width is linear in a size, another variable of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Widening {
    /// The first variable of the zone.
    pub zone: usize,
    /// The variable of the size, a scalar contributor.
    pub size: usize,
    /// By what part of their width at the middle of all limits place and tilts grow per unit of the size (1/m).
    pub growth: [f64; 2],
}

impl Widening {
    /// Widths of place and tilts over those in the middle, where the size is `away` (m) from the middle of its limits.
    pub fn grown(&self, away: f64) -> [f64; 2] {
        self.growth.map(|growth| (1.0 + growth * away).max(0.0))
    }
}
