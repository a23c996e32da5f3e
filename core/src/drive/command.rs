//! A P-velocity controller that follows any commanded speed.

use super::{Commandable, Push, Pushed};
use crate::{ParameterError, Scalar, error::bounded};

/// The commanded speed from a time on: a cubic of the time since.
///
/// Ramps, trapezoids, S-curves and STEP are such pieces exactly; a sine is to within 1e-6 of its amplitude with 48 a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece<S> {
    /// When it starts (s).
    pub start: S,
    /// Speed (m/s, rad/s) at the start, and its coefficients of the first, second and third power of the time since (1/s, 1/s², 1/s³).
    pub coefficients: [S; 4],
}

crate::cast::cast!([] [] Piece: Piece<f64> => T Piece<T> { start, coefficients });

impl<S: Scalar> Piece<S> {
    /// The commanded speed (m/s, rad/s) at time `t` (s).
    #[inline(always)]
    pub fn speed(&self, t: S) -> S {
        let [a, b, c, d] = self.coefficients;
        let since = t - self.start;
        ((d * since + c) * since + b) * since + a
    }

    /// How fast it changes (m/s², rad/s²).
    #[inline(always)]
    pub fn rate(&self, t: S) -> S {
        let [_, b, c, d] = self.coefficients;
        let since = t - self.start;
        (S::from_f64(3.0) * d * since + (c + c)) * since + b
    }
}

/// A commanded speed over time. Before the first piece starts, the speed is zero.
pub trait Command<S>: Clone {
    /// The piece at time `t` (s).
    fn piece(&self, t: S) -> Piece<S>;

    /// This command, if it can be followed.
    ///
    /// # Errors
    /// [`ParameterError`] names the first number that is not finite or out of bounds, or the first start that is not after the last.
    fn checked(self) -> Result<Self, ParameterError<S>>
    where
        S: PartialOrd;
}

impl<S: Scalar, const N: usize> Command<S> for [Piece<S>; N] {
    #[inline(always)]
    fn piece(&self, t: S) -> Piece<S> {
        let (zero, one) = (S::zero(), S::one());
        let mut found = Piece { start: zero, coefficients: [zero; 4] };
        // A sum with weights of 0 and 1, which is exact: of one question for many numbers compilers make a branch.
        let mut has_begun = self.map(|piece| piece.start.select_gt(t, zero, one)).into_iter();
        let mut begun = has_begun.next().unwrap_or(zero);
        for piece in self {
            let next = has_begun.next().unwrap_or(zero);
            let weight = begun - next;
            begun = next;
            found.start += weight * piece.start;
            for (found, coefficient) in found.coefficients.iter_mut().zip(piece.coefficients) {
                *found += weight * coefficient;
            }
        }
        found
    }

    fn checked(self) -> Result<Self, ParameterError<S>>
    where
        S: PartialOrd,
    {
        check_pieces(&self).map(|()| self)
    }
}

/// Whether the `pieces` can be followed.
///
/// # Errors
/// See [`Command::checked`].
pub fn check_pieces<S: Scalar + PartialOrd>(pieces: &[Piece<S>]) -> Result<(), ParameterError<S>> {
    let mut last = -1e6;
    for Piece { start, coefficients } in pieces {
        bounded("drive.command.start", *start, [last, 1e6])?;
        last = start.to_f64();
        for coefficient in coefficients {
            bounded("drive.command", *coefficient, [-1e15, 1e15])?;
        }
    }
    Ok(())
}

/// K·(command(t) − v).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Commanded<S, C> {
    /// Gain K (N·s/m, N·m·s/rad).
    pub gain: S,
    /// The commanded speed.
    pub command: C,
}

crate::cast::cast!([C] [] Commanded: Commanded<f64, C> => T Commanded<T, C::Of<T>> { gain, command });

