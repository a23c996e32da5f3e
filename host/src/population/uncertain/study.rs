//! Units at values of what is unknown.

use std::ops::Range;

use slipfit_system::parallel;
use slipfit_tolerance::numeric::normal::{quantile, tail};

use super::{
    answer::{Answer, Tried, UnknownReport, forces},
    design::Design,
    unknown::Unknown,
};
use crate::{
    dynamics::simulate::SimulateError,
    mechanism::ByDrive,
    population::{
        production::Production,
        simulate_units,
        subject::Subject,
        tally::{Counter, Counts, Duty},
    },
    setup::{Measured, Scene},
};

/// What units did at one value: their counts, and the greatest forces (N) that half and 95 % of them do not exceed.
pub type Counted = (Counts, Option<[f64; 2]>);

/// The units `numbers` of a `production` of `subject` with this `duty`; `done` is called with how many are simulated.
///
/// # Errors
/// See [`simulate_units`].
pub fn counted(
    subject: &dyn Subject,
    production: &Production,
    numbers: Range<u64>,
    duty: Duty,
    done: impl Fn(u64) + Sync,
) -> Result<Counted, SimulateError> {
    let counter = Counter::new(subject, duty);
    let mut tally = counter.nothing();
    simulate_units(subject, production, numbers, done, |_, units| counter.add(&mut tally, units))?;
    Ok((tally.counts, forces(&tally.figures.force)))
}

/// What the production of `model` does with the values of a `design` of the `unknowns`, and with what `measured` parts leave open, on all threads of the current pool: `count` counts
/// units of a model at a value, both by their numbers. The result does not depend on the number of threads.
///
/// # Errors
/// Those of `count`.
pub fn study<M: Clone + Sync>(
    model: &M,
    unknowns: &[&dyn Unknown<M>],
    measured: Option<&Measured>,
    design: Design,
    duty: Duty,
    count: impl Fn(&M, u64, Range<u64>) -> Result<Counted, SimulateError> + Sync,
) -> Result<Answer, SimulateError> {
    // Shares of the variance are those of independent coordinates: the first of correlated unknowns has what they share.
    let points = design.points(unknowns.iter().map(|unknown| unknown.coordinates()).sum());
    let tried = |value: usize| {
        let (mut own, mut at, mut shown) = (model.clone(), 0, Vec::with_capacity(unknowns.len()));
        let mut correlated = points[value].clone();
        correlate(unknowns, &mut correlated);
        for unknown in unknowns {
            let point = &correlated[at..at + unknown.coordinates()];
            at += point.len();
            unknown.apply(point, &mut own);
            shown.push(unknown.shown(point));
        }
        let (counts, force) = count(&own, value as u64, design.units_of(value as u64))?;
        Ok(Tried { point: points[value].clone(), shown, counts, force })
    };
    let tried: Vec<Tried> = parallel::each(points.len(), tried).into_iter().collect::<Result<_, SimulateError>>()?;
    let report = |(i, unknown): (usize, &&dyn Unknown<M>)| UnknownReport {
        name: unknown.name().to_owned(),
        unit: unknown.unit().to_owned(),
        tried: tried.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], tried| {
            [low.min(tried.shown[i]), high.max(tried.shown[i])]
        }),
        coordinates: unknown.coordinates(),
    };
    let unknowns = unknowns.iter().enumerate().map(report).collect();
    let measured = measured.map(|measured| measured.names.clone()).unwrap_or_default();
    Ok(Answer::of(unknowns, measured, &tried, design.units_each, duty))
}

/// Gives a `point` of independent coordinates the correlations of the `unknowns`, by their normal scores.
fn correlate<M>(unknowns: &[&dyn Unknown<M>], point: &mut [f64]) {
    if unknowns.iter().all(|unknown| unknown.weights().is_empty()) {
        return;
    }
    let scores: Vec<f64> = point.iter().map(|share| quantile(*share)).collect();
    for (k, unknown) in unknowns.iter().enumerate().filter(|(_, unknown)| !unknown.weights().is_empty()) {
        let score: f64 = unknown.weights().iter().zip(&scores).map(|(weight, score)| weight * score).sum();
        point[k] = tail(-score);
    }
}

/// The production of this number that measured parts leave possible beside the likeliest one; none where nothing was measured.
fn possible<'a>(production: &Production<'a>, number: u64) -> Option<Production<'a>> {
    // The likeliest can be drawn, and these have its correlations where their own contradict what the scene states.
    production.possible(number)?.ok()
}

/// Of a `production` of `scene`.
///
/// # Errors
/// See [`simulate_units`].
pub fn of_slide(
    scene: &Scene,
    production: &Production,
    design: Design,
    duty: Duty,
    done: impl Fn(u64) + Sync,
) -> Result<Answer, SimulateError> {
    let unknowns: Vec<&dyn Unknown<Scene>> = scene.uncertain.iter().map(|one| one as _).collect();
    study(scene, &unknowns, scene.measured.as_deref(), design, duty, |own, value, numbers| {
        counted(own, possible(production, value).as_ref().unwrap_or(production), numbers, duty, &done)
    })
}

/// Of a `production` of a mechanism by one of its drives.
///
/// # Errors
/// See [`simulate_units`].
pub fn of_mechanism(
    driven: &ByDrive,
    production: &Production,
    design: Design,
    duty: Duty,
    done: impl Fn(u64) + Sync,
) -> Result<Answer, SimulateError> {
    let mechanism = driven.mechanism();
    let unknowns: Vec<&dyn Unknown<_>> = mechanism.uncertain.iter().map(|one| one as _).collect();
    study(mechanism, &unknowns, mechanism.measured.as_deref(), design, duty, |own, value, numbers| {
        let own = ByDrive::new(own, driven.index()).expect("the drive of the same mechanism");
        counted(&own, possible(production, value).as_ref().unwrap_or(production), numbers, duty, &done)
    })
}
