//! A slide as a unit that is sought.

use slipfit_core::slide::CONTACTS;

use super::Unit;
use crate::{
    dynamics::{
        simulate::{Settings, SimulateError, simulate},
        trajectory::Trajectory,
    },
    setup::{Scene, SlideParameter},
};

impl Unit for Scene {
    type Parameter = SlideParameter;

    fn motion(&self, levels: &[f64], _: usize, every: f64, duration: f64) -> Result<Trajectory, SimulateError> {
        let mut settings = Settings::desk(self, every);
        // A record goes on where the stroke ends, as far as it goes.
        settings.run.stroke = None;
        settings.run.duration = duration;
        let mut all = [0.0; CONTACTS];
        all.iter_mut().zip(levels).for_each(|(all, level)| *all = *level);
        Ok(simulate(self, &self.gaps_at(&all), &settings)?.trajectory)
    }

    fn prescribed(&self, _: usize, _: &[f64], _: f64) -> Option<Self> {
        None
    }
}
