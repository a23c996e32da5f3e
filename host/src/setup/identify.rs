//! What is sought in measured motion.

use slipfit_core::slide::CONTACTS;
use slipfit_identify::{drive_train::Term, fit, record::Columns};

use super::{Adjustable, Scene, SlideParameter};

/// What is sought in measured motion, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Identification {
    /// Which column is what.
    pub columns: Columns,
    /// How the fit is made.
    pub options: fit::Options,
    /// What is sought.
    pub subject: Subject,
}

/// What a record is of.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// A drive train without a mechanism, by its effort along the measured motion.
    DriveTrain {
        /// Its law; `None` to compare all.
        law: Option<Law>,
        /// Cut-off frequency (Hz) of the motion's filter, if it is stated.
        cutoff: Option<f64>,
    },
    /// The slide of the scene, by the force that its drive has to give.
    Slide(Vec<Sought>),
}

/// A law of a drive train.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Law {
    /// Its name.
    pub name: String,
    /// Its terms.
    pub terms: Vec<Term>,
}

/// A value of a slide that is sought, between two bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Sought {
    /// Which.
    pub value: SoughtValue,
    /// Its name, such as friction.coefficient.
    pub name: String,
    /// The least and the greatest value (SI).
    pub bounds: [f64; 2],
}

/// A value of a slide that can be sought.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SoughtValue {
    /// A parameter.
    Parameter(SlideParameter),
    /// The tolerance level of the gaps of these indices.
    Level(Vec<usize>),
}

impl SoughtValue {
    /// The symbol of its SI unit; empty for a plain number.
    pub fn unit(&self) -> &'static str {
        match self {
            Self::Parameter(SlideParameter::Mass) => "kg",
            Self::Parameter(SlideParameter::Stiffness) => "N/m^e",
            Self::Parameter(_) | Self::Level(_) => "",
        }
    }

    /// What it is (SI) in a scene with gaps of these `levels`.
    pub fn of(&self, scene: &Scene, levels: &[f64; CONTACTS]) -> f64 {
        let first = match self {
            Self::Parameter(parameter) => parameter.values(scene).first().copied(),
            Self::Level(contacts) => contacts.first().map(|i| levels[*i]),
        };
        first.unwrap_or_default()
    }

    /// Makes it `value` (SI).
    pub fn set(&self, scene: &mut Scene, levels: &mut [f64; CONTACTS], value: f64) {
        match self {
            Self::Parameter(parameter) => parameter.set(scene, value),
            Self::Level(contacts) => contacts.iter().for_each(|i| levels[*i] = value),
        }
    }
}
