//! The fixed-step schemes a scene can ask for, with their numbers of passes.

use clap::{ValueEnum, builder::PossibleValue};
use slipfit_core::integrator::{
    Extrapolated, ImplicitEuler, Integrator, Rodas3, RungeKutta4, Sdirk2, SemiImplicitEuler,
};

/// A scheme by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntegratorKind {
    /// First order, explicit.
    SemiImplicitEuler,
    /// Fourth order, explicit.
    RungeKutta4,
    /// Third order, linearly implicit.
    Rodas3,
    /// First order, one Newton pass.
    LinearlyImplicitEuler,
    /// First order, four Newton passes.
    ImplicitEuler,
    /// Second order, two stages of four Newton passes.
    Sdirk2,
    /// Second order, three parts of four Newton passes.
    Extrapolated,
}

/// Work to be done with a scheme's type.
pub trait IntegratorVisitor {
    /// What the work gives.
    type Output;

    /// Does the work.
    fn visit<I: Integrator>(self) -> Self::Output;
}

impl IntegratorKind {
    /// All of them, the cheapest step first.
    pub const ALL: [Self; 7] = [
        Self::SemiImplicitEuler,
        Self::RungeKutta4,
        Self::LinearlyImplicitEuler,
        Self::Rodas3,
        Self::ImplicitEuler,
        Self::Sdirk2,
        Self::Extrapolated,
    ];

    /// Hands the scheme's type to `visitor`.
    pub fn visit<V: IntegratorVisitor>(self, visitor: V) -> V::Output {
        match self {
            Self::SemiImplicitEuler => visitor.visit::<SemiImplicitEuler>(),
            Self::RungeKutta4 => visitor.visit::<RungeKutta4>(),
            Self::Rodas3 => visitor.visit::<Rodas3>(),
            Self::LinearlyImplicitEuler => visitor.visit::<ImplicitEuler<1>>(),
            Self::ImplicitEuler => visitor.visit::<ImplicitEuler<4>>(),
            Self::Sdirk2 => visitor.visit::<Sdirk2<4>>(),
            Self::Extrapolated => visitor.visit::<Extrapolated<2, 4>>(),
        }
    }

    /// Its name in scene files and on the command line.
    pub fn name(self) -> &'static str {
        struct Name;
        impl IntegratorVisitor for Name {
            type Output = &'static str;
            fn visit<I: Integrator>(self) -> &'static str {
                I::NAME
            }
        }
        self.visit(Name)
    }

    /// Whether forces are solved for at the end of a step; exact friction needs that.
    pub fn is_implicit(self) -> bool {
        struct Implicit;
        impl IntegratorVisitor for Implicit {
            type Output = bool;
            fn visit<I: Integrator>(self) -> bool {
                I::IMPLICIT
            }
        }
        self.visit(Implicit)
    }
}

impl ValueEnum for IntegratorKind {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(self.name().into())
    }
}
