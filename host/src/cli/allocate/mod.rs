//! `slipfit allocate`: the cheapest tolerances that meet requirements of the measures, or of what units do.

mod curve;
mod function;
mod report;
mod tables;
mod tolerances;

use std::path::PathBuf;

use clap::Args;
use indicatif::ProgressBar;
use slipfit_core::sampling::stream::derived;
use slipfit_system::files;
use slipfit_tolerance::{
    allocate::{
        AllocateError,
        check::check as checked_units,
        confirm::{Counted, confirmed, least_units},
        cost::Process,
        curve::{LEVELS, curve as cost_against_defects},
        figures::Figures as _,
        requirement::{Kind, OfMeasures, Requirement},
        search::{Found, search},
    },
    counting::study::{MOST_UNITS, StudyError},
    product::{Product, costed::Costed},
};

use self::{
    function::{Function, Limits},
    report::{Confirmation, Report},
    tolerances::{DIGITS, Tolerances},
};
use super::{
    arguments::{SceneArguments, ThreadArguments},
    call, check,
    failure::Failure,
    population::uncertain,
    terminal::{counter, given, print, print_json, progress, warn},
};
use crate::scene::{SceneFile, with_tolerances};

/// What seeds of fresh units, which confirm malfunctions, are derived with.
const FRESH_UNITS: u64 = 5 << 32;
/// How many times as many they are as the units of the search.
const FRESH: u64 = 8;

/// Chooses the cheapest tolerances that meet the requirements.
///
/// A requirement limits how measures vary, or how many units of a slide malfunction. It stands in the scene (`require` of a measure,
/// `[allocate]`) or follows `--require`. Tolerances with a `cost` are chosen, the others stay as they are. Where even the tightest
/// tolerances do not meet a requirement, the command says by how much and exits with 1.
#[derive(Args)]
#[command(mut_arg("scene", |arg| arg.default_value(None::<&str>).required(true)))]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Requirement instead of those of the scene, such as rss, ppm=100 or malfunction=0.01.
    ///
    /// For every measure with limits: rss, rss-off-centre, worst-case, ppm=100, ppk=1.33. For all measures together: yield=0.999, the
    /// share of units with all measures within their limits. For the units of a slide: malfunction=0.01, the permitted share of units
    /// that crawl or jam over the whole stroke.
    #[arg(long, value_name = "WHAT", value_parser = kind)]
    require: Option<Required>,
    /// Greatest force (N) of the motor; units that need more count as malfunctioning.
    ///
    /// Only together with `--require malfunction=SHARE`.
    #[arg(long, value_name = "N", requires = "require")]
    force_limit: Option<f64>,
    /// Units to simulate for every set of tolerances that is tried.
    ///
    /// Only for requirements on malfunction. The tolerances found are confirmed with eight times as many other units, or more if the
    /// share is small. More units find cheaper tolerances and take longer.
    #[arg(long, default_value_t = 2048, value_parser = clap::value_parser!(u64).range(100..=10_000_000))]
    units: u64,
    /// Units to draw for the check of the tolerances found.
    #[arg(long, default_value_t = 1_000_000, value_parser = clap::value_parser!(u64).range(2..=MOST_UNITS))]
    samples: u64,
    /// Seed of the production.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    threads: ThreadArguments,
    /// Writes the scene with the tolerances found.
    #[arg(long, value_name = "FILE", conflicts_with = "set")]
    write: Option<PathBuf>,
    /// Writes the curve of cost against defects as CSV.
    ///
    /// A row has a number of defects, 10,000 to 1 ppm, the least cost for it, and the tolerances.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draws the curve of cost against defects as SVG.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

/// What is required, and whether of all measures together.
#[derive(Clone, Copy)]
struct Required {
    kind: Kind,
    together: bool,
}

