//! Whether a run can be believed: what its steps said about themselves, held against the run's own scale, and how far a
//! better run parts from it.
//!
//! Of its steps two signs raise doubt. *Doubtful force*: from the ramp's start on, a step's momentum error e (N·s) shifts the
//! drive's force by K_p·e/m, here as a share of the greatest force. *Imbalance*: the residual that Newton's passes left, as a
//! share of the greatest momentum, moving with the drive at least, at any time; a release that is not solved can end in another
//! jam. Much of either is a warning by itself. The *difference* is how far the drive's force parts from a better run's: a
//! controller's from the desk's, the desk's from one at a tenth of its tolerance.

use serde::Serialize;
use slipfit_core::drive::Drive;

/// Share of the peak force that a single step may leave in doubt.
const FORCE_BOUND: f64 = 0.3;

/// Residual that a step may leave, as a share of the momentum.
const IMBALANCE_BOUND: f64 = 0.3;

/// Share of the peak force by which a better run may part.
const DIFFERENCE_BOUND: f64 = 5e-3;

/// The verdict of a run on its own numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Trust {
    /// Worst error estimate as a force, as a share of the peak force; from the ramp's start on.
    pub doubtful_force: f64,
    /// Worst residual as a share of the greatest momentum.
    pub imbalance: f64,
    /// How far the force parts from that of a better run, as a share of its peak, from the ramp's start on; `None` if there
    /// was none.
    pub difference: Option<f64>,
    /// A step (s) that should do, where a controller's is too large; `None` if it is not, and for the desk.
    pub better_step: Option<f64>,
    /// Whether a run with that step was made and found good enough.
    pub better_step_tried: bool,
}

impl Trust {
    /// The verdict on steps of `step` (s); `None` for the desk's, whose length is their own business.
    fn new(doubtful_force: f64, imbalance: f64, difference: Option<f64>, step: Option<f64>) -> Self {
        // The error of a step falls at least with its square; how a residual or a difference falls is not known.
        let finer = [
            (doubtful_force / FORCE_BOUND, 2.0),
            (imbalance / IMBALANCE_BOUND, 4.0),
            (difference.unwrap_or(0.0) / DIFFERENCE_BOUND, 2.0),
        ];
        let exceeded = finer.into_iter().filter(|(excess, _)| *excess > 1.0);
        let times = exceeded.map(|(excess, least)| libm::sqrt(excess).clamp(least, 100.0)).reduce(f64::max);
        let better_step = step.zip(times).map(|(step, times)| round_step(step / times));
        Self { doubtful_force, imbalance, difference, better_step, better_step_tried: false }
    }

    /// Whether nothing speaks against the run.
    pub fn is_sound(&self) -> bool {
        self.better_step.is_none() && self.difference.is_none_or(|difference| difference <= DIFFERENCE_BOUND)
    }

    /// The verdict after a better run, whose force parts by `difference`; `step` (s) is that of a controller.
    pub fn compared(self, difference: f64, step: Option<f64>) -> Self {
        Self::new(self.doubtful_force, self.imbalance, Some(difference), step)
    }

    /// The same, after runs with shorter steps that do not do: `step` (s) may.
    pub fn advised(self, step: Option<f64>) -> Self {
        Self { better_step: step, ..self }
    }

    /// The same, after runs with shorter steps: `step` (s) is one that does.
    pub fn tried(self, step: f64) -> Self {
        Self { better_step: Some(step), better_step_tried: true, ..self }
    }

    /// What a designer should know, if anything.
    pub fn warning(&self) -> Option<String> {
        if self.is_sound() {
            return None;
        }
        let percent = |share: f64| if share < 10.0 { format!("{:.1} %", share * 100.0) } else { "far".into() };
        let difference = self.difference.filter(|difference| *difference > DIFFERENCE_BOUND);
        let Some(step) = self.better_step.map(|step| step * 1e6) else {
            let difference = percent(difference.unwrap_or_default());
            return Some(format!(
                "the desk's error limit is too large for this scene: a tenth of it changes the drive force by {difference} \
                 of its peak; take a tenth of run.error"
            ));
        };
        let why = match difference {
            Some(difference) => format!("the drive force is off by {} of its peak", percent(difference)),
            None if self.imbalance > IMBALANCE_BOUND => {
                format!("forces and motion do not balance (off by {} of the momentum)", percent(self.imbalance))
            }
            None => format!("single steps shift the drive force by {} of its peak", percent(self.doubtful_force)),
        };
        let advice = if step < 1.0 {
            "no step above 1 µs will do: the contacts are too stiff or too deep, look at gaps, stiffness and friction"
                .into()
        } else if self.better_step_tried {
            format!("take --step {step}us")
        } else {
            format!("try --step {step}us")
        };
        Some(format!("the controller's step is too large for this scene: {why}; {advice}"))
    }
}

