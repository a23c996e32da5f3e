//! The command of a prediction: planned in advance, or followed as it comes.

use num_traits::AsPrimitive;

use super::{
    Ahead, State,
    ring::signed,
    setpoints::{TICKS, whole},
};
use crate::Scalar;

impl<S: Scalar + AsPrimitive<u32>, M> Ahead<S, M> {
    /// The horizon: periods from the end of the coming one to the last setpoint that can be set. Three more than the lead, because the last
    /// steps need the setpoints around them.
    pub fn horizon<P, const D: usize, const N: usize>(&self, _: &State<S, P, D, N>) -> u32 {
        self.reach::<N>().horizon
    }

    /// Sets the commanded `speed` (m/s) so many `periods` after the end of the coming one, of a command that is known in advance: once a
    /// period for the [`horizon`](Self::horizon). The first one after a [`restart`](Self::restart) or at rest holds up to the horizon,
    /// until the next ones are set. False, without any change, if the instant is beyond the horizon or the motion is already predicted
    /// for it; in that case restart first.
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
            state.history.clear();
        }
        is_open
    }

    /// The last whole period after the present instant for which the motion is predicted; 0 before the first step, because a mechanism at
    /// rest does not depend on the command.
    #[inline(always)]
    fn known<P: Copy, const D: usize, const N: usize>(&self, state: &State<S, P, D, N>) -> i32 {
        let known = whole(state.ring.head().wrapping_sub(state.clock).cast_signed());
        if state.ring.has_moved() { known } else { 0 }
    }

    /// [Plans](Self::plan) the `command` (m/s) by time (s) up to the horizon, except where the motion is already predicted.
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

    /// Sets the commanded `speed` (m/s) at the end of the coming period, of a command that is not known in advance. The setpoint at the
    /// horizon is extrapolated by a parabola through the last eight periods; always there, so that the extrapolated command is as smooth
    /// as the real one. At first and after a [`restart`](Self::restart) the command is extrapolated as constant, until eight periods are
    /// known. A speed that is not finite is ignored.
    #[inline(always)]
    pub fn follow<P: Copy, const D: usize, const N: usize>(&self, state: &mut State<S, P, D, N>, speed: S) {
        let (zero, one) = (S::zero(), S::one());
        let horizon = S::from_count(self.reach::<N>().horizon);
        // Where the motion is already predicted for the coming period, that used an extrapolated setpoint, which stays.
        let beyond: S = signed(state.ring.head().wrapping_sub(state.clock).wrapping_sub(TICKS));
        let is_predicted = beyond.select_gt(zero, one - state.is_open, zero);
        let assumed = state.setpoints.at(1);
        let speed = speed.or_old(one, assumed);
        let deviation = is_predicted.select_gt(zero, speed - assumed, zero);
        state.deviation = deviation;
        let parabola = state.history.update(speed, deviation, horizon);
        state.setpoints.set(1, is_predicted.select_gt(zero, assumed, speed));
        let (horizon, is_first) = (self.reach::<N>().horizon, AsPrimitive::<u32>::as_(state.is_open));
        for periods in if is_first == 1 { 1 } else { horizon }..=horizon {
            state.setpoints.set(periods.wrapping_add(1).cast_signed(), parabola.after(S::from_count(periods)));
        }
    }
}
