//! The pose of one rigid body on full SO(3).

use nalgebra::Matrix3;

use crate::{
    Scalar, Vector3,
    product::{cross, dot, mapped_entries, times, transposed_times},
};

/// A unit quaternion, body to fixed frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orientation<S> {
    /// Real part.
    pub w: S,
    /// Imaginary part.
    pub v: Vector3<S>,
}

/// Displacement from the nominal pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<S> {
    /// Displacement of the centre of mass (m).
    pub displacement_w: Vector3<S>,
    /// Orientation; the identity at the nominal pose. Kept near unit length, never assumed to have it exactly.
    pub orientation: Orientation<S>,
}

/// Rᵀ − I: what carries a frame vector into the body, less the vector itself.
///
/// Kept as the difference, because near the nominal pose R would leave f32 few digits of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToBody<S> {
    change: Matrix3<S>,
}

impl<S: Scalar> Pose<S> {
    /// The nominal pose.
    pub fn nominal() -> Self {
        Self { displacement_w: Vector3::zeros(), orientation: Orientation { w: S::one(), v: Vector3::zeros() } }
    }

    /// The pose Q that solves Q = `self` + `dt`·Q̇(Q): the end of an implicit move with the velocities `velocity_w`
    /// (m/s) and `angular_velocity_b` (rad/s) that hold at its end.
    ///
    /// For the quaternion, q̇ = ½ q∘ω, the equation is linear and solved exactly.
    #[inline(always)]
    pub fn implicit_update(&self, velocity_w: Vector3<S>, angular_velocity_b: Vector3<S>, dt: S) -> Self {
        let Orientation { w, v } = self.orientation;
        let turn = angular_velocity_b * (dt * S::from_f64(0.5));
        let scale = S::one() / (S::one() + dot(&turn, &turn));
        Self {
            displacement_w: self.displacement_w + velocity_w * dt,
            orientation: Orientation { w: (w - dot(&v, &turn)) * scale, v: (v + turn * w + cross(&v, &turn)) * scale },
        }
    }

    /// `self` + `dt`·Q̇(`self`): an explicit move with the velocities `velocity_w` (m/s) and `angular_velocity_b` (rad/s).
    #[inline(always)]
    pub fn explicit_update(&self, velocity_w: Vector3<S>, angular_velocity_b: Vector3<S>, dt: S) -> Self {
        let Orientation { w, v } = self.orientation;
        let turn = angular_velocity_b * (dt * S::from_f64(0.5));
        Self {
            displacement_w: self.displacement_w + velocity_w * dt,
            orientation: Orientation { w: w - dot(&v, &turn), v: v + turn * w + cross(&v, &turn) },
        }
    }

    /// `self + weight·(to − from)`, component by component; the quaternion is not brought back to unit length.
    #[inline(always)]
    pub fn shifted(&self, from: &Self, to: &Self, weight: S) -> Self {
        let (from_q, to_q) = (from.orientation, to.orientation);
        Self {
            displacement_w: self.displacement_w + (to.displacement_w - from.displacement_w) * weight,
            orientation: Orientation {
                w: self.orientation.w + (to_q.w - from_q.w) * weight,
                v: self.orientation.v + (to_q.v - from_q.v) * weight,
            },
        }
    }

    /// `self` where it is finite and `condition` > 0, else `old`, number by number.
    #[inline(always)]
    pub fn or_old(&self, condition: S, old: &Self) -> Self {
        let either = |new: S, old| new.or_old(condition, old);
        Self {
            displacement_w: self.displacement_w.zip_map(&old.displacement_w, either),
            orientation: Orientation {
                w: either(self.orientation.w, old.orientation.w),
                v: self.orientation.v.zip_map(&old.orientation.v, either),
            },
        }
    }

    /// The same pose with its quaternion nearer to unit length: by a Newton step where it is near already, and within a factor of two or
    /// three at any length.
    #[inline(always)]
    pub fn normalised(&self) -> Self {
        let Orientation { w, v } = self.orientation;
        let scale = towards_unit_length(w * w + dot(&v, &v));
        Self { displacement_w: self.displacement_w, orientation: Orientation { w: w * scale, v: v * scale } }
    }

    /// 0 if all numbers are finite, else NaN.
    #[inline(always)]
    pub(crate) fn finiteness_probe(&self) -> S {
        let Self { displacement_w: r, orientation: q } = self;
        (r.x + r.y + r.z + q.w + q.v.x + q.v.y + q.v.z) * S::zero()
    }

