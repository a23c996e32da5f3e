//! A unit of a scene as a model of what was recorded of its drive.

use slipfit_identify::{
    drive_train::{ComparedSamples, smoothed},
    model::{Model, ModelError, Parameter},
    record::Record,
};
use slipfit_tolerance::number::{ten_digits, three_digits};

use super::{Compared, OfRecord, SoughtValue, Unit};
use crate::{
    dynamics::{simulate::SimulateError, trajectory::Trajectory},
    setup::Adjustable,
};

/// A unit and records of its drive, which begin with the scene's run.
pub struct MotionModel<U: Unit> {
    unit: U,
    /// Tolerance levels of the gaps that are not sought.
    levels: Vec<f64>,
    of: OfRecord<U::Parameter>,
    parameters: Vec<Parameter>,
    measured: Vec<f64>,
    times: Vec<f64>,
    runs: Vec<Run<U>>,
}

/// A record without its numbers: when the samples were taken, and which of them are compared.
struct Run<U> {
    start: f64,
    step: f64,
    samples: usize,
    /// The unit that moves as measured, and how its force is filtered, where the motion is that of the record.
    along: Option<(U, ComparedSamples)>,
}

/// A record that does not fit the scene.
#[derive(Debug, thiserror::Error)]
pub enum RecordMisfit {
    /// It begins before the run.
    #[error("{record}: the record begins at {} s, and the scene's run at 0 s", ten_digits(*start))]
    Early {
        /// The record.
        record: String,
        /// Its first time (s).
        start: f64,
    },
    /// It lacks what is compared.
    #[error("{record}: the record has no {what}, which is compared")]
    Lacks {
        /// The record.
        record: String,
        /// What it lacks.
        what: &'static str,
    },
    /// Nothing can move as it was measured.
    #[error("the measured motion cannot be prescribed for this unit")]
    NotPrescribed,
}

impl Compared {
    /// Its name in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::Speed => "speed",
            Self::Position => "position",
        }
    }

    fn of_record(self, record: &Record) -> Option<&Vec<f64>> {
        match self {
            Self::Force => record.force.as_ref(),
            Self::Speed => record.speed.as_ref(),
            Self::Position => record.position.as_ref(),
        }
    }

    fn of_motion(self, motion: &Trajectory) -> &[f64] {
        match self {
            Self::Force => &motion.force,
            Self::Speed => &motion.vz,
            Self::Position => &motion.z,
        }
    }

    /// Of positions what they differ by from the first one.
    fn counted(self, mut values: Vec<f64>) -> Vec<f64> {
        if let (Self::Position, Some(first)) = (self, values.first().copied()) {
            values.iter_mut().for_each(|value| *value -= first);
        }
        values
    }
}

impl<U: Unit> MotionModel<U> {
    /// The `unit` with gaps of these `levels` and what is sought of it, beside `records`.
    ///
    /// # Errors
    /// See [`RecordMisfit`].
    pub fn new(
        unit: &U,
        levels: Vec<f64>,
        of: &OfRecord<U::Parameter>,
        records: &[Record],
    ) -> Result<Self, RecordMisfit> {
        let (mut measured, mut times, mut runs) = (Vec::new(), Vec::new(), Vec::new());
        for record in records {
            let Record { start, step, samples, ref name, .. } = *record;
            if start < 0.0 {
                return Err(RecordMisfit::Early { record: name.clone(), start });
            }
            let lacks = |what| RecordMisfit::Lacks { record: name.clone(), what };
            let along = match of.along {
                None => {
                    let values = of.compared.of_record(record).ok_or_else(|| lacks(of.compared.name()))?;
                    measured.extend(of.compared.counted(values.clone()));
                    times.extend((0..samples).map(|i| start + step * i as f64));
                    None
                }
                Some(along) => {
                    let smoothed = smoothed(record, along.cutoff);
                    let force = smoothed.force.as_ref().ok_or_else(|| lacks("force"))?;
                    measured.extend(smoothed.compared.of(force));
                    times.extend(smoothed.compared.times(record));
                    let own = unit.prescribed(of.drive, &smoothed.speed, step).ok_or(RecordMisfit::NotPrescribed)?;
                    Some((own, smoothed.compared))
                }
            };
            // A motion that was measured begins with its record.
            runs.push(Run { start: if along.is_some() { 0.0 } else { start }, step, samples, along });
        }
        let start = |value: &SoughtValue<U::Parameter>| match value {
            SoughtValue::Parameter(parameter) => parameter.values(unit).first().copied(),
            SoughtValue::Level(gaps) => gaps.first().and_then(|gap| levels.get(*gap).copied()),
            SoughtValue::Delay => None,
        };
        let parameter = |sought: &super::Sought<U::Parameter>| {
            let stated = sought.prior.map(|[mean, _]| mean).or(start(&sought.value)).unwrap_or_default();
            Parameter {
                name: sought.name.clone(),
                unit: sought.unit,
                bounds: sought.bounds,
                start: stated.clamp(sought.bounds[0], sought.bounds[1]),
                prior: sought.prior,
            }
        };
        let parameters = of.sought.iter().map(parameter).collect();
        Ok(Self { unit: unit.clone(), levels, of: of.clone(), parameters, measured, times, runs })
    }

