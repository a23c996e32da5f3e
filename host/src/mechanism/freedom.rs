//! Degrees of freedom (eqs. 5–8): what ideal joints leave, and what joints with play take of it.

use nalgebra::{DMatrix, SMatrix, SVector};
use slipfit_core::{
    ParameterError,
    system::{
        Bodies, Link, Reduced,
        planar::PlanarTree,
        spatial::{FreeBodies, tree::SpatialTree},
    },
};

use super::{
    Joint, JointKind, Mechanism, Mounts, RunError, Walls,
    element::{PlanarElement, SpatialContact, SpatialElement},
    planar, spatial,
};

/// The mobility of a mechanism, n = 6(N − 1) − Σ i·c_i − n_cl (eq. 8), in a plane with 3 for 6.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Freedom {
    /// N: bodies and the frame.
    pub parts: usize,
    /// 6 in space, 3 in a plane.
    pub of_each: usize,
    /// c_i by i: how many ideal joints remove i freedoms.
    pub ideal: Vec<usize>,
    /// n_cl: what joints with play remove; stops, which hold only where they touch, not counted.
    pub by_clearance: usize,
    /// n.
    pub degrees_of_freedom: i64,
}

impl Freedom {
    /// The mobility of `mechanism` in its drawn pose.
    ///
    /// # Errors
    /// If it has no run, see [`RunError`].
    pub fn of(mechanism: &Mechanism) -> Result<Self, RunError> {
        let of_each = if mechanism.planar { 3 } else { 6 };
        let mut ideal = vec![0; of_each + 1];
        for joint in &mechanism.joints {
            let removed = match joint.kind {
                JointKind::Fixed => of_each,
                JointKind::Revolute { .. } | JointKind::Prismatic { .. } => of_each - 1,
                JointKind::PinSlot { .. } | JointKind::Cylindrical { .. } => of_each - 2,
                JointKind::Spherical => of_each - 3,
                _ => continue,
            };
            ideal[removed] += 1;
        }
        let by_clearance = rank(mechanism)?;
        let parts = mechanism.bodies.len() + 1;
        let removed: usize = ideal.iter().enumerate().map(|(i, count)| i * count).sum();
        let degrees_of_freedom = (of_each * (parts - 1)) as i64 - removed as i64 - by_clearance as i64;
        Ok(Self { parts, of_each, ideal, by_clearance, degrees_of_freedom })
    }

    /// The count as a formula.
    pub fn describe(&self) -> String {
        let ideal = self.ideal.iter().enumerate().filter(|(_, count)| **count > 0);
        let ideal: Vec<String> = ideal.map(|(i, count)| format!("{i}·{count}")).collect();
        let ideal = if ideal.is_empty() { "0".to_owned() } else { ideal.join(" − ") };
        let Self { parts, of_each, by_clearance, degrees_of_freedom, .. } = self;
        format!("{of_each}·({parts} − 1) − {ideal} − {by_clearance} = {degrees_of_freedom}")
    }
}

/// The rank of all that joints with play hold.
fn rank(mechanism: &Mechanism) -> Result<usize, RunError> {
    let open = vec![0.0; mechanism.gaps.len()];
    if mechanism.planar {
        let mounts = Mounts::of(mechanism)?;
        return Ok(match mounts.coordinates().len() {
            1 => in_plane::<1>(mechanism, &mounts, &open),
            2 => in_plane::<2>(mechanism, &mounts, &open),
            3 => in_plane::<3>(mechanism, &mounts, &open),
            4 => in_plane::<4>(mechanism, &mounts, &open),
            5 => in_plane::<5>(mechanism, &mounts, &open),
            _ => in_plane::<6>(mechanism, &mounts, &open),
        }?);
    }
    if mechanism.bodies.len() > spatial::MOST {
        return Err(RunError::Bodies(mechanism.bodies.len()));
    }
    const N: usize = spatial::MOST;
    let bodies: FreeBodies<f64, N, { 6 * N }> = spatial::bodies(mechanism)?;
    let rows = in_space(mechanism, &bodies, &open)?;
    let Some(mounts) = spatial::mounts(mechanism)? else {
        return Ok(rank_of(&rows.iter().map(|row| row.component_mul(&bodies.per_lever()).into()).collect::<Vec<_>>()));
    };
    let tree: SpatialTree<f64, N, { 6 * N }, { spatial::MOST_COORDINATES }> = spatial::tree(mechanism, &mounts)?;
    let placed = tree.placed(&tree.nominal(), &SVector::zeros());
    let by_coordinate =
        |row: &SVector<f64, { 6 * N }>| tree.reduced_force(&placed, row).component_mul(&tree.per_lever());
    Ok(rank_of(&rows.iter().map(|row| by_coordinate(row).into()).collect::<Vec<_>>()))
}

