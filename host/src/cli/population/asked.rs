//! What `slipfit population` is asked for: units of a production, simulated in shards or at once.

use std::path::PathBuf;

use clap::Args;
use indicatif::ProgressBar;
use slipfit_tolerance::counting::{
    file::{Found as _, Source},
    run::{Keep, Shard, checkpoint, run},
};

use super::rows::Rows;
use crate::{
    cli::{
        arguments::{DriveArguments, Moving, SceneArguments, ThreadArguments},
        endings,
        failure::Failure,
        terminal::{given, print, print_json, progress},
        tolerance::Written,
    },
    dynamics::driven::Driven,
    population::{
        part::Settings,
        production::Production,
        rare::{Question, Rare},
        simulation::{Listener, Simulation},
        study::Population,
        subject::Subject,
        tally::{Counter, Duty, Tally},
        uncertain::design::Design,
    },
};

/// Simulates units of a production one by one: how many malfunction, and why.
///
/// For slides and mechanisms with a drive. Every unit has gaps of its own. Gaps that are measures follow from the product's
/// tolerances; the others are drawn from the mean and the standard deviation in the scene. With `[vary]` in the scene friction, stiffness, damping, mass, gain, ramp
/// and the direction of gravity vary, too. With `[uncertain]` four times as many units more are simulated, and the answer covers the unknown values.
/// A slide runs the whole stroke unless `--opening` is given, a mechanism
/// `run.duration` or to the end of its stroke.
///
/// For slides only: `--opening`.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub drive: DriveArguments,
    /// Units to simulate.
    #[arg(long, default_value_t = 5000, value_parser = clap::value_parser!(u64).range(1..=100_000_000))]
    pub units: u64,
    /// Seed of the production.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Runs the opening (run.duration) instead of the whole stroke.
    #[arg(long)]
    pub opening: bool,
    /// Greatest force (N) of the motor, or torque (N·m), driving or braking; units that need more count as malfunctioning.
    #[arg(long, value_name = "N")]
    pub force_limit: Option<f64>,
    /// Correlation between any two gaps that the scene states by mean and standard deviation.
    #[arg(long, value_name = "RHO", default_value_t = 0.0, allow_hyphen_values = true)]
    pub correlation: f64,
    /// Also estimates the probability of rare malfunctions, by subset simulation; takes seconds to minutes.
    ///
    /// There is an estimate for each kind of malfunction (crawls, jams, over the force limit) on each side (tight units, loose units).
    #[arg(long)]
    pub rare: bool,
    /// Writes a row for every unit as CSV.
    ///
    /// Its columns: number of the unit, tightness (σ, mean over its gaps), breakaway time, peak force, settled force, final velocity, end
    /// of the run, travel, verdict, whether the desk decided it, then every gap (m). Units stand in the names; what a unit does not have
    /// is empty.
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Draws the peak force over the tightness of the units as SVG, and marks those that malfunction.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Draws which share malfunctions over the distance from the mean unit, as SVG.
    ///
    /// At each distance it compares the unit with all gaps tighter, the unit with all gaps looser, and random combinations of gaps.
    #[arg(long, value_name = "FILE")]
    pub plot_distance: Option<PathBuf>,
    /// Writes a page with all results and pictures, and an animation of one unit of each verdict.
    #[arg(long, value_name = "FILE")]
    pub page: Option<PathBuf>,
    /// Works on part I of N and writes it to `--out`; `slipfit merge` joins the parts.
    ///
    /// I is 1 to N. `auto` takes the part of this task in a SLURM job array.
    #[arg(long, value_name = "I/N", requires = "out", conflicts_with_all = ["csv", "plot", "plot_distance", "page", "rare"])]
    pub shard: Option<Shard>,
    /// Writes the results of the units to a file that `slipfit merge` reads.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Continues where an interrupted run with the same `--out` stopped.
    #[arg(long, requires = "out")]
    pub resume: bool,
    #[command(flatten)]
    pub threads: ThreadArguments,
}

/// What the picture of the hypothesis shows.
pub const HYPOTHESIS: &str = "Do the tightest and the loosest units malfunction most often? A triangle or square is one unit \
                                     with all gaps tighter, or looser, by the same n: at 100 % it malfunctions. The line is the share of random units as far \
                                     from the mean unit.";

impl Arguments {
    /// What units have to do.
    pub fn duty_of(&self, subject: &dyn Subject) -> Duty {
        Duty { limit: self.force_limit, stroke: subject.run().stroke.filter(|_| !self.opening) }
    }

    fn settings(&self) -> Settings {
        Settings::new(self.units, self.seed, self.opening, self.correlation, self.force_limit)
    }

