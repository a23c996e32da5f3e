//! Error control: steps as long as their own error estimates allow, the truth that fixed steps are measured against.
//!
//! The steps are those of the kernel's schemes, so that no law is written twice; only their length changes. Between the
//! ends of steps velocities and positions are cubics whose slopes the scheme tells. Deterministic: the same scene and
//! tolerance give the same bits.

use std::ops::ControlFlow;

use slipfit_core::{
    SVector,
    integrator::{Dense, MotionOf, Step, StepOf},
    mechanism::Mechanism,
};
use slipfit_system::interrupt;

use crate::{
    closing::{self, Gaps},
    step_control::StepControl,
};

pub use crate::step_control::{CHANGES, Effort, FIRST_STEP, GREATEST_STEP, SAFETY, Stopped};

/// How well each step has to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Error of the drive force that a step may make (N).
    pub force: f64,
    /// Error of a position that a step may make (m).
    pub position: f64,
}

impl Tolerance {
    /// `force` (N), and what [`PLACE`] allows with it.
    pub fn of_force(force: f64) -> Self {
        Self { force, position: force * PLACE }
    }
}

/// What turns an error of momentum into one of force and position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensitivity {
    /// Mass (kg).
    pub mass: f64,
    /// Gain of the drive (N·s/m).
    pub gain: f64,
}

/// What is kept of a motion: some numbers that change smoothly.
pub trait Values: Copy {
    /// The rates that a scheme gives at an end of a step, such as accelerations.
    type Rates: Copy;

    /// How fast they change (1/s), number by number, at these `rates`.
    fn slope(&self, rates: &Self::Rates) -> Self;

    /// The same where the scheme gives no rates: a `guess`, except for numbers whose rates are kept with them.
    fn known_slope(&self, guess: Self) -> Self {
        guess
    }

    /// Number by number, what `by` makes of the values in `of`.
    fn combined<const N: usize>(of: [&Self; N], by: impl Fn([f64; N]) -> f64) -> Self;
}

impl<const K: usize> Values for [f64; K] {
    type Rates = Self;

    fn slope(&self, rates: &Self) -> Self {
        *rates
    }

    #[inline]
    fn combined<const N: usize>(of: [&Self; N], by: impl Fn([f64; N]) -> f64) -> Self {
        std::array::from_fn(|k| by(of.map(|values| values[k])))
    }
}

/// The end of an accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot<V: Values> {
    /// Time (s).
    pub t: f64,
    /// What is kept of the motion.
    pub values: V,
    /// Rates at the start and at the end of the step, if its scheme knows them; see [`Values::slope`].
    pub rates: Option<[V::Rates; 2]>,
}

impl Sensitivity {
    /// The error of a `step` of `length` (s), of which `tolerance` allows 1.
    pub fn error<P, R, const D: usize>(&self, tolerance: Tolerance, step: &Step<f64, P, R, D>, length: f64) -> f64 {
        // What Newton left counts like an error of the scheme: without it, a stage that has not converged would pass.
        let velocity_error = greater(step.error, step.residual) / self.mass;
        let place_error = greater(step.drift, step.residual * length) / self.mass;
        greater(self.gain * velocity_error / tolerance.force, place_error / tolerance.position)
    }
}

/// The greater of two, NaN if one of them is: what is not a number must not pass as a small error.
pub fn greater(one: f64, other: f64) -> f64 {
    if one > other || one.is_nan() { one } else { other }
}

/// Error of place (m) allowed with 1 N of error of force: 3 nm for each 0.1 mN. Errors of place last, and between tight contacts
/// they cost more force later than those of velocity do now.
pub const PLACE: f64 = 3e-5;

/// Steps between two looks at whether somebody asked to stop.
pub(crate) const STEPS_PER_LOOK: u32 = 256;

/// The accelerations (m/s², rad/s²) at the start and the end of a step; see [`Dense`].
pub type Accelerations<const D: usize> = [SVector<f64, D>; 2];

/// How the contacts of a mechanism are watched, so that no step passes one over.
pub struct Watched<'a, F> {
    /// Fills in the contacts at a motion, always in the same order.
    pub gaps: F,
    /// How deep (m) a contact may be that a step passes over.
    pub depth: f64,
    /// Ascending times (s) at which what is commanded bends: no step passes over one.
    pub bends: &'a [f64],
}

