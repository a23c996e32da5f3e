//! What a drive is commanded over time.

use slipfit_core::drive::{Command, Drive, Piece};
use slipfit_desk::drive::Pieces;

/// A commanded speed, as verdicts look at it.
#[derive(Clone, Debug, PartialEq)]
pub struct Setpoint {
    ramp: Drive<f64>,
    pieces: Option<Pieces>,
}

impl From<Drive<f64>> for Setpoint {
    fn from(ramp: Drive<f64>) -> Self {
        Self { ramp, pieces: None }
    }
}

impl Setpoint {
    /// The ramp of a drive, or the `pieces` that are commanded in place of it.
    pub fn new(ramp: Drive<f64>, pieces: Option<Pieces>) -> Self {
        Self { ramp, pieces }
    }

    /// The commanded speed (m/s, rad/s) at time `t` (s).
    pub fn at(&self, t: f64) -> f64 {
        match &self.pieces {
            None => self.ramp.command(t),
            Some(pieces) => pieces.piece(t).speed(t),
        }
    }

    /// The same, exactly zero where rounding alone is left of it.
    pub fn settled_at(&self, t: f64) -> f64 {
        let speed = self.at(t);
        if speed.abs() > 1e-9 * self.ramp.speed.abs() { speed } else { 0.0 }
    }

    /// When the command begins to move (s).
    pub fn start(&self) -> f64 {
        self.ramp.ramp_start
    }

    /// From when on the command is constant (s).
    pub fn end(&self) -> f64 {
        self.ramp.ramp_end
    }

    /// 1 or −1: the direction that is commanded first.
    pub fn along(&self) -> f64 {
        let first = match &self.pieces {
            None => self.ramp.speed,
            Some(Pieces(pieces)) => {
                let moves = pieces.iter().find(|piece| piece.coefficients.iter().any(|of| *of != 0.0));
                // Of the first speed that is not zero, the sign.
                moves.map_or(0.0, |piece| piece.coefficients.into_iter().find(|of| *of != 0.0).unwrap_or_default())
            }
        };
        if first < 0.0 { -1.0 } else { 1.0 }
    }

    /// Times (s), each at the end of a stretch with a constant speed that is not zero, before the last.
    pub fn holds(&self) -> Vec<f64> {
        let Some(Pieces(pieces)) = &self.pieces else { return Vec::new() };
        let is_hold = |piece: &Piece<f64>| piece.coefficients[0] != 0.0 && piece.coefficients[1..] == [0.0; 3];
        pieces.windows(2).filter(|two| is_hold(&two[0])).map(|two| two[1].start).collect()
    }

    /// Times (s) at which the command bends.
    pub fn bends(&self) -> Vec<f64> {
        self.pieces.iter().flat_map(|Pieces(pieces)| pieces.iter().map(|piece| piece.start)).collect()
    }
}
