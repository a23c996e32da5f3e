//! Force laws, one a file. Each gives its force together with the derivatives an implicit step needs.

pub mod bistop;
pub mod elastic;
pub mod fit;
pub mod friction;
pub mod hunt_crossley;
pub mod impact;
pub mod lankarani_nikravesh;
mod normal;
mod response;
pub mod step;
pub mod stop;

pub use elastic::{Elastic, Linear, Power, ThreeHalves};
pub use fit::{ClearanceFit, Fit};
pub use friction::{Exact, Friction, Frictionless, Regularised, StaticKinetic, Stribeck, StribeckData};
pub use hunt_crossley::HuntCrossley;
pub use impact::Impact;
pub use lankarani_nikravesh::LankaraniNikravesh;
pub use normal::Normal;
pub use response::NormalResponse;
pub use stop::{Pad, Slot, Stop};
