//! What the interrupt does once a millisecond: measure, predict, watch.

use slipfit_core::{
    ParameterError,
    ahead::{self, Ahead},
    kernel::{Kernel, StateOf},
    law::{Exact, Friction, Impact, Regularised, ThreeHalves},
    menu::ContactData,
    monitor::{LevelBank, Limits, Monitor, Sample, Verdict, Watch},
    pose::Pose,
    sampling::{
        normal::score,
        stream::{Rng, Xoshiro256PlusPlus, unit_stream},
    },
    slide::Slide,
    table::{F32Nodes, Scrubber, Table},
};

use crate::scene::{Predictor, SCENE, STEP, Unit};

/// The flash table and the region it lies in.
pub type Flashed = (Table<'static>, &'static [u8]);

/// Bytes of the table that are checked in a period: once round in a second.
const SCRUBBED: usize = 256;

/// Steps in which the unit itself moves through a period, finer than the predictor's.
const PLANT_STEPS: u32 = 4;

/// Periods before the motion's start in which the prediction takes its lead.
const EARLY: u32 = 70;

/// The stick band (m/s) in place of exact friction, which prediction ahead of the clock cannot have.
const STICK_BAND: f32 = 1e-5;

/// The prediction of a unit, ahead of the clock.
pub type Prediction = Ahead<f32, Slide<f32, ThreeHalves<f32>, Regularised<f32>>>;

/// What it keeps: too much for the stack, so that there is one, in its place.
pub type Motions = ahead::State<f32, Pose<f32>, 6, 128>;

/// A unit on its rig.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rig {
    /// Its tolerance level.
    pub level: f32,
    /// Its friction coefficient over the scene's.
    pub friction: f32,
    /// The tolerance level it is taken for.
    pub taken_for: f32,
    /// Standard deviation of the noise of its force sensor (N).
    pub noise: f32,
    /// Seed of the noise.
    pub seed: u64,
}

/// A function of its own, as is the plant's step, so that their stacks do not add up.
#[inline(never)]
fn step(prediction: &Prediction, motions: &mut Motions) -> ahead::Prediction<f32> {
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

/// The plant and all that watches it.
pub struct Control {
    plant: Predictor,
    plant_state: StateOf<f32, Unit, 6>,
    random: Xoshiro256PlusPlus,
    noise: f32,
    periods: u32,
    prediction: Prediction,
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
fn unit<F: Friction<f32>>(
    level: f32,
    law: impl FnOnce(f32) -> Result<F, ParameterError<f32>>,
) -> Result<Slide<f32, ThreeHalves<f32>, F>, ParameterError<f32>> {
    let unit = SCENE.at(level)?;
    let ContactData { stiffness, damping, depth, .. } = unit.contact;
    let contact = Impact::new(ThreeHalves::new(stiffness)?, damping, depth)?;
    unit.body.slide(contact, law(unit.friction.coefficient())?, unit.drive)
}

/// The kernel of a unit whose friction is `factor` times the scene's.
fn plant(level: f32, factor: f32) -> Result<Predictor, ParameterError<f32>> {
    Kernel::new(unit(level, |coefficient| Exact::new(coefficient * factor))?, STEP / PLANT_STEPS as f32)
}

/// The prediction of a unit of `level`.
///
/// # Panics
/// If the level is out of bounds.
pub fn prediction(level: f32) -> Prediction {
    let limits = ahead::Limits { period: STEP, tolerance: 7e-5, lead: 0.2, lag: 0.2 };
    let unit = unit(level, |coefficient| Regularised::new(coefficient, STICK_BAND));
    unit.and_then(|unit| Ahead::new(unit, limits)).expect("the level is in bounds")
}

impl Control {
    /// At rest at the motion's start.
    ///
    /// # Panics
    /// If the rig is out of bounds or the table is not one in f32 over few levels and time.
    pub fn new(rig: &Rig, (flashed, region): Flashed, motions: &'static mut Motions) -> Self {
        let plant = plant(rig.level, rig.friction).expect("the unit is in bounds");
        let prediction = prediction(rig.taken_for);
        prediction.put_at_rest(motions, Pose::nominal(), EARLY);
        (0..EARLY).for_each(|_| _ = step(&prediction, motions));
        let table = flashed.f32().expect("the table's values are f32");
        let limits = Limits { blind: 0.2, force_most: 3.5, ..Limits::for_noise(STEP, rig.noise) };
        Self {
            plant_state: plant.at_rest(Pose::nominal()),
            plant,
            random: unit_stream(rig.seed, 0),
            noise: rig.noise,
            periods: 0,
            prediction,
            motions,
            monitor: Monitor::new(table, rig.taken_for, limits).expect("the limits are in bounds"),
            watch: Watch::default(),
            bank: LevelBank::new(table).expect("the table is over few levels and time"),
            scrubber: Scrubber::new(&flashed),
            region,
            damaged: 0,
        }
    }

    /// One period. `clock` counts; what simulates the unit and its sensor is not counted.
    pub fn tick(&mut self, clock: impl Fn() -> u32) -> Record {
        for _ in 0..PLANT_STEPS {
            self.plant.step(&mut self.plant_state);
        }
        let drive = self.plant.mechanism().drive();
        self.periods = self.periods.saturating_add(1);
        let time = self.periods as f32 * STEP;
        let speed = self.plant_state.motion.velocity.z;
        let measured = drive.force(time, speed) + self.noise * score::<f32>(self.random.next_u64());
        let sample = Sample { time, force: measured, speed, command: drive.command(time) };

        let start = clock();
        let ahead::Prediction { force: predicted, lead, .. } = step(&self.prediction, self.motions);
        let report = self.monitor.step(&mut self.watch, &sample);
        self.bank.add(time, measured);
        if self.scrubber.check(self.region, SCRUBBED).is_err() {
            self.damaged = self.damaged.saturating_add(1);
        }
        let cost = clock().wrapping_sub(start);
        let (periods, expected) = (self.periods, report.tightness.expected);
        Record { periods, measured, predicted, lead, expected, verdict: report.verdict, cost }
    }
}
