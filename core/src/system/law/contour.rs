//! Walls that are not parallel to the travel, or not straight.

use super::{Axis, Contact, Law, Pad, Response, Wall, along, steady};
use crate::{
    SMatrix, SVector, Scalar,
    law::{Friction, Normal},
    mechanism::Way,
};

/// How far a wall stands out from its nominal line at a distance t along it (m): slope·t + curvature·t²/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contour<S> {
    /// Slope where t = 0; positive where the gap narrows along the wall.
    pub slope: S,
    /// Curvature (1/m); positive where the slope grows along the wall.
    pub curvature: S,
}

crate::cast::cast!([] [] Contour: Contour<f64> => T Contour<T> { slope, curvature });

impl<S: Scalar> Contour<S> {
    /// How far (m) the wall stands out at `t` (m).
    #[inline(always)]
    pub fn height(&self, t: S) -> S {
        (self.slope + S::from_f64(0.5) * self.curvature * t) * t
    }

    /// Its slope there.
    #[inline(always)]
    pub fn slope_at(&self, t: S) -> S {
        self.slope + self.curvature * t
    }
}

/// A `wall` with a contour: its gap at a distance t along it is the wall's own less the contour's height, its normal is the contour's.
///
/// Penetration and sliding are measured along the axes of the nominal wall, so that the normal force is the gradient of an energy and
/// friction does work on what slides. They are longer than those along the contour's own normal and tangent by half the slope squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contoured<S, W> {
    /// The nominal wall.
    pub wall: W,
    /// Which of its axes the contour is along, of a wall in space.
    pub along: Axis,
    /// The contour.
    pub contour: Contour<S>,
}

crate::cast::cast!([W] [] Contoured: Contoured<f64, W> => T Contoured<T, W::Of<T>> { wall, contour; along });

/// The numbers that forces change with: distances from and along the wall, their rates, and the rate along the other tangent.
const NUMBERS: usize = 5;

/// Forces along normal, contour and the other tangent, each with its derivatives by the [`NUMBERS`].
type Forces<S> = [(S, SVector<S, NUMBERS>); 3];

impl<S: Scalar> Contour<S> {
    /// What a wall with this contour and `gap` (m) does to a point at the `place` from and along it, with its rates along normal, contour
    /// and the other tangent.
    #[inline(always)]
    fn forces<N: Normal<S>, F: Friction<S>>(
        &self,
        contact: &Contact<N, F>,
        internal: &F::Internal,
        way: Way<S>,
        (gap, [n, t], [u, v, w]): (S, [S; 2], [S; 3]),
    ) -> (Forces<S>, F::Internal) {
        let one = S::one();
        let slope = self.slope_at(t);
        let depth = (self.height(t) - (gap + n), along::<S, NUMBERS>(0, -one) + along(1, slope));
        let approach = (slope * v - u, along(2, -one) + along(3, slope) + along(1, self.curvature * v));
        let sliding = (v + slope * u, along(3, one) + along(2, slope) + along(1, self.curvature * u));
        let touch = contact.touch(internal, way, [depth, approach], [sliding, (w, along(4, one))]);
        let (push, by_push) = (touch.force, touch.force_slope);
        let [rub, aside] = touch.traction;
        let [by_rub, by_aside] = touch.traction_slopes;
        let forces = [
            (push + slope * rub, by_push + by_rub * slope + along(1, self.curvature * rub)),
            (rub - slope * push, by_rub - by_push * slope - along(1, self.curvature * push)),
            (aside, by_aside),
        ];
        (forces, touch.internal)
    }
}

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Law<S, 2> for Contoured<S, Pad<S, N, F>> {
    type Internal = F::Internal;

    const STICKS: bool = F::STICKS;

    const PLACES: usize = 2;

    #[inline(always)]
    fn fresh(&self) -> F::Internal {
        F::fresh()
    }

    #[inline(always)]
    fn gap(&self, place: &SVector<S, 2>) -> S {
        self.wall.gap + place[0] - self.contour.height(place[1])
    }

    #[inline(always)]
    fn each_gap(&self, place: &SVector<S, 2>, rate: &SVector<S, 2>, mut see: impl FnMut(S, S)) {
        see(self.gap(place), rate[0] - self.contour.slope_at(place[1]) * rate[1]);
    }

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 2>,
        rate: &SVector<S, 2>,
        internal: &F::Internal,
        way: Way<S>,
    ) -> (Response<S, 2>, F::Internal) {
        let at = (self.wall.gap, [place[0], place[1]], [rate[0], rate[1], S::zero()]);
        let ([(push, p), (rub, r), _], internal) = self.contour.forces(&self.wall.contact, internal, way, at);
        let response = steady(
            SVector::<S, 2>::new(push, rub),
            SMatrix::<S, 2, 2>::new(-p[2], -p[3], -r[2], -r[3]),
            SMatrix::<S, 2, 2>::new(-p[0], -p[1], -r[0], -r[1]),
        );
        (response.moving(way.over, 2), internal)
    }

    #[inline(always)]
    fn shifted(base: &F::Internal, from: &F::Internal, to: &F::Internal, weight: S) -> F::Internal {
        F::shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn or_old(new: &F::Internal, condition: S, old: &F::Internal) -> F::Internal {
        F::or_old(new, condition, old)
    }
}

