//! How many values of what is unknown are tried, and with how many units.

use slipfit_core::sampling::stream::{derived, uniform};
use slipfit_tolerance::{
    numeric::lanes::LANES,
    sampling::sampler::{Method, Sampler},
};

/// Units for each unit of a population of which everything is known.
const TIMES: u64 = 4;
/// Values, powers of two, and the units of each from which on there are as many.
const VALUES: [(u64, u64); 2] = [(64, 64), (32, 2)];
/// What the seed of the values is derived with.
const STREAM: u64 = 7 << 32;

/// The fewest units of a population that this takes.
pub const LEAST_UNITS: u64 = VALUES[1].0 * VALUES[1].1 / TIMES;

/// Values of what is unknown, and units for each: the first of them have the numbers after those of the population itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Design {
    /// Values.
    pub values: u64,
    /// Units of each.
    pub units_each: u64,
    /// Number of the first unit.
    pub first: u64,
    /// Seed of the production.
    pub seed: u64,
}

impl Design {
    /// Beside a population of so many `units`, at most four times as many. None of fewer than [`LEAST_UNITS`].
    pub fn beside(units: u64, seed: u64) -> Option<Self> {
        let all = TIMES * units;
        let (values, _) = VALUES.into_iter().find(|(values, least)| all / values >= *least)?;
        Some(Self { values, units_each: all / values, first: units, seed })
    }

    /// Units in all.
    pub fn units(&self) -> u64 {
        self.values * self.units_each
    }

    /// The units of a value, by its number.
    pub fn units_of(&self, value: u64) -> std::ops::Range<u64> {
        let first = self.first + value * self.units_each;
        first..first + self.units_each
    }

    /// The values as points of the unit cube with so many `coordinates`: scrambled Sobol' points, so that each coordinate has one value
    /// in each of as many equal strata.
    pub fn points(&self, coordinates: usize) -> Vec<Vec<f64>> {
        if coordinates == 0 {
            return vec![Vec::new(); self.values as usize];
        }
        let sampler = Sampler::new(Method::ScrambledSobol, derived(self.seed, STREAM), coordinates, 1, self.values);
        let point = |value: u64| {
            let mut bits = vec![[0; LANES]; coordinates];
            sampler.fill(value, &mut bits);
            bits.iter().map(|bits| uniform(bits[0])).collect()
        };
        (0..self.values).map(point).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{Design, LEAST_UNITS};

    #[test]
    fn it_takes_at_most_five_times_the_units() {
        for units in [LEAST_UNITS, 100, 300, 512, 1024, 5000, 100_000_000] {
            let design = Design::beside(units, 1).unwrap();
            assert!(units + design.units() <= 5 * units && design.units() > 3 * units, "{units} {design:?}");
            assert!(design.units_of(0).start == units && design.units_of(3).end == units + 4 * design.units_each);
        }
        assert_eq!(Design::beside(LEAST_UNITS - 1, 1), None);
    }

    #[test]
    fn each_coordinate_has_a_value_in_each_stratum() {
        let design = Design::beside(5000, 3).unwrap();
        let points = design.points(5);
        for i in 0..5 {
            let mut strata: Vec<u64> = points.iter().map(|point| (point[i] * design.values as f64) as u64).collect();
            strata.sort_unstable();
            assert!(strata.into_iter().eq(0..design.values));
        }
    }
}
