//! What elements add up to: forces alone, with the balance of a stage, or with all derivatives.

use super::{Bodies, Law, Link, Response};
use crate::{SMatrix, SVector, Scalar};

/// Takes what elements do.
pub trait Assembly<S: Scalar, const D: usize> {
    /// Adds the `response` of a law at `link`.
    fn add<B: Bodies<S, D>, L: Link<S, B, D, R>, W: Law<S, R>, const R: usize>(
        &mut self,
        link: &L,
        at: (&B, &B::Placed),
        view: &L::View,
        response: &Response<S, R>,
    );
}

/// The generalised force (N, N·m).
pub(super) struct Sum<S, const D: usize>(pub SVector<S, D>);

/// The force, and how M·V/a − force goes by velocities that also move the bodies over the time a.
pub(super) struct Balance<S, const D: usize> {
    pub force: SVector<S, D>,
    pub matrix: SMatrix<S, D, D>,
    pub a: S,
}

/// The force and its derivatives by time, velocity and place, the last two negated.
pub(super) struct Derivatives<S, const D: usize> {
    pub force: SVector<S, D>,
    pub per_time: SVector<S, D>,
    pub damping: SMatrix<S, D, D>,
    pub stiffness: SMatrix<S, D, D>,
}

/// Adds Λᵀ·C, as far as the `link` says that Λ is not zero. Column k of C is the sum over the numbers i of what forces change by
/// with the number i where the coordinate k changes: `change(i, k)`.
#[inline(always)]
fn add_product<S: Scalar, B: Bodies<S, D>, L: Link<S, B, D, R>, const R: usize, const D: usize>(
    link: &L,
    gradient: &SMatrix<S, R, D>,
    change: impl Fn(usize, usize) -> SVector<S, R>,
    sum: &mut SMatrix<S, D, D>,
) {
    let mut moved = [false; D];
    for (k, moved) in moved.iter_mut().enumerate() {
        *moved = link.moves(k);
    }
    for k in 0..D {
        if moved[k] {
            let mut column = SVector::<S, R>::zeros();
            for i in 0..R {
                if link.depends(i, k) {
                    column += change(i, k);
                }
            }
            for j in 0..D {
                if moved[j] {
                    for i in 0..R {
                        if link.depends(i, j) {
                            sum[(j, k)] += gradient[(i, j)] * column[i];
                        }
                    }
                }
            }
        }
    }
}

impl<S: Scalar, const D: usize> Assembly<S, D> for Sum<S, D> {
    #[inline(always)]
    fn add<B: Bodies<S, D>, L: Link<S, B, D, R>, W: Law<S, R>, const R: usize>(
        &mut self,
        link: &L,
        at: (&B, &B::Placed),
        view: &L::View,
        response: &Response<S, R>,
    ) {
        link.add_force(at, view, &response.force, &mut self.0);
    }
}

impl<S: Scalar, const D: usize> Assembly<S, D> for Balance<S, D> {
    #[inline(always)]
    fn add<B: Bodies<S, D>, L: Link<S, B, D, R>, W: Law<S, R>, const R: usize>(
        &mut self,
        link: &L,
        at: (&B, &B::Placed),
        view: &L::View,
        response: &Response<S, R>,
    ) {
        let gradient = &link.gradient(at, view);
        link.add_force(at, view, &response.force, &mut self.force);
        // Over the time a a velocity also moves the bodies, by which rates are others.
        let rates = gradient + link.swept(at, view, gradient) * self.a;
        let stiffness = response.stiffness * self.a;
        let change = |i, k| {
            let by_rate = response.impedance.column(i) * rates[(i, k)];
            if i < W::PLACES { by_rate + stiffness.column(i) * gradient[(i, k)] } else { by_rate }
        };
        add_product(link, gradient, change, &mut self.matrix);
        link.add_carried(at, view, gradient, &(response.force * self.a), &mut self.matrix);
    }
}

impl<S: Scalar, const D: usize> Assembly<S, D> for Derivatives<S, D> {
    #[inline(always)]
    fn add<B: Bodies<S, D>, L: Link<S, B, D, R>, W: Law<S, R>, const R: usize>(
        &mut self,
        link: &L,
        at: (&B, &B::Placed),
        view: &L::View,
        response: &Response<S, R>,
    ) {
        let gradient = &link.gradient(at, view);
        let Response { impedance, stiffness, .. } = response;
        link.add_force(at, view, &response.force, &mut self.force);
        if W::TIMED {
            link.add_force(at, view, &response.per_time, &mut self.per_time);
        }
        let swept = link.swept(at, view, gradient);
        add_product(link, gradient, |i, k| impedance.column(i) * gradient[(i, k)], &mut self.damping);
        let change = |i, k| {
            let by_rate = impedance.column(i) * swept[(i, k)];
            if i < W::PLACES { stiffness.column(i) * gradient[(i, k)] + by_rate } else { by_rate }
        };
        add_product(link, gradient, change, &mut self.stiffness);
        link.add_carried(at, view, gradient, &response.force, &mut self.stiffness);
    }
}
