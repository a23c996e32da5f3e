//! What requirements come to, whatever they come from: figures of the tolerances that must not exceed 1.

use super::{AllocateError, program::Power};

/// How far a figure may be above 1.
pub const MET: f64 = 1e-6;

/// How the weights of tolerances are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slopes {
    /// By central differences, a tolerance at a time, over this share of it either way: for figures that are smooth.
    Differences(f64),
    /// By a designed experiment that moves all tolerances at once by this factor: for figures that are counted, in which a
    /// single tolerance's part is lost between those of chance.
    Design(f64),
}

/// How finely figures tell tolerances apart, and how far what is found around some tolerances can be followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Precision {
    /// How slopes are found.
    pub slopes: Slopes,
    /// By which factor a program may leave the tolerances around which its slopes were found.
    pub reach: f64,
    /// How far below 1 a figure with a price may be.
    pub slack: f64,
    /// A change of the cost (share of it) that no longer counts.
    pub still: f64,
    /// The most programs.
    pub programs: usize,
    /// Whether tolerances are traded against each other where programs lead to no end. If not, those of a program are widened alone.
    pub trades: bool,
}

impl Precision {
    /// Figures that are smooth functions of tolerances.
    pub const COMPUTED: Self = Self {
        slopes: Slopes::Differences(0.02),
        reach: f64::INFINITY,
        slack: MET,
        still: 1e-7,
        programs: 16,
        trades: true,
    };
    /// Shares of some thousand simulated units, which move by one unit at a time, each taking long.
    pub const COUNTED: Self =
        Self { slopes: Slopes::Design(1.3), reach: 1.6, slack: 0.03, still: 5e-3, programs: 8, trades: false };
}

/// What requirements come to: figures that must not exceed 1.
pub trait Figures: Sync {
    /// How each figure grows with tolerances.
    fn powers(&self) -> Vec<Power>;

    /// Whether slopes describe what they come from.
    fn smooth(&self) -> bool {
        true
    }

    /// How finely they tell tolerances apart.
    fn precision(&self) -> Precision {
        Precision::COMPUTED
    }

    /// What each figure may rise by where its requirement is loosened a little.
    fn reliefs(&self) -> Vec<f64> {
        vec![0.01; self.powers().len()]
    }

    /// The figures at `tolerances` (SI).
    ///
    /// # Errors
    /// [`AllocateError`], if there are none.
    fn values(&self, tolerances: &[f64]) -> Result<Vec<f64>, AllocateError>;
}
