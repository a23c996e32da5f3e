//! Elements of a mechanism, with those of a kind that stand side by side at the desk.

use slipfit_core::{
    Cast, Scalar,
    mechanism::Way,
    system::{Assembly, Bodies, Elements, LANES},
};

/// Elements `E`, and contacts `C` that are added up by the lanes in which they stand side by side. Numbers are one, or one for each unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Grouped<C, E> {
    /// The contacts of each lane.
    pub lanes: [Vec<C>; LANES],
    /// Those that stand in no lane.
    pub rest: Vec<E>,
}

impl<E> Grouped<(), E> {
    /// Elements of which none stand side by side.
    pub fn none(elements: Vec<E>) -> Self {
        Self { lanes: Default::default(), rest: elements }
    }
}

impl<C: Cast, E: Cast> Cast for Grouped<C, E> {
    type Of<T: Scalar> = Grouped<C::Of<T>, E::Of<T>>;

    fn cast<T: Scalar>(&self, number: &mut impl FnMut(f64) -> T) -> Self::Of<T> {
        Grouped {
            lanes: self.lanes.each_ref().map(|lane| lane.iter().map(|one| one.cast(number)).collect()),
            rest: self.rest.iter().map(|one| one.cast(number)).collect(),
        }
    }
}

impl<S: Scalar, B: Bodies<S, D>, C, E, const D: usize> Elements<S, B, D> for Grouped<C, E>
where
    C: Elements<S, B, D, Internal = ()>,
    E: Elements<S, B, D, Internal: Default>,
{
    type Internal = E::Internal;

    const STICKS: bool = E::STICKS;

    fn fresh(&self) -> E::Internal {
        self.rest.first().map_or_else(Default::default, E::fresh)
    }

    #[inline(always)]
    fn act(
        &self,
        way: (S, Way<S>),
        at: (&B, &B::Placed),
        internal: &E::Internal,
        _: Option<&mut E::Internal>,
        sum: &mut impl Assembly<S, B, D>,
    ) {
        if size_of::<C>() > 0 {
            sum.add_by_lane(&self.lanes.each_ref().map(|lane| &lane[..]), way, at);
        }
        for element in &self.rest {
            element.act(way, at, internal, None, sum);
        }
    }

    #[inline(always)]
    fn remembered(&self, at: (&B, &B::Placed), internal: &E::Internal) -> E::Internal {
        self.rest.iter().fold(*internal, |internal, element| element.remembered(at, &internal))
    }

    fn shifted(&self, base: &E::Internal, from: &E::Internal, to: &E::Internal, weight: S) -> E::Internal {
        self.rest.first().map_or(*base, |element| element.shifted(base, from, to, weight))
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &E::Internal, kept: &mut E::Internal) {
        if let Some(element) = self.rest.first() {
            element.accept(condition, next, kept);
        }
    }
}
