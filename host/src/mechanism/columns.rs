//! What is told of a motion: drives and bodies, column by column.

use nalgebra::{Vector2, Vector3};
use slipfit_core::{
    SVector,
    pose::Pose,
    system::{
        Bodies,
        planar::{Kind, PlanarTree, Point},
        spatial::{
            PlacedBody,
            tree::{Kind as SpatialKind, SpatialTree},
        },
    },
};

use super::{Action, Mechanism, Mounts, NamedDrive, mounts::flat};
use crate::dynamics::outcome::Instant;

/// Coordinates and their rates at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<const D: usize> {
    /// Generalised velocities (m/s, rad/s).
    pub rates: [f64; D],
    /// Displacements (m) and angles (rad) from the drawn pose; in space rotation vectors.
    pub places: [f64; D],
    /// How fast these change (m/s, rad/s).
    pub place_rates: [f64; D],
}

impl<const D: usize> State<D> {
    /// The state at a `pose` and `rates` in a plane, whose angles are next to those of the `last` places: a turn goes on where its
    /// direction begins anew.
    pub fn planar(topology: &[Kind; D], pose: &[[f64; 2]; D], rates: [f64; D], last: &[f64; D]) -> Self {
        let places = std::array::from_fn(|k| {
            let [w, v] = pose[k];
            if topology[k] == Kind::Turn { near(whole_angle([w, v]), last[k]) } else { w }
        });
        Self { rates, places, place_rates: rates }
    }

    /// The state of free bodies at their `poses` and `rates`.
    pub fn spatial<const N: usize>(poses: &[Pose<f64>; N], rates: [f64; D]) -> Self {
        let (mut places, mut place_rates) = ([0.0; D], rates);
        let all = places.as_chunks_mut::<6>().0.iter_mut().zip(place_rates.as_chunks_mut::<6>().0);
        for ((place, rate), pose) in all.zip(poses) {
            let length = pose.orientation.v.norm();
            let angle = whole_angle([pose.orientation.w, length]);
            let turn = pose.orientation.v * if length > 0.0 { angle / length } else { 0.0 };
            let r = pose.displacement_w;
            *place = [r.x, r.y, r.z, turn.x, turn.y, turn.z];
            let [.., x, y, z] = *rate;
            let turning = vector_rate(&turn, &Vector3::new(x, y, z));
            (rate[3], rate[4], rate[5]) = (turning.x, turning.y, turning.z);
        }
        Self { rates, places, place_rates }
    }

    /// The state of bodies on ideal joints in space, whose angles are next to those of the `last` places.
    pub fn on_joints<const N: usize, const W: usize>(
        tree: &SpatialTree<f64, N, W, D>,
        pose: &[[f64; 2]; D],
        rates: [f64; D],
        last: &[f64; D],
    ) -> Self {
        let (mut places, mut place_rates) = (tree.places(pose, whole_angle), rates);
        for k in 0..D {
            match tree.coordinate(k).0 {
                SpatialKind::Turn => places[k] = near(places[k], last[k]),
                SpatialKind::Ball => {
                    let three = |of: &[f64; D]| Vector3::new(of[k], of[k + 1], of[k + 2]);
                    let turning = vector_rate(&three(&places), &three(&rates));
                    place_rates[k..k + 3].copy_from_slice(turning.as_slice());
                }
                SpatialKind::Slide | SpatialKind::OfBall | SpatialKind::Still => {}
            }
        }
        Self { rates, places, place_rates }
    }

    /// How fast these numbers change, where the velocities do by `accelerations` (m/s², rad/s²).
    pub fn slope(&self, accelerations: [f64; D]) -> Self {
        Self { rates: accelerations, places: self.place_rates, place_rates: [0.0; D] }
    }
}

/// Cosine and sine of half an `angle` (rad).
pub fn half_angle(angle: f64) -> [f64; 2] {
    [libm::cos(angle / 2.0), libm::sin(angle / 2.0)]
}

/// The angle (rad) of half of which there are cosine and sine.
fn whole_angle([cos, sin]: [f64; 2]) -> f64 {
    2.0 * libm::atan2(sin, cos)
}

/// How fast a rotation vector `turn` (rad) goes by the angular velocity `rotation` (rad/s) in the body.
fn vector_rate(turn: &Vector3<f64>, rotation: &Vector3<f64>) -> Vector3<f64> {
    let angle = turn.norm();
    let half = 0.5 * angle;
    let share = if angle > 1e-4 { (1.0 - half / libm::tan(half)) / (angle * angle) } else { 1.0 / 12.0 };
    let across = turn.cross(rotation);
    rotation + across * 0.5 + turn.cross(&across) * share
}

