//! Contacts that share their laws.

use super::{Assembly, Bodies, Element, Elements, Law, Link};
use crate::{Scalar, mechanism::Way};

/// What is left of a law where its contact `C` is given.
pub trait Shape<C>: Copy {
    /// The law.
    type Law;

    /// The law of this shape with the `contact`.
    fn with(&self, contact: &C) -> Self::Law;
}

/// `N` elements of one kind whose laws share a `contact`: each a link that measures `R` numbers, and a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alike<C, L, G, const N: usize, const R: usize> {
    /// What they share.
    pub contact: C,
    /// What each measures, and its shape.
    pub each: [(L, G); N],
}

impl<C, L: Copy, G: Shape<C>, const N: usize, const R: usize> Alike<C, L, G, N, R> {
    /// The elements, one by one.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = Element<L, G::Law, R>> {
        self.each.iter().map(|(link, shape)| Element { link: *link, law: shape.with(&self.contact) })
    }
}

impl<S, B, C, L, G, const D: usize, const N: usize, const R: usize> Elements<S, B, D> for Alike<C, L, G, N, R>
where
    S: Scalar,
    B: Bodies<S, D>,
    L: Link<S, B, D, R> + Copy,
    G: Shape<C, Law: Law<S, R>>,
{
    type Internal = [<G::Law as Law<S, R>>::Internal; N];

    const STICKS: bool = G::Law::STICKS;

    #[inline(always)]
    fn fresh(&self) -> Self::Internal {
        self.each.each_ref().map(|(_, shape)| shape.with(&self.contact).fresh())
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
        for ((shifted, from), to) in shifted.iter_mut().zip(from).zip(to) {
            *shifted = G::Law::shifted(shifted, from, to, weight);
        }
        shifted
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &Self::Internal, kept: &mut Self::Internal) {
        for (kept, next) in kept.iter_mut().zip(next) {
            *kept = G::Law::or_old(next, condition, kept);
        }
    }
}
