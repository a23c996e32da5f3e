//! Degrees of freedom of a mechanism with clearance joints (eqs. 5–8; eq. 6 repeats eq. 5).

use nalgebra::{Matrix6, Vector3, Vector6};

use crate::setup::{PinSpec, Scene};

/// n = 6(N − 1) − Σ i·c_i − n_cl: the degrees of freedom of `parts` N parts with ideal joints that remove
/// `removed[k]` degrees of freedom each, and clearance joints that remove `by_clearance` n_cl together.
///
/// Negative for an over-constrained mechanism.
pub fn degrees_of_freedom(parts: u32, removed: &[u32], by_clearance: u32) -> i64 {
    let removed: i64 = removed.iter().map(|&i| i64::from(i)).sum();
    6 * (i64::from(parts) - 1) - removed - i64::from(by_clearance)
}

/// Degrees of freedom removed by clearance joints: the rank of the wrenches of the contact normals, about the centre
/// of mass, lengths scaled by the farthest contact.
pub fn rank_of_normals(contacts: &[(Vector3<f64>, Vector3<f64>)]) -> u32 {
    let length = contacts.iter().map(|(point, _)| point.norm()).fold(0.0, f64::max);
    let length = if length > 0.0 { length } else { 1.0 };
    let gram = contacts.iter().fold(Matrix6::zeros(), |gram, (point, normal)| {
        let moment = point.cross(normal) / length;
        let wrench = Vector6::new(normal.x, normal.y, normal.z, moment.x, moment.y, moment.z);
        gram + wrench * wrench.transpose()
    });
    gram.rank(1e-9) as u32
}

/// Outward normals of the walls around a pin, in the order of [`SURFACES`](crate::setup::SURFACES): left, right, rail and wall.
pub const SURFACE_NORMALS: [[f64; 3]; 4] = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 1.0, 0.0]];

/// The scene's contacts at the nominal pose: point (m, from the centre of mass) and outward normal of the slide.
pub fn contacts(scene: &Scene) -> Vec<(Vector3<f64>, Vector3<f64>)> {
    let of_pin = |pin: &'_ PinSpec| {
        pin.gaps.into_iter().zip(SURFACE_NORMALS).map(|(gap, n)| (pin.position, gap, n)).collect::<Vec<_>>()
    };
    let pins = scene.pins.iter().flat_map(of_pin);
    pins.filter_map(|(point, gap, normal)| gap.map(|_| (Vector3::from(point), normal.into()))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rank(pins: &[[f64; 3]], normals: &[usize]) -> u32 {
        let contacts: Vec<_> = pins
            .iter()
            .flat_map(|&pin| normals.iter().map(move |&k| (Vector3::from(pin), Vector3::from(SURFACE_NORMALS[k]))))
            .collect();
        rank_of_normals(&contacts)
    }

    #[test]
    fn mechanisms_of_known_mobility() {
        let corners = [[-0.062, 0.0, -0.018], [0.062, 0.0, -0.018], [-0.062, 0.0, 0.018], [0.062, 0.0, 0.018]];
        // The CD-ROM slide keeps its travel only.
        assert_eq!(rank(&corners, &[0, 1, 2, 3]), 5);
        assert_eq!(degrees_of_freedom(2, &[], 5), 1);
        // A body on a table: three contacts or four, up only.
        assert_eq!(rank(&corners[..3], &[2]), 3);
        assert_eq!(rank(&corners, &[2]), 3);
        // A slot with one pin, with two pins, with two pins one above the other.
        assert_eq!(rank(&corners[..1], &[0, 1]), 1);
        assert_eq!(rank(&[[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]], &[0, 1]), 2);
        assert_eq!(rank(&[[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]], &[0, 1, 2, 3]), 3);
        // One pin in a square hole.
        assert_eq!(rank(&[[0.0, 0.0, 0.0]], &[0, 1, 2, 3]), 2);
        assert_eq!(rank(&[], &[]), 0);
        // Ideal joints: a planar four-bar's revolute joints in space over-constrain it, a free body keeps six.
        assert_eq!(degrees_of_freedom(4, &[5, 5, 5, 5], 0), -2);
        assert_eq!(degrees_of_freedom(2, &[], 0), 6);
        // A slider-crank with two revolute joints, one spherical and one prismatic joint, one part held by clearance.
        assert_eq!(degrees_of_freedom(4, &[5, 5, 3], 4), 1);
    }
}
