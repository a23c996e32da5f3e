//! Prediction ahead of the clock: error-controlled steps in constant work a period.
//!
//! A prediction needs no measurement, so it need not keep step with the clock. Every period makes a given number of attempts of
//! RODAS3, each with the step that its error estimates ask for, and accepts them or not. Where the motion is smooth a step takes up to
//! two periods, and the lead so won is spent where only short ones will do. Accepted motions go into a ring, from which a cubic
//! reads the value at the present instant. The state decides by selects only: every period takes the same instructions.
//!
//! The less lead is left, the more the tolerance gives way, in steps, and the error that is then made is reported. Where it falls
//! behind by a given lag nevertheless, steps are forced: of linearly implicit Euler, over a period, whatever their error. So the lag
//! is bounded too.
//!
//! The command has one setpoint per period, up to a horizon beyond the last step: set in advance by [`Ahead::plan`], or extrapolated by
//! [`Ahead::follow`]. Steps use times relative to their start, so that the clock may run forever.
//!
//! Time is counted in ticks of 2⁻²⁰ periods, so that neither a lead nor a step is ever rounded.

mod command;
mod cubic;
mod follow;
mod prediction;
mod ring;
mod setpoints;

pub use prediction::{Limits, MOST_ATTEMPTS, Prediction, Status};

use num_traits::AsPrimitive;

use crate::{
    ParameterError, Scalar,
    error::bounded,
    integrator::{Part, Rodas3, Sums},
    mechanism::Driven,
};

use self::{
    follow::History,
    ring::{Knot, Ring, signed},
    setpoints::{Setpoints, TICKS, whole},
};

/// Everything about a prediction that does not change but the drive's command, which every step sets anew. Stepping cannot fail and
/// takes the same instructions for every state.
#[derive(Clone, Copy, Debug)]
pub struct Ahead<S, M> {
    mechanism: M,
    limits: Limits<S>,
    /// Duration of a tick (s).
    tick: S,
    /// Periods in a second (1/s).
    rate: S,
    /// Greatest lead and lag, in periods.
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
    /// The command, from the greatest lag before the present instant to a period beyond the horizon.
    setpoints: Setpoints<S, N>,
    /// Of a command that is not known in advance.
    history: History<S>,
    /// See [`Prediction::deviation`].
    deviation: S,
    /// 1 at rest and after a restart, until a setpoint is set or a step is made; else 0.
    is_open: S,
    /// What an attempt works on, here so that the stack need not hold it.
    sums: Sums<S, D>,
    /// See [`Prediction::forced`].
    forced: u32,
    /// See [`Prediction::excess`].
    excess: S,
}

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

/// What a state of some size leaves of the limits, in ticks.
struct Reach<S> {
    lead: S,
    lag: S,
    /// Periods from the present instant to the last one whose setpoint is known.
    horizon: u32,
}

