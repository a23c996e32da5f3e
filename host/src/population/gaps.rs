//! The gaps of one unit, as many as what it is a unit of has.

use slipfit_core::slide::{ABSENT, CONTACTS};

/// The gaps (m) of one unit: as many as a slide's pins have, or as many as a mechanism has.
pub trait UnitGaps: Clone + Send + Sync + AsRef<[f64]> + AsMut<[f64]> {
    /// `count` that are [`ABSENT`].
    fn absent(count: usize) -> Self;
}

impl UnitGaps for [f64; CONTACTS] {
    fn absent(_: usize) -> Self {
        [ABSENT; CONTACTS]
    }
}

impl UnitGaps for Vec<f64> {
    fn absent(count: usize) -> Self {
        vec![ABSENT; count]
    }
}
