//! What is sought in measured motion.

use slipfit_identify::{drive_train::Term, fit, record::Columns};

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

/// A parameter of a slide that is sought, between two bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Sought {
    /// Which.
    pub unknown: Unknown,
    /// The least and the greatest value (SI).
    pub bounds: [f64; 2],
}

/// What may be unknown of a slide.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unknown {
    /// Coefficient of friction.
    Friction,
    /// Stiffness of the contacts (N/m^e).
    Stiffness,
    /// Mass (kg), with which the moments of inertia grow.
    Mass,
    /// Tolerance level of some gaps.
    Level {
        /// What they are called together.
        of: String,
        /// Their indices.
        contacts: Vec<usize>,
    },
}
