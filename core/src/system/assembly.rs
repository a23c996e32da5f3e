//! What elements add up to: forces alone, with the balance of a stage, or with all derivatives.

use super::{Bodies, Link, Response, Seen};
use crate::{SMatrix, SVector, Scalar};

/// Takes what elements do.
pub trait Assembly<S: Scalar, const D: usize> {
    /// Adds the `response` of a law at `link`.
    fn add<B: Bodies<S, D>, L: Link<S, B, D, R>, const R: usize>(
        &mut self,
        link: &L,
        at: (&B, &B::Placed),
        view: &L::View,
        seen: &Seen<S, R, D>,
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

/// Adds Λᵀ·`force`, as far as the `link` says that Λ is not zero.
#[inline(always)]
fn add_force<S: Scalar, B: Bodies<S, D>, L: Link<S, B, D, R>, const R: usize, const D: usize>(
    link: &L,
    gradient: &SMatrix<S, R, D>,
    force: &SVector<S, R>,
    sum: &mut SVector<S, D>,
) {
    for k in 0..D {
        for i in 0..R {
            if link.depends(i, k) {
                sum[k] += gradient[(i, k)] * force[i];
            }
        }
    }
}

/// Adds Λᵀ·W, as far as the `link` says that Λ is not zero. Column k of W is the sum over the numbers i of what forces change by
/// with the number i where the coordinate k changes: `change(i, k)`.
#[inline(always)]
fn add_product<S: Scalar, B: Bodies<S, D>, L: Link<S, B, D, R>, const R: usize, const D: usize>(
    link: &L,
    gradient: &SMatrix<S, R, D>,
    change: impl Fn(usize, usize) -> SVector<S, R>,
    sum: &mut SMatrix<S, D, D>,
) {
    for k in 0..D {
        let mut column = SVector::<S, R>::zeros();
        for i in 0..R {
            if link.depends(i, k) {
                column += change(i, k);
            }
        }
        for j in 0..D {
            for i in 0..R {
                if link.depends(i, j) {
                    sum[(j, k)] += gradient[(i, j)] * column[i];
                }
            }
        }
    }
}

impl<S: Scalar, const D: usize> Assembly<S, D> for Sum<S, D> {
    #[inline(always)]
    fn add<B: Bodies<S, D>, L: Link<S, B, D, R>, const R: usize>(
        &mut self,
        link: &L,
        _: (&B, &B::Placed),
        _: &L::View,
        seen: &Seen<S, R, D>,
        response: &Response<S, R>,
    ) {
        add_force(link, &seen.gradient, &response.force, &mut self.0);
    }
}

impl<S: Scalar, const D: usize> Assembly<S, D> for Balance<S, D> {
    #[inline(always)]
    fn add<B: Bodies<S, D>, L: Link<S, B, D, R>, const R: usize>(
        &mut self,
        link: &L,
        at: (&B, &B::Placed),
        view: &L::View,
        seen: &Seen<S, R, D>,
        response: &Response<S, R>,
    ) {
        let Seen { gradient, .. } = seen;
        add_force(link, gradient, &response.force, &mut self.force);
        // Over the time a a velocity also moves the bodies, by which rates are others.
        let rates = gradient + link.swept(at, view) * self.a;
        let stiffness = response.stiffness * self.a;
        let change = |i, k| response.impedance.column(i) * rates[(i, k)] + stiffness.column(i) * gradient[(i, k)];
        add_product(link, gradient, change, &mut self.matrix);
        link.add_carried(at, view, seen, &(response.force * self.a), &mut self.matrix);
    }
}

impl<S: Scalar, const D: usize> Assembly<S, D> for Derivatives<S, D> {
    #[inline(always)]
    fn add<B: Bodies<S, D>, L: Link<S, B, D, R>, const R: usize>(
        &mut self,
        link: &L,
        at: (&B, &B::Placed),
        view: &L::View,
        seen: &Seen<S, R, D>,
        response: &Response<S, R>,
    ) {
        let Seen { gradient, .. } = seen;
        let Response { impedance, stiffness, .. } = response;
        add_force(link, gradient, &response.force, &mut self.force);
        add_force(link, gradient, &response.per_time, &mut self.per_time);
        let swept = link.swept(at, view);
        add_product(link, gradient, |i, k| impedance.column(i) * gradient[(i, k)], &mut self.damping);
        let change = |i, k| stiffness.column(i) * gradient[(i, k)] + impedance.column(i) * swept[(i, k)];
        add_product(link, gradient, change, &mut self.stiffness);
        link.add_carried(at, view, seen, &response.force, &mut self.stiffness);
    }
}