    /// What should have been recorded of a `run` of a unit with these `values`.
    fn output(&self, run: &Run<U>, values: &[f64]) -> Result<Vec<f64>, SimulateError> {
        let mut unit = run.along.as_ref().map_or(&self.unit, |(unit, _)| unit).clone();
        let (mut levels, mut delay) = (self.levels.clone(), 0.0);
        for (sought, value) in self.of.sought.iter().zip(values) {
            match &sought.value {
                SoughtValue::Parameter(parameter) => parameter.set(&mut unit, *value),
                SoughtValue::Level(gaps) => gaps.iter().for_each(|gap| levels[*gap] = *value),
                SoughtValue::Delay => delay = *value,
            }
        }
        let Run { start, step, samples, .. } = *run;
        let motion = unit.motion(&levels, self.of.drive, step, start + step * samples as f64)?;
        let computed = self.of.compared.of_motion(&motion);
        let at = |i: usize| {
            // Where a run ended early nothing changes any more.
            let place = ((start - delay) / step + i as f64).clamp(0.0, computed.len() as f64 - 1.0);
            let before = (place as usize).min(computed.len().saturating_sub(2));
            let share = place - before as f64;
            computed[before] + share * (computed[before + 1] - computed[before])
        };
        let mut all = self.of.compared.counted((0..samples).map(at).collect());
        let Some((_, compared)) = &run.along else { return Ok(all) };
        // The jump from rest to a record that begins in motion has an infinite force.
        if let [first, second, ..] = &mut all[..] {
            *first = *second;
        }
        Ok(compared.of(&all))
    }
}

impl<U> Run<U> {
    /// The number of samples that are compared.
    fn compared(&self) -> usize {
        self.along.as_ref().map_or(self.samples, |(_, compared)| compared.count())
    }

    /// Whether it has the motion of another run, so that the two differ by their noise alone.
    fn repeats(&self, other: &Self) -> bool {
        let clock = |run: &Self| (run.start, run.step, run.samples);
        self.along.is_none() && other.along.is_none() && clock(self) == clock(other)
    }
}

impl<U: Unit> Model for MotionModel<U> {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn measured(&self) -> &[f64] {
        &self.measured
    }

    fn runs(&self) -> Vec<usize> {
        self.runs.iter().map(Run::compared).collect()
    }

    fn times(&self) -> Vec<f64> {
        self.times.clone()
    }

    fn simulate(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        let mut output: Vec<f64> = Vec::with_capacity(self.measured.len());
        let mut before: Option<(&Run<U>, usize)> = None;
        for run in &self.runs {
            if let Some((_, at)) = before.filter(|(other, _)| run.repeats(other)) {
                output.extend_from_within(at..at + run.compared());
                continue;
            }
            before = Some((run, output.len()));
            output.extend(self.output(run, values).map_err(|error| {
                let named = self.parameters.iter().zip(values);
                let written = named.map(|(parameter, value)| {
                    parameter.written(&format!("{} = {}", parameter.name, three_digits(*value)))
                });
                ModelError { values: written.collect::<Vec<_>>().join(", "), why: error.to_string() }
            })?);
        }
        Ok(output)
    }
}
