//! Contact laws chosen at run time, for fixed steps at the desk: one type for every scene instead of one for each
//! combination of laws, scheme and number type. The laws themselves are core's, and so are the bits.

use slipfit_core::{
    ParameterError, Scalar,
    law::{
        Elastic, Exact, Friction, Frictionless, HuntCrossley, Impact, LankaraniNikravesh, Linear, Normal,
        NormalResponse, Power, Regularised, Stribeck, ThreeHalves,
        friction::{SlidingContact, Traction},
    },
    menu::{ContactData, FrictionData, FrictionType, NormalType, SlideData},
    slide::Slide,
};

use crate::{
    cast::cast_variants,
    contact::{NormalData, Rebound},
};

/// Any elastic law of the menu.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnyElastic<S> {
    /// e = 1.
    Linear(Linear<S>),
    /// e = 3/2.
    ThreeHalves(ThreeHalves<S>),
    /// Any other exponent.
    Power(Power<S>),
}

impl<S: Scalar + PartialOrd> AnyElastic<S> {
    /// The cheapest law that covers `contact`.
    ///
    /// # Errors
    /// [`ParameterError`] names the parameter that is not finite or out of bounds.
    pub fn new(contact: &ContactData<S>) -> Result<Self, ParameterError<S>> {
        Self::of(contact.stiffness, contact.exponent)
    }

    /// The cheapest law of `stiffness` k (N/m^e) and `exponent` e.
    ///
    /// # Errors
    /// [`ParameterError`] names the parameter that is not finite or out of bounds.
    pub fn of(stiffness: S, exponent: S) -> Result<Self, ParameterError<S>> {
        Ok(match NormalType::of(exponent) {
            NormalType::Linear => Self::Linear(Linear::new(stiffness)?),
            NormalType::ThreeHalves => Self::ThreeHalves(ThreeHalves::new(stiffness)?),
            NormalType::Power => Self::Power(Power::new(stiffness, exponent)?),
        })
    }
}

impl<S: Scalar> Elastic<S> for AnyElastic<S> {
    #[inline(always)]
    fn force(&self, depth: S) -> (S, S) {
        match self {
            Self::Linear(law) => law.force(depth),
            Self::ThreeHalves(law) => law.force(depth),
            Self::Power(law) => powered(law, depth),
        }
    }

    fn energy(&self, depth: S) -> S {
        match self {
            Self::Linear(law) => law.energy(depth),
            Self::ThreeHalves(law) => law.energy(depth),
            Self::Power(law) => law.energy(depth),
        }
    }
}

/// The force of a general exponent and its slope, in a function of its own: it is long, seldom asked for, and would be compiled into
/// every element of every mechanism.
#[inline(never)]
fn powered<S: Scalar>(law: &Power<S>, depth: S) -> (S, S) {
    law.force(depth)
}

cast_variants!([] AnyElastic: AnyElastic<f64> => T AnyElastic<T> { Linear, ThreeHalves, Power });

/// Any law along a contact's normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnyNormal<S> {
    /// A spring and a damper that fades in with depth.
    Impact(Impact<S, AnyElastic<S>>),
    /// Hunt and Crossley's.
    HuntCrossley(HuntCrossley<S, AnyElastic<S>>),
    /// Lankarani and Nikravesh's.
    LankaraniNikravesh(LankaraniNikravesh<S, AnyElastic<S>>),
}

cast_variants!([] AnyNormal: AnyNormal<f64> => T AnyNormal<T> { Impact, HuntCrossley, LankaraniNikravesh });

