//! Where joints are: how their coordinates are written, and how they go on.

use super::{
    SpatialTree,
    joint::Kind,
    numbers::{set, three},
};
use crate::{
    SVector, Scalar, Vector3,
    pose::{Orientation, Pose, turn_rate, turned_over},
    system::half_turn,
};

impl<S: Scalar, const N: usize, const W: usize, const D: usize> SpatialTree<S, N, W, D> {
    /// The nominal pose.
    pub fn nominal(&self) -> [[S; 2]; D] {
        self.pose([S::zero(); D], |_| [S::one(), S::zero()])
    }

    /// The pose with the given displacements (m) and, of joints about an axis, angles (rad); of joints about a point rotation
    /// vectors. `half_angle` gives cosine and sine of half an angle.
    pub fn pose(&self, values: [S; D], half_angle: impl Fn(S) -> [S; 2]) -> [[S; 2]; D] {
        let mut pose = [[S::zero(); 2]; D];
        let vector = SVector::<S, D>::from(values);
        for (k, (coordinate, value)) in self.coordinates.iter().zip(values).enumerate() {
            match coordinate.kind {
                Kind::Slide => set(&mut pose, k, [value, S::zero()]),
                Kind::Turn => set(&mut pose, k, half_angle(value)),
                Kind::Ball => {
                    let turn = three(&vector, k);
                    let angle = turn.dot(&turn).sqrt();
                    let [w, sine] = half_angle(angle);
                    let share = S::zero().select_gt(angle, S::zero(), sine / angle.max_of(S::from_f64(1e-30)));
                    set_orientation(&mut pose, k, &Orientation { w, v: turn * share });
                }
                Kind::OfBall | Kind::Still => {}
            }
        }
        pose
    }

    /// The way back: displacements (m), angles (rad) and rotation vectors. `whole_angle` gives the angle, of half of which there are
    /// cosine and sine.
    pub fn places(&self, pose: &[[S; 2]; D], whole_angle: impl Fn([S; 2]) -> S) -> [S; D] {
        let mut places = [S::zero(); D];
        for (k, (coordinate, half)) in self.coordinates.iter().zip(pose).enumerate() {
            match coordinate.kind {
                Kind::Slide => put(&mut places, k, [half[0]]),
                Kind::Turn => put(&mut places, k, [whole_angle(*half)]),
                Kind::Ball => {
                    let Orientation { w, v } = ball(pose, k).orientation;
                    let length = v.dot(&v).sqrt();
                    let share = whole_angle([w, length]) / length.max_of(S::from_f64(1e-30));
                    put(&mut places, k, (v * share).data.0[0]);
                }
                Kind::OfBall | Kind::Still => {}
            }
        }
        places
    }

    /// `pose` + `dt`·Q̇ with the `velocity` held: implicit in the pose, or not.
    #[inline(always)]
    pub(super) fn updated(
        &self,
        pose: &[[S; 2]; D],
        velocity: &SVector<S, D>,
        dt: S,
        is_implicit: bool,
    ) -> [[S; 2]; D] {
        let mut next = *pose;
        let none = Vector3::zeros();
        for (k, (coordinate, [w, v])) in self.coordinates.iter().zip(*pose).enumerate() {
            let rate = velocity.data.0[0].get(k).copied().unwrap_or(S::zero());
            match coordinate.kind {
                Kind::Slide => set(&mut next, k, [w + rate * dt, v]),
                Kind::Turn => {
                    let by = rate * dt * S::from_f64(0.5);
                    let turned = half_turn::turned_on([w, v], by);
                    set(&mut next, k, if is_implicit { half_turn::shortened(turned, by) } else { turned });
                }
                Kind::Ball => {
                    let (now, turning) = (ball(pose, k), three(velocity, k));
                    let next_pose = if is_implicit {
                        now.implicit_update(none, turning, dt)
                    } else {
                        now.explicit_update(none, turning, dt)
                    };
                    set_orientation(&mut next, k, &next_pose.orientation);
                }
                Kind::OfBall | Kind::Still => {}
            }
        }
        next
    }

    /// `pose` with its turns nearer to unit length.
    #[inline(always)]
    pub(super) fn at_unit_length(&self, pose: &[[S; 2]; D]) -> [[S; 2]; D] {
        let mut next = *pose;
        for (k, (coordinate, half)) in self.coordinates.iter().zip(pose).enumerate() {
            match coordinate.kind {
                Kind::Turn => set(&mut next, k, half_turn::normalised(*half)),
                Kind::Ball => set_orientation(&mut next, k, &ball(pose, k).normalised().orientation),
                Kind::Slide | Kind::OfBall | Kind::Still => {}
            }
        }
        next
    }

    /// See [`Mechanism::displacement`](crate::mechanism::Mechanism::displacement).
    #[inline(always)]
    pub(super) fn displaced(&self, velocity: &SVector<S, D>, rate: &SVector<S, D>, a: S) -> SVector<S, D> {
        let mut displaced = rate * a;
        for (k, _) in self.coordinates.iter().enumerate().filter(|(_, coordinate)| coordinate.kind == Kind::Ball) {
            let turned = turned_over(&three(velocity, k), &three(rate, k), a);
            put(&mut displaced.data.0[0], k, turned.data.0[0]);
        }
        displaced
    }

    /// See [`Mechanism::rate`](crate::mechanism::Mechanism::rate).
    #[inline(always)]
    pub(super) fn rate_at(&self, displacement: &SVector<S, D>, velocity: &SVector<S, D>) -> SVector<S, D> {
        let mut rate = *velocity;
        for (k, coordinate) in self.coordinates.iter().enumerate() {
            match coordinate.kind {
                Kind::Turn => {
                    if let (Some(rate), Some(angle)) = (rate.data.0[0].get_mut(k), displacement.data.0[0].get(k)) {
                        *rate = half_turn::angle_rate(*angle, *rate);
                    }
                }
                Kind::Ball => {
                    let turning = turn_rate(&three(displacement, k), &three(velocity, k));
                    put(&mut rate.data.0[0], k, turning.data.0[0]);
                }
                Kind::Slide | Kind::OfBall | Kind::Still => {}
            }
        }
        rate
    }
}

/// How a ball is turned whose first coordinate is `k`.
#[inline(always)]
pub(super) fn ball<S: Scalar, const D: usize>(pose: &[[S; 2]; D], k: usize) -> Pose<S> {
    let numbers = pose.get(k..).map(<[_]>::as_flattened).and_then(|rest| rest.first_chunk::<4>());
    let [w, x, y, z] = numbers.copied().unwrap_or([S::one(), S::zero(), S::zero(), S::zero()]);
    Pose { displacement_w: Vector3::zeros(), orientation: Orientation { w, v: Vector3::new(x, y, z) } }
}

/// Writes `values` from `k` on.
#[inline(always)]
fn put<S: Scalar, const M: usize>(numbers: &mut [S], k: usize, values: [S; M]) {
    if let Some(places) = numbers.get_mut(k..).and_then(|rest| rest.first_chunk_mut::<M>()) {
        *places = values;
    }
}

#[inline(always)]
fn set_orientation<S: Scalar, const D: usize>(pose: &mut [[S; 2]; D], k: usize, to: &Orientation<S>) {
    if let Some([first, second]) = pose.get_mut(k..).and_then(|rest| rest.first_chunk_mut::<2>()) {
        (*first, *second) = ([to.w, to.v.x], [to.v.y, to.v.z]);
    }
}
