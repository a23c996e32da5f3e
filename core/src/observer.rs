//! Correction of a kernel by a measured speed: the motion of the real unit, with an error of its force that the model does not have.
//!
//! A unit differs from its model: friction, load, temperature. The observer knows how noisy the sensor is and how fast that difference
//! changes, and corrects the kernel's speed and an estimate of the missing force after every step, in constant work. The drive's force then
//! follows from a speed that is less noisy than the measured one and less wrong than the model's.
//!
//! The missing force acts along the drive. So it is applied as a change of the command: gain times command is a force.
//!
//! Errors of speed and of force are tracked as position and speed are by an alpha-beta filter, whose gains for white noise have a closed form:
//! Kalata, "The tracking index: a generalized parameter for alpha-beta and alpha-beta-gamma target trackers", IEEE Transactions on Aerospace
//! and Electronic Systems 20 (1984). The drive and the contacts damp what the filter leaves undamped, so that corrections fade faster still.

use crate::{ParameterError, Scalar, error::bounded};

/// What is known about the sensor and the unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise<S> {
    /// Standard deviation of a measured speed (m/s, rad/s), white.
    pub speed: S,
    /// Standard deviation of what the missing force changes by in a period (N, N·m).
    pub force: S,
}

/// The correction of one drive. Its calls cannot fail and take the same instructions whatever is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observer<S> {
    /// Gain of the drive (N·s/m, N·m·s/rad).
    gain: S,
    /// What of a difference of speed corrects the speed, and what the missing force (N·s/m, N·m·s/rad).
    corrections: [S; 2],
    /// Bound of the missing force (N, N·m).
    most: S,
    missing: S,
}

impl<S: Scalar + PartialOrd> Observer<S> {
    /// An observer of a drive of some `gain` (N·s/m, N·m·s/rad) that moves `mass` (kg, kg·m²) in steps of `period` (s). The missing force
    /// stays within `most` (N, N·m) either way.
    ///
    /// # Errors
    /// If the gain is outside 1e-9…1e9, the mass outside 1e-9…1e9, the period outside 1e-9…1 s, the noise of speed outside
    /// 1e-9…1e3, that of force outside 0…1e9, the bound outside 1e-9…1e9, or one of them is not finite.
    pub fn new(gain: S, mass: S, period: S, noise: Noise<S>, most: S) -> Result<Self, ParameterError<S>> {
        let gain = bounded("observer.gain", gain, [1e-9, 1e9])?;
        let mass = bounded("observer.mass", mass, [1e-9, 1e9])?;
        let period = bounded("observer.period", period, [1e-9, 1.0])?;
        let speed = bounded("observer.noise.speed", noise.speed, [1e-9, 1e3])?;
        let force = bounded("observer.noise.force", noise.force, [0.0, 1e9])?;
        let most = bounded("observer.most", most, [1e-9, 1e9])?;
        let [alpha, beta] = alpha_beta(period.to_f64() * force.to_f64() / (mass.to_f64() * speed.to_f64()));
        let corrections = [S::from_f64(alpha), S::from_f64(beta * mass.to_f64() / period.to_f64())];
        Ok(Self { gain, corrections, most, missing: S::zero() })
    }
}

impl<S: Scalar> Observer<S> {
    /// The command (m/s, rad/s) with which the kernel makes its next step, where the drive's is `command`.
    #[inline(always)]
    pub fn command(&self, command: S) -> S {
        command + self.missing / self.gain
    }

    /// By how much (m/s, rad/s) the kernel's speed along the drive is to change after its step, if it is `predicted` and another one was
    /// `measured`. What is not finite changes nothing.
    #[inline(always)]
    pub fn correct(&mut self, predicted: S, measured: S) -> S {
        let (zero, one) = (S::zero(), S::one());
        let difference = measured - predicted;
        let finite = (one + difference * zero).select_gt(zero, one, zero);
        let [of_speed, of_force] = self.corrections;
        let missing = (self.missing + of_force * difference).within(-self.most, self.most);
        self.missing = missing.or_old(finite, self.missing);
        (of_speed * difference).or_old(finite, zero)
    }

    /// The force (N, N·m) that acts on the unit along the drive and is missing in the model: negative where the unit is harder to move.
    #[inline(always)]
    pub fn missing(&self) -> S {
        self.missing
    }

    /// Nothing is missing again: for another unit.
    pub fn restart(&mut self) {
        self.missing = S::zero();
    }
}

/// Gains α and β of a tracking index Λ, in the steady state (Kalata).
fn alpha_beta(index: f64) -> [f64; 2] {
    let r = (4.0 + index - libm::sqrt(8.0 * index + index * index)) / 4.0;
    let alpha = 1.0 - r * r;
    [alpha, 2.0 * (2.0 - alpha) - 4.0 * r]
}

