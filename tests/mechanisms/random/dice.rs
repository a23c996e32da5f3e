//! Random numbers for scenes.

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::scene::{Laws, Loss, Vec3};

/// The random numbers of one scene.
pub struct Dice(Xoshiro256PlusPlus);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    /// Uniform in [0, 1).
    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn within(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.unit()
    }

    /// Its logarithm is uniform.
    pub fn log(&mut self, least: f64, most: f64) -> f64 {
        libm::exp(self.within(libm::log(least), libm::log(most)))
    }

    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    pub fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count - 1)
    }

    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    pub fn sign(&mut self) -> f64 {
        self.pick(&[-1.0, 1.0])
    }

    /// A vector with components within ± `most`, in the plane z = 0 or in space.
    pub fn vector(&mut self, most: f64, planar: bool) -> Vec3 {
        let z = if planar { 0.0 } else { self.within(-most, most) };
        Vec3::new(self.within(-most, most), self.within(-most, most), z)
    }

    /// A direction, sometimes along an axis.
    pub fn direction(&mut self, planar: bool) -> Vec3 {
        if self.chance(0.3) {
            return self.axis(planar);
        }
        loop {
            let vector = self.vector(1.0, planar);
            if (0.1..1.0).contains(&vector.norm()) {
                return vector.normalize();
            }
        }
    }

    /// A direction along an axis of the frame.
    pub fn axis(&mut self, planar: bool) -> Vec3 {
        let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
        let axis = axes[self.below(if planar { 2 } else { 3 })];
        axis * self.sign()
    }

    /// A gap (m): compressed, tight or wide.
    pub fn gap(&mut self) -> f64 {
        match self.below(6) {
            0 => -self.log(5e-7, 1.5e-5),
            1 | 2 => self.log(1e-6, 1e-4),
            _ => self.log(1e-4, 1e-2),
        }
    }

    /// A gap (m) of a joint with clearance.
    pub fn clearance(&mut self) -> f64 {
        self.log(1e-5, 4e-4)
    }

    /// Laws of a contact that carries 5 to 500 N at 20 µm.
    pub fn laws(&mut self) -> Laws {
        let exponent = self.pick(&[1.0, 1.5, 1.5, 2.0, 3.0]);
        let stiffness = self.log(5.0, 500.0) / libm::pow(2e-5, exponent);
        let loss = match self.below(8) {
            0 => Loss::HuntCrossley { restitution: self.within(0.3, 0.95), speed: self.log(0.1, 1.0) },
            1 => Loss::LankaraniNikravesh { restitution: self.within(0.3, 0.95), speed: self.log(0.1, 1.0) },
            2 => Loss::Impact { damping: 0.0, depth: 1e-5 },
            _ => Loss::Impact { damping: self.log(1.0, 200.0), depth: self.log(1e-6, 2e-5) },
        };
        let friction = self.chance(0.75).then(|| [self.within(0.02, 0.5), self.log(5e-4, 5e-3)]);
        Laws { stiffness, exponent, loss, friction }
    }
}
