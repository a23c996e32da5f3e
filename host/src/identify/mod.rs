//! Scenes as models of measured motion.

mod mechanism;
mod model;
mod slide;
mod specification;

pub use self::model::{MotionModel, RecordMisfit};
pub use self::specification::{Along, Compared, Identification, Law, OfRecord, Sought, SoughtValue, Subject, Unit};
