//! What is told of a motion: drives and bodies, column by column.

use nalgebra::{Quaternion, UnitQuaternion, Vector2, Vector3};
use slipfit_core::{
    SVector,
    system::{
        Bodies,
        planar::{Placed, PlanarTree, Point},
        spatial::{
            PlacedBody,
            tree::{Kind as SpatialKind, SpatialTree},
        },
    },
};

use super::{
    Action, Mechanism, Mounts, NamedDrive,
    mounts::flat,
    state::{State, half_angle, rotation_vector},
};
use crate::dynamics::observer::Instant;

/// How one body moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMotion {
    /// Displacement of the centre of mass (m).
    pub displacement: Vector3<f64>,
    /// Rotation from the drawn pose.
    pub orientation: UnitQuaternion<f64>,
    /// How much it has turned about the axes of the frame (rad): the integral of `spin` of a body that one axis or one point holds, or
    /// nothing; of other bodies the rotation vector.
    pub turned: Vector3<f64>,
    /// Whether it turns about one axis alone, so that `turned` is the rotation vector.
    pub is_axial: bool,
    /// The rotation vector (rad) shortly before, if it does not.
    pub before: Vector3<f64>,
    /// Velocity of the centre of mass (m/s).
    pub velocity: Vector3<f64>,
    /// Angular velocity in the frame (rad/s).
    pub spin: Vector3<f64>,
}

impl BodyMotion {
    /// Rotation vector from the drawn pose (rad); in a plane its third part is the angle. It goes on beyond full turns.
    pub fn turn(&self) -> Vector3<f64> {
        if self.is_axial { self.turned } else { rotation_vector(&self.orientation, &self.before) }
    }
}

/// The bodies of a mechanism in a plane.
pub struct PlanarBodies<'a, const D: usize> {
    tree: &'a PlanarTree<f64, D>,
    /// Of each body its centre of mass, where that is drawn (m), and what turns it.
    pub bodies: Vec<(Point<f64, D>, Vector2<f64>, Option<usize>)>,
}

impl<'a, const D: usize> PlanarBodies<'a, D> {
    /// Those of `mechanism` on its `mounts`.
    pub fn of(mechanism: &Mechanism, mounts: &Mounts, tree: &'a PlanarTree<f64, D>) -> Self {
        let body = |(i, body): (usize, &super::Body)| {
            let drawn = flat(body.centre);
            (mounts.point(Some(i), drawn), drawn, mounts.turn(Some(i)))
        };
        Self { tree, bodies: mechanism.bodies.iter().enumerate().map(body).collect() }
    }

    /// Displacement (m) and velocity (m/s) of the centre of mass of each body that is `placed`, and what turns it.
    pub fn moved(&self, placed: &Placed<f64, D>) -> impl Iterator<Item = ([Vector3<f64>; 2], Option<usize>)> {
        self.bodies.iter().map(|(centre, drawn, turn)| {
            let [place, velocity] = self.tree.motion_of(centre, placed);
            ([place - drawn, velocity].map(|vector| Vector3::new(vector.x, vector.y, 0.0)), *turn)
        })
    }

    /// Puts how they move in place of what was `told`.
    pub fn tell(&self, state: &State<D>, told: &mut Vec<BodyMotion>) {
        let pose = self.tree.pose(state.places, half_angle);
        let placed = self.tree.placed(&pose, &SVector::from(state.rates));
        let body = |([displacement, velocity], turn): ([Vector3<f64>; 2], Option<usize>)| {
            let about = |values: &[f64; D]| Vector3::z() * turn.map_or(0.0, |turn| values[turn]);
            let [cos, sin] = turn.map_or([1.0, 0.0], |turn| pose[turn]);
            BodyMotion {
                displacement,
                orientation: UnitQuaternion::new_unchecked(Quaternion::new(cos, 0.0, 0.0, sin)),
                turned: about(&state.places),
                is_axial: true,
                before: Vector3::zeros(),
                velocity,
                spin: about(&state.rates),
            }
        };
        told.clear();
        told.extend(self.moved(&placed).map(body));
    }
}

/// What turns a body: the coordinates that do, each with its axis in the drawn pose.
struct Turns {
    all: Vec<(usize, SpatialKind, Vector3<f64>)>,
    /// Whether they do so about one axis.
    is_axial: bool,
}

