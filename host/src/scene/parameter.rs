//! Parameters that a table of a scene names: `[vary]`, where they differ from unit to unit, or `[uncertain]`, where they are not known.

use slipfit_tolerance::unit::{self, Quantity};

use super::{
    SceneError,
    contact::{STIFFNESS, per_millimetre, stiffness},
    quantity::{LEAST_RAMP, RAMP},
    tree::Node,
    value::Field,
};
use crate::setup::ShownIn;

/// Where friction that is another changes nothing.
pub(super) const FRICTIONLESS: &str = "where the law of friction is \"none\"";
/// Where another stick band changes nothing.
pub(super) const BANDLESS: &str = "where the law of friction is not \"regularised\"";
/// Where a tilt of gravity changes nothing.
pub(super) const UNTILTED: &str = "where gravity is zero, or along the axis of the tilt";

/// The greatest component (m/s²) of `gravity` across the frame's axis of this index, about which a tilt turns it.
pub(super) fn across(gravity: [f64; 3], axis: usize) -> f64 {
    (0..3).filter(|i| *i != axis).map(|i| gravity[i].abs()).fold(0.0, f64::max)
}

/// What numbers a parameter has.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    /// Any of a quantity.
    Number(&'static Quantity),
    /// The end of a ramp that starts at this instant (s).
    RampEnd(f64),
    /// A stiffness of contacts with this exponent; none of several.
    Stiffness(Option<f64>),
}

impl Kind {
    /// What its deviation may be. A stiffness varies by shares of itself.
    pub fn deviation(self) -> Quantity {
        let of =
            |quantity: &Quantity| Quantity { units: quantity.units, range: [-quantity.range[1], quantity.range[1]] };
        match self {
            Self::Number(quantity) => of(quantity),
            Self::RampEnd(_) => of(&RAMP),
            Self::Stiffness(_) => Quantity { units: unit::ONE, range: [-100.0, 100.0] },
        }
    }

    /// The value (SI) in `field`; what is wrong with it is noted.
    pub fn value(self, field: &Field) -> Result<f64, SceneError> {
        match self {
            Self::Number(quantity) => field.to_number(quantity),
            Self::RampEnd(_) => field.to_number(&RAMP),
            Self::Stiffness(exponent) => {
                Ok(field.found().recover(stiffness(field, exponent.unwrap_or(1.0)), STIFFNESS[0]))
            }
        }
    }

    /// The values (SI) of a list of two, in increasing order as `order` says.
    ///
    /// # Errors
    /// An end that makes no scene, or ends in another order; none where something else is wrong, as what stands for it may be anything.
    pub fn range(self, list: &Field, ends: [&Node; 2], order: &str) -> Result<[f64; 2], SceneError> {
        let ends = ends.map(|node| Field { key: list.key.clone(), node });
        let [low, high] = [self.value(&ends[0])?, self.value(&ends[1])?];
        if list.found().any() {
            return Ok([low, high]);
        }
        if low >= high {
            return Err(list.out_of_range("", order));
        }
        match ends.iter().zip([low, high]).find(|(_, value)| !self.allows(*value)) {
            Some((end, _)) => Err(end.out_of_range("", self.limits())),
            None => Ok([low, high]),
        }
    }

    /// Whether `value` (SI) makes a sound scene.
    pub fn allows(self, value: f64) -> bool {
        match self {
            Self::Number(quantity) => quantity.covers(value),
            Self::RampEnd(start) => value - start >= LEAST_RAMP && RAMP.covers(value),
            Self::Stiffness(_) => (STIFFNESS[0]..=STIFFNESS[1]).contains(&value),
        }
    }

    /// All that is allowed, for a message.
    pub fn limits(self) -> String {
        match self {
            Self::Number(quantity) => quantity.limits(),
            Self::RampEnd(start) => format!("more than the ramp's start, {start} s, by 1 µs or more"),
            Self::Stiffness(_) => format!("{:e} to {:e} N/m^e", STIFFNESS[0], STIFFNESS[1]),
        }
    }

    /// The symbol of its SI unit; empty for a plain number.
    pub fn si_unit(self) -> &'static str {
        let of =
            |quantity: &Quantity| quantity.units.iter().find(|unit| unit.to_si(1.0) == 1.0).map_or("", |of| of.symbol);
        match self {
            Self::Number(quantity) => of(quantity),
            Self::RampEnd(_) => of(&RAMP),
            Self::Stiffness(_) => "N/m^e",
        }
    }

    /// How its values are shown.
    pub fn shown_in(self) -> ShownIn {
        let first = |quantity: &Quantity| {
            let unit = quantity.units[0];
            ShownIn { unit: unit.symbol.into(), size: unit.to_si(1.0) }
        };
        match self {
            Self::Number(quantity) => first(quantity),
            Self::RampEnd(_) => first(&RAMP),
            Self::Stiffness(exponent) => {
                let exponent = exponent.unwrap_or(1.0);
                ShownIn { unit: format!("N/mm^{exponent}"), size: per_millimetre(1.0, exponent) }
            }
        }
    }
}

/// A parameter that a table names.
pub(super) struct Named<'t, 's, P> {
    /// Which.
    pub parameter: P,
    /// Its name in reports, such as friction.coefficient.
    pub name: String,
    /// What numbers it has.
    pub kind: Kind,
    /// What the table says of it.
    pub field: Field<'t, 's>,
}

impl<'t, 's, P> Named<'t, 's, P> {
    /// The `key` in the table `of`, which reports call `group`, if it is there. Where the parameter has no effect, that is noted.
    pub fn find(
        of: &Field<'t, 's>,
        [group, key]: [&str; 2],
        parameter: P,
        kind: Kind,
        no_effect: Option<&'static str>,
    ) -> Option<Self> {
        let field = of.get(key)?;
        // A value that stands for a wrong one may leave a parameter without effect.
        if let Some(why) = no_effect.filter(|_| !field.found().any()) {
            field.found().note(field.no_effect(why, "to leave it out"));
        }
        Some(Self { parameter, name: format!("{group}.{key}"), kind, field })
    }
}
