//! Sampling controllers in a run.

use slipfit_desk::drive::Held;

use super::{Mechanism, NamedDrive, Sampling};
use crate::dynamics::{command::Travel, observer::Instant};

/// What takes the samples of a drive's controller in one run.
pub struct Sampler<'a> {
    named: &'a NamedDrive,
    sampling: &'a Sampling,
    travel: Travel,
    /// Time (s) and position (m, rad) of the last sample.
    last: Option<[f64; 2]>,
    /// Samples that were due so far.
    due: u64,
    /// Each sample: when (s) it was taken, and what is held from then on (N, N·m).
    samples: Vec<[f64; 2]>,
}

/// Rounding of times, as a share of the period, that does not delay a sample.
const EARLY: f64 = 1e-9;

impl<'a> Sampler<'a> {
    /// That of a drive, if it samples.
    pub fn of(named: &'a NamedDrive) -> Option<Self> {
        let sampling = named.sampling.as_ref()?;
        let travel = Travel::new(&named.drive, named.command.as_ref(), sampling.positions.as_deref());
        Some(Self { named, sampling, travel, last: None, due: 0, samples: Vec::new() })
    }

    /// Whether it samples at time `t` (s): at the first end of a step that is not before the next sample.
    pub fn is_due(&self, t: f64) -> bool {
        t >= (self.due as f64 - EARLY) * self.sampling.period
    }

    /// Samples the motion `at` an instant, and holds what follows from it.
    pub fn sample(&mut self, at: Instant) {
        let Sampling { position_gain, differentiates, ref held, .. } = *self.sampling;
        let speed = match self.last {
            Some([t, z]) if differentiates && at.t > t => (at.z - z) / (at.t - t),
            _ => at.vz,
        };
        let command = match position_gain {
            Some(gain) => gain * (self.travel.at(at.t) - at.z),
            None => self.named.commanded(at.t),
        };
        let effort = self.named.limited(self.named.drive.gain * (command - speed));
        held.set(effort);
        self.last = Some([at.t, at.z]);
        self.samples.push([at.t, effort]);
        // A step that is longer than the period passes samples over.
        while self.is_due(at.t) {
            self.due += 1;
        }
    }

    /// Its samples: when (s) each was taken, and what is held from then on (N, N·m).
    pub fn into_samples(self) -> Vec<[f64; 2]> {
        self.samples
    }
}

impl Mechanism {
    /// The same mechanism whose sampling controllers hold nothing that another run holds; `None` if it has no such controllers.
    pub fn with_own_controllers(&self) -> Option<Self> {
        self.drives.iter().any(|named| named.sampling.is_some()).then(|| {
            let mut own = self.clone();
            own.drives.iter_mut().filter_map(|named| named.sampling.as_mut()).for_each(|of| of.held = Held::default());
            own
        })
    }
}
