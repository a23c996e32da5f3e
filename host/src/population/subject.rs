//! What a population is of: a slide on pins, or a mechanism by one of its drives.

use super::{
    production::Drawn,
    stroke::Stroke,
    unit::{Decisive, Fault, Unit},
};
use crate::dynamics::{driven::Driven, simulate::SimulateError};

/// A level of eq. 9, and the unit there.
pub type AtLevel = (f64, Unit);

/// What the units of a production are units of.
pub trait Subject: Driven {
    /// Simulates the units that were `drawn`; one that cannot be has a [`Fault`].
    ///
    /// # Errors
    /// [`SimulateError::Interrupted`].
    fn units(&self, drawn: &Drawn) -> Result<Vec<Unit>, SimulateError>;

    /// The figures that decide whether units do their job, of those `drawn` units that are `asked` for, or why there are none.
    ///
    /// # Errors
    /// [`SimulateError::Interrupted`].
    fn decisive(&self, drawn: &Drawn, asked: &[usize]) -> Result<Vec<Result<Decisive, Fault>>, SimulateError>;

    /// One stroke of unit `i` of those `drawn`, sampled every `every` (s), with a friction that differs from the unit's own by the
    /// share `friction`.
    ///
    /// # Errors
    /// See [`SimulateError`].
    fn stroke(&self, drawn: &Drawn, i: usize, friction: f64, every: f64) -> Result<Stroke, SimulateError>;

    /// Why unit `i` of those `drawn` has no run; `None` if it has one.
    fn trouble(&self, drawn: &Drawn, i: usize) -> Option<String>;

    /// The gaps (m) at the tolerance levels `n`, one for each; the last holds for all that follow.
    fn gaps_at(&self, n: &[f64]) -> Vec<f64>;

    /// The tolerance levels at which the `gaps` (m) are; `None` for one that does not vary.
    fn levels_of(&self, gaps: &[f64]) -> Vec<Option<f64>>;

    /// Whether a unit with these `gaps` (m) can be assembled.
    fn fits(&self, gaps: &[f64]) -> bool;

    /// How many random combinations of gaps take a few seconds.
    fn combinations(&self) -> u64;

    /// How many parameters vary beside the gaps.
    fn parameters(&self) -> usize;

    /// Whether any gap varies.
    fn has_levels(&self) -> bool {
        self.levels_of(&self.gaps_at(&[0.0])).iter().any(Option::is_some)
    }

    /// How much tighter than the mean unit one with these `gaps` (m) is: the mean over its gaps, each in its standard
    /// deviations, signed like the level n of eq. 9.
    fn tightness(&self, gaps: &[f64]) -> f64 {
        let levels: Vec<f64> = self.levels_of(gaps).into_iter().flatten().collect();
        levels.iter().sum::<f64>() / levels.len().max(1) as f64
    }

    /// Units with the given `gaps` (m) and the scene's own parameters.
    fn as_drawn(&self, gaps: Vec<Vec<f64>>) -> Drawn {
        let deviations = vec![vec![0.0; self.parameters()]; gaps.len()];
        Drawn { numbers: 0..gaps.len() as u64, gaps, deviations, variables: Vec::new() }
    }

    /// Those of the levels `n` of eq. 9 at which a unit can be assembled, and what it does there, all parameters as the scene
    /// states them.
    ///
    /// # Errors
    /// As [`Subject::units`].
    fn at_levels(&self, n: &[f64]) -> Result<Vec<AtLevel>, SimulateError> {
        let (n, gaps): (Vec<_>, Vec<_>) =
            n.iter().map(|n| (*n, self.gaps_at(&[*n]))).filter(|(_, gaps)| self.fits(gaps)).unzip();
        Ok(n.into_iter().zip(self.units(&self.as_drawn(gaps))?).collect())
    }
}
