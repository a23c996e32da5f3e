//! Elements: a link that measures and a law that answers.

use super::{Assembly, Bodies, Elements, Law, Link, law::DriveLaw};
use crate::{Scalar, mechanism::Way};

/// A law at a link that measures `R` lengths and angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element<L, W, const R: usize> {
    /// What it measures.
    pub link: L,
    /// What it answers.
    pub law: W,
}

crate::cast::cast!([L W] [R] Element: Element<L, W, R> => T Element<L::Of<T>, W::Of<T>, R> { link, law });

impl<L, W, const R: usize> Element<L, W, R> {
    /// What it sees and gives at time `t` (s) as a drive of bodies that are placed.
    #[inline(always)]
    pub fn driving<S: Scalar, B: Bodies<S, D>, const D: usize>(&self, t: S, at: (&B, &B::Placed)) -> Driving<S>
    where
        L: Link<S, B, D, R>,
        W: DriveLaw<S, R>,
    {
        let view = self.link.view(at.0, at.1);
        let speed = self.law.speed(&self.link.seen(at, &view).rate);
        Driving { speed, effort: self.law.effort(t, speed) }
    }
}

/// What a drive sees and gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Driving<S> {
    /// The speed that it goes by (m/s, or rad/s of one that turns).
    pub speed: S,
    /// Its force (N), or torque (N·m).
    pub effort: S,
}

impl<S: Scalar, B: Bodies<S, D>, L: Link<S, B, D, R>, W: Law<S, R>, const D: usize, const R: usize> Elements<S, B, D>
    for Element<L, W, R>
{
    type Internal = W::Internal;

    const STICKS: bool = W::STICKS;

    #[inline(always)]
    fn fresh(&self) -> W::Internal {
        self.law.fresh()
    }

    #[inline(always)]
    fn act(
        &self,
        (t, way): (S, Way<S>),
        at: (&B, &B::Placed),
        internal: &W::Internal,
        updated: Option<&mut W::Internal>,
        sum: &mut impl Assembly<S, B, D>,
    ) {
        let view = self.link.view(at.0, at.1);
        let seen = self.link.seen(at, &view);
        let (response, next) = self.law.response(t, &seen.place, &seen.rate, internal, way);
        if let Some(slot) = updated {
            *slot = next;
        }
        sum.add::<L, W, R>(&self.link, at, &view, &response);
    }

    #[inline(always)]
    fn remembered(&self, at: (&B, &B::Placed), internal: &W::Internal) -> W::Internal {
        W::remembered(&self.link.seen(at, &self.link.view(at.0, at.1)).place, internal)
    }

    #[inline(always)]
    fn shifted(&self, base: &W::Internal, from: &W::Internal, to: &W::Internal, weight: S) -> W::Internal {
        W::shifted(base, from, to, weight)
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &W::Internal, kept: &mut W::Internal) {
        *kept = W::or_old(next, condition, kept);
    }
}

impl<S: Scalar, B: Bodies<S, D>, const D: usize> Elements<S, B, D> for () {
    type Internal = ();

    const STICKS: bool = false;

    #[inline(always)]
    fn fresh(&self) {}

    #[inline(always)]
    fn act(&self, _: (S, Way<S>), _: (&B, &B::Placed), (): &(), _: Option<&mut ()>, _: &mut impl Assembly<S, B, D>) {}

    #[inline(always)]
    fn shifted(&self, (): &(), (): &(), (): &(), _: S) {}

    #[inline(always)]
    fn accept(&self, _: S, (): &(), (): &mut ()) {}
}

