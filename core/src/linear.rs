//! The 6 × 6 solve of one free body, in 3 × 3 blocks.

use nalgebra::Matrix3;

use crate::{
    Scalar, Vector2, Vector3,
    product::{columns, cross, dot, mapped_entries, product, times},
};

/// [[a, b], [c, d]]: forces and torques by velocities and angular velocities.
#[derive(Clone, Copy, Debug)]
pub struct Blocks<S> {
    pub a: Matrix3<S>,
    pub b: Matrix3<S>,
    pub c: Matrix3<S>,
    pub d: Matrix3<S>,
}

/// The inverse of a 3 × 3 matrix by its adjugate: straight-line, one division. Not finite for a singular matrix.
#[inline(always)]
pub(crate) fn inverse<S: Scalar>(m: &Matrix3<S>) -> Matrix3<S> {
    let [[xx, yx, zx], [xy, yy, zy], [xz, yz, zz]]: [[S; 3]; 3] = m.data.0;
    let (r0, r1, r2) = (Vector3::new(xx, xy, xz), Vector3::new(yx, yy, yz), Vector3::new(zx, zy, zz));
    let (c0, c1, c2) = (cross(&r1, &r2), cross(&r2, &r0), cross(&r0, &r1));
    let scale = S::one() / dot(&r0, &c0);
    Matrix3::from_columns(&[c0 * scale, c1 * scale, c2 * scale])
}

/// The length (m) of `apart` and its reciprocal (1/m), which stays finite where there is no length.
#[inline(always)]
pub(crate) fn length<S: Scalar>(apart: &Vector2<S>) -> [S; 2] {
    let squared = apart.dot(apart);
    let reciprocal = squared.max_of(S::from_f64(1e-30)).rsqrt();
    [squared * reciprocal, reciprocal]
}

/// The length (m) of `apart`, and how fast (m/s) it grows at this `rate`: where there is no length at once, by the sum of both parts, which
/// is no less than the length of the rate.
#[inline(always)]
pub(crate) fn growing<S: Scalar>(apart: &Vector2<S>, rate: &Vector2<S>) -> [S; 2] {
    let [length, reciprocal] = length(apart);
    let at_once = rate.x.max_of(-rate.x) + rate.y.max_of(-rate.y);
    [length, length.select_gt(S::from_f64(1e-12), apart.dot(rate) * reciprocal, at_once)]
}

/// [a]×, the matrix with [a]×·b = a × b.
#[inline(always)]
pub(crate) fn cross_matrix<S: Scalar>(a: &Vector3<S>) -> Matrix3<S> {
    let o = S::zero();
    Matrix3::new(o, -a.z, a.y, a.z, o, -a.x, -a.y, a.x, o)
}

/// [a]×·`m`: the cross products of a with the columns.
#[inline(always)]
pub(crate) fn cross_columns<S: Scalar>(a: &Vector3<S>, m: &Matrix3<S>) -> Matrix3<S> {
    let [x, y, z] = columns(m);
    Matrix3::from_columns(&[cross(a, &x), cross(a, &y), cross(a, &z)])
}

/// −`m`·[a]×: the cross products of a with the rows.
#[inline(always)]
pub(crate) fn cross_rows<S: Scalar>(a: &Vector3<S>, m: &Matrix3<S>) -> Matrix3<S> {
    let [x, y, z] = columns(m);
    Matrix3::from_columns(&[z * a.y - y * a.z, x * a.z - z * a.x, y * a.x - x * a.y])
}

/// [b]×·[a]× of the `outer` product a·bᵀ, or a sum of such products: a·bᵀ − (a·b)·1.
#[inline(always)]
pub(crate) fn twice_crossed<S: Scalar>(outer: &Matrix3<S>) -> Matrix3<S> {
    let [[xx, yx, zx], [xy, yy, zy], [xz, yz, zz]]: [[S; 3]; 3] = outer.data.0;
    let trace = xx + yy + zz;
    Matrix3::new(xx - trace, xy, xz, yx, yy - trace, yz, zx, zy, zz - trace)
}

impl<S: Scalar> Blocks<S> {
    /// All zero but for the diagonal.
    #[inline(always)]
    pub fn diagonal(a: Vector3<S>, d: Vector3<S>) -> Self {
        let zero = Matrix3::zeros();
        Self { a: Matrix3::from_diagonal(&a), b: zero, c: zero, d: Matrix3::from_diagonal(&d) }
    }