impl<S: Scalar + PartialOrd> AnyNormal<S> {
    /// The law of `data`.
    ///
    /// # Errors
    /// [`ParameterError`] names the parameter that is not finite or out of bounds.
    pub fn new(data: &NormalData) -> Result<Self, ParameterError<S>> {
        let number = S::from_f64;
        let [stiffness, exponent] = data.spring().map(number);
        let spring = AnyElastic::of(stiffness, exponent)?;
        Ok(match *data {
            NormalData::Impact(data) => Self::Impact(Impact::new(spring, number(data.damping), number(data.depth))?),
            NormalData::HuntCrossley(Rebound { restitution, speed, .. }) => {
                Self::HuntCrossley(HuntCrossley::new(spring, number(restitution), number(speed))?)
            }
            NormalData::LankaraniNikravesh(Rebound { restitution, speed, .. }) => {
                Self::LankaraniNikravesh(LankaraniNikravesh::new(spring, number(restitution), number(speed))?)
            }
        })
    }
}

impl<S: Scalar> Normal<S> for AnyNormal<S> {
    #[inline(always)]
    fn response(&self, penetration: S, rate: S) -> NormalResponse<S> {
        match self {
            Self::Impact(law) => law.response(penetration, rate),
            Self::HuntCrossley(law) => law.response(penetration, rate),
            Self::LankaraniNikravesh(law) => law.response(penetration, rate),
        }
    }

    fn energy(&self, penetration: S) -> S {
        match self {
            Self::Impact(law) => law.energy(penetration),
            Self::HuntCrossley(law) => law.energy(penetration),
            Self::LankaraniNikravesh(law) => law.energy(penetration),
        }
    }
}

/// Any friction law without internal variables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnySliding<S> {
    /// None.
    Frictionless,
    /// Regularised Coulomb friction.
    Regularised(Regularised<S>),
    /// Friction with a static and a kinetic coefficient and a viscous part.
    Stribeck(Stribeck<S>),
}

cast_variants!([] AnySliding: AnySliding<f64> => T AnySliding<T> { Regularised, Stribeck; Frictionless });

/// The traction of Stribeck friction, in a function of its own: it is seldom asked for, and would be compiled into every contact.
#[inline(never)]
fn measured<S: Scalar>(law: &Stribeck<S>, contact: &SlidingContact<S>) -> Traction<S> {
    law.traction(&(), contact).0
}

impl<S: Scalar> Friction<S> for AnySliding<S> {
    type Internal = ();

    const STICKS: bool = false;

    fn fresh() {}

    #[inline(always)]
    fn traction(&self, (): &(), contact: &SlidingContact<S>) -> (Traction<S>, ()) {
        match self {
            Self::Frictionless => Frictionless.traction(&(), contact),
            Self::Regularised(law) => law.traction(&(), contact),
            Self::Stribeck(law) => (measured(law, contact), ()),
        }
    }

    fn shifted((): &(), (): &(), (): &(), _: S) {}

    fn or_old((): &(), _: S, (): &()) {}
}

/// A slide without true stick, whose laws were chosen at run time. The paper's laws have a type of their own, as fast as
/// firmware's: a choice within each contact makes a step more than twice as slow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SlidingSlide<S> {
    /// The paper's laws: exponent 3/2, regularised Coulomb friction.
    Usual(Slide<S, ThreeHalves<S>, Regularised<S>>),
    /// Any others.
    Chosen(Slide<S, AnyElastic<S>, AnySliding<S>>),
}

/// A slide with true stick, likewise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StickingSlide<S> {
    /// Exponent 3/2.
    Usual(Slide<S, ThreeHalves<S>, Exact<S>>),
    /// Any other.
    Chosen(Slide<S, AnyElastic<S>, Exact<S>>),
}

/// A slide whose laws were chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnySlide<S> {
    /// Without true stick.
    Sliding(SlidingSlide<S>),
    /// With true stick.
    Sticking(StickingSlide<S>),
}

