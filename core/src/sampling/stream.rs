//! One stream of random numbers a unit.

pub use rand_core::Rng;
use rand_core::SeedableRng;
pub use rand_xoshiro::Xoshiro256PlusPlus;

/// ⌊2⁶⁴/φ⌋, odd: the increment of SplitMix64.
pub const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// The output function of SplitMix64 (Steele, Lea, Flood 2014, with Stafford's variant 13): a bijection of 64 bits in
/// which every bit of the input moves half of the output's.
#[inline(always)]
pub const fn mix(word: u64) -> u64 {
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

/// A seed for another purpose than `seed` itself: independent for every `purpose`.
#[inline(always)]
pub const fn derived(seed: u64, purpose: u64) -> u64 {
    mix(mix(seed).wrapping_add(purpose.wrapping_mul(GOLDEN)))
}

/// The stream of unit `unit` of the production `seed`.
///
/// xoshiro256++ (Blackman, Vigna 2021) whose state is four outputs of SplitMix64 from [`derived`]`(seed, unit)`, a
/// bijection of `unit`: no two units of a production start alike, and each can be drawn alone.
#[inline(always)]
pub fn unit_stream(seed: u64, unit: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(derived(seed, unit))
}

/// A number between 0 and 1, neither of both, from random `bits`: the middle of one of 2⁵³ equal parts. That of the last part would
/// be rounded to 1.
#[inline(always)]
pub fn uniform(bits: u64) -> f64 {
    (((bits >> 11) as f64 + 0.5) / (1u64 << 53) as f64).min(1.0 - 0.5 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::{GOLDEN, Rng, SeedableRng, Xoshiro256PlusPlus, derived, mix, uniform, unit_stream};

    #[test]
    fn generator_gives_the_published_numbers() {
        let mut state = [0; 32];
        for (word, value) in state.chunks_mut(8).zip([1u64, 2, 3, 4]) {
            word.copy_from_slice(&value.to_le_bytes());
        }
        let mut generator = Xoshiro256PlusPlus::from_seed(state);
        let published = [41943041, 58720359, 3588806011781223, 3591011842654386, 9228616714210784205];
        assert_eq!(published.map(|_| generator.next_u64()), published);
    }

    #[test]
    fn seeding_is_what_it_is_documented_to_be() {
        let start = derived(7, 5);
        let mut state = [0; 32];
        for (k, word) in (1u64..).zip(state.chunks_mut(8)) {
            word.copy_from_slice(&mix(start.wrapping_add(k.wrapping_mul(GOLDEN))).to_le_bytes());
        }
        assert_eq!(unit_stream(7, 5), Xoshiro256PlusPlus::from_seed(state));
    }

    #[test]
    fn units_and_seeds_have_streams_of_their_own() {
        assert_eq!(unit_stream(7, 1000).next_u64(), unit_stream(7, 1000).next_u64());
        let first = |seed, unit| unit_stream(seed, unit).next_u64();
        assert!(first(7, 0) != first(7, 1) && first(7, 0) != first(8, 0) && first(0, 1) != first(1, 0));
        // Neighbours are uncorrelated: the product of two uniform numbers about ½ has mean 0 and deviation 1/12.
        let centred = |unit| uniform(first(3, unit)) - 0.5;
        assert!(uniform(0) > 0.0 && uniform(u64::MAX) < 1.0);
        let count = if cfg!(miri) { 100 } else { 10_000 };
        let mean = (0..count).map(|unit| centred(unit) * centred(unit + 1)).sum::<f64>() / count as f64;
        assert!(libm::fabs(mean) < 4.0 / 12.0 / libm::sqrt(count as f64), "{mean}");
    }
}