/// Integrates `mechanism` from `start` at time 0 over `duration` (s) or until `accept` breaks, which sees the start and the
/// motion at the end of each accepted step, with the step's accelerations, and the contacts there. A step is accepted if `error`,
/// which also sees its length (s), is at most 1, and if no contact begins to act in it (see [`closing`]).
///
/// # Errors
/// See [`Stopped`].
pub fn integrate<I: Dense, M: Mechanism<f64, D>, const D: usize>(
    mechanism: &M,
    start: MotionOf<f64, M, D>,
    duration: f64,
    error: impl Fn(&StepOf<f64, M, D>, f64) -> f64,
    watched: Watched<impl Fn(&MotionOf<f64, M, D>, &mut Gaps)>,
    mut accept: impl FnMut(f64, &MotionOf<f64, M, D>, Option<Accelerations<D>>, &Gaps) -> ControlFlow<()>,
) -> Result<Effort, Stopped> {
    let (mut step_control, mut motion) = (StepControl::default(), start);
    let differentiated = |t: f64, motion: &MotionOf<f64, M, D>| {
        mechanism.differentiated(t, &motion.pose, &motion.internal, &motion.velocity)
    };
    let [mut before, mut after] = [Gaps::default(), Gaps::default()];
    (watched.gaps)(&motion, &mut before);
    // First `accept`: a controller that samples there changes what acts from then on.
    let mut flow = accept(step_control.t, &motion, None, &before);
    let mut at_start = differentiated(step_control.t, &motion);
    while step_control.t < duration && flow.is_continue() {
        if step_control.tried().is_multiple_of(STEPS_PER_LOOK) && interrupt::requested() {
            return Err(Stopped::Interrupted);
        }
        let t = step_control.t;
        let (length, limit) = step_control.next(duration, watched.bends);
        let (step, accelerations) = I::dense_step(mechanism, t, length, &motion, &at_start);
        // A step that leaves the finite range is the worst of all: stages deep in a contact that the derivatives at the step's start do
        // not know overflow.
        let probe = mechanism.finiteness_probe(&step.motion.pose) + step.motion.velocity.sum() * 0.0;
        if !step_control.accepts_error(error(&step, length) + probe, length, I::ORDER)? {
            continue;
        }
        (watched.gaps)(&step.motion, &mut after);
        if step_control.shortens(closing::between(&before, &after, length, watched.depth), length) {
            continue;
        }
        std::mem::swap(&mut before, &mut after);
        step_control.accept(length, limit, before.until_pushed(watched.depth));
        motion = step.motion;
        flow = accept(step_control.t, &motion, Some(accelerations), &before);
        at_start = differentiated(step_control.t, &motion);
    }
    Ok(step_control.effort)
}

/// The values of [`Knot`] at ascending `times` (s) within the `knots`, of which there are at least two.
pub fn sampled<V: Values>(knots: &[Knot<V>], times: impl Iterator<Item = f64>) -> Vec<V> {
    let mut i = 0;
    let mut cubics = Cubics::of(knots, i);
    times
        .map(|t| {
            let before = i;
            while i + 2 < knots.len() && knots[i + 1].t < t {
                i += 1;
            }
            if i != before {
                cubics = Cubics::of(knots, i);
            }
            cubics.at(t)
        })
        .collect()
}

/// The values between two knots: a cubic each, by the values and slopes at both.
pub struct Cubics<V> {
    from: f64,
    length: f64,
    start: V,
    end: V,
    /// Slopes over the whole length.
    start_slope: V,
    end_slope: V,
}

impl<V: Values> Cubics<V> {
    /// Between the knots `i` and `i + 1`.
    pub fn of(knots: &[Knot<V>], i: usize) -> Self {
        let (from, to) = (&knots[i], &knots[i + 1]);
        let length = to.t - from.t;
        let slopes = match to.rates {
            Some([start, end]) => [from.values.slope(&start), to.values.slope(&end)],
            None => Self::guessed(knots, i),
        };
        let [start_slope, end_slope] = slopes.map(|slope| V::combined([&slope], |[slope]| slope * length));
        Self { from: from.t, length, start: from.values, end: to.values, start_slope, end_slope }
    }

    /// Slopes between the knots `i` and `i + 1`, by those next to them.
    fn guessed(knots: &[Knot<V>], i: usize) -> [V; 2] {
        let chord = |j: usize| {
            let (from, to) = (&knots[j], &knots[j + 1]);
            let length = to.t - from.t;
            (length, V::combined([&from.values, &to.values], |[from, to]| (to - from) / length))
        };
        let (length, own) = chord(i);
        let before = i.checked_sub(1).map(chord);
        let after = (i + 2 < knots.len()).then(|| chord(i + 1));
        let at = |values: V, other: Option<(f64, V)>, further: Option<(f64, V)>| {
            let [beside, beyond] = [&other, &further].map(|one| one.as_ref().map_or(&own, |(_, chord)| chord));
            values.known_slope(V::combined([&own, beside, beyond], |[own, beside, beyond]| {
                slope(
                    (length, own),
                    other.map(|(length, _)| (length, beside)),
                    further.map(|(length, _)| (length, beyond)),
                )
            }))
        };
        [at(knots[i].values, before, after), at(knots[i + 1].values, after, before)]
    }

