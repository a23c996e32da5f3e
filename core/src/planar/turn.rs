//! Turning in the plane, and forces at a lever.

use nalgebra::{Matrix3, Vector2, Vector3};

use crate::Scalar;

/// Rᵀ − I by its diagonal and the sine: what carries a frame vector into the body, less the vector itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct Turn<S> {
    less: S,
    sine: S,
}

impl<S: Scalar> Turn<S> {
    #[inline(always)]
    pub fn of([w, v]: [S; 2]) -> Self {
        let twice = v * (S::from_f64(2.0) / (w * w + v * v));
        Self { less: twice * v, sine: twice * w }
    }

    #[inline(always)]
    pub fn change(&self, p: Vector2<S>) -> Vector2<S> {
        Vector2::new(-self.less * p.x - self.sine * p.y, self.sine * p.x - self.less * p.y)
    }

    #[inline(always)]
    pub fn to_body(self, p: Vector2<S>) -> Vector2<S> {
        p + self.change(p)
    }

    #[inline(always)]
    pub fn to_frame(self, p: Vector2<S>) -> Vector2<S> {
        p + Self { sine: -self.sine, ..self }.change(p)
    }
}

/// y × `p`.
#[inline(always)]
pub(super) fn turned<S: Scalar>(p: Vector2<S>) -> Vector2<S> {
    Vector2::new(p.y, -p.x)
}

/// Force and torque of the force `f` at `lever`.
#[inline(always)]
pub(super) fn at<S: Scalar>(lever: Vector2<S>, f: Vector2<S>) -> Vector3<S> {
    Vector3::new(f.x, f.y, turned(lever).dot(&f))
}

/// The derivatives by v and ω of a quantity that depends on the velocity v + ω·y × `lever` of a point: `x` and `z` are its
/// derivatives by the two parts of that velocity.
#[inline(always)]
pub(super) fn spread<S: Scalar>(lever: Vector2<S>, [x, z]: [Vector3<S>; 2]) -> Matrix3<S> {
    let arm = turned(lever);
    Matrix3::from_columns(&[x, z, x * arm.x + z * arm.y])
}
