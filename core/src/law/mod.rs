//! Force laws, one a file. Each gives its force together with the derivatives an implicit step needs.

pub mod bistop;
pub mod elastic;
pub mod friction;
pub mod impact;
mod normal;
pub mod step;
pub mod stop;

pub use elastic::{Elastic, Linear, Power, ThreeHalves};
pub use friction::{Exact, Friction, Frictionless, Regularised, StaticKinetic};
pub use impact::{Impact, NormalResponse};
pub use normal::Normal;
pub use stop::{Pad, Slot, Stop};