    /// The rotation from the fixed frame into the body.
    #[inline(always)]
    pub fn to_body(&self) -> ToBody<S> {
        let Orientation { w, v } = self.orientation;
        let twice = v * (S::from_f64(2.0) / (w * w + dot(&v, &v)));
        let (xx, yy, zz) = (twice.x * v.x, twice.y * v.y, twice.z * v.z);
        let (xy, yz, zx) = (twice.x * v.y, twice.y * v.z, twice.z * v.x);
        let (wx, wy, wz) = (twice.x * w, twice.y * w, twice.z * w);
        #[rustfmt::skip]
        let change = Matrix3::new(
            -(yy + zz), xy + wz, zx - wy,
            xy - wz, -(xx + zz), yz + wx,
            zx + wy, yz - wx, -(xx + yy),
        );
        ToBody { change }
    }
}

impl<S: Scalar> ToBody<S> {
    /// The same rotation in numbers of another type.
    #[inline(always)]
    pub(crate) fn cast<T: Scalar>(&self, number: impl Fn(S) -> T) -> ToBody<T> {
        ToBody { change: mapped_entries(&self.change, number) }
    }

    /// Rᵀ.
    #[inline(always)]
    pub fn matrix(&self) -> Matrix3<S> {
        self.change + Matrix3::identity()
    }

    /// The frame's z axis in body axes.
    #[inline(always)]
    pub fn z_axis(&self) -> Vector3<S> {
        let [x, y, z] = self.change.data.0[2];
        Vector3::new(x, y, S::one() + z)
    }

    /// (Rᵀ − I)·`vector_w`.
    #[inline(always)]
    pub fn change(&self, vector_w: Vector3<S>) -> Vector3<S> {
        times(&self.change, &vector_w)
    }

    /// Rᵀ·`vector_w`: a frame vector in body axes.
    #[inline(always)]
    pub fn apply(&self, vector_w: Vector3<S>) -> Vector3<S> {
        vector_w + self.change(vector_w)
    }

    /// R·`vector_b`: a body vector in frame axes.
    #[inline(always)]
    pub fn apply_inverse(&self, vector_b: Vector3<S>) -> Vector3<S> {
        vector_b + transposed_times(&self.change, &vector_b)
    }
}

/// What brings nearer to unit length what has this `square` of a length, never negative nor zero.
///
/// Newton's step ½(3 − `square`) does so near 1. It alone would turn a length beyond √3 around, and one that a step makes shorter by more
/// than a factor of 1.5 would vanish step by step: an implicit step of 2.24 rad does. Below 0.5 and above 2.5 it is therefore
/// 0.625/`square`, which is the greater one there and the smaller one between.
#[inline(always)]
pub(crate) fn towards_unit_length<S: Scalar>(square: S) -> S {
    (S::from_f64(0.625) / square).max_of(S::from_f64(0.5) * (S::from_f64(3.0) - square))
}

/// How fast the turn θ (rad) of [`Pose::explicit_update`] grows while the body turns with `angular_velocity_b` ω (rad/s): the orientation is
/// that of the quaternion (1, θ/2) after the pose's, so that θ̇ = ω + ½·θ×ω + ¼·θ(θ·ω).
#[inline(always)]
pub(crate) fn turn_rate<S: Scalar>(turn_b: &Vector3<S>, angular_velocity_b: &Vector3<S>) -> Vector3<S> {
    let half = turn_b * S::from_f64(0.5);
    angular_velocity_b + cross(&half, angular_velocity_b) + half * dot(&half, angular_velocity_b)
}

/// The turn θ (rad) that solves θ = `a`·(`rate` + ½·θ × ω), see [`turn_rate`], over the time `a` (s) with the angular velocity ω (rad/s).
#[inline(always)]
pub(crate) fn turned_over<S: Scalar>(angular_velocity: &Vector3<S>, rate: &Vector3<S>, a: S) -> Vector3<S> {
    let half = angular_velocity * (a * S::from_f64(0.5));
    let turned = rate - cross(&half, rate) + half * dot(&half, rate);
    turned * (a / (S::one() + dot(&half, &half)))
}

#[cfg(test)]
mod tests {
    use super::{Pose, towards_unit_length, turn_rate, turned_over};
    use crate::Vector3;

