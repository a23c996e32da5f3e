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
    /// [`horizon`](Self::horizon) once a period, it is known whenever it is needed. False if that is beyond the horizon, or if the motion
    /// is already predicted for that instant by another speed: [`restart`](Self::restart) takes that back.
    #[inline(always)]
    pub fn plan<P: Copy, const D: usize, const N: usize>(
        &self,
        state: &mut State<S, P, D, N>,
        periods: u32,
        speed: S,
    ) -> bool {
        let horizon = self.reach::<N>().horizon;
        let at = periods.min(horizon).wrapping_add(1).cast_signed();
        // Beyond the horizon nothing is known but that the mechanism is at rest until it is released.
        let known = whole(state.ring.head().wrapping_sub(state.clock).cast_signed()).min(horizon.cast_signed());
        let is_open = periods <= horizon && at > known;
        let old = state.setpoints.at(at);
        state.setpoints.set(at, S::from_count(u32::from(is_open)).select_gt(S::zero(), speed, old));
        state.told.forget();
        is_open
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
    /// smooth as the real one. At first and after a [`restart`](Self::restart) it stays what it is.
    #[inline(always)]
    pub fn follow<P: Copy, const D: usize, const N: usize>(&self, state: &mut State<S, P, D, N>, speed: S) {
        let (zero, one) = (S::zero(), S::one());
        let horizon = S::from_count(self.reach::<N>().horizon);
        // Whether the motion is predicted up to the coming period.
        let known: S = signed(state.ring.head().wrapping_sub(state.clock).wrapping_sub(TICKS));
        let is_known = known.select_gt(zero, one - state.is_open, zero);
        let deviation = is_known * (speed - state.setpoints.at(1));
        state.deviation = deviation;
        let parabola = state.told.tell(speed, deviation, horizon);
        let kept = horizon * (one - state.is_open);
        for periods in 0..=self.reach::<N>().horizon {
            let (after, at) = (S::from_count(periods), periods.wrapping_add(1).cast_signed());
            state.setpoints.set(at, kept.select_gt(after, state.setpoints.at(at), parabola.after(after)));
        }
    }
}
