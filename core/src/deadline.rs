//! What an interrupt of a fixed period knows of its own timing: calls, periods missed, the longest call.
//!
//! Times are readings of a counter that counts up and wraps around at 2³², as the cycle counter of a Cortex-M does. A main program that
//! restarts a watchdog only while calls go on and none is missed turns a late interrupt into a reset.

use crate::{ParameterError, error::bounded};

/// Counts since the first call; none wraps around.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Timing {
    /// Calls that have begun.
    pub calls: u32,
    /// Periods in which no call began. A call that begins up to half a period late is in its own.
    pub missed: u32,
    /// The longest call, in ticks of the counter.
    pub longest: u32,
    /// Calls that took longer than a period.
    pub overruns: u32,
}

/// The deadline of one interrupt, whose calls say when they begin and end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Deadline {
    period: u32,
    /// When the last call began.
    begun: u32,
    timing: Timing,
}

impl Deadline {
    /// The deadline of an interrupt every `period` ticks.
    ///
    /// # Errors
    /// If the period is outside 2…2²⁹ ticks.
    pub fn new(period: u32) -> Result<Self, ParameterError<f64>> {
        bounded("deadline.period", f64::from(period), [2.0, f64::from(1u32 << 29)])?;
        Ok(Self { period, begun: 0, timing: Timing::default() })
    }

    /// A call begins at `now`, less than 2³² ticks after the one before.
    #[inline]
    pub fn begin(&mut self, now: u32) {
        let since = now.wrapping_sub(self.begun);
        let (whole, rest) = (since.checked_div(self.period).unwrap_or(0), since.checked_rem(self.period).unwrap_or(0));
        let periods = whole.wrapping_add(u32::from(rest > self.period / 2));
        let counts = u32::from(self.timing.calls > 0);
        self.timing.missed = self.timing.missed.saturating_add(counts * periods.saturating_sub(1));
        self.timing.calls = self.timing.calls.saturating_add(1);
        self.begun = now;
    }

    /// The call that began last ends at `now`.
    #[inline]
    pub fn end(&mut self, now: u32) {
        let took = now.wrapping_sub(self.begun);
        self.timing.longest = self.timing.longest.max(took);
        self.timing.overruns = self.timing.overruns.saturating_add(u32::from(took > self.period));
    }

    /// What is known so far.
    pub fn timing(&self) -> Timing {
        self.timing
    }
}

#[cfg(test)]
mod tests {
    use super::{Deadline, Timing};

    const PERIOD: u32 = 1000;

    /// Calls in the periods of `at`, each late by and taking some ticks, on a counter that starts anywhere.
    fn timing(start: u32, calls: impl Iterator<Item = [u32; 3]>) -> Timing {
        let mut deadline = Deadline::new(PERIOD).unwrap();
        for [period, late, took] in calls {
            let now = start.wrapping_add(period.wrapping_mul(PERIOD)).wrapping_add(late);
            deadline.begin(now);
            deadline.end(now.wrapping_add(took));
        }
        deadline.timing()
    }

    #[test]
    fn periods_without_a_call_are_counted() {
        for start in [0, 1, u32::MAX, u32::MAX - 30_000] {
            // One call in each of 60 periods, up to a quarter of a period late.
            let punctual = timing(start, (0..60).map(|i| [i, 7 * i % 250, 300 + i]));
            assert_eq!(punctual, Timing { calls: 60, missed: 0, longest: 359, overruns: 0 });
            // Those of every seventh period are missed, and three in a row.
            let periods = (0..61).filter(|i| i % 7 != 3 && !(30..33).contains(i));
            let here: std::vec::Vec<_> = periods.collect();
            let gaps = timing(start, here.iter().map(|i| [*i, 0, 10]));
            assert_eq!((gaps.calls, gaps.missed), (here.len() as u32, 61 - here.len() as u32));
        }
    }

    #[test]
    fn the_longest_call_and_overruns_are_found() {
        let calls = [[0, 0, 100], [1, 0, 1000], [2, 0, 1001], [4, 0, 20]];
        assert_eq!(timing(5, calls.into_iter()), Timing { calls: 4, missed: 1, longest: 1001, overruns: 1 });
        // A call that never ends is not counted as short: the next one says that periods were missed.
        let mut deadline = Deadline::new(PERIOD).unwrap();
        deadline.begin(0);
        deadline.begin(9 * PERIOD);
        assert_eq!(deadline.timing(), Timing { calls: 2, missed: 8, longest: 0, overruns: 0 });
    }

    #[test]
    fn periods_out_of_bounds_are_refused() {
        for (period, allowed) in [(0, false), (1, false), (2, true), (1 << 29, true), ((1 << 29) + 1, false)] {
            assert_eq!(Deadline::new(period).is_ok(), allowed, "{period}");
        }
    }

    #[test]
    fn counts_stop_at_their_ends() {
        let mut deadline = Deadline::new(2).unwrap();
        deadline.begin(0);
        for i in 1..4u32 {
            deadline.begin(i.wrapping_mul(u32::MAX));
        }
        assert_eq!(deadline.timing().missed, u32::MAX);
    }
}