/// `angle` (rad) by so many turns that it is next to `last`.
fn near(angle: f64, last: f64) -> f64 {
    let turn = 2.0 * std::f64::consts::PI;
    angle + turn * ((last - angle) / turn).round()
}

impl<const D: usize> crate::dynamics::error_control::Values for State<D> {
    fn get(&self, k: usize) -> f64 {
        *self.rates.iter().chain(&self.places).nth(k).unwrap_or(&0.0)
    }

    fn rate(&self, k: usize) -> Option<f64> {
        k.checked_sub(D).and_then(|k| self.place_rates[..].get(k)).copied()
    }

    fn with(&self, value: impl Fn(usize) -> f64) -> Self {
        Self { rates: std::array::from_fn(&value), places: std::array::from_fn(|k| value(D + k)), ..*self }
    }
}

/// How one body moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMotion {
    /// Displacement of the centre of mass (m).
    pub displacement: Vector3<f64>,
    /// Rotation vector from the drawn pose (rad); in a plane its third part is the angle.
    pub turn: Vector3<f64>,
    /// Velocity of the centre of mass (m/s).
    pub velocity: Vector3<f64>,
    /// Angular velocity in the frame (rad/s).
    pub spin: Vector3<f64>,
}

/// The bodies of a mechanism in a plane: their centres of mass, where they are drawn (m), and what turns them.
pub struct PlanarBodies<'a, const D: usize> {
    tree: &'a PlanarTree<f64, D>,
    bodies: Vec<(Point<f64, D>, Vector2<f64>, Option<usize>)>,
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

    /// How they move.
    pub fn told(&self, state: &State<D>) -> Vec<BodyMotion> {
        let pose = self.tree.pose(state.places, half_angle);
        let placed = self.tree.placed(&pose, &SVector::from(state.rates));
        let body = |(centre, drawn, turn): &(Point<f64, D>, Vector2<f64>, Option<usize>)| {
            let [place, velocity] = self.tree.motion_of(centre, &placed);
            let moved = place - drawn;
            let about = |values: &[f64; D]| Vector3::z() * turn.map_or(0.0, |turn| values[turn]);
            BodyMotion {
                displacement: Vector3::new(moved.x, moved.y, 0.0),
                turn: about(&state.places),
                velocity: Vector3::new(velocity.x, velocity.y, 0.0),
                spin: about(&state.rates),
            }
        };
        self.bodies.iter().map(body).collect()
    }
}

/// The one axis about which coordinates turn a body, and which they are; a body that others turn, too, has none.
type Turns = (Vector3<f64>, Vec<usize>);

/// The bodies of a mechanism in space on ideal joints.
pub struct JointedBodies<const N: usize, const W: usize, const D: usize> {
    tree: SpatialTree<f64, N, W, D>,
    turns: Vec<Option<Turns>>,
}

impl<const N: usize, const W: usize, const D: usize> JointedBodies<N, W, D> {
    /// The first `count` bodies of `tree`.
    pub fn new(count: usize, tree: SpatialTree<f64, N, W, D>) -> Self {
        let turns = |body: usize| {
            let of = |k: &usize| tree.is_moved(*k, body) && tree.coordinate(*k).0.turns();
            let all: Vec<usize> = (0..D).filter(of).collect();
            let axis = all.first().map_or(Vector3::zeros(), |k| tree.coordinate(*k).1);
            let along = |k: &usize| {
                let (kind, other) = tree.coordinate(*k);
                kind == SpatialKind::Turn && axis.dot(&other).abs() > 1.0 - 1e-12
            };
            all.iter().all(along).then(|| (axis, all.clone()))
        };
        Self { tree, turns: (0..count).map(turns).collect() }
    }

    /// By which length (m) the angle of a body is compared with displacements; 0 where it does not turn.
    pub fn lever(&self, body: usize) -> f64 {
        let turns = |k: &usize| self.tree.is_moved(*k, body) && self.tree.coordinate(*k).0.turns();
        (0..D).rfind(turns).map_or(0.0, |k| self.tree.lever(k))
    }