impl<S: Scalar, B: Bodies<S, D>, E: Elements<S, B, D>, F: Elements<S, B, D>, const D: usize> Elements<S, B, D>
    for (E, F)
{
    type Internal = (E::Internal, F::Internal);

    const STICKS: bool = E::STICKS || F::STICKS;

    #[inline(always)]
    fn fresh(&self) -> Self::Internal {
        (self.0.fresh(), self.1.fresh())
    }

    #[inline(always)]
    fn act(
        &self,
        way: (S, Way<S>),
        at: (&B, &B::Placed),
        internal: &Self::Internal,
        updated: Option<&mut Self::Internal>,
        sum: &mut impl Assembly<S, B, D>,
    ) {
        let (first, second) = match updated {
            Some((first, second)) => (Some(first), Some(second)),
            None => (None, None),
        };
        self.0.act(way, at, &internal.0, first, sum);
        self.1.act(way, at, &internal.1, second, sum);
    }

    #[inline(always)]
    fn remembered(&self, at: (&B, &B::Placed), internal: &Self::Internal) -> Self::Internal {
        (self.0.remembered(at, &internal.0), self.1.remembered(at, &internal.1))
    }

    #[inline(always)]
    fn shifted(&self, base: &Self::Internal, from: &Self::Internal, to: &Self::Internal, weight: S) -> Self::Internal {
        (self.0.shifted(&base.0, &from.0, &to.0, weight), self.1.shifted(&base.1, &from.1, &to.1, weight))
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &Self::Internal, kept: &mut Self::Internal) {
        self.0.accept(condition, &next.0, &mut kept.0);
        self.1.accept(condition, &next.1, &mut kept.1);
    }
}

impl<S: Scalar, B: Bodies<S, D>, E: Elements<S, B, D>, const D: usize, const N: usize> Elements<S, B, D> for [E; N] {
    type Internal = [E::Internal; N];

    const STICKS: bool = E::STICKS;

    #[inline(always)]
    fn fresh(&self) -> Self::Internal {
        self.each_ref().map(E::fresh)
    }

    #[inline(always)]
    fn act(
        &self,
        way: (S, Way<S>),
        at: (&B, &B::Placed),
        internal: &Self::Internal,
        updated: Option<&mut Self::Internal>,
        sum: &mut impl Assembly<S, B, D>,
    ) {
        let mut slots = updated.into_iter().flatten();
        for (element, internal) in self.iter().zip(internal) {
            element.act(way, at, internal, slots.next(), sum);
        }
    }

    #[inline(always)]
    fn remembered(&self, at: (&B, &B::Placed), internal: &Self::Internal) -> Self::Internal {
        let mut remembered = *internal;
        for (element, internal) in self.iter().zip(&mut remembered) {
            *internal = element.remembered(at, internal);
        }
        remembered
    }

    #[inline(always)]
    fn shifted(&self, base: &Self::Internal, from: &Self::Internal, to: &Self::Internal, weight: S) -> Self::Internal {
        let mut shifted = *base;
        for (((element, shifted), from), to) in self.iter().zip(&mut shifted).zip(from).zip(to) {
            *shifted = element.shifted(shifted, from, to, weight);
        }
        shifted
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &Self::Internal, kept: &mut Self::Internal) {
        for ((element, next), kept) in self.iter().zip(next).zip(kept) {
            element.accept(condition, next, kept);
        }
    }
}

/// Elements chosen at run time. They share their internal variables, of which each keeps its own, and remember places alone.
impl<S: Scalar, B: Bodies<S, D>, E: Elements<S, B, D, Internal: Default>, const D: usize> Elements<S, B, D> for &[E] {
    type Internal = E::Internal;

    const STICKS: bool = false;

    fn fresh(&self) -> E::Internal {
        E::Internal::default()
    }

    #[inline(always)]
    fn act(
        &self,
        way: (S, Way<S>),
        at: (&B, &B::Placed),
        internal: &E::Internal,
        updated: Option<&mut E::Internal>,
        sum: &mut impl Assembly<S, B, D>,
    ) {
        for element in *self {
            element.act(way, at, internal, None, sum);
        }
        if let Some(slot) = updated {
            *slot = self.remembered(at, internal);
        }
    }

    #[inline(always)]
    fn remembered(&self, at: (&B, &B::Placed), internal: &E::Internal) -> E::Internal {
        self.iter().fold(*internal, |internal, element| element.remembered(at, &internal))
    }

    #[inline(always)]
    fn shifted(&self, base: &E::Internal, from: &E::Internal, to: &E::Internal, weight: S) -> E::Internal {
        self.first().map_or(*base, |element| element.shifted(base, from, to, weight))
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &E::Internal, kept: &mut E::Internal) {
        if let Some(element) = self.first() {
            element.accept(condition, next, kept);
        }
    }
}
