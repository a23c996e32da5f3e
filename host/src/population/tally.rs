//! What is kept of a population's units: counts, how figures spread, and a few units. Memory does not grow with the population.

use std::cmp::Ordering;

use super::{
    Unit,
    kept::Outcomes,
    malfunction::{Kind, Side, is_over, malfunctions},
    ranked::Ranked,
    subject::Subject,
    unit::{FAULTS, Fault},
};
use crate::dynamics::outcome::Verdict;

/// How far (m) before the end of its stroke a unit has not come to it; lanes stop within 0.1 µm of it.
const SHORT: f64 = 1e-6;
/// The worst units, which are kept.
pub const WORST: usize = 5;
/// First units of each verdict, which are kept.
const FIRST: usize = 1024;
/// Verdicts, in the order in which units are counted by them.
pub const VERDICTS: [Verdict; 5] =
    [Verdict::Runs, Verdict::Crawls, Verdict::Jammed, Verdict::Overruns, Verdict::Undecided];
/// Kinds of malfunction, in the order in which units are counted by them.
pub const KINDS: [Kind; 4] = [Kind::Crawls, Kind::Jams, Kind::Overruns, Kind::OverLimit];

/// What units have to do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Duty {
    /// The motor's greatest force (N, N·m), if it has a limit.
    pub limit: Option<f64>,
    /// How far (m, rad) they are to travel, if they are.
    pub stroke: Option<f64>,
}

/// Counts of units.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// All.
    pub units: u64,
    /// By verdict, as in [`VERDICTS`].
    pub verdicts: [u64; 5],
    /// Those that run, but have not come to the end of the stroke when the run is over.
    pub short: u64,
    /// Those that need more than the limit.
    pub over_limit: u64,
    /// Those that malfunction.
    pub malfunctions: u64,
    /// Those that the desk computed.
    pub at_desk: u64,
    /// Those without a run, as in [`FAULTS`].
    pub faults: [u64; FAULTS.len()],
    /// Those that malfunction, by kind as in [`KINDS`]: tight ones and loose ones.
    pub kinds: [[u64; 2]; 4],
    /// Those that malfunction, by the gap whose contact is pressed in deepest; as many as any unit has pressed.
    pub pressed: Vec<u64>,
}

impl Counts {
    /// Every count but those of [`Counts::pressed`], in one order.
    pub fn each(&mut self) -> impl Iterator<Item = &mut u64> {
        let Self { units, verdicts, short, over_limit, malfunctions, at_desk, faults, kinds, pressed: _ } = self;
        [units, short, over_limit, malfunctions, at_desk]
            .into_iter()
            .chain(faults)
            .chain(verdicts)
            .chain(kinds.as_flattened_mut())
    }
}

/// How figures of units spread.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figures {
    /// Greatest force (N, N·m).
    pub force: Ranked,
    /// The same of units that run.
    pub running_force: Ranked,
    /// The same of units that malfunction.
    pub failing_force: Ranked,
    /// Breakaway time (s).
    pub breakaway: Ranked,
    /// Velocity at the end (m/s, rad/s).
    pub final_velocity: Ranked,
    /// Tightness (σ, the mean over the gaps).
    pub tightness: Ranked,
    /// The same of units that malfunction.
    pub failing_tightness: Ranked,
}

impl Figures {
    /// Every figure, in one order.
    pub fn each(&self) -> [&Ranked; 7] {
        let Self { force, running_force, failing_force, breakaway, final_velocity, tightness, failing_tightness } =
            self;
        [force, running_force, failing_force, breakaway, final_velocity, tightness, failing_tightness]
    }

    /// The same, to be changed.
    pub fn each_mut(&mut self) -> [&mut Ranked; 7] {
        let Self { force, running_force, failing_force, breakaway, final_velocity, tightness, failing_tightness } =
            self;
        [force, running_force, failing_force, breakaway, final_velocity, tightness, failing_tightness]
    }
}

/// What is kept of units. The order in which they come does not matter.
#[derive(Clone, Debug, PartialEq)]
pub struct Tally {
    /// Counts.
    pub counts: Counts,
    /// How figures spread.
    pub figures: Figures,
    /// Which units malfunction and with what force: of this it is found what both vary with.
    pub outcomes: Outcomes,
    /// The worst, at most [`WORST`]: of those that malfunction the ones that come least far, then those that need most force.
    pub worst: Vec<Unit>,
    /// The first of each verdict, as in [`VERDICTS`], in order.
    pub first: [Vec<Unit>; VERDICTS.len()],
}

/// The worse first. Of equal ones the first of the production.
fn by_badness(one: &Unit, other: &Unit) -> Ordering {
    let key = |unit: &Unit| (!unit.outcome.verdict.is_malfunction(), unit.outcome.end.z);
    let ((runs, z), (other_runs, other_z)) = (key(one), key(other));
    let by_travel = if runs { Ordering::Equal } else { z.total_cmp(&other_z) };
    let force = |unit: &Unit| unit.outcome.peak_force.unwrap_or(f64::NEG_INFINITY);
    let by_force = force(other).total_cmp(&force(one));
    runs.cmp(&other_runs).then(by_travel).then(by_force).then(one.number.cmp(&other.number))
}

