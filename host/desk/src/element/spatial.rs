//! Elements in space, chosen at run time.

use nalgebra::Matrix3;
use slipfit_core::{
    Scalar,
    mechanism::Way,
    system::{
        Assembly, Bodies, Element, Elements,
        law::{Contoured, LineSpring, Motor, Pin, Pusher, Ring, Wall},
        spatial::{About, Along, AtPoint, FreeBodies, Rim, Seat},
    },
};

use super::{HasContacts, act, act_apart, approach, gap};
use crate::{
    closing::Approach,
    drive::AnyDrive,
    laws::{AnyNormal, AnySliding},
};

/// A wall with a contour and any laws.
type AnyContouredWall = Contoured<f64, Wall<f64, AnyNormal<f64>, AnySliding<f64>>>;

/// A ring around a rod whose axes are turned or not.
type AnyRing<S> = Element<Rim<S, Option<Matrix3<S>>>, Ring<S, AnyNormal<S>, AnySliding<S>>, 3>;

/// A contact in space, or several side by side: a number `S` has a value for each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpatialContact<S = f64> {
    /// A pin between walls.
    Pin(Element<Seat<S>, Pin<S, AnyNormal<S>, AnySliding<S>>, 3>),
    /// A point before a wall.
    Wall(Element<Seat<S>, Wall<S, AnyNormal<S>, AnySliding<S>>, 3>),
    /// A ring around a rod whose axes are turned or not.
    Ring(AnyRing<S>),
}

/// An element in space.
#[derive(Clone, Debug, PartialEq)]
pub enum SpatialElement {
    /// A contact.
    Contact(SpatialContact),
    /// A torque.
    Motor(Element<About<f64>, Motor<AnyDrive>, 1>),
    /// A force.
    Pusher(Element<Along<f64>, Pusher<AnyDrive>, 2>),
    /// A force by the speed where it acts.
    AtPoint(Element<AtPoint<f64>, Motor<AnyDrive>, 1>),
    /// A point before a wall with a contour.
    Contour(Element<Seat<f64>, AnyContouredWall, 3>),
    /// A spring along the line between two points.
    Line(Element<Seat<f64>, LineSpring<f64, 3>, 3>),
}

/// Bodies in space, and where they are.
type Free<'a, S, const N: usize, const D: usize> =
    (&'a FreeBodies<S, N, D>, &'a <FreeBodies<S, N, D> as Bodies<S, D>>::Placed);

impl SpatialElement {
    /// The gap (m) of the contact that it is, if it is one.
    pub fn gap<const N: usize, const D: usize>(&self, at: Free<f64, N, D>) -> Option<f64> {
        match self {
            Self::Contact(SpatialContact::Pin(element)) => gap(element, at),
            Self::Contact(SpatialContact::Wall(element)) => gap(element, at),
            Self::Contact(SpatialContact::Ring(element)) => gap(element, at),
            Self::Contour(element) => gap(element, at),
            Self::Motor(_) | Self::Pusher(_) | Self::AtPoint(_) | Self::Line(_) => None,
        }
    }
}

impl<const N: usize, const D: usize> HasContacts<f64, FreeBodies<f64, N, D>, D> for SpatialElement {
    fn approach(&self, at: Free<f64, N, D>, see: &mut impl FnMut(Approach)) {
        match self {
            Self::Contact(contact) => contact.approach(at, see),
            Self::Contour(element) => approach((element, &element.law.wall.contact.normal), at, see),
            Self::Motor(_) | Self::Pusher(_) | Self::AtPoint(_) | Self::Line(_) => {}
        }
    }
}

impl<S: Scalar + PartialOrd, const N: usize, const D: usize> HasContacts<S, FreeBodies<S, N, D>, D>
    for SpatialContact<S>
{
    #[inline(always)]
    fn approach(&self, at: Free<S, N, D>, see: &mut impl FnMut(Approach<S>)) {
        match self {
            Self::Pin(element) => approach((element, &element.law.contact.normal), at, see),
            Self::Wall(element) => approach((element, &element.law.contact.normal), at, see),
            Self::Ring(element) => approach((element, &element.law.contact.normal), at, see),
        }
    }
}

impl<S: Scalar + PartialOrd, const N: usize, const D: usize> Elements<S, FreeBodies<S, N, D>, D> for SpatialContact<S> {
    type Internal = ();

    const STICKS: bool = false;

    fn fresh(&self) {}

    #[inline(always)]
    fn act(
        &self,
        way: (S, Way<S>),
        at: (&FreeBodies<S, N, D>, &<FreeBodies<S, N, D> as Bodies<S, D>>::Placed),
        (): &(),
        _: Option<&mut ()>,
        sum: &mut impl Assembly<S, FreeBodies<S, N, D>, D>,
    ) {
        match self {
            Self::Pin(element) => act(element, way, at, &[(); 2], sum),
            Self::Wall(element) => act(element, way, at, &(), sum),
            Self::Ring(element) => act(element, way, at, &(), sum),
        }
    }

    fn shifted(&self, (): &(), (): &(), (): &(), _: S) {}

    fn accept(&self, _: S, (): &(), (): &mut ()) {}
}

impl<const N: usize, const D: usize> Elements<f64, FreeBodies<f64, N, D>, D> for SpatialElement {
    type Internal = ();

    const STICKS: bool = false;

    fn fresh(&self) {}

    #[inline(always)]
    fn act(
        &self,
        way: (f64, Way<f64>),
        at: (&FreeBodies<f64, N, D>, &<FreeBodies<f64, N, D> as Bodies<f64, D>>::Placed),
        (): &(),
        _: Option<&mut ()>,
        sum: &mut impl Assembly<f64, FreeBodies<f64, N, D>, D>,
    ) {
        match self {
            // Inlined: a call from wide instructions costs more than what these do.
            Self::Contact(contact) => contact.act(way, at, &(), None, sum),
            Self::Motor(element) => act(element, way, at, &(), sum),
            Self::Pusher(element) => act(element, way, at, &(), sum),
            Self::AtPoint(element) => act(element, way, at, &(), sum),
            Self::Contour(element) => act_apart(element, way, at, sum),
            Self::Line(element) => act_apart(element, way, at, sum),
        }
    }

    fn shifted(&self, (): &(), (): &(), (): &(), _: f64) {}

    fn accept(&self, _: f64, (): &(), (): &mut ()) {}
}