    /// How they move. Angles about one axis go on from turn to turn.
    pub fn told(&self, state: &State<D>) -> Vec<BodyMotion> {
        let pose = self.tree.pose(state.places, half_angle);
        let placed = self.tree.placed(&pose, &SVector::from(state.rates));
        let body = |(turns, at): (&Option<Turns>, &PlacedBody<f64>)| BodyMotion {
            displacement: at.displacement_w,
            turn: match turns {
                Some((axis, all)) => {
                    axis * all.iter().map(|k| state.places[*k] * axis.dot(&self.tree.coordinate(*k).1)).sum::<f64>()
                }
                None => nalgebra::Rotation3::from_matrix_unchecked(at.to_frame).scaled_axis(),
            },
            velocity: at.velocity_w,
            spin: at.rotation_w,
        };
        self.turns.iter().zip(&placed.free.bodies).map(body).collect()
    }
}

/// The free bodies of a mechanism in space.
pub fn spatial<const D: usize>(state: &State<D>) -> Vec<BodyMotion> {
    let vector = |values: &[f64]| Vector3::new(values[0], values[1], values[2]);
    let bodies = state.rates.as_chunks::<6>().0.iter().zip(state.places.as_chunks::<6>().0);
    let body = |(rates, places): (&[f64; 6], &[f64; 6])| {
        let turn = vector(&places[3..]);
        BodyMotion {
            displacement: vector(places),
            turn,
            velocity: vector(rates),
            spin: nalgebra::Rotation3::from_scaled_axis(turn) * vector(&rates[3..]),
        }
    };
    bodies.map(body).collect()
}

/// Two vectors along an axis.
trait AlongAxis {
    fn along(self, axis: [f64; 3]) -> (f64, f64);
}

impl AlongAxis for (&Vector3<f64>, &Vector3<f64>) {
    fn along(self, axis: [f64; 3]) -> (f64, f64) {
        let axis = Vector3::from(axis);
        (self.0.dot(&axis), self.1.dot(&axis))
    }
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
            let motion = &motions[named.body];
            let (vz, z) = match named.action {
                Action::Pushes { axis } => (&motion.velocity, &motion.displacement).along(axis),
                Action::Turns { axis } => (&motion.spin, &motion.turn).along(axis),
            };
            Instant { t, vz, force: named.drive.force(t, vz), z }
        })
    }

    /// The least inertia (kg, kg·m²) that a drive may find: that of its body alone.
    pub fn least_inertia(&self, NamedDrive { action, body, .. }: &NamedDrive) -> f64 {
        let body = &self.bodies[*body];
        match action {
            Action::Pushes { .. } => body.mass,
            Action::Turns { axis } => body.inertia.iter().zip(axis).map(|(inertia, axis)| inertia * axis * axis).sum(),
        }
    }

    /// A sample at time `t` (s), in the order of [`columns`](Self::columns).
    pub fn row(&self, t: f64, drives: &[Instant], motions: &[BodyMotion]) -> Vec<f64> {
        let mut row = vec![t];
        row.extend(drives.iter().map(|at| at.force));
        for motion in motions {
            if self.planar {
                let BodyMotion { displacement: d, turn, velocity: v, spin } = motion;
                row.extend([d.x, d.y, turn.z, v.x, v.y, spin.z]);
            } else {
                let BodyMotion { displacement, turn, velocity, spin } = motion;
                row.extend(displacement.iter().chain(turn).chain(velocity).chain(spin));
            }
        }
        row
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Vector3};

    use super::{State, spatial};

    #[test]
    fn an_angular_velocity_is_told_in_the_frame() {
        let turned = Rotation3::new(Vector3::new(0.9, -1.3, 0.4));
        let rotation_b = Vector3::new(0.2, 0.5, -0.7);
        let six = |angular: Vector3<f64>| [0.0, 0.0, 0.0, angular.x, angular.y, angular.z];
        let state = State { rates: six(rotation_b), places: six(turned.scaled_axis()), place_rates: [0.0; 6] };
        // Around a constant axis any turn will do.
        let h = 0.1;
        let [before, after] = [-h, h].map(|t| turned * Rotation3::new(rotation_b * t));
        let turning = (after * before.inverse()).scaled_axis() / (2.0 * h);
        let [motion] = &spatial(&state)[..] else { panic!("one body") };
        assert!((turning - motion.spin).norm() < 1e-9, "{turning} {}", motion.spin);
        assert!((turning - rotation_b).norm() > 0.1);
    }
}