impl<S: Scalar + PartialOrd> SlidingSlide<S> {
    /// The slide that `data` describes, true stick stood for by a `stick_band` (m/s).
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn new(data: &SlideData<S>, stick_band: S) -> Result<Self, ParameterError<S>> {
        let SlideData { body, contact, friction, drive } = *data;
        let friction = match (friction.friction_type(), friction) {
            (FrictionType::Regularised, FrictionData::Regularised { coefficient, stick_band }) => {
                AnySliding::Regularised(Regularised::new(coefficient, stick_band)?)
            }
            (FrictionType::Exact, FrictionData::Exact { coefficient }) => {
                AnySliding::Regularised(Regularised::new(coefficient, stick_band)?)
            }
            _ => AnySliding::Frictionless,
        };
        Ok(match (AnyElastic::new(&contact)?, friction) {
            (AnyElastic::ThreeHalves(elastic), AnySliding::Regularised(friction)) => {
                Self::Usual(body.slide(normal(elastic, &contact)?, friction, drive)?)
            }
            (elastic, friction) => Self::Chosen(body.slide(normal(elastic, &contact)?, friction, drive)?),
        })
    }
}

impl<S: Scalar + PartialOrd> StickingSlide<S> {
    /// The slide that `data` describes, with true stick of this `coefficient`.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    fn new(data: &SlideData<S>, coefficient: S) -> Result<Self, ParameterError<S>> {
        let SlideData { body, contact, drive, .. } = *data;
        let friction = Exact::new(coefficient)?;
        Ok(match AnyElastic::new(&contact)? {
            AnyElastic::ThreeHalves(elastic) => Self::Usual(body.slide(normal(elastic, &contact)?, friction, drive)?),
            elastic => Self::Chosen(body.slide(normal(elastic, &contact)?, friction, drive)?),
        })
    }
}

impl<S: Scalar + PartialOrd> AnySlide<S> {
    /// The slide that `data` describes.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn new(data: &SlideData<S>) -> Result<Self, ParameterError<S>> {
        match (data.friction.friction_type(), data.friction) {
            (FrictionType::Exact, FrictionData::Exact { coefficient }) => {
                Ok(Self::Sticking(StickingSlide::new(data, coefficient)?))
            }
            _ => Ok(Self::Sliding(SlidingSlide::new(data, S::one())?)),
        }
    }
}

/// The law along the normal with this spring and the damper of `contact`.
#[inline(always)]
fn normal<S: Scalar + PartialOrd, E: Elastic<S>>(
    elastic: E,
    contact: &ContactData<S>,
) -> Result<Impact<S, E>, ParameterError<S>> {
    Impact::new(elastic, contact.damping, contact.depth)
}

/// The law along the normal of `contact`, whatever its exponent.
///
/// # Errors
/// [`ParameterError`] names the parameter that is not finite or out of bounds.
pub fn any_normal<S: Scalar + PartialOrd>(
    contact: &ContactData<S>,
) -> Result<Impact<S, AnyElastic<S>>, ParameterError<S>> {
    normal(AnyElastic::new(contact)?, contact)
}

/// The slide of `data` if it has the paper's laws. `None` if it has others, or is out of bounds.
///
/// Inlined with all that it calls, so that packs are made by their own instructions.
#[inline(always)]
pub fn usual<S: Scalar + PartialOrd>(data: &SlideData<S>) -> Option<Slide<S, ThreeHalves<S>, Regularised<S>>> {
    let SlideData { body, contact, friction, drive } = *data;
    match (contact.normal_type(), friction.friction_type(), friction) {
        (NormalType::ThreeHalves, FrictionType::Regularised, FrictionData::Regularised { coefficient, stick_band }) => {
            let elastic = ThreeHalves::new(contact.stiffness).ok()?;
            let friction = Regularised::new(coefficient, stick_band).ok()?;
            body.slide(normal(elastic, &contact).ok()?, friction, drive).ok()
        }
        _ => None,
    }
}

/// The slide of `data` if it has other laws, but no true stick: chosen in each contact, at more time. `None` likewise.
pub fn chosen<S: Scalar + PartialOrd>(data: &SlideData<S>) -> Option<Slide<S, AnyElastic<S>, AnySliding<S>>> {
    match AnySlide::new(data) {
        Ok(AnySlide::Sliding(SlidingSlide::Chosen(slide))) => Some(slide),
        _ => None,
    }
}