/// Watches the steps of a run.
#[derive(Clone, Copy, Debug)]
pub struct Watch {
    step: f64,
    ramp_start: f64,
    /// K_p/m (1/s).
    force_per_momentum: f64,
    residual: f64,
    late_error: f64,
    momentum: f64,
    force: f64,
}

impl Watch {
    /// For the steps of `step` (s) of a body of `mass` (kg) that `drive` moves.
    pub fn new(step: f64, mass: f64, drive: &Drive<f64>) -> Self {
        Self {
            step,
            ramp_start: drive.ramp_start,
            force_per_momentum: drive.gain / mass,
            residual: 0.0,
            late_error: 0.0,
            momentum: mass * drive.speed.abs(),
            force: 0.0,
        }
    }

    /// Takes note of a step from time `t` (s): what it reports of itself, the momentum (N·s) that it led to, and the
    /// drive force (N) that it started with.
    pub fn observe(&mut self, t: f64, [residual, error]: [f64; 2], momentum: f64, force: f64) {
        self.residual = self.residual.max(residual);
        if t >= self.ramp_start {
            self.late_error = self.late_error.max(error);
        }
        self.momentum = self.momentum.max(momentum);
        self.force = self.force.max(force.abs());
    }

    /// The verdict.
    pub fn trust(&self) -> Trust {
        let share = |part: f64, whole: f64| if part > 0.0 { part / whole.max(f64::MIN_POSITIVE) } else { 0.0 };
        let doubtful_force = share(self.late_error * self.force_per_momentum, self.force);
        Trust::new(doubtful_force, share(self.residual, self.momentum), None, Some(self.step))
    }
}

/// The greatest of 1, 2.5 and 5 times a power of ten seconds that is not above `step` (s), 10 ns at least.
fn round_step(step: f64) -> f64 {
    let nanoseconds = (step * 1e9 * (1.0 + 1e-9)).min(1e9);
    let mut round = 10.0;
    for decade in [1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8] {
        for multiple in [1.0, 2.5, 5.0] {
            if multiple * decade <= nanoseconds {
                round = multiple * decade;
            }
        }
    }
    round / 1e9
}

#[cfg(test)]
mod tests {
    use slipfit_core::{Vector3, drive::Drive};

    use super::{Trust, Watch, round_step};

    #[test]
    fn steps_are_round() {
        assert_eq!(round_step(50e-6 / 2.0), 25e-6);
        assert_eq!(round_step(1e-3 / 4.0), 250e-6);
        assert_eq!(round_step(0.0), 1e-8);
    }

    fn drive() -> Drive<f64> {
        Drive { gain: 40.0, ramp_start: 0.05, ramp_end: 1.0, speed: 0.01, point_b: Vector3::zeros() }
    }

    #[test]
    fn great_doubts_name_a_cause_and_a_step() {
        let mut watch = Watch::new(50e-6, 0.08, &drive());
        watch.observe(0.01, [1e-8, 1e-3], 1e-3, 0.2);
        watch.observe(0.06, [1e-8, 1e-5], 1e-3, 0.2);
        assert!(watch.trust().is_sound() && watch.trust().warning().is_none());
        watch.observe(0.06, [1e-3, 0.0], 1e-3, 0.2);
        assert!(watch.trust().warning().unwrap().contains("do not balance"));
        watch.observe(0.06, [0.0, 1e-3], 10.0, 0.2);
        let warning = watch.trust().warning().unwrap();
        assert!(warning.contains("250.0 % of its peak") && warning.contains("--step 10us"), "{warning}");
    }

    #[test]
    fn a_better_run_has_its_say() {
        let trust = Watch::new(50e-6, 0.08, &drive()).trust();
        assert!(trust.compared(0.004, Some(50e-6)).is_sound());
        let warning = trust.compared(0.1, Some(50e-6)).warning().unwrap();
        assert!(warning.contains("off by 10.0 % of its peak") && warning.contains("--step 10us"), "{warning}");
        assert_eq!(trust.compared(f64::MAX, Some(50e-6)).better_step, Some(5e-7));
        let of_desk = Trust::default().compared(0.01, None);
        assert!(!of_desk.is_sound() && of_desk.warning().unwrap().contains("run.error"));
        assert!(Trust::default().compared(0.001, None).is_sound());
    }
}