/// Puts `unit` in its place by `order` and keeps the first `most`.
fn keep(kept: &mut Vec<Unit>, unit: &Unit, most: usize, order: impl Fn(&Unit, &Unit) -> Ordering) {
    let place = kept.partition_point(|other| order(other, unit) == Ordering::Less);
    if place < most {
        kept.insert(place, unit.clone());
        kept.truncate(most);
    }
}

impl Default for Tally {
    fn default() -> Self {
        Self::new()
    }
}

impl Tally {
    /// Of no units.
    pub fn new() -> Self {
        Self {
            counts: Counts::default(),
            figures: Figures::default(),
            outcomes: Outcomes::default(),
            worst: Vec::new(),
            first: [const { Vec::new() }; VERDICTS.len()],
        }
    }

    /// Adds those of another.
    pub fn join(&mut self, mut other: Self) {
        self.counts.each().zip(other.counts.each()).for_each(|(own, other)| *own += *other);
        self.figures.each_mut().into_iter().zip(other.figures.each()).for_each(|(own, other)| own.join(other));
        self.outcomes.join(&other.outcomes);
        let pressed = &mut self.counts.pressed;
        pressed.resize(pressed.len().max(other.counts.pressed.len()), 0);
        pressed.iter_mut().zip(&other.counts.pressed).for_each(|(own, other)| *own += other);
        other.worst.iter().for_each(|unit| keep(&mut self.worst, unit, WORST, by_badness));
        other.first.iter().flatten().for_each(|unit| self.keep_first(unit));
    }

    fn keep_first(&mut self, unit: &Unit) {
        let verdict = VERDICTS.iter().position(|verdict| *verdict == unit.outcome.verdict).unwrap_or(0);
        keep(&mut self.first[verdict], unit, FIRST, |one, other| one.number.cmp(&other.number));
    }

    /// Units that malfunction so on that side.
    pub fn of_kind(&self, kind: Kind, side: Side) -> u64 {
        let [tight, loose] = KINDS
            .iter()
            .zip(self.counts.kinds)
            .find_map(|(own, count)| (*own == kind).then_some(count))
            .unwrap_or_default();
        match side {
            Side::Tight => tight,
            Side::Loose => loose,
            Side::Any => tight + loose,
        }
    }

    /// The first units of the production, in order, as far as all of them are kept.
    pub fn first_units(&self) -> Vec<&Unit> {
        let full = self.first.iter().filter(|kept| kept.len() == FIRST);
        let last = full.filter_map(|kept| kept.last()).map(|unit| unit.number).min().unwrap_or(u64::MAX);
        let mut units: Vec<_> = self.first.iter().flatten().filter(|unit| unit.number <= last).collect();
        units.sort_by_key(|unit| unit.number);
        units
    }
}

/// Counts the units of a production.
pub struct Counter<'a> {
    subject: &'a dyn Subject,
    duty: Duty,
}

impl<'a> Counter<'a> {
    /// Of a production of `subject`.
    pub fn new(subject: &'a dyn Subject, duty: Duty) -> Self {
        Self { subject, duty }
    }

    /// Of no units.
    pub fn nothing(&self) -> Tally {
        Tally::new()
    }

    /// Adds the `units`.
    pub fn add(&self, tally: &mut Tally, units: &[Unit]) {
        let Duty { limit, stroke } = self.duty;
        let Figures { force, running_force, failing_force, breakaway, final_velocity, tightness, failing_tightness } =
            &mut tally.figures;
        let counts = &mut tally.counts;
        let count = |count: &mut u64, is: bool| *count += u64::from(is);
        for unit in units {
            let outcome = &unit.outcome;
            let (runs, fails) = (outcome.verdict == Verdict::Runs, malfunctions(unit, limit));
            counts.units += 1;
            tally.outcomes.add(unit.number, outcome.peak_force, fails);
            VERDICTS.iter().zip(&mut counts.verdicts).for_each(|(of, own)| count(own, *of == outcome.verdict));
            count(&mut counts.short, runs && stroke.is_some_and(|stroke| outcome.end.z < stroke - SHORT));
            count(&mut counts.over_limit, is_over(unit, limit));
            count(&mut counts.malfunctions, fails);
            count(&mut counts.at_desk, outcome.at_desk);
            FAULTS.iter().zip(&mut counts.faults).for_each(|(of, own)| count(own, Some(*of) == outcome.fault));
            let n = self.subject.tightness(&unit.gaps);
            tightness.add(n);
            if let Some(peak) = outcome.peak_force {
                force.add(peak);
                if runs {
                    running_force.add(peak);
                }
                if fails {
                    failing_force.add(peak);
                }
            }
            outcome.breakaway.into_iter().for_each(|t| breakaway.add(t));
            if !matches!(outcome.fault, Some(Fault::Unsolved | Fault::OutOfBounds)) {
                final_velocity.add(outcome.final_velocity);
            }
            if fails {
                failing_tightness.add(n);
                let kind = Kind::of(unit, limit);
                let side = usize::from(n <= 0.0);
                KINDS.iter().zip(&mut counts.kinds).for_each(|(of, own)| count(&mut own[side], Some(*of) == kind));
                if let Some((contact, _)) = outcome.most_loaded {
                    counts.pressed.resize(counts.pressed.len().max(contact + 1), 0);
                    counts.pressed[contact] += 1;
                }
            }
        }
        for unit in units {
            keep(&mut tally.worst, unit, WORST, by_badness);
            tally.keep_first(unit);
        }
    }
}
