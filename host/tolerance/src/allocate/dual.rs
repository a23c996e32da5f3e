//! The Lagrangian bound: rows become prices, and every tolerance is chosen alone.
//!
//! For any prices λ ≥ 0 the least of Σ cost + Σ λⱼ(rowⱼ − 1) over all choices bounds the cost from below. It is concave in λ.
//! Where every tolerance has one range it is smooth, and its greatest value is the least cost (costs are convex there).

use nalgebra::{DMatrix, DVector};

use super::program::{Choices, Pick, Program, Span};

/// Sweeps through all prices.
const SWEEPS: usize = 60;
/// Steps that enclose a price, each a factor of 16, and steps that narrow it.
const ENCLOSING: usize = 80;
const NARROWING: usize = 100;
/// Halvings of a Newton step.
const HALVINGS: usize = 12;

/// What follows from prices.
#[derive(Clone, Debug)]
pub struct Bound {
    /// Prices of the rows.
    pub prices: Vec<f64>,
    /// The best of every tolerance.
    pub picks: Vec<Pick>,
    /// Bound of the cost.
    pub value: f64,
    /// Share of its budget that each row uses.
    pub usage: Vec<f64>,
}

impl Program<'_> {
    /// The bound at `prices`.
    pub fn bound(&self, choices: &Choices, prices: Vec<f64>) -> Bound {
        let best = |(item, pieces): (usize, &Vec<_>)| self.best(item, pieces, self.prices(item, &prices));
        let picks: Vec<Pick> = choices.iter().enumerate().map(best).collect();
        let tolerances: Vec<f64> = picks.iter().map(|pick| pick.t).collect();
        let value = picks.iter().map(|pick| pick.total).sum::<f64>() - prices.iter().sum::<f64>();
        let usage = self.rows.iter().map(|row| row.usage(&tolerances)).collect();
        Bound { prices, picks, value, usage }
    }

    /// The greatest bound, searched for from `prices` on; what is found bounds the cost however near it comes. Rows end
    /// within `accuracy` of their budgets, on the safe side, where the bound is smooth.
    pub fn greatest_bound(&self, choices: &Choices, prices: Vec<f64>, accuracy: f64) -> Bound {
        let mut found = self.bound(choices, prices);
        for _ in 0..SWEEPS {
            let before = found.value;
            for row in 0..self.rows.len() {
                found = self.with_price(choices, found, row, accuracy);
            }
            if self.rows.len() < 2 || found.met(accuracy) {
                break;
            }
            if let Some(better) = self.newton(choices, &found) {
                found = better;
                if found.met(accuracy) {
                    break;
                }
            } else if found.value - before <= accuracy * found.value.abs() {
                break;
            }
        }
        found
    }

    /// With the best price of one row, at which its budget is used up, or nothing where it is not.
    fn with_price(&self, choices: &Choices, found: Bound, row: usize, accuracy: f64) -> Bound {
        let at = |price: f64| {
            let mut prices = found.prices.clone();
            prices[row] = price;
            self.bound(choices, prices)
        };
        let free = if found.prices[row] == 0.0 { found.clone() } else { at(0.0) };
        if free.usage[row] <= 1.0 {
            return free;
        }
        // In logarithms usage over price is nearly a line.
        let excess = |bound: &Bound| libm::log(bound.usage[row]);
        let start = if found.prices[row] > 0.0 { found.prices[row] } else { free.value.abs().max(1e-9) };
        let mut here = at(start);
        let [mut low, mut high]: [(f64, f64); 2];
        let x = libm::log(start);
        let step = libm::log(16.0);
        if excess(&here) > 0.0 {
            (low, high) = ((x, excess(&here)), (x, excess(&here)));
            for _ in 0..ENCLOSING {
                low = high;
                here = at(libm::exp(low.0 + step));
                high = (low.0 + step, excess(&here));
                if high.1 <= 0.0 {
                    break;
                }
            }
        } else {
            (low, high) = ((x, excess(&here)), (x, excess(&here)));
            for _ in 0..ENCLOSING {
                high = low;
                let next = at(libm::exp(high.0 - step));
                low = (high.0 - step, excess(&next));
                if low.1 > 0.0 {
                    break;
                }
                here = next;
            }
        }
        if high.1 > 0.0 || low.1 <= 0.0 {
            return here;
        }
        // Regula falsi that halves the value of an end which stays (Illinois), every third step in the middle.
        let mut stays = [1.0, 1.0];
        for number in 0..NARROWING {
            if high.1 >= -accuracy || high.0 - low.0 <= accuracy {
                break;
            }
            let (left, right) = (low.1 * stays[0], high.1 * stays[1]);
            let share = if number % 3 == 2 { 0.5 } else { (left / (left - right)).clamp(0.001, 0.999) };
            let x = low.0 + share * (high.0 - low.0);
            let next = at(libm::exp(x));
            let value = excess(&next);
            if value > 0.0 {
                low = (x, value);
                stays = [1.0, 0.5 * stays[1]];
            } else {
                high = (x, value);
                here = next;
                stays = [0.5 * stays[0], 1.0];
            }
        }
        here
    }

    /// A Newton step of all prices that are not nothing, shortened until the bound grows; `None` if it does not.
    fn newton(&self, choices: &Choices, found: &Bound) -> Option<Bound> {
        let active: Vec<usize> =
            (0..self.rows.len()).filter(|row| found.prices[*row] > 0.0 || found.usage[*row] > 1.0).collect();
        let mut matrix = DMatrix::<f64>::zeros(active.len(), active.len());
        for (item, (pick, pieces)) in found.picks.iter().zip(choices).enumerate() {
            let piece = pieces[pick.piece];
            let Span::Range([low, high]) = piece.span else { continue };
            if pick.t <= low || pick.t >= high {
                continue;
            }
            let law = self.processes[item][piece.process].law;
            let curvature = law.derivatives(pick.t)[1] + 2.0 * self.prices(item, &found.prices)[1];
            let slope = |row: usize| self.rows[row].weights[item] * self.rows[row].power.slope(pick.t);
            for (m, row) in active.iter().enumerate() {
                for (n, other) in active.iter().enumerate() {
                    matrix[(m, n)] += slope(*row) * slope(*other) / curvature;
                }
            }
        }
        let most = matrix.diagonal().max();
        if !(most > 0.0 && most.is_finite()) {
            return None;
        }
        // Rows that go together leave the matrix singular.
        (0..active.len()).for_each(|m| matrix[(m, m)] += 1e-10 * most);
        let excess = DVector::from_iterator(active.len(), active.iter().map(|row| found.usage[*row] - 1.0));
        let step = matrix.cholesky()?.solve(&excess);
        let mut length = 1.0;
        for _ in 0..HALVINGS {
            let mut prices = found.prices.clone();
            active
                .iter()
                .zip(step.iter())
                .for_each(|(row, step)| prices[*row] = (prices[*row] + length * step).max(0.0));
            let next = self.bound(choices, prices);
            if next.value > found.value {
                return Some(next);
            }
            length *= 0.5;
        }
        None
    }
}

impl Bound {
    /// Whether no budget is exceeded and those with a price are used up, within an `accuracy`.
    pub fn met(&self, accuracy: f64) -> bool {
        let rows = self.prices.iter().zip(&self.usage);
        rows.into_iter().all(|(price, usage)| *usage <= 1.0 + accuracy && (*price == 0.0 || *usage >= 1.0 - accuracy))
    }

    /// The chosen tolerances.
    pub fn tolerances(&self) -> Vec<f64> {
        self.picks.iter().map(|pick| pick.t).collect()
    }
}
