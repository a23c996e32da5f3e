//! What one unit of a population did, and how surely.

use serde::Serialize;
use slipfit_core::{
    law::Elastic,
    menu::{FrictionData, SlideData},
};

use crate::{
    dynamics::{
        desk,
        laws::{AnyElastic, AnySlide},
        outcome::{JAMMED, Moment, RUNS, Verdict, between_verdicts},
        simulate::{Settings, SimulateError, simulate},
    },
    setup::Scene,
};

use super::{Course, Figures, Unit, production::Drawn};

/// Error of the drive force that a step may make, as a share of the drive's greatest force. Single precision knows the
/// rest of a run no better.
pub const ERROR: f64 = 4e-5;

/// The same where true stick is stood for by a stick band that follows the tolerance.
pub const ERROR_OF_STICK: f64 = 2.5e-6;

/// Units whose final speed, as a share of the command, is this near to a limit between two verdicts are simulated once more
/// at the desk: relative to the limit. Of 12,000 units of two scenes no speed was off by more than a hundredth of that.
const DOUBT: f64 = 0.01;

/// Figures of one unit. Speeds, forces and travel count along the commanded direction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct UnitOutcome {
    /// Verdict at the end.
    pub verdict: Verdict,
    /// Breakaway time (s), if the unit breaks away.
    pub breakaway: Option<f64>,
    /// Magnitude of the greatest force, driving or braking, from the ramp's start on (N); none if the run ends before.
    pub peak_force: Option<f64>,
    /// Mean force over the last 20 ms (N), if it varies by less than 1 %.
    pub settled_force: Option<f64>,
    /// Velocity at the end (m/s).
    pub final_velocity: f64,
    /// The end of the run.
    pub end: Moment,
    /// The contact that was pressed in deepest, in the order of Table 2, and its elastic force (N) then; none if none
    /// was.
    pub most_loaded: Option<(usize, f64)>,
    /// Whether the desk computed it.
    pub at_desk: bool,
    /// Why there is no run, if there is none.
    pub fault: Option<Fault>,
}

/// Why a unit has no run, and so no figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fault {
    /// Its joints do not allow its gaps: it is jammed where it stands.
    Unassembled,
    /// No step of the desk meets the tolerance.
    Unsolved,
    /// One of its parameters is out of bounds.
    OutOfBounds,
}

/// Faults, in the order in which units are counted by them.
pub const FAULTS: [Fault; 3] = [Fault::Unassembled, Fault::Unsolved, Fault::OutOfBounds];

impl Fault {
    /// Of one unit.
    ///
    /// # Errors
    /// What has nothing to do with the unit: somebody asked to stop.
    pub fn of(error: SimulateError) -> Result<Self, SimulateError> {
        match error {
            SimulateError::Unsolved { .. } | SimulateError::NotFinite { .. } => Ok(Self::Unsolved),
            SimulateError::Parameter(_) => Ok(Self::OutOfBounds),
            SimulateError::Every { .. } | SimulateError::Interrupted => Err(error),
        }
    }

    /// What a unit with it did.
    pub fn outcome(self) -> UnitOutcome {
        UnitOutcome {
            verdict: if self == Self::Unassembled { Verdict::Jammed } else { Verdict::Undecided },
            breakaway: None,
            peak_force: None,
            settled_force: None,
            final_velocity: 0.0,
            end: Moment { t: 0.0, z: 0.0 },
            most_loaded: None,
            at_desk: false,
            fault: Some(self),
        }
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
        varied.parameter.apply(&mut own, *deviation);
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
        Ok(Unit { number: drawn.numbers.start + i as u64, gaps: drawn.gaps[i], outcome })
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
    let mut figures = super::simulate(course, &sound).into_iter();
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

/// The figures that decide whether a unit does its job.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decisive {
    /// Speed at the end as a share of the command; none where no verdict follows from it.
    pub speed: Option<f64>,
    /// Magnitude of the greatest force (N), driving or braking, from the ramp's start on.
    pub force: Option<f64>,
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

/// Whether a final speed, as a `share` of the command, is so near to a limit between two verdicts that a better run has to decide.
pub fn is_near_a_limit(share: f64) -> bool {
    let near = |limit: f64| (share / limit - 1.0).abs() < DOUBT;
    !share.is_finite() || near(RUNS) || near(JAMMED)
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
