//! Sobol' points with 32 digits in up to a thousand dimensions, Owen-scrambled.
//!
//! Directions of S. Joe and F. Y. Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J.
//! Sci. Comput. 30 (2008), file new-joe-kuo-6, under the licence beside it.

use slipfit_core::sampling::stream::derived;

/// Degree, polynomial and initial numbers of dimensions 2 to 1000, a line each.
const JOE_KUO: &str = include_str!("joe-kuo-6.txt");

/// The most dimensions.
pub const MOST_DIMENSIONS: usize = 1000;
/// Digits of a coordinate; there are as many points as a coordinate has values.
pub const DIGITS: usize = 32;

/// Direction numbers, bit-reversed: the first digit of a coordinate is bit 0, as the scrambling wants it.
#[derive(Clone, Debug)]
pub struct Directions {
    /// Of every digit of a point's number, one a dimension.
    of_digit: Vec<Vec<u32>>,
}

impl Directions {
    /// For `dimensions` ≤ [`MOST_DIMENSIONS`].
    pub fn new(dimensions: usize) -> Self {
        let mut of_digit = vec![Vec::new(); DIGITS];
        let first = (0..DIGITS).map(|digit| 1 << digit).collect();
        let others = JOE_KUO.lines().skip(1).map(directions);
        for numbers in std::iter::once(first).chain(others).take(dimensions) {
            let numbers: Vec<u32> = numbers;
            of_digit.iter_mut().zip(numbers).for_each(|(digit, number)| digit.push(number));
        }
        Self { of_digit }
    }

    /// Writes the coordinates of point `index`, bit-reversed.
    pub fn point(&self, index: u32, coordinates: &mut [u32]) {
        coordinates.fill(0);
        let mut left = index;
        while left != 0 {
            let digit = left.trailing_zeros();
            for (coordinate, direction) in coordinates.iter_mut().zip(&self.of_digit[digit as usize]) {
                *coordinate ^= direction;
            }
            left &= left - 1;
        }
    }
}

/// The bit-reversed directions of a line of the file: dimension, degree s, inner coefficients a, numbers m.
fn directions(line: &str) -> Vec<u32> {
    let mut fields = line.split_ascii_whitespace().skip(1).map_while(|field| field.parse::<u32>().ok());
    let (degree, inner) = (fields.next().unwrap_or(1) as usize, fields.next().unwrap_or(0));
    let mut numbers: Vec<u32> = fields.zip(1..).map(|(m, digit)| m << (DIGITS - digit)).collect();
    for k in degree..DIGITS {
        let mut number = numbers[k - degree] ^ numbers[k - degree] >> degree;
        for j in 1..degree {
            if inner >> (degree - 1 - j) & 1 == 1 {
                number ^= numbers[k - j];
            }
        }
        numbers.push(number);
    }
    numbers.into_iter().map(u32::reverse_bits).collect()
}

/// Owen's nested uniform scrambling of a bit-reversed coordinate, by a hash in which every digit is flipped by a function
/// of the digits before it (Laine, Karras 2011; constants of N. Vegdahl).
#[inline(always)]
pub fn scrambled(reversed: u32, key: u32) -> u32 {
    let mut x = reversed;
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(key);
    x = x.wrapping_mul((key >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

/// The key that scrambles `dimension` in replicate `replicate` of a study with `seed`.
pub fn key(seed: u64, replicate: u64, dimension: u64) -> u32 {
    (derived(derived(seed, replicate), dimension) >> 32) as u32
}

#[cfg(test)]
mod tests {
    use super::{Directions, MOST_DIMENSIONS, key, scrambled};

    /// Coordinates in [0, 1) of the first points, as every implementation of these directions gives them.
    #[test]
    fn first_points() {
        let directions = Directions::new(5);
        let mut point = [0; 5];
        let mut rows = Vec::new();
        for index in 0..8 {
            directions.point(index, &mut point);
            rows.push(point.map(|x| f64::from(x.reverse_bits()) / 4_294_967_296.0));
        }
        insta::assert_debug_snapshot!(rows.iter().map(|row| format!("{row:?}")).collect::<Vec<_>>());
    }

    /// Every coordinate of the first 2ᵐ points, scrambled or not, falls once into each interval of length 1/2ᵐ.
    #[test]
    fn every_dimension_is_stratified() {
        let directions = Directions::new(MOST_DIMENSIONS);
        let mut point = vec![0; MOST_DIMENSIONS];
        let mut hits = vec![[0u64; 4]; MOST_DIMENSIONS];
        for index in 0..256 {
            directions.point(index, &mut point);
            for (dimension, (coordinate, hits)) in point.iter().zip(&mut hits).enumerate() {
                let stratum = scrambled(*coordinate, key(1, 0, dimension as u64)) >> 24;
                hits[(stratum / 64) as usize] |= 1 << (stratum % 64);
            }
        }
        assert!(hits.iter().flatten().all(|hit| *hit == u64::MAX));
    }

    /// A digit of the result depends on the digits before it and its own only, and flips with it.
    #[test]
    fn scrambling_is_nested() {
        for key in [0, 1, 0x8000_0000, 0xdead_beef] {
            for digit in 0..32 {
                let (one, other) = (scrambled(0x1234_5678, key), scrambled(0x1234_5678 ^ 1 << digit, key));
                assert_eq!((one ^ other).leading_zeros(), digit);
            }
        }
    }
}
