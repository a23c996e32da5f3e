//! Tolerances traded against each other, by the figures themselves.
//!
//! Figures of measures with kinks may fall in steps, or along one tolerance only where another is tight, which no separable program
//! around some tolerances tells. Here a tolerance is widened where that is possible, or where another one that is tightened instead costs
//! less; steps get shorter until none of two thousandths is left that saves anything (a pattern search: Kolda, Lewis and Torczon, SIAM Review
//! 45, 2003). It assumes that a tighter tolerance is never worse, and finds a local minimum.

use slipfit_system::parallel;

use super::{
    AllocateError,
    branch::Solution,
    cost::{Process, Values},
    figures::{Figures, MET},
};

/// Steps, as logarithms of a factor, from the longest to the shortest.
const STEPS: [f64; 5] = [0.6, 0.15, 0.04, 0.01, 0.002];
/// How much more or less the other one of a pair is tightened.
const AGAINST: [f64; 4] = [0.3, 1.0, 3.0, 10.0];
/// What a step has to save, as a share of the cost.
const SAVES: f64 = 1e-6;
/// Trials that are made at once.
const AT_ONCE: usize = 8;

/// Tolerances that meet all figures.
#[derive(Clone, Debug)]
struct Choice {
    /// No tolerance is wider than this (logarithm of SI).
    bounds: Vec<f64>,
    processes: Vec<usize>,
    tolerances: Vec<f64>,
    cost: f64,
}

/// What a step may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moves {
    /// One tolerance, which is widened, or all of them.
    Wider,
    /// Two, of which one is tightened, as well.
    Pairs,
}

/// The cheapest tolerances of `processes` that are found from `start` on by `moves`, of which no figure is above what is `allowed`, and
/// their figures; those of `start` are not.
///
/// # Errors
/// [`AllocateError`], if there are no figures.
pub fn exchanged(
    processes: &[&[Process]],
    start: &[f64],
    (figures, allowed): (&dyn Figures, &[f64]),
    moves: Moves,
) -> Result<Option<(Solution, Vec<f64>)>, AllocateError> {
    let Some(mut best) = choice(processes, start.iter().map(|t| libm::log(*t)).collect()) else {
        return Ok(None);
    };
    for step in STEPS {
        // Each step saves a share of the cost, so that there is a last one.
        while let Some(next) = step_from(processes, &best, (step, moves), (figures, allowed))? {
            best = next;
        }
    }
    let found = figures.values(&best.tolerances)?;
    // With the widest tolerances of all.
    let bound =
        choice(processes, vec![f64::INFINITY; best.bounds.len()]).map_or(f64::NEG_INFINITY, |widest| widest.cost);
    let Choice { processes, tolerances, cost, .. } = best;
    Ok(Some((Solution { processes, tolerances, cost, prices: vec![0.0; found.len()], bound }, found)))
}

/// A cheaper choice one `step` away of which no figure is above what is allowed.
fn step_from(
    processes: &[&[Process]],
    from: &Choice,
    (step, moves): (f64, Moves),
    (figures, allowed): (&dyn Figures, &[f64]),
) -> Result<Option<Choice>, AllocateError> {
    let count = from.bounds.len();
    // By one step, or to the next tolerance that costs less: between some, or up to another process, there may be none.
    let wider: Vec<f64> =
        (0..count).map(|item| (from.bounds[item] + step).max(next_cheaper(processes[item], from, item))).collect();
    let moved = |moves: &[(usize, f64)]| {
        let mut bounds = from.bounds.clone();
        for (item, by) in moves {
            bounds[*item] = if *by > 0.0 { wider[*item] } else { bounds[*item] + by };
        }
        choice(processes, bounds).filter(|next| next.cost < from.cost * (1.0 - SAVES))
    };
    let all: Vec<(usize, f64)> = (0..count).map(|item| (item, step)).collect();
    let mut trials: Vec<Choice> = moved(&all).into_iter().collect();
    trials.extend((0..count).filter_map(|item| moved(&[(item, step)])));
    for wider in (0..count).filter(|_| moves == Moves::Pairs) {
        for tighter in (0..count).filter(|tighter| *tighter != wider) {
            trials.extend(AGAINST.iter().filter_map(|by| moved(&[(wider, step), (tighter, -by * step)])));
        }
    }
    trials.sort_by(|one, other| one.cost.total_cmp(&other.cost));
    for trials in trials.chunks(AT_ONCE) {
        if slipfit_system::interrupt::requested() {
            return Err(AllocateError::Interrupted);
        }
        let values = parallel::map(trials, |next| figures.values(&next.tolerances));
        for (next, values) in trials.iter().zip(values) {
            if values?.iter().zip(allowed).all(|(figure, allowed)| *figure <= allowed + MET) {
                return Ok(Some(next.clone()));
            }
        }
    }
    Ok(None)
}

/// The cheapest processes, and the widest tolerances that they hold, within these bounds. None where a process holds nothing so tight.
fn choice(processes: &[&[Process]], bounds: Vec<f64>) -> Option<Choice> {
    let mut all = Choice { bounds, processes: Vec::new(), tolerances: Vec::new(), cost: 0.0 };
    for (of, bound) in processes.iter().zip(&mut all.bounds) {
        let most = libm::exp(*bound);
        let held = of.iter().enumerate().filter_map(|(process, of)| {
            let t = widest(&of.values, most)?;
            Some((process, t, of.law.cost(t)))
        });
        let (process, t, cost) = held.min_by(|one, other| one.2.total_cmp(&other.2))?;
        // Beyond what any process holds a bound means nothing.
        let ends = of.iter().map(|process| process.values.ends()[1]);
        *bound = bound.min(libm::log(ends.fold(0.0, f64::max)));
        all.processes.push(process);
        all.tolerances.push(t);
        all.cost += cost;
    }
    Some(all)
}

/// The least bound (logarithm of SI) of an `item` within which something costs less than what it has; −∞ if nothing does.
fn next_cheaper(processes: &[Process], from: &Choice, item: usize) -> f64 {
    let (most, now) = (from.tolerances[item], processes[from.processes[item]].law.cost(from.tolerances[item]));
    let cheaper = |of: &Process| match &of.values {
        Values::List(values) => values.iter().copied().find(|t| *t > most && of.law.cost(*t) < now),
        Values::Range([low, high]) if of.law.cost(*high) < now && *high > most => {
            // Costs fall.
            let (mut dear, mut cheap) = (low.max(most), *high);
            while cheap > dear * (1.0 + SAVES) {
                let middle = libm::sqrt(dear * cheap);
                if of.law.cost(middle) < now { cheap = middle } else { dear = middle }
            }
            Some(if of.law.cost(low.max(most)) < now { low.max(most) } else { cheap })
        }
        Values::Range(_) => None,
    };
    processes.iter().filter_map(cheaper).reduce(f64::min).map_or(f64::NEG_INFINITY, libm::log)
}

/// The widest of `values` that is at most `most`.
fn widest(values: &Values, most: f64) -> Option<f64> {
    match values {
        Values::Range([low, high]) => (most >= *low * (1.0 - MET)).then(|| most.clamp(*low, *high)),
        Values::List(values) => values.iter().rev().find(|t| **t <= most * (1.0 + MET)).copied(),
    }
}
