//! A torsion spring with a damper, about what its link measures.

use super::{Law, Response, steady};
use crate::{SMatrix, SVector, Scalar, mechanism::Way};

/// φ = −stiffness·(x − rest) − damping·ẋ.
///
/// The link measures the angle up to whole turns. The spring counts them: it keeps the angle that it had, and the new one is the next to
/// it, less than half a turn away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring<S> {
    /// N·m/rad.
    pub stiffness: S,
    /// N·m·s/rad.
    pub damping: S,
    /// The angle (rad) at which it is relaxed.
    pub rest: S,
    /// The angle (rad) at which it starts, to within less than half a turn.
    pub start: S,
}

crate::cast::cast!([] [] Spring: Spring<f64> => T Spring<T> { stiffness, damping, rest, start });

/// The angle (rad) that is a whole number of turns from `measured` and less than half a turn from `last`; of up to a million turns.
#[inline(always)]
fn continued<S: Scalar>(measured: S, last: S) -> S {
    let (turn, per_turn) = (S::from_f64(core::f64::consts::TAU), S::from_f64(1.0 / core::f64::consts::TAU));
    // Adding 1.5·2²³ in f32, or 1.5·2⁵² in f64, leaves no digits behind the point.
    let is_double = S::one() + S::from_f64(1e-9);
    let rounding = is_double.select_gt(S::one(), S::from_f64(6_755_399_441_055_744.0), S::from_f64(12_582_912.0));
    let turns = ((last - measured) * per_turn + rounding) - rounding;
    measured + turns * turn
}

impl<S: Scalar> Law<S, 1> for Spring<S> {
    /// The angle (rad) with its whole turns.
    type Internal = S;

    const STICKS: bool = false;

    const PLACES: usize = 1;

    #[inline(always)]
    fn fresh(&self) -> S {
        self.start
    }

    #[inline(always)]
    fn response(
        &self,
        _: S,
        place: &SVector<S, 1>,
        rate: &SVector<S, 1>,
        last: &S,
        way: Way<S>,
    ) -> (Response<S, 1>, S) {
        let angle = continued(place.x, *last);
        let force = -(self.stiffness * (angle - self.rest) + self.damping * rate.x);
        let one = |x: S| SMatrix::<S, 1, 1>::new(x);
        (steady(SVector::<S, 1>::new(force), one(self.damping), one(self.stiffness)).moving(way.over, 1), angle)
    }

    #[inline(always)]
    fn remembered(place: &SVector<S, 1>, last: &S) -> S {
        continued(place.x, *last)
    }

    #[inline(always)]
    fn shifted(base: &S, from: &S, to: &S, weight: S) -> S {
        *base + (*to - *from) * weight
    }

    #[inline(always)]
    fn or_old(new: &S, condition: S, old: &S) -> S {
        new.or_old(condition, *old)
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{PI, TAU};

    use super::{Spring, continued};
    use crate::{
        Scalar, Vector2,
        integrator::{Extrapolated, ImplicitEuler, Integrator, Rodas3, Rodas4, RungeKutta4, Sdirk2, SemiImplicitEuler},
        kernel::Kernel,
        system::{
            Element, System,
            planar::{Coordinate, PlanarTree, Point, Rigid, Turning},
        },
    };

    /// How far the greatest and the last twist and their sum over time of two discs err, as a share of the greatest twist: the first disc is
    /// thrown so fast that the spring between them is wound by three and a half turns, while both go around.
    fn error<S: Scalar + PartialOrd, I: Integrator>(step: f64) -> f64 {
        [0.0, 0.5, 1.0, -2.5].map(|turns| error_from::<S, I>(step, turns)).into_iter().fold(0.0, f64::max)
    }

    /// The same where the first disc starts turned by so many `turns`, and the spring is relaxed there.
    fn error_from<S: Scalar + PartialOrd, I: Integrator>(step: f64, turns: f64) -> f64 {
        let s = S::from_f64;
        let disc = |k: usize| Rigid {
            mass: s(1.0),
            inertia: s([1e-3, 3e-3][k]),
            centre: Point::fixed(Vector2::new(s(k as f64), s(0.0))).on(k, &Coordinate::Turn),
        };
        let tree = PlanarTree::new([Coordinate::Turn; 2], &[disc(0), disc(1)], Vector2::zeros()).unwrap();
        let spring = Element::<_, _, 1> {
            link: Turning { body: Some(0), against: Some(1) },
            law: Spring { stiffness: s(0.03), damping: s(0.0), rest: s(turns * TAU), start: s(turns * TAU) },
        };
        let kernel = Kernel::<S, _, I>::new(System::new(tree, spring), s(step)).unwrap();
        let mut state = kernel.at_rest::<2>([[libm::cos(turns * PI), libm::sin(turns * PI)].map(s), [s(1.0), s(0.0)]]);
        let (twist, reduced) = (3.5 * TAU, 1e-3 * 3e-3 / 4e-3);
        let rate = libm::sqrt(0.03 / reduced);
        state.motion.velocity[0] = s(twist * rate);
        let mut worst = 0.0f64;
        while f64::from(state.steps) * step < 2.0 * TAU / rate {
            let _ = kernel.step(&mut state);
            let t = f64::from(state.steps) * step;
            let [first, second] = [0, 1].map(|k| state.motion.velocity[k].to_f64());
            let momentum = 1e-3 * first + 3e-3 * second;
            worst = worst.max(libm::fabs(momentum / (1e-3 * twist * rate) - 1.0));
            worst = worst.max(libm::fabs((first - second) / (twist * rate) - libm::cos(rate * t)));
            worst = worst.max(libm::fabs((state.motion.internal.to_f64() - turns * TAU) / twist - libm::sin(rate * t)));
        }
        worst
    }

    #[test]
    #[cfg_attr(miri, ignore = "an interpreter has no time for so many steps")]
    fn a_spring_is_wound_by_several_turns_in_every_scheme() {
        for (name, found, most) in [
            (Rodas4::NAME, error::<f64, Rodas4>(1e-3), 1e-6),
            (Rodas3::NAME, error::<f64, Rodas3>(1e-3), 1e-4),
            (RungeKutta4::NAME, error::<f64, RungeKutta4>(1e-3), 1e-6),
            (SemiImplicitEuler::NAME, error::<f64, SemiImplicitEuler>(1e-4), 1e-2),
            (Sdirk2::<4>::NAME, error::<f64, Sdirk2<4>>(1e-3), 1e-3),
            (ImplicitEuler::<4>::NAME, error::<f64, ImplicitEuler<4>>(2e-5), 1e-2),
            (Extrapolated::<3, 4>::NAME, error::<f64, Extrapolated<3, 4>>(1e-3), 1e-3),
            ("rodas4 in f32", error::<f32, Rodas4>(1e-3), 1e-4),
            ("sdirk2 in f32", error::<f32, Sdirk2<4>>(1e-3), 1e-3),
        ] {
            assert!(found < most, "{name}: {found:e}");
        }
    }

    #[test]
    fn an_angle_goes_on_from_turn_to_turn() {
        for last in [0.0, 3.0, -3.1, 100.0, -7.5 * TAU, 1e5] {
            for by in [-0.99 * PI, -1.0, 0.0, 1e-3, 0.99 * PI] {
                let angle: f64 = last + by;
                let measured = angle - TAU * libm::round(angle / TAU);
                assert!((continued(measured, last) - angle).abs() < 1e-10, "{last} {by}");
                let single = continued(measured as f32, last as f32);
                assert!((f64::from(single) - angle).abs() < 2e-7 * angle.abs().max(PI), "{last} {by}: {single}");
            }
        }
    }
}
