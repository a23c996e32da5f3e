//! What a law along a contact's normal is.

use super::{Elastic, Impact, NormalResponse};
use crate::Scalar;

/// A one-sided law along a contact's normal: it pushes or does nothing.
pub trait Normal<S>: Copy {
    /// The response at `penetration` δ (m, positive inside) and `rate` δ̇ (m/s, positive while approaching).
    fn response(&self, penetration: S, rate: S) -> NormalResponse<S>;
}

impl<S: Scalar, E: Elastic<S>> Normal<S> for Impact<S, E> {
    #[inline(always)]
    fn response(&self, penetration: S, rate: S) -> NormalResponse<S> {
        self.response(penetration, rate)
    }
}
