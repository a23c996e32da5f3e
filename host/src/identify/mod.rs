//! Scenes as models of measured motion.

mod slide;

pub use self::slide::SlideModel;
