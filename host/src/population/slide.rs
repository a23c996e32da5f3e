//! Units of a slide's production: on lanes in single precision, and at the desk where a verdict is in doubt.

use slipfit_core::{
    law::Elastic,
    menu::{FrictionData, SlideData},
};
use slipfit_desk::population::{Course, Figures, simulate as simulate_lanes};

use super::{
    production::Drawn,
    stroke::{self, Stroke},
    subject::Subject,
    unit::{Decisive, Fault, Unit, UnitOutcome, is_near_a_limit},
};
use crate::{
    dynamics::{
        desk,
        laws::{AnyElastic, AnySlide},
        outcome::{Moment, Verdict, between_verdicts},
        simulate::{Run, Settings, SimulateError, simulate},
    },
    mechanism::level_of,
    setup::{Adjustable, Scene, SlideParameter},
};

/// Error of the drive force that a step may make, as a share of the drive's greatest force. Single precision knows the
/// rest of a run no better.
pub const ERROR: f64 = 4e-5;

/// The same where true stick is stood for by a stick band that follows the tolerance.
pub const ERROR_OF_STICK: f64 = 2.5e-6;

impl Subject for Scene {
    fn units(&self, drawn: &Drawn) -> Result<Vec<Unit>, SimulateError> {
        units(self, drawn)
    }

    fn decisive(&self, drawn: &Drawn, asked: &[usize]) -> Result<Vec<Result<Decisive, Fault>>, SimulateError> {
        decisive(self, drawn, asked)
    }

    fn stroke(&self, drawn: &Drawn, i: usize, friction: f64, every: f64) -> Result<Stroke, SimulateError> {
        let mut own = scene_of(self, drawn, i);
        SlideParameter::Friction.change(&mut own, &mut |coefficient| coefficient * (1.0 + friction));
        let settings = Settings::desk(&own, every).to(desk::tolerance_of(&own, own.run.error.max(stroke::ERROR)));
        let Run { outcome, trajectory, .. } = simulate(&own, &drawn.gaps[i], &settings)?;
        Ok(Stroke { outcome, trajectory })
    }

    fn trouble(&self, drawn: &Drawn, i: usize) -> Option<String> {
        trouble(self, drawn, i)
    }

    fn gaps_at(&self, n: &[f64]) -> Vec<f64> {
        Scene::gaps_at(self, &std::array::from_fn(|i| level_of(n, i))).to_vec()
    }

    fn levels_of(&self, gaps: &[f64]) -> Vec<Option<f64>> {
        Scene::levels_of(self, gaps)
    }

    fn fits(&self, _: &[f64]) -> bool {
        true
    }

    fn combinations(&self) -> u64 {
        512
    }

    fn parameters(&self) -> usize {
        self.vary.len()
    }
}

/// What a scene's units are simulated for.
pub fn course(scene: &Scene) -> Course {
    let run = scene.run;
    let error = if matches!(scene.friction, FrictionData::Exact { .. }) { ERROR_OF_STICK } else { ERROR };
    Course { duration: run.duration, stroke: run.stroke, tolerance: desk::tolerance_of(scene, error) }
}

/// The scene of unit `i` of those `drawn`.
pub fn scene_of(scene: &Scene, drawn: &Drawn, i: usize) -> Scene {
    let mut own = scene.clone();
    for (varied, deviation) in scene.vary.iter().zip(&drawn.deviations[i]) {
        varied.parameter.vary(&mut own, *deviation);
    }
    own
}

/// Simulates the units that were `drawn` of a production of `scene`.
///
/// # Errors
/// [`SimulateError::Interrupted`].
pub fn units(scene: &Scene, drawn: &Drawn) -> Result<Vec<Unit>, SimulateError> {
    let all: Vec<usize> = (0..drawn.gaps.len()).collect();
    let unit = |(i, lane): (usize, Option<Lane>)| {
        let outcome = match lane {
            None => Fault::OutOfBounds.outcome(),
            Some(Lane { slide, figures }) => {
                let found = outcome(scene, &slide, &figures);
                let is_doubtful = is_doubtful(&slide, &figures, found.verdict);
                if is_doubtful { at_desk(scene, drawn, i, found)? } else { found }
            }
        };
        Ok(Unit { number: drawn.numbers.start + i as u64, gaps: drawn.gaps[i].clone(), outcome })
    };
    lanes(scene, drawn, &all).into_iter().enumerate().map(unit).collect()
}

/// A unit that ran on a lane.
struct Lane {
    slide: SlideData<f64>,
    figures: Figures,
}

/// Those of the units that were `drawn` which are `asked` for, on lanes; none of one whose parameters are out of bounds.
fn lanes(scene: &Scene, drawn: &Drawn, asked: &[usize]) -> Vec<Option<Lane>> {
    let course = course(scene);
    let slides: Vec<Option<SlideData<f64>>> = asked.iter().map(|i| slide(scene, drawn, *i, &course)).collect();
    let sound: Vec<SlideData<f64>> = slides.iter().flatten().copied().collect();
    let mut figures = simulate_lanes(course, &sound).into_iter();
    let lane = |slide: Option<SlideData<f64>>| slide.and_then(|slide| Some(Lane { slide, figures: figures.next()? }));
    slides.into_iter().map(lane).collect()
}

