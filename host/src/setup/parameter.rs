//! Parameters that can differ from what a scene states, and those that do from unit to unit.

use slipfit_tolerance::model::Contributor;

/// A parameter of a slide or of a mechanism.
pub trait Adjustable: Copy + Send + Sync {
    /// What it is a parameter of.
    type Of: Clone + Send + Sync;

    /// Replaces each value (SI) that it has in `of` by what `change` makes of it. An angle of gravity is 0 as stated.
    fn change(self, of: &mut Self::Of, change: &mut dyn FnMut(f64) -> f64);

    /// Whether it varies by shares of itself.
    fn varies_by_shares(self) -> bool;

    /// Moves it by a `deviation` (SI, or a share).
    fn vary(self, of: &mut Self::Of, deviation: f64) {
        match self.varies_by_shares() {
            true => self.change(of, &mut |value| value * (1.0 + deviation)),
            false => self.change(of, &mut |value| value + deviation),
        }
    }

    /// Gives it a `value` (SI), wherever `of` has it.
    fn set(self, of: &mut Self::Of, value: f64) {
        self.change(of, &mut |_| value);
    }

    /// The values (SI) that it has in `of`.
    fn values(self, of: &Self::Of) -> Vec<f64> {
        let mut values = Vec::new();
        self.change(&mut of.clone(), &mut |value| {
            values.push(value);
            value
        });
        values
    }
}

/// A parameter that varies, and by how much from the stated value: of a slide, or of another menu `P`.
#[derive(Clone, Debug, PartialEq)]
pub struct Varied<P = SlideParameter> {
    /// Which.
    pub parameter: P,
    /// Its deviation (SI, or a share) from the scene's value.
    pub deviation: Contributor,
}

/// A parameter of a slide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlideParameter {
    /// Coefficient of friction.
    Friction,
    /// Speed below which regularised friction fades.
    StickBand,
    /// Stiffness of the contacts; it varies by shares of itself.
    Stiffness,
    /// Damping of the contacts.
    Damping,
    /// Penetration at which damping is full.
    Depth,
    /// Mass; the inertia goes with it.
    Mass,
    /// Gain of the drive.
    Gain,
    /// End of the drive's ramp.
    RampEnd,
    /// Direction of gravity: rotation about the frame's x.
    TiltX,
    /// Direction of gravity: rotation about the frame's z.
    TiltZ,
}

/// `gravity` (m/s²) turned about x by an `angle` (rad).
pub fn tilted_x([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    [x, cos * y - sin * z, sin * y + cos * z]
}

/// `gravity` (m/s²) turned about z by an `angle` (rad).
pub fn tilted_z([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    [cos * x - sin * y, sin * x + cos * y, z]
}
