//! Whether a run can be believed: what its steps said about themselves, held against the run's own scale.
//!
//! Two signs tell that a step is too large. *Doubtful force*: from the ramp's start on, a step's momentum error e (N·s)
//! shifts the drive's force by K_p·e/m, here as a share of the greatest force. *Imbalance*: the residual that Newton's
//! passes left, as a share of the greatest momentum, at any time; a release that is not solved can end in another jam.
//!
//! The bounds were set on one thousand random scenes of the stability map and counted on another (seed 1), in which
//! one run in four is off by more than 5 % from t = 50 ms on against a quarter of the step. Measured by
//! `slipfit precision --stability`: of 238 wrong runs 19 do not warn (8 %); of 717 right ones 341 warn (48 %); 45 stop with
//! an error.

use serde::Serialize;

/// The greatest share of the peak force that a single step may leave in doubt.
pub const FORCE_BOUND: f64 = 6e-3;

/// The greatest residual as a share of the greatest momentum.
pub const IMBALANCE_BOUND: f64 = 0.3;

/// The verdict of a run on its own numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Trust {
    /// Worst error estimate as a force, as a share of the peak force; from the ramp's start on.
    pub doubtful_force: f64,
    /// Worst residual as a share of the greatest momentum.
    pub imbalance: f64,
    /// A step (s) that should do, where this one is too large; `None` if the run is sound.
    pub better_step: Option<f64>,
}

impl Trust {
    /// Whether nothing speaks against the run.
    pub fn is_sound(&self) -> bool {
        self.better_step.is_none()
    }

    /// What a designer should know, if anything.
    pub fn warning(&self) -> Option<String> {
        let step = self.better_step? * 1e6;
        let percent = |share: f64| if share < 10.0 { format!("{:.1} %", share * 100.0) } else { "far".into() };
        let why = if self.imbalance > IMBALANCE_BOUND {
            format!("forces and motion do not balance (off by {} of the momentum)", percent(self.imbalance))
        } else {
            format!("single steps shift the drive force by {} of its peak", percent(self.doubtful_force))
        };
        let advice = if step < 1.0 {
            "no step above 1 µs will do: the contacts are too stiff or too deep, look at gaps, stiffness and friction"
                .into()
        } else {
            format!("take --step {step}us")
        };
        Some(format!("the step is too large for this scene: {why}; {advice}"))
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
    /// For steps of `step` (s) of a body of `mass` (kg) under a drive of `gain` (N·s/m) that starts at `ramp_start` (s).
    pub fn new(step: f64, mass: f64, gain: f64, ramp_start: f64) -> Self {
        let force_per_momentum = gain / mass;
        Self { step, ramp_start, force_per_momentum, residual: 0.0, late_error: 0.0, momentum: 0.0, force: 0.0 }
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
        let imbalance = share(self.residual, self.momentum);
        // The error of a step falls at least with its square; how a residual falls is not known.
        let by_force = libm::sqrt(doubtful_force / FORCE_BOUND).max(2.0);
        let finer = match (doubtful_force > FORCE_BOUND, imbalance > IMBALANCE_BOUND) {
            (false, false) => None,
            (true, false) => Some(by_force),
            (false, true) => Some(4.0),
            (true, true) => Some(by_force.max(4.0)),
        };
        Trust { doubtful_force, imbalance, better_step: finer.map(|times| round_step(self.step / times)) }
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
    use super::{Watch, round_step};

    #[test]
    fn steps_are_round() {
        assert_eq!(round_step(50e-6 / 2.0), 25e-6);
        assert_eq!(round_step(1e-3 / 4.0), 250e-6);
        assert_eq!(round_step(0.0), 1e-8);
    }

    #[test]
    fn doubts_name_a_cause_and_a_step() {
        let mut watch = Watch::new(50e-6, 0.08, 40.0, 0.05);
        watch.observe(0.01, [1e-6, 1e-3], 1e-3, 0.2);
        assert!(watch.trust().is_sound());
        watch.observe(0.06, [1e-6, 1e-5], 1e-3, 0.2);
        let warning = watch.trust().warning().unwrap();
        assert!(warning.contains("2.5 % of its peak") && warning.contains("--step 10us"), "{warning}");
        watch.observe(0.06, [1e-3, 0.0], 1e-3, 0.2);
        assert!(watch.trust().warning().unwrap().contains("do not balance"));
    }
}
