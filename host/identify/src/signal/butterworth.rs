//! S. Butterworth's low pass of fourth order (1930), applied forwards and backwards: no shift of phase, and at the cut-off frequency
//! half the amplitude.

use std::f64::consts::PI;

/// A section of second order, in transposed direct form II.
#[derive(Clone, Debug)]
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

/// The filter.
#[derive(Clone, Debug)]
pub struct LowPass {
    sections: [Section; 2],
    /// Samples that the step response needs to settle to a thousandth.
    settling: usize,
}

impl LowPass {
    /// With a cut-off frequency that is a `share` of the sampling frequency, above 0 and below ½.
    pub fn new(share: f64) -> Self {
        // The bilinear transformation, prewarped to the cut-off frequency.
        let k = libm::tan(PI * share);
        let section = |angle: f64| {
            let damping = 2.0 * libm::cos(angle);
            let norm = 1.0 + k * damping + k * k;
            let b = k * k / norm;
            Section { b: [b, 2.0 * b, b], a: [2.0 * (k * k - 1.0) / norm, (1.0 - k * damping + k * k) / norm] }
        };
        Self { sections: [section(PI / 8.0), section(3.0 * PI / 8.0)], settling: (3.0 / share) as usize + 1 }
    }

    /// Samples at each end of a filtered signal that depend on how it is continued beyond.
    pub fn settling(&self) -> usize {
        self.settling
    }

    /// The `signal`, forwards and backwards, continued at its ends by its reflection at the first and the last point.
    pub fn both_ways(&self, signal: &[f64]) -> Vec<f64> {
        let n = signal.len();
        let pad = self.settling.min(n.saturating_sub(1));
        let (Some(first), Some(last)) = (signal.first(), signal.last()) else { return Vec::new() };
        let before = (1..=pad).rev().map(|i| 2.0 * first - signal[i]);
        let after = (1..=pad).map(|i| 2.0 * last - signal[n - 1 - i]);
        let mut extended: Vec<f64> = before.chain(signal.iter().copied()).chain(after).collect();
        for _ in 0..2 {
            self.sections.iter().for_each(|section| section.apply(&mut extended));
            extended.reverse();
        }
        extended[pad..pad + n].to_vec()
    }
}

impl Section {
    /// Filters in place, as if the first value had been there for ever.
    fn apply(&self, signal: &mut [f64]) {
        let ([b0, b1, b2], [a1, a2]) = (self.b, self.a);
        let first = signal.first().copied().unwrap_or_default();
        let mut late = (b2 - a2) * first;
        let mut soon = (b1 - a1) * first + late;
        for x in signal {
            let y = b0 * *x + soon;
            soon = b1 * *x - a1 * y + late;
            late = b2 * *x - a2 * y;
            *x = y;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LowPass, PI};

    #[test]
    fn amplitudes_follow_the_law_and_phases_do_not_shift() {
        let share = 0.1;
        let filter = LowPass::new(share);
        for frequency in [0.01, 0.05, 0.1, 0.2] {
            let wave: Vec<f64> = (0..4000).map(|i| libm::sin(2.0 * PI * frequency * f64::from(i))).collect();
            let filtered = filter.both_ways(&wave);
            // The squared amplitude of the analogue filter at the prewarped frequency; |H|² = 1/(1 + Ω⁸).
            let ratio = libm::tan(PI * frequency) / libm::tan(PI * share);
            let gain = 1.0 / (1.0 + libm::pow(ratio, 8.0));
            for i in 1000..3000 {
                assert!((filtered[i] - gain * wave[i]).abs() < 1e-6, "{frequency} {i}: {} {}", filtered[i], wave[i]);
            }
        }
    }

    #[test]
    fn a_straight_line_stays_one() {
        let line: Vec<f64> = (0..300).map(|i| 3.0 + 0.1 * f64::from(i)).collect();
        let filtered = LowPass::new(0.05).both_ways(&line);
        let worst = filtered.iter().zip(&line).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-3, "{worst}");
    }
}
