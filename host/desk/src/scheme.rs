//! What a controller can compute with: fixed-step schemes with their numbers of passes, and number types.

use slipfit_core::integrator::{
    Extrapolated, ImplicitEuler, Integrator, Rodas3, Rodas4, RungeKutta4, Sdirk2, SemiImplicitEuler,
};

/// The number type of a fixed-step run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ScalarKind {
    /// Single precision, as on a controller.
    #[default]
    F32,
    /// Double precision.
    F64,
}

impl ScalarKind {
    /// Both.
    pub const ALL: [Self; 2] = [Self::F32, Self::F64];

    /// Its name in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }
}

/// A scheme by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntegratorKind {
    /// First order, explicit.
    SemiImplicitEuler,
    /// Fourth order, explicit.
    RungeKutta4,
    /// Third order, linearly implicit.
    Rodas3,
    /// Fourth order, linearly implicit.
    Rodas4,
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
    pub const ALL: [Self; 8] = [
        Self::SemiImplicitEuler,
        Self::RungeKutta4,
        Self::LinearlyImplicitEuler,
        Self::Rodas3,
        Self::ImplicitEuler,
        Self::Rodas4,
        Self::Sdirk2,
        Self::Extrapolated,
    ];

    /// Hands the scheme's type to `visitor`.
    pub fn visit<V: IntegratorVisitor>(self, visitor: V) -> V::Output {
        match self {
            Self::SemiImplicitEuler => visitor.visit::<SemiImplicitEuler>(),
            Self::RungeKutta4 => visitor.visit::<RungeKutta4>(),
            Self::Rodas3 => visitor.visit::<Rodas3>(),
            Self::Rodas4 => visitor.visit::<Rodas4>(),
            Self::LinearlyImplicitEuler | Self::ImplicitEuler | Self::Sdirk2 | Self::Extrapolated => {
                self.visit_implicit(visitor)
            }
        }
    }

    /// The same for a law that sticks, which only implicit schemes can follow. No code is made for the others, which scenes
    /// refuse; implicit Euler would stand for them.
    pub fn visit_implicit<V: IntegratorVisitor>(self, visitor: V) -> V::Output {
        match self {
            Self::LinearlyImplicitEuler => visitor.visit::<ImplicitEuler<1>>(),
            Self::Sdirk2 => visitor.visit::<Sdirk2<4>>(),
            Self::Extrapolated => visitor.visit::<Extrapolated<2, 4>>(),
            _ => visitor.visit::<ImplicitEuler<4>>(),
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
