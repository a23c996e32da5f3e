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
        spatial::{FreeBodies, Placed},
    },
};

use crate::{
    cast::cast_variants,
    closing::Approach,
    contact::{Laws, SlidingData},
    drive::AnyDrive,
    laws::{AnyNormal, AnySliding},
    real::Real,
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

/// [`act`] in a function of its own, of what is seldom asked for and would be compiled into every mechanism. Nothing on lanes, see
/// [`PlanarElement::runs_on_lanes`].
#[inline(always)]
fn act_apart<S, B, L, W, const D: usize, const R: usize>(
    element: &Element<L, W, R>,
    way: (S, Way<S>),
    at: (&B, &B::Placed),
    sum: &mut impl Assembly<S, B, D>,
) where
    S: Real,
    B: Bodies<S, D>,
    L: Link<S, B, D, R>,
    W: Law<S, R, Internal = ()>,
{
    if S::UNITS == 1 {
        act_out_of_line(element, way, at, sum);
    }
}

#[inline(never)]
fn act_out_of_line<S, B, L, W, const D: usize, const R: usize>(
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

/// Elements that may be contacts.
pub trait HasContacts<S: Scalar, B: Bodies<S, D>, const D: usize>: Elements<S, B, D> {
    /// Shows `see` the contacts that it is.
    fn approach(&self, at: (&B, &B::Placed), see: &mut impl FnMut(Approach<S>));
}

impl<S: Scalar, B: Bodies<S, D>, const D: usize> HasContacts<S, B, D> for () {
    fn approach(&self, _: (&B, &B::Placed), _: &mut impl FnMut(Approach<S>)) {}
}

/// Bodies that turn.
pub trait AngularSpeeds<S: Scalar, const D: usize>: Bodies<S, D> {
    /// The greatest angular velocity (rad/s) of a body that is `placed`.
    fn max_angular_speed(&self, placed: &Self::Placed) -> S;
}

impl<S: Real, const D: usize> AngularSpeeds<S, D> for PlanarTree<S, D> {
    #[inline(always)]
    fn max_angular_speed(&self, placed: &planar::Placed<S, D>) -> S {
        let mut most = S::zero();
        for (kind, rate) in self.topology().iter().zip(&placed.rates) {
            if *kind == planar::Kind::Turn {
                most = rate.magnitude().max_of(most);
            }
        }
        most
    }
}

impl<const N: usize, const D: usize> AngularSpeeds<f64, D> for FreeBodies<f64, N, D> {
    fn max_angular_speed(&self, placed: &Placed<f64, N>) -> f64 {
        placed.bodies.iter().fold(0.0, |most, body| most.max(body.rotation_w.norm()))
    }
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
    let mut speed = S::zero();
    for rate in &seen.rate {
        speed += rate.max_of(-*rate);
    }
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
type AnyContouredPad<S> = Contoured<S, Pad<S, AnyNormal<S>, AnySliding<S>>>;

/// An element in a plane. A number `S` has a value for each of several units, or is one.
#[derive(Clone, Debug, PartialEq)]
pub enum PlanarElement<const D: usize, S = f64> {
    /// A hole around a pin.
    Journal(Element<planar::Between<S, D>, Journal<S, AnyNormal<S>, AnySliding<S>>, 4>),
    /// A point before a line.
    Pad(Element<planar::Across<S, D>, Pad<S, AnyNormal<S>, AnySliding<S>>, 2>),
    /// A torsion spring, and the angles (rad) at which its two bodies start.
    Spring((Element<planar::Turning, Spring<S>, 1>, [S; 2])),
    /// A torque.
    Motor(Element<planar::Turning, Motor<AnyDrive<S>>, 1>),
    /// A force.
    Pusher(Element<planar::Along<S, D>, Pusher<AnyDrive<S>>, 2>),
    /// A point before a line with a contour.
    Contour(Element<planar::Across<S, D>, AnyContouredPad<S>, 2>),
    /// A spring along the line between two points.
    Line(Element<planar::Between<S, D>, LineSpring<S, 2>, 4>),
}

cast_variants!([D] PlanarElement: PlanarElement<D> => T PlanarElement<D, T> {
    Journal, Pad, Spring, Motor, Pusher, Contour, Line
});

/// Bodies in a plane, and where they are.
type Planar<'a, S, const D: usize> = (&'a PlanarTree<S, D>, &'a planar::Placed<S, D>);

impl<const D: usize> PlanarElement<D> {
    /// Whether several units with this element can be integrated at a time. Line springs and contoured walls are not compiled for lanes;
    /// commands other than a ramp and Stribeck friction would be slower there than one by one.
    pub fn runs_on_lanes(&self) -> bool {
        let by_coulomb = |contact: &AnyContact| !matches!(contact.friction, AnySliding::Stribeck(_));
        let by_ramp =
            |drive: &AnyDrive| matches!(drive, AnyDrive::Ramp(_) | AnyDrive::RampTrain(_) | AnyDrive::Friction(_));
        match self {
            Self::Journal(element) => by_coulomb(&element.law.contact),
            Self::Pad(element) => by_coulomb(&element.law.contact),
            Self::Motor(element) => by_ramp(&element.law.0),
            Self::Pusher(element) => by_ramp(&element.law.0),
            Self::Spring(_) => true,
            Self::Contour(_) | Self::Line(_) => false,
        }
    }

    /// The gap (m) of the contact that it is, if it is one.
    pub fn gap(&self, at: Planar<f64, D>) -> Option<f64> {
        match self {
            Self::Journal(element) => gap(element, at),
            Self::Pad(element) => gap(element, at),
            Self::Contour(element) => gap(element, at),
            Self::Spring(_) | Self::Motor(_) | Self::Pusher(_) | Self::Line(_) => None,
        }
    }
}

impl<const D: usize, S: Real> HasContacts<S, PlanarTree<S, D>, D> for PlanarElement<D, S> {
    #[inline(always)]
    fn approach(&self, at: Planar<S, D>, see: &mut impl FnMut(Approach<S>)) {
        match self {
            Self::Journal(element) => approach((element, &element.law.contact.normal), at, see),
            Self::Pad(element) => approach((element, &element.law.contact.normal), at, see),
            Self::Contour(element) => approach((element, &element.law.wall.contact.normal), at, see),
            Self::Spring(_) | Self::Motor(_) | Self::Pusher(_) | Self::Line(_) => {}
        }
    }
}

/// How far (rad) turning coordinates have turned since the start, with their whole turns, as far as springs look at them; 0 of others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angles<const D: usize, S = f64>([S; D]);

impl<const D: usize, S: Real> Default for Angles<D, S> {
    fn default() -> Self {
        Self([S::zero(); D])
    }
}

impl<const D: usize, S: Real> Angles<D, S> {
    /// How far a coordinate has; 0 for the frame.
    fn of(&self, turn: Option<usize>) -> S {
        turn.map_or(S::zero(), |k| self.0[k])
    }
}

impl<const D: usize, S: Real> Elements<S, PlanarTree<S, D>, D> for PlanarElement<D, S> {
    type Internal = Angles<D, S>;

    const STICKS: bool = false;

    fn fresh(&self) -> Angles<D, S> {
        Angles::default()
    }

    #[inline(always)]
    fn act(
        &self,
        way: (S, Way<S>),
        at: (&PlanarTree<S, D>, &planar::Placed<S, D>),
        angles: &Angles<D, S>,
        _: Option<&mut Angles<D, S>>,
        sum: &mut impl Assembly<S, PlanarTree<S, D>, D>,
    ) {
        match self {
            Self::Journal(element) => act(element, way, at, &(), sum),
            Self::Pad(element) => act(element, way, at, &(), sum),
            Self::Spring((element, _)) => {
                let planar::Turning { body, against } = element.link;
                act(element, way, at, &(element.law.start + angles.of(body) - angles.of(against)), sum);
            }
            Self::Motor(element) => act(element, way, at, &(), sum),
            Self::Pusher(element) => act(element, way, at, &(), sum),
            Self::Contour(element) => act_apart(element, way, at, sum),
            Self::Line(element) => act_apart(element, way, at, sum),
        }
    }

    #[inline(always)]
    fn remembered(&self, (_, placed): Planar<S, D>, angles: &Angles<D, S>) -> Angles<D, S> {
        let mut next = *angles;
        if let Self::Spring((Element { link: planar::Turning { body, against }, .. }, starts)) = self {
            for (turn, start) in [body, against].into_iter().zip(starts) {
                if let Some(k) = *turn {
                    let angle = placed.axes[k].y.zip_map(placed.axes[k].x, libm::atan2);
                    next.0[k] = angle.zip_map(*start + angles.0[k], next_to) - *start;
                }
            }
        }
        next
    }

    fn shifted(&self, base: &Angles<D, S>, from: &Angles<D, S>, to: &Angles<D, S>, weight: S) -> Angles<D, S> {
        Angles(std::array::from_fn(|k| base.0[k] + (to.0[k] - from.0[k]) * weight))
    }

    #[inline(always)]
    fn accept(&self, condition: S, next: &Angles<D, S>, kept: &mut Angles<D, S>) {
        for (kept, next) in kept.0.iter_mut().zip(next.0) {
            *kept = next.or_old(condition, *kept);
        }
    }
}

/// `angle` (rad) by so many turns that it is next to `last`.
pub fn next_to(angle: f64, last: f64) -> f64 {
    angle + TAU * ((last - angle) / TAU).round()
}
