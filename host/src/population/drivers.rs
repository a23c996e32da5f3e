//! What drives force and malfunction: correlation ratios.
//!
//! The correlation ratio η² = Var(E[y|x])/Var(y) (Pearson 1905), the first-order Sobol' index of independent contributors,
//! needs no runs of its own: the units are sorted into classes of x, as many as units allow, and the variance between the
//! classes' means is held against that within (ω², which is free of the bias that η² has for few units). A contributor with
//! several variables, such as a plane in its zone, has the sum over these. Errors come from leaving out a sixteenth of the
//! units at a time (jackknife).

use serde::Serialize;

use super::{
    production::{Drawn, Production},
    subject::UnitGaps,
};
use crate::tolerance::counting::file::{FormatError, Reader, integer};

/// Units that find the classes.
const PILOT: u64 = 1024;
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

/// Sums over the units of one class in one part. They are of integers, so that parts of a population join in any order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Cell {
    count: u64,
    sum: i64,
    square: u128,
}

impl Cell {
    fn add(&mut self, figure: i64) {
        self.join(Self { count: 1, sum: figure, square: u128::from(figure.unsigned_abs()).pow(2) });
    }

    fn join(&mut self, other: Self) {
        let Self { count, sum, square } = *self;
        *self = Self {
            count: count + other.count,
            sum: sum.saturating_add(other.sum),
            square: square.saturating_add(other.square),
        };
    }
}

/// The classes of one variable in every part.
type Cells = [[Cell; CLASSES]; PARTS];

/// What figures vary with, summed up: by variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    of_force: Vec<Cells>,
    of_malfunction: Vec<Cells>,
}

impl Sums {
    /// Of no units, with so many `variables` each.
    pub fn new(variables: usize) -> Self {
        let nothing = vec![[[Cell::default(); CLASSES]; PARTS]; variables];
        Self { of_force: nothing.clone(), of_malfunction: nothing }
    }

    /// How many variables there are.
    pub fn variables(&self) -> usize {
        self.of_force.len()
    }

    fn each(&mut self) -> impl Iterator<Item = &mut Cell> {
        let Self { of_force, of_malfunction } = self;
        of_force.iter_mut().chain(of_malfunction).flat_map(|cells| cells.as_flattened_mut())
    }

    /// Adds those of as many variables.
    pub fn join(&mut self, other: &mut Self) {
        self.each().zip(other.each()).for_each(|(own, other)| own.join(*other));
    }

    /// Adds their bytes.
    pub fn encode(&self, out: &mut Vec<u8>) {
        integer(out, self.variables() as u64);
        for cell in self.of_force.iter().chain(&self.of_malfunction).flat_map(|cells| cells.as_flattened()) {
            let Cell { count, sum, square } = *cell;
            // The sign goes into the lowest bit, so that small sums are short.
            let zigzag = (sum << 1 ^ sum >> 63) as u64;
            [count, zigzag, square as u64, (square >> 64) as u64].into_iter().for_each(|part| integer(out, part));
        }
    }

    /// Reads them.
    ///
    /// # Errors
    /// [`FormatError::Damaged`].
    pub fn decode(reader: &mut Reader) -> Result<Self, FormatError> {
        let variables = reader.count()?;
        // Variable by variable, so that nothing is allocated of which no bytes are there.
        let mut all = || {
            let mut read = Vec::new();
            for _ in 0..variables {
                let mut cells = [[Cell::default(); CLASSES]; PARTS];
                for cell in cells.as_flattened_mut() {
                    let (count, zigzag) = (reader.integer()?, reader.integer()?);
                    let square = u128::from(reader.integer()?) | u128::from(reader.integer()?) << 64;
                    *cell = Cell { count, sum: (zigzag >> 1) as i64 ^ -((zigzag & 1) as i64), square };
                }
                read.push(cells);
            }
            Ok(read)
        };
        Ok(Self { of_force: all()?, of_malfunction: all()? })
    }
}

/// Steps in which forces are summed up, in the drive's greatest force: less than single precision knows.
const STEPS: f64 = (1u64 << 30) as f64;
/// Greater forces (in the drive's greatest) count as this: sums of 100 million of them are integers still.
const GREATEST: f64 = 32.0;

/// Sorts units into classes of every variable.
pub struct Classes {
    /// Limits between classes of every variable.
    limits: Vec<[f64; CLASSES - 1]>,
    /// Force (N, N·m) in whose steps forces are summed up.
    scale: f64,
}

impl Classes {
    /// Of the variables of a `production`, for forces that compare with `greatest` (N, N·m).
    pub fn new<G: UnitGaps>(production: &Production<G>, greatest: f64) -> Self {
        Self::by(&production.draw(0..PILOT).variables, greatest)
    }

    fn by(variables: &[Vec<f64>], greatest: f64) -> Self {
        let limits = |column: &Vec<f64>| {
            let mut sorted = column.clone();
            sorted.sort_by(f64::total_cmp);
            std::array::from_fn(|k| sorted[(k + 1) * sorted.len() / CLASSES])
        };
        let scale = if greatest > 0.0 { greatest } else { 1.0 };
        Self { limits: variables.iter().map(limits).collect(), scale }
    }

    /// How many variables there are.
    pub fn variables(&self) -> usize {
        self.limits.len()
    }

