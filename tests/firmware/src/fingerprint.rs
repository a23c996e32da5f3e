//! One number for many bits.

use slipfit_core::{integrator::Motion, pose::Pose, slide::Internal};

/// FNV-1a, 64 bits wide.
#[derive(Clone, Copy, Debug)]
pub struct Fingerprint(u64);

impl Fingerprint {
    /// Adds the bits of `value`, which must not be NaN: the bits of a NaN vary between machines.
    pub fn add(&mut self, value: f32) {
        debug_assert!(!value.is_nan());
        for byte in value.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// Adds every number of `motion`, the remembered friction forces too.
    pub fn add_motion<R: Remembered>(&mut self, motion: &Motion<f32, Pose<f32>, Internal<R>, 6>) {
        let pose = &motion.pose;
        let orientation = &pose.orientation;
        let numbers = pose.displacement_w.iter().chain([&orientation.w]).chain(orientation.v.iter());
        numbers.chain(motion.velocity.iter()).for_each(|number| self.add(*number));
        motion.internal.0.as_flattened().iter().flat_map(R::numbers).for_each(|number| self.add(*number));
    }
}

/// What a friction law remembers, as numbers.
pub trait Remembered {
    /// The numbers.
    fn numbers(&self) -> &[f32];
}

impl Remembered for () {
    fn numbers(&self) -> &[f32] {
        &[]
    }
}

impl Remembered for [f32; 2] {
    fn numbers(&self) -> &[f32] {
        self
    }
}

impl Default for Fingerprint {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl core::fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}
