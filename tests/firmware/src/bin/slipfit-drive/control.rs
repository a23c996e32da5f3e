//! What a controller does once a millisecond: predict, watch, estimate, check its table. Take it over into an image of your own.

use slipfit_core::{
    ParameterError,
    ahead::{self, Ahead},
    drive::{Drive, SetpointDrive},
    law::{Friction, Impact, Regularised, ThreeHalves},
    menu::ContactData,
    monitor::{LevelBank, Limits, Monitor, Sample, Verdict, Watch},
    pose::Pose,
    slide::Slide,
    table::{F32Nodes, Scrubber, Table},
};

use crate::scene::{SCENE, STEP};

/// The flash table and the region it lies in.
pub type Flashed = (Table<'static>, &'static [u8]);

/// Bytes of the table that are checked in a period: once round in a second.
const SCRUBBED: usize = 256;

/// Periods before the motion's start in which the prediction takes its lead.
const EARLY: u32 = 70;

/// The stick band (m/s) in place of exact friction, which prediction ahead of the clock cannot have.
const STICK_BAND: f32 = 1e-5;

/// The prediction of a unit, ahead of the clock.
pub type Prediction = Ahead<f32, Slide<f32, ThreeHalves<f32>, Regularised<f32>, [f32; 4], SetpointDrive<f32>>>;

/// What it keeps: too much for the stack, so that there is one, in its place.
pub type Motions = ahead::State<f32, Pose<f32>, 6, 128>;

/// A function of its own, so that its stack does not add up with that of the rest.
#[inline(never)]
fn step((prediction, ramp): &mut (Prediction, Drive<f32>), motions: &mut Motions) -> ahead::Prediction<f32> {
    let horizon = prediction.horizon(motions);
    let speed = ramp.command(prediction.time(motions, horizon + 1));
    prediction.plan(motions, horizon, speed);
    prediction.step(motions)
}

/// What there is to say of a period.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Record {
    /// Periods since the motion's start.
    pub periods: u32,
    /// Measured force (N).
    pub measured: f32,
    /// Force that is predicted for the level the unit is taken for (N).
    pub predicted: f32,
    /// By how much (s) the prediction is ahead of the clock; negative where it is of an earlier time.
    pub lead: f32,
    /// Force that the table has for it (N).
    pub expected: f32,
    /// The monitor's verdict.
    pub verdict: Verdict,
    /// What the clock counted while predicting and watching.
    pub cost: u32,
}

/// All that watches a unit.
pub struct Control {
    periods: u32,
    /// With the ramp that the command takes.
    prediction: (Prediction, Drive<f32>),
    /// Given to the next control.
    pub motions: &'static mut Motions,
    monitor: Monitor<'static, F32Nodes<'static>>,
    watch: Watch,
    /// Over all levels of the table.
    pub bank: LevelBank<'static, F32Nodes<'static>, 32>,
    scrubber: Scrubber,
    region: &'static [u8],
    /// Rounds in which the table had changed.
    pub damaged: u32,
}

/// A unit of `level`, with the friction that `law` makes of the scene's coefficient.
///
/// # Errors
/// If the level is out of bounds.
pub fn unit<F: Friction<f32>>(
    level: f32,
    law: impl FnOnce(f32) -> Result<F, ParameterError<f32>>,
) -> Result<Slide<f32, ThreeHalves<f32>, F>, ParameterError<f32>> {
    let unit = SCENE.at(level)?;
    let ContactData { stiffness, damping, depth, .. } = unit.contact;
    let contact = Impact::new(ThreeHalves::new(stiffness)?, damping, depth)?;
    unit.body.slide(contact, law(unit.friction.coefficient())?, unit.drive)
}

/// The prediction of a unit of `level`, and the ramp that its command takes.
///
/// # Panics
/// If the level is out of bounds.
pub fn prediction(level: f32) -> (Prediction, Drive<f32>) {
    let limits = ahead::Limits { period: STEP, tolerance: 7e-5, lead: 0.2, lag: 0.2, attempts: 1 };
    let unit = unit(level, |coefficient| Regularised::new(coefficient, STICK_BAND)).expect("the level is in bounds");
    let ramp = *unit.drive();
    let led = unit.driven_by(SetpointDrive::new(ramp.gain)).and_then(|led| Ahead::new(led, limits));
    (led.expect("the scene's gain is in bounds"), ramp)
}

impl Control {
    /// For a unit that is `taken_for` this tolerance level, at the motion's start. The `noise` (N) is the standard deviation of a good
    /// unit's force from the table's.
    ///
    /// # Panics
    /// If the level is out of bounds or the table is not one in f32 over few levels and time.
    pub fn new(taken_for: f32, noise: f32, (flashed, region): Flashed, motions: &'static mut Motions) -> Self {
        let mut prediction = prediction(taken_for);
        let ramp = prediction.1;
        prediction.0.put_at_rest(motions, Pose::nominal(), EARLY, |t| ramp.command(t));
        (0..EARLY).for_each(|_| _ = step(&mut prediction, motions));
        let table = flashed.f32().expect("the table's values are f32");
        let limits = Limits { blind: 0.2, force_most: 3.5, ..Limits::for_noise(STEP, noise) };
        Self {
            periods: 0,
            prediction,
            motions,
            monitor: Monitor::new(table, taken_for, limits).expect("the limits are in bounds"),
            watch: Watch::default(),
            bank: LevelBank::new(table).expect("the table is over few levels and time"),
            scrubber: Scrubber::new(&flashed),
            region,
            damaged: 0,
        }
    }

    /// When the next period ends (s), from the motion's start.
    pub fn time(&self) -> f32 {
        self.periods.saturating_add(1) as f32 * STEP
    }

    /// One period, at whose end the drive measures `sample`. `clock` counts.
    pub fn tick(&mut self, sample: &Sample, clock: impl Fn() -> u32) -> Record {
        self.periods = self.periods.saturating_add(1);

        let start = clock();
        let ahead::Prediction { force: predicted, lead, .. } = step(&mut self.prediction, self.motions);
        let report = self.monitor.step(&mut self.watch, sample);
        self.bank.add(sample.time, sample.force);
        if self.scrubber.check(self.region, SCRUBBED).is_err() {
            self.damaged = self.damaged.saturating_add(1);
        }
        let cost = clock().wrapping_sub(start);
        let (periods, expected) = (self.periods, report.tightness.expected);
        Record { periods, measured: sample.force, predicted, lead, expected, verdict: report.verdict, cost }
    }
}