    /// The units of this shard.
    fn numbers(&self) -> std::ops::Range<u64> {
        let (settings, shard) = (self.settings(), self.shard.unwrap_or(Shard::ALL));
        settings.units_in(&shard.blocks(Tally::blocks(&settings)))
    }

    /// The progress of the units of this shard, and of those of a `design`.
    pub fn bar(&self, design: Option<Design>) -> ProgressBar {
        let numbers = self.numbers();
        let units = numbers.end - numbers.start.min(numbers.end) + design.map_or(0, |design| design.units());
        progress("simulating", units as usize)
    }

    /// Simulates what is asked for of a `production` of `subject` with this `duty`, by the `drive` of that number, and tells `bar` of
    /// each unit. None, if it is one of several shards, which is written to its file.
    pub fn simulated(
        &self,
        subject: &dyn Subject,
        production: &Production,
        duty: Duty,
        drive: usize,
        bar: &ProgressBar,
    ) -> Result<Option<Tally>, Failure> {
        let partial = self.out.as_deref().map(checkpoint);
        let outputs = [
            ("--csv", &self.csv),
            ("--plot", &self.plot),
            ("--plot-distance", &self.plot_distance),
            ("--page", &self.page),
            ("--out", &self.out),
            ("the checkpoint of --out", &partial),
        ];
        endings::check_part("--out", self.out.as_deref())?;
        self.scene.check_outputs(&given(outputs))?;
        let settings = self.settings().by_drive(drive);
        let (name, text) = self.scene.text()?;
        // Shards of a scene with measured parts are refused.
        let source = Source { name, text: text.into_owned(), set: self.scene.set.clone(), measured: None };
        let shard = self.shard.unwrap_or(Shard::ALL);
        let keep = self.out.as_deref().map(|out| Keep { out, resume: self.resume });
        let mut rows = Rows::begin(self.csv.as_deref(), subject, self.units)?;
        let listener = rows.as_mut().map(|rows| Listener::new(Box::new(|units| rows.add(units))));
        let counter = Counter::new(subject, duty);
        let simulation = Simulation { subject, production, settings, counter, listener };
        let tally = self.threads.install(|| {
            let tally = run(&simulation, &source, shard, keep.as_ref(), |units| bar.inc(units))?;
            simulation.catch_up(self.numbers().end).map(|()| tally)
        })??;
        drop(simulation);
        rows.map_or(Ok(()), Rows::end)?;
        let (Some(out), Shard { number, count: 2.. }) = (&self.out, shard) else { return Ok(Some(tally)) };
        let units = tally.counts.units;
        bar.finish_and_clear();
        let written = Written { shard: number, of: shard.count, units, file: out.display().to_string() };
        if self.scene.json { print_json(&written) } else { print(&written.to_string()) }.map(|()| None)
    }

    /// As it was asked for when a population was split, `settings` among it.
    pub fn of_parts(settings: &Settings, json: bool) -> Self {
        Self {
            scene: SceneArguments { scene: PathBuf::new(), set: Vec::new(), json },
            units: settings.units,
            seed: settings.seed,
            drive: DriveArguments { drive: None },
            opening: settings.opening,
            force_limit: settings.limit(),
            correlation: settings.correlation(),
            rare: false,
            csv: None,
            plot: None,
            plot_distance: None,
            page: None,
            shard: None,
            out: None,
            resume: false,
            threads: ThreadArguments { threads: None },
        }
    }

    /// Lets what moves run as long as is asked for: a slide its whole stroke, unless its opening is asked for.
    pub fn set_length(&self, moving: &mut Moving) -> Result<(), Failure> {
        match moving {
            Moving::Slide(scene) if !self.opening => {
                scene.run.duration = scene.stroke_duration().unwrap_or(scene.run.duration);
            }
            Moving::Mechanism(_) if self.opening => {
                let message = "--opening is for slides on pins: a mechanism has one run, `run.duration`";
                return Err(Failure::Input(message.into()));
            }
            _ => {}
        }
        Ok(())
    }

    /// Rare malfunction, which the units of the `population` must not contradict.
    pub fn estimate(
        &self,
        subject: &dyn Subject,
        production: &Production,
        population: &Population,
    ) -> Result<Rare, Failure> {
        let limit = self.force_limit;
        let question = Question { subject, production, seed: self.seed, limit };
        let bar = progress("estimating", question.repeats());
        let tally = &population.tally;
        let counted = |kind, side| (tally.of_kind(kind, side), tally.counts.units);
        let rare = question.answer(counted, |repeats| bar.inc(repeats as u64))?;
        bar.finish_and_clear();
        Ok(rare)
    }
}
