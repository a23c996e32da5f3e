//! The cheapest tolerances by figures of any kind: one separable program after another.
//!
//! Around some tolerances every figure is taken for a constant and a weighted sum of powers that has its value and its slopes there.
//! The cheapest tolerances under these are where the figures are looked at next. For measures that are linear the first program
//! is the right one. A solution counts only if the figures themselves are met there. Where programs come to no end, or slopes do not
//! describe what is required, tolerances are traded against each other from there on.

use super::{
    AllocateError,
    branch::Solution,
    cost::Process,
    exchange::{Moves, exchanged},
    figures::{Figures, MET},
    program::{Program, Row},
    slopes::weights,
};

/// Figures beyond this say little of where they would be 1.
const FAR: f64 = 9.0;
/// Figures within so many times of what they may rise by below 1 get a price by trades.
const BINDS: f64 = 2.0;
/// What wider or traded tolerances have to save, as a share of the cost, to speak against a program.
const WIDENS: f64 = 1e-3;
/// The most corrections of a program.
const CORRECTIONS: usize = 6;

/// The cheapest tolerances that were found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Processes, tolerances and cost; prices are what the cost falls by for every unit that a figure may rise by, all others
    /// held. The bound is that of the last program; where that has none, the cost of the widest tolerances.
    pub solution: Solution,
    /// The figures.
    pub figures: Vec<f64>,
    /// What the cost falls by where all figures which bind have their relief together, if there are several: then none of them may gain
    /// anything alone.
    pub together: Option<f64>,
    /// Whether they were found by trades of tolerances, since no program describes what is required.
    pub traded: bool,
}

/// Finds the cheapest tolerances of `processes`, from `start` on.
///
/// # Errors
/// [`AllocateError::Infeasible`], if the tightest of all do not meet the requirements.
pub fn search(processes: &[&[Process]], start: &[f64], figures: &dyn Figures) -> Result<Found, AllocateError> {
    let precision = figures.precision();
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
    let limits: Vec<[f64; 2]> =
        processes.iter().zip(&tightest).map(|(of, low)| [*low, ends(of, 1, f64::max)]).collect();
    let mut at: Vec<f64> = start.iter().zip(&limits).map(|(t, [low, high])| t.clamp(*low, *high)).collect();
    let mut values = figures.values(&at)?;
    let mut best: Option<(Found, Local)> = None;
    let mut last = f64::INFINITY;
    let mut settled = false;
    for _ in 0..precision.programs {
        if slipfit_system::interrupt::requested() {
            return Err(AllocateError::Interrupted);
        }
        if values.iter().any(|figure| !figure.is_finite() || *figure > FAR) {
            at = between(&at);
            values = figures.values(&at)?;
            continue;
        }
        let Local { rows, mut constants } = Local::around(&at, &values, &limits, figures)?;
        let mut next = None;
        settled = false;
        for _ in 0..CORRECTIONS {
            let Some(solution) = solve(processes, &rows, &constants, (&at, precision.reach)) else { break };
            let found = figures.values(&solution.tolerances)?;
            let met = found.iter().all(|figure| *figure <= 1.0 + MET);
            let used = found
                .iter()
                .zip(&solution.prices)
                .all(|(figure, price)| *price == 0.0 || *figure >= 1.0 - precision.slack);
            for ((constant, row), figure) in constants.iter_mut().zip(&rows).zip(&found) {
                *constant = figure - row.usage(&solution.tolerances);
            }
            if met && best.as_ref().is_none_or(|(best, _)| solution.cost < best.solution.cost) {
                let local = Local { rows: rows.clone(), constants: constants.clone() };
                best = Some((
                    Found { solution: solution.clone(), figures: found.clone(), together: None, traded: false },
                    local,
                ));
            }
            next = Some((solution, found));
            settled = met && used;
            if settled {
                break;
            }
        }
        let Some((solution, found)) = next else {
            at = between(&at);
            values = figures.values(&at)?;
            continue;
        };
        let still = (solution.cost - last).abs() <= precision.still * solution.cost.abs();
        (at, values, last) = (solution.tolerances, found, solution.cost);
        settled &= still;
        if still && best.is_some() {
            break;
        }
    }
    let programmed = best.as_ref().map(|(found, _)| &found.solution);
    if precision.trades && (!settled || !figures.smooth() || widens(processes, programmed, figures)?) {
        let starts = std::iter::once(&tightest).chain(programmed.map(|solution| &solution.tolerances));
        let traded = traded(processes, &starts.collect::<Vec<_>>(), figures)?;
        if let Some(traded) = traded
            && programmed.is_none_or(|programmed| traded.solution.cost < programmed.cost * (1.0 - WIDENS))
        {
            return priced_by_trades(processes, traded, figures);
        }
    }
    let (mut found, local) = best.ok_or(AllocateError::NotFound)?;
    if !precision.trades {
        found = widened(processes, found, figures)?;
    }
    local.price(processes, &mut found, &figures.reliefs(), precision.slack);
    Ok(found)
}

