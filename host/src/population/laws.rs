//! The laws of a slide whose units are simulated several at a time.

use slipfit_core::{
    ParameterError, Scalar,
    law::{Elastic, Friction, Impact, Regularised, ThreeHalves},
    menu::{FrictionData, SlideData},
    slide::Slide,
};

use crate::laws::{AnyElastic, AnySliding};

/// The types of a slide's laws.
pub trait Laws {
    /// Of the elastic part of the contact.
    type Elastic<S: Scalar + PartialOrd>: Elastic<S>;
    /// Of friction: none that remembers, because the integrator needs derivatives.
    type Friction<S: Scalar + PartialOrd>: Friction<S, Memory = ()>;

    /// The slide that `data` describes. True stick counts as no friction law of these types.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    #[allow(clippy::type_complexity, reason = "the types of both laws are what is chosen")]
    fn slide<S: Scalar + PartialOrd>(
        data: &SlideData<S>,
    ) -> Result<Slide<S, Self::Elastic<S>, Self::Friction<S>>, ParameterError<S>>;
}

/// Exponent 3/2 and regularised Coulomb friction: the paper's.
pub struct ThreeHalvesRegularised;

/// Any other exponent, or no friction: chosen in each contact, at twice the time.
pub struct Chosen;

/// Coefficient and stick band (m/s); without friction a coefficient of 0.
fn regularised<S: Scalar + PartialOrd>(friction: &FrictionData<S>) -> Result<Regularised<S>, ParameterError<S>> {
    match *friction {
        FrictionData::Regularised { coefficient, stick_band } => Regularised::new(coefficient, stick_band),
        _ => Regularised::new(S::zero(), S::one()),
    }
}

impl Laws for ThreeHalvesRegularised {
    type Elastic<S: Scalar + PartialOrd> = ThreeHalves<S>;
    type Friction<S: Scalar + PartialOrd> = Regularised<S>;

    fn slide<S: Scalar + PartialOrd>(
        data: &SlideData<S>,
    ) -> Result<Slide<S, ThreeHalves<S>, Regularised<S>>, ParameterError<S>> {
        let contact = Impact::new(ThreeHalves::new(data.contact.stiffness)?, data.contact.damping, data.contact.depth)?;
        Slide::new(data.body, contact, regularised(&data.friction)?, data.drive)
    }
}

impl Laws for Chosen {
    type Elastic<S: Scalar + PartialOrd> = AnyElastic<S>;
    type Friction<S: Scalar + PartialOrd> = AnySliding<S>;

    fn slide<S: Scalar + PartialOrd>(
        data: &SlideData<S>,
    ) -> Result<Slide<S, AnyElastic<S>, AnySliding<S>>, ParameterError<S>> {
        let contact = Impact::new(AnyElastic::new(&data.contact)?, data.contact.damping, data.contact.depth)?;
        let friction = match data.friction {
            FrictionData::None => AnySliding::Frictionless,
            _ => AnySliding::Regularised(regularised(&data.friction)?),
        };
        Slide::new(data.body, contact, friction, data.drive)
    }
}

/// Whether a slide has the paper's laws.
pub fn is_usual(data: &SlideData<f64>) -> bool {
    use slipfit_core::menu::NormalType;
    data.contact.normal_type() == NormalType::ThreeHalves && matches!(data.friction, FrictionData::Regularised { .. })
}
