//! What a law along a contact's normal is.

use super::{bistop::SlotResponse, response::NormalResponse};
use crate::Scalar;

/// A one-sided law along a contact's normal: it pushes or does nothing.
pub trait Normal<S: Scalar>: Copy {
    /// The response at `penetration` δ (m, positive inside) and `rate` δ̇ (m/s, positive while approaching).
    fn response(&self, penetration: S, rate: S) -> NormalResponse<S>;

    /// Elastic energy (J) stored at `penetration` (m, positive inside).
    fn energy(&self, penetration: S) -> S;

    /// A slot of this law with the gaps `lower` and `upper` (m) at offset 0.
    ///
    /// `offset` (m) is the pin's displacement along the slot's axis as seen from the body that carries the slot:
    /// the lower gap is `lower + offset`, the upper `upper − offset`. `speed` u (m/s) is that of the body's material at
    /// the pin, so the offset's rate is −u.
    #[inline(always)]
    fn slot(&self, lower: S, upper: S, offset: S, speed: S) -> SlotResponse<S> {
        SlotResponse::new(self.response(-(lower + offset), speed), self.response(offset - upper, -speed))
    }
}