impl Turns {
    /// The first coordinate of the spherical joint that alone turns it.
    fn ball(&self) -> Option<usize> {
        match self.all[..] {
            [(k, SpatialKind::Ball, _)] => Some(k),
            _ => None,
        }
    }

    /// How much (rad) they have turned the body by their `places`, drawn axis by drawn axis.
    fn sum(&self, places: &[f64]) -> Vector3<f64> {
        let one = |(k, kind, axis): &(usize, SpatialKind, Vector3<f64>)| match kind {
            SpatialKind::Ball => Vector3::from_column_slice(&places[*k..*k + 3]),
            _ => axis * places[*k],
        };
        self.all.iter().map(one).sum()
    }
}

/// The bodies of a mechanism in space on ideal joints.
pub struct JointedBodies<const N: usize, const W: usize, const D: usize> {
    tree: SpatialTree<f64, N, W, D>,
    turns: Vec<Turns>,
}

impl<const N: usize, const W: usize, const D: usize> JointedBodies<N, W, D> {
    /// The first `count` bodies of `tree`.
    pub fn new(count: usize, tree: SpatialTree<f64, N, W, D>) -> Self {
        let turns = |body: usize| {
            let coordinates = (0..D).filter(|k| tree.is_moved(*k, body)).map(|k| (k, tree.coordinate(k)));
            let turning = coordinates.filter(|(_, (kind, _))| matches!(kind, SpatialKind::Turn | SpatialKind::Ball));
            let all: Vec<_> = turning.map(|(k, (kind, axis))| (k, kind, axis)).collect();
            let first = all.first().map_or(Vector3::zeros(), |(.., axis)| *axis);
            let is_along = |kind, axis: &Vector3<f64>| kind == SpatialKind::Turn && first.dot(axis).abs() > 1.0 - 1e-12;
            let is_axial = all.iter().all(|(_, kind, axis)| is_along(*kind, axis));
            Turns { all, is_axial }
        };
        Self { tree, turns: (0..count).map(turns).collect() }
    }

    /// By which length (m) the angle of a body is compared with displacements; 0 where it does not turn.
    pub fn lever(&self, body: usize) -> f64 {
        let turns = |k: &usize| self.tree.is_moved(*k, body) && self.tree.coordinate(*k).0.turns();
        (0..D).rfind(turns).map_or(0.0, |k| self.tree.lever(k))
    }

    /// Puts how they move in place of what was `told`. Angles go on from turn to turn.
    pub fn tell(&self, state: &State<D>, told: &mut Vec<BodyMotion>) {
        let mut pose = self.tree.pose(state.places, half_angle);
        for k in (0..D).filter(|k| self.tree.coordinate(*k).0 == SpatialKind::Ball) {
            pose[k..k + 2].copy_from_slice(&state.quaternions[k..k + 2]);
        }
        let placed = self.tree.placed(&pose, &SVector::from(state.rates));
        let body = |(turns, at): (&Turns, &PlacedBody<f64>)| {
            let sum = turns.sum(&state.places);
            let rotation = nalgebra::Rotation3::from_matrix_unchecked(at.to_frame);
            let orientation = UnitQuaternion::from_rotation_matrix(&rotation);
            let is_held = turns.is_axial || turns.all.len() == 1;
            BodyMotion {
                displacement: at.displacement_w,
                orientation,
                turned: if is_held { sum } else { rotation_vector(&orientation, &sum) },
                is_axial: turns.is_axial,
                before: turns.ball().map_or(sum, |k| Vector3::from_column_slice(&state.turns[k..k + 3])),
                velocity: at.velocity_w,
                spin: at.rotation_w,
            }
        };
        told.clear();
        told.extend(self.turns.iter().zip(&placed.free.bodies).map(body));
    }
}

/// Puts how the free bodies of a mechanism in space move in place of what was `told`.
pub fn spatial<const D: usize>(state: &State<D>, told: &mut Vec<BodyMotion>) {
    let vector = |values: &[f64]| Vector3::new(values[0], values[1], values[2]);
    let body = |k: usize| {
        let orientation = state.quaternion(k + 3);
        BodyMotion {
            displacement: vector(&state.places[k..]),
            orientation,
            turned: vector(&state.places[k + 3..]),
            is_axial: false,
            before: vector(&state.turns[k + 3..]),
            velocity: vector(&state.rates[k..]),
            spin: orientation * vector(&state.rates[k + 3..]),
        }
    };
    told.clear();
    told.extend((0..D).step_by(6).map(body));
}