fn kind(text: &str) -> Result<Required, String> {
    const ALLOWED: &str =
        "allowed are rss, rss-off-centre, worst-case, ppm=100, ppk=1.33, yield=0.999, malfunction=0.01";
    let (name, number) = text.split_once('=').map_or((text, None), |(name, number)| (name, Some(number)));
    let number = number.map(|number| number.trim().parse::<f64>().map_err(|_| ALLOWED.to_owned())).transpose()?;
    let within = |low: f64, high: f64| number.filter(|number| *number > low && *number < high);
    let each = |kind| Ok(Required { kind, together: false });
    match (name.trim(), number) {
        ("rss", None) => each(Kind::Rss),
        ("rss-off-centre", None) => each(Kind::RssOffCentre),
        ("worst-case", None) => each(Kind::WorstCase),
        ("ppm", Some(_)) => {
            each(Kind::Defects(1e-6 * within(0.0, 1e6).ok_or("allowed are more than 0, less than 1e6")?))
        }
        ("ppk", Some(_)) => each(Kind::Ppk(within(0.0, 10.0).ok_or("allowed are more than 0, less than 10")?)),
        ("yield", Some(_)) => {
            let share = within(0.0, 1.0).ok_or("allowed are more than 0, less than 1")?;
            Ok(Required { kind: Kind::Defects(1.0 - share), together: true })
        }
        ("malfunction", Some(_)) => {
            let allowed = number.filter(|share| *share > 0.0 && *share <= 0.5);
            let allowed = allowed.ok_or("allowed are more than 0, at most 0.5")?;
            Ok(Required { kind: Kind::Malfunction { allowed, force_limit: None }, together: true })
        }
        _ => Err(ALLOWED.into()),
    }
}

