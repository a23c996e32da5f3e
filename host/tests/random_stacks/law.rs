//! Distributions of dimensions: their scene text, their limits, and values drawn without slipfit.

use super::chance::{Chance, decimal};

/// How a dimension deviates from its value. Numbers are deviations in the dimension's own unit.
#[derive(Clone, Debug)]
pub enum Law {
    Constant,
    Normal(Spread),
    Truncated(Spread),
    Uniform,
    Triangular {
        mode: Option<f64>,
    },
    Trapezoidal {
        shoulders: [f64; 2],
    },
    Beta {
        shapes: [f64; 2],
    },
    Skewed(Spread, f64),
    Weibull {
        shape: f64,
        scale: f64,
        location: f64,
    },
    Gumbel {
        mode: f64,
        scale: f64,
        smallest: bool,
    },
    Lognormal {
        mean: f64,
        deviation: f64,
        location: f64,
    },
    Table(Vec<f64>),
    /// Weights, limits and laws.
    Mixture(Vec<(f64, [f64; 2], Law)>),
}

/// Mean and standard deviation.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    pub mean: Mean,
    pub width: Width,
}

#[derive(Clone, Copy, Debug)]
pub enum Mean {
    /// In the middle of the limits.
    Middle,
    /// At this deviation from the value.
    Stated(f64),
    /// At this distance from the middle.
    Shifted(f64),
}

#[derive(Clone, Copy, Debug)]
pub enum Width {
    /// Half of the tolerance over this.
    Sigma(f64),
    Deviation(f64),
    /// The nearer limit is three times this many standard deviations from the mean.
    Cpk(f64),
}

impl Spread {
    fn random(chance: &mut Chance, [low, high]: [f64; 2]) -> Self {
        let half = 0.5 * (high - low);
        let off = decimal(chance.between(-0.5, 0.5) * half, 6);
        let mean = match chance.below(6) {
            0 => Mean::Stated(decimal(0.5 * (low + high) + off, 6)),
            1 => Mean::Shifted(off),
            _ => Mean::Middle,
        };
        let width = match chance.below(6) {
            0 => Width::Deviation(decimal(half * chance.between(0.15, 0.6), 6)),
            1 => Width::Cpk(chance.one_of(&[0.5, 0.8, 1.0, 1.33, 2.0])),
            _ => Width::Sigma(chance.one_of(&[3.0, 3.0, 2.0, 4.5, 1.5, 6.0])),
        };
        Self { mean, width }
    }

    /// Mean and standard deviation of the deviations.
    fn moments(&self, [low, high]: [f64; 2]) -> [f64; 2] {
        let middle = 0.5 * (low + high);
        let mean = match self.mean {
            Mean::Middle => middle,
            Mean::Stated(mean) => mean,
            Mean::Shifted(shift) => middle + shift,
        };
        let deviation = match self.width {
            Width::Sigma(sigma) => 0.5 * (high - low) / sigma,
            Width::Deviation(deviation) => deviation,
            Width::Cpk(cpk) => (high - mean).min(mean - low) / (3.0 * cpk),
        };
        [mean, deviation]
    }
}

/// A standard normal's distribution function.
pub fn normal_share(score: f64) -> f64 {
    0.5 * libm::erfc(-score * std::f64::consts::FRAC_1_SQRT_2)
}

/// Its inverse, by bisection and then Newton's method; within ±9.
pub fn normal_point(share: f64) -> f64 {
    if share > 0.5 {
        return -normal_point(1.0 - share);
    }
    let (mut low, mut high) = (-9.0, 0.0);
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        if normal_share(middle) < share { low = middle } else { high = middle }
    }
    let mut at: f64 = 0.5 * (low + high);
    for _ in 0..3 {
        let density = libm::exp(-0.5 * at * at) / libm::sqrt(std::f64::consts::TAU);
        at = (at - (normal_share(at) - share) / density).clamp(-9.0, 0.0);
    }
    at
}