/// Whether tolerances of a solution can be widened: then figures do not grow with them as its program took them to.
fn widens(processes: &[&[Process]], solution: Option<&Solution>, figures: &dyn Figures) -> Result<bool, AllocateError> {
    let Some(Solution { tolerances, cost, .. }) = solution else { return Ok(true) };
    let met = vec![1.0; figures.reliefs().len()];
    let wider = exchanged(processes, tolerances, (figures, &met), Moves::Wider)?;
    Ok(wider.is_some_and(|(wider, _)| wider.cost < cost * (1.0 - WIDENS)))
}

/// What programs `found` of counted figures, wider where these allow it: slopes between few counts err, so that a program may hold a tolerance
/// that matters little. For the same reason its bound is none; that without any requirement takes its place.
fn widened(processes: &[&[Process]], found: Found, figures: &dyn Figures) -> Result<Found, AllocateError> {
    let Found { solution, .. } = &found;
    let met = vec![1.0; found.figures.len()];
    let Some((wider, figures)) = exchanged(processes, &solution.tolerances, (figures, &met), Moves::Wider)? else {
        return Ok(found);
    };
    let prices = solution.prices.clone();
    if wider.cost < solution.cost * (1.0 - WIDENS) {
        return Ok(Found { solution: Solution { prices, ..wider }, figures, ..found });
    }
    let solution = Solution { bound: wider.bound, ..found.solution };
    Ok(Found { solution, ..found })
}

/// The cheapest of what trades find from each of `starts` on, all of which meet the figures; without prices.
fn traded(
    processes: &[&[Process]],
    starts: &[&Vec<f64>],
    figures: &dyn Figures,
) -> Result<Option<Found>, AllocateError> {
    let mut best: Option<Found> = None;
    let met = vec![1.0; figures.reliefs().len()];
    for start in starts {
        let Some((solution, figures)) = exchanged(processes, start, (figures, &met), Moves::Pairs)? else {
            continue;
        };
        if best.as_ref().is_none_or(|best| solution.cost < best.solution.cost) {
            best = Some(Found { solution, figures, together: None, traded: true });
        }
    }
    Ok(best)
}

/// What was `found`, with the prices of figures that bind: what trades save where these have their relief.
fn priced_by_trades(processes: &[&[Process]], mut found: Found, figures: &dyn Figures) -> Result<Found, AllocateError> {
    let reliefs = figures.reliefs();
    let bind: Vec<usize> =
        (0..reliefs.len()).filter(|row| found.figures[*row] >= 1.0 - BINDS * reliefs[*row]).collect();
    let fall = |loosened: &[usize]| -> Result<f64, AllocateError> {
        let allowed = |row: usize| if loosened.contains(&row) { 1.0 + reliefs[row] } else { 1.0 };
        let allowed: Vec<f64> = (0..reliefs.len()).map(allowed).collect();
        let cheaper = exchanged(processes, &found.solution.tolerances, (figures, &allowed), Moves::Pairs)?;
        Ok(cheaper.map_or(0.0, |(cheaper, _)| (found.solution.cost - cheaper.cost).max(0.0)))
    };
    let prices =
        bind.iter().map(|row| Ok(fall(&[*row])? / reliefs[*row])).collect::<Result<Vec<f64>, AllocateError>>()?;
    let alone = bind.iter().zip(&prices).map(|(row, price)| price * reliefs[*row]).fold(0.0, f64::max);
    let together = if bind.len() > 1 { Some(fall(&bind)?.max(alone)) } else { None };
    bind.iter().zip(prices).for_each(|(row, price)| found.solution.prices[*row] = price);
    found.together = together;
    Ok(found)
}

