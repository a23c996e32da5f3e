//! Prediction ahead of the clock: error-controlled steps in constant work a period.
//!
//! A prediction needs no measurement, so it need not keep step with the clock. Every period makes one attempt of RODAS3, with
//! the step that its error estimates ask for, and accepts it or not. Where the motion is smooth a step takes up to
//! two periods, and the lead so won is spent where only short ones will do. Accepted motions go into a ring, from which a cubic
//! reads the value at the present instant. The state decides by selects only: every period takes the same instructions.
//!
//! The less lead is left, the more the tolerance gives way, in steps, and the error that is then made is reported. Where it falls
//! behind by a given lag nevertheless, steps are forced: of linearly implicit Euler, over a period, whatever their error. So the lag
//! is bounded too.
//!
//! Time is counted in ticks of 2⁻²⁰ periods, so that neither a lead nor a step is ever rounded.

mod cubic;
mod ring;

use num_traits::AsPrimitive;

use crate::{
    ParameterError, Scalar,
    error::bounded,
    integrator::{Part, Rodas3, Sums},
    mechanism::Driven,
};

use self::ring::{Knot, Ring, signed};

/// What prediction ahead of the clock is held to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits<S> {
    /// Time from one call to the next (s).
    pub period: S,
    /// Error of the drive's force that a step may make (N).
    pub tolerance: S,
    /// The lead that is not exceeded (s).
    pub lead: S,
    /// The lag (s) at which steps are forced: of linearly implicit Euler, over a period, whatever their error. At a quarter, a
    /// half and three quarters of it the tolerance grows fourfold each time.
    pub lag: S,
}

/// Everything about a prediction that does not change. Stepping it cannot fail and takes the same instructions for every
/// state.
#[derive(Clone, Copy, Debug)]
pub struct Ahead<S, M> {
    mechanism: M,
    limits: Limits<S>,
    /// Duration of a tick (s).
    tick: S,
    /// Greatest lead and lag, in ticks.
    most: [S; 2],
    /// What an error of momentum (N·s) and of its time integral (N·s²) is of the tolerance.
    weights: [S; 2],
}

/// Everything that changes: the motions of the last `N` accepted steps, a power of two, and what the next one starts from.
#[derive(Clone, Debug, PartialEq)]
pub struct State<S, P, const D: usize, const N: usize> {
    /// Calls so far.
    periods: u32,
    /// Calls before time 0.
    early: u32,
    /// The present instant among the motions, in ticks: without the periods for which the last motion was held, over which it stops.
    /// So the motions stay within half the range of ticks of each other.
    clock: u32,
    /// Length of the next attempt, in ticks.
    length: S,
    ring: Ring<S, P, D, N>,
    /// What an attempt works on, here so that the stack need not hold it.
    sums: Sums<S, D>,
    /// See [`Prediction::forced`].
    forced: u32,
    /// See [`Prediction::excess`].
    excess: S,
}

/// What a prediction says after a period.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[must_use = "its values may be older than the present instant"]
pub struct Prediction<S> {
    /// The time (s) that the values hold for: the clock's, or the last one known where the prediction is behind.
    pub time: S,
    /// Speed along the drive (m/s).
    pub speed: S,
    /// Force of the drive (N).
    pub force: S,
    /// How far beyond the clock the motion is known (s); negative where the prediction is behind.
    pub lead: S,
    /// The tolerance (N) that the period's attempt was held to; infinite for a forced step.
    pub tolerance: S,
    /// Sum of the estimated errors (N) of all steps since the start, as far as they exceed the tolerance of [`Limits`]; without forced
    /// steps.
    pub excess: S,
    /// Forced steps since the start: their error is not known.
    pub forced: u32,
}

/// Whether a prediction is of use.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Status<S> {
    /// The value is that of the present instant; the motion is known for so long (s) beyond.
    Ahead(S),
    /// The value is so much (s) older than the present instant.
    Behind(S),
}

/// Ticks of a period.
const TICKS: u32 = 1 << 20;

/// The most periods by which the clock starts before time 0.
pub const MOST_EARLY: u32 = 1000;

/// The least step, in ticks: a 4096th of a period.
const LEAST: f64 = 256.0;

/// The first step, in ticks: a 50th of a period.
const FIRST: f64 = 20_000.0;

/// Error of place (m) allowed with 1 N of error of force. Errors of place last, and between tight contacts they cost more force
/// later than those of velocity do now.
const PLACE: f64 = 2.2e-5;

/// The greatest step, in ticks: two periods. Longer ones step over what happens at breakaway, and err by up to 0.6 % of the peak there.
const GREATEST: f64 = 2.0 * 1_048_576.0;