    /// At time `t` (s).
    pub fn at(&self, t: f64) -> V {
        let s = (t - self.from) / self.length;
        let ends = [&self.start, &self.end, &self.start_slope, &self.end_slope];
        V::combined(ends, |[y0, y1, d0, d1]| hermite(s, [y0, y1], [d0, d1]))
    }
}

/// The values at time `t` (s) between the knots `i` and `i + 1`.
pub fn between<V: Values>(knots: &[Knot<V>], i: usize, t: f64) -> V {
    Cubics::of(knots, i).at(t)
}

/// Neighbouring steps whose lengths differ by more than this factor meet at an event, such as a contact that closes: there
/// values bend, and the slope on one side is no guide to the other.
const EVENT: f64 = 4.0;

/// The slope at an end of a step whose `own` length and chord are given: that of the parabola through three knots, the one in
/// the middle there, if the `other` step beyond is known; at an event and where there is none, that of the parabola through
/// three knots on the step's own side; of the chord where there are only two.
fn slope((length, own): (f64, f64), other: Option<(f64, f64)>, further: Option<(f64, f64)>) -> f64 {
    let goes_on = |beyond: f64| beyond <= EVENT * length && length <= EVENT * beyond;
    match (other, further) {
        (Some((beyond, chord)), _) if further.is_none() || goes_on(beyond) => {
            (chord * length + own * beyond) / (beyond + length)
        }
        (_, Some((beyond, chord))) => own + (own - chord) * length / (beyond + length),
        _ => own,
    }
}

/// The cubic with the given values and slopes at 0 and 1.
#[inline]
fn hermite(s: f64, [y0, y1]: [f64; 2], [d0, d1]: [f64; 2]) -> f64 {
    let rest = 1.0 - s;
    y0 * rest * rest * (1.0 + 2.0 * s) + y1 * s * s * (3.0 - 2.0 * s) + d0 * s * rest * rest - d1 * s * s * rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bend_between_a_long_and_a_short_step_does_not_reach_into_the_long_one() {
        let y = |t: f64| if t < 0.4 { t * t } else { 0.16 + 7.0 * (t - 0.4) };
        let knots: Vec<_> =
            [0.0, 0.2, 0.4, 0.41, 0.42, 0.44].map(|t| Knot { t, values: [y(t); 4], rates: None }).into();
        for t in [0.25, 0.3, 0.39, 0.405, 0.43] {
            let [found, ..] = sampled(&knots, std::iter::once(t))[0];
            assert!((found - y(t)).abs() < 1e-14, "{t}: {found}");
        }
    }

    #[test]
    fn cubics_are_met_exactly_where_the_scheme_tells_their_slopes() {
        let (y, rate) = (|t: f64| 1.0 + t * (2.0 + t * (5.0 * t - 3.0)), |t: f64| 2.0 + t * (15.0 * t - 6.0));
        let knot = |[from, t]: [f64; 2]| Knot { t, values: [y(t); 1], rates: Some([[rate(from)], [rate(t)]]) };
        let knots: Vec<_> = [[0.0, 0.0], [0.0, 0.1], [0.1, 0.9], [0.9, 1.0]].map(knot).into();
        for t in [0.05, 0.3, 0.5, 0.8, 0.95] {
            let [found] = sampled(&knots, std::iter::once(t))[0];
            assert!((found - y(t)).abs() < 1e-14, "{t}: {found}");
        }
    }

    #[test]
    fn parabolas_are_met_exactly_between_uneven_knots() {
        let y = |t: f64| 1.0 + t * (2.0 - 3.0 * t);
        let knots: Vec<_> =
            [0.0, 0.1, 0.4, 0.5, 1.0].map(|t| Knot { t, values: [y(t), 0.0, t, 0.0], rates: None }).into();
        let times = [0.05, 0.1, 0.25, 0.4, 0.45, 0.5, 0.7];
        for (t, found) in times.into_iter().zip(sampled(&knots, times.into_iter())) {
            assert!((found[0] - y(t)).abs() < 1e-14 && (found[2] - t).abs() < 1e-14, "{t}: {found:?}");
        }
    }
}
