//! The separable program: the cheapest tolerances of which weighted sums of powers stay within budgets.
//!
//! minimise Σᵢ costᵢ(tᵢ) with Σᵢ wⱼᵢ·tᵢ^pⱼ ≤ 1 for every row j, where p is 1 (worst case) or 2 (root sum of squares), no weight
//! is negative, and every tᵢ is one that a process of its own can hold.

use super::cost::{Process, Values};

/// How a row grows with tolerances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Power {
    /// As their sum.
    One,
    /// As the sum of their squares.
    Two,
}

impl Power {
    /// Of a tolerance.
    pub fn of(self, t: f64) -> f64 {
        match self {
            Self::One => t,
            Self::Two => t * t,
        }
    }

    /// Its derivative.
    pub fn slope(self, t: f64) -> f64 {
        match self {
            Self::One => 1.0,
            Self::Two => 2.0 * t,
        }
    }

    /// The exponent.
    pub fn exponent(self) -> f64 {
        match self {
            Self::One => 1.0,
            Self::Two => 2.0,
        }
    }
}

/// Σ weight·t^power ≤ 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// How it grows.
    pub power: Power,
    /// One a tolerance, not negative.
    pub weights: Vec<f64>,
}

impl Row {
    /// The share of its budget that is used.
    pub fn usage(&self, tolerances: &[f64]) -> f64 {
        self.weights.iter().zip(tolerances).map(|(weight, t)| weight * self.power.of(*t)).sum()
    }
}

/// The processes of every tolerance, at least one each, and the rows.
#[derive(Clone, Debug)]
pub struct Program<'a> {
    /// One list a tolerance.
    pub processes: Vec<&'a [Process]>,
    /// Rows.
    pub rows: Vec<Row>,
    /// Tolerances to stay near to, and by which factor at most they are left; `None` for anything that processes can hold.
    pub near: Option<(&'a [f64], f64)>,
}

/// Part of a process.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Span {
    /// Anything between.
    Range([f64; 2]),
    /// Values of its list from the first number up to the second, exclusive.
    Points([usize; 2]),
}

/// A process, or part of it, that a tolerance may still take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Which process.
    pub process: usize,
    /// Which part.
    pub span: Span,
}

/// What every tolerance may still take.
pub type Choices = Vec<Vec<Piece>>;

/// The best of a tolerance at some prices.
#[derive(Clone, Copy, Debug)]
pub struct Pick {
    /// Which of its pieces.
    pub piece: usize,
    /// Number in the list, for points.
    pub point: usize,
    /// The tolerance.
    pub t: f64,
    /// Cost and prices.
    pub total: f64,
}

impl Program<'_> {
    /// All processes with all of their values that are near; where a tolerance has none of these, with all.
    pub fn whole(&self) -> Choices {
        let all = [0.0, f64::INFINITY];
        let choices = |(item, processes): (usize, &&[Process])| {
            let near = self.near.map_or(all, |(near, factor)| [near[item] / factor, near[item] * factor]);
            let near = pieces(processes, near);
            if near.is_empty() { pieces(processes, all) } else { near }
        };
        self.processes.iter().enumerate().map(choices).collect()
    }

    /// The tightest and the widest tolerance of a piece.
    pub fn ends(&self, item: usize, piece: &Piece) -> [f64; 2] {
        match piece.span {
            Span::Range(range) => range,
            Span::Points([first, end]) => [first, end - 1].map(|point| self.point(item, piece.process, point)),
        }
    }

    /// The value of that number in the list of a process.
    pub fn point(&self, item: usize, process: usize, point: usize) -> f64 {
        match &self.processes[item][process].values {
            Values::List(values) => values[point],
            Values::Range([low, _]) => *low,
        }
    }

    /// The tightest tolerances of all choices.
    pub fn tightest(&self, choices: &Choices) -> Vec<f64> {
        let least = |(item, pieces): (usize, &Vec<Piece>)| {
            pieces.iter().map(|piece| self.ends(item, piece)[0]).fold(f64::INFINITY, f64::min)
        };
        choices.iter().enumerate().map(least).collect()
    }

    /// The best of a tolerance in one piece where its first and second power have these prices.
    pub fn best_in(&self, item: usize, number: usize, piece: &Piece, prices: [f64; 2]) -> Pick {
        let law = &self.processes[item][piece.process].law;
        let total = |t: f64| law.cost(t) + prices[0] * t + prices[1] * t * t;
        let ends = self.ends(item, piece);
        let t = law.best(prices, ends);
        let Span::Points([first, end]) = piece.span else {
            return Pick { piece: number, point: 0, t, total: total(t) };
        };
        // The total is convex: the best value is next to the best number.
        let Values::List(values) = &self.processes[item][piece.process].values else {
            return Pick { piece: number, point: 0, t, total: total(t) };
        };
        let above = (first + values[first..end].partition_point(|value| *value < t)).min(end - 1);
        let below = above.saturating_sub(1).max(first);
        let [one, other] = [below, above].map(|point| (point, values[point], total(values[point])));
        let (point, t, total) = if one.2 <= other.2 { one } else { other };
        Pick { piece: number, point, t, total }
    }

    /// The best of a tolerance in all of its pieces.
    pub fn best(&self, item: usize, pieces: &[Piece], prices: [f64; 2]) -> Pick {
        let all = pieces.iter().enumerate().map(|(number, piece)| self.best_in(item, number, piece, prices));
        all.min_by(|one, other| one.total.total_cmp(&other.total)).unwrap_or(Pick {
            piece: 0,
            point: 0,
            t: f64::NAN,
            total: f64::INFINITY,
        })
    }

    /// What the first and second power of a tolerance cost at the prices of the rows.
    pub fn prices(&self, item: usize, prices: &[f64]) -> [f64; 2] {
        let of = |power: Power| {
            let rows = self.rows.iter().zip(prices).filter(|(row, _)| row.power == power);
            rows.map(|(row, price)| price * row.weights[item]).sum()
        };
        [of(Power::One), of(Power::Two)]
    }
}

/// The parts of processes that lie between two tolerances.
fn pieces(processes: &[Process], [low, high]: [f64; 2]) -> Vec<Piece> {
    let piece = |(process, of): (usize, &Process)| {
        let span = match &of.values {
            Values::Range([first, last]) => {
                let [first, last] = [first.max(low), last.min(high)];
                (first <= last).then_some(Span::Range([first, last]))
            }
            Values::List(values) => {
                let [first, end] = [values.partition_point(|t| *t < low), values.partition_point(|t| *t <= high)];
                (first < end).then_some(Span::Points([first, end]))
            }
        };
        Some(Piece { process, span: span? })
    };
    processes.iter().enumerate().filter_map(piece).collect()
}