impl<S: Scalar + PartialOrd, M> Ahead<S, M> {
    /// Prediction of `mechanism` within `limits`.
    ///
    /// # Errors
    /// If the period is outside 1e-6…1 s, the tolerance outside 1e-9…1e6 N, the lead or the lag outside
    /// 4…1000 periods, one of them is not finite, or there are no attempts or more than [`MOST_ATTEMPTS`].
    pub fn new<const D: usize>(mechanism: M, limits: Limits<S>) -> Result<Self, ParameterError<S>>
    where
        M: Driven<S, D>,
    {
        let period = bounded("ahead.period", limits.period, [1e-6, 1.0])?;
        let tolerance = bounded("ahead.tolerance", limits.tolerance, [1e-9, 1e6])?;
        let lead = bounded("ahead.lead", limits.lead / period, [3.999, 1000.0])?;
        let lag = bounded("ahead.lag", limits.lag / period, [3.999, 1000.0])?;
        bounded("ahead.attempts", S::from_count(limits.attempts), [1.0, f64::from(MOST_ATTEMPTS)])?;
        let ticks = S::from_count(TICKS);
        let mass = mechanism.mass();
        Ok(Self {
            weights: [mechanism.drive().gain / (mass * tolerance), S::one() / (mass * tolerance * S::from_f64(PLACE))],
            mechanism,
            limits,
            tick: period / ticks,
            rate: S::one() / period,
            most: [lead, lag],
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

    /// What a state of `N` motions and 2·N setpoints holds: if less than the limits ask for, the lead and the lag are so much shorter.
    #[inline(always)]
    fn reach<const N: usize>(&self) -> Reach<S> {
        // A setpoint before the lag, and six after the lead: the horizon's, what its cubic needs, and the next.
        let room = S::from_f64(2.0 * N as f64 - 8.0);
        let [lead, lag] = self.most;
        let lead = lead.at_most(room - S::from_f64(4.0));
        let lag = lag.at_most(room - lead);
        let ticks = S::from_count(TICKS);
        Reach { lead: lead * ticks, lag: lag * ticks, horizon: lead.as_().wrapping_add(3) }
    }

    /// At rest in `pose` until time 0, `early` periods before which the clock starts: [`MOST_EARLY`] at most, more count as so many. The
    /// `command` (m/s) as a function of time (s) gives the setpoints up to the horizon; beyond, the last one holds until others are set.
    pub fn at_rest<const D: usize, const N: usize>(
        &self,
        pose: M::Pose,
        early: u32,
        command: impl FnMut(S) -> S,
    ) -> State<S, M::Pose, D, N>
    where
        M: Driven<S, D>,
    {
        let zero = S::zero();
        let (ring, sums) = (Ring::new(pose), [Part::zero(); 2]);
        let (setpoints, history) = (Setpoints::new(), History::new());
        let mut state = State {
            periods: 0,
            early: 0,
            clock: 0,
            length: zero,
            ring,
            setpoints,
            history,
            deviation: zero,
            is_open: zero,
            sums,
            forced: 0,
            excess: zero,
        };
        self.put_at_rest(&mut state, pose, early, command);
        state
    }

    /// As [`at_rest`](Self::at_rest), in place: for a state that is too large for the stack.
    pub fn put_at_rest<const D: usize, const N: usize>(
        &self,
        state: &mut State<S, M::Pose, D, N>,
        pose: M::Pose,
        early: u32,
        mut command: impl FnMut(S) -> S,
    ) where
        M: Driven<S, D>,
    {
        let early = early.min(MOST_EARLY);
        state.clock = 0u32.wrapping_sub(early.wrapping_mul(TICKS));
        (state.periods, state.early) = (0, early);
        state.length = S::from_f64(FIRST);
        state.ring.put_at_rest(pose, state.clock, 0);
        state.setpoints.fill(S::zero());
        for periods in 0..=self.reach::<N>().horizon.wrapping_add(1) {
            let time = self.time(state, periods);
            state.setpoints.set(periods.cast_signed(), command(time));
        }
        (state.history, state.deviation, state.is_open) = (History::new(), S::zero(), S::one());
        state.sums = [Part::zero(); 2];
        (state.forced, state.excess) = (0, S::zero());
    }

    /// The time (s) after so many more `periods`; 0 when the mechanism is released. In f32 it is rounded to 2, 4 and more periods after 2²⁴
    /// of them, 4.7 h at 1 kHz. Steps do not use it, but a command that depends on it should then count periods itself.
    #[inline(always)]
    pub fn time<P, const D: usize, const N: usize>(&self, state: &State<S, P, D, N>, periods: u32) -> S {
        let periods = S::from_count(state.periods.saturating_add(periods));
        (periods - S::from_count(state.early)) * self.limits.period
    }

    /// One period: the clock goes on by it, steps are attempted, and the values at the new instant are given.
    #[inline(always)]
    pub fn step<const D: usize, const N: usize>(&mut self, state: &mut State<S, M::Pose, D, N>) -> Prediction<S>
    where
        M: Driven<S, D>,
    {
        let zero = S::zero();
        state.periods = state.periods.saturating_add(1);
        state.clock = state.clock.wrapping_add(TICKS);
        state.setpoints.advance();
        let mut tolerance = zero;
        for _ in 0..self.limits.attempts {
            tolerance = self.attempt(state);
        }
        let horizon = self.reach::<N>().horizon.cast_signed();
        state.setpoints.set(horizon.wrapping_add(1), state.setpoints.at(horizon));

        let ticks = state.ring.head().wrapping_sub(state.clock).cast_signed();
        let lead = signed::<S>(ticks.cast_unsigned()) * self.tick;
        let [speed, position] = self.motion(state, 0);
        let deviation = zero.select_gt(lead, zero, state.deviation);
        (state.deviation, state.is_open) = (zero, zero);
        Prediction {
            time: self.time(state, 0) + lead.select_gt(zero, zero, lead),
            speed,
            position,
            force: self.mechanism.drive().gain * (state.setpoints.command(ticks.min(0), self.rate) - speed),
            deviation,
            lead,
            tolerance,
            excess: state.excess,
            forced: state.forced,
        }
    }

    /// Attempts a step. The tolerance (N) that it is held to; infinite for a forced one.
    #[inline(always)]
    fn attempt<const D: usize, const N: usize>(&mut self, state: &mut State<S, M::Pose, D, N>) -> S
    where
        M: Driven<S, D>,
    {
        let (zero, one) = (S::zero(), S::one());
        let clock = state.clock;
        let Reach { lead: most, lag, .. } = self.reach::<N>();
        let ticks = state.ring.head().wrapping_sub(clock);
        let lead: S = signed(ticks);
        self.mechanism.drive_mut().command = state.setpoints.pieces(ticks.cast_signed(), self.rate);
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
            Rodas3::attempt(&self.mechanism, zero, length * self.tick, from, Some(forced), &mut state.sums)
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
        forced.select_gt(zero, one / zero, given_way * tolerance)
    }

    /// Speed (m/s) and position (m) along the drive so many `periods` after the present instant, or the last ones known.
    #[inline(always)]
    fn motion<const D: usize, const N: usize>(&self, state: &State<S, M::Pose, D, N>, periods: u32) -> [S; 2]
    where
        M: Driven<S, D>,
    {
        let mechanism = &self.mechanism;
        state.ring.read(state.clock.wrapping_add(periods.wrapping_mul(TICKS)), |knot| {
            [mechanism.speed(&knot.velocity), mechanism.position(&knot.pose)]
        })
    }

    /// The force (N) of the drive so many `periods` after the present instant; none if that is beyond the lead.
    pub fn forecast<const D: usize, const N: usize>(&self, state: &State<S, M::Pose, D, N>, periods: u32) -> Option<S>
    where
        M: Driven<S, D>,
    {
        let ticks = state.ring.head().wrapping_sub(state.clock).cast_signed();
        let is_known = ticks >= 0 && i64::from(whole(ticks)) >= i64::from(periods);
        let [speed, _] = self.motion(state, periods.min(MOST_EARLY));
        let command = state.setpoints.at(periods.min(MOST_EARLY).cast_signed());
        is_known.then(|| self.mechanism.drive().gain * (command - speed))
    }

    /// Goes on from the motion at the present instant: for when the command has changed that was planned, or the unit, and with it the
    /// prediction that is called, of the same period, lead and lag. Where the prediction is behind, it goes on from the last motion known;
    /// before time 0 the mechanism stays at rest until then. The setpoints stay until others are [planned](Self::plan) or
    /// [followed](Self::follow).
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
        if state.periods < state.early {
            state.ring.put_at_rest(pose, state.clock, 0);
        } else {
            state.ring.restart(state.clock, Knot { pose, ..present });
        }
        state.length = S::from_f64(FIRST);
        state.is_open = S::one();
        state.history.clear();
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

#[cfg(test)]
mod tests;
