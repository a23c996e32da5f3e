//! Contact laws as source text.

use slipfit_core::{
    law::StribeckData,
    menu::{FrictionData, FrictionType, NormalType},
};

use super::expression::Typed;
use crate::mechanism::{Laws, NormalData, Rebound, SlidingData};

/// The contacts met so far, each once.
#[derive(Default)]
pub(super) struct Contacts {
    all: Vec<Laws>,
    names: Vec<&'static str>,
}

impl Contacts {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// What is used from `slipfit_core::law`.
    pub fn names(&self) -> Vec<&'static str> {
        self.names.clone()
    }

    /// Type arguments and value of the contact of `laws`.
    pub fn of(&mut self, laws: &Laws) -> Typed {
        let [normal, friction] = [self.normal(laws), self.friction(laws)];
        let index = self.all.iter().position(|one| one == laws).unwrap_or_else(|| {
            self.all.push(*laws);
            self.all.len() - 1
        });
        Typed { of: format!("{}, {}", normal.of, friction.of), value: format!("contact_{index}") }
    }

    /// Statements that make them.
    pub fn made(&mut self) -> String {
        let all = self.all.clone();
        let one = |(i, laws): (usize, &Laws)| {
            let [normal, friction] = [self.normal(laws).value, self.friction(laws).value];
            format!("    let contact_{i} = Contact {{ normal: {normal}, friction: {friction} }};\n")
        };
        all.iter().enumerate().map(one).collect()
    }

    fn normal(&mut self, laws: &Laws) -> Typed {
        let [stiffness, exponent] = laws.contact.spring();
        let (name, spring) = match NormalType::of(exponent) {
            NormalType::Linear => ("Linear", format!("Linear::new(s({stiffness:?}))?")),
            NormalType::ThreeHalves => ("ThreeHalves", format!("ThreeHalves::new(s({stiffness:?}))?")),
            NormalType::Power => ("Power", format!("Power::new(s({stiffness:?}), s({exponent:?}))?")),
        };
        let (law, [first, second]) = match laws.contact {
            NormalData::Impact(data) => ("Impact", [data.damping, data.depth]),
            NormalData::HuntCrossley(Rebound { restitution, speed, .. }) => ("HuntCrossley", [restitution, speed]),
            NormalData::LankaraniNikravesh(Rebound { restitution, speed, .. }) => {
                ("LankaraniNikravesh", [restitution, speed])
            }
        };
        self.names.extend([name, law]);
        Typed {
            of: format!("{law}<S, {name}<S>>"),
            value: format!("{law}::new({spring}, s({first:?}), s({second:?}))?"),
        }
    }

    fn friction(&mut self, laws: &Laws) -> Typed {
        let data = match laws.friction {
            SlidingData::Coulomb(data) => data,
            SlidingData::Stribeck(StribeckData { at_rest, kinetic, stribeck_speed, viscous, stick_band }) => {
                self.names.extend(["Stribeck", "StribeckData"]);
                let value = format!(
                    "Stribeck::new(StribeckData {{ at_rest: s({at_rest:?}), kinetic: s({kinetic:?}), stribeck_speed: \
                     s({stribeck_speed:?}), viscous: s({viscous:?}), stick_band: s({stick_band:?}) }})?"
                );
                return Typed { of: "Stribeck<S>".into(), value };
            }
            SlidingData::StaticKinetic { at_rest, kinetic } => {
                self.names.push("StaticKinetic");
                let value = format!("StaticKinetic::new(s({at_rest:?}), s({kinetic:?}))?");
                return Typed { of: "StaticKinetic<S>".into(), value };
            }
        };
        let (name, of, value) = match (data.friction_type(), data) {
            (FrictionType::Regularised, FrictionData::Regularised { coefficient, stick_band }) => {
                let value = format!("Regularised::new(s({coefficient:?}), s({stick_band:?}))?");
                ("Regularised", "Regularised<S>", value)
            }
            (FrictionType::Exact, FrictionData::Exact { coefficient }) => {
                ("Exact", "Exact<S>", format!("Exact::new(s({coefficient:?}))?"))
            }
            _ => ("Frictionless", "Frictionless", "Frictionless".into()),
        };
        self.names.push(name);
        Typed { of: of.into(), value }
    }
}
