//! What drives force and malfunction: correlation ratios.
//!
//! The correlation ratio η² = Var(E[y|x])/Var(y) (Pearson 1905), the first-order Sobol' index of independent contributors,
//! needs no runs of its own: the units are sorted into classes of x, as many as units allow, and the variance between the
//! classes' means is held against that within (ω², which is free of the bias that η² has for few units). A contributor with
//! several variables, such as a plane in its zone, has the sum over these. Errors come from leaving out a sixteenth of the
//! units at a time (jackknife).

use serde::Serialize;

/// Classes of a variable, equally probable.
const CLASSES: usize = 12;
/// Units from which on contributors are told: ten in a class.
pub const LEAST_UNITS: usize = 10 * CLASSES;
/// Parts of the population of which one at a time is left out.
const PARTS: usize = 16;

/// Share of a contributor in the variance of a figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Driver {
    /// Name of the contributor.
    pub name: String,
    /// Correlation ratio; about 0 where it does nothing.
    pub share: f64,
    /// Its standard error.
    pub error: f64,
}

/// Sums over the units of one class in one part.
#[derive(Clone, Copy, Default)]
struct Cell {
    count: f64,
    sum: f64,
    square: f64,
}

/// Sorts units into classes of every variable.
pub struct Drivers {
    /// Limits between classes of every variable.
    limits: Vec<Vec<f64>>,
    /// By variable, part and class.
    cells: Vec<[[Cell; CLASSES]; PARTS]>,
}

impl Drivers {
    /// Classes by the `variables` of some units, a column each.
    pub fn new(variables: &[Vec<f64>]) -> Self {
        let limits = |column: &Vec<f64>| {
            let mut sorted = column.clone();
            sorted.sort_by(f64::total_cmp);
            (1..CLASSES).map(|k| sorted[k * sorted.len() / CLASSES]).collect()
        };
        let limits: Vec<Vec<f64>> = variables.iter().map(limits).collect();
        Self { cells: vec![[[Cell::default(); CLASSES]; PARTS]; limits.len()], limits }
    }

    /// Adds units with these `variables`, a column each, and the figure of each, if it has one.
    pub fn add(&mut self, first: u64, variables: &[Vec<f64>], figures: &[Option<f64>]) {
        for ((limits, cells), column) in self.limits.iter().zip(&mut self.cells).zip(variables) {
            for (i, (x, figure)) in column.iter().zip(figures).enumerate() {
                let Some(y) = figure else { continue };
                let class = limits.partition_point(|limit| limit <= x);
                let cell = &mut cells[(first as usize + i) % PARTS][class];
                *cell = Cell { count: cell.count + 1.0, sum: cell.sum + y, square: cell.square + y * y };
            }
        }
    }

    /// The contributors, each with its variables, by falling share; none from fewer than [`LEAST_UNITS`] figures, of which the
    /// luckiest of many contributors would explain all.
    pub fn ranked(&self, contributors: &[(&str, std::ops::Range<usize>)]) -> Vec<Driver> {
        let figures =
            |cells: &[[Cell; CLASSES]; PARTS]| cells.as_flattened().iter().map(|cell| cell.count).sum::<f64>();
        if self.cells.first().is_none_or(|cells| figures(cells) < LEAST_UNITS as f64) {
            return Vec::new();
        }
        let of = |(name, own): &(&str, std::ops::Range<usize>)| {
            let share = |without: Option<usize>| own.clone().map(|k| ratio(&self.cells[k], without)).sum::<f64>();
            let all = share(None);
            let parts: Vec<f64> = (0..PARTS).map(|part| share(Some(part))).collect();
            let mean = parts.iter().sum::<f64>() / PARTS as f64;
            let square: f64 = parts.iter().map(|part| (part - mean) * (part - mean)).sum();
            let error = libm::sqrt(square * (PARTS as f64 - 1.0) / PARTS as f64);
            Driver { name: (*name).to_owned(), share: all, error }
        };
        let mut drivers: Vec<Driver> = contributors.iter().map(of).collect();
        drivers.sort_by(|one, other| other.share.total_cmp(&one.share));
        drivers
    }
}

/// ω² of one variable: (SSB − (k−1)·MSW)/(SST + MSW).
fn ratio(cells: &[[Cell; CLASSES]; PARTS], without: Option<usize>) -> f64 {
    let mut classes = [Cell::default(); CLASSES];
    for (_, part) in cells.iter().enumerate().filter(|(number, _)| Some(*number) != without) {
        for (class, cell) in classes.iter_mut().zip(part) {
            class.count += cell.count;
            class.sum += cell.sum;
            class.square += cell.square;
        }
    }
    let used: Vec<&Cell> = classes.iter().filter(|class| class.count > 0.0).collect();
    let total = |of: fn(&Cell) -> f64| used.iter().map(|class| of(class)).sum::<f64>();
    let (count, sum, square) = (total(|class| class.count), total(|class| class.sum), total(|class| class.square));
    let between = total(|class| class.sum * class.sum / class.count) - sum * sum / count;
    let all = square - sum * sum / count;
    let within = (all - between) / (count - used.len() as f64);
    if all > 0.0 && within.is_finite() { (between - (used.len() as f64 - 1.0) * within) / (all + within) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::Drivers;
    use slipfit_core::sampling::stream::{Rng, unit_stream};

    /// Of three units one of many contributors always explains all: nothing is said.
    #[test]
    fn few_units_tell_nothing() {
        let columns = vec![vec![0.1, 0.2, 0.3]; 2];
        let mut drivers = Drivers::new(&columns);
        drivers.add(0, &columns, &[Some(1.0), Some(0.0), Some(0.0)]);
        assert!(drivers.ranked(&[("a", 0..1), ("b", 1..2)]).is_empty());
    }

    /// y = 2·a + b + (a pair's) c₀·c₁: shares 4/6, 1/6, and the product's that no single variable has.
    #[test]
    fn shares_are_those_of_a_known_function() {
        let count = 20_000;
        let mut columns = vec![Vec::new(); 4];
        for i in 0..count {
            let mut stream = unit_stream(5, i);
            let mut uniform = || stream.next_u64() as f64 / 18_446_744_073_709_551_616.0 - 0.5;
            columns.iter_mut().for_each(|column| column.push(uniform() * libm::sqrt(12.0)));
        }
        let figures: Vec<_> = (0..count as usize)
            .map(|i| Some(2.0 * columns[0][i] + columns[1][i] + columns[2][i] * columns[3][i]))
            .collect();
        let mut drivers = Drivers::new(&columns);
        drivers.add(0, &columns, &figures);
        let ranked = drivers.ranked(&[("b", 1..2), ("c", 2..4), ("a", 0..1)]);
        assert_eq!(ranked.iter().map(|driver| driver.name.as_str()).collect::<Vec<_>>(), ["a", "b", "c"]);
        // Classes lose a little of what is linear: 1/12².
        for (driver, share) in ranked.iter().zip([4.0 / 6.0, 1.0 / 6.0, 0.0]) {
            assert!((driver.share - share).abs() < 4.0 * driver.error + 0.01 * share, "{driver:?}");
            assert!(driver.error < 0.01, "{driver:?}");
        }
    }
}
