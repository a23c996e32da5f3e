//! What is sought in measured motion.

use slipfit_identify::{drive_train::Term, fit, record::Columns};

use crate::{
    dynamics::{simulate::SimulateError, trajectory::Trajectory},
    mechanism,
    setup::{Adjustable, SlideParameter},
};

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
    /// The slide of the scene.
    Slide(OfRecord<SlideParameter>),
    /// The mechanism of the scene.
    Mechanism(OfRecord<mechanism::Parameter>),
}

/// A law of a drive train.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Law {
    /// Its name.
    pub name: String,
    /// Its terms.
    pub terms: Vec<Term>,
}

/// What a record shows of a unit, and what is sought of it.
#[derive(Clone, Debug, PartialEq)]
pub struct OfRecord<P> {
    /// What is sought.
    pub sought: Vec<Sought<P>>,
    /// The drive that was recorded.
    pub drive: usize,
    /// What is compared.
    pub compared: Compared,
    /// Whether the drive moves as it was measured.
    pub along: Option<Along>,
}

/// A drive that moves as it was measured, so that its controller need not be known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along {
    /// Cut-off frequency (Hz) of the motion's filter, if it is stated.
    pub cutoff: Option<f64>,
}

/// What of a record is compared with the computed motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compared {
    /// The force or torque of the drive.
    #[default]
    Force,
    /// The speed along the drive's axis.
    Speed,
    /// The distance along the drive's axis from the first sample on.
    Position,
}

/// A value that is sought, between two bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Sought<P> {
    /// Which.
    pub value: SoughtValue<P>,
    /// Its name, such as friction.coefficient.
    pub name: String,
    /// The list of the scene in which a table of the name before the key states it, such as `body`; `None` if the name is the key.
    pub list: Option<&'static str>,
    /// The symbol of its SI unit; empty for a plain number.
    pub unit: &'static str,
    /// The least and the greatest value (SI).
    pub bounds: [f64; 2],
    /// What is known of it beforehand, as mean and standard deviation (SI), if anything is.
    pub prior: Option<[f64; 2]>,
}

impl<P> Sought<P> {
    /// In which list of a scene it is stated, if in one; `None` of what no key of a scene says.
    pub fn place(&self) -> Option<Option<&'static str>> {
        matches!(self.value, SoughtValue::Parameter(_)).then_some(self.list)
    }
}

/// A value that can be sought.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SoughtValue<P> {
    /// A parameter.
    Parameter(P),
    /// The tolerance level of the gaps of these indices.
    Level(Vec<usize>),
    /// The time (s) by which the record lags behind what it shows.
    Delay,
}

/// A unit of a scene that moves.
pub trait Unit: Clone + Send + Sync {
    /// A parameter of it.
    type Parameter: Adjustable<Of = Self>;

    /// The motion of the drive of this number, with gaps of these `levels`, over `duration` (s) at intervals of `every` (s).
    ///
    /// # Errors
    /// [`SimulateError`] where there is none.
    fn motion(&self, levels: &[f64], drive: usize, every: f64, duration: f64) -> Result<Trajectory, SimulateError>;

    /// The same unit whose drive of this number has the `speeds` (m/s, rad/s) at intervals of `step` (s), whatever that takes; `None` of
    /// one whose motion cannot be prescribed.
    fn prescribed(&self, drive: usize, speeds: &[f64], step: f64) -> Option<Self>;
}