/// The rows of `gradient`, angles by their levers.
fn scaled<const R: usize, const D: usize>(gradient: &SMatrix<f64, R, D>, per_lever: &SVector<f64, D>) -> Vec<[f64; D]> {
    gradient.row_iter().map(|row| std::array::from_fn(|k| row[k] * per_lever[k])).collect()
}

/// How the numbers of `link` go by the velocities: row by row the generalised force of 1 N, or 1 N·m, along a number.
fn gradient<B: Bodies<f64, D>, L: Link<f64, B, D, R>, const R: usize, const D: usize>(
    link: &L,
    bodies: &B,
    placed: &B::Placed,
) -> SMatrix<f64, R, D> {
    let view = link.view(bodies, placed);
    let mut gradient = SMatrix::<f64, R, D>::zeros();
    for (i, unit) in SMatrix::<f64, R, R>::identity().column_iter().enumerate() {
        let mut row = SVector::<f64, D>::zeros();
        link.add_force((bodies, placed), &view, &unit.into_owned(), &mut row);
        gradient.set_row(i, &row.transpose());
    }
    gradient
}

fn rank_of<const D: usize>(rows: &[[f64; D]]) -> usize {
    if rows.is_empty() { 0 } else { DMatrix::from_fn(rows.len(), D, |i, j| rows[i][j]).rank(1e-9) }
}

fn in_plane<const D: usize>(
    mechanism: &Mechanism,
    mounts: &Mounts,
    gaps: &[f64],
) -> Result<usize, ParameterError<f64>> {
    let tree: PlanarTree<f64, D> = planar::bodies(mechanism, mounts)?;
    let pose = tree.pose([0.0; D], |_| [1.0, 0.0]);
    let placed = tree.placed(&pose, &SVector::zeros());
    // Stops are the pads of joints of that kind.
    let held = Mechanism {
        joints: mechanism
            .joints
            .iter()
            .filter(|joint| !matches!(joint.kind, JointKind::Stop { .. }))
            .map(straight)
            .collect(),
        ..mechanism.clone()
    };
    let mut rows = Vec::new();
    for element in planar::elements::<D>(&held, mounts, gaps, 1.0)? {
        match element {
            PlanarElement::Journal(element) => {
                let gradient = gradient(&element.link, &tree, &placed);
                rows.extend(scaled(&gradient, &tree.per_lever()).into_iter().take(2));
            }
            PlanarElement::Pad(element) => {
                let gradient = gradient(&element.link, &tree, &placed);
                rows.extend(scaled(&gradient, &tree.per_lever()).into_iter().take(1));
            }
            _ => {}
        }
    }
    Ok(rank_of(&rows))
}

/// A `joint` with straight and parallel walls.
fn straight(joint: &Joint) -> Joint {
    Joint { walls: Walls::Parallel, ..joint.clone() }
}

/// What joints with play hold of the free `bodies`: row by row the generalised force of 1 N.
fn in_space<const N: usize, const W: usize>(
    mechanism: &Mechanism,
    bodies: &FreeBodies<f64, N, W>,
    gaps: &[f64],
) -> Result<Vec<SVector<f64, W>>, ParameterError<f64>> {
    let placed = bodies.placed(&bodies.nominal(), &SVector::zeros());
    let joints = mechanism.joints.iter().map(straight).collect();
    let mut rows = Vec::new();
    for element in spatial::elements(&Mechanism { joints, ..mechanism.clone() }, gaps, 1.0)? {
        match element {
            SpatialElement::Contact(SpatialContact::Pin(element)) => {
                let gradient = gradient(&element.link, bodies, &placed);
                let [left, right, rail, wall] = element.law.gaps.map(|gap| gap < spatial::NONE);
                let held = [left || right, rail || wall, false];
                let all = gradient.row_iter().zip(held);
                rows.extend(all.filter(|(_, held)| *held).map(|(row, _)| row.transpose()));
            }
            SpatialElement::Contact(SpatialContact::Ring(element)) => {
                let gradient = gradient(&element.link, bodies, &placed);
                rows.extend(gradient.row_iter().take(2).map(|row| row.transpose()));
            }
            _ => {}
        }
    }
    Ok(rows)
}
