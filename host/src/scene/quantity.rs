//! Quantities of what moves that several readers share.

use slipfit_tolerance::unit::{self, Quantity};

pub(super) const MASS: Quantity = Quantity { units: unit::MASS, range: [0.001, 1e7] };
pub(super) const COEFFICIENT: Quantity = Quantity { units: unit::ONE, range: [0.0, 100.0] };
pub(super) const STICK_BAND: Quantity = Quantity { units: unit::SPEED, range: [1e-7, 1000.0] };
pub(super) const GAIN: Quantity = Quantity { units: unit::DAMPING, range: [0.0, 1e6] };
pub(super) const RAMP: Quantity = Quantity { units: unit::SECONDS, range: [-1000.0, 1000.0] };
pub(super) const SPEED: Quantity = Quantity { units: unit::SPEED, range: [-1e6, 1e6] };
pub(super) const POINT: Quantity = Quantity { units: unit::LENGTH, range: [-1e5, 1e5] };
/// A rotation of gravity.
pub(super) const TILT: Quantity = Quantity { units: unit::ANGLE, range: [-180.0, 180.0] };

/// s: what the slide's kernel takes.
pub(super) const LEAST_RAMP: f64 = 1e-6;
