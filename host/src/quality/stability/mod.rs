//! The stability map: how far from the paper's slide a fixed step still holds, and whether a run that does not hold says so.
//!
//! Every point is run as the controller runs it with an account of its energy, once more by the desk, or else with a quarter of
//! the step, for its error, and once at rest: without a drive and with no gap closed, where nothing may gain energy. Points are independent and their
//! random numbers a function of seed and index, so that the map does not depend on the number of threads.

mod factor;
mod generator;

use serde::Serialize;

use slipfit_system::parallel;

use crate::{
    dynamics::{
        confirm::against,
        controller::audited,
        simulate::{Run, Settings, SimulateError, simulate},
    },
    setup::Scene,
};

pub use factor::{FACTORS, Factor, Range, SCHEMES, STEP, Setup, Zero};
use generator::SplitMix64;

/// Tolerance level of the points that vary something else.
pub const LEVEL: f64 = 2.5;

/// A drive force off by more than this share of its peak from t = 50 ms on is wrong.
pub const WRONG: f64 = 0.05;

/// What a slide may gain in energy where it cannot, as a share of the energy exchanged.
pub const GROWTH: f64 = 0.01;

/// Time (s) from which errors count.
const LATE: f64 = 0.05;

/// Least gap (m) of the variant at rest.
const REST_GAP: f64 = 1e-5;

/// A point of the map.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// Scheme.
    pub integrator: &'static str,
    /// The factor varied, or "random".
    pub factor: &'static str,
    /// Its value; of a random point all values in the order of [`FACTORS`].
    pub values: Vec<f64>,
    /// How it went; `None` if the run left the finite range and stopped.
    pub indicators: Option<Indicators>,
}

/// How a run went.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Indicators {
    /// Worst energy defect over the energy exchanged.
    pub defect: f64,
    /// Greatest elastic energy over what there was to fill it; above 1 + [`GROWTH`] contacts are deeper than energy
    /// allows.
    pub filling: f64,
    /// Greatest rise of energy at rest over the energy exchanged; infinite if that run did not stay finite.
    pub rise: f64,
    /// See [`Trust`](crate::dynamics::trust::Trust).
    pub imbalance: f64,
    /// See [`Trust`](crate::dynamics::trust::Trust).
    pub doubtful_force: f64,
    /// See [`Trust`](crate::dynamics::trust::Trust).
    pub difference: Option<f64>,
    /// Greatest force error from 50 ms on over the peak force, against the desk; infinite if there is nothing to hold
    /// it against.
    pub error: f64,
    /// Whether the run itself says that its step is too large.
    pub warned: bool,
}

/// A point in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Grade {
    /// Right, and says so.
    Sound,
    /// Right from 50 ms on, but warns.
    Cautious,
    /// Wrong, and warns.
    Warned,
    /// Stopped with an error, because the motion left the finite range.
    Stopped,
    /// Wrong without a warning.
    Silent,
}

impl Point {
    /// The point in one word.
    pub fn grade(&self) -> Grade {
        match &self.indicators {
            None => Grade::Stopped,
            Some(indicators) => match (indicators.is_wrong(), indicators.warned) {
                (false, false) => Grade::Sound,
                (false, true) => Grade::Cautious,
                (true, true) => Grade::Warned,
                (true, false) => Grade::Silent,
            },
        }
    }
}

impl Indicators {
    /// Whether the force is wrong from 50 ms on, or energy appeared from nowhere.
    pub fn is_wrong(&self) -> bool {
        self.error > WRONG || self.filling > 1.0 + GROWTH
    }
}

/// The factors one at a time, at [`LEVEL`], for every scheme in turn. `done` is called after each point.
///
/// # Errors
/// The first point's [`SimulateError`] other than a motion that left the finite range.
pub fn one_at_a_time(scene: &Scene, done: impl Fn() + Sync) -> Result<Vec<Point>, SimulateError> {
    let points = SCHEMES.into_iter().flat_map(|scheme| {
        FACTORS.into_iter().flat_map(move |factor| {
            factor.range.values().into_iter().map(move |value| {
                let mut setup = Setup::new(scene.clone(), LEVEL);
                setup.scene.controller.integrator = scheme;
                (factor.set)(&mut setup, value);
                (factor.name, vec![value], setup)
            })
        })
    });
    judged(points.collect(), done)
}

