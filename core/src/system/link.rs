//! What elements measure.

use super::{Bodies, Law, Response, bodies::ByCoordinate};
use crate::{SMatrix, SVector, Scalar};

/// What an element sees: `R` lengths and angles, and how fast they change.
#[derive(Clone, Copy, Debug)]
pub struct Seen<S, const R: usize> {
    /// x (m, rad); zero where a law needs the rate alone.
    pub place: SVector<S, R>,
    /// ẋ (m/s, rad/s).
    pub rate: SVector<S, R>,
}

/// Measures `R` lengths and angles x of bodies `B`, and gives them the forces φ that work along these.
pub trait Link<S: Scalar, B: Bodies<S, D>, const D: usize, const R: usize> {
    /// What places, rates and their derivatives are made of.
    type View;

    /// The bodies as the link looks at them.
    fn view(&self, bodies: &B, placed: &B::Placed) -> Self::View;

    /// What there is to see.
    fn seen(&self, at: (&B, &B::Placed), view: &Self::View) -> Seen<S, R>;

    /// Adds the generalised force (N, N·m) Λᵀφ of a `force` φ to `sum`, with Λ = ∂ẋ/∂V.
    fn add_force(&self, at: (&B, &B::Placed), view: &Self::View, force: &SVector<S, R>, sum: &mut SVector<S, D>);

    /// Adds −∂(Λᵀφ)/∂V for the `response` of a law `W` and for velocities that also move the bodies over the time `a` (s). Where
    /// [`Bodies::MATRIX_IS_LEAN`], the impedance of the response is told over that time and all there is to add.
    fn add_impedance<W: Law<S, R>>(
        &self,
        at: (&B, &B::Placed),
        view: &Self::View,
        response: &Response<S, R>,
        a: S,
        matrix: &mut B::Jacobian,
    );

    /// Adds −∂(Λᵀφ)/∂V to `damping` and −∂(Λᵀφ)/∂Q to `stiffness`, for the `response` of a law `W`.
    fn add_derivatives<W: Law<S, R>>(
        &self,
        at: (&B, &B::Placed),
        view: &Self::View,
        response: &Response<S, R>,
        damping: &mut B::Jacobian,
        stiffness: &mut B::Jacobian,
    );
}

/// A link of bodies whose forces add up by generalised velocities, which tells its gradient Λ = ∂ẋ/∂V entry by entry.
pub trait GradientLink<S: Scalar, B: Bodies<S, D>, const D: usize, const R: usize> {
    /// See [`Link::View`].
    type View;

    /// See [`Link::view`].
    fn view(&self, bodies: &B, placed: &B::Placed) -> Self::View;

    /// Whether the coordinate `k` moves anything that there is to see. Where it does not, in any pose, derivatives are zero and
    /// not looked at.
    fn moves(&self, k: usize) -> bool;

    /// See [`Link::seen`].
    fn seen(&self, at: (&B, &B::Placed), view: &Self::View) -> Seen<S, R>;

    /// Λ.
    fn gradient(&self, at: (&B, &B::Placed), view: &Self::View) -> SMatrix<S, R, D>;

    /// See [`Link::add_force`].
    fn add_force(&self, at: (&B, &B::Placed), view: &Self::View, force: &SVector<S, R>, sum: &mut SVector<S, D>);

    /// Adds −∂(Λᵀφ)/∂Q for a `force` φ that is held to `stiffness`.
    fn add_carried(
        &self,
        at: (&B, &B::Placed),
        view: &Self::View,
        gradient: &SMatrix<S, R, D>,
        force: &SVector<S, R>,
        stiffness: &mut SMatrix<S, D, D>,
    );

    /// ∂(Λ·V)/∂Q, the velocities V being held.
    fn swept(&self, at: (&B, &B::Placed), view: &Self::View, gradient: &SMatrix<S, R, D>) -> SMatrix<S, R, D>;