impl From<AllocateError> for Failure {
    fn from(error: AllocateError) -> Self {
        match error {
            AllocateError::NotLinear(_) | AllocateError::Model(_) | AllocateError::Unjudged { .. } => {
                Self::Input(error.to_string())
            }
            AllocateError::Study(StudyError::Interrupted) => Self::Work(error.into()),
            AllocateError::Study(error) => Self::Input(error.to_string()),
            _ => Self::Work(error.into()),
        }
    }
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let outputs = [("--write", &self.write), ("--csv", &self.csv), ("--plot", &self.plot)];
        let (name, text) = self.scene.text()?;
        let overrides = self.scene.overrides(&[]);
        let file = SceneFile::parse(&name, &text, &overrides)?;
        let product = file
            .product
            .ok_or_else(|| Failure::Input("the scene has no product, whose tolerances could be chosen".into()))?;
        let requirements = self.requirements(&product)?;
        let limits = Limits::of(&requirements);
        if limits.is_some() && file.slide.is_none() {
            return Err(Failure::Input("the scene has no [slide], whose units could malfunction".into()));
        }
        check_costs(&product.costed)?;
        self.scene.check_outputs(&given(outputs))?;
        let scene = Tolerances { name: &name, text: &text, overrides: &overrides, costed: &product.costed };
        let tried = if limits.is_none() { counter("sets of tolerances tried") } else { ProgressBar::hidden() };
        let model = |tolerances: &[f64]| {
            tried.inc(1);
            scene.model(tolerances)
        };
        let function = limits.map(|limits| Function::new(&scene, limits));
        let counted = |tolerances: &[f64], units: u64, seed: u64| match &function {
            Some(function) => function.count(tolerances, units, seed),
            None => Ok(Counted { failed: 0, units }),
        };
        let malfunctions = |tolerances: &[f64], _: Option<f64>| {
            let Counted { failed, units } = counted(tolerances, self.units, self.seed)?;
            Ok::<f64, AllocateError>(failed as f64 / units as f64)
        };
        let processes: Vec<&[Process]> = product.costed.iter().map(|costed| costed.processes.as_slice()).collect();
        let start: Vec<f64> = product.costed.iter().map(|costed| costed.stated).collect();
        let figures_of = |requirements: &[Requirement]| {
            let figures = OfMeasures::new(requirements, &model, &start, self.seed)?;
            Ok::<_, AllocateError>(figures.with_malfunctions(&malfunctions))
        };
        let work = || -> Result<(Report, Vec<f64>), Failure> {
            let figures = figures_of(&requirements)?;
            let found = match limits {
                None => search(&processes, &start, &figures).map(|found| (found, None)),
                Some(Limits { allowed, .. }) => {
                    let search = |target: f64, before: Option<&Found>| {
                        let start = before.map_or(start.as_slice(), |found| found.solution.tolerances.as_slice());
                        search(&processes, start, &figures_of(&aimed_at(&requirements, target))?)
                    };
                    let units = (FRESH * self.units).max(least_units(allowed));
                    let count = |found: &Found, round: u64| {
                        counted(&found.solution.tolerances, units, derived(self.seed, FRESH_UNITS + round))
                    };
                    confirmed(allowed, search, count).and_then(|confirmed| {
                        let figures = figures.values(&confirmed.found.solution.tolerances)?;
                        let confirmation = Confirmation::new(&confirmed);
                        Ok((Found { figures, ..confirmed.found }, Some(confirmation)))
                    })
                }
            };
            tried.finish_and_clear();
            let (found, confirmation) = match found {
                Err(AllocateError::Infeasible { figures: least, .. }) => {
                    return Err(Failure::Work(anyhow::anyhow!(tables::missing(
                        &product.model,
                        figures.rows(),
                        &least
                    ))));
                }
                other => other?,
            };
            let tolerances = found.solution.tolerances.clone();
            let unknown = match &function {
                Some(function) => function.unknown(&tolerances, self.units, self.seed)?,
                None => None,
            };
            if let Some(function) = &function {
                function.finish();
            }
            let doubts = unknown.as_ref().map(uncertain::warnings).transpose()?.unwrap_or_default();
            let unknown = unknown.zip(limits).map(|(answer, limits)| report::Unknown::new(answer, limits.allowed));
            let checked = checked_units(&model(&tolerances)?, self.samples, self.seed)?;
            if let Some((requirement, outside)) = checked.contradicts(&requirements) {
                let of = requirement.measure.map_or("all measures", |i| product.model.measures[i].name.as_str());
                return Err(Failure::Work(anyhow::anyhow!(
                    "{of}: {outside} of {} units drawn with the tolerances found are outside, more than is allowed: where a measure is \
                     level and then bends, its tails may not be found",
                    checked.units
                )));
            }
            let points = if self.csv.is_some() || self.plot.is_some() || call::wants_pictures() {
                let bar = progress("cost against defects", LEVELS.len());
                let points = cost_against_defects(&processes, &tolerances, &model, self.seed, || bar.inc(1))?;
                bar.finish_and_clear();
                points
            } else {
                Vec::new()
            };
            let checked = report::Checks { measures: checked, confirmation, unknown };
            let mut report = Report::new(&file.title, &product, figures.rows(), &found, checked, points);
            report.warnings.extend(doubts);
            Ok((report, tolerances))
        };
        let (mut report, tolerances) = self.threads.install(work)??;
        let simulated = file.slide.iter().filter(|_| function.is_some());
        report.warnings.extend(simulated.flat_map(check::warnings_of));
        if let Some(path) = &self.csv {
            files::write(path, &curve::csv(&report)?)?;
        }
        call::picture(self.plot.as_deref(), "cost", || curve::svg(&report))?;
        if let Some(path) = &self.write {
            files::write(path, with_tolerances(&text, &product.costed, &tolerances, DIGITS).as_bytes())?;
        }
        warn(&report.warnings);
        if self.scene.json { print_json(&report) } else { print(&tables::tables(&report)) }
    }

    fn requirements(&self, product: &Product) -> Result<Vec<Requirement>, Failure> {
        let limited = |i: &usize| product.model.measures[*i].limits.iter().any(Option::is_some);
        let limited: Vec<usize> = (0..product.model.measures.len()).filter(limited).collect();
        let requirements = match self.require {
            None => product.requirements.clone(),
            Some(Required { kind: Kind::Malfunction { allowed, .. }, .. }) => {
                let kind = Kind::Malfunction { allowed, force_limit: self.force_limit };
                vec![Requirement { measure: None, kind }]
            }
            Some(_) if limited.is_empty() => Vec::new(),
            Some(Required { kind, together: true }) => vec![Requirement { measure: None, kind }],
            Some(Required { kind, .. }) => {
                limited.into_iter().map(|i| Requirement { measure: Some(i), kind }).collect()
            }
        };
        if requirements.is_empty() {
            let message = match self.require {
                None => {
                    "nothing is required: a measure with limits needs require = \"rss\", [allocate] yield or malfunction, or \
                     give --require"
                }
                Some(_) => {
                    "nothing is required: --require is for measures with limits, and none has `lower` or `upper`"
                }
            };
            return Err(Failure::Input(message.into()));
        }
        Ok(requirements)
    }
}

/// The same requirements, except that the share of units that may malfunction is the `target`.
fn aimed_at(requirements: &[Requirement], target: f64) -> Vec<Requirement> {
    let of = |requirement: &Requirement| match requirement.kind {
        Kind::Malfunction { force_limit, .. } => {
            Requirement { kind: Kind::Malfunction { allowed: target, force_limit }, ..*requirement }
        }
        _ => *requirement,
    };
    requirements.iter().map(of).collect()
}

/// Refuses what cannot be chosen.
fn check_costs(costed: &[Costed]) -> Result<(), Failure> {
    if costed.is_empty() {
        let message = "no tolerance of the scene has a cost: cost = { reciprocal = 0.5, range = [0.05, 0.2] } beside it gives it one";
        return Err(Failure::Input(message.into()));
    }
    match costed.iter().find(|costed| costed.place.is_none()) {
        Some(set) => Err(Failure::Input(format!("--set: the tolerance of {} is to be chosen", set.name))),
        None => Ok(()),
    }
}
