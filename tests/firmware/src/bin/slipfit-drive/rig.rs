//! The drive's unit and its force sensor, simulated: what stands in for hardware.

use slipfit_core::{
    ParameterError,
    kernel::{Kernel, StateOf},
    law::Exact,
    monitor::Sample,
    pose::Pose,
    sampling::{
        normal::score,
        stream::{Rng, Xoshiro256PlusPlus, unit_stream},
    },
};

use crate::{
    control::{Control, Flashed, Motions, Record, unit},
    scene::{Predictor, STEP, Unit},
};

/// Steps in which the unit itself moves through a period, finer than the predictor's.
const PLANT_STEPS: u32 = 4;

/// A unit on its rig.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rig {
    /// Its tolerance level.
    pub level: f32,
    /// Its friction coefficient over the scene's.
    pub friction: f32,
    /// The tolerance level it is taken for.
    pub taken_for: f32,
    /// Standard deviation of the noise of its force sensor (N).
    pub noise: f32,
    /// Seed of the noise.
    pub seed: u64,
}

/// A unit with its sensor, and its controller.
pub struct OnRig {
    kernel: Predictor,
    state: StateOf<f32, Unit, 6>,
    random: Xoshiro256PlusPlus,
    noise: f32,
    /// What watches the unit.
    pub control: Control,
}

/// The kernel of a unit whose friction is `factor` times the scene's.
fn kernel(level: f32, factor: f32) -> Result<Predictor, ParameterError<f32>> {
    Kernel::new(unit(level, |coefficient| Exact::new(coefficient * factor))?, STEP / PLANT_STEPS as f32)
}

impl OnRig {
    /// At rest at the motion's start.
    ///
    /// # Panics
    /// If the rig is out of bounds or the table is not one in f32 over few levels and time.
    pub fn new(rig: &Rig, flashed: Flashed, motions: &'static mut Motions) -> Self {
        let kernel = kernel(rig.level, rig.friction).expect("the unit is in bounds");
        let state = kernel.at_rest(Pose::nominal());
        let control = Control::new(rig.taken_for, rig.noise, flashed, motions);
        Self { kernel, state, random: unit_stream(rig.seed, 0), noise: rig.noise, control }
    }

    /// One period. `clock` counts what the control does, not the unit.
    ///
    /// # Panics
    /// If the unit's motion leaves the finite range.
    pub fn tick(&mut self, clock: impl Fn() -> u32) -> Record {
        let sample = self.measured();
        self.control.tick(&sample, clock)
    }

    /// What the drive measures at the end of the next period.
    ///
    /// # Panics
    /// If the unit's motion leaves the finite range.
    fn measured(&mut self) -> Sample {
        for _ in 0..PLANT_STEPS {
            let report = self.kernel.step(&mut self.state);
            assert!(report.residual.is_finite(), "the unit can be moved");
        }
        let (drive, time, speed) = (self.kernel.mechanism().drive(), self.control.time(), self.state.motion.velocity.z);
        let force = drive.force(time, speed) + self.noise * score::<f32>(self.random.next_u64());
        Sample { time, force, speed, command: drive.command(time) }
    }
}
