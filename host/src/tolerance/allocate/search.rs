//! The cheapest tolerances by figures of any kind: one separable program after another.
//!
//! Around some tolerances every figure is taken for a constant and a weighted sum of powers that has its value and its slopes there.
//! The cheapest tolerances under these are where the figures are looked at next. For measures that are linear the first program
//! is the right one. A solution counts only if the figures themselves are met there.

use rayon::prelude::*;

use super::{
    AllocateError,
    branch::Solution,
    cost::Process,
    program::{Power, Program, Row},
};

/// Distance of tolerances for slopes (share of the tolerance).
const STEP: f64 = 0.02;
/// Figures beyond this say little of where they would be 1.
const FAR: f64 = 9.0;
/// How far a figure may be above 1, and off it where it has a price.
pub const MET: f64 = 1e-6;
/// The most programs, and the most corrections of one.
const PROGRAMS: usize = 16;
const CORRECTIONS: usize = 6;
/// A change of the cost (share of it) that no longer counts.
const STILL: f64 = 1e-7;

/// What requirements come to: figures that must not exceed 1.
pub trait Figures: Sync {
    /// How each figure grows with tolerances.
    fn powers(&self) -> Vec<Power>;

    /// The figures at `tolerances` (SI).
    ///
    /// # Errors
    /// [`AllocateError`], if there are none.
    fn values(&self, tolerances: &[f64]) -> Result<Vec<f64>, AllocateError>;
}

/// The cheapest tolerances that were found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Processes, tolerances and cost; prices are what the cost falls by for every unit that a figure may rise by. The bound is
    /// that of the last program.
    pub solution: Solution,
    /// The figures.
    pub figures: Vec<f64>,
}

/// Finds the cheapest tolerances of `processes`, from `start` on.
///
/// # Errors
/// [`AllocateError::Infeasible`], if the tightest of all do not meet the requirements.
pub fn search(processes: &[&[Process]], start: &[f64], figures: &dyn Figures) -> Result<Found, AllocateError> {
    let powers = figures.powers();
    let ends = |of: &[Process], end: usize, pick: fn(f64, f64) -> f64| {
        of.iter().map(|process| process.values.ends()[end]).reduce(pick).unwrap_or(f64::NAN)
    };
    let tightest: Vec<f64> = processes.iter().map(|of| ends(of, 0, f64::min)).collect();
    let least = figures.values(&tightest)?;
    if !least.iter().all(|figure| *figure <= 1.0 + MET) {
        return Err(AllocateError::Infeasible { tightest, figures: least });
    }
    let between = |tolerances: &[f64]| -> Vec<f64> {
        tolerances.iter().zip(&tightest).map(|(t, least)| libm::sqrt(t * least)).collect()
    };
    let widest = processes.iter().map(|of| ends(of, 1, f64::max));
    let mut at: Vec<f64> =
        start.iter().zip(&tightest).zip(widest).map(|((t, low), high)| t.clamp(*low, high)).collect();
    let mut values = figures.values(&at)?;
    let mut best: Option<Found> = None;
    let mut last = f64::INFINITY;
    for _ in 0..PROGRAMS {
        if crate::system::interrupt::requested() {
            return Err(AllocateError::Interrupted);
        }
        if values.iter().any(|figure| !figure.is_finite() || *figure > FAR) {
            at = between(&at);
            values = figures.values(&at)?;
            continue;
        }
        let weights = weights(&at, &powers, figures)?;
        let mut rows: Vec<Row> =
            weights.into_iter().zip(&powers).map(|(weights, power)| Row { power: *power, weights }).collect();
        // A tolerance that lowers a figure, by rounding or by a shift of the mean, counts as without effect.
        rows.iter_mut().for_each(|row| row.weights.iter_mut().for_each(|weight| *weight = weight.max(0.0)));
        let mut constants: Vec<f64> = rows.iter().zip(&values).map(|(row, value)| value - row.usage(&at)).collect();
        let mut next = None;
        for _ in 0..CORRECTIONS {
            let Some(solution) = solve(processes, &rows, &constants) else { break };
            let found = figures.values(&solution.tolerances)?;
            let met = found.iter().all(|figure| *figure <= 1.0 + MET);
            let used = found.iter().zip(&solution.prices).all(|(figure, price)| *price == 0.0 || *figure >= 1.0 - MET);
            for ((constant, row), figure) in constants.iter_mut().zip(&rows).zip(&found) {
                *constant = figure - row.usage(&solution.tolerances);
            }
            if met && best.as_ref().is_none_or(|best| solution.cost < best.solution.cost) {
                best = Some(Found { solution: solution.clone(), figures: found.clone() });
            }
            next = Some((solution, found));
            if met && used {
                break;
            }
        }
        let Some((solution, found)) = next else {
            at = between(&at);
            values = figures.values(&at)?;
            continue;
        };
        let still = (solution.cost - last).abs() <= STILL * solution.cost.abs();
        (at, values, last) = (solution.tolerances, found, solution.cost);
        if still && best.is_some() {
            break;
        }
    }
    best.ok_or(AllocateError::NotFound)
}

/// The cheapest tolerances where every figure is its constant and its row.
fn solve(processes: &[&[Process]], rows: &[Row], constants: &[f64]) -> Option<Solution> {
    let mut budgets = Vec::with_capacity(rows.len());
    let mut scaled = Vec::new();
    for (row, constant) in rows.iter().zip(constants) {
        let budget = 1.0 - constant;
        if budget.is_nan() || budget <= 0.0 {
            return None;
        }
        budgets.push(budget);
        scaled.push(Row { power: row.power, weights: row.weights.iter().map(|weight| weight / budget).collect() });
    }
    let mut solution = Program { processes: processes.to_vec(), rows: scaled }.solve()?;
    solution.prices.iter_mut().zip(budgets).for_each(|(price, budget)| *price /= budget);
    Some(solution)
}

/// Of every figure, its slope in the power of every tolerance, by central differences.
fn weights(at: &[f64], powers: &[Power], figures: &dyn Figures) -> Result<Vec<Vec<f64>>, AllocateError> {
    let moved: Vec<(usize, f64)> = (0..at.len()).flat_map(|item| [(item, 1.0 - STEP), (item, 1.0 + STEP)]).collect();
    let values = moved.into_par_iter().map(|(item, factor)| {
        let mut tolerances = at.to_vec();
        tolerances[item] *= factor;
        figures.values(&tolerances)
    });
    let values = values.collect::<Result<Vec<_>, _>>()?;
    let weight = |row: usize, item: usize| {
        let [low, high] = [2 * item, 2 * item + 1].map(|point| values[point][row]);
        let [tight, wide] = [1.0 - STEP, 1.0 + STEP].map(|factor| powers[row].of(factor * at[item]));
        (high - low) / (wide - tight)
    };
    Ok((0..powers.len()).map(|row| (0..at.len()).map(|item| weight(row, item)).collect()).collect())
}