#[cfg(test)]
mod tests {
    use super::{Noise, Observer, alpha_beta};

    /// The gains of the filter whose covariance no longer changes, by Riccati's recursion.
    fn by_recursion(index: f64) -> [f64; 2] {
        // Unit period and noise of the measurement: place and speed are driven by an acceleration constant over a period.
        let noise = [[0.25, 0.5], [0.5, 1.0]].map(|row| row.map(|q| q * index * index));
        let [mut p, mut k] = [[[1.0, 0.0], [0.0, 1.0]], [[0.0; 2]; 2]];
        for _ in 0..1_000_000 {
            let [[a, b], [_, c]] = p;
            let [[qa, qb], [_, qc]] = noise;
            let [a, b, c] = [a + 2.0 * b + c + qa, b + c + qb, c + qc];
            k[0] = [a / (a + 1.0), b / (a + 1.0)];
            p = [[a - k[0][0] * a, b - k[0][0] * b], [b - k[0][0] * b, c - k[0][1] * b]];
        }
        k[0]
    }

    #[test]
    #[cfg_attr(miri, ignore = "an interpreter has no time for so many steps")]
    fn gains_are_those_of_the_steady_filter() {
        for index in [1e-3, 0.02, 0.3, 1.0, 10.0] {
            let [closed, recursion] = [alpha_beta(index), by_recursion(index)];
            for (closed, recursion) in closed.into_iter().zip(recursion) {
                assert!((closed - recursion).abs() < 1e-9 * recursion.max(1e-3), "{index}: {closed} {recursion}");
            }
        }
        assert_eq!(alpha_beta(0.0), [0.0, 0.0]);
    }

    fn observer() -> Observer<f32> {
        let noise = Noise { speed: 1e-3, force: 1e-3 };
        Observer::new(40.0, 0.08, 1e-3, noise, 2.0).expect("it is in bounds")
    }

    /// A mass that the drive pushes against a force that the model does not have: the force is found, and the speed is the measured one.
    #[test]
    #[cfg_attr(miri, ignore = "an interpreter has no time for so many steps")]
    fn a_constant_force_is_found() {
        let (gain, mass, period) = (40.0, 0.08, 1e-3);
        let mut observer = observer();
        let [mut real, mut model] = [0.0f32; 2];
        let moved = |v: f32, command: f32, force: f32| {
            (v + period / mass * (gain * command + force)) / (1.0 + period / mass * gain)
        };
        for _ in 0..3000 {
            real = moved(real, 0.1, -0.7);
            model = moved(model, observer.command(0.1), 0.0);
            model += observer.correct(model, real);
        }
        assert!((observer.missing() + 0.7).abs() < 1e-3, "{}", observer.missing());
        assert!((model - real).abs() < 1e-5, "{model} {real}");
        observer.restart();
        assert_eq!(observer.missing(), 0.0);
        assert_eq!(observer.command(0.1), 0.1);
    }

    #[test]
    fn what_is_not_finite_changes_nothing() {
        let mut observer = observer();
        observer.correct(0.1, 0.101);
        let before = observer;
        for (predicted, measured) in [(0.1, f32::NAN), (0.1, f32::INFINITY), (f32::NAN, 0.1), (f32::NEG_INFINITY, 0.1)]
        {
            assert_eq!(observer.correct(predicted, measured), 0.0);
            assert_eq!(observer, before);
        }
        // The force stays within its bound, however far off the sensor is.
        assert!(observer.correct(0.0, 1e30).is_finite());
        assert_eq!(observer.missing(), 2.0);
        for _ in 0..3 {
            observer.correct(0.0, -1e30);
        }
        assert_eq!(observer.missing(), -2.0);
    }

    #[test]
    fn what_is_out_of_bounds_is_named() {
        let noise = Noise { speed: 1e-3f64, force: 1e-3 };
        let new = |gain, mass, period, noise, most| {
            Observer::new(gain, mass, period, noise, most).map(|_| ()).map_err(|error| error.parameter)
        };
        assert_eq!(new(40.0, 0.08, 1e-3, noise, 1.0), Ok(()));
        for (parameter, found) in [
            ("observer.gain", new(0.0, 0.08, 1e-3, noise, 1.0)),
            ("observer.mass", new(40.0, -1.0, 1e-3, noise, 1.0)),
            ("observer.period", new(40.0, 0.08, 2.0, noise, 1.0)),
            ("observer.noise.speed", new(40.0, 0.08, 1e-3, Noise { speed: 0.0, ..noise }, 1.0)),
            ("observer.noise.force", new(40.0, 0.08, 1e-3, Noise { force: f64::NAN, ..noise }, 1.0)),
            ("observer.most", new(40.0, 0.08, 1e-3, noise, f64::INFINITY)),
        ] {
            assert_eq!(found, Err(parameter));
        }
    }
}