    #[test]
    #[cfg_attr(miri, ignore = "an interpreter has no time for so many steps")]
    fn a_full_turn_about_z_comes_back() {
        let rate = Vector3::new(0.0, 0.0, 2.0 * core::f64::consts::PI);
        let mut pose = Pose::nominal();
        for _ in 0..10_000 {
            // The midpoint of two implicit half-moves is second order: a Cayley step.
            let half = pose.implicit_update(Vector3::zeros(), rate, 0.5e-4);
            pose = pose.shifted(&pose, &half, 2.0).normalised();
        }
        let x_w = pose.to_body().apply_inverse(Vector3::x());
        assert!((x_w - Vector3::x()).norm_squared() < 1e-14, "{x_w}");
    }

    /// About a fixed axis, so that the angle is known: each step turns by twice the arctangent of half of what it is to turn by.
    #[test]
    fn however_far_a_step_turns_the_length_stays_and_the_angle_is_right() {
        let axis = Vector3::new(2.0, -1.0, 2.0) / 3.0;
        for by in [0.1, 1.7, 2.0, 2.2, 2.24, 3.0, 3.5, 5.0, 20.0, 1e3, 1e6] {
            for is_implicit in [true, false] {
                let (mut pose, mut angle) = (Pose::<f64>::nominal(), 0.0);
                for step in 0..1000 {
                    let none = Vector3::zeros();
                    let next = if is_implicit {
                        pose.implicit_update(none, axis, by)
                    } else {
                        pose.explicit_update(none, axis, by)
                    };
                    pose = next.normalised();
                    angle += 2.0 * libm::atan(by / 2.0);
                    let q = pose.orientation;
                    let length = libm::sqrt(q.w * q.w + q.v.norm_squared());
                    assert!(
                        (0.01 / by.max(1.0)..=by.max(2.0)).contains(&length),
                        "{by} {is_implicit} {step}: {length:e}"
                    );
                    let [w, v] = [q.w / length, axis.dot(&q.v) / length];
                    let [cos, sin] = [libm::cos(angle / 2.0), libm::sin(angle / 2.0)];
                    assert!(libm::hypot(w - cos, v - sin) < 1e-10, "{by} {is_implicit} {step}");
                }
            }
        }
    }

    #[test]
    fn near_unit_length_it_is_newtons_step_to_the_last_digit() {
        for k in 501..2500 {
            let square = f64::from(k) / 1000.0;
            assert_eq!(towards_unit_length(square), 0.5 * (3.0 - square), "{square}");
            assert_eq!(towards_unit_length(square as f32), 0.5 * (3.0 - square as f32), "{square}");
        }
        assert!(towards_unit_length(f64::NAN).is_nan());
    }

    #[test]
    fn what_turns_over_a_time_solves_its_equation() {
        let (omega, rate, a) = (Vector3::<f64>::new(3.0, -1.0, 2.0), Vector3::new(0.4, 0.5, -0.2), 0.3);
        let turned = turned_over(&omega, &rate, a);
        let half = turned * 0.5;
        assert!((turned - (rate + half.cross(&omega)) * a).norm() < 1e-15);
        // The cross product is what the rate changes by with a small turn.
        let small = turned * 1e-7;
        assert!(((turn_rate(&small, &omega) - omega) * 1e7 - half.cross(&omega)).norm() < 1e-6);
    }

    #[test]
    fn body_and_frame_are_inverse_and_keep_length() {
        let pose = Pose::nominal().implicit_update(Vector3::new(1.0, 2.0, 3.0), Vector3::new(0.7, -0.4, 1.9), 1.0);
        let r = pose.to_body();
        let a = Vector3::<f64>::new(0.3, -1.2, 0.5);
        assert!((r.apply_inverse(r.apply(a)) - a).norm_squared() < 1e-30);
        assert!(libm::fabs(r.apply(a).norm_squared() - a.norm_squared()) < 1e-14);
        assert!((r.apply(a) - a - r.change(a)).norm_squared() < 1e-30);
        // Rᵀ turns +x towards −y when the body turns about +z.
        let quarter = Pose::nominal().implicit_update(Vector3::zeros(), Vector3::new(0.0, 0.0, 2.0), 1.0).to_body();
        assert!((quarter.apply(Vector3::x()) - Vector3::new(0.0, -1.0, 0.0)).norm_squared() < 1e-30);
    }
}