    /// Adds the Jacobian of a damper at a point of the body: its force −`matrix`·(v + ω × `lever`) acts at `lever`, from the
    /// centre of mass, and also exerts a torque. The blocks are minus the derivatives of force and torque by v and ω.
    #[inline(always)]
    pub fn add_at(&mut self, lever: &Vector3<S>, matrix: &Matrix3<S>) {
        let turned = cross_columns(lever, matrix);
        self.a += matrix;
        self.b += cross_rows(lever, matrix);
        self.c += turned;
        self.d += cross_rows(lever, &turned);
    }

    /// `self`·(x, y).
    #[inline(always)]
    pub fn times(&self, x: Vector3<S>, y: Vector3<S>) -> (Vector3<S>, Vector3<S>) {
        (times(&self.a, &x) + times(&self.b, &y), times(&self.c, &x) + times(&self.d, &y))
    }

    /// `self` + `weight`·`other`.
    #[inline(always)]
    pub fn plus(&self, other: &Self, weight: S) -> Self {
        Self {
            a: self.a + other.a * weight,
            b: self.b + other.b * weight,
            c: self.c + other.c * weight,
            d: self.d + other.d * weight,
        }
    }

    /// The same in numbers of another type.
    #[inline(always)]
    pub fn cast<T: Scalar>(&self, number: impl Fn(S) -> T) -> Blocks<T> {
        let block = |m| mapped_entries(m, &number);
        Blocks { a: block(&self.a), b: block(&self.b), c: block(&self.c), d: block(&self.d) }
    }

    /// What solving takes. Eliminates x; no pivoting is needed, because the diagonal blocks carry mass and inertia plus
    /// positive contact terms.
    #[inline(always)]
    pub fn factorised(&self) -> Factors<S> {
        let inverse_a = inverse(&self.a);
        let c_over_a = product(&self.c, &inverse_a);
        Factors { inverse_a, b: self.b, c_over_a, inverse_rest: inverse(&(self.d - product(&c_over_a, &self.b))) }
    }
}

/// [`Blocks`] made ready for solving.
#[derive(Clone, Copy, Debug)]
pub struct Factors<S> {
    pub inverse_a: Matrix3<S>,
    pub b: Matrix3<S>,
    pub c_over_a: Matrix3<S>,
    /// Of d − c·a⁻¹·b, what is left for y.
    pub inverse_rest: Matrix3<S>,
}

impl<S: Scalar> Factors<S> {
    /// The solution of blocks·(x, y) = (`f`, `g`).
    #[inline(always)]
    pub fn solve(&self, f: Vector3<S>, g: Vector3<S>) -> (Vector3<S>, Vector3<S>) {
        let y = times(&self.inverse_rest, &(g - times(&self.c_over_a, &f)));
        (times(&self.inverse_a, &(f - times(&self.b, &y))), y)
    }
}

#[cfg(test)]
mod tests {
    use super::{Blocks, cross_columns, cross_matrix, twice_crossed};
    use crate::{Vector3, product::outer};
    use nalgebra::{Matrix3, SMatrix, SVector};

    #[test]
    fn crossed_twice_is_the_product_of_two_cross_matrices() {
        let (a, b) = (Vector3::new(0.3, -1.2, 2.0), Vector3::new(1.5, 0.4, -0.7));
        let found = twice_crossed(&outer(&a, &b));
        assert!((found - cross_columns(&b, &cross_matrix(&a))).norm() < 1e-15, "{found}");
    }

    #[test]
    fn agrees_with_nalgebra() {
        let mut seed = 1u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed) / 4_294_967_296.0 - 0.5
        };
        for _ in 0..if cfg!(miri) { 5 } else { 100 } {
            let m = SMatrix::<f64, 6, 6>::from_fn(|i, j| next() + if i == j { 3.0 } else { 0.0 });
            let r = SVector::<f64, 6>::from_fn(|_, _| next());
            let block = |i, j| -> Matrix3<f64> { m.fixed_view::<3, 3>(i, j).into_owned() };
            let blocks = Blocks { a: block(0, 0), b: block(0, 3), c: block(3, 0), d: block(3, 3) };
            let (x, y) = blocks.factorised().solve(Vector3::new(r[0], r[1], r[2]), Vector3::new(r[3], r[4], r[5]));
            let back = m * SVector::<f64, 6>::new(x.x, x.y, x.z, y.x, y.y, y.z) - r;
            assert!(back.norm() < 1e-13, "{back}");
        }
    }
}
