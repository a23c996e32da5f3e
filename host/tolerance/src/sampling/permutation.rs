//! Shuffles that are not stored: a bijection of 0…n − 1 for every key.

/// A keyed bijection of the numbers below `count`.
#[derive(Clone, Copy, Debug)]
pub struct Permutation {
    count: u64,
    mask: u64,
    shift: u32,
    key: [u64; 4],
}

impl Permutation {
    /// Of the numbers below `count` ≥ 1, by a random `key`.
    pub fn new(count: u64, key: u64) -> Self {
        let bits = (64 - (count - 1).leading_zeros()).max(2);
        let word = |i| slipfit_core::sampling::stream::derived(key, i);
        Self {
            count,
            mask: u64::MAX >> (64 - bits),
            shift: bits.div_ceil(2),
            key: [word(0), word(1), word(2), word(3)],
        }
    }

    /// Where `index` < count goes.
    ///
    /// Every step maps the next power of two onto itself; what lands outside goes round again (cycle walking), less than
    /// twice on average.
    pub fn of(&self, index: u64) -> u64 {
        let mut x = index;
        loop {
            for key in self.key {
                x = x.wrapping_mul(key | 1).wrapping_add(key >> 32) & self.mask;
                x ^= x >> self.shift;
            }
            if x < self.count {
                return x;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Permutation;

    #[test]
    fn is_a_bijection() {
        for count in [1, 2, 3, 5, 625, 1000, 1024, 4097] {
            let permutation = Permutation::new(count, 42);
            let mut images: Vec<u64> = (0..count).map(|i| permutation.of(i)).collect();
            images.sort_unstable();
            assert!(images.iter().copied().eq(0..count), "{count}");
        }
    }

    /// Ranks of two shuffles are uncorrelated: over many pairs the coefficient has deviation 1/√(n − 1).
    #[test]
    fn shuffles_are_uncorrelated() {
        for count in [100u64, 128, 1000] {
            let centred = |key| {
                let permutation = Permutation::new(count, key);
                (0..count).map(move |i| permutation.of(i) as f64 - (count - 1) as f64 / 2.0).collect::<Vec<_>>()
            };
            let variance = ((count * count - 1) as f64) / 12.0;
            let shuffles: Vec<_> = (0..60).map(centred).collect();
            let mut squares = 0.0;
            let mut pairs = 0.0;
            for i in 0..shuffles.len() {
                for j in 0..i {
                    let product: f64 = shuffles[i].iter().zip(&shuffles[j]).map(|(a, b)| a * b).sum();
                    let coefficient = product / variance / count as f64;
                    squares += coefficient * coefficient;
                    pairs += 1.0;
                }
            }
            let ratio = squares / pairs * (count - 1) as f64;
            assert!((ratio - 1.0).abs() < 4.0 * libm::sqrt(2.0 / pairs), "{count}: {ratio}");
        }
    }
}
