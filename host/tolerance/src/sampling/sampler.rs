//! The random numbers behind every unit: pseudo-random, a Latin hypercube, or scrambled Sobol' points.
//!
//! A number is 64 random bits, read as a fraction in (0, 1). Designs are drawn in *replicates*, equal and independent:
//! within one the units depend on each other, so that only the spread between replicates tells the error.

use serde::{Deserialize, Serialize};
use slipfit_core::sampling::stream::{Rng, derived, unit_stream};

use super::{
    permutation::Permutation,
    sobol::{Directions, key, scrambled},
    streams::Streams,
};
use crate::numeric::lanes::{LANES, widest};

/// Version of what units are drawn with: of random numbers, scores, distributions and zones. Units of one version are not
/// those of another.
pub const VERSION: u32 = 3;

/// How the units of a study are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Independent units.
    PseudoRandom,
    /// Every variable takes one value from each of as many equally probable strata as there are units.
    LatinHypercube,
    /// Owen-scrambled Sobol' points.
    ScrambledSobol,
}

/// What draws the random numbers of any unit.
pub struct Sampler {
    seed: u64,
    dimensions: usize,
    replicate: u64,
    design: Design,
}

enum Design {
    PseudoRandom,
    /// A shuffle a replicate and dimension, and the width of a stratum as a fraction of 2⁶⁴.
    LatinHypercube(Vec<Vec<Permutation>>, u64),
    /// A key a replicate and dimension.
    ScrambledSobol(Directions, Vec<Vec<u32>>),
}

impl Sampler {
    /// Numbers of `replicates` times `units` units with `dimensions` variables.
    pub fn new(method: Method, seed: u64, dimensions: usize, replicates: u64, units: u64) -> Self {
        let each = |of: &dyn Fn(u64, u64) -> u64| -> Vec<Vec<u64>> {
            (0..replicates).map(|r| (0..dimensions as u64).map(|d| of(r, d)).collect()).collect()
        };
        let design = match method {
            Method::PseudoRandom => Design::PseudoRandom,
            Method::LatinHypercube => {
                let keys = each(&|r, d| derived(derived(seed, r), d));
                let shuffles =
                    keys.into_iter().map(|keys| keys.into_iter().map(|key| Permutation::new(units, key)).collect());
                Design::LatinHypercube(shuffles.collect(), u64::MAX / units)
            }
            Method::ScrambledSobol => {
                let keys = (0..replicates).map(|r| (0..dimensions as u64).map(|d| key(seed, r, d)).collect());
                Design::ScrambledSobol(Directions::new(dimensions), keys.collect())
            }
        };
        Self { seed, dimensions, replicate: units, design }
    }

    /// Writes the numbers of the units from `first` on, one row a dimension.
    pub fn fill(&self, first: u64, bits: &mut [[u64; LANES]]) {
        match &self.design {
            Design::PseudoRandom => widest(
                #[inline(always)]
                || {
                    let mut streams = Streams::new(self.seed, first);
                    for row in bits {
                        *row = streams.next();
                    }
                },
            ),
            Design::LatinHypercube(shuffles, width) => {
                for lane in 0..LANES {
                    let unit = first + lane as u64;
                    let mut stream = unit_stream(self.seed, unit);
                    let (replicate, index) = self.place(unit, shuffles.len());
                    for (row, shuffle) in bits.iter_mut().zip(&shuffles[replicate]) {
                        let within = (u128::from(stream.next_u64()) * u128::from(*width)) >> 64;
                        row[lane] = shuffle.of(index) * width + within as u64;
                    }
                }
            }
            Design::ScrambledSobol(directions, keys) => {
                let mut point = vec![0; self.dimensions];
                for lane in 0..LANES {
                    let (replicate, index) = self.place(first + lane as u64, keys.len());
                    directions.point(index as u32, &mut point);
                    for ((row, coordinate), key) in bits.iter_mut().zip(&point).zip(&keys[replicate]) {
                        // The middle of the digit that was drawn last.
                        row[lane] = u64::from(scrambled(*coordinate, *key)) << 32 | 1 << 31;
                    }
                }
            }
        }
    }

    /// Replicate and number within it; units past the last, which only fill up lanes, count as the first.
    fn place(&self, unit: u64, replicates: usize) -> (usize, u64) {
        let replicate = (unit / self.replicate) as usize;
        if replicate < replicates { (replicate, unit % self.replicate) } else { (0, 0) }
    }
}

#[cfg(test)]
mod tests {
    use super::{LANES, Method, Sampler};

    const METHODS: [Method; 3] = [Method::PseudoRandom, Method::LatinHypercube, Method::ScrambledSobol];

    fn drawn(sampler: &Sampler, first: u64) -> Vec<[u64; LANES]> {
        let mut bits = vec![[0; LANES]; sampler.dimensions];
        sampler.fill(first, &mut bits);
        bits
    }

    #[test]
    fn one_unit_drawn_alone_is_the_same_unit() {
        for method in METHODS {
            let sampler = Sampler::new(method, 9, 7, 2, 100);
            let all: Vec<_> = (0..200 / LANES as u64).map(|group| drawn(&sampler, group * LANES as u64)).collect();
            for unit in [0, 13, 99, 100, 199] {
                let alone = drawn(&sampler, unit);
                let group = &all[unit as usize / LANES];
                assert!(alone.iter().zip(group).all(|(a, b)| a[0] == b[unit as usize % LANES]), "{method:?} {unit}");
            }
            let other = Sampler::new(method, 10, 7, 2, 100);
            assert!(drawn(&other, 0) != all[0], "{method:?}");
        }
    }

    #[test]
    fn a_latin_hypercube_has_one_unit_a_stratum() {
        let sampler = Sampler::new(Method::LatinHypercube, 3, 5, 2, 104);
        for dimension in 0..5 {
            let mut strata: Vec<u128> = (0..13)
                .flat_map(|group| drawn(&sampler, 104 + group * LANES as u64)[dimension])
                .map(|bits| (u128::from(bits) * 104) >> 64)
                .collect();
            strata.sort_unstable();
            assert!(strata.iter().copied().eq(0..104));
        }
    }
}
