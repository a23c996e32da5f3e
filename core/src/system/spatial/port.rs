//! Which point of a body a link looks at, and from which body.

use crate::Vector3;

/// A point of a body, or of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Port<S> {
    /// Which body; `None` for the frame, which also stands for a body that is not there.
    pub body: Option<usize>,
    /// The point (m) from the body's centre of mass, in its axes; in the frame from its origin.
    pub lever: Vector3<S>,
}

/// A point of one body as seen from another, in the axes of the latter: displacement (m) since the nominal poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seat<S> {
    /// The point.
    pub point: Port<S>,
    /// The body that it is seen from; `None` for the frame.
    pub from: Option<usize>,
}
