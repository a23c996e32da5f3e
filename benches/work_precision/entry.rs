//! Solvers at their settings.

use std::time::Duration;

/// One solver at one setting: work that is done, or not if the solver gives up.
pub struct Entry {
    /// Its name.
    pub solver: &'static str,
    /// At what.
    pub setting: String,
    /// What it does.
    pub work: Box<dyn Fn() -> Option<Achieved>>,
}

/// The drive force (N) at every millisecond from 0 on, and the time that the integration alone took.
pub struct Achieved {
    /// Force.
    pub force: Vec<f64>,
    /// Time.
    pub time: Duration,
}

/// Tolerances of the peers.
#[derive(Clone, Copy)]
pub struct Tolerances {
    /// Relative.
    pub relative: f64,
    /// Absolute, of velocities (m/s, rad/s).
    pub absolute: f64,
    /// Absolute tolerances of poses over those of velocities (s).
    pub proportion: f64,
}

impl Tolerances {
    /// Those tried.
    pub fn all() -> impl Iterator<Item = Self> {
        let relative = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6];
        let absolute = [1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 1e-8];
        let pairs = relative.into_iter().flat_map(move |r| absolute.map(|a| (r, a)));
        pairs.flat_map(|(relative, absolute)| {
            [1e-2, 1e-3, 1e-4].map(|proportion| Self { relative, absolute, proportion })
        })
    }
}

impl std::fmt::Display for Tolerances {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.0e} {:.0e} {:.0e}", self.relative, self.absolute, self.proportion)
    }
}
