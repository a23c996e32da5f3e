//! Elements chosen at run time: the laws and links are core's, and so are the bits.

mod spatial;

use std::f64::consts::TAU;

use slipfit_core::{
    ParameterError, Scalar,
    law::{Regularised, Stribeck, StribeckData},
    mechanism::Way,
    menu::FrictionData,
    system::{
        Assembly, Bodies, Element, Elements, Law, Link,
        law::{Contact, Contoured, Journal, LineSpring, Motor, Pad, Pusher, Spring},
        planar::{self, PlanarTree},
    },
};

use crate::{
    closing::Approach,
    contact::{Laws, SlidingData},
    drive::AnyDrive,
    laws::{AnyNormal, AnySliding},
};

pub use spatial::{SpatialContact, SpatialElement};

/// Over how many stick bands static friction falls halfway to kinetic where a stick band is used in place of true stick: at the end of
/// the band a thousandth of their difference is lost.
const DROP: f64 = 33.0;

/// The least stick band (m/s) in place of true stick with such a fall. On a steeper fall implicit steps are stable where the motion is not,
/// so that a body which has broken away would seem to stick.
const LEAST_BAND: f64 = 3e-7;

/// Any contact without internal variables.
pub type AnyContact<S = f64> = Contact<AnyNormal<S>, AnySliding<S>>;

/// The contact of `laws`; the `stick_band` (m/s) is used in place of true stick.
///
/// # Errors
/// [`ParameterError`] names the parameter that is not finite or out of bounds.
pub fn contact<S: Scalar + PartialOrd>(laws: &Laws, stick_band: f64) -> Result<AnyContact<S>, ParameterError<S>> {
    let normal = AnyNormal::new(&laws.contact)?;
    let number = S::from_f64;
    let regularised =
        |coefficient, band| Ok(AnySliding::Regularised(Regularised::new(number(coefficient), number(band))?));
    let stribeck = |data: StribeckData<f64>| {
        let StribeckData { at_rest, kinetic, stribeck_speed, viscous, stick_band } = data;
        let [at_rest, kinetic] = [at_rest, kinetic].map(number);
        let [stribeck_speed, viscous, stick_band] = [stribeck_speed, viscous, stick_band].map(number);
        let data = StribeckData { at_rest, kinetic, stribeck_speed, viscous, stick_band };
        Ok(AnySliding::Stribeck(Stribeck::new(data)?))
    };
    let friction = match laws.friction {
        SlidingData::Coulomb(FrictionData::None) => AnySliding::Frictionless,
        SlidingData::Coulomb(FrictionData::Regularised { coefficient, stick_band }) => {
            regularised(coefficient, stick_band)?
        }
        SlidingData::Coulomb(FrictionData::Exact { coefficient }) => regularised(coefficient, stick_band)?,
        SlidingData::Stribeck(data) => stribeck(data)?,
        SlidingData::StaticKinetic { at_rest, kinetic } => {
            let stick_band = stick_band.max(LEAST_BAND);
            let stribeck_speed = DROP * stick_band;
            stribeck(StribeckData { at_rest, kinetic, stribeck_speed, viscous: 0.0, stick_band })?
        }
    };
    Ok(Contact { normal, friction })
}

/// What an `element` with the given `internal` variables does, without a look at laws and derivatives of contacts that are open. The kernel,
/// whose steps all take the same number of instructions, must not choose so. A zero less in a sum changes at most the sign of a zero.
#[inline(always)]
fn act<S, B, L, W, const D: usize, const R: usize>(
    element: &Element<L, W, R>,
    (t, way): (S, Way<S>),
    at: (&B, &B::Placed),
    internal: &W::Internal,
    sum: &mut impl Assembly<S, B, D>,
) where
    S: Scalar + PartialOrd,
    B: Bodies<S, D>,
    L: Link<S, B, D, R>,
    W: Law<S, R>,
{
    let Element { link, law } = element;
    let view = link.view(at.0, at.1);
    let seen = link.seen(at, &view);
    if law.gap(&seen.place) > S::zero() {
        return;
    }
    let (response, _) = law.response(t, &seen.place, &seen.rate, internal, way);
    sum.add::<L, W, R>(link, at, &view, &response);
}