impl Law {
    /// A random one for a tolerance with the limits `low` and `high`; `plain` ones are no mixtures.
    pub fn random(chance: &mut Chance, [low, high]: [f64; 2], plain: bool) -> Self {
        let half = 0.5 * (high - low);
        let within = |chance: &mut Chance| decimal(chance.between(low, high), 6).clamp(low, high);
        let spread = |chance: &mut Chance| Spread::random(chance, [low, high]);
        match chance.below(if plain { 12 } else { 14 }) {
            0 | 1 => Self::Normal(spread(chance)),
            2 => Self::Truncated(spread(chance)),
            3 => Self::Uniform,
            4 => Self::Triangular {
                mode: chance
                    .happens(0.6)
                    .then(|| chance.one_of(&[low, high, 0.0]))
                    .filter(|mode| (low..=high).contains(mode))
                    .or_else(|| chance.happens(0.5).then(|| within(chance))),
            },
            5 => {
                let (a, b) = (within(chance), within(chance));
                Self::Trapezoidal { shoulders: [a.min(b), a.max(b)] }
            }
            // slipfit takes microseconds for one of its values.
            6 if !plain && chance.happens(0.5) => {
                Self::Beta { shapes: [0, 1].map(|_| chance.one_of(&[0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 12.0])) }
            }
            6 | 7 => Self::Skewed(spread(chance), chance.one_of(&[-2.0, -0.7, 0.1, 0.5, 1.0, 2.0])),
            8 => Self::Weibull {
                shape: chance.one_of(&[0.8, 1.0, 1.5, 2.0, 3.5, 8.0]),
                scale: decimal(half, 6),
                location: chance.one_of(&[0.0, low]),
            },
            9 => Self::Gumbel {
                mode: chance.one_of(&[0.0, low]),
                scale: decimal(0.3 * half, 6),
                smallest: chance.happens(0.5),
            },
            10 => {
                let location = chance.one_of(&[0.0, low]);
                let mean = decimal(location + half, 6);
                Self::Lognormal { mean, deviation: decimal(half * chance.between(0.1, 0.7), 6), location }
            }
            11 => {
                let mut values: Vec<f64> = (0..2 + chance.below(9)).map(|_| within(chance)).collect();
                values.extend([low, high].into_iter().filter(|_| chance.happens(0.5)));
                values.sort_by(f64::total_cmp);
                if values[0] == values[values.len() - 1] { Self::Uniform } else { Self::Table(values) }
            }
            _ => {
                let part = |chance: &mut Chance| {
                    let (a, b) = (within(chance), within(chance));
                    let limits = if (a - b).abs() < 0.05 * half { [low, high] } else { [a.min(b), a.max(b)] };
                    let law = Self::random(chance, limits, true);
                    (chance.one_of(&[1.0, 1.0, 2.0, 0.1, 7.0]), if law.is_scaled() { limits } else { [0.0; 2] }, law)
                };
                let mut parts: Vec<_> = (0..2 + chance.below(2)).map(|_| part(chance)).collect();
                if chance.happens(0.15) {
                    // A small lot far away.
                    let at = decimal(chance.between(5.0, 40.0) * half, 3);
                    parts.push((0.02, [at, decimal(at + half, 4)], Self::Uniform));
                }
                Self::Mixture(parts)
            }
        }
    }

    /// Whether the tolerance gives its place and width.
    pub fn is_scaled(&self) -> bool {
        !self.stands_alone() && !self.has_width()
    }

    /// Whether it takes no tolerance.
    pub fn stands_alone(&self) -> bool {
        matches!(self, Self::Constant | Self::Table(_))
    }

    /// Whether a tolerance beside it gives limits alone.
    pub fn has_width(&self) -> bool {
        match self {
            Self::Normal(spread) | Self::Skewed(spread, _) => matches!(spread.width, Width::Deviation(_)),
            Self::Weibull { .. } | Self::Gumbel { .. } | Self::Lognormal { .. } | Self::Mixture(_) => true,
            _ => false,
        }
    }

    /// A deviation drawn by a method of its own; `limits` are those of the tolerance.
    pub fn draw(&self, limits: [f64; 2], chance: &mut Chance) -> f64 {
        let [low, high] = limits;
        match self {
            Self::Normal(spread) => {
                let [mean, deviation] = spread.moments(limits);
                mean + deviation * chance.normal()
            }
            Self::Truncated(spread) => loop {
                let [mean, deviation] = spread.moments(limits);
                let x = mean + deviation * chance.normal();
                if (low..=high).contains(&x) {
                    return x;
                }
            },
            // By rejection under the highest density.
            Self::Triangular { .. } | Self::Trapezoidal { .. } => loop {
                let (x, y) = (chance.between(low, high), chance.unit());
                let [left, right] = self.shoulders(limits);
                let density = if x < left {
                    (x - low) / (left - low)
                } else if x > right {
                    (high - x) / (high - right)
                } else {
                    1.0
                };
                if y < density {
                    return x;
                }
            },
            Self::Beta { shapes: [a, b] } => {
                let (x, y) = (chance.gamma(*a), chance.gamma(*b));
                low + (high - low) * x / (x + y)
            }
            Self::Skewed(spread, skewness) => shifted_lognormal(spread.moments(limits), *skewness, chance.normal()),
            Self::Lognormal { mean, deviation, location } => {
                let square = libm::log1p(deviation * deviation / ((mean - location) * (mean - location)));
                location + (mean - location) * libm::exp(libm::sqrt(square) * chance.normal() - 0.5 * square)
            }
            Self::Mixture(parts) => {
                let mut left = chance.unit() * parts.iter().map(|(weight, ..)| weight).sum::<f64>();
                for (weight, limits, law) in parts {
                    if left < *weight {
                        return law.draw(*limits, chance);
                    }
                    left -= weight;
                }
                parts[0].2.draw(parts[0].1, chance)
            }
            _ => self.point(limits, chance.unit()),
        }
    }

