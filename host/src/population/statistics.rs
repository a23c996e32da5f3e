//! What a population's units did, together.

use serde::Serialize;
use slipfit_tolerance::{numeric::normal, statistics::binomial};

use super::{
    ranked::Ranked,
    tally::{Duty, Tally},
};

pub use super::malfunction::{is_over, malfunctions};

/// Chance beyond either end of an interval of 95 %.
const SIDE: f64 = 0.025;

/// A share of the population.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Share {
    /// Units.
    pub units: u64,
    /// Share of all.
    pub share: f64,
    /// Its 95 % confidence interval (Clopper and Pearson).
    pub interval: [f64; 2],
}

impl Share {
    /// Of `units` in `all` ≥ 1.
    pub fn new(units: u64, all: u64) -> Self {
        Self { units, share: units as f64 / all as f64, interval: binomial::limits(units, all, SIDE) }
    }

    /// How many standard deviations a normal function with this share of malfunctions is within its limit; none if there
    /// are none, or nothing else.
    pub fn sigma_level(&self) -> Option<f64> {
        (0.0 < self.share && self.share < 1.0).then(|| -normal::quantile(self.share))
    }
}

/// A figure over the population.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Units that have the figure.
    pub units: u64,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
    /// The values that 0, 5, 50, 95 and 100 % of the units do not exceed.
    pub quantiles: [f64; 5],
}

/// Shares of [`Spread::quantiles`].
pub const QUANTILES: [f64; 5] = [0.0, 0.05, 0.5, 0.95, 1.0];

impl Spread {
    /// Of `values`; none if there are none.
    pub fn of(values: &Ranked) -> Option<Self> {
        let last = values.units().checked_sub(1)?;
        let count = values.units() as f64;
        let total =
            |of: &dyn Fn(f64) -> f64| values.values().map(|(value, count)| of(value) * count as f64).sum::<f64>();
        let mean = total(&|value| value) / count;
        let square = total(&|value| (value - mean) * (value - mean));
        let mut quantiles = [0.0; QUANTILES.len()];
        for (quantile, share) in quantiles.iter_mut().zip(QUANTILES) {
            *quantile = values.at(libm::round(share * last as f64) as u64)?;
        }
        let deviation = libm::sqrt(square / (count - 1.0).max(1.0));
        Some(Self { units: values.units(), mean, deviation, quantiles })
    }
}

/// What a population's units did.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statistics {
    /// Units.
    pub units: u64,
    /// Those that run.
    pub runs: Share,
    /// Those that run, but have not come to the end of the stroke when the run is over; none if no stroke is asked for.
    pub short: Option<Share>,
    /// Those that crawl.
    pub crawls: Share,
    /// Those that jam.
    pub jammed: Share,
    /// Units that overrun the command.
    pub overruns: Share,
    /// Those without a verdict.
    pub undecided: Share,
    /// Those that crawl, jam or need more than the force limit.
    pub malfunctions: Share,
    /// Those that need more than the force limit, if there is one.
    pub over_limit: Option<Share>,
    /// Standard deviations from a limit at which a normal figure would fail as often.
    pub sigma_level: Option<f64>,
    /// Greatest force (N).
    pub peak_force: Option<Spread>,
    /// Greatest force of the units that run (N).
    pub running_force: Option<Spread>,
    /// Breakaway time (s).
    pub breakaway: Option<Spread>,
    /// Velocity at the end (m/s).
    pub final_velocity: Option<Spread>,
    /// Units that the desk computed.
    pub at_desk: u64,
    /// Units that cannot be assembled, which count as jammed.
    pub unassembled: u64,
    /// Units that the desk cannot solve, which come to no verdict.
    pub unsolved: u64,
    /// Units whose parameters are out of bounds, which come to no verdict.
    pub out_of_bounds: u64,
}

impl Statistics {
    /// Of a `tally` of at least one unit with this `duty`.
    pub fn new(tally: &Tally, duty: Duty) -> Self {
        let (counts, figures) = (&tally.counts, &tally.figures);
        let all = counts.units.max(1);
        let [runs, crawls, jammed, overruns, undecided] = counts.verdicts.map(|units| Share::new(units, all));
        let failed = Share::new(counts.malfunctions, all);
        let [unassembled, unsolved, out_of_bounds] = counts.faults;
        Self {
            units: all,
            runs,
            short: duty.stroke.map(|_| Share::new(counts.short, all)),
            crawls,
            jammed,
            overruns,
            undecided,
            malfunctions: failed,
            over_limit: duty.limit.map(|_| Share::new(counts.over_limit, all)),
            // Of undecided units it is not known on which side they are.
            sigma_level: failed.sigma_level().filter(|_| undecided.units == 0),
            peak_force: Spread::of(&figures.force),
            running_force: Spread::of(&figures.running_force),
            breakaway: Spread::of(&figures.breakaway),
            final_velocity: Spread::of(&figures.final_velocity),
            at_desk: counts.at_desk,
            unassembled,
            unsolved,
            out_of_bounds,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Share, Spread};
    use crate::population::ranked::Ranked;

    #[test]
    fn shares_have_their_interval_and_sigma_level() {
        let share = Share::new(135, 100_000);
        assert!((share.sigma_level().unwrap() - 3.0).abs() < 1e-3);
        assert!(share.interval[0] < 0.00135 && 0.00135 < share.interval[1]);
        assert_eq!(Share::new(0, 10).sigma_level(), None);
    }

    #[test]
    fn spreads_are_of_the_values() {
        let mut values = Ranked::default();
        (0..=100).for_each(|value| values.add(f64::from(value)));
        let spread = Spread::of(&values).unwrap();
        assert_eq!((spread.mean, spread.quantiles), (50.0, [0.0, 5.0, 50.0, 95.0, 100.0]));
        assert!((spread.deviation - libm::sqrt(101.0 * 102.0 / 12.0)).abs() < 1e-9);
        assert_eq!(Spread::of(&Ranked::default()), None);
    }
}
