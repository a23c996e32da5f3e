//! What the recipes share: the controller, which is yours to copy, and what stands for the use that a product makes of its
//! forces.
#![no_std]
#![forbid(unsafe_code)]

#[allow(missing_docs, reason = "`slipfit kernel` writes it")]
#[path = "../../scene.rs"]
pub mod scene;

use scene::{Predictor, Unit};
use semihosting::{println, process};
use slipfit_core::{kernel::StateOf, pose::Pose};

/// Processor clock of the emulated board (Hz).
pub const CLOCK: u32 = 25_000_000;

/// Tolerance level of the unit.
pub const LEVEL: f32 = 2.5;

/// Periods that a recipe runs for.
pub const PERIODS: u32 = 200;

/// The kernel of a unit, and how far its motion has come. Whoever steps it owns it: it is locked nowhere.
pub struct Controller {
    kernel: Predictor,
    state: StateOf<f32, Unit, 6>,
}

impl Controller {
    /// A unit of tolerance level `level`, at rest at time 0.
    ///
    /// # Panics
    /// If the level is out of bounds. This is the only place where a kernel can be wrong, so ask before the drive starts.
    pub fn new(level: f32) -> Self {
        let kernel = scene::predictor(level).expect("the level is in bounds");
        Self { state: kernel.at_rest(Pose::nominal()), kernel }
    }

    /// One period of [`STEP`](scene::STEP); gives the drive's force (N) at its end. Takes the same instructions every time.
    ///
    /// # Errors
    /// If the motion left the finite range and was held as it was: the force would be that of an earlier time.
    pub fn step(&mut self) -> Result<f32, Held> {
        let report = self.kernel.step(&mut self.state);
        if !report.residual.is_finite() {
            return Err(Held);
        }
        let speed = self.state.motion.velocity.z;
        Ok(self.kernel.mechanism().drive().force(self.kernel.time(self.state.steps), speed))
    }
}

/// The motion was held. In a product the drive stops here, or goes on without the prediction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Held;

/// A hash (FNV-1a) of the bits of forces, by which a test compares them with those of the PC.
pub struct Forces(u64);

impl Default for Forces {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Forces {
    /// Adds a force (N).
    pub fn add(&mut self, force: f32) {
        let bytes = force.to_bits().to_le_bytes();
        self.0 = bytes.iter().fold(self.0, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3));
    }

    /// Prints the hash to the debugger and ends the emulation.
    pub fn print_and_exit(self) -> ! {
        println!("forces {:016x}", self.0);
        process::exit(0)
    }
}
