//! Free bodies in numbers of another type, such as the lanes of a register.

use super::{FreeBodies, Placed, PlacedBody, Rigid};
use crate::{
    SMatrix, Scalar,
    product::{mapped, mapped_entries},
    system::{AbreastBodies, Lanes, everywhere},
};

crate::cast::cast!([] [] Rigid: Rigid<f64> => T Rigid<T> { mass, inertia_b, centre_w });
crate::cast::cast!([] [N D] FreeBodies: FreeBodies<f64, N, D> => T FreeBodies<T, N, D> { bodies, gravity_w, per_lever, least_mass });

impl<S: Scalar> PlacedBody<S> {
    /// The same in numbers of another type.
    #[inline(always)]
    fn cast<T: Scalar>(&self, number: impl Fn(S) -> T) -> PlacedBody<T> {
        PlacedBody {
            to_frame: mapped_entries(&self.to_frame, &number),
            displacement_w: mapped(&self.displacement_w, &number),
            velocity_w: mapped(&self.velocity_w, &number),
            rotation_b: mapped(&self.rotation_b, &number),
            rotation_w: mapped(&self.rotation_w, &number),
        }
    }
}

impl<S: Scalar, L: Lanes<S>, const N: usize, const D: usize> AbreastBodies<S, L, D> for FreeBodies<S, N, D> {
    type Lanes = FreeBodies<L, N, D>;

    #[inline(always)]
    fn everywhere(placed: &Placed<S, N>) -> Placed<L, N> {
        Placed { bodies: placed.bodies.each_ref().map(|body| body.cast(everywhere)) }
    }

    #[inline(always)]
    fn summed(jacobian: &SMatrix<L, D, D>) -> SMatrix<S, D, D> {
        let mut sums = SMatrix::<S, D, D>::zeros();
        for (sum, lanes) in sums.iter_mut().zip(jacobian) {
            *sum = lanes.sum();
        }
        sums
    }
}
