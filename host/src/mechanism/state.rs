//! Coordinates of a mechanism and their rates, which are what is kept of a run.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use slipfit_core::{
    pose::{Orientation, Pose},
    system::{
        planar::Kind,
        spatial::tree::{Kind as SpatialKind, SpatialTree},
    },
};
use slipfit_desk::element::next_to;

use crate::dynamics::error_control::Values;

/// Coordinates and their rates at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<const D: usize> {
    /// Generalised velocities (m/s, rad/s).
    pub rates: [f64; D],
    /// Displacements (m) and angles (rad) from the drawn pose. The three of what turns about a point are the integral of its angular
    /// velocity about the axes of what it turns on: unlike a rotation vector they go on smoothly beyond a full turn.
    pub places: [f64; D],
    /// How fast these change (m/s, rad/s).
    pub place_rates: [f64; D],
    /// The unit quaternion of what turns about a point, real part first, in the first two rows of its three; of no effect in others.
    pub quaternions: [[f64; 2]; D],
    /// How fast these change (1/s).
    pub quaternion_rates: [[f64; 2]; D],
    /// The rotation vector (rad) of what turns about a point, next to the one before it in time.
    pub turns: [f64; D],
}

impl<const D: usize> State<D> {
    /// At rest at these `places`, with nothing turned about a point.
    pub fn at_rest(places: [f64; D]) -> Self {
        let (none, no_rows) = ([0.0; D], [[0.0; 2]; D]);
        Self { rates: none, places, place_rates: none, quaternions: no_rows, quaternion_rates: no_rows, turns: none }
    }

    /// The state at a `pose` and `rates` in a plane, whose angles are next to those of the `last` places: a turn goes on where its
    /// direction begins anew.
    pub fn planar(topology: &[Kind; D], pose: &[[f64; 2]; D], rates: [f64; D], last: &[f64; D]) -> Self {
        let places = std::array::from_fn(|k| {
            let [w, v] = pose[k];
            if topology[k] == Kind::Turn { next_to(whole_angle([w, v]), last[k]) } else { w }
        });
        Self { rates, place_rates: rates, ..Self::at_rest(places) }
    }

    /// The state of free bodies at their `poses` and `rates` after the `last` one, from which they have turned by less than half a turn.
    pub fn spatial<const N: usize>(poses: &[Pose<f64>; N], rates: [f64; D], last: &Self) -> Self {
        let mut state = Self { rates, place_rates: rates, ..Self::at_rest([0.0; D]) };
        for (i, Pose { displacement_w, orientation }) in poses.iter().enumerate() {
            state.places[6 * i..6 * i + 3].copy_from_slice(displacement_w.as_slice());
            state.turn_about_point(6 * i + 3, orientation, last);
        }
        state
    }

    /// The state of bodies on ideal joints in space after the `last` one, next to whose angles its own are.
    pub fn on_joints<const N: usize, const W: usize>(
        tree: &SpatialTree<f64, N, W, D>,
        pose: &[[f64; 2]; D],
        rates: [f64; D],
        last: &Self,
    ) -> Self {
        let mut state = Self { rates, place_rates: rates, ..Self::at_rest(tree.places(pose, whole_angle)) };
        for k in 0..D {
            match tree.coordinate(k).0 {
                SpatialKind::Turn => state.places[k] = next_to(state.places[k], last.places[k]),
                SpatialKind::Ball => {
                    let [[w, x], [y, z]] = [pose[k], pose[k + 1]];
                    state.turn_about_point(k, &Orientation { w, v: Vector3::new(x, y, z) }, last);
                }
                SpatialKind::Slide | SpatialKind::OfBall | SpatialKind::Still => {}
            }
        }
        state
    }

    /// Makes `orientation` that of what turns about a point by the coordinates from `k` on.
    fn turn_about_point(&mut self, k: usize, orientation: &Orientation<f64>, last: &Self) {
        let Orientation { w, v } = orientation;
        let mut now = UnitQuaternion::new_normalize(Quaternion::from_parts(*w, *v));
        let before = last.quaternion(k);
        // Both signs are the same orientation.
        if now.coords.dot(&before.coords) < 0.0 {
            now = UnitQuaternion::new_unchecked(-now.into_inner());
        }
        let spin = now * Vector3::from_column_slice(&self.rates[k..k + 3]);
        let rows = |q: Quaternion<f64>| [[q.w, q.i], [q.j, q.k]];
        self.quaternions[k..k + 2].copy_from_slice(&rows(now.into_inner()));
        self.quaternion_rates[k..k + 2].copy_from_slice(&rows(Quaternion::from_imag(spin * 0.5) * now.into_inner()));
        let turned = Vector3::from_column_slice(&last.places[k..k + 3]) + (now * before.inverse()).scaled_axis();
        self.places[k..k + 3].copy_from_slice(turned.as_slice());
        self.place_rates[k..k + 3].copy_from_slice(spin.as_slice());
        let turn = rotation_vector(&now, &Vector3::from_column_slice(&last.turns[k..k + 3]));
        self.turns[k..k + 3].copy_from_slice(turn.as_slice());
    }

    /// The orientation of what turns about a point by the coordinates from `k` on.
    pub fn quaternion(&self, k: usize) -> UnitQuaternion<f64> {
        let [[w, x], [y, z]] = [self.quaternions[k], self.quaternions[k + 1]];
        UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 0.0).unwrap_or_default()
    }
}

/// Cosine and sine of half an `angle` (rad).
pub fn half_angle(angle: f64) -> [f64; 2] {
    [libm::cos(angle / 2.0), libm::sin(angle / 2.0)]
}

/// The angle (rad) of half of which there are cosine and sine.
pub fn whole_angle([cos, sin]: [f64; 2]) -> f64 {
    2.0 * libm::atan2(sin, cos)
}

impl<const D: usize> Values for State<D> {
    /// Accelerations (m/s², rad/s²).
    type Rates = [f64; D];

    fn slope(&self, accelerations: &[f64; D]) -> Self {
        self.known_slope(Self { rates: *accelerations, ..*self })
    }

    fn known_slope(&self, guess: Self) -> Self {
        Self { places: self.place_rates, quaternions: self.quaternion_rates, ..guess }
    }

    #[inline]
    fn combined<const N: usize>(of: [&Self; N], by: impl Fn([f64; N]) -> f64) -> Self {
        Self {
            rates: std::array::from_fn(|k| by(of.map(|state| state.rates[k]))),
            places: std::array::from_fn(|k| by(of.map(|state| state.places[k]))),
            quaternions: std::array::from_fn(|k| [0, 1].map(|row| by(of.map(|state| state.quaternions[k][row])))),
            turns: of.first().map_or([0.0; D], |state| state.turns),
            // Of no effect between the ends of steps.
            ..Self::at_rest([0.0; D])
        }
    }
}

/// Of all rotation vectors (rad) of `orientation` the one that is nearest to the one `before`.
///
/// It is smooth as long as no body that is tilted comes by a full turn: there the direction swings around.
pub fn rotation_vector(orientation: &UnitQuaternion<f64>, before: &Vector3<f64>) -> Vector3<f64> {
    let (sine, about) = (orientation.imag().norm(), before.norm());
    // At a full turn the direction is lost.
    let direction = match (sine > 1e-9 || about < 1.0, sine > 0.0) {
        (true, true) => orientation.imag() / sine,
        (true, false) => return Vector3::zeros(),
        (false, _) => before / about,
    };
    direction * next_to(whole_angle([orientation.w, orientation.imag().dot(&direction)]), before.dot(&direction))
}
