//! A distribution from its parameters.

use super::{
    family::Family, johnson_sb::JohnsonSb, johnson_su::JohnsonSu, kind::Kind, lognormal::Lognormal,
    mixture::TwoNormals, normal::Normal, weibull::Weibull,
};

impl Kind {
    /// The distribution of the family with `parameters` as [`Family::parameters`] gives them; missing ones are 0.
    pub fn with(self, parameters: &[f64]) -> Box<dyn Family> {
        let at = |i: usize| parameters.get(i).copied().unwrap_or_default();
        match self {
            Self::Normal => Box::new(Normal { mean: at(0), deviation: at(1) }),
            Self::Lognormal | Self::ShiftedLognormal => {
                Box::new(Lognormal { shift: at(0), mean: at(1), deviation: at(2) })
            }
            Self::Weibull | Self::ShiftedWeibull => Box::new(Weibull { shift: at(0), scale: at(1), shape: at(2) }),
            Self::JohnsonSu => Box::new(JohnsonSu { gamma: at(0), delta: at(1), xi: at(2), lambda: at(3) }),
            Self::JohnsonSb => Box::new(JohnsonSb { gamma: at(0), delta: at(1), xi: at(2), lambda: at(3) }),
            Self::TwoNormals => {
                let normal = |i: usize| Normal { mean: at(i), deviation: at(i + 1) };
                Box::new(TwoNormals { share: at(0), parts: [normal(1), normal(3)] })
            }
        }
    }
}
