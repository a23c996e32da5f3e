//! Laws of contacts as plain data.

use slipfit_core::menu::{ContactData, FrictionData};

/// Laws of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laws {
    /// Along the normal.
    pub contact: NormalData,
    /// Along the tangents.
    pub friction: FrictionData<f64>,
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
