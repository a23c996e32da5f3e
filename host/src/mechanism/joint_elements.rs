//! Which joint each element of a mechanism stands for.

use super::{Joint, Mechanism};

/// The joint that each element stands for, in the order of elements; none for those that are no joint's, which come last.
pub(super) fn joints_of_elements(mechanism: &Mechanism) -> impl Iterator<Item = Option<&Joint>> {
    let joints = mechanism.joints.iter().flat_map(|joint| std::iter::repeat_n(joint, elements_of(joint)));
    joints.map(Some).chain(std::iter::repeat(None))
}

/// How many elements there are of a joint.
fn elements_of(joint: &Joint) -> usize {
    use super::JointKind::{Bearing, Guide, Journal, Stop, Track};
    match joint.kind {
        Track { gaps } if !joint.walls.is_parallel() => gaps.iter().flatten().count(),
        Journal { .. } | Stop { .. } | Track { .. } => 1,
        Bearing { .. } => 2,
        Guide { .. } => 4,
        _ => 0,
    }
}
