//! The setpoints of a prediction: what is commanded at the end of each period, from the past up to the horizon.

use crate::{
    Scalar,
    drive::{Piece, catmull_rom},
};

/// Ticks of a period.
pub(super) const TICKS: u32 = 1 << 20;

/// `2·N` setpoints (m/s), one a period, round and round.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Setpoints<S, const N: usize> {
    speeds: [[S; 2]; N],
    /// Count of the present instant's.
    now: u32,
}

/// How many periods before or after the present instant.
fn offset(periods: i32) -> u32 {
    periods.cast_unsigned()
}

impl<S: Scalar, const N: usize> Setpoints<S, N> {
    /// All at rest.
    pub fn new() -> Self {
        Self { speeds: [[S::zero(); 2]; N], now: 0 }
    }

    /// Makes all of them `speed`.
    pub fn fill(&mut self, speed: S) {
        self.speeds.fill([speed; 2]);
        self.now = 0;
    }

    #[inline(always)]
    fn place(&self, periods: i32) -> (usize, usize) {
        let place = self.now.wrapping_add(offset(periods)) as usize;
        ((place / 2) & (N - 1), place & 1)
    }

    /// The setpoint so many `periods` after the present instant, or before where negative.
    #[inline(always)]
    pub fn at(&self, periods: i32) -> S {
        let (pair, side) = self.place(periods);
        self.speeds[pair][side]
    }

    /// Makes it `speed`.
    #[inline(always)]
    pub fn set(&mut self, periods: i32, speed: S) {
        let (pair, side) = self.place(periods);
        self.speeds[pair][side] = speed;
    }

    /// The present instant is a period later.
    #[inline(always)]
    pub fn advance(&mut self) {
        self.now = self.now.wrapping_add(1);
    }

    /// The command over the `P` periods of which the first has the instant `lead` (ticks) after the present one, at time 0; of
    /// `rate` (1/s) periods in a second.
    #[inline(always)]
    pub fn pieces<const P: usize>(&self, lead: i32, rate: S) -> [Piece<S>; P] {
        let first = whole(lead);
        let period = S::one() / rate;
        let into = S::from_count(lead.cast_unsigned() & (TICKS - 1)) / S::from_count(TICKS);
        let mut last = [-1, 0, 1].map(|k| self.at(first.wrapping_add(k)));
        core::array::from_fn(|piece| {
            let piece = piece as u32;
            let [before, from, to] = last;
            let after = self.at(first.wrapping_add(piece.wrapping_add(2).cast_signed()));
            last = [from, to, after];
            catmull_rom([before, from, to, after], (S::from_count(piece) - into) * period, rate)
        })
    }

    /// What is commanded (m/s) at the instant `lead` (ticks) after the present one.
    #[inline(always)]
    pub fn command(&self, lead: i32, rate: S) -> S {
        let [piece] = self.pieces(lead, rate);
        piece.speed(S::zero())
    }
}

/// Whole periods in so many `ticks`, rounded down.
#[inline(always)]
pub(super) fn whole(ticks: i32) -> i32 {
    ticks >> TICKS.trailing_zeros()
}

#[cfg(test)]
mod tests {
    use super::{Setpoints, TICKS};
    use crate::drive::Command;

    #[test]
    fn the_command_is_continuous_over_the_ring_and_meets_its_setpoints() {
        let speed = |k: i32| libm::sin(0.3 * f64::from(k));
        let mut setpoints = Setpoints::<f64, 8>::new();
        for now in 0..40 {
            (-4..9).for_each(|k| setpoints.set(k, speed(now + k)));
            for k in -3..5 {
                let lead = k * TICKS.cast_signed();
                assert_eq!(setpoints.command(lead, 1e3), speed(now + k));
                for into in [0.0, 0.25, 0.7, 1.0, 2.2] {
                    let ticks = lead + (into * f64::from(TICKS)) as i32;
                    let pieces: [_; 3] = setpoints.pieces(lead, 1e3);
                    let t = into * 1e-3;
                    let found = pieces.piece(t).speed(t);
                    assert!(libm::fabs(found - setpoints.command(ticks, 1e3)) < 1e-6, "{k} {into}");
                    assert!(libm::fabs(found - libm::sin(0.3 * (f64::from(now + k) + into))) < 2e-3, "{k} {into}");
                }
            }
            setpoints.advance();
        }
    }
}
