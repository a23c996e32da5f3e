//! What is to be computed, as data: a slide on four pins, runs and controllers, tolerance levels, what varies and what is unknown.

mod hash;
mod measured;
mod parameter;
mod slide;
mod task;
mod uncertain;

pub use hash::{Digest, scene_hash};
pub use measured::{Measured, MeasuredGaps, Place};
pub use parameter::{Adjustable, SlideParameter, Varied, tilted_x, tilted_z};
pub use slide::{GapError, GapMeasures, PinSpec, SURFACES, Scene, SlideSpec};
pub use task::{ControllerSpec, GAP_MOST, LevelRange, RunSpec};
pub use uncertain::{Belief, REACH, ShownIn, Uncertain};
