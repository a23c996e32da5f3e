//! `slipfit tolerance`: how the measures of a product vary over the production.

mod experiment;
mod gaps;
mod output;
mod tables;

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use indicatif::ProgressBar;
use serde::Serialize;
use slipfit_tolerance::{
    counting::{
        file::Source,
        run::{Keep, RunError, Shard, checkpoint, run},
        study::{Settings, Study},
    },
    model::{Measure, Model},
    numeric::lanes::LANES,
    sampling::sampler::Method,
    theory::experiment::Design,
};

use self::gaps::Given;
use super::{
    arguments::{DRAWING, SceneArguments, ThreadArguments},
    call::{self, Want},
    endings,
    failure::Failure,
    terminal::{print, print_json, progress, warn},
};
use crate::{
    setup::{Measured, Scene},
    show::columns::{Column, Columns, Values},
};

pub(super) use output::OutputArguments;

/// What is drawn unless something else is asked for: as many units as in the paper.
pub(super) const DEFAULT: Settings = Settings { method: Method::PseudoRandom, samples: 5000, replicates: 1, seed: 1 };

/// Shows how measures vary: Monte Carlo, worst case, RSS, contributors, capability.
///
/// For scenes with a product. Where the scene has a slide as well, the output ends with the clearances of its pins at the level
/// `--n`. Of a slide with stated gaps it shows the gaps and these clearances, and draws nothing.
#[derive(Args)]
#[command(mut_arg("scene", |arg| arg.default_value(DRAWING)))]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Units to draw, in each replicate; if not given 5000.
    #[arg(long)]
    samples: Option<u64>,
    /// How units are drawn.
    #[arg(long, value_enum, default_value_t = Sampling::Mc)]
    method: Sampling,
    /// Independent repetitions, 1 to 1024; if not given 8 for lhs and sobol, 1 for mc.
    ///
    /// Standard errors follow from their spread.
    #[arg(long)]
    replicates: Option<u64>,
    /// Seed of the production; if not given 1.
    ///
    /// The same scene, seed and number give the same unit on every machine.
    #[arg(long)]
    seed: Option<u64>,
    #[command(flatten)]
    threads: ThreadArguments,
    /// Works on part I of N and writes it to `--out`; `slipfit merge` joins the parts.
    ///
    /// I is 1 to N. `auto` takes the part of this task in a SLURM job array.
    #[arg(long, value_name = "I/N", requires = "out")]
    shard: Option<Shard>,
    /// Writes the results of the units to a file that `slipfit merge` reads.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Continues where an interrupted run with the same `--out` stopped.
    #[arg(long, requires = "out")]
    resume: bool,
    /// Writes the measures of every unit as CSV.
    #[arg(long, value_name = "FILE", conflicts_with = "shard")]
    draws: Option<PathBuf>,
    #[command(flatten)]
    outputs: OutputArguments,
}

/// How units are drawn.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Sampling {
    /// Pseudo-random units.
    Mc,
    /// Latin hypercube.
    Lhs,
    /// Owen-scrambled Sobol' points.
    Sobol,
    /// A designed experiment instead of random units: all combinations of the limits.
    Factorial,
    /// A designed experiment: the smallest two-level orthogonal array (L4, L8, …).
    Taguchi,
    /// A designed experiment: the smallest three-level orthogonal array (L9, L27, …).
    Taguchi3,
}

