//! Drives whose feedback can turn positive.
//!
//! A pushing drive acts at its point, and may control the speed of the centre of mass instead of its own. On a body that turns about a pivot of the frame the
//! two move in the same sense only while both are on the same side of the pivot, seen along the drive's axis. Beyond, more force means
//! less measured speed, and the drive drives itself away from its command.

use nalgebra::{Rotation3, Unit, Vector3};

use super::{Action, Body, JointKind, Mechanism, NamedDrive};

/// A drive whose feedback turns positive.
#[derive(Clone, Debug, PartialEq)]
pub struct Reversal<'a> {
    /// Which drive.
    pub drive: &'a str,
    /// The body that it pushes.
    pub body: &'a str,
    /// The joint that the body turns about.
    pub pivot: &'a str,
    /// The least angle (rad) from the start, in either direction, by which the body turns until then; 0 where it begins so.
    pub angle: f64,
}

/// Angles (rad) within this of the start count as the start.
const START: f64 = 1e-9;

/// The drives of `mechanism` whose feedback turns positive within half a turn of the start.
pub fn reversals(mechanism: &Mechanism) -> Vec<Reversal<'_>> {
    mechanism.drives.iter().filter_map(|named| reversal(mechanism, named)).collect()
}

fn reversal<'a>(mechanism: &'a Mechanism, named: &'a NamedDrive) -> Option<Reversal<'a>> {
    let Action::Pushes { axis } = named.action else { return None };
    if !named.at_centre {
        return None;
    }
    let body = &mechanism.bodies[named.body];
    let mut pivots = mechanism.joints.iter().filter_map(|joint| match joint.kind {
        JointKind::Revolute { axis } => Some((joint, axis)),
        _ => None,
    });
    let of_body = [None, Some(named.body)];
    let (pivot, about) = pivots.find(|(joint, _)| of_body.iter().all(|port| joint.between.contains(port)))?;
    let lever = body.at_start(Vector3::from(body.centre) - Vector3::from(pivot.at), about);
    let point = lever + body.at_start(named.drive.point_b, about);
    let angle = angle([lever, point], Vector3::from(about), Vector3::from(axis))?;
    Some(Reversal { drive: &named.name, body: &body.name, pivot: &pivot.name, angle })
}

impl Body {
    /// A vector of the drawn body where the body starts, turned about an `axis`.
    fn at_start(&self, vector: Vector3<f64>, axis: [f64; 3]) -> Vector3<f64> {
        Rotation3::from_axis_angle(&Unit::new_normalize(Vector3::from(axis)), self.start.angle) * vector
    }
}

/// The least angle (rad) that turns the product of the lever arms of two points, from the pivot, negative; `None` if none does.
fn angle([centre, point]: [Vector3<f64>; 2], about: Vector3<f64>, push: Vector3<f64>) -> Option<f64> {
    // Turned by θ an arm is a·cos θ + b·sin θ: the speed along the push that a unit of angular velocity gives.
    let arm = |lever: Vector3<f64>| {
        let across = about.cross(&lever);
        [across.dot(&push), about.cross(&across).dot(&push)]
    };
    let [first, second] = [centre, point].map(arm);
    let size = |[a, b]: [f64; 2]| libm::hypot(a, b);
    let least = 1e-9 * size(first).max(size(second));
    if size(first) <= least || size(second) <= least {
        return None;
    }
    let product = |angle: f64| {
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        (first[0] * cos + first[1] * sin) * (second[0] * cos + second[1] * sin)
    };
    let negative = |angle: f64| product(angle) < -1e-12 * size(first) * size(second);
    if negative(0.0) {
        return Some(0.0);
    }
    // Each arm changes its sign twice a turn.
    let zeros = [first, second].into_iter().flat_map(|[a, b]| {
        let zero = libm::atan2(-a, b);
        [zero, zero - std::f64::consts::PI, zero + std::f64::consts::PI]
    });
    let beyond = |zero: f64| negative(zero + START.copysign(zero)) || negative(zero + 1e-3_f64.copysign(zero));
    zeros.filter(|zero| beyond(*zero)).map(f64::abs).reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::angle;

    /// The angle for a lever about z that is pushed along y.
    fn pushed(centre: [f64; 2], point: [f64; 2]) -> Option<f64> {
        angle([centre, point].map(|[x, y]| Vector3::new(x, y, 0.0)), Vector3::z(), Vector3::y())
    }

    #[test]
    fn a_drive_on_the_far_side_of_the_pivot_feeds_back_positively_from_the_start() {
        assert_eq!(pushed([0.1, 0.0], [-0.05, 0.0]), Some(0.0));
        assert_eq!(pushed([-0.1, 0.0], [0.05, 0.01]), Some(0.0));
    }

    #[test]
    fn on_one_line_from_the_pivot_it_never_does() {
        for point in [[0.2, 0.0], [0.05, 0.0], [0.1, 0.0]] {
            assert_eq!(pushed([0.1, 0.0], point), None);
        }
        assert_eq!(pushed([0.1, 0.05], [0.2, 0.1]), None);
        // Nor where the centre of mass does not move.
        assert_eq!(pushed([0.0, 0.0], [0.2, 0.1]), None);
    }

    #[test]
    fn aside_it_does_after_the_turn_that_brings_one_of_them_above_the_pivot() {
        // The centre of mass is on x; the point 30° above it is over the pivot after 60°.
        let point = [0.1 * libm::cos(0.5235987755982988), 0.05];
        let found = pushed([0.1, 0.0], point).unwrap();
        assert!((found - 1.0471975511965976).abs() < 1e-9, "{found}");
    }
}