/// How much shorter than the estimate allows a step is.
const SAFETY: f64 = 0.9;

/// How much the next step may be shorter and longer.
const CHANGES: [f64; 2] = [0.2, 3.0];

/// Factors by which the tolerance grows where the lead is below these shares of the greatest. While there is a lead it may be tight; the
/// less is left, the more it gives way, so that the lead is seldom lost.
const BY_LEAD: [[f64; 2]; 4] = [[0.1, 2.0], [0.05, 2.0], [0.01, 1.5], [0.0, 2.0]];

/// Further factors, where the lead is below these shares of the greatest lag.
const BY_LAG: [[f64; 2]; 3] = [[-0.25, 4.0], [-0.5, 4.0], [-0.75, 4.0]];

/// Error, as a multiple of the tolerance, of an attempt whose error is not known.
const NOT_FINITE: f64 = 1e12;

impl<S: Scalar + PartialOrd, M> Ahead<S, M> {
    /// Prediction of `mechanism` within `limits`.
    ///
    /// # Errors
    /// If the period is outside 1e-6…1 s, the tolerance outside 1e-9…1e6 N, the lead or the lag outside
    /// 4…1000 periods, or one is not finite.
    pub fn new<const D: usize>(mechanism: M, limits: Limits<S>) -> Result<Self, ParameterError<S>>
    where
        M: Driven<S, D>,
    {
        let period = bounded("ahead.period", limits.period, [1e-6, 1.0])?;
        let tolerance = bounded("ahead.tolerance", limits.tolerance, [1e-9, 1e6])?;
        let lead = bounded("ahead.lead", limits.lead / period, [3.999, 1000.0])?;
        let lag = bounded("ahead.lag", limits.lag / period, [3.999, 1000.0])?;
        let ticks = S::from_count(TICKS);
        let mass = mechanism.mass();
        Ok(Self {
            weights: [mechanism.drive().gain / (mass * tolerance), S::one() / (mass * tolerance * S::from_f64(PLACE))],
            mechanism,
            limits,
            tick: period / ticks,
            most: [lead * ticks, lag * ticks],
        })
    }
}

impl<S: Scalar + AsPrimitive<u32>, M> Ahead<S, M> {
    /// The mechanism.
    pub fn mechanism(&self) -> &M {
        &self.mechanism
    }

    /// The limits.
    pub fn limits(&self) -> &Limits<S> {
        &self.limits
    }

    /// At rest in `pose` at time 0, `early` periods before which the clock starts: [`MOST_EARLY`] at most, more count as so many.
    pub fn at_rest<const D: usize, const N: usize>(&self, pose: M::Pose, early: u32) -> State<S, M::Pose, D, N>
    where
        M: Driven<S, D>,
    {
        let zero = S::zero();
        let (ring, sums) = (Ring::new(pose), [Part::zero(); 2]);
        let mut state = State { periods: 0, early: 0, clock: 0, length: zero, ring, sums, forced: 0, excess: zero };
        self.put_at_rest(&mut state, pose, early);
        state
    }

    /// As [`at_rest`](Self::at_rest), in place: for a state that is too large for the stack.
    pub fn put_at_rest<const D: usize, const N: usize>(
        &self,
        state: &mut State<S, M::Pose, D, N>,
        pose: M::Pose,
        early: u32,
    ) where
        M: Driven<S, D>,
    {
        let early = early.min(MOST_EARLY);
        state.clock = 0u32.wrapping_sub(early.wrapping_mul(TICKS));
        (state.periods, state.early) = (0, early);
        state.length = S::from_f64(FIRST);
        state.ring.put_at_rest(pose, state.clock, 0);
        state.sums = [Part::zero(); 2];
        (state.forced, state.excess) = (0, S::zero());
    }

