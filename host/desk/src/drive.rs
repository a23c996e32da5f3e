//! Drives chosen at run time: the laws are core's, and so are the bits.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

use crate::{cast::cast_variants, real::Real};
use slipfit_core::{
    Cast, ParameterError, Scalar,
    drive::{Command, Commanded, Drive, Piece, Push, Pushed, Train, TrainData, check_pieces},
};

/// A commanded speed of any number of pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Pieces<S = f64>(pub Arc<[Piece<S>]>);

impl Cast for Pieces {
    type Of<T: Scalar> = Pieces<T>;

    fn cast<T: Scalar>(&self, number: &mut impl FnMut(f64) -> T) -> Pieces<T> {
        Pieces(self.0.iter().map(|piece| piece.cast(number)).collect())
    }
}

impl<S: Scalar + PartialOrd> Command<S> for Pieces<S> {
    fn piece(&self, t: S) -> Piece<S> {
        match self.0.partition_point(|piece| piece.start <= t) {
            0 => Piece { start: S::zero(), coefficients: [S::zero(); 4] },
            after => self.0[after - 1],
        }
    }

    fn checked(self) -> Result<Self, ParameterError<S>> {
        check_pieces(&self.0).map(|()| self)
    }
}

/// The effort (N, N·m) that a sampling controller holds between two of its samples. All clones share it; the run changes it between steps.
#[derive(Clone, Debug, Default)]
pub struct Held(Arc<AtomicU64>);

impl Held {
    /// Holds `effort` (N, N·m) from now on.
    pub fn set(&self, effort: f64) {
        self.0.store(effort.to_bits(), Ordering::Relaxed);
    }

    /// What is held (N, N·m).
    pub fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }
}

/// The same for all.
impl Cast for Held {
    type Of<T: Scalar> = Self;

    fn cast<T: Scalar>(&self, _: &mut impl FnMut(f64) -> T) -> Self {
        self.clone()
    }
}

impl PartialEq for Held {
    fn eq(&self, other: &Self) -> bool {
        self.get() == other.get()
    }
}

impl<S: Scalar> Push<S> for Held {
    fn checked(self) -> Result<Self, ParameterError<S>> {
        Ok(self)
    }

    fn effort(&self, _: S, _: S) -> S {
        S::from_f64(self.get())
    }

    fn pushed(&self, t: S, v: S) -> Pushed<S> {
        Pushed { force: self.effort(t, v), per_speed: S::zero(), per_time: S::zero() }
    }
}

/// Any drive.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyDrive<S = f64> {
    /// A ramp.
    Ramp(Drive<S>),
    /// A ramp, on a drive train.
    RampTrain(Train<S, Drive<S>>),
    /// Any command.
    Commanded(Commanded<S, Pieces<S>>),
    /// Any command, on a drive train.
    CommandedTrain(Train<S, Commanded<S, Pieces<S>>>),
    /// A sampling controller.
    Held(Held),
    /// A sampling controller, on a drive train.
    HeldTrain(Train<S, Held>),
    /// Friction alone, of a joint.
    Friction(Train<S, ()>),
}

cast_variants!([] AnyDrive: AnyDrive => T AnyDrive<T> {
    Ramp, RampTrain, Commanded, CommandedTrain, Held, HeldTrain, Friction
});

impl<S: Real> AnyDrive<S> {
    /// The drive with the ramp, or with the command of `pieces` in place of it, on the drive train of `train`, if it has one.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn new(
        ramp: Drive<S>,
        pieces: Option<&Pieces<S>>,
        train: Option<TrainData<S>>,
    ) -> Result<Self, ParameterError<S>> {
        let commanded = pieces.map(|pieces| Commanded { gain: ramp.gain, command: pieces.clone() });
        Ok(match (commanded, train) {
            (None, None) => Self::Ramp(ramp.checked()?),
            (None, Some(data)) => Self::RampTrain(Train::new(ramp, data)?),
            (Some(commanded), None) => Self::Commanded(commanded.checked()?),
            (Some(commanded), Some(data)) => Self::CommandedTrain(Train::new(commanded, data)?),
        })
    }

    /// What `held` gives, on the drive train of `train`, if it has one.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter that is not finite or out of bounds.
    pub fn held(held: Held, train: Option<TrainData<S>>) -> Result<Self, ParameterError<S>> {
        Ok(match train {
            None => Self::Held(held),
            Some(data) => Self::HeldTrain(Train::new(held, data)?),
        })
    }
}

impl<S: Real> Push<S> for AnyDrive<S> {
    fn checked(self) -> Result<Self, ParameterError<S>> {
        Ok(match self {
            Self::Ramp(drive) => Self::Ramp(drive.checked()?),
            Self::RampTrain(drive) => Self::RampTrain(drive.checked()?),
            Self::Commanded(drive) => Self::Commanded(drive.checked()?),
            Self::CommandedTrain(drive) => Self::CommandedTrain(drive.checked()?),
            Self::Held(drive) => Self::Held(drive),
            Self::HeldTrain(drive) => Self::HeldTrain(drive.checked()?),
            Self::Friction(drive) => Self::Friction(drive.checked()?),
        })
    }

    #[inline(always)]
    fn effort(&self, t: S, v: S) -> S {
        match self {
            Self::Ramp(drive) => drive.effort(t, v),
            Self::RampTrain(drive) => drive.effort(t, v),
            Self::Commanded(drive) => drive.effort(t, v),
            Self::CommandedTrain(drive) => drive.effort(t, v),
            Self::Held(drive) => drive.effort(t, v),
            Self::HeldTrain(drive) => drive.effort(t, v),
            Self::Friction(drive) => drive.effort(t, v),
        }
    }

    #[inline(always)]
    fn pushed(&self, t: S, v: S) -> Pushed<S> {
        match self {
            Self::Ramp(drive) => drive.pushed(t, v),
            // In place for several units: a call from wide instructions costs more than what these do.
            Self::RampTrain(drive) if S::UNITS > 1 => drive.pushed(t, v),
            Self::Friction(drive) if S::UNITS > 1 => drive.pushed(t, v),
            other => other.pushed_otherwise(t, v),
        }
    }
}

impl<S: Real> AnyDrive<S> {
    /// [`Push::pushed`] of all but a plain ramp, in a function of its own: it would be compiled into every mechanism.
    #[inline(never)]
    fn pushed_otherwise(&self, t: S, v: S) -> Pushed<S> {
        match self {
            Self::Ramp(drive) => drive.pushed(t, v),
            Self::RampTrain(drive) => drive.pushed(t, v),
            Self::Commanded(drive) => drive.pushed(t, v),
            Self::CommandedTrain(drive) => drive.pushed(t, v),
            Self::Held(drive) => drive.pushed(t, v),
            Self::HeldTrain(drive) => drive.pushed(t, v),
            Self::Friction(drive) => drive.pushed(t, v),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_looked_up_as_the_kernel_does() {
        let piece = |start: f64, speed: f64| Piece { start, coefficients: [speed, 0.5, -1.0, 2.0] };
        let array = [piece(0.1, 1.0), piece(0.2, 2.0), piece(0.2, 3.0), piece(0.7, -1.0)];
        let pieces = Pieces(array.to_vec().into());
        for t in [-1.0, 0.0, 0.1, 0.15, 0.2, 0.3, 0.7, 5.0] {
            assert_eq!(pieces.piece(t), array.piece(t), "{t}");
        }
    }
}
