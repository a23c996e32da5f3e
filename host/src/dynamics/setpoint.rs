//! What a drive is commanded over time.

use slipfit_core::drive::{Drive, Piece};

use super::command::Command;

/// Share of the greatest speed of a recorded command below which it is rest.
const RECORDED_REST: f64 = 1e-3;

/// A commanded speed, as verdicts see it.
#[derive(Clone, Debug, PartialEq)]
pub struct Setpoint {
    ramp: Drive<f64>,
    command: Option<Command>,
}

impl From<Drive<f64>> for Setpoint {
    fn from(ramp: Drive<f64>) -> Self {
        Self { ramp, command: None }
    }
}

impl Setpoint {
    /// The ramp of a drive, or the `command` in place of it.
    pub fn new(ramp: Drive<f64>, command: Option<Command>) -> Self {
        Self { ramp, command }
    }

    /// Pieces of the command in place of the ramp; none if there is a ramp.
    fn pieces(&self) -> &[Piece<f64>] {
        self.command.as_ref().map_or(&[], |command| &command.pieces.0)
    }

    fn is_recorded(&self) -> bool {
        self.command.as_ref().is_some_and(|command| command.is_recorded)
    }

    /// The commanded speed (m/s, rad/s) at time `t` (s).
    pub fn at(&self, t: f64) -> f64 {
        self.command.as_ref().map_or_else(|| self.ramp.command(t), |command| command.at(t))
    }

    /// The same, exactly zero where rounding alone is left of it, or the noise of a record.
    pub fn settled_at(&self, t: f64) -> f64 {
        let speed = self.at(t);
        let least = if self.is_recorded() { RECORDED_REST } else { 1e-9 };
        if speed.abs() > least * self.ramp.speed.abs() { speed } else { 0.0 }
    }

    /// When the command begins to move (s).
    pub fn start(&self) -> f64 {
        self.ramp.ramp_start
    }

    /// From when on the command is constant (s).
    pub fn end(&self) -> f64 {
        self.ramp.ramp_end
    }

    /// 1 or −1: the direction that is commanded first; in a record, whose first speeds are noise, that of the greatest speed.
    pub fn along(&self) -> f64 {
        let first = match &self.command {
            None => self.ramp.speed,
            Some(command) if command.is_recorded => self.ramp.speed,
            Some(_) => {
                let moves = self.pieces().iter().find(|piece| piece.coefficients.iter().any(|of| *of != 0.0));
                // Of the first speed that is not zero, the sign.
                moves.map_or(0.0, |piece| piece.coefficients.into_iter().find(|of| *of != 0.0).unwrap_or_default())
            }
        };
        if first < 0.0 { -1.0 } else { 1.0 }
    }

    /// Times (s), each at the end of a stretch with a constant speed that is not zero, before the last.
    pub fn holds(&self) -> Vec<f64> {
        if self.is_recorded() {
            return Vec::new();
        }
        let is_hold = |piece: &Piece<f64>| piece.coefficients[0] != 0.0 && piece.coefficients[1..] == [0.0; 3];
        self.pieces().windows(2).filter(|two| is_hold(&two[0])).map(|two| two[1].start).collect()
    }

    /// Times (s) at which the command bends.
    pub fn bends(&self) -> Vec<f64> {
        self.pieces().iter().map(|piece| piece.start).collect()
    }
}