/// The slide of unit `i`, true stick by the law that stands for it; none whose parameters are out of bounds.
fn slide(scene: &Scene, drawn: &Drawn, i: usize, course: &Course) -> Option<SlideData<f64>> {
    let gaps = &drawn.gaps[i];
    let mut data = match scene.vary.is_empty() {
        true => scene.slide_data::<f64>(gaps),
        false => scene_of(scene, drawn, i).slide_data::<f64>(gaps),
    };
    if let (FrictionData::Exact { coefficient }, Some(stick_band)) =
        (data.friction, desk::stick_band(scene, course.tolerance))
    {
        data.friction = FrictionData::Regularised { coefficient, stick_band };
    }
    // In single precision, in which it is simulated.
    AnySlide::new(&data.cast(|x| x as f32)).ok().map(|_| data)
}

/// The speed at the end as a share of the command (m/s), and whether the run was over by then.
fn share(slide: &SlideData<f64>, figures: &Figures) -> (f64, bool) {
    let end = f64::from(figures.end);
    let command = slide.drive.command(end).abs();
    (f64::from(figures.final_velocity) / command, end >= slide.drive.ramp_end * (1.0 - 1e-6) && command > 0.0)
}

fn outcome(scene: &Scene, slide: &SlideData<f64>, figures: &Figures) -> UnitOutcome {
    let (share, over) = share(slide, figures);
    let at_end = scene.run.stroke.is_some_and(|stroke| f64::from(figures.travel) >= stroke - 2e-7);
    let number = |x: f32| Some(f64::from(x)).filter(|x| x.is_finite());
    let depth = f64::from(figures.depth);
    let force = AnyElastic::new(&slide.contact).map_or(0.0, |elastic| elastic.force(depth).0);
    UnitOutcome {
        verdict: Verdict::of(share, over || at_end),
        breakaway: number(figures.breakaway),
        peak_force: number(figures.peak_force),
        settled_force: number(figures.settled_force),
        final_velocity: f64::from(figures.final_velocity),
        end: Moment { t: f64::from(figures.end), z: f64::from(figures.travel) },
        most_loaded: (depth > 0.0).then_some((usize::from(figures.contact), force)),
        at_desk: false,
        fault: None,
    }
}

/// The decisive figures of units that were `drawn`, those that are `asked` for: by the lanes alone, unless these stall.
///
/// # Errors
/// [`SimulateError::Interrupted`].
pub fn decisive(scene: &Scene, drawn: &Drawn, asked: &[usize]) -> Result<Vec<Result<Decisive, Fault>>, SimulateError> {
    let of = |(lane, i): (Option<Lane>, &usize)| {
        let Some(Lane { slide, figures }) = lane else { return Ok(Err(Fault::OutOfBounds)) };
        let found = outcome(scene, &slide, &figures);
        let (share, _) = share(&slide, &figures);
        if !figures.stalled && share.is_finite() {
            let speed = (found.verdict != Verdict::Undecided).then_some(share);
            return Ok(Ok(Decisive { speed, force: found.peak_force }));
        }
        let found = at_desk(scene, drawn, *i, found)?;
        if let Some(fault) = found.fault {
            return Ok(Err(fault));
        }
        let command = slide.drive.command(found.end.t).abs();
        let speed = (found.verdict != Verdict::Undecided).then_some(found.final_velocity / command);
        Ok(Ok(Decisive { speed, force: found.peak_force }))
    };
    lanes(scene, drawn, asked).into_iter().zip(asked).map(of).collect()
}

/// Whether the `verdict` of a unit may be another to a better tolerance. None stays none.
fn is_doubtful(slide: &SlideData<f64>, figures: &Figures, verdict: Verdict) -> bool {
    let command = slide.drive.command(f64::from(figures.end)).abs();
    let swings = || between_verdicts(figures.end_speeds.map(|speed| f64::from(speed) / command));
    let near = || is_near_a_limit(share(slide, figures).0);
    figures.stalled || (verdict != Verdict::Undecided && (swings() || near()))
}

/// Why unit `i` of those `drawn` has no run at the desk; `None` if it has one.
pub fn trouble(scene: &Scene, drawn: &Drawn, i: usize) -> Option<String> {
    let own = scene_of(scene, drawn, i);
    simulate(&own, &drawn.gaps[i], &Settings::desk(&own, 1.0)).err().map(|error| error.to_string())
}

/// Unit `i` once more, at the desk; what only lanes know is kept of `found`.
fn at_desk(scene: &Scene, drawn: &Drawn, i: usize, found: UnitOutcome) -> Result<UnitOutcome, SimulateError> {
    let own = scene_of(scene, drawn, i);
    let outcome = match simulate(&own, &drawn.gaps[i], &Settings::desk(&own, 1.0)) {
        Ok(run) => run.outcome,
        Err(error) => return Ok(Fault::of(error)?.outcome()),
    };
    Ok(UnitOutcome {
        verdict: outcome.verdict,
        breakaway: outcome.breakaway,
        peak_force: outcome.peak_force,
        settled_force: outcome.settled_force,
        final_velocity: outcome.final_velocity,
        end: outcome.end,
        most_loaded: found.most_loaded,
        at_desk: true,
        fault: None,
    })
}
