//! Laws of contacts as plain data.

use slipfit_core::{
    law::StribeckData,
    menu::{ContactData, FrictionData},
};

/// Laws of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laws {
    /// Along the normal.
    pub contact: NormalData,
    /// Along the tangents.
    pub friction: SlidingData,
}

/// A law along a contact's tangents, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SlidingData {
    /// Coulomb friction, with one coefficient.
    Coulomb(FrictionData<f64>),
    /// Regularised friction with a static and a kinetic coefficient, the fall between them and a viscous part.
    Stribeck(StribeckData<f64>),
    /// True stick up to the static coefficient, sliding with the kinetic one.
    StaticKinetic {
        /// Static coefficient.
        at_rest: f64,
        /// Kinetic coefficient, not above it.
        kinetic: f64,
    },
}

impl SlidingData {
    /// No friction.
    pub const NONE: Self = Self::Coulomb(FrictionData::None);

    /// The coefficient that has to be overcome to move: the static one, where there are two.
    pub fn holds(&self) -> f64 {
        match self {
            Self::Coulomb(data) => data.coefficient(),
            Self::Stribeck(StribeckData { at_rest, .. }) | Self::StaticKinetic { at_rest, .. } => *at_rest,
        }
    }

    /// The coefficients, static before kinetic; none without friction.
    pub fn coefficients(&mut self) -> Vec<&mut f64> {
        match self {
            Self::Coulomb(data) => data.coefficient_mut().into_iter().collect(),
            Self::Stribeck(StribeckData { at_rest, kinetic, .. }) | Self::StaticKinetic { at_rest, kinetic } => {
                vec![at_rest, kinetic]
            }
        }
    }

    /// The stick band (m/s), of a regularised law, to be changed.
    pub fn stick_band_mut(&mut self) -> Option<&mut f64> {
        match self {
            Self::Coulomb(data) => data.stick_band_mut(),
            Self::Stribeck(StribeckData { stick_band, .. }) => Some(stick_band),
            Self::StaticKinetic { .. } => None,
        }
    }

    /// The stick band (m/s), of a regularised law.
    pub fn stick_band(mut self) -> Option<f64> {
        self.stick_band_mut().copied()
    }

    /// Whether only implicit steps can follow it.
    pub fn sticks(&self) -> bool {
        matches!(self, Self::Coulomb(FrictionData::Exact { .. }) | Self::StaticKinetic { .. })
    }
}

/// A law along a contact's normal, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalData {
    /// A spring and a damper that fades in with depth.
    Impact(ContactData<f64>),
    /// Hunt and Crossley's.
    HuntCrossley(Rebound),
    /// Lankarani and Nikravesh's.
    LankaraniNikravesh(Rebound),
}

/// Parameters of a law with a restitution, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rebound {
    /// Stiffness k (N/m^e).
    pub stiffness: f64,
    /// Exponent e.
    pub exponent: f64,
    /// Speed after over speed before a bounce.
    pub restitution: f64,
    /// Speed of approach (m/s) that the restitution is meant for.
    pub speed: f64,
}

impl NormalData {
    /// Stiffness k (N/m^e) and exponent e of the spring.
    pub fn spring(&self) -> [f64; 2] {
        match self {
            Self::Impact(data) => [data.stiffness, data.exponent],
            Self::HuntCrossley(data) | Self::LankaraniNikravesh(data) => [data.stiffness, data.exponent],
        }
    }
}
