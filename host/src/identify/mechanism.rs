//! A mechanism as a unit that is sought.

use slipfit_core::drive::{Piece, TrainData};
use slipfit_desk::drive::Pieces;

use super::Unit;
use crate::{
    dynamics::{command::spline, simulate::SimulateError, trajectory::Trajectory},
    mechanism::{Command, Mechanism, Parameter, UNLIMITED, run},
    setup::RunSpec,
};

impl Unit for Mechanism {
    type Parameter = Parameter;

    fn motion(&self, levels: &[f64], drive: usize, every: f64, duration: f64) -> Result<Trajectory, SimulateError> {
        let gaps = self.gaps_at(levels).map_err(|error| SimulateError::Parameter(error.to_string()))?;
        let asked = Self { run: RunSpec { duration, stroke: None, ..self.run }, ..self.clone() };
        Ok(run(&asked, &gaps, every)?.trajectories.swap_remove(drive))
    }

    fn prescribed(&self, drive: usize, speeds: &[f64], step: f64) -> Option<Self> {
        let mut own = self.clone();
        let spline = spline(speeds, step, None);
        let last = [speeds.last().copied().unwrap_or_default(), 0.0, 0.0, 0.0];
        let piece = |(k, coefficients): (usize, [f64; 4])| Piece { start: step * k as f64, coefficients };
        let pieces = spline.into_iter().chain([last]).enumerate().map(piece).collect();
        let named = own.drives.get_mut(drive)?;
        named.command = Some(Command { pieces: Pieces(pieces), is_recorded: true });
        named.sampling = None;
        named.is_prescribed = true;
        // What limits the motor does not limit a motion that has been.
        named.train = named.train.map(|train| TrainData { limit: UNLIMITED, ..train });
        let fastest = speeds.iter().fold(0.0f64, |most, speed| if speed.abs() > most.abs() { *speed } else { most });
        (named.drive.speed, named.drive.ramp_start, named.drive.ramp_end) = (fastest, 0.0, step * speeds.len() as f64);
        own.set_prescribed_gains();
        Some(own)
    }
}
