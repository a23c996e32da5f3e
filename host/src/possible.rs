//! Productions that measured parts leave possible: few parts do not determine a distribution.

use slipfit_core::sampling::stream::derived;
use slipfit_system::parallel;
use slipfit_tolerance::{
    analysis::analyse,
    counting::study::{Settings, StudyError},
    model::Model,
    report::{Report, report},
};

use crate::setup::Measured;

/// Productions that are drawn: their extreme fortieths are the ends of intervals.
pub const PRODUCTIONS: usize = 120;
/// The most units of each, as their sampling errors are known and taken away.
const UNITS: u64 = 5000;
/// What their seeds are derived with.
const STREAM: u64 = 5 << 32;

/// Reports of productions of `model` that the `measured` parts leave possible, with the `settings` of its study. `done` is
/// called after each.
///
/// # Errors
/// [`StudyError`], if one cannot be drawn or somebody asked to stop.
pub fn reports(
    model: &Model,
    measured: &Measured,
    settings: Settings,
    done: impl Fn() + Sync,
) -> Result<Vec<Report>, StudyError> {
    let units = (UNITS / settings.replicates).clamp(2, settings.units()) * settings.replicates;
    let one = |number: usize| {
        let number = number as u64;
        let own = measured.model(model, &measured.production.drawn(number));
        let settings = Settings { samples: units, seed: derived(settings.seed, STREAM + number), ..settings };
        let found = analyse(&own, settings, |_| ())?;
        done();
        Ok(report("", &own, &found))
    };
    parallel::each(PRODUCTIONS, one).into_iter().collect()
}

/// What a report says of the `measured` parts.
pub fn note(measured: &Measured) -> String {
    let of = |i: usize| {
        let (parts, shape) = (measured.production.parts(i), measured.production.shape(i));
        format!("{} ({parts} parts, {shape})", measured.names[i])
    };
    let all: Vec<String> = (0..measured.names.len()).map(of).collect();
    format!("measured: {}; intervals include what these parts leave open", all.join(", "))
}