impl<S, N, F> Contoured<S, Wall<S, N, F>> {
    /// Which number is along the normal, which along the contour and which along the other tangent.
    #[inline(always)]
    fn axes(&self) -> [usize; 3] {
        let normal = self.wall.axis.of([0, 1, 2]);
        let along = self.along.of([0, 1, 2]);
        [normal, along, 3 - normal - along]
    }
}

impl<S: Scalar, N: Normal<S>, F: Friction<S>> Law<S, 3> for Contoured<S, Wall<S, N, F>> {
    type Internal = F::Internal;

    const STICKS: bool = F::STICKS;

    const PLACES: usize = 3;

    #[inline(always)]
    fn fresh(&self) -> F::Internal {
        F::fresh()
    }

    #[inline(always)]
    fn gap(&self, place: &SVector<S, 3>) -> S {
        self.wall.gap(place) - self.contour.height(self.along.of(place.data.0[0]))
    }

    #[inline(always)]
    fn each_gap(&self, place: &SVector<S, 3>, rate: &SVector<S, 3>, mut see: impl FnMut(S, S)) {
        let slope = self.contour.slope_at(self.along.of(place.data.0[0]));
        let [normal, along] = [self.wall.axis, self.along].map(|axis| axis.of(rate.data.0[0]));
        see(self.gap(place), self.wall.sign * normal - slope * along);
    }

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 3>,
        rate: &SVector<S, 3>,
        internal: &F::Internal,
        way: Way<S>,
    ) -> (Response<S, 3>, F::Internal) {
        let axes = self.axes();
        let sign = self.wall.sign;
        let [n, t, _] = axes.map(|axis| place[axis]);
        let [u, v, w] = axes.map(|axis| rate[axis]);
        let at = (self.wall.gap, [sign * n, t], [sign * u, v, w]);
        let (forces, internal) = self.contour.forces(&self.wall.contact, internal, way, at);
        let signs = [sign, S::one(), S::one()];
        let mut force = SVector::<S, 3>::zeros();
        let (mut impedance, mut stiffness) = (SMatrix::<S, 3, 3>::zeros(), SMatrix::<S, 3, 3>::zeros());
        for ((row, sign), (value, by)) in axes.into_iter().zip(signs).zip(forces) {
            force[row] = sign * value;
            for (k, (column, other)) in axes.into_iter().zip(signs).enumerate() {
                impedance[(row, column)] = -(sign * other * by[2 + k]);
                if k < 2 {
                    stiffness[(row, column)] = -(sign * other * by[k]);
                }
            }
        }
        (steady(force, impedance, stiffness).moving(way.over, 3), internal)
    }

    #[inline(always)]
    fn shifted(base: &F::Internal, from: &F::Internal, to: &F::Internal, weight: S) -> F::Internal {
        F::shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn or_old(new: &F::Internal, condition: S, old: &F::Internal) -> F::Internal {
        F::or_old(new, condition, old)
    }
}

