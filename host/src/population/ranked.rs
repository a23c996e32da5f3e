//! How a figure spreads over any number of units, in bounded memory.
//!
//! Values are counted one by one as long as few differ, then in classes that are as wide as they must be. Which class a value
//! is in does not depend on the order in which units come, so that parts of a population can be joined in any.

use std::collections::BTreeMap;

use slipfit_tolerance::counting::file::{FormatError, Reader, integer};

/// Classes that are kept apart. Where there are more, each two become one.
const MOST: usize = 1 << 15;

/// Values of a figure, counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ranked {
    /// Bits of a value's key that its class leaves out.
    shift: u32,
    /// Values by class.
    counts: BTreeMap<u64, u64>,
    /// All of them.
    units: u64,
    /// The least and the greatest; none without values.
    ends: Option<[f64; 2]>,
}

/// An integer that is greater for a greater number: floating-point numbers have the order of their bits, but for the sign.
fn key(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 0 { bits | 1 << 63 } else { !bits }
}

fn value_of(key: u64) -> f64 {
    f64::from_bits(if key >> 63 == 0 { !key } else { key & !(1 << 63) })
}

impl Ranked {
    /// Adds a value; nothing that is not a number.
    pub fn add(&mut self, value: f64) {
        if value.is_nan() {
            return;
        }
        let [low, high] = self.ends.unwrap_or([value; 2]);
        self.ends = Some([low.min(value), high.max(value)]);
        self.units += 1;
        *self.counts.entry(key(value) >> self.shift).or_default() += 1;
        self.shrink();
    }

    /// Adds those of another.
    pub fn join(&mut self, other: &Self) {
        self.units += other.units;
        if let Some([low, high]) = other.ends {
            let [own_low, own_high] = self.ends.unwrap_or([low, high]);
            self.ends = Some([own_low.min(low), own_high.max(high)]);
        }
        self.coarsen(other.shift.saturating_sub(self.shift));
        let left = self.shift - other.shift;
        for (class, count) in &other.counts {
            *self.counts.entry(class >> left).or_default() += count;
        }
        self.shrink();
    }

    /// Leaves out the fewest bits that leave no more classes than are kept apart.
    fn shrink(&mut self) {
        let mut classes = self.counts.len();
        if classes <= MOST {
            return;
        }
        // Neighbours by the bits after which they are one class. All at once: numbers of single precision share some thirty bits.
        let mut one_after = [0; 65];
        for (class, next) in self.counts.keys().zip(self.counts.keys().skip(1)) {
            one_after[(64 - (class ^ next).leading_zeros()) as usize] += 1;
        }
        let enough = |bits: &u32| {
            classes -= one_after[*bits as usize];
            classes <= MOST
        };
        self.coarsen((1..64).find(enough).unwrap_or(63));
    }

    fn coarsen(&mut self, bits: u32) {
        if bits > 0 {
            self.shift += bits;
            let mut coarse: Vec<(u64, u64)> = Vec::with_capacity(self.counts.len());
            for (class, count) in &self.counts {
                match coarse.last_mut().filter(|(last, _)| *last == class >> bits) {
                    Some((_, sum)) => *sum += count,
                    None => coarse.push((class >> bits, *count)),
                }
            }
            self.counts = coarse.into_iter().collect();
        }
    }

    /// How many values there are.
    pub fn units(&self) -> u64 {
        self.units
    }

    /// The least and the greatest; none without values.
    pub fn ends(&self) -> Option<[f64; 2]> {
        self.ends
    }

    /// How many are less than `value`, as far as classes tell.
    pub fn below(&self, value: f64) -> u64 {
        self.counts.range(..key(value) >> self.shift).map(|(_, count)| count).sum()
    }

    /// Values with how many there are of each, the least first: of each class that which stands for it.
    pub fn values(&self) -> impl Iterator<Item = (f64, u64)> {
        let [low, high] = self.ends.unwrap_or([0.0; 2]);
        let middle = if self.shift > 0 { 1 << (self.shift - 1) } else { 0 };
        self.counts.iter().map(move |(class, count)| (value_of(class << self.shift | middle).clamp(low, high), *count))
    }

