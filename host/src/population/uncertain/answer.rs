//! What a production with unknowns does, as distributions.

use serde::Serialize;
use slipfit_tolerance::statistics::{
    decisive::{self, Point},
    interval::of_values,
    mixture::Mixture,
};

use crate::{
    dynamics::outcome::Verdict,
    population::tally::{Counts, Duty, VERDICTS},
};

/// Shares of the units that need no more than the forces of [`Tried::force`].
const SHARES: [f64; 2] = [0.5, 0.95];

/// A value that was tried, and what its units did.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    /// Where it is in the unit cube.
    pub point: Vec<f64>,
    /// The number that stands for it, of each unknown.
    pub shown: Vec<f64>,
    /// Counts of its units.
    pub counts: Counts,
    /// The greatest force (N) that half and 95 % of its units do not exceed, if they have any.
    pub force: Option<[f64; 2]>,
}

/// An unknown, as reports have it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnknownReport {
    /// Its name.
    pub name: String,
    /// Its unit; empty for a plain number.
    pub unit: String,
    /// The least and the greatest value that was tried.
    pub tried: [f64; 2],
    /// Coordinates in the unit cube.
    #[serde(skip)]
    pub coordinates: usize,
}

/// A figure of the whole production.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Expected {
    /// Mean over what is unknown.
    pub expected: f64,
    /// What holds it with 95 %.
    pub interval: [f64; 2],
}

/// An unknown that decides.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Decides {
    /// Its name.
    pub name: String,
    /// Its share of the variance of the share that malfunctions.
    pub share: f64,
    /// Its standard error.
    pub error: f64,
}

/// A value of each unknown, and which share of its units malfunctions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ValueReport {
    /// In the order of the unknowns.
    pub values: Vec<f64>,
    /// Units that malfunction.
    pub malfunctions: u64,
}

/// What the production does.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Answer {
    /// The unknowns.
    pub unknowns: Vec<UnknownReport>,
    /// What is known from measured parts alone.
    pub measured: Vec<String>,
    /// Units that were simulated at each value.
    pub units_each: u64,
    /// Share of the units that malfunction.
    pub malfunctions: Expected,
    /// Share that crawls.
    pub crawls: Expected,
    /// Share that jams.
    pub jammed: Expected,
    /// Share that overruns the command.
    pub overruns: Expected,
    /// Share that needs more than the force limit, if there is one.
    pub over_limit: Option<Expected>,
    /// The greatest force (N, N·m) that half of the units do not exceed.
    pub median_force: Option<Expected>,
    /// The same of 95 % of the units.
    pub high_force: Option<Expected>,
    /// Which of the unknowns decide how many malfunction, the strongest first; none that chance explains.
    pub decides: Vec<Decides>,
    /// The values that were tried.
    pub values: Vec<ValueReport>,
    /// Units that come to no verdict.
    pub undecided: u64,
    /// Those of them whose parameters are out of bounds.
    pub out_of_bounds: u64,
}

impl Answer {
    /// Of the values that were `tried`, with so many units each.
    pub fn of(
        unknowns: Vec<UnknownReport>,
        measured: Vec<String>,
        tried: &[Tried],
        units_each: u64,
        duty: Duty,
    ) -> Self {
        let hits = |of: &dyn Fn(&Counts) -> u64| tried.iter().map(|tried| of(&tried.counts)).collect::<Vec<u64>>();
        let mixture = |of: &dyn Fn(&Counts) -> u64| Mixture::of(&hits(of), units_each);
        let share = |of: &dyn Fn(&Counts) -> u64| {
            let Mixture { expected, interval, .. } = mixture(of);
            Expected { expected, interval }
        };
        let verdict = |wanted: Verdict| {
            let number = VERDICTS.iter().position(|verdict| *verdict == wanted).unwrap_or(VERDICTS.len() - 1);
            share(&|counts| counts.verdicts[number])
        };
        let force = |number: usize| {
            let mut forces = tried.iter().map(|tried| Some(tried.force?[number])).collect::<Option<Vec<f64>>>()?;
            forces.sort_by(f64::total_cmp);
            let expected = forces.iter().sum::<f64>() / forces.len() as f64;
            Some(Expected { expected, interval: of_values(&forces) })
        };
        let malfunctions = mixture(&|counts| counts.malfunctions);
        let decides = decides(&unknowns, tried, units_each, malfunctions.noise);
        let value =
            |tried: &Tried| ValueReport { values: tried.shown.clone(), malfunctions: tried.counts.malfunctions };
        let count = |of: &dyn Fn(&Counts) -> u64| hits(of).iter().sum();
        Self {
            measured,
            units_each,
            malfunctions: Expected { expected: malfunctions.expected, interval: malfunctions.interval },
            crawls: verdict(Verdict::Crawls),
            jammed: verdict(Verdict::Jammed),
            overruns: verdict(Verdict::Overruns),
            over_limit: duty.limit.map(|_| share(&|counts| counts.over_limit)),
            median_force: force(0),
            high_force: force(1),
            decides,
            values: tried.iter().map(value).collect(),
            undecided: count(&|counts| counts.verdicts[VERDICTS.len() - 1]),
            out_of_bounds: count(&|counts| counts.faults[2]),
            unknowns,
        }
    }

    /// The unknown that decides most, the first where none stands out: its number.
    pub fn most_decisive(&self) -> usize {
        let first = self.decides.first().map(|first| first.name.as_str());
        self.unknowns.iter().position(|unknown| Some(unknown.name.as_str()) == first).unwrap_or_default()
    }

    /// Units in all.
    pub fn units(&self) -> u64 {
        self.units_each * self.values.len() as u64
    }
}

/// Which of the `unknowns` decide how many units malfunction, where counting alone has this variance.
fn decides(unknowns: &[UnknownReport], tried: &[Tried], units_each: u64, noise: f64) -> Vec<Decides> {
    let point =
        |tried: &Tried| Point { at: tried.point.clone(), figure: tried.counts.malfunctions as f64 / units_each as f64 };
    let points: Vec<Point> = tried.iter().map(point).collect();
    let ranges: Vec<_> = unknowns
        .iter()
        .scan(0, |at, unknown| {
            let start = *at;
            *at += unknown.coordinates;
            Some(start..*at)
        })
        .collect();
    let shares = decisive::shares(&points, &ranges, noise);
    let named = unknowns.iter().zip(shares);
    let mut decides: Vec<Decides> = named
        .filter_map(|(unknown, found)| {
            let decisive::Share { share, error } = found?;
            Some(Decides { name: unknown.name.clone(), share, error })
        })
        .collect();
    decides.sort_by(|one, other| other.share.total_cmp(&one.share));
    decides
}

/// The forces that [`SHARES`] of the units do not exceed.
pub(super) fn forces(ranked: &crate::population::ranked::Ranked) -> Option<[f64; 2]> {
    let last = ranked.units().checked_sub(1)? as f64;
    let [half, most] = SHARES.map(|share| ranked.at(libm::round(share * last) as u64));
    Some([half?, most?])
}
