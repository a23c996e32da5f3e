//! Turns about an axis by cosine and sine of half the angle. They are kept near unit length, and never assumed to have it exactly.

use crate::{Scalar, Vector2, pose::towards_unit_length};

/// `half` after a turn whose half angle has the tangent `by`; its length grows.
#[inline(always)]
pub(super) fn turned_on<S: Scalar>([w, v]: [S; 2], by: S) -> [S; 2] {
    [w - v * by, v + w * by]
}

/// By what a turn to the end of an implicit step is shorter than [`turned_on`] makes it.
#[inline(always)]
pub(super) fn shortened<S: Scalar>(half: [S; 2], by: S) -> [S; 2] {
    let scale = S::one() / (S::one() + by * by);
    half.map(|x| x * scale)
}

/// Nearer to unit length, see [`towards_unit_length`].
#[inline(always)]
pub(super) fn normalised<S: Scalar>([w, v]: [S; 2]) -> [S; 2] {
    let scale = towards_unit_length(w * w + v * v);
    [w * scale, v * scale]
}

/// 1 − cosine and sine of the whole angle.
#[inline(always)]
pub(super) fn less_and_sine<S: Scalar>([w, v]: [S; 2]) -> [S; 2] {
    let twice = v * (S::from_f64(2.0) / (w * w + v * v));
    [twice * v, twice * w]
}

/// Cosine and sine of the whole angle.
#[inline(always)]
pub(super) fn whole<S: Scalar>(half: [S; 2]) -> Vector2<S> {
    let [less, sine] = less_and_sine(half);
    Vector2::new(S::one() - less, sine)
}

/// How fast the angle θ (rad) grows whose half has the tangent θ/2, by which [`turned_on`] goes, while the body turns with the `rate`
/// ω (rad/s): θ̇ = ω·(1 + θ²/4).
#[inline(always)]
pub(super) fn angle_rate<S: Scalar>(angle: S, rate: S) -> S {
    rate * (S::one() + angle * angle * S::from_f64(0.25))
}

/// `base + weight·(to − from)`, number by number, of coordinates that have two each.
#[inline(always)]
pub(super) fn shifted<S: Scalar, const D: usize>(
    base: &[[S; 2]; D],
    from: &[[S; 2]; D],
    to: &[[S; 2]; D],
    weight: S,
) -> [[S; 2]; D] {
    let mut shifted = *base;
    for ((base, from), to) in shifted.iter_mut().zip(from).zip(to) {
        *base = [base[0] + (to[0] - from[0]) * weight, base[1] + (to[1] - from[1]) * weight];
    }
    shifted
}

/// Makes `kept` `next`, number by number where it is finite and `condition` > 0.
#[inline(always)]
pub(super) fn accept<S: Scalar, const D: usize>(condition: S, next: &[[S; 2]; D], kept: &mut [[S; 2]; D]) {
    for (kept, next) in kept.as_flattened_mut().iter_mut().zip(next.as_flattened()) {
        *kept = next.or_old(condition, *kept);
    }
}

/// 0 if all numbers are finite, else NaN.
#[inline(always)]
pub(super) fn finiteness_probe<S: Scalar, const D: usize>(pose: &[[S; 2]; D]) -> S {
    pose.as_flattened().iter().fold(S::zero(), |sum, x| sum + *x * S::zero())
}