/// Place and angle of a body in a plane, and how fast they change.
const IN_A_PLANE: [&str; 6] = ["x (m)", "y (m)", "angle (rad)", "vx (m/s)", "vy (m/s)", "spin (rad/s)"];

/// Place and rotation vector of a body in space, its velocity, and its angular velocity in the frame.
#[rustfmt::skip]
const IN_SPACE: [&str; 12] = [
    "x (m)", "y (m)", "z (m)",
    "ax (rad)", "ay (rad)", "az (rad)",
    "vx (m/s)", "vy (m/s)", "vz (m/s)",
    "wx (rad/s)", "wy (rad/s)", "wz (rad/s)",
];

impl Mechanism {
    /// Names of the columns of [`row`](Self::row), with their units.
    pub fn columns(&self) -> Vec<String> {
        let drives = self.drives.iter().map(|drive| match drive.action {
            Action::Pushes { .. } => format!("{}.force (N)", drive.name),
            Action::Turns { .. } => format!("{}.torque (N·m)", drive.name),
        });
        let bodies = self
            .bodies
            .iter()
            .flat_map(|body| self.columns_of_body().iter().map(|what| format!("{}.{what}", body.name)));
        std::iter::once("t (s)".to_owned()).chain(drives).chain(bodies).collect()
    }

