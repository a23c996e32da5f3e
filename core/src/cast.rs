//! Parameters in numbers of another type, such as the lanes of a register: a unit on each lane.

use crate::{SMatrix, Scalar};

/// What is made of numbers `f64`, and can be made of others.
pub trait Cast {
    /// The same, of numbers `T`.
    type Of<T: Scalar>;

    /// The same in numbers of another type; `number` sees each of its numbers once, always in the same order.
    fn cast<T: Scalar>(&self, number: &mut impl FnMut(f64) -> T) -> Self::Of<T>;
}

impl Cast for f64 {
    type Of<T: Scalar> = T;

    fn cast<T: Scalar>(&self, number: &mut impl FnMut(f64) -> T) -> T {
        number(*self)
    }
}

impl Cast for () {
    type Of<T: Scalar> = ();

    fn cast<T: Scalar>(&self, _: &mut impl FnMut(f64) -> T) {}
}

impl<A: Cast, B: Cast> Cast for (A, B) {
    type Of<T: Scalar> = (A::Of<T>, B::Of<T>);

    fn cast<T: Scalar>(&self, number: &mut impl FnMut(f64) -> T) -> (A::Of<T>, B::Of<T>) {
        (self.0.cast(number), self.1.cast(number))
    }
}

impl<C: Cast, const N: usize> Cast for [C; N] {
    type Of<T: Scalar> = [C::Of<T>; N];

    fn cast<T: Scalar>(&self, number: &mut impl FnMut(f64) -> T) -> [C::Of<T>; N] {
        self.each_ref().map(|one| one.cast(number))
    }
}

/// Column by column.
impl<const R: usize, const C: usize> Cast for SMatrix<f64, R, C> {
    type Of<T: Scalar> = SMatrix<T, R, C>;

    fn cast<T: Scalar>(&self, number: &mut impl FnMut(f64) -> T) -> SMatrix<T, R, C> {
        SMatrix::from_array_storage(nalgebra::ArrayStorage(self.data.0.cast(number)))
    }
}

/// Implements [`Cast`] field by field: of the generic parameters that are cast themselves and those that are constants, the type's name,
/// the type, the type in numbers `T`, the fields that are cast, and after `;` those that stay as they are.
macro_rules! cast {
    (
        [$($cast:ident)*] [$($n:ident)*] $name:ident: $this:ty => $t:ident $other:ty { $($field:tt),* $(; $($same:tt),*)? }
    ) => {
        impl<$($cast: $crate::cast::Cast,)* $(const $n: usize),*> $crate::cast::Cast for $this {
            type Of<$t: $crate::Scalar> = $other;

            fn cast<$t: $crate::Scalar>(&self, number: &mut impl FnMut(f64) -> $t) -> $other {
                $name {
                    $($field: $crate::cast::Cast::cast(&self.$field, number),)*
                    $($($same: self.$same,)*)?
                }
            }
        }
    };
}

pub(crate) use cast;