    /// Adds units as they were `drawn`, each with its greatest force (N, N·m), if it has one, and whether it malfunctions.
    pub fn add<G>(&self, sums: &mut Sums, drawn: &Drawn<G>, units: impl Iterator<Item = (Option<f64>, bool)> + Clone) {
        let Sums { of_force, of_malfunction } = sums;
        let cells = of_force.iter_mut().zip(of_malfunction);
        for ((limits, (of_force, of_malfunction)), column) in self.limits.iter().zip(cells).zip(&drawn.variables) {
            for ((number, x), (force, fails)) in (drawn.numbers.start..).zip(column).zip(units.clone()) {
                let class = limits.iter().filter(|limit| *limit <= x).count();
                let part = (number % PARTS as u64) as usize;
                of_malfunction[part][class].add(i64::from(fails));
                if let Some(force) = force {
                    let steps = (force / self.scale).clamp(-GREATEST, GREATEST) * STEPS;
                    of_force[part][class].add(libm::round(steps) as i64);
                }
            }
        }
    }
}

impl Sums {
    /// What the greatest force varies with: contributors, each with its variables.
    pub fn of_force(&self, contributors: &[(&str, std::ops::Range<usize>)]) -> Vec<Driver> {
        ranked(&self.of_force, contributors)
    }

    /// What malfunction varies with, likewise.
    pub fn of_malfunction(&self, contributors: &[(&str, std::ops::Range<usize>)]) -> Vec<Driver> {
        ranked(&self.of_malfunction, contributors)
    }
}

/// The contributors, each with its variables, by falling share; none from fewer than [`LEAST_UNITS`] figures, of which the
/// luckiest of many contributors would explain all.
fn ranked(cells: &[Cells], contributors: &[(&str, std::ops::Range<usize>)]) -> Vec<Driver> {
    let figures = |cells: &Cells| cells.as_flattened().iter().map(|cell| cell.count).sum::<u64>();
    if cells.first().is_none_or(|cells| figures(cells) < LEAST_UNITS as u64) {
        return Vec::new();
    }
    let of = |(name, own): &(&str, std::ops::Range<usize>)| {
        let share = |without: Option<usize>| own.clone().map(|k| ratio(&cells[k], without)).sum::<f64>();
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

/// ω² of one variable: (SSB − (k−1)·MSW)/(SST + MSW).
fn ratio(cells: &Cells, without: Option<usize>) -> f64 {
    let mut classes = [Cell::default(); CLASSES];
    for (_, part) in cells.iter().enumerate().filter(|(number, _)| Some(*number) != without) {
        for (class, cell) in classes.iter_mut().zip(part) {
            class.join(*cell);
        }
    }
    let used: Vec<&Cell> = classes.iter().filter(|class| class.count > 0).collect();
    let total = |of: fn(&Cell) -> f64| used.iter().map(|class| of(class)).sum::<f64>();
    let (count, sum) = (total(|class| class.count as f64), total(|class| class.sum as f64));
    let square = total(|class| class.square as f64);
    let between = total(|class| class.sum as f64 * class.sum as f64 / class.count as f64) - sum * sum / count;
    let all = square - sum * sum / count;
    let within = (all - between) / (count - used.len() as f64);
    if all > 0.0 && within.is_finite() { (between - (used.len() as f64 - 1.0) * within) / (all + within) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::{Classes, Driver, Sums};
    use crate::population::production::Drawn;
    use slipfit_core::sampling::stream::{Rng, unit_stream};

    /// What the `figures` of units with these `variables` vary with.
    fn drivers(
        variables: &[Vec<f64>],
        figures: &[f64],
        contributors: &[(&str, std::ops::Range<usize>)],
    ) -> Vec<Driver> {
        let classes = Classes::by(variables, 4.0);
        let count = figures.len();
        let drawn = Drawn {
            numbers: 0..count as u64,
            gaps: vec![(); count],
            deviations: vec![],
            variables: variables.to_vec(),
        };
        let mut sums = Sums::new(variables.len());
        classes.add(&mut sums, &drawn, figures.iter().map(|figure| (Some(*figure), false)));
        sums.of_force(contributors)
    }

    /// Of three units one of many contributors always explains all: nothing is said.
    #[test]
    fn few_units_tell_nothing() {
        let columns = vec![vec![0.1, 0.2, 0.3]; 2];
        assert!(drivers(&columns, &[1.0, 0.0, 0.0], &[("a", 0..1), ("b", 1..2)]).is_empty());
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
        let figures: Vec<_> =
            (0..count as usize).map(|i| 2.0 * columns[0][i] + columns[1][i] + columns[2][i] * columns[3][i]).collect();
        let ranked = drivers(&columns, &figures, &[("b", 1..2), ("c", 2..4), ("a", 0..1)]);
        assert_eq!(ranked.iter().map(|driver| driver.name.as_str()).collect::<Vec<_>>(), ["a", "b", "c"]);
        // Classes lose a little of what is linear: 1/12².
        for (driver, share) in ranked.iter().zip([4.0 / 6.0, 1.0 / 6.0, 0.0]) {
            assert!((driver.share - share).abs() < 4.0 * driver.error + 0.01 * share, "{driver:?}");
            assert!(driver.error < 0.01, "{driver:?}");
        }
    }
}
