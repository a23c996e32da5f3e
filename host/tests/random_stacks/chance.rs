//! Random numbers of the test's own: another generator and other transformations than slipfit's.

use std::f64::consts::TAU;

/// PCG-XSH-RR with 64 bits of state (O'Neill 2014).
#[derive(Clone, Debug)]
pub struct Chance {
    state: u64,
    increment: u64,
}

impl Chance {
    /// The sequence number `stream` of the generator started by `seed`.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut made = Self { state: 0, increment: stream << 1 | 1 };
        made.word();
        made.state = made.state.wrapping_add(seed);
        made.word();
        made
    }

    fn word(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(self.increment);
        (((old >> 18 ^ old) >> 27) as u32).rotate_right((old >> 59) as u32)
    }

    /// Uniform in (0, 1), 52 bits.
    pub fn unit(&mut self) -> f64 {
        let bits = u64::from(self.word()) << 20 ^ u64::from(self.word()) >> 12;
        (bits as f64 + 0.5) / (1u64 << 52) as f64
    }

    /// Uniform in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A whole number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// True with this probability.
    pub fn happens(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// One of `choices`.
    pub fn one_of<T: Clone>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())].clone()
    }

    /// A random decimal in [low, high] with this many digits behind the point, so that text and number agree.
    pub fn decimal(&mut self, low: f64, high: f64, digits: usize) -> f64 {
        decimal(self.between(low, high), digits)
    }

    /// A standard normal, by Box and Muller.
    pub fn normal(&mut self) -> f64 {
        libm::sqrt(-2.0 * libm::log(self.unit())) * libm::cos(TAU * self.unit())
    }

    /// A gamma variable of this shape and scale 1, by Marsaglia and Tsang (2000).
    pub fn gamma(&mut self, shape: f64) -> f64 {
        if shape < 1.0 {
            return self.gamma(shape + 1.0) * libm::pow(self.unit(), 1.0 / shape);
        }
        let d = shape - 1.0 / 3.0;
        loop {
            let z = self.normal();
            let root = 1.0 + z / libm::sqrt(9.0 * d);
            let v = root * root * root;
            if v > 0.0 && libm::log(self.unit()) < 0.5 * z * z + d * (1.0 - v + libm::log(v)) {
                return d * v;
            }
        }
    }

    /// A random order of the numbers below `count`.
    pub fn order(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            let other = self.below(last + 1);
            order.swap(last, other);
        }
        order
    }
}

/// `value` to this many digits behind the point.
pub fn decimal(value: f64, digits: usize) -> f64 {
    format!("{value:.digits$}").parse().unwrap()
}
