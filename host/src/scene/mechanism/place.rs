//! Places and directions, in a plane or in space.

use slipfit_tolerance::unit::{self, Quantity};

use crate::scene::{SceneError, value::Field};

/// How long an axis or a normal at least is, in its own numbers.
const LEAST_AXIS: f64 = 1e-9;

/// Reads a place or a direction: two numbers in a plane, else three.
pub(super) fn place(field: &Field, planar: bool, quantity: &Quantity) -> Result<[f64; 3], SceneError> {
    if planar { field.to_numbers::<2>(quantity).map(|[x, y]| [x, y, 0.0]) } else { field.to_numbers(quantity) }
}

/// Reads a direction, to unit length.
pub(super) fn direction(table: &Field, key: &str, planar: bool) -> Result<[f64; 3], SceneError> {
    const NUMBER: Quantity = Quantity { units: unit::ONE, range: [-1e6, 1e6] };
    let field = table.require(key, if planar { "a direction [x, y]" } else { "a direction [x, y, z]" })?;
    let axis = place(&field, planar, &NUMBER)?;
    let length = libm::sqrt(axis.iter().map(|x| x * x).sum());
    if length < LEAST_AXIS {
        return Err(field.out_of_range("", "a direction other than zero"));
    }
    // What is given along an axis stays exactly so.
    Ok(if axis.iter().filter(|x| **x != 0.0).count() == 1 {
        axis.map(f64::signum_or_zero)
    } else {
        axis.map(|x| x / length)
    })
}

/// The sign of a number, 0 for 0.
trait SignumOrZero {
    fn signum_or_zero(self) -> f64;
}

impl SignumOrZero for f64 {
    fn signum_or_zero(self) -> f64 {
        if self == 0.0 { 0.0 } else { self.signum() }
    }
}