/// The program around a solution.
struct Local {
    rows: Vec<Row>,
    constants: Vec<f64>,
}

impl Local {
    /// Around tolerances with these values of the figures.
    fn around(at: &[f64], values: &[f64], ends: &[[f64; 2]], figures: &dyn Figures) -> Result<Self, AllocateError> {
        let weights = weights(figures.precision().slopes, at, ends, figures)?;
        let rows = weights.into_iter().zip(figures.powers()).map(|(weights, power)| Row { power, weights });
        let rows: Vec<Row> = rows.collect();
        let constants = rows.iter().zip(values).map(|(row, value)| value - row.usage(at)).collect();
        Ok(Self { rows, constants })
    }

    /// Prices figures that bind together, or would if another one had its relief. Multipliers do not tell what one of them gains alone:
    /// both limits of a symmetric measure have one multiplier between them, and to loosen one gains nothing, or not more than until the
    /// other binds. So each has its relief, and then all at once.
    fn price(&self, processes: &[&[Process]], found: &mut Found, reliefs: &[f64], slack: f64) {
        let binds = |row: usize| found.figures[row] >= 1.0 - 2.0 * slack;
        let bind: Vec<usize> =
            (0..self.rows.len()).filter(|row| binds(*row) || found.figures[*row] >= 1.0 - reliefs[*row]).collect();
        if bind.len() < 2 {
            return;
        }
        let cost = |loosened: &[usize]| -> f64 {
            // What is loosened comes last, so that of rows that are alike those that still bind have the price.
            let held = (0..self.rows.len()).filter(|row| !loosened.contains(row));
            let scaled = held.chain(loosened.iter().copied()).map(|row| {
                let more = if loosened.contains(&row) { reliefs[row] } else { 0.0 };
                // A figure that binds is taken to be 1.
                let usage = self.rows[row].usage(&found.solution.tolerances);
                let budget = if binds(row) { usage } else { 1.0 - self.constants[row] } + more;
                let weights = self.rows[row].weights.iter().map(|weight| weight / budget).collect();
                Row { power: self.rows[row].power, weights }
            });
            let program = Program { processes: processes.to_vec(), rows: scaled.collect(), near: None };
            program.cost_with(&found.solution)
        };
        let now = cost(&[]);
        let fall = |loosened: &[usize]| (now - cost(loosened)).max(0.0);
        let alone: Vec<f64> = bind.iter().map(|row| fall(&[*row]) / reliefs[*row]).collect();
        let together = fall(&bind);
        for (row, price) in bind.iter().zip(alone) {
            // The program is solved to so many digits.
            let is_none = price * reliefs[*row] < MET * together;
            found.solution.prices[*row] = if is_none { 0.0 } else { price };
        }
        found.together = Some(together);
    }
}

/// The cheapest tolerances where every figure is its constant and its row, within a factor of the tolerances they are `near`.
fn solve(processes: &[&[Process]], rows: &[Row], constants: &[f64], near: (&[f64], f64)) -> Option<Solution> {
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
    let mut solution = Program { processes: processes.to_vec(), rows: scaled, near: Some(near) }.solve()?;
    solution.prices.iter_mut().zip(budgets).for_each(|(price, budget)| *price /= budget);
    Some(solution)
}
