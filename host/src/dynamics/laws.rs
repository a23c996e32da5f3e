//! Contact laws chosen at run time, for fixed steps at the desk: one type for every scene instead of one for each
//! combination of laws, scheme and number type. The laws themselves are core's, and so are the bits.

use slipfit_core::{
    ParameterError, Scalar,
    law::{
        Elastic, Exact, Friction, Frictionless, HuntCrossley, Impact, LankaraniNikravesh, Linear, Normal,
        NormalResponse, Power, Regularised, ThreeHalves,
        friction::{SlidingContact, Traction},
    },
    menu::{ContactData, FrictionData, FrictionType, NormalType, SlideData},
    slide::Slide,
};

use crate::mechanism::{NormalData, Rebound};

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
            Self::Power(law) => law.force(depth),
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

impl AnyNormal<f64> {
    /// The law of `data`.
    ///
    /// # Errors
    /// [`ParameterError`] names the parameter that is not finite or out of bounds.
    pub fn new(data: &NormalData) -> Result<Self, ParameterError<f64>> {
        let [stiffness, exponent] = data.spring();
        let spring = AnyElastic::of(stiffness, exponent)?;
        Ok(match *data {
            NormalData::Impact(data) => Self::Impact(Impact::new(spring, data.damping, data.depth)?),
            NormalData::HuntCrossley(Rebound { restitution, speed, .. }) => {
                Self::HuntCrossley(HuntCrossley::new(spring, restitution, speed)?)
            }
            NormalData::LankaraniNikravesh(Rebound { restitution, speed, .. }) => {
                Self::LankaraniNikravesh(LankaraniNikravesh::new(spring, restitution, speed)?)
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
}

impl<S: Scalar> Friction<S> for AnySliding<S> {
    type Memory = ();

    const STICKS: bool = false;

    fn fresh() {}

    #[inline(always)]
    fn traction(&self, (): &(), contact: &SlidingContact<S>) -> (Traction<S>, ()) {
        match self {
            Self::Frictionless => Frictionless.traction(&(), contact),
            Self::Regularised(law) => law.traction(&(), contact),
        }
    }

    fn shifted((): &(), (): &(), (): &(), _: S) {}

    fn or_old((): &(), _: S, (): &()) {}
}

/// A slide whose laws were chosen at run time. The exponent 3/2 has types of its own, as fast as firmware's: a choice within
/// each contact makes a step more than twice as slow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnySlide<S> {
    /// Exponent 3/2, regularised Coulomb friction.
    ThreeHalvesRegularised(Slide<S, ThreeHalves<S>, Regularised<S>>),
    /// Exponent 3/2, exact Coulomb friction.
    ThreeHalvesExact(Slide<S, ThreeHalves<S>, Exact<S>>),
    /// Friction without internal variables.
    Sliding(Slide<S, AnyElastic<S>, AnySliding<S>>),
    /// Exact Coulomb friction.
    Sticking(Slide<S, AnyElastic<S>, Exact<S>>),
}

impl<S: Scalar + PartialOrd> AnySlide<S> {
    /// The slide that `data` describes.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn new(data: &SlideData<S>) -> Result<Self, ParameterError<S>> {
        let SlideData { body, contact, friction, drive } = *data;
        let elastic = AnyElastic::new(&contact)?;
        if let AnyElastic::ThreeHalves(elastic) = elastic {
            let normal = Impact::new(elastic, contact.damping, contact.depth)?;
            match (friction.friction_type(), friction) {
                (FrictionType::Exact, FrictionData::Exact { coefficient }) => {
                    let slide = Slide::new(body, normal, Exact::new(coefficient)?, drive)?;
                    return Ok(Self::ThreeHalvesExact(slide));
                }
                (FrictionType::Regularised, FrictionData::Regularised { coefficient, stick_band }) => {
                    let slide = Slide::new(body, normal, Regularised::new(coefficient, stick_band)?, drive)?;
                    return Ok(Self::ThreeHalvesRegularised(slide));
                }
                _ => {}
            }
        }
        let normal = Impact::new(elastic, contact.damping, contact.depth)?;
        Ok(match (friction.friction_type(), friction) {
            (FrictionType::Exact, FrictionData::Exact { coefficient }) => {
                Self::Sticking(Slide::new(body, normal, Exact::new(coefficient)?, drive)?)
            }
            (FrictionType::Regularised, FrictionData::Regularised { coefficient, stick_band }) => {
                let friction = AnySliding::Regularised(Regularised::new(coefficient, stick_band)?);
                Self::Sliding(Slide::new(body, normal, friction, drive)?)
            }
            _ => Self::Sliding(Slide::new(body, normal, AnySliding::Frictionless, drive)?),
        })
    }
}
