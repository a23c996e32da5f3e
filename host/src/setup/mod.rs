//! What is to be computed, as data: a slide on four pins, runs and controllers, tolerance levels, and what varies.

mod hash;
mod identify;
mod slide;
mod task;
mod vary;

pub use hash::{Digest, scene_hash};
pub use identify::{Identification, Law, Sought, Subject, Unknown};
pub use slide::{GapError, GapMeasures, PinSpec, SURFACES, Scene, SlideSpec};
pub use task::{ControllerSpec, GAP_MOST, LevelRange, RunSpec};
pub use vary::{SlideParameter, Varied, rub_more, tilted_x, tilted_z};