impl<S: Scalar, C: Command<S>> Push<S> for Commanded<S, C> {
    fn checked(self) -> Result<Self, ParameterError<S>>
    where
        S: PartialOrd,
    {
        Ok(Self { gain: bounded("drive.gain", self.gain, [0.0, 1e9])?, command: self.command.checked()? })
    }

    #[inline(always)]
    fn effort(&self, t: S, v: S) -> S {
        self.pushed(t, v).force
    }

    #[inline(always)]
    fn pushed(&self, t: S, v: S) -> Pushed<S> {
        let piece = self.command.piece(t);
        Pushed { force: self.gain * (piece.speed(t) - v), per_speed: self.gain, per_time: self.gain * piece.rate(t) }
    }
}

impl<S: Scalar, const N: usize> Commandable<S> for Commanded<S, [Piece<S>; N]> {
    /// Without pieces the command stays zero.
    #[inline(always)]
    fn set_command(&mut self, v: S) {
        let zero = S::zero();
        let mut start = S::from_f64(-1e6);
        for piece in &mut self.command {
            *piece = Piece { start, coefficients: [v, zero, zero, zero] };
            // In order, as they have to be.
            start += S::one();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Command, Commandable, Commanded, Piece, Push};
    use crate::{Vector3, drive::Drive};

    /// Eq. 12's ramp from 0.05 to 1 s to 0.1 m/s as pieces.
    fn ramp() -> [Piece<f64>; 2] {
        let duration = 0.95;
        let [second, third] = [3.0 * 0.1 / (duration * duration), -2.0 * 0.1 / (duration * duration * duration)];
        [
            Piece { start: 0.05, coefficients: [0.0, 0.0, second, third] },
            Piece { start: 1.0, coefficients: [0.1, 0.0, 0.0, 0.0] },
        ]
    }

    #[test]
    fn pieces_of_a_ramp_are_the_ramp() {
        let drive = Drive { gain: 40.0, ramp_start: 0.05, ramp_end: 1.0, speed: 0.1, point_b: Vector3::zeros() };
        let commanded = Commanded { gain: 40.0, command: ramp() }.checked().unwrap();
        for t in [0.0, 0.05, 0.06, 0.3, 0.99, 1.0, 3.0] {
            let [one, other] = [drive.pushed(t, 0.02), commanded.pushed(t, 0.02)];
            for (one, other) in [
                (one.force, other.force),
                (one.per_time, other.per_time),
                (drive.effort(t, 0.02), commanded.effort(t, 0.02)),
            ] {
                assert!(libm::fabs(one - other) < 1e-13, "{t} {one} {other}");
            }
            assert_eq!(one.per_speed, other.per_speed);
        }
    }

    #[test]
    fn nothing_is_commanded_before_the_first_piece_and_without_pieces() {
        assert_eq!(ramp().piece(0.04).speed(0.04), 0.0);
        assert_eq!(<[Piece<f32>; 0]>::piece(&[], 0.04).speed(0.04), 0.0);
    }

    #[test]
    fn a_command_that_is_set_holds_exactly() {
        let mut commanded = Commanded { gain: 40.0, command: ramp() };
        for v in [0.07, -0.1, 0.0] {
            commanded.set_command(v);
            for t in [-1000.0, 0.0, 0.5, 1e5] {
                assert_eq!((commanded.command.piece(t).speed(t), commanded.pushed(t, 0.0).per_time), (v, 0.0));
            }
            assert!(commanded.checked().is_ok());
        }
    }

    #[test]
    fn pieces_out_of_order_and_numbers_that_are_none_are_refused() {
        let [first, last] = ramp();
        assert_eq!([last, first].checked().unwrap_err().parameter, "drive.command.start");
        let broken = Piece { coefficients: [0.0, f64::NAN, 0.0, 0.0], ..last };
        assert_eq!([first, broken].checked().unwrap_err().parameter, "drive.command");
        assert_eq!(Commanded { gain: -1.0, command: [first, last] }.checked().unwrap_err().parameter, "drive.gain");
    }
}