    fn shoulders(&self, [low, high]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Triangular { mode } => [mode.unwrap_or(0.5 * (low + high)); 2],
            Self::Trapezoidal { shoulders } => *shoulders,
            _ => [low, high],
        }
    }

    /// The deviation below which this share of all lies, 0 < share < 1.
    pub fn point(&self, limits: [f64; 2], share: f64) -> f64 {
        let [low, high] = limits;
        match self {
            Self::Constant => 0.0,
            Self::Uniform => low + (high - low) * share,
            Self::Normal(spread) => {
                let [mean, deviation] = spread.moments(limits);
                mean + deviation * normal_point(share)
            }
            Self::Truncated(spread) => {
                let [mean, deviation] = spread.moments(limits);
                let [below, up_to] = limits.map(|limit| normal_share((limit - mean) / deviation));
                (mean + deviation * normal_point(below + share * (up_to - below))).clamp(low, high)
            }
            Self::Triangular { .. } | Self::Trapezoidal { .. } => {
                let [left, right] = self.shoulders(limits);
                let area = 0.5 * (high - low + right - left);
                let (rise, fall) = (0.5 * (left - low) / area, 0.5 * (high - right) / area);
                if share < rise {
                    low + libm::sqrt(2.0 * share * area * (left - low))
                } else if share > 1.0 - fall {
                    high - libm::sqrt(2.0 * (1.0 - share) * area * (high - right))
                } else {
                    left + (share - rise) * area
                }
            }
            Self::Skewed(spread, skewness) => {
                let score = if *skewness < 0.0 { -normal_point(share) } else { normal_point(share) };
                shifted_lognormal(spread.moments(limits), *skewness, score)
            }
            Self::Weibull { shape, scale, location } => location + scale * libm::pow(-libm::log1p(-share), 1.0 / shape),
            Self::Gumbel { mode, scale, smallest: false } => mode - scale * libm::log(-libm::log(share)),
            Self::Gumbel { mode, scale, smallest: true } => mode + scale * libm::log(-libm::log1p(-share)),
            Self::Lognormal { mean, deviation, location } => {
                let square = libm::log1p(deviation * deviation / ((mean - location) * (mean - location)));
                location + (mean - location) * libm::exp(libm::sqrt(square) * normal_point(share) - 0.5 * square)
            }
            Self::Table(values) => {
                let place = share * (values.len() - 1) as f64;
                let piece = (place as usize).min(values.len() - 2);
                values[piece] + (values[piece + 1] - values[piece]) * (place - piece as f64)
            }
            Self::Beta { .. } | Self::Mixture(_) => unreachable!("no closed form"),
        }
    }

    /// Whether [`Self::point`] knows it.
    pub fn has_points(&self) -> bool {
        !matches!(self, Self::Constant | Self::Beta { .. } | Self::Mixture(_))
    }

    /// Where all deviations lie except a share of 1e-15, and so certainly those of every unit that is drawn.
    pub fn support(&self, limits: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Beta { .. } => limits,
            Self::Mixture(parts) => {
                let ends = parts.iter().map(|(_, limits, law)| law.support(*limits));
                ends.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap()
            }
            _ => [1e-15, 1.0 - 1e-15].map(|share| self.point(limits, share)),
        }
    }

    /// Limits for the worst case: those of the `tolerance`, unless the distribution has its own.
    pub fn limits(&self, tolerance: Option<[f64; 2]>) -> [f64; 2] {
        match (self, tolerance) {
            (Self::Constant, _) => [0.0; 2],
            (Self::Table(values), _) => [values[0], values[values.len() - 1]],
            (_, Some(limits)) => limits,
            (Self::Mixture(parts), None) => {
                let ends = parts.iter().map(|(_, limits, law)| law.limits((!law.has_width()).then_some(*limits)));
                ends.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap()
            }
            (law, None) => [-3.0, 3.0].map(|score| law.point([0.0; 2], normal_share(score))),
        }
    }
}

/// Of these moments, at a standard normal score; its mirror image for a negative skewness.
fn shifted_lognormal([mean, deviation]: [f64; 2], skewness: f64, score: f64) -> f64 {
    // (w + 2)·√(w − 1) is the skewness of a log-normal with w = e^(s²); it grows with w.
    let (mut low, mut high) = (0.0f64, 100.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if (middle + 3.0) * libm::sqrt(middle) < skewness.abs() { low = middle } else { high = middle }
    }
    let square = libm::log1p(low);
    let unit = (libm::exp(libm::sqrt(square) * score) - libm::exp(0.5 * square)) / libm::sqrt(low * (1.0 + low));
    mean + deviation.copysign(skewness) * unit
}