    /// Adds Λᵀ·C, as far as Λ is not zero. Column k of C is the sum of the [`Change`] with all numbers where the coordinate k changes.
    #[inline(always)]
    fn add_product(&self, gradient: &SMatrix<S, R, D>, change: &Change<'_, S, R, D>, sum: &mut SMatrix<S, D, D>) {
        for k in 0..D {
            if self.moves(k) {
                let mut column = SVector::<S, R>::zeros();
                for i in 0..R {
                    column += change.with(i, k);
                }
                for j in 0..D {
                    if self.moves(j) {
                        for i in 0..R {
                            sum[(j, k)] += gradient[(i, j)] * column[i];
                        }
                    }
                }
            }
        }
    }
}

/// How forces change with what a link measures, and that with coordinates. No closure: where the compiler does not inline one, a panic is
/// reachable in it.
pub struct Change<'a, S, const R: usize, const D: usize> {
    /// −∂φ/∂ẋ, and how the rates change with the coordinates.
    impedance: &'a SMatrix<S, R, R>,
    rates: &'a SMatrix<S, R, D>,
    /// −∂φ/∂x of the first numbers, how these change with the coordinates, and how many they are.
    by_place: Option<(&'a SMatrix<S, R, R>, &'a SMatrix<S, R, D>, usize)>,
}

impl<S: Scalar, const R: usize, const D: usize> Change<'_, S, R, D> {
    /// What forces change by with the number `i` where the coordinate `k` changes.
    #[inline(always)]
    pub fn with(&self, i: usize, k: usize) -> SVector<S, R> {
        let by_rate = self.impedance.column(i) * self.rates[(i, k)];
        match self.by_place {
            Some((stiffness, places, count)) if i < count => by_rate + stiffness.column(i) * places[(i, k)],
            _ => by_rate,
        }
    }
}

impl<S, B, L, const D: usize, const R: usize> Link<S, B, D, R> for L
where
    S: Scalar,
    B: Bodies<S, D, Jacobian = SMatrix<S, D, D>> + ByCoordinate,
    L: GradientLink<S, B, D, R>,
{
    type View = <L as GradientLink<S, B, D, R>>::View;

    #[inline(always)]
    fn view(&self, bodies: &B, placed: &B::Placed) -> Self::View {
        GradientLink::view(self, bodies, placed)
    }

    #[inline(always)]
    fn seen(&self, at: (&B, &B::Placed), view: &Self::View) -> Seen<S, R> {
        GradientLink::seen(self, at, view)
    }

    #[inline(always)]
    fn add_force(&self, at: (&B, &B::Placed), view: &Self::View, force: &SVector<S, R>, sum: &mut SVector<S, D>) {
        GradientLink::add_force(self, at, view, force, sum);
    }

    #[inline(always)]
    fn add_impedance<W: Law<S, R>>(
        &self,
        at: (&B, &B::Placed),
        view: &Self::View,
        response: &Response<S, R>,
        a: S,
        matrix: &mut SMatrix<S, D, D>,
    ) {
        let gradient = &self.gradient(at, view);
        let rates = gradient + self.swept(at, view, gradient) * a;
        let stiffness = response.stiffness * a;
        let change =
            Change { impedance: &response.impedance, rates: &rates, by_place: Some((&stiffness, gradient, W::PLACES)) };
        self.add_product(gradient, &change, matrix);
        self.add_carried(at, view, gradient, &(response.force * a), matrix);
    }

    #[inline(always)]
    fn add_derivatives<W: Law<S, R>>(
        &self,
        at: (&B, &B::Placed),
        view: &Self::View,
        response: &Response<S, R>,
        damping: &mut SMatrix<S, D, D>,
        stiffness: &mut SMatrix<S, D, D>,
    ) {
        let gradient = &self.gradient(at, view);
        let swept = self.swept(at, view, gradient);
        let (impedance, places) = (&response.impedance, (&response.stiffness, gradient, W::PLACES));
        self.add_product(gradient, &Change { impedance, rates: gradient, by_place: None }, damping);
        self.add_product(gradient, &Change { impedance, rates: &swept, by_place: Some(places) }, stiffness);
        self.add_carried(at, view, gradient, &response.force, stiffness);
    }
}
