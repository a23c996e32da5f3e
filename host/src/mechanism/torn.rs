//! Whether the start of a mechanism tears a joint open.

use slipfit_core::{
    SVector,
    system::{Bodies, Reduced, spatial::tree::Mount},
};

use super::{
    Joint, JointKind, Mechanism, Mounts, Rest, RunError, joint_elements::joints_of_elements, planar, spatial,
    start::thrown, state::half_angle,
};

/// How far (m) a joint may be pressed together at the start beyond its play. Contacts give way by less, and angles are rounded; what a
/// start tears open overlaps by millimetres.
const PRESSED: f64 = 1e-4;

/// A joint that the start tears open: its contact is deeper in than its play is wide.
#[derive(Clone, Debug, PartialEq)]
pub struct Torn<'a> {
    /// Which.
    pub joint: &'a Joint,
    /// How deep (m).
    pub depth: f64,
}

/// The joint of `mechanism` that is torn most at the start of the unit with these `gaps` (m); `None` if none is.
///
/// # Errors
/// If the mechanism has no run, see [`RunError`].
pub fn torn<'a>(mechanism: &'a Mechanism, gaps: &[f64]) -> Result<Option<Torn<'a>>, RunError> {
    let found = if mechanism.planar {
        let mounts = Mounts::of(mechanism)?;
        match mounts.coordinates().len() {
            ..=3 => in_plane::<3>(mechanism, &mounts, gaps)?,
            _ => in_plane::<6>(mechanism, &mounts, gaps)?,
        }
    } else if let Some(mounts) = spatial::mounts(mechanism)? {
        on_joints(mechanism, &mounts, gaps)?
    } else {
        match mechanism.bodies.len() {
            1 => free::<1, 6>(mechanism, gaps)?,
            2 => free::<2, 12>(mechanism, gaps)?,
            3 => free::<3, 18>(mechanism, gaps)?,
            other => return Err(RunError::Bodies(other)),
        }
    };
    let torn = found.into_iter().zip(joints_of_elements(mechanism)).filter_map(|(gap, joint)| {
        let (joint, depth) = (joint?, -gap?);
        // As deep as play is wide, or as a preload presses in the drawn pose. A stop has a distance instead of play.
        let is_stop = matches!(joint.kind, JointKind::Stop { .. });
        let deep = |gap: f64| if is_stop { (-gap).max(0.0) } else { gap.abs() };
        let play = joint.kind.gaps().map(|gap| deep(gaps[gap])).fold(0.0, f64::max);
        (depth > play + PRESSED).then_some(Torn { joint, depth })
    });
    Ok(torn.max_by(|one, other| one.depth.total_cmp(&other.depth)))
}

/// The gaps (m) at the start of the elements in a plane that are contacts.
fn in_plane<const D: usize>(
    mechanism: &Mechanism,
    mounts: &Mounts,
    gaps: &[f64],
) -> Result<Vec<Option<f64>>, RunError> {
    let tree = planar::bodies::<D>(mechanism, mounts)?;
    let Rest { places, rates } = Rest::of(mechanism, mounts);
    let placed = tree.placed(&tree.pose(places, half_angle), &SVector::from(rates));
    // No gap goes by the stick band.
    let elements = planar::elements::<D>(mechanism, mounts, gaps, 1.0)?;
    Ok(elements.iter().map(|element| element.gap((&tree, &placed))).collect())
}

/// The same of free bodies in space.
fn free<const N: usize, const D: usize>(mechanism: &Mechanism, gaps: &[f64]) -> Result<Vec<Option<f64>>, RunError> {
    let bodies = spatial::bodies::<N, D>(mechanism)?;
    let mut poses = bodies.nominal();
    poses.iter_mut().zip(thrown(mechanism)).for_each(|(pose, (start, _))| *pose = start);
    let placed = bodies.placed(&poses, &SVector::zeros());
    let elements = spatial::elements(mechanism, gaps, 1.0)?;
    Ok(elements.iter().map(|element| element.gap((&bodies, &placed))).collect())
}

/// The same of bodies on ideal joints in space.
fn on_joints(mechanism: &Mechanism, mounts: &[Mount<f64>], gaps: &[f64]) -> Result<Vec<Option<f64>>, RunError> {
    const D: usize = spatial::MOST_COORDINATES;
    let tree = spatial::tree::<{ spatial::MOST }, { 6 * spatial::MOST }, D>(mechanism, mounts)?;
    let Rest { places, rates } = Rest::on_joints(mechanism, mounts);
    let placed = tree.placed(&tree.pose(places, half_angle), &SVector::from(rates));
    let elements = spatial::elements(mechanism, gaps, 1.0)?;
    Ok(elements.iter().map(|element| element.gap(tree.free(&placed))).collect())
}
