//! Which of a population's units malfunction, and with what force: as many as the ranking of causes needs, in bounded memory.
//!
//! A unit is drawn again from its number. So numbers are kept, of the first units that malfunction and of the first that do not; of a
//! rare malfunction these are all that do.

use slipfit_tolerance::counting::file::{FormatError, Reader, integer};

/// The most units of either outcome that are kept.
const MOST: usize = 1 << 14;
/// The most units among which those are found that malfunction: so many are drawn again in seconds.
const MOST_UNITS: u64 = 1 << 22;

/// A unit and its greatest force (N, N·m); NaN if it has none.
#[derive(Clone, Copy, Debug)]
pub struct Kept {
    /// Its number in the production.
    pub number: u64,
    /// The force.
    pub force: f64,
}

/// The same bits: NaN equals itself.
impl PartialEq for Kept {
    fn eq(&self, other: &Self) -> bool {
        (self.number, self.force.to_bits()) == (other.number, other.force.to_bits())
    }
}

/// The first units of either outcome, by ascending number. The order in which units come does not matter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcomes {
    /// Those that do not malfunction, and those that do.
    of: [Vec<Kept>; 2],
}

/// The first `units` of a production, of which just those `marked` malfunction, or do not.
pub struct Judged {
    /// All of them.
    pub units: u64,
    /// Numbers of those that are rarer among them, ascending.
    pub marked: Vec<u64>,
}

impl Outcomes {
    /// Adds a unit of this `number` with its `force` (N, N·m).
    pub fn add(&mut self, number: u64, force: Option<f64>, malfunctions: bool) {
        let own = &mut self.of[usize::from(malfunctions)];
        if own.len() == MOST && own.last().is_some_and(|last| last.number < number) {
            return;
        }
        let place = own.partition_point(|other| other.number < number);
        own.insert(place, Kept { number, force: force.unwrap_or(f64::NAN) });
        own.truncate(MOST);
    }

    /// Adds those of another part of the population.
    pub fn join(&mut self, other: &Self) {
        for (own, other) in self.of.iter_mut().zip(&other.of) {
            own.extend(other);
            own.sort_by_key(|unit| unit.number);
            own.truncate(MOST);
        }
    }

    /// Units from the first on among which all of this outcome are kept, of `units` in all.
    fn complete(&self, malfunctions: bool, units: u64) -> u64 {
        let own = &self.of[usize::from(malfunctions)];
        if own.len() < MOST { units } else { own.last().map_or(units, |last| last.number + 1) }
    }

    /// As many of the first of `units` in all as the outcome is known of.
    pub fn judged(&self, units: u64) -> Judged {
        let key = |malfunctions: bool| (self.complete(malfunctions, units), self.of[usize::from(!malfunctions)].len());
        let rarer = key(true) >= key(false);
        let known = self.complete(rarer, units).min(MOST_UNITS);
        let own = self.of[usize::from(rarer)].iter().map(|unit| unit.number);
        Judged { units: known, marked: own.take_while(|number| *number < known).collect() }
    }

    /// The first units that have a force, in order, as far as all of them are kept.
    pub fn with_force(&self, units: u64) -> Vec<Kept> {
        let known = self.complete(false, units).min(self.complete(true, units));
        let all = self.of.iter().flatten().filter(|unit| unit.number < known && !unit.force.is_nan());
        let mut all: Vec<Kept> = all.copied().collect();
        all.sort_by_key(|unit| unit.number);
        all
    }

    /// Adds their bytes.
    pub fn encode(&self, out: &mut Vec<u8>) {
        for own in &self.of {
            integer(out, own.len() as u64);
            let mut next = 0;
            for Kept { number, force } in own {
                integer(out, number - next);
                out.extend(force.to_le_bytes());
                next = number + 1;
            }
        }
    }

    /// Reads them.
    ///
    /// # Errors
    /// [`FormatError::Damaged`].
    pub fn decode(reader: &mut Reader) -> Result<Self, FormatError> {
        let mut found = Self::default();
        for own in &mut found.of {
            let mut next = 0u64;
            for _ in 0..reader.count()? {
                let number = next.checked_add(reader.integer()?).ok_or(FormatError::Damaged)?;
                own.push(Kept { number, force: reader.number()? });
                next = number.checked_add(1).ok_or(FormatError::Damaged)?;
            }
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::{MOST, MOST_UNITS, Outcomes};

    fn outcomes(numbers: impl Iterator<Item = u64>, fails: impl Fn(u64) -> bool) -> Outcomes {
        let mut all = Outcomes::default();
        numbers.for_each(|number| all.add(number, (number % 5 > 0).then_some(number as f64), fails(number)));
        all
    }

    #[test]
    fn parts_in_any_order_are_the_whole() {
        let fails = |number: u64| number.is_multiple_of(3);
        let units = 4 * MOST as u64;
        let whole = outcomes(0..units, fails);
        let mut joined = outcomes((0..units).filter(|k| k % 2 == 1), fails);
        joined.join(&outcomes((0..units).rev().filter(|k| k % 2 == 0), fails));
        assert_eq!(joined, whole);
        // Every third malfunctions: the list of those is full later.
        let judged = whole.judged(units);
        assert_eq!(judged.units, 3 * (MOST as u64 - 1) + 1);
        assert_eq!(judged.marked, (0..judged.units).filter(|k| fails(*k)).collect::<Vec<_>>());
        let forces = whole.with_force(units);
        assert!(forces.iter().all(|unit| unit.force == unit.number as f64 && unit.number % 5 > 0));
        assert!(forces.is_sorted_by(|one, next| one.number < next.number));
    }

    #[test]
    fn rare_outcomes_are_all_known() {
        let rare = |number: u64| number % 9000 == 7;
        let units = 100_000;
        for flipped in [false, true] {
            let all = outcomes(0..units, |number| rare(number) != flipped);
            let judged = all.judged(units);
            assert_eq!(judged.units, units);
            assert_eq!(judged.marked, (0..units).filter(|k| rare(*k)).collect::<Vec<_>>());
        }
        let none = Outcomes::default().judged(MOST_UNITS + 5);
        assert_eq!((none.units, none.marked.len()), (MOST_UNITS, 0));
    }
}
