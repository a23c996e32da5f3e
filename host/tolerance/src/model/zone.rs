//! How features vary in a zone by the rules for it, and how far the zone reaches along slopes.

/// How a plane or an axis varies in its zone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZoneRule {
    /// u, p, r independent normals of standard deviation 1/(3√3): a corner of the face has t/6. In a disc x, y independent
    /// normals of standard deviation 1/3: the axis has t/6 along any direction.
    SigmaZone,
    /// The same, drawn again until inside the zone.
    Truncated,
    /// Uniform in the octahedron or the disc.
    UniformInZone,
    /// Offset only: u normal of standard deviation 1/3; a disc as by [`ZoneRule::SigmaZone`].
    Translation,
}

/// Standard deviation 1/(3√3) of u, p and r in a sigma-zone: a corner of the face has a sixth of the zone.
pub const SIGMA_ZONE: f64 = 0.192_450_089_729_875_26;
/// Standard deviation of x and y in a disc: a sixth of the zone's diameter.
pub const SIGMA_DISC: f64 = 1.0 / 3.0;

/// The vector of length 1 along `slopes`; 0 for none.
pub(super) fn along(slopes: &[f64]) -> Vec<f64> {
    let length = libm::sqrt(slopes.iter().map(|slope| slope * slope).sum());
    slopes.iter().map(|slope| if length > 0.0 { slope / length } else { 0.0 }).collect()
}

/// The unit vector of the greatest of the `slopes`, with its sign; 0 for none.
pub(super) fn steepest(slopes: &[f64]) -> Vec<f64> {
    let most = slopes.iter().fold(0.0, |most: f64, slope| most.max(slope.abs()));
    let first = slopes.iter().position(|slope| slope.abs() == most && most > 0.0);
    let of = |(k, slope): (usize, &f64)| if Some(k) == first { 1f64.copysign(*slope) } else { 0.0 };
    slopes.iter().enumerate().map(of).collect()
}