/// [`act`] in a function of its own.
#[inline(never)]
fn act_apart<S, B, L, W, const D: usize, const R: usize>(
    element: &Element<L, W, R>,
    way: (S, Way<S>),
    at: (&B, &B::Placed),
    sum: &mut impl Assembly<S, B, D>,
) where
    S: Scalar + PartialOrd,
    B: Bodies<S, D>,
    L: Link<S, B, D, R>,
    W: Law<S, R, Internal = ()>,
{
    act(element, way, at, &(), sum);
}

/// The gap (m) of a contact, which is negative where it is pressed together.
fn gap<B: Bodies<f64, D>, L: Link<f64, B, D, R>, W: Law<f64, R>, const D: usize, const R: usize>(
    element: &Element<L, W, R>,
    at: (&B, &B::Placed),
) -> Option<f64> {
    let view = element.link.view(at.0, at.1);
    Some(element.law.gap(&element.link.seen(at, &view).place))
}

/// The most contacts of an element.
const MOST_WALLS: usize = 4;

/// Shows `see` the contacts of an `element` with the `normal` law.
#[inline(always)]
fn approach<
    S: Scalar + PartialOrd,
    B: Bodies<S, D>,
    L: Link<S, B, D, R>,
    W: Law<S, R>,
    const D: usize,
    const R: usize,
>(
    (Element { link, law }, normal): (&Element<L, W, R>, &AnyNormal<S>),
    at: (&B, &B::Placed),
    see: &mut impl FnMut(Approach<S>),
) {
    let seen = link.seen(at, &link.view(at.0, at.1));
    // No less than the length of the rate.
    let speed = seen.rate.iter().fold(S::zero(), |sum, rate| sum + rate.max_of(-*rate));
    let (mut walls, mut count) = ([(S::zero(), S::zero()); MOST_WALLS], 0);
    law.each_gap(&seen.place, &seen.rate, |gap, rate| {
        walls[count] = (gap, rate);
        count += 1;
    });
    for (gap, rate) in &walls[..count] {
        see(Approach::new(*gap, *rate, speed, normal));
    }
}

/// A line with a contour and any laws.
type AnyContouredPad = Contoured<f64, Pad<f64, AnyNormal<f64>, AnySliding<f64>>>;

/// An element in a plane.
#[derive(Clone, Debug, PartialEq)]
pub enum PlanarElement<const D: usize> {
    /// A hole around a pin.
    Journal(Element<planar::Between<f64, D>, Journal<f64, AnyNormal<f64>, AnySliding<f64>>, 4>),
    /// A point before a line.
    Pad(Element<planar::Across<f64, D>, Pad<f64, AnyNormal<f64>, AnySliding<f64>>, 2>),
    /// A torsion spring, and the angles (rad) at which its two bodies start.
    Spring(Element<planar::Turning, Spring<f64>, 1>, [f64; 2]),
    /// A torque.
    Motor(Element<planar::Turning, Motor<AnyDrive>, 1>),
    /// A force.
    Pusher(Element<planar::Along<f64, D>, Pusher<AnyDrive>, 2>),
    /// A point before a line with a contour.
    Contour(Element<planar::Across<f64, D>, AnyContouredPad, 2>),
    /// A spring along the line between two points.
    Line(Element<planar::Between<f64, D>, LineSpring<f64, 2>, 4>),
}

impl<const D: usize> PlanarElement<D> {
    /// The gap (m) of the contact that it is, if it is one.
    pub fn gap(&self, at: (&PlanarTree<f64, D>, &<PlanarTree<f64, D> as Bodies<f64, D>>::Placed)) -> Option<f64> {
        match self {
            Self::Journal(element) => gap(element, at),
            Self::Pad(element) => gap(element, at),
            Self::Contour(element) => gap(element, at),
            Self::Spring(..) | Self::Motor(_) | Self::Pusher(_) | Self::Line(_) => None,
        }
    }