impl Sampling {
    /// The designed experiment, if it is one.
    fn design(self) -> Option<Design> {
        match self {
            Self::Mc | Self::Lhs | Self::Sobol => None,
            Self::Factorial => Some(Design::FullFactorial),
            Self::Taguchi => Some(Design::TwoLevel),
            Self::Taguchi3 => Some(Design::ThreeLevel),
        }
    }
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let file = self.scene.load_file(&[])?;
        match (&file.product, &file.slide) {
            (Some(product), _) => {
                self.outputs.check_level(file.slide.is_some())?;
                self.study(&file.title, &product.model, file.slide.as_ref(), file.measured.as_deref())?;
                warn(&product.warnings);
                Ok(())
            }
            (None, Some(scene)) => self.given(scene),
            (None, None) => Err(Failure::Input(format!(
                "{}: there is no product to draw; `slipfit check` shows the gaps that the scene gives",
                file.title
            ))),
        }
    }

    /// The gaps as the scene gives them.
    fn given(&self, scene: &Scene) -> Result<(), Failure> {
        self.refuse_units("the scene gives its gaps, there is no product to draw")?;
        let given = Given::new(scene, self.outputs.level(scene));
        if self.scene.json { print_json(&given) } else { print(&given.describe()) }
    }

    /// Refuses options of random units where there are none.
    fn refuse_units(&self, why: &str) -> Result<(), Failure> {
        let own = [
            ("--out", self.out.is_some()),
            ("--draws", self.draws.is_some()),
            ("--samples", self.samples.is_some()),
            ("--replicates", self.replicates.is_some()),
            ("--seed", self.seed.is_some()),
        ];
        let own = own.iter().find(|(_, is_given)| *is_given).map(|(option, _)| *option);
        let option = own.or(self.outputs.asked());
        option.map_or(Ok(()), |option| Err(Failure::Input(format!("{option}: {why}"))))
    }

    fn settings(&self) -> Result<Settings, Failure> {
        let (method, replicates) = match self.method {
            Sampling::Lhs => (Method::LatinHypercube, 8),
            Sampling::Sobol => (Method::ScrambledSobol, 8),
            _ => (DEFAULT.method, DEFAULT.replicates),
        };
        let replicates = self.replicates.unwrap_or(replicates);
        if !(1..=1024).contains(&replicates) {
            return Err(Failure::Input(format!("--replicates is {replicates}, allowed are 1 to 1024")));
        }
        let samples = self.samples.unwrap_or(DEFAULT.samples);
        let bad = || Failure::Input(format!("{samples} samples in {replicates} replicates are too many"));
        let samples = samples.checked_mul(replicates).ok_or_else(bad)?;
        Ok(Settings { method, samples, replicates, seed: self.seed.unwrap_or(DEFAULT.seed) })
    }

    fn study(
        &self,
        title: &str,
        model: &Model,
        slide: Option<&Scene>,
        measured: Option<&Measured>,
    ) -> Result<(), Failure> {
        if let Some(design) = self.method.design() {
            self.refuse_units("a designed experiment has no random units")?;
            return experiment::show(title, model, design, self.scene.json);
        }
        let settings = self.settings()?;
        let study = Study::new(model, settings).map_err(RunError::from)?;
        let partial = self.out.as_deref().map(checkpoint);
        let own = [("--out", &self.out), ("the checkpoint of --out", &partial), ("--draws", &self.draws)];
        let own: Vec<_> = own.iter().filter_map(|(option, path)| Some((*option, path.as_deref()?))).collect();
        endings::check_part("--out", self.out.as_deref())?;
        let inputs = self.scene.inputs();
        let inputs: Vec<_> = inputs.iter().map(|(name, path)| (*name, path.as_path())).collect();
        self.outputs.prepare(&inputs, &own, model.measures.len())?;
        let (name, text) = self.scene.text()?;
        let measured_parts = measured.map(Measured::hash);
        let source = Source { name, text: text.into_owned(), set: self.scene.set.clone(), measured: measured_parts };
        let shard = self.shard.unwrap_or(Shard::ALL);
        let keep = self.out.as_deref().map(|out| Keep { out, resume: self.resume });
        let blocks = shard.blocks(settings.blocks());
        if call::current().is_some_and(|call| call.wants(Want::Draws)) {
            Columns::check_space(settings.samples, 1 + study.model.measures.len())?;
        }
        let bar = progress("drawing", settings.units_in(&blocks) as usize);
        let tallies = self.threads.install(|| run(&study, &source, shard, keep.as_ref(), |units| bar.inc(units)))??;
        bar.finish_and_clear();
        let drawn = || Ok(draws(&study, &progress("writing", settings.samples as usize))?);
        call::columns(Want::Draws, self.draws.as_deref(), drawn)?;
        match (&self.out, shard) {
            (Some(out), Shard { number, count: 2.. }) => {
                let units: u64 = tallies.iter().map(|tally| tally.counts.units).sum();
                let written = Written { shard: number, of: shard.count, units, file: out.display().to_string() };
                if self.scene.json { print_json(&written) } else { print(&written.to_string()) }
            }
            _ => {
                let show = || self.outputs.show(title, slide, measured, &study, &tallies, self.scene.json);
                self.threads.install(show)?
            }
        }
    }
}

/// A shard that is done.
#[derive(Serialize)]
pub(super) struct Written {
    pub shard: u64,
    pub of: u64,
    pub units: u64,
    pub file: String,
}

impl std::fmt::Display for Written {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "shard {} of {}: {} units in {}", self.shard, self.of, self.units, self.file)
    }
}

/// Measures of every unit, in mm and degrees, a row a unit.
fn draws(study: &Study, bar: &ProgressBar) -> anyhow::Result<Columns> {
    let measures = &study.model.measures;
    let units = study.settings.samples;
    let mut all: Vec<Vec<f64>> = measures.iter().map(|_| Vec::with_capacity(units as usize)).collect();
    for first in (0..units).step_by(LANES) {
        let values = study.unit_measures(first);
        let lanes = (units - first).min(LANES as u64);
        for ((column, measure), value) in all.iter_mut().zip(measures).zip(&values) {
            column.extend(value.0[..lanes as usize].iter().map(|value| value * measure.quantity.factor()));
        }
        bar.inc(lanes);
        if slipfit_system::interrupt::requested() {
            return Err(RunError::Interrupted { saved: None }.into());
        }
    }
    bar.finish_and_clear();
    let of_measure = |(measure, values): (&Measure, Vec<f64>)| {
        Column::numbers(&measure.name, values).in_unit(measure.quantity.unit())
    };
    let number = Column::new("unit", Values::Counts((0..units).collect()));
    Ok(Columns([number].into_iter().chain(measures.iter().zip(all).map(of_measure)).collect()))
}
