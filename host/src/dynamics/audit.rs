//! Where the energy of a run goes: work in = gain of kinetic, gravity and elastic energy + damping + friction + defect.
//!
//! The energies are states and exact; the powers are integrated over the steps by the Adams–Moulton rule through three
//! points, third order, so that on smooth motion the defect is the scheme's own up to that order. What the laws do not
//! account for is the defect: positive where the scheme lost energy, negative where it made some. A stick stores
//! nothing: neither friction law has a spring.

use serde::Serialize;
use slipfit_core::slide::{Energy, Power};

/// The energy account of a run (J).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Audit {
    /// Work of the drive on the slide.
    pub work: f64,
    /// Gain of kinetic energy.
    pub kinetic: f64,
    /// Gain of energy of height.
    pub gravity: f64,
    /// Gain of energy in compressed contacts; negative where compression was released.
    pub elastic: f64,
    /// Lost in contacts, to dampers and at parting.
    pub damping: f64,
    /// Lost to friction.
    pub friction: f64,
    /// What is missing at the end.
    pub defect: f64,
    /// The greatest amount of the defect at any time.
    pub worst_defect: f64,
    /// The greatest amount of any other entry at any time, the scale for defects.
    pub exchanged: f64,
    /// The greatest rise of the slide's energy, kinetic, gravity and elastic, above an earlier value. Without a drive it
    /// cannot rise.
    pub rise: f64,
    /// The greatest elastic energy at any time over all that there was to fill it: the elastic energy at the start, the
    /// work and the fall. Above 1 a contact is deeper than energy allows.
    pub filling: f64,
}

impl Audit {
    /// The worst defect as a share of the energy exchanged; 0 where nothing moved.
    pub fn relative_defect(&self) -> f64 {
        share(self.worst_defect, self.exchanged)
    }

    /// The greatest rise of the slide's energy as a share of the energy exchanged.
    pub fn relative_rise(&self) -> f64 {
        share(self.rise, self.exchanged)
    }
}

fn share(part: f64, whole: f64) -> f64 {
    if part > 0.0 { part / whole.max(f64::MIN_POSITIVE) } else { 0.0 }
}

/// Keeps the account of a run, step by step.
#[derive(Clone, Debug, Default)]
pub struct Auditor {
    step: f64,
    start: Option<Energy<f64>>,
    /// The powers of the last two instants, the latest first.
    before: [Option<[f64; 3]>; 2],
    audit: Audit,
    least_total: f64,
    most_elastic: f64,
    most_work: f64,
    deepest_fall: f64,
}

impl Auditor {
    /// For a run in steps of `step` (s).
    pub fn new(step: f64) -> Self {
        Self { step, ..Self::default() }
    }

    /// Takes note of the energy and the powers at the next instant, from time 0 on.
    pub fn observe(&mut self, energy: Energy<f64>, power: Power<f64>) {
        let now = [power.drive, power.damping, power.friction];
        let start = *self.start.get_or_insert(energy);
        let gains = [self.gain(now, 0), self.gain(now, 1), self.gain(now, 2)];
        self.before = [Some(now), self.before[0]];

        let audit = &mut self.audit;
        for (total, gain) in [&mut audit.work, &mut audit.damping, &mut audit.friction].into_iter().zip(gains) {
            *total += gain;
        }
        audit.kinetic = energy.kinetic - start.kinetic;
        audit.gravity = energy.gravity - start.gravity;
        audit.elastic = energy.elastic - start.elastic;
        let total = audit.kinetic + audit.gravity + audit.elastic;
        audit.defect = audit.work - total - audit.damping - audit.friction;
        audit.worst_defect = audit.worst_defect.max(audit.defect.abs());
        let entries = [audit.work, audit.kinetic, audit.gravity, audit.elastic, audit.damping, audit.friction];
        audit.exchanged = entries.iter().fold(audit.exchanged, |most, entry| most.max(entry.abs()));
        audit.rise = audit.rise.max(total - self.least_total);
        self.least_total = self.least_total.min(total);

        self.most_elastic = self.most_elastic.max(energy.elastic);
        self.most_work = self.most_work.max(audit.work);
        self.deepest_fall = self.deepest_fall.max(-audit.gravity);
        audit.filling = share(self.most_elastic, start.elastic + self.most_work + self.deepest_fall);
    }

    /// The account so far.
    pub fn audit(&self) -> Audit {
        self.audit
    }

    /// The integral of power `i` over the step that ends with the powers `now`.
    fn gain(&self, now: [f64; 3], i: usize) -> f64 {
        self.step
            * match self.before {
                [None, _] => 0.0,
                [Some(last), None] => (now[i] + last[i]) / 2.0,
                [Some(last), Some(earlier)] => (5.0 * now[i] + 8.0 * last[i] - earlier[i]) / 12.0,
            }
    }
}
