//! Sums of matrices of three, and products of them and of vectors, always inlined.
//!
//! The library's own are calls wherever the compiler's budget for inlining is used up. A call takes a controller longer than the
//! product, and lanes, whose instructions the library does not know of, many times as long. The sums have the library's order,
//! so that the bits are the same.

use nalgebra::{Matrix2, Matrix3};

use crate::{SMatrix, SVector, Scalar, Vector2, Vector3};

/// The columns of `m`.
#[inline(always)]
pub(crate) fn columns<S: Scalar>(m: &Matrix3<S>) -> [Vector3<S>; 3] {
    let [x, y, z]: [[S; 3]; 3] = m.data.0;
    [Vector3::from(x), Vector3::from(y), Vector3::from(z)]
}

/// `a` + `b`.
#[inline(always)]
pub(crate) fn sum<S: Scalar>(a: &Matrix3<S>, b: &Matrix3<S>) -> Matrix3<S> {
    let ([a, b, c], [d, e, f]) = (columns(a), columns(b));
    Matrix3::from_columns(&[a + d, b + e, c + f])
}

/// `a` − `b`.
#[inline(always)]
pub(crate) fn difference<S: Scalar>(a: &Matrix3<S>, b: &Matrix3<S>) -> Matrix3<S> {
    let ([a, b, c], [d, e, f]) = (columns(a), columns(b));
    Matrix3::from_columns(&[a - d, b - e, c - f])
}

/// −`m`.
#[inline(always)]
pub(crate) fn opposite<S: Scalar>(m: &Matrix3<S>) -> Matrix3<S> {
    mapped_entries(m, |entry| -entry)
}

/// `a` × `b`.
#[inline(always)]
pub(crate) fn cross<S: Scalar>(a: &Vector3<S>, b: &Vector3<S>) -> Vector3<S> {
    Vector3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

/// `a` · `b`.
#[inline(always)]
pub(crate) fn dot<S: Scalar>(a: &Vector3<S>, b: &Vector3<S>) -> S {
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// `m` · `v`.
#[inline(always)]
pub(crate) fn times<S: Scalar>(m: &Matrix3<S>, v: &Vector3<S>) -> Vector3<S> {
    let [x, y, z] = columns(m);
    let row = |x: S, y: S, z: S| x * v.x + y * v.y + z * v.z;
    Vector3::new(row(x.x, y.x, z.x), row(x.y, y.y, z.y), row(x.z, y.z, z.z))
}

/// Whether a number `S` is several, for which the library's products of matrices would be calls. One number keeps them, since they make
/// shorter code on a controller.
pub(crate) const fn is_wide<S>() -> bool {
    size_of::<S>() > size_of::<f64>()
}

/// `m` · `v` of any size.
#[inline(always)]
pub(crate) fn applied<S: Scalar, const R: usize, const C: usize>(
    m: &SMatrix<S, R, C>,
    v: &SVector<S, C>,
) -> SVector<S, R> {
    if !is_wide::<S>() {
        return m * v;
    }
    let mut sum = SVector::<S, R>::zeros();
    for (k, (column, x)) in m.data.0.iter().zip(&v.data.0[0]).enumerate() {
        for (sum, entry) in sum.data.0[0].iter_mut().zip(column) {
            let product = *entry * *x;
            *sum = if k == 0 { product } else { *sum + product };
        }
    }
    sum
}

/// `m`ᵀ · `v` in a plane.
#[inline(always)]
pub(crate) fn transposed_in_plane<S: Scalar>(m: &Matrix2<S>, v: &Vector2<S>) -> Vector2<S> {
    if !is_wide::<S>() {
        return m.tr_mul(v);
    }
    Vector2::new(m.m11 * v.x + m.m21 * v.y, m.m12 * v.x + m.m22 * v.y)
}

/// `a` · `b`ᵀ in a plane.
#[inline(always)]
pub(crate) fn outer_in_plane<S: Scalar>(a: &Vector2<S>, b: &Vector2<S>) -> Matrix2<S> {
    if !is_wide::<S>() {
        return a * b.transpose();
    }
    Matrix2::new(a.x * b.x, a.x * b.y, a.y * b.x, a.y * b.y)
}

/// `m`ᵀ · `v`.
#[inline(always)]
pub(crate) fn transposed_times<S: Scalar>(m: &Matrix3<S>, v: &Vector3<S>) -> Vector3<S> {
    let [x, y, z] = columns(m);
    Vector3::new(dot(&x, v), dot(&y, v), dot(&z, v))
}

/// `a` · `b`.
#[inline(always)]
pub(crate) fn product<S: Scalar>(a: &Matrix3<S>, b: &Matrix3<S>) -> Matrix3<S> {
    let [x, y, z] = columns(b);
    Matrix3::from_columns(&[times(a, &x), times(a, &y), times(a, &z)])
}

/// `a` · `b`ᵀ.
#[inline(always)]
pub(crate) fn outer<S: Scalar>(a: &Vector3<S>, b: &Vector3<S>) -> Matrix3<S> {
    Matrix3::from_columns(&[a * b.x, a * b.y, a * b.z])
}

/// `number` of each component.
#[inline(always)]
pub(crate) fn mapped<S: Copy, T: Scalar>(v: &Vector3<S>, number: impl Fn(S) -> T) -> Vector3<T> {
    let [x, y, z] = v.data.0[0];
    Vector3::from([number(x), number(y), number(z)])
}

/// `number` of each entry.
#[inline(always)]
pub(crate) fn mapped_entries<S: Scalar, T: Scalar>(m: &Matrix3<S>, number: impl Fn(S) -> T) -> Matrix3<T> {
    let [x, y, z] = columns(m);
    Matrix3::from_columns(&[mapped(&x, &number), mapped(&y, &number), mapped(&z, &number)])
}

#[cfg(test)]
mod tests {
    use super::{cross, dot, outer, product, times, transposed_times};
    use crate::Vector3;
    use nalgebra::Matrix3;

    #[test]
    fn the_bits_are_those_of_the_library() {
        let mut seed = 7u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (f64::from(seed) / 4_294_967_296.0 - 0.5) as f32
        };
        for _ in 0..if cfg!(miri) { 5 } else { 1000 } {
            let [a, b] = [(); 2].map(|()| Vector3::from_fn(|_, _| next()));
            let [m, n] = [(); 2].map(|()| Matrix3::from_fn(|_, _| next()));
            assert_eq!(cross(&a, &b), a.cross(&b));
            assert_eq!(dot(&a, &b), a.dot(&b));
            assert_eq!(times(&m, &a), m * a);
            assert_eq!(transposed_times(&m, &a), m.tr_mul(&a));
            assert_eq!(product(&m, &n), m * n);
            assert_eq!(outer(&a, &b), a * b.transpose());
        }
    }
}
