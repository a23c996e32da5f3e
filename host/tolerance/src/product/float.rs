//! The play of a hole on its pin, in which it floats.

use crate::numeric::lanes::{LANES, Lanes};

use super::contact::CONDITIONS;

/// The diameter of a hole or a pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Size {
    /// The variable of an actual one (m).
    Actual(usize),
    /// That of a boundary (m), which is perfect.
    Boundary(f64),
}

impl Size {
    #[inline(always)]
    fn of(self, variables: &[Lanes]) -> Lanes {
        match self {
            Self::Actual(variable) => variables[variable],
            Self::Boundary(size) => Lanes::splat(size),
        }
    }
}

/// A hole and a pin: which variables say how large they are and where in its play the hole floats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Float {
    /// Number of the fit in the product; none of a datum in its boundary.
    pub fit: Option<usize>,
    /// Hole and pin.
    pub diameters: [Size; 2],
    /// The first of two variables across the axes, or of four with both tilts, in units of half the play.
    pub first: Option<usize>,
    /// What of the play tilts the axes by it at the end of the shorter one, over the reach of the contact; 0 if the axes do not
    /// tilt in it.
    pub tilt: f64,
}

impl Float {
    /// Half of the play (m); negative where the pin is larger than the hole.
    #[inline(always)]
    pub fn half_play(&self, variables: &[Lanes]) -> Lanes {
        let [hole, pin] = self.diameters.map(|size| size.of(variables));
        (hole - pin) * 0.5
    }

    /// Takes the float off the conditions of two axes: off the distances across, and off the tilts. A pin without play holds
    /// the hole centred.
    #[inline(always)]
    pub fn take_off(&self, variables: &[Lanes], conditions: &mut [Lanes; CONDITIONS]) {
        let Some(first) = self.first else { return };
        let play = self.half_play(variables).map(|play| play.max(0.0));
        conditions[0] -= variables[first] * play;
        conditions[1] -= variables[first + 1] * play;
        if self.tilt > 0.0 {
            conditions[2] -= variables[first + 2] * play * self.tilt;
            conditions[3] -= variables[first + 3] * play * self.tilt;
        }
    }

    /// The units in which the pin is larger than the hole, or axes that are `off` (m) each other do not come together within
    /// the `room` (m) of all pins of the part.
    pub fn misfits(&self, variables: &[Lanes], off: Lanes, room: Lanes) -> usize {
        let play = self.half_play(variables);
        (0..LANES).filter(|lane| play.0[*lane] < 0.0 || off.0[*lane] > room.0[*lane]).count()
    }
}
