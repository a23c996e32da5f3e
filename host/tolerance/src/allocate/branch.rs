//! Branch and bound over processes and steps.

use std::{cmp::Ordering, collections::BinaryHeap};

use super::{
    cost::Values,
    dual::Bound,
    program::{Choices, Piece, Program, Span},
};

/// How near to the bound (share of the cost) a solution is taken as the cheapest.
pub const GAP: f64 = 1e-8;
/// How near to its budget a row of a bound is brought, and of a solution.
const ACCURACY: [f64; 2] = [1e-7, 1e-13];
/// How far a budget may be exceeded by rounding.
const ROUNDING: f64 = 1e-12;
/// The most boxes that are looked at.
const MOST: usize = 50_000;
/// Steps that pull a solution back into its budgets.
const PULLS: usize = 60;

/// The cheapest choice.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// Process of every tolerance.
    pub processes: Vec<usize>,
    /// Every tolerance (SI).
    pub tolerances: Vec<f64>,
    /// Cost of all.
    pub cost: f64,
    /// λ of every row: what the cost falls by if the logarithm of its budget rises by one, all processes and steps held.
    pub prices: Vec<f64>,
    /// No choice costs less than this.
    pub bound: f64,
}

/// Choices that are still to be looked at, and the bound of their cost.
struct Node {
    choices: Choices,
    bound: Bound,
}

impl PartialEq for Node {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Node {}

impl PartialOrd for Node {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Node {
    fn cmp(&self, other: &Self) -> Ordering {
        // The cheapest first.
        other.bound.value.total_cmp(&self.bound.value)
    }
}

impl Program<'_> {
    /// The cheapest tolerances; `None` if the tightest of all do not meet a budget.
    pub fn solve(&self) -> Option<Solution> {
        let whole = self.whole();
        let tightest = self.tightest(&whole);
        if !self.rows.iter().all(|row| row.usage(&tightest) <= 1.0 + ROUNDING) {
            return None;
        }
        let mut best: Option<Solution> = None;
        let mut heap = BinaryHeap::new();
        let root = self.greatest_bound(&whole, vec![0.0; self.rows.len()], ACCURACY[0]);
        heap.push(Node { choices: whole, bound: root });
        let mut lowest = f64::NEG_INFINITY;
        for _ in 0..MOST {
            let Some(Node { choices, bound }) = heap.pop() else {
                lowest = f64::INFINITY;
                break;
            };
            lowest = bound.value;
            if best.as_ref().is_some_and(|best| lowest >= best.cost * (1.0 - GAP)) {
                break;
            }
            let fixed = fixed(&choices, &bound);
            if let Some(found) = self.solve_fixed(&fixed, &bound.prices)
                && best.as_ref().is_none_or(|best| found.cost < best.cost)
            {
                best = Some(found);
            }
            for choices in self.split(&choices, &bound).into_iter().flatten() {
                let tightest = self.tightest(&choices);
                if self.rows.iter().all(|row| row.usage(&tightest) <= 1.0 + ROUNDING) {
                    let bound = self.greatest_bound(&choices, bound.prices.clone(), ACCURACY[0]);
                    heap.push(Node { choices, bound });
                }
            }
        }
        best.map(|best| Solution { bound: lowest.min(best.cost), ..best })
    }

    /// The least cost with the processes of a solution, and with the values that it takes from lists.
    pub fn cost_with(&self, solution: &Solution) -> f64 {
        let of = |(item, (process, t)): (usize, (&usize, &f64))| {
            let span = match &self.processes[item][*process].values {
                Values::Range(range) => Span::Range(*range),
                Values::List(values) => {
                    let point = values.partition_point(|value| value < t).min(values.len() - 1);
                    Span::Points([point, point + 1])
                }
            };
            vec![Piece { process: *process, span }]
        };
        let choices: Choices = solution.processes.iter().zip(&solution.tolerances).enumerate().map(of).collect();
        self.greatest_bound(&choices, vec![0.0; self.rows.len()], ACCURACY[1]).value
    }

