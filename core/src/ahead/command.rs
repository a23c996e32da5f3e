//! The command that is told to a prediction: in advance, or as it comes.

use num_traits::AsPrimitive;

use super::{
    Ahead, State,
    ring::signed,
    setpoints::{TICKS, whole},
};
use crate::Scalar;

impl<S: Scalar + AsPrimitive<u32>, M> Ahead<S, M> {
    /// Periods from the end of the coming one to the horizon, beyond which no command is taken: by three more than the lead, to whose last
    /// steps setpoints on either side belong.
    pub fn horizon<P, const D: usize, const N: usize>(&self, _: &State<S, P, D, N>) -> u32 {
        self.reach::<N>().horizon
    }

    /// The commanded `speed` (m/s) so many `periods` after the end of the coming one, of a command that is known in advance. Told for the
    /// [`horizon`](Self::horizon) once a period, it is known whenever it is needed. The first one told after a
    /// [`restart`](Self::restart) or at rest holds up to the horizon, until the next are told. False, and nothing is changed, if the instant
    /// is beyond the horizon, or the motion is already predicted for it: a restart takes that back.
    #[inline(always)]
    pub fn plan<P: Copy, const D: usize, const N: usize>(
        &self,
        state: &mut State<S, P, D, N>,
        periods: u32,
        speed: S,
    ) -> bool {
        let horizon = self.reach::<N>().horizon;
        let at = periods.min(horizon).wrapping_add(1).cast_signed();
        let is_open = periods <= horizon && at > self.known(state).min(horizon.cast_signed());
        if is_open {
            let is_first: u32 = state.is_open.as_();
            let end = if is_first == 1 { horizon.wrapping_add(1).cast_signed() } else { at };
            for at in at..=end {
                state.setpoints.set(at, speed);
            }
            state.is_open = S::zero();
            state.told.forget();
        }
        is_open
    }

    /// The last whole period after the present instant for which the motion is predicted. Of a mechanism at rest nothing is, since until
    /// it is released its motion does not go by the command.
    #[inline(always)]
    fn known<P: Copy, const D: usize, const N: usize>(&self, state: &State<S, P, D, N>) -> i32 {
        let known = whole(state.ring.head().wrapping_sub(state.clock).cast_signed());
        if state.ring.has_moved() { known } else { 0 }
    }

    /// [Plans](Self::plan) the `command` (m/s) by time (s) up to the horizon, but for what the motion is already predicted for.
    pub fn plan_all<P: Copy, const D: usize, const N: usize>(
        &self,
        state: &mut State<S, P, D, N>,
        mut command: impl FnMut(S) -> S,
    ) {
        for periods in 0..=self.reach::<N>().horizon {
            let speed = command(self.time(state, periods.wrapping_add(1)));
            self.plan(state, periods, speed);
        }
    }

    /// The commanded `speed` (m/s) at the end of the coming period, of a command that is not known in advance: a parabola through what it
    /// was in the last eight periods says what it will be at the horizon. Always there, so that the command that is reckoned with is as
    /// smooth as the real one. At first and after a [`restart`](Self::restart) it counts as constant, until eight periods are known. A speed
    /// that is not finite says nothing.
    #[inline(always)]
    pub fn follow<P: Copy, const D: usize, const N: usize>(&self, state: &mut State<S, P, D, N>, speed: S) {
        let (zero, one) = (S::zero(), S::one());
        let horizon = S::from_count(self.reach::<N>().horizon);
        // Where the motion is predicted up to the coming period, it was by another command; else by this one.
        let beyond: S = signed(state.ring.head().wrapping_sub(state.clock).wrapping_sub(TICKS));
        let is_known = beyond.select_gt(zero, one - state.is_open, zero);
        let reckoned = state.setpoints.at(1);
        let speed = speed.or_old(one, reckoned);
        let deviation = is_known.select_gt(zero, speed - reckoned, zero);
        state.deviation = deviation;
        let parabola = state.told.tell(speed, deviation, horizon);
        state.setpoints.set(1, is_known.select_gt(zero, reckoned, speed));
        let kept = horizon * (one - state.is_open);
        for periods in 1..=self.reach::<N>().horizon {
            let (after, at) = (S::from_count(periods), periods.wrapping_add(1).cast_signed());
            state.setpoints.set(at, kept.select_gt(after, state.setpoints.at(at), parabola.after(after)));
        }
    }
}
