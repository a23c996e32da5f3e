//! What was chosen at run time in numbers of another type.

/// Implements [`Cast`](slipfit_core::Cast) variant by variant: of the generic parameters that are constants, the type's name, the type, the
/// type in numbers `T`, the variants, and after `;` those that hold nothing.
macro_rules! cast_variants {
    ([$($n:ident)*] $name:ident: $this:ty => $t:ident $other:ty { $($variant:ident),* $(; $empty:ident)? }) => {
        impl<$(const $n: usize),*> slipfit_core::Cast for $this {
            type Of<$t: slipfit_core::Scalar> = $other;

            fn cast<$t: slipfit_core::Scalar>(&self, number: &mut impl FnMut(f64) -> $t) -> $other {
                match self {
                    $(Self::$variant(one) => $name::$variant(slipfit_core::Cast::cast(one, number)),)*
                    $(Self::$empty => $name::$empty,)?
                }
            }
        }
    };
}

pub(crate) use cast_variants;
