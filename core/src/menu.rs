//! The menu of scene types: from plain data to the cheapest kernel that covers it.

use crate::{
    ParameterError, Scalar, Vector3,
    drive::Drive,
    law::{Elastic, Exact, Friction, Frictionless, Impact, Linear, Power, Regularised, ThreeHalves},
    slide::{Body, PINS, Slide},
    system::{Lanes, everywhere},
};

/// Contact parameters, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactData<S> {
    /// Stiffness k (N/m^e).
    pub stiffness: S,
    /// Exponent e.
    pub exponent: S,
    /// Damping c (N·s/m).
    pub damping: S,
    /// Depth of full damping d (m).
    pub depth: S,
}

/// Friction parameters, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrictionData<S> {
    /// No friction.
    None,
    /// Coulomb friction smoothed over a stick band.
    Regularised {
        /// Coefficient μ.
        coefficient: S,
        /// Stick band v_s (m/s).
        stick_band: S,
    },
    /// Coulomb friction with true stick.
    Exact {
        /// Coefficient μ.
        coefficient: S,
    },
}

/// A slide as plain data, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlideData<S> {
    /// Body, pins and gaps.
    pub body: Body<S>,
    /// Contact law.
    pub contact: ContactData<S>,
    /// Friction law.
    pub friction: FrictionData<S>,
    /// Drive.
    pub drive: Drive<S>,
}

/// Work to be done on a slide of whichever type covers the data.
pub trait SlideVisitor<S> {
    /// What the work gives.
    type Output;

    /// Does the work.
    fn visit<E: Elastic<S>, F: Friction<S>>(self, slide: Slide<S, E, F>) -> Self::Output;
}

/// The normal law's type for an exponent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalType {
    /// e = 1.
    Linear,
    /// e = 3/2.
    ThreeHalves,
    /// Any other.
    Power,
}

impl NormalType {
    /// The cheapest type that covers `exponent`.
    pub fn of<S: Scalar + PartialOrd>(exponent: S) -> Self {
        if exponent == S::one() {
            Self::Linear
        } else if exponent == S::from_f64(1.5) {
            Self::ThreeHalves
        } else {
            Self::Power
        }
    }
}

/// The friction law's type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionType {
    /// No friction asked for, or μ = 0.
    Frictionless,
    /// The regularised law.
    Regularised,
    /// The law with true stick.
    Exact,
}

impl<S: Scalar + PartialOrd> ContactData<S> {
    /// The cheapest normal law that covers the exponent.
    pub fn normal_type(&self) -> NormalType {
        NormalType::of(self.exponent)
    }
}

impl<S: Scalar + PartialOrd> FrictionData<S> {
    /// Coefficient μ, 0 without friction.
    pub fn coefficient(&self) -> S {
        match *self {
            Self::None => S::zero(),
            Self::Regularised { coefficient, .. } | Self::Exact { coefficient } => coefficient,
        }
    }

    /// The coefficient μ, to be changed; `None` without friction.
    pub fn coefficient_mut(&mut self) -> Option<&mut S> {
        match self {
            Self::None => None,
            Self::Regularised { coefficient, .. } | Self::Exact { coefficient } => Some(coefficient),
        }
    }

    /// The stick band (m/s), to be changed; `None` of a law that has none.
    pub fn stick_band_mut(&mut self) -> Option<&mut S> {
        match self {
            Self::Regularised { stick_band, .. } => Some(stick_band),
            Self::Exact { .. } | Self::None => None,
        }
    }

    /// The cheapest friction law that covers the data.
    pub fn friction_type(&self) -> FrictionType {
        match self {
            _ if self.coefficient() == S::zero() => FrictionType::Frictionless,
            Self::None => FrictionType::Frictionless,
            Self::Regularised { .. } => FrictionType::Regularised,
            Self::Exact { .. } => FrictionType::Exact,
        }
    }
}

impl<S: Scalar> ContactData<S> {
    /// The same contact in numbers of another type.
    pub fn cast<T: Scalar>(&self, number: impl Fn(S) -> T) -> ContactData<T> {
        ContactData {
            stiffness: number(self.stiffness),
            exponent: number(self.exponent),
            damping: number(self.damping),
            depth: number(self.depth),
        }
    }
}