/// How many points [`one_at_a_time`] has.
pub fn one_at_a_time_count() -> usize {
    SCHEMES.len() * FACTORS.iter().map(|factor| factor.range.values().len()).sum::<usize>()
}

/// The random point `index` under `seed`: a combination of all factors and schemes, and the factors' values.
pub fn random_setup(scene: &Scene, seed: u64, index: usize) -> (Vec<f64>, Setup) {
    let mut generator = SplitMix64::new(seed, index as u64);
    let mut setup = Setup::new(scene.clone(), LEVEL);
    setup.scene.controller.integrator = SCHEMES[(generator.share() * SCHEMES.len() as f64) as usize];
    let values: Vec<f64> = FACTORS.iter().map(|factor| factor.range.at(generator.share())).collect();
    for (factor, value) in FACTORS.iter().zip(&values) {
        (factor.set)(&mut setup, *value);
    }
    (values, setup)
}

/// `count` random combinations of all factors and schemes. `done` is called after each point.
///
/// # Errors
/// As for [`one_at_a_time`].
pub fn random(scene: &Scene, seed: u64, count: usize, done: impl Fn() + Sync) -> Result<Vec<Point>, SimulateError> {
    let points = (0..count).map(|i| random_setup(scene, seed, i));
    judged(points.map(|(values, setup)| ("random", values, setup)).collect(), done)
}

fn judged(points: Vec<(&'static str, Vec<f64>, Setup)>, done: impl Fn() + Sync) -> Result<Vec<Point>, SimulateError> {
    parallel::try_map(&points, |(factor, values, setup)| {
        let integrator = setup.scene.controller.integrator.name();
        let indicators = indicators(setup);
        done();
        Ok(Point { integrator, factor, values: values.clone(), indicators: indicators? })
    })
}

/// The run, unless it left the finite range or the desk found no step short enough.
fn finite(run: Result<Run, SimulateError>) -> Result<Option<Run>, SimulateError> {
    match run {
        Ok(run) => Ok(Some(run)),
        Err(SimulateError::NotFinite { .. } | SimulateError::Unsolved { .. }) => Ok(None),
        Err(other) => Err(other),
    }
}

fn indicators(setup: &Setup) -> Result<Option<Indicators>, SimulateError> {
    let (gaps, settings) = (setup.gaps(), setup.settings());
    let Some(run) = finite(audited(&setup.scene, &gaps, &settings))? else { return Ok(None) };
    let truth = match finite(simulate(&setup.scene, &gaps, &Settings::desk(&setup.scene, settings.every)))? {
        Some(truth) => Some(truth),
        // Where nothing is smooth enough for error control.
        None => finite(simulate(&setup.scene, &gaps, &settings.by(setup.finer())))?,
    };
    let run = match &truth {
        Some(truth) => against(truth, &setup.scene, &settings, run),
        None => run,
    };
    let mut undriven = setup.scene.clone();
    undriven.drive.gain = 0.0;
    let at_rest = finite(audited(&undriven, &gaps.map(|gap| gap.max(REST_GAP)), &settings))?;
    let audit = run.audit.unwrap_or_default();
    Ok(Some(Indicators {
        defect: audit.relative_defect(),
        filling: audit.filling,
        rise: at_rest.and_then(|run| run.audit).map_or(f64::INFINITY, |audit| audit.relative_rise()),
        imbalance: run.trust.imbalance,
        doubtful_force: run.trust.doubtful_force,
        difference: run.trust.difference,
        error: truth.map_or(f64::INFINITY, |truth| run.trajectory.greatest_difference(&truth.trajectory, LATE)),
        warned: !run.trust.is_sound(),
    }))
}

/// How many points have each grade, in the order of [`Grade`].
pub fn tally(points: &[Point]) -> [(Grade, usize); 5] {
    [Grade::Sound, Grade::Cautious, Grade::Warned, Grade::Stopped, Grade::Silent]
        .map(|grade| (grade, points.iter().filter(|point| point.grade() == grade).count()))
}