    /// Shows `see` the contacts that it is.
    pub fn approach(
        &self,
        at: (&PlanarTree<f64, D>, &<PlanarTree<f64, D> as Bodies<f64, D>>::Placed),
        see: &mut impl FnMut(Approach),
    ) {
        match self {
            Self::Journal(element) => approach((element, &element.law.contact.normal), at, see),
            Self::Pad(element) => approach((element, &element.law.contact.normal), at, see),
            Self::Contour(element) => approach((element, &element.law.wall.contact.normal), at, see),
            Self::Spring(..) | Self::Motor(_) | Self::Pusher(_) | Self::Line(_) => {}
        }
    }
}

/// How far (rad) turning coordinates have turned since the start, with their whole turns, as far as springs look at them; 0 of others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angles<const D: usize>([f64; D]);

impl<const D: usize> Default for Angles<D> {
    fn default() -> Self {
        Self([0.0; D])
    }
}

impl<const D: usize> Angles<D> {
    /// How far a coordinate has; 0 for the frame.
    fn of(&self, turn: Option<usize>) -> f64 {
        turn.map_or(0.0, |k| self.0[k])
    }
}

impl<const D: usize> Elements<f64, PlanarTree<f64, D>, D> for PlanarElement<D> {
    type Internal = Angles<D>;

    const STICKS: bool = false;

    fn fresh(&self) -> Angles<D> {
        Angles::default()
    }

    #[inline(always)]
    fn act(
        &self,
        way: (f64, Way<f64>),
        at: (&PlanarTree<f64, D>, &planar::Placed<f64, D>),
        angles: &Angles<D>,
        _: Option<&mut Angles<D>>,
        sum: &mut impl Assembly<f64, PlanarTree<f64, D>, D>,
    ) {
        match self {
            Self::Journal(element) => act(element, way, at, &(), sum),
            Self::Pad(element) => act(element, way, at, &(), sum),
            Self::Spring(element, _) => {
                let planar::Turning { body, against } = element.link;
                act(element, way, at, &(element.law.start + angles.of(body) - angles.of(against)), sum);
            }
            Self::Motor(element) => act(element, way, at, &(), sum),
            Self::Pusher(element) => act(element, way, at, &(), sum),
            // Out of line: seldom asked for, they would be compiled into every mechanism.
            Self::Contour(element) => act_apart(element, way, at, sum),
            Self::Line(element) => act_apart(element, way, at, sum),
        }
    }

    fn remembered(&self, (_, placed): (&PlanarTree<f64, D>, &planar::Placed<f64, D>), angles: &Angles<D>) -> Angles<D> {
        let mut next = *angles;
        if let Self::Spring(Element { link: planar::Turning { body, against }, .. }, starts) = self {
            for (turn, start) in [body, against].into_iter().zip(starts) {
                if let Some(k) = *turn {
                    let angle = libm::atan2(placed.axes[k].y, placed.axes[k].x);
                    next.0[k] = next_to(angle, start + angles.0[k]) - start;
                }
            }
        }
        next
    }

    fn shifted(&self, base: &Angles<D>, from: &Angles<D>, to: &Angles<D>, weight: f64) -> Angles<D> {
        Angles(std::array::from_fn(|k| base.0[k] + (to.0[k] - from.0[k]) * weight))
    }

    fn accept(&self, condition: f64, next: &Angles<D>, kept: &mut Angles<D>) {
        for (kept, next) in kept.0.iter_mut().zip(next.0) {
            *kept = next.or_old(condition, *kept);
        }
    }
}

/// `angle` (rad) by so many turns that it is next to `last`.
pub fn next_to(angle: f64, last: f64) -> f64 {
    angle + TAU * ((last - angle) / TAU).round()
}
