//! The random streams of several units at once: word for word those of [`unit_stream`], several times as fast.
//!
//! [`unit_stream`]: slipfit_core::sampling::stream::unit_stream

use slipfit_core::sampling::stream::{GOLDEN, derived, mix};

use crate::numeric::lanes::LANES;

/// States of xoshiro256++ (Blackman, Vigna 2021), one a unit.
pub struct Streams([[u64; LANES]; 4]);

impl Streams {
    /// Of the units from `first` on of the production `seed`.
    #[inline(always)]
    pub fn new(seed: u64, first: u64) -> Self {
        let mut states = [[0; LANES]; 4];
        for lane in 0..LANES {
            let mut word = derived(seed, first + lane as u64);
            for state in &mut states {
                word = word.wrapping_add(GOLDEN);
                state[lane] = mix(word);
            }
        }
        Self(states)
    }

    /// The next word of every unit.
    #[inline(always)]
    pub fn next(&mut self) -> [u64; LANES] {
        let [a, b, c, d] = &mut self.0;
        let mut words = [0; LANES];
        for lane in 0..LANES {
            words[lane] = a[lane].wrapping_add(d[lane]).rotate_left(23).wrapping_add(a[lane]);
            let shifted = b[lane] << 17;
            c[lane] ^= a[lane];
            d[lane] ^= b[lane];
            b[lane] ^= c[lane];
            a[lane] ^= d[lane];
            c[lane] ^= shifted;
            d[lane] = d[lane].rotate_left(45);
        }
        words
    }
}

#[cfg(test)]
mod tests {
    use slipfit_core::sampling::stream::{Rng, unit_stream};

    use super::{LANES, Streams};

    #[test]
    fn words_are_those_of_each_unit() {
        let mut all = Streams::new(7, 1000);
        let mut each: [_; LANES] = std::array::from_fn(|lane| unit_stream(7, 1000 + lane as u64));
        for _ in 0..100 {
            assert_eq!(all.next(), std::array::from_fn(|lane| each[lane].next_u64()));
        }
    }
}