    /// The value with `before` others before it; none if there are no more.
    pub fn at(&self, before: u64) -> Option<f64> {
        let [low, high] = self.ends?;
        let mut passed = 0;
        let found = self.values().find(|(_, count)| {
            passed += count;
            passed > before
        });
        match before {
            0 => Some(low),
            _ if before + 1 == self.units => Some(high),
            _ => found.map(|(value, _)| value),
        }
    }

    /// Adds its bytes.
    pub fn encode(&self, out: &mut Vec<u8>) {
        integer(out, self.shift.into());
        integer(out, self.counts.len() as u64);
        let mut last = 0;
        for (class, count) in &self.counts {
            integer(out, class - last);
            integer(out, *count);
            last = *class;
        }
        self.ends.iter().flatten().for_each(|end| out.extend(end.to_le_bytes()));
    }

    /// Reads them.
    ///
    /// # Errors
    /// [`FormatError::Damaged`].
    pub fn decode(reader: &mut Reader) -> Result<Self, FormatError> {
        let shift = u32::try_from(reader.integer()?).ok().filter(|shift| *shift < 64).ok_or(FormatError::Damaged)?;
        let mut found = Self { shift, ..Self::default() };
        let mut class = 0u64;
        for _ in 0..reader.count()? {
            class = class.checked_add(reader.integer()?).ok_or(FormatError::Damaged)?;
            let count = reader.integer()?;
            found.units = found.units.checked_add(count).ok_or(FormatError::Damaged)?;
            found.counts.insert(class, count);
        }
        if class > u64::MAX >> shift {
            return Err(FormatError::Damaged);
        }
        if found.units > 0 {
            found.ends = Some([reader.number()?, reader.number()?]).filter(|[low, high]| low <= high);
            found.ends.ok_or(FormatError::Damaged)?;
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::{MOST, Ranked, key, value_of};

    fn ranked(values: impl IntoIterator<Item = f64>) -> Ranked {
        let mut ranked = Ranked::default();
        values.into_iter().for_each(|value| ranked.add(value));
        ranked
    }

    #[test]
    fn keys_have_the_order_of_the_numbers() {
        let values = [f64::NEG_INFINITY, -2.5, -1e-300, 0.0, 1e-300, 0.1, 3.0, f64::INFINITY];
        assert!(values.windows(2).all(|pair| key(pair[0]) < key(pair[1])));
        assert!(values.iter().all(|value| value_of(key(*value)) == *value));
    }

    #[test]
    fn few_values_are_exact() {
        let found = ranked([3.0, -1.0, 2.0, 2.0, f64::NAN]);
        assert_eq!((found.units(), found.ends()), (4, Some([-1.0, 3.0])));
        assert_eq!([0, 1, 2, 3].map(|k| found.at(k).unwrap()), [-1.0, 2.0, 2.0, 3.0]);
        assert_eq!([-1.0, 2.0, 2.5, 9.0].map(|x| found.below(x)), [0, 1, 3, 4]);
        assert_eq!((ranked([]).at(0), ranked([]).ends()), (None, None));
    }

    /// A million values in a third of a megabyte, in whatever order and in whatever parts they come.
    #[test]
    fn many_values_stay_in_bounds_and_the_order_does_not_matter() {
        let value = |k: u64| libm::sin(k as f64) + 1.5;
        let count = 1_000_000;
        let all = ranked((0..count).map(value));
        assert!(all.counts.len() <= MOST && all.counts.len() > MOST / 2, "{}", all.counts.len());
        let mut joined = ranked((0..count).filter(|k| k % 3 == 0).map(value));
        joined.join(&ranked([]));
        joined.join(&ranked((0..count).rev().filter(|k| k % 3 > 0).map(value)));
        assert_eq!(joined, all);
        // Quantiles of the arcsine law.
        for share in [0.01, 0.3, 0.5, 0.99] {
            let exact = 1.5 - libm::cos(std::f64::consts::PI * share);
            let found = all.at((share * count as f64) as u64).unwrap();
            assert!((found / exact - 1.0).abs() < 1e-4, "{share} {found} {exact}");
        }
        let mut bytes = Vec::new();
        all.encode(&mut bytes);
        assert!(bytes.len() < 8 * MOST, "{}", bytes.len());
    }
}
