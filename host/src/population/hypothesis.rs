//! Are the tightest and the loosest combinations the most probable to malfunction?
//!
//! All gaps moved by the same n, as eq. 9 moves them, against as many random combinations as far from the mean unit: random
//! directions in the space of all gaps, each gap measured by its standard deviation, of the same root mean square.

use serde::Serialize;
use slipfit_core::{
    sampling::stream::{Rng, derived, uniform, unit_stream},
    slide::ABSENT,
};
use slipfit_system::parallel;
use slipfit_tolerance::numeric::normal;

use super::{
    statistics::{Share, malfunctions},
    subject::Subject,
};
use crate::dynamics::{outcome::Verdict, simulate::SimulateError};

/// Distances from the mean unit, root mean square in standard deviations of the gaps.
pub const DISTANCES: [f64; 7] = [0.25, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0];

/// What seeds of directions are derived with.
const STREAM: u64 = 5 << 32;

/// What units do at one distance from the mean unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AtDistance {
    /// Root mean square over the gaps (σ).
    pub distance: f64,
    /// All gaps tighter by that: the unit of level n.
    pub tight: Verdict,
    /// Whether that one malfunctions.
    pub tight_malfunctions: bool,
    /// All gaps looser by that: the unit of level −n.
    pub loose: Verdict,
    /// Whether that one malfunctions.
    pub loose_malfunctions: bool,
    /// Random combinations that malfunction.
    pub random: Share,
}

/// The same over all distances.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hypothesis {
    /// By distance, ascending.
    pub distances: Vec<AtDistance>,
}

impl Hypothesis {
    /// Tries `directions` random combinations at each distance, against a motor's force `limit` (N), on all threads of the
    /// current pool.
    ///
    /// # Errors
    /// See [`SimulateError`].
    pub fn test(subject: &dyn Subject, directions: u64, seed: u64, limit: Option<f64>) -> Result<Self, SimulateError> {
        let at = |distance: f64| {
            let sides = [-distance, distance].map(|n| subject.gaps_at(&[n]));
            let sides = subject.units(&subject.as_drawn(sides.into()))?;
            let [loose, tight] = [0, 1].map(|i| (sides[i].outcome.verdict, malfunctions(&sides[i], limit)));
            let gaps = (0..directions).map(|i| combination(subject, distance, seed, i)).collect();
            let random = subject.units(&subject.as_drawn(gaps))?;
            let failed = random.iter().filter(|unit| malfunctions(unit, limit)).count() as u64;
            Ok::<_, SimulateError>(AtDistance {
                distance,
                tight: tight.0,
                tight_malfunctions: tight.1,
                loose: loose.0,
                loose_malfunctions: loose.1,
                random: Share::new(failed, directions.max(1)),
            })
        };
        let distances = parallel::try_map(&DISTANCES, |distance| at(*distance))?;
        Ok(Self { distances })
    }

    /// The answer in words.
    pub fn verdict(&self) -> String {
        let side = |failed: fn(&&AtDistance) -> bool| self.distances.iter().filter(failed).count();
        let (tight, loose) = (side(|at| at.tight_malfunctions), side(|at| at.loose_malfunctions));
        let count = self.distances.len();
        let random = self.distances.iter().map(|at| at.random.share).sum::<f64>() / count as f64;
        let [nearest, farthest] = [0, count - 1].map(|i| self.distances[i].distance);
        format!(
            "{count} levels from {nearest} to {farthest} σ: with all gaps looser {loose} of them malfunction, with all tighter \
             {tight}; of random combinations as far from the mean {:.0} %",
            random * 100.0
        )
    }
}

/// Gaps (m) in a random direction from the means, at a root mean square of `distance` standard deviations.
fn combination(subject: &dyn Subject, distance: f64, seed: u64, number: u64) -> Vec<f64> {
    let mut stream = unit_stream(derived(seed, STREAM), number);
    let mut n = |gap: &f64| {
        let share = uniform(stream.next_u64());
        if *gap == ABSENT { None } else { Some(normal::quantile(share)) }
    };
    let n: Vec<Option<f64>> = subject.gaps_at(&[0.0]).iter().map(&mut n).collect();
    let present = n.iter().flatten();
    let square = present.clone().map(|n| n * n).sum::<f64>() / present.count().max(1) as f64;
    let scale = distance / libm::sqrt(square.max(f64::MIN_POSITIVE));
    subject.gaps_at(&n.iter().map(|n| n.unwrap_or_default() * scale).collect::<Vec<_>>())
}
