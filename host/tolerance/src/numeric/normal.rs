//! The standard normal on the desk: draws by a table, three times as fast as the ratios of polynomials it is made from.
//!
//! A table with four numbers for each 128th of an octave of the tail probability is far too large for a controller and
//! fits a desk's cache: five draws of six need its first 16 KB.

use std::{f64::consts::FRAC_1_SQRT_2, sync::LazyLock};

use slipfit_core::sampling::normal::upper_score;

use crate::numeric::lanes::{LANES, Lanes};

/// Probability that intervals of 95 % leave out on either side.
pub const SIDE: f64 = 0.025;
/// 1/√(2π).
const DENSITY_AT_MEAN: f64 = 0.398_942_280_401_432_7;
/// Binary digits that choose a piece of an octave.
const DIGITS: u32 = 7;
const MANTISSA: u64 = (1 << 52) - 1;
const ONE: u64 = 1023 << 52;
const SIGN: u64 = 1 << 63;
const TWO_52: u64 = (1023 + 52) << 52;
const TWO_84: u64 = (1023 + 84) << 52;
/// Pieces, filled up to a power of two: a place cannot lie beyond.
const COUNT: usize = 64 << DIGITS;

/// Cubic pieces in the tail probability, for tails of 1/2⁶⁴ to ½: values and slopes agree where they meet.
static PIECES: LazyLock<Box<[[f64; 4]; COUNT]>> = LazyLock::new(|| {
    let knot = |piece: u64| f64::from_bits(ONE + (piece << (52 - DIGITS)));
    let at = |tail: f64| {
        let score = upper_score(tail / 18_446_744_073_709_551_616.0);
        (score, -1.0 / (density(score) * 18_446_744_073_709_551_616.0))
    };
    let piece = |i| {
        let (from, to) = (knot(i), knot(i + 1));
        let ((value, slope), (end, end_slope)) = (at(from), at(to.min(9_223_372_036_854_775_808.0)));
        let (slope, end_slope) = (slope * (to - from), end_slope * (to - from));
        [value, slope, 3.0 * (end - value) - 2.0 * slope - end_slope, 2.0 * (value - end) + slope + end_slope]
    };
    let mut pieces = Box::new([[0.0; 4]; COUNT]);
    pieces.iter_mut().zip(0..=63 << DIGITS).for_each(|(place, i)| *place = piece(i));
    pieces
});

/// The standard normal of 64 random bits in the sense of [`slipfit_core::sampling::normal::score`], which it meets
/// within 1e-10.
#[derive(Clone, Copy)]
pub struct Scores(&'static [[f64; 4]; COUNT]);

impl Scores {
    /// The table, made once a process.
    pub fn table() -> Self {
        Self(&PIECES)
    }

    /// The score of `bits`.
    #[inline(always)]
    pub fn score(self, bits: u64) -> f64 {
        let tail = tail_of(bits);
        cubic(self.0[place(tail)], tail, bits)
    }

    /// The scores of several units.
    #[inline(always)]
    pub fn lanes(self, bits: [u64; LANES]) -> Lanes {
        // Step by step over all lanes: all but the table's look-up is in vectors.
        let (mut tails, mut pieces, mut scores) = ([0; LANES], [[0.0; LANES]; 4], [0.0; LANES]);
        for lane in 0..LANES {
            tails[lane] = tail_of(bits[lane]);
        }
        for lane in 0..LANES {
            let [c0, c1, c2, c3] = self.0[place(tails[lane])];
            (pieces[0][lane], pieces[1][lane], pieces[2][lane], pieces[3][lane]) = (c0, c1, c2, c3);
        }
        let [c0, c1, c2, c3] = &pieces;
        for lane in 0..LANES {
            scores[lane] = cubic([c0[lane], c1[lane], c2[lane], c3[lane]], tails[lane], bits[lane]);
        }
        Lanes(scores)
    }
}

/// The tail probability of `bits` times 2⁶⁴, from 1 to 2⁶³, as the bits of a float.
#[inline(always)]
fn tail_of(bits: u64) -> u64 {
    let tail = ((bits | 1) as i64).unsigned_abs();
    // Both halves as floats, the upper one exact: rounded once, in instructions that there are for vectors.
    let upper = f64::from_bits(tail >> 32 | TWO_84) - (f64::from_bits(TWO_84) + f64::from_bits(TWO_52));
    (upper + f64::from_bits(tail & 0xffff_ffff | TWO_52)).to_bits()
}

/// The piece in which a tail lies.
#[inline(always)]
fn place(tail: u64) -> usize {
    ((tail - ONE) >> (52 - DIGITS)) as usize % COUNT
}

#[inline(always)]
fn cubic([c0, c1, c2, c3]: [f64; 4], tail: u64, bits: u64) -> f64 {
    let t = f64::from_bits((tail << DIGITS) & MANTISSA | ONE) - 1.0;
    let magnitude = c0 + t * (c1 + t * (c2 + t * c3));
    f64::from_bits(magnitude.to_bits() ^ (!bits & SIGN))
}

/// The standard normal density.
pub fn density(score: f64) -> f64 {
    DENSITY_AT_MEAN * libm::exp(-0.5 * score * score)
}

/// P(Z > `score`), accurate in the upper tail.
pub fn tail(score: f64) -> f64 {
    0.5 * libm::erfc(score * FRAC_1_SQRT_2)
}

/// The score below which a standard normal lies with `probability`, 0 < probability < 1.
pub fn quantile(probability: f64) -> f64 {
    if probability < 0.5 { -upper_score(probability) } else { upper_score(1.0 - probability) }
}

/// Half the width of an interval of 95 % of a normal estimate, in standard errors.
pub fn normal_factor() -> f64 {
    -quantile(SIDE)
}

#[cfg(test)]
mod tests {
    use slipfit_core::sampling::{normal::score, stream::mix};

    use crate::numeric::normal::{Scores, quantile, tail};

    #[test]
    fn table_meets_its_bound() {
        let table = Scores::table();
        let corners = [0, 1, 2, 3, 1 << 62, (1 << 63) - 1, 1 << 63, u64::MAX];
        let random = (0..200_000u64).map(|i| mix(i) >> (i % 64));
        for bits in random.chain(corners) {
            let error = (table.score(bits) - score::<f64>(bits)).abs();
            assert!(error <= 1e-10, "{bits}: {error:e}");
            assert_eq!(table.score(bits), -table.score(!bits));
        }
    }

    #[test]
    fn tails_in_ppm() {
        for (n, ppm) in [
            (2.0, 22750.1319),
            (2.5, 6209.66533),
            (3.0, 1349.89803),
            (3.43, 301.790625),
            (4.5, 3.39767312),
            (6.0, 9.86587645e-4),
        ] {
            assert!((tail(n) * 1e6 / ppm - 1.0).abs() < 2.5e-9, "{n}: {}", tail(n) * 1e6);
            assert!((-quantile(tail(n)) - n).abs() < 1e-9);
        }
    }
}