    /// The cheapest of choices that leave one range or one value to every tolerance.
    fn solve_fixed(&self, choices: &Choices, prices: &[f64]) -> Option<Solution> {
        let tightest = self.tightest(choices);
        let within = |tolerances: &[f64], by: f64| self.rows.iter().all(|row| row.usage(tolerances) <= 1.0 + by);
        if !within(&tightest, ROUNDING) {
            return None;
        }
        let found = self.greatest_bound(choices, prices.to_vec(), ACCURACY[1]);
        let mut tolerances = found.tolerances();
        if !within(&tolerances, ROUNDING) {
            let part = |share: f64| -> Vec<f64> {
                tightest.iter().zip(&tolerances).map(|(low, t)| low + share * (t - low)).collect()
            };
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..PULLS {
                let middle = 0.5 * (low + high);
                if within(&part(middle), 0.0) { low = middle } else { high = middle }
            }
            tolerances = part(low);
        }
        let processes: Vec<usize> = choices.iter().map(|pieces| pieces[0].process).collect();
        let cost = processes.iter().zip(&tolerances).enumerate();
        let cost = cost.map(|(item, (process, t))| self.processes[item][*process].law.cost(*t)).sum();
        Some(Solution { processes, tolerances, cost, prices: found.prices, bound: found.value })
    }

    /// Two parts of the choices, apart at the tolerance that can be chosen otherwise at the least price; `None` if there is
    /// nothing to choose.
    fn split(&self, choices: &Choices, bound: &Bound) -> Option<[Choices; 2]> {
        let mut least: Option<(f64, usize, [Vec<Piece>; 2])> = None;
        for (item, (pieces, pick)) in choices.iter().zip(&bound.picks).enumerate() {
            let prices = self.prices(item, &bound.prices);
            let chosen = pieces[pick.piece];
            let others = pieces.iter().enumerate().filter(|(number, _)| *number != pick.piece);
            let others: Vec<(f64, Piece)> =
                others.map(|(number, piece)| (self.best_in(item, number, piece, prices).total, *piece)).collect();
            let mut offer = |regret: f64, parts: [Vec<Piece>; 2]| {
                if least.as_ref().is_none_or(|(best, ..)| regret < *best) {
                    least = Some((regret, item, parts));
                }
            };
            if let Some(next) = others.iter().map(|(total, _)| *total).reduce(f64::min) {
                offer(next - pick.total, [vec![chosen], others.iter().map(|(_, piece)| *piece).collect()]);
            }
            let Span::Points([first, end]) = chosen.span else { continue };
            // Apart on the side of the better neighbour.
            let sides = [(pick.point > first).then_some(pick.point), (pick.point + 1 < end).then_some(pick.point + 1)];
            for border in sides.into_iter().flatten() {
                let neighbour = if border == pick.point { pick.point - 1 } else { pick.point + 1 };
                let t = self.point(item, chosen.process, neighbour);
                let law = &self.processes[item][chosen.process].law;
                let total = law.cost(t) + prices[0] * t + prices[1] * t * t;
                let part = |points: [usize; 2]| Piece { span: Span::Points(points), ..chosen };
                let rest = others.iter().map(|(_, piece)| *piece);
                let with = |own: [usize; 2], other: [usize; 2]| {
                    [vec![part(own)], std::iter::once(part(other)).chain(rest.clone()).collect()]
                };
                let parts = if border == pick.point {
                    with([border, end], [first, border])
                } else {
                    with([first, border], [border, end])
                };
                offer(total - pick.total, parts);
            }
        }
        let (_, item, parts) = least?;
        Some(parts.map(|pieces| {
            let mut choices = choices.clone();
            choices[item] = pieces;
            choices
        }))
    }
}

/// What `bound` chooses, with the whole range of the process that it is from.
fn fixed(choices: &Choices, bound: &Bound) -> Choices {
    let only = |(pieces, pick): (&Vec<Piece>, &super::program::Pick)| {
        let piece = pieces[pick.piece];
        let span = match piece.span {
            range @ Span::Range(_) => range,
            Span::Points(_) => Span::Points([pick.point, pick.point + 1]),
        };
        vec![Piece { span, ..piece }]
    };
    choices.iter().zip(&bound.picks).map(only).collect()
}
