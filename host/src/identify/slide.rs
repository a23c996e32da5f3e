//! The slide of a scene as a model of its drive's force over time.

use slipfit_core::slide::CONTACTS;
use slipfit_identify::{
    model::{Model, ModelError, Parameter},
    record::Record,
};
use slipfit_tolerance::number::{ten_digits, three_digits};

use crate::{
    dynamics::simulate::{Settings, SimulateError, simulate},
    setup::{Scene, Sought},
};

/// A slide and the records of its drive's force, which begin with the scene's run.
pub struct SlideModel {
    scene: Scene,
    /// Tolerance levels of the gaps that are not sought.
    levels: [f64; CONTACTS],
    sought: Vec<Sought>,
    parameters: Vec<Parameter>,
    measured: Vec<f64>,
    clocks: Vec<Clock>,
}

/// When the samples of a record were taken.
#[derive(Clone, Copy, PartialEq)]
struct Clock {
    start: f64,
    step: f64,
    samples: usize,
}

/// A record that does not fit the scene's run.
#[derive(Debug, thiserror::Error)]
#[error("{record}: the record begins at {} s, and the scene's run at 0 s", ten_digits(*start))]
pub struct EarlyRecord {
    /// The record.
    pub record: String,
    /// Its first time (s).
    pub start: f64,
}

impl SlideModel {
    /// The slide of `scene` with gaps of these `levels` and what is `sought` of it, beside `records` with a force.
    ///
    /// # Errors
    /// A record that begins before the run.
    pub fn new(
        scene: &Scene,
        levels: [f64; CONTACTS],
        sought: &[Sought],
        records: &[Record],
    ) -> Result<Self, EarlyRecord> {
        if let Some(early) = records.iter().find(|record| record.start < 0.0) {
            return Err(EarlyRecord { record: early.name.clone(), start: early.start });
        }
        let parameter = |sought: &Sought| Parameter {
            name: sought.name.clone(),
            unit: sought.value.unit(),
            bounds: sought.bounds,
            start: sought.value.of(scene, &levels).clamp(sought.bounds[0], sought.bounds[1]),
        };
        let clock = |record: &Record| Clock { start: record.start, step: record.step, samples: record.samples };
        Ok(Self {
            scene: scene.clone(),
            levels,
            sought: sought.to_vec(),
            parameters: sought.iter().map(parameter).collect(),
            measured: records.iter().flat_map(|record| record.force.iter().flatten().copied()).collect(),
            clocks: records.iter().map(clock).collect(),
        })
    }

    /// The force (N) at the samples of a record.
    fn force(&self, scene: &Scene, levels: &[f64; CONTACTS], clock: Clock) -> Result<Vec<f64>, SimulateError> {
        let Clock { start, step, samples } = clock;
        let mut settings = Settings::desk(scene, step);
        // A record goes on where the stroke ends, as far as it goes.
        settings.run.stroke = None;
        settings.run.duration = start + step * samples as f64;
        let run = simulate(scene, &scene.gaps_at(levels), &settings)?;
        let force = &run.trajectory.force;
        let at = |i: usize| {
            let place = start / step + i as f64;
            let before = (place as usize).min(force.len().saturating_sub(2));
            let share = place - before as f64;
            force[before] + share * (force[before + 1] - force[before])
        };
        Ok((0..samples).map(at).collect())
    }
}

impl Model for SlideModel {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn measured(&self) -> &[f64] {
        &self.measured
    }

    fn runs(&self) -> Vec<usize> {
        self.clocks.iter().map(|clock| clock.samples).collect()
    }

    fn simulate(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        let (mut scene, mut levels) = (self.scene.clone(), self.levels);
        for (sought, value) in self.sought.iter().zip(values) {
            sought.value.set(&mut scene, &mut levels, *value);
        }
        let mut output: Vec<f64> = Vec::with_capacity(self.measured.len());
        let mut before: Option<(Clock, usize)> = None;
        for clock in &self.clocks {
            // Runs of one clock are one run: they differ by their noise alone.
            if let Some((_, at)) = before.filter(|(other, _)| other == clock) {
                output.extend_from_within(at..at + clock.samples);
                continue;
            }
            before = Some((*clock, output.len()));
            let force = self.force(&scene, &levels, *clock).map_err(|error| {
                let written: Vec<_> = self
                    .parameters
                    .iter()
                    .zip(values)
                    .map(|(parameter, value)| {
                        parameter.written(&format!("{} = {}", parameter.name, three_digits(*value)))
                    })
                    .collect();
                ModelError { values: written.join(", "), why: error.to_string() }
            })?;
            output.extend(force);
        }
        Ok(output)
    }
}