    /// What is told of each body, with its unit.
    pub fn columns_of_body(&self) -> &'static [&'static str] {
        if self.planar { &IN_A_PLANE } else { &IN_SPACE }
    }

    /// What each drive sees and does at time `t` (s): speed, force and travel along its axis, or angular velocity, torque
    /// and angle about it.
    pub fn drives_at<'a>(&'a self, t: f64, motions: &'a [BodyMotion]) -> impl Iterator<Item = Instant> + 'a {
        self.drives.iter().map(move |named| {
            let BodyMotion { displacement, orientation, turned, velocity, spin, .. } = motions[named.body];
            let arms = named.arms(|lever| orientation * lever);
            let [vz, z] = named.measured_motion([velocity, spin], displacement, arms, || turned);
            Instant { t, vz, force: named.effort(t, vz), z }
        })
    }

    /// The least inertia (kg, kg·m²) that a drive may find: that of its body alone.
    pub fn least_inertia(&self, NamedDrive { action, body, .. }: &NamedDrive) -> f64 {
        let (mass, inertia) = self.moved_with(*body);
        match action {
            Action::Pushes { .. } => mass,
            Action::Turns { axis } => inertia.iter().zip(axis).map(|(inertia, axis)| inertia * axis * axis).sum(),
        }
    }

    /// A sample at time `t` (s), in the order of [`columns`](Self::columns).
    pub fn row(&self, t: f64, drives: &[Instant], motions: &[BodyMotion]) -> Vec<f64> {
        let mut row = vec![t];
        row.extend(drives.iter().map(|at| at.force));
        for motion in motions {
            if self.planar {
                let BodyMotion { displacement: d, turned, velocity: v, spin, .. } = motion;
                row.extend([d.x, d.y, turned.z, v.x, v.y, spin.z]);
            } else {
                let BodyMotion { displacement, velocity, spin, .. } = motion;
                row.extend(displacement.iter().chain(&motion.turn()).chain(velocity).chain(spin));
            }
        }
        row
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use nalgebra::{Rotation3, UnitQuaternion, Vector3};
    use slipfit_core::pose::{Orientation, Pose};

    use super::{BodyMotion, State, spatial};
    use crate::dynamics::error_control::{Knot, between};

    /// The pose of a body that is turned by `rotation`, in either sign of its quaternion.
    fn pose(rotation: &UnitQuaternion<f64>, sign: f64) -> [Pose<f64>; 1] {
        let orientation = Orientation { w: sign * rotation.w, v: rotation.imag() * sign };
        [Pose { displacement_w: Vector3::zeros(), orientation }]
    }

    fn six(angular: Vector3<f64>) -> [f64; 6] {
        [0.0, 0.0, 0.0, angular.x, angular.y, angular.z]
    }

    fn only(state: &State<6>) -> BodyMotion {
        let mut told = Vec::new();
        spatial(state, &mut told);
        told[0]
    }

    #[test]
    fn an_angular_velocity_is_told_in_the_frame() {
        let turned = UnitQuaternion::new(Vector3::new(0.9, -1.3, 0.4));
        let rotation_b = Vector3::new(0.2, 0.5, -0.7);
        let state = State::spatial(&pose(&turned, 1.0), six(rotation_b), &State::at_rest([0.0; 6]));
        // Around a constant axis any turn will do.
        let h = 0.1;
        let [before, after] = [-h, h].map(|t| turned.to_rotation_matrix() * Rotation3::new(rotation_b * t));
        let turning = (after * before.inverse()).scaled_axis() / (2.0 * h);
        let motion = only(&state);
        assert!((turning - motion.spin).norm() < 1e-9, "{turning} {}", motion.spin);
        assert!((turning - rotation_b).norm() > 0.1);
        assert!((motion.turn() - Vector3::new(0.9, -1.3, 0.4)).norm() < 1e-14, "{}", motion.turn());
    }

    /// A body whose axis moves while it turns by many turns: its rotation vector goes on without a jump, and is that of its orientation.
    #[test]
    fn the_rotation_vector_of_a_body_whose_axis_moves_does_not_jump() {
        let h = 1e-3;
        let mut last = State::at_rest([0.0; 6]);
        let (mut orientation, mut before) = (UnitQuaternion::identity(), Vector3::zeros());
        for k in 0..4000 {
            let t = h * f64::from(k);
            let spin = Vector3::new(libm::sin(9.0 * t), 0.7 * libm::cos(5.0 * t), libm::cos(7.0 * t)) * 40.0;
            let state = State::spatial(
                &pose(&orientation, if k % 2 == 0 { 1.0 } else { -1.0 }),
                six(orientation.inverse() * spin),
                &last,
            );
            let turn = only(&state).turn();
            assert!((UnitQuaternion::new(turn).inverse() * orientation).angle() < 1e-7, "{t}");
            // Of all rotation vectors of this orientation none is nearer to the one before.
            let direction = turn.try_normalize(0.0).unwrap_or_default();
            for other in [turn + direction * (2.0 * PI), turn - direction * (2.0 * PI)] {
                assert!((turn - before).norm() <= (other - before).norm() + 1e-9, "{t}");
            }
            (before, last) = (turn, state);
            orientation = UnitQuaternion::new(spin * h) * orientation;
        }
    }

    /// A body that spins about an axis of its own, the axis tilted, is where it is to be between the ends of steps, at each of many turns
    /// and whatever the sign of its quaternion.
    #[test]
    fn turns_go_on_beyond_a_full_one() {
        let step = 0.05;
        for axis in [Vector3::z(), -Vector3::x(), Vector3::new(2.0, -1.0, 2.0) / 3.0] {
            for tilt in [Vector3::zeros(), Vector3::new(0.3, 0.2, -0.1), Vector3::new(1e-3, 0.0, 2e-3)] {
                let tilt = UnitQuaternion::new(tilt);
                let at = |t: f64| UnitQuaternion::new(axis * (10.0 * t)) * tilt;
                let rates = six(tilt.inverse() * axis * 10.0);
                let mut last = State::at_rest([0.0; 6]);
                let mut knots: Vec<Knot<State<6>>> = Vec::new();
                for k in 0..100 {
                    let t = step * f64::from(k);
                    let values = State::spatial(&pose(&at(t), if k % 3 == 0 { -1.0 } else { 1.0 }), rates, &last);
                    knots.push(Knot { t, values, rates: (k > 0).then_some([[0.0; 6]; 2]) });
                    last = values;
                }
                for i in 0..99 {
                    let t = step * (f64::from(i as u32) + 0.37);
                    let motion @ BodyMotion { turned, spin, .. } = only(&between(&knots, i, t));
                    let turn = motion.turn();
                    let apart = (UnitQuaternion::new(turn).inverse() * at(t)).angle();
                    assert!(apart < 1e-4, "{t}: {apart:e}");
                    assert!((spin - axis * 10.0).norm() < 1e-2, "{t}: {spin}");
                    assert!((turned - axis * (10.0 * t) - tilt.scaled_axis()).norm() < 1e-9, "{t}: {turned}");
                    if tilt.angle() == 0.0 {
                        assert!((turn - axis * (10.0 * t)).norm() < 1e-4, "{t}: {turn}");
                    }
                }
            }
        }
    }
}
