//! Vectors and small rigid displacements of several units at once.

use std::ops::{Add, Mul, Sub};

use crate::numeric::lanes::Lanes;

/// A vector of each of several units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector(pub [Lanes; 3]);

impl Vector {
    /// Zero.
    pub const ZERO: Self = Self([Lanes::ZERO; 3]);

    /// The same vector in every unit.
    #[inline(always)]
    pub fn splat(vector: [f64; 3]) -> Self {
        let [a, b, c] = vector;
        Self([Lanes::splat(a), Lanes::splat(b), Lanes::splat(c)])
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> Lanes {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        a * x + b * y + c * z
    }

    /// Scalar product with the same vector in every unit.
    #[inline(always)]
    pub fn along(self, [x, y, z]: [f64; 3]) -> Lanes {
        let [a, b, c] = self.0;
        a * x + b * y + c * z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    /// Length.
    #[inline(always)]
    pub fn norm(self) -> Lanes {
        self.dot(self).sqrt()
    }
}

impl Add for Vector {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a + x, b + y, c + z])
    }
}

impl Sub for Vector {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a - x, b - y, c - z])
    }
}

impl Mul<Lanes> for Vector {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: Lanes) -> Self {
        let [a, b, c] = self.0;
        Self([a * factor, b * factor, c * factor])
    }
}

/// A rigid displacement about a centre that is the same in every unit: P ↦ C + R(P − C) + t.
#[derive(Clone, Copy, Debug)]
pub struct Displacement {
    rows: [Vector; 3],
    centre: [f64; 3],
    shift: Vector,
}

impl Displacement {
    /// From t (m) and the Gibbs vector 2·tan(θ/2)·axis, which to second order is the rotation vector.
    ///
    /// R = ((1 − g²)·I + 2ggᵀ + 2g×)/(1 + g²) with half of it for g: exact, without trigonometry, and regular at no
    /// rotation, as the Euler angles of eq. 3 are not.
    #[inline(always)]
    pub fn new(components: &[Lanes; 6], centre: [f64; 3]) -> Self {
        let [x, y, z, a, b, c] = *components;
        let [a, b, c] = [a * 0.5, b * 0.5, c * 0.5];
        let (aa, bb, cc) = (a * a, b * b, c * c);
        let one = Lanes::splat(1.0);
        let scale = one / (one + aa + bb + cc);
        let double = scale * 2.0;
        let (ab, bc, ca) = (a * b, b * c, c * a);
        let rows = [
            Vector([(one + aa - bb - cc) * scale, (ab - c) * double, (ca + b) * double]),
            Vector([(ab + c) * double, (one - aa + bb - cc) * scale, (bc - a) * double]),
            Vector([(ca - b) * double, (bc + a) * double, (one - aa - bb + cc) * scale]),
        ];
        Self { rows, centre, shift: Vector([x, y, z]) }
    }

    /// In how many units it is not a number.
    pub fn undefined(&self) -> usize {
        let Vector([x, ..]) = self.shift;
        x.0.iter().filter(|x| x.is_nan()).count()
    }

    /// R·`vector`.
    #[inline(always)]
    pub fn turn(&self, vector: Vector) -> Vector {
        let [a, b, c] = self.rows;
        Vector([a.dot(vector), b.dot(vector), c.dot(vector)])
    }

    /// Where the point goes.
    #[inline(always)]
    pub fn apply(&self, point: Vector) -> Vector {
        let centre = Vector::splat(self.centre);
        self.turn(point - centre) + centre + self.shift
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_about_z() {
        // tan(45°) = 1, twice.
        let components = [0.1, 0.2, 0.3, 0.0, 0.0, 2.0].map(Lanes::splat);
        let displacement = Displacement::new(&components, [1.0, 0.0, 0.0]);
        let found = displacement.apply(Vector::splat([2.0, 0.0, 5.0]));
        for (found, expected) in found.0.iter().zip([1.1, 1.2, 5.3]) {
            assert!((found.0[3] - expected).abs() < 1e-15, "{found:?}");
        }
        assert_eq!(displacement.turn(Vector::ZERO), Vector::ZERO);
    }

    #[test]
    fn keeps_lengths_and_turns_by_the_rotation_vector() {
        let small = [0.0, 0.0, 0.0, 1e-3, -2e-3, 5e-4].map(Lanes::splat);
        let displacement = Displacement::new(&small, [0.0; 3]);
        let vector = Vector::splat([0.3, -0.7, 0.2]);
        let turned = displacement.turn(vector);
        assert!((turned.norm() - vector.norm()).0[0].abs() < 1e-15);
        let rotation = Vector([small[3], small[4], small[5]]);
        let second_order = vector + rotation.cross(vector) + rotation.cross(rotation.cross(vector)) * Lanes::splat(0.5);
        assert!((turned - second_order).norm().0[0] < 1e-8);
        assert!((vector.along([0.0, 1.0, 0.0]) - Lanes::splat(-0.7)).0[0].abs() < 1e-16);
    }
}
