//! Taguchi's loss: what a unit costs its user that works, but is off its target.
//!
//! The loss is k·(y − T)² with k = A₀/Δ₀²: a deviation of Δ₀ costs A₀. Over the production it is k·(σ² + (mean − T)²) on average,
//! whether the measure has limits or not. A unit that can be put right for less than its loss costs no more than that. (Taguchi, *Introduction to quality engineering*, 1986.)

/// The loss of a measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss {
    /// A₀: what a deviation of Δ₀ costs.
    pub cost: f64,
    /// Δ₀ (SI), positive.
    pub at: f64,
    /// T (SI).
    pub target: f64,
    /// What it costs to put a unit right, if that is said: no unit costs more.
    pub repair: Option<f64>,
}

impl Loss {
    /// k: cost over SI unit².
    pub fn coefficient(&self) -> f64 {
        self.cost / (self.at * self.at)
    }

    /// The loss of a unit with this value (SI): at most the cost of a repair.
    pub fn of(&self, value: f64) -> f64 {
        let loss = self.coefficient() * (value - self.target) * (value - self.target);
        self.repair.map_or(loss, |repair| loss.min(repair))
    }

    /// The mean loss of a production with this mean and standard deviation (SI) in which no unit is put right.
    pub fn mean(&self, mean: f64, deviation: f64) -> f64 {
        self.coefficient() * self.square(mean, deviation)
    }

    fn square(&self, mean: f64, deviation: f64) -> f64 {
        deviation * deviation + (mean - self.target) * (mean - self.target)
    }

    /// The signal-to-noise ratio (dB): 10·lg(mean²/σ²), or, for a target of 0, where there is no signal, −10·lg of the mean
    /// square over that of Δ₀.
    pub fn signal_to_noise(&self, mean: f64, deviation: f64) -> f64 {
        let ratio = if self.target == 0.0 {
            self.at * self.at / self.square(mean, deviation)
        } else {
            mean * mean / (deviation * deviation)
        };
        10.0 * libm::log10(ratio)
    }

    /// The tolerance ± (SI) at which the maker's and the user's loss balance, Δ₀·√(A/A₀): beyond it a unit costs its user more
    /// than putting it right would cost the maker.
    pub fn tolerance(&self) -> Option<f64> {
        self.repair.map(|repair| self.at * libm::sqrt(repair / self.cost))
    }
}

#[cfg(test)]
mod tests {
    use crate::model::loss::Loss;

    /// A supply of 115 V ± 20 V that costs 100 to replace and 2 to put right: k = 0.25, ± 2.83 V.
    #[test]
    fn losses_of_a_power_supply() {
        let loss = Loss { cost: 100.0, at: 20.0, target: 115.0, repair: Some(2.0) };
        assert_eq!(loss.coefficient(), 0.25);
        assert!((loss.tolerance().unwrap() - 2.828_427_124_746).abs() < 1e-12);
        // 3² + 4² = 25 square volts.
        assert!((loss.mean(119.0, 3.0) - 6.25).abs() < 1e-12);
        assert!((loss.signal_to_noise(100.0, 1.0) - 40.0).abs() < 1e-12);
        let nothing = Loss { target: 0.0, ..loss };
        assert!((nothing.signal_to_noise(0.0, 2.0) - 20.0).abs() < 1e-12);
    }
}