#[cfg(test)]
mod tests {
    use super::{Axis, Contour, Contoured};
    use crate::{
        SVector, Vector3,
        law::{Impact, Linear, Regularised},
        mechanism::Way,
        system::law::{Contact, Law, Pad, Wall},
    };

    fn contact() -> Contact<Impact<f64, Linear<f64>>, Regularised<f64>> {
        let normal = Impact::new(Linear::new(1e4).unwrap(), 0.0, 1e-3).unwrap();
        Contact { normal, friction: Regularised::new(0.3, 1e-4).unwrap() }
    }

    fn force<W: Law<f64, R, Internal = ()>, const R: usize>(
        wall: &W,
        place: [f64; R],
        rate: [f64; R],
    ) -> SVector<f64, R> {
        let way = Way { over: None, mass_rate: 1.0, tangent_share: 1.0 };
        wall.response(0.0, &place.into(), &rate.into(), &(), way).0.force
    }

    #[test]
    fn a_flat_contour_is_the_wall() {
        let pad = Pad { gap: 1e-4, contact: contact() };
        let flat = Contoured { wall: pad, along: Axis::Y, contour: Contour { slope: 0.0, curvature: 0.0 } };
        let (place, rate) = ([-2e-4, 0.3], [0.01, 0.2]);
        assert_eq!(force(&flat, place, rate), force(&pad, place, rate));
        let wall = Wall { axis: Axis::Z, sign: -1.0, gap: 1e-4, contact: contact() };
        let flat = Contoured { wall, along: Axis::X, contour: Contour { slope: 0.0, curvature: 0.0 } };
        let (place, rate) = ([0.3, -0.2, 2e-4], [0.2, -0.1, -0.01]);
        let [one, other] = [force(&flat, place, rate), force(&wall, place, rate)];
        assert!((one - other).norm() < 1e-15, "{one} {other}");
    }

    #[test]
    fn the_force_is_along_the_contours_normal_and_friction_along_the_contour() {
        // At t = 0.5 m the wall stands out by 0.02·0.5 + 0.04·0.25/2 = 0.015 m, with a slope of 0.04.
        let contour = Contour { slope: 0.02, curvature: 0.04 };
        let pad = Pad { gap: 1e-3, contact: contact() };
        let wall = Contoured { wall: pad, along: Axis::Y, contour };
        let place = [0.0135, 0.5];
        assert!(libm::fabs(Law::<f64, 2>::gap(&wall, &place.into()) + 5e-4) < 1e-15);
        let [at_rest, sliding] = [[0.0; 2], [0.0, 0.1]].map(|rate| force(&wall, place, rate));
        assert!((at_rest - SVector::<f64, 2>::new(5.0, -0.2)).norm() < 1e-11, "{at_rest}");
        let rub = sliding - at_rest;
        // Undamped, so that only friction is added: 0.3·5 N against the motion.
        assert!((rub - SVector::<f64, 2>::new(-0.06, -1.5)).norm() < 1e-11, "{rub}");
    }

    #[test]
    fn a_wall_in_space_is_the_one_in_the_plane() {
        let contour = Contour { slope: -0.03, curvature: 0.2 };
        let pad = Contoured { wall: Pad { gap: 1e-4, contact: contact() }, along: Axis::Y, contour };
        let (place, rate) = ([-3e-4, 0.01], [0.02, 0.1]);
        let planar = force(&pad, place, rate);
        for (axis, along, sign) in
            [(Axis::X, Axis::Z, 1.0), (Axis::X, Axis::Z, -1.0), (Axis::Y, Axis::Z, -1.0), (Axis::Z, Axis::X, 1.0)]
        {
            let wall = Contoured { wall: Wall { axis, sign, gap: 1e-4, contact: contact() }, along, contour };
            let [normal, tangent] = [axis, along].map(|axis| Vector3::from(axis.unit()));
            let in_space = |[n, t]: [f64; 2]| <[f64; 3]>::from(normal * (sign * n) + tangent * t);
            let found = force(&wall, in_space(place), in_space(rate));
            let expected = normal * (sign * planar.x) + tangent * planar.y;
            assert!((found - expected).norm() < 1e-12, "{axis:?} {along:?} {sign}: {found}");
        }
    }
}