impl<S: Scalar> SlideData<S> {
    /// The same slide in numbers of another type.
    pub fn cast<T: Scalar>(&self, number: impl Fn(S) -> T) -> SlideData<T> {
        let vector = |v: &Vector3<S>| Vector3::new(number(v.x), number(v.y), number(v.z));
        let SlideData { body, contact, friction, drive } = self;
        SlideData {
            body: Body {
                mass: number(body.mass),
                inertia_b: vector(&body.inertia_b),
                gravity_w: vector(&body.gravity_w),
                pins_w: body.pins_w.each_ref().map(vector),
                gaps: body.gaps.map(&number),
            },
            contact: contact.cast(&number),
            friction: match *friction {
                FrictionData::None => FrictionData::None,
                FrictionData::Regularised { coefficient, stick_band } => {
                    FrictionData::Regularised { coefficient: number(coefficient), stick_band: number(stick_band) }
                }
                FrictionData::Exact { coefficient } => FrictionData::Exact { coefficient: number(coefficient) },
            },
            drive: Drive {
                gain: number(drive.gain),
                ramp_start: number(drive.ramp_start),
                ramp_end: number(drive.ramp_end),
                speed: number(drive.speed),
                point_b: vector(&drive.point_b),
            },
        }
    }

    /// What a slide of lanes is to be made of for [`abreast_pins`](crate::slide::abreast_pins): the parameters of this one in every lane, and in
    /// place of each pin all of them, each in its lane.
    pub fn abreast<L: Lanes<S>>(&self) -> SlideData<L> {
        let mut lanes = self.cast(everywhere);
        let [a, b, c, d] = self.body.pins_w;
        let place = Vector3::new(L::of([a.x, b.x, c.x, d.x]), L::of([a.y, b.y, c.y, d.y]), L::of([a.z, b.z, c.z, d.z]));
        lanes.body.pins_w = [place; PINS];
        #[rustfmt::skip]
        let [
            left_a, right_a, rail_a, wall_a,
            left_b, right_b, rail_b, wall_b,
            left_c, right_c, rail_c, wall_c,
            left_d, right_d, rail_d, wall_d,
        ] = self.body.gaps;
        let [left, right, rail, wall] = [
            [left_a, left_b, left_c, left_d],
            [right_a, right_b, right_c, right_d],
            [rail_a, rail_b, rail_c, rail_d],
            [wall_a, wall_b, wall_c, wall_d],
        ]
        .map(L::of);
        lanes.body.gaps =
            [left, right, rail, wall, left, right, rail, wall, left, right, rail, wall, left, right, rail, wall];
        lanes
    }
}

impl<S: Scalar + PartialOrd> SlideData<S> {
    /// Hands the slide to `visitor` as the cheapest type that covers it.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn visit<V: SlideVisitor<S>>(&self, visitor: V) -> Result<V::Output, ParameterError<S>> {
        let ContactData { stiffness, exponent, .. } = self.contact;
        match self.contact.normal_type() {
            NormalType::Linear => self.visit_elastic(Linear::new(stiffness)?, visitor),
            NormalType::ThreeHalves => self.visit_elastic(ThreeHalves::new(stiffness)?, visitor),
            NormalType::Power => self.visit_elastic(Power::new(stiffness, exponent)?, visitor),
        }
    }

    fn visit_elastic<E: Elastic<S>, V: SlideVisitor<S>>(
        &self,
        elastic: E,
        visitor: V,
    ) -> Result<V::Output, ParameterError<S>> {
        let contact = Impact::new(elastic, self.contact.damping, self.contact.depth)?;
        let SlideData { body, friction, drive, .. } = *self;
        match (friction.friction_type(), friction) {
            (FrictionType::Regularised, FrictionData::Regularised { coefficient, stick_band }) => {
                let friction = Regularised::new(coefficient, stick_band)?;
                Ok(visitor.visit(body.slide(contact, friction, drive)?))
            }
            (FrictionType::Exact, FrictionData::Exact { coefficient }) => {
                Ok(visitor.visit(body.slide(contact, Exact::new(coefficient)?, drive)?))
            }
            _ => Ok(visitor.visit(body.slide(contact, Frictionless, drive)?)),
        }
    }
}