    /// One period: the clock goes on by it, one step is attempted, and the values at the new instant are given.
    #[inline(always)]
    pub fn step<const D: usize, const N: usize>(&self, state: &mut State<S, M::Pose, D, N>) -> Prediction<S>
    where
        M: Driven<S, D>,
    {
        let (zero, one) = (S::zero(), S::one());
        state.periods = state.periods.saturating_add(1);
        state.clock = state.clock.wrapping_add(TICKS);
        let clock = state.clock;
        let now = (S::from_count(state.periods) - S::from_count(state.early)) * self.limits.period;

        let lead: S = signed(state.ring.head().wrapping_sub(clock));
        let [most, lag] = self.most;
        let lags: S = -(lead / lag);
        let given_way = factor(lead / most, BY_LEAD) * factor(-lags, BY_LAG);
        let forced = lags.select_gt(one, one, zero);

        // A forced step leads over a period at least, so that the lag does not grow; none leads too far.
        let period = S::from_count(TICKS);
        let wanted = forced.select_gt(zero, state.length.max_of(period), state.length);
        let fits = wanted.select_gt(most - lead, zero, one);
        let has_room = state.ring.has_room(clock) * fits;
        // In whole ticks.
        let advance = S::from_count(wanted.max_of(S::from_f64(LEAST)).as_());
        // Of an attempt whose half is taken.
        let length = advance + advance * forced;

        let end = {
            let from = state.ring.newest();
            let internal = self.mechanism.fresh();
            let from = (&from.pose, &from.velocity, &internal);
            let (t, h) = (now + lead * self.tick, length * self.tick);
            Rodas3::attempt(&self.mechanism, t, h, from, Some(forced), &mut state.sums)
        };
        let [momentum, place] = self.weights;
        let error = (end.error * momentum).max_of(end.drift * place);
        let finiteness_probe = self.mechanism.finiteness_probe(&end.pose);
        let next = state.ring.next(end.pose, &end.change);
        let finiteness_probe = next.velocity.data.0[0].iter().fold(finiteness_probe, |sum, v| sum + *v) * zero;
        let error = error + finiteness_probe;
        let worst = S::from_f64(NOT_FINITE);
        let error = worst.select_gt(error, error, worst).max_of(S::from_f64(1e-9));

        // A forced step may be finite where its error is not: that is of stages which it does not take.
        let finite = (one + finiteness_probe).select_gt(zero, one, zero);
        let good = error.select_gt(given_way, zero, one);
        let accepted = has_room * forced.select_gt(zero, finite, good);
        state.ring.extend(accepted.as_(), (accepted * advance).as_());
        // Where not even a forced step is finite, the last motion is held for a period.
        let held = forced * (one - accepted);
        state.clock = clock.wrapping_sub((held * period).as_());
        let clock = state.clock;
        let relative = error / given_way;
        let factor = S::from_f64(SAFETY) / relative.pow(S::from_f64(1.0 / 3.0));
        let next =
            (length * factor.within(S::from_f64(CHANGES[0]), S::from_f64(CHANGES[1]))).max_of(S::from_f64(LEAST));
        let greatest = S::from_f64(GREATEST);
        let next = next.select_gt(greatest, greatest, next);
        // Where there was no room the attempt says nothing.
        state.length = has_room.select_gt(zero, next, state.length);
        state.forced = state.forced.saturating_add(forced.as_());
        let tolerance = self.limits.tolerance;
        state.excess += accepted * (one - forced) * error.select_gt(one, error - one, zero) * tolerance;

        let lead = signed::<S>(state.ring.head().wrapping_sub(clock)) * self.tick;
        let speed = state.ring.read(clock, |knot| self.mechanism.speed(&knot.velocity));
        let time = now + lead.select_gt(zero, zero, lead);
        Prediction {
            time,
            speed,
            force: self.mechanism.drive().force(time, speed),
            lead,
            tolerance: forced.select_gt(zero, one / zero, given_way * tolerance),
            excess: state.excess,
            forced: state.forced,
        }
    }

    /// Goes on from the motion at the present instant: for when the command or the unit has changed, and with it the prediction
    /// that is called. Where the prediction is behind, it goes on from the last motion known.
    pub fn restart<const D: usize, const N: usize>(&self, state: &mut State<S, M::Pose, D, N>)
    where
        M: Driven<S, D>,
    {
        let mechanism = &self.mechanism;
        let present = state.ring.interpolated(state.clock, |base, from, to, weight| {
            let change = (to.velocity - from.velocity) * weight;
            Knot { pose: mechanism.shifted(&base.pose, &from.pose, &to.pose, weight), velocity: base.velocity + change }
        });
        let pose = mechanism.normalised(&present.pose);
        state.ring.restart(state.clock, Knot { pose, ..present });
        state.length = S::from_f64(FIRST);
    }
}

/// The product of the factors of all `steps` that `x` is below.
#[inline(always)]
fn factor<S: Scalar, const N: usize>(x: S, steps: [[f64; 2]; N]) -> S {
    let one = S::one();
    steps
        .iter()
        .fold(one, |product, [below, factor]| product * S::from_f64(*below).select_gt(x, S::from_f64(*factor), one))
}

impl<S: Scalar> Prediction<S> {
    /// Ahead of the clock, or behind it.
    pub fn status(&self) -> Status<S>
    where
        S: PartialOrd,
    {
        if self.lead >= S::zero() { Status::Ahead(self.lead) } else { Status::Behind(-self.lead) }
    }
}

#[cfg(test)]
mod tests;
