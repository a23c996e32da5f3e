//! `slipfit simulate`: one unit.

mod words;

use std::path::PathBuf;

use clap::Args;
use maud::Markup;
use serde::Serialize;
use slipfit_core::slide::CONTACTS;
use slipfit_system::files;

use super::{
    arguments::{Moving, SceneArguments, one_of},
    call::{self, Want},
    check::{self, GapReport, gap_reports},
    failure::Failure,
    mechanism::{self, Wanted},
    terminal::{given, print, print_json, warn},
};
use crate::{
    dynamics::{
        audit::Audit,
        confirm::{confirmed, with_step_tried},
        controller::audited,
        driven::Driven,
        film::{Film, MOMENTS, film},
        outcome::{Outcome, Verdict},
        scheme::{IntegratorKind, ScalarKind},
        simulate::{Run, Settings, SimulateError, Solved, simulate},
        trajectory::Trajectory,
        trust::Trust,
    },
    population::{
        production::{MOST_UNITS, Production},
        slide::scene_of,
    },
    scene::{Override, parse_every},
    setup::Scene,
    show::{
        export,
        figure::{unit_over_time, word},
        player,
        report::{Figure, unit_page},
    },
};

pub(super) use words::why_undecided;

/// Simulates one unit: speed and drive force over time.
///
/// For slides and mechanisms. The unit is that of a tolerance level (`--n`) or one of the production (`--unit`). A slide runs its opening
/// (`run.duration`) unless `--stroke` is given. The desk computes the run by error-controlled steps. It also says how far
/// the controller is off, which takes steps of one length. With `--step`, `--integrator`, `--scalar` or `--audit` the run shown is the
/// controller's, and its error against the desk's is printed.
///
/// For slides only: `--audit`, `--stroke`, `--scalar`.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Tolerance level, for all gaps or one for each; positive is tighter.
    ///
    /// One for each gap is a list with commas. A slide takes sixteen levels: left, right, rail and wall of each of four pins, whether
    /// the scene has that gap or not. A mechanism takes them in the order in which `slipfit check` lists its gaps.
    #[arg(long, value_delimiter = ',', allow_hyphen_values = true, default_value = "0")]
    n: Vec<f64>,
    /// Number of a unit of the production, instead of a tolerance level.
    ///
    /// The units are those of `slipfit population`, which runs the whole stroke: add `--stroke` for the same run.
    #[arg(long, value_name = "NUMBER", conflicts_with = "n")]
    unit: Option<u64>,
    /// Seed of the production, for `--unit`.
    #[arg(long, default_value_t = 1, requires = "unit")]
    seed: u64,
    /// Correlation between the gaps, for `--unit`.
    ///
    /// It holds for any two gaps that the scene states by mean and standard deviation.
    #[arg(long, value_name = "RHO", default_value_t = 0.0, requires = "unit", allow_hyphen_values = true)]
    correlation: f64,
    /// Writes the run as CSV, in SI units.
    ///
    /// Of a slide the columns are time, speed and force along the drive, displacement of the centre of mass. Of a mechanism they are
    /// time, the force of each drive, and the motion of each body. Their heads have units.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draws speed and force over time as SVG.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Writes a page with the run and an animation of the bodies on their joints, gaps enlarged, by the desk's run.
    #[arg(long, value_name = "FILE")]
    page: Option<PathBuf>,
    /// Interval between the samples in the output, such as 1ms or 500us; a bare number is in ms.
    #[arg(long, default_value = "1ms", allow_hyphen_values = true)]
    every: String,
    /// Prints the energy balance of the controller's run.
    ///
    /// Work of the drive = gains + losses + defect. The defect is the error of the integration scheme: positive where the scheme lost
    /// energy, negative where it added some.
    #[arg(long)]
    audit: bool,
    #[command(flatten)]
    length: LengthArguments,
    #[command(flatten)]
    controller: ControllerArguments,
}

/// How long runs are and how well the desk knows them, where it differs from the scene.
#[derive(Args)]
pub(super) struct LengthArguments {
    /// Runs the whole stroke (run.stroke) instead of the opening (run.duration); for slides.
    #[arg(long)]
    pub stroke: bool,
    /// Error that one step of the desk may make, such as 1e-6; replaces run.error.
    ///
    /// Of a slide it is a share of the drive's greatest force, of a mechanism a share of its own speed. Smaller is more exact and slower.
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true)]
    error: Option<String>,
}

impl LengthArguments {
    /// The options as settings of the scene.
    pub fn overrides(&self) -> Option<Override> {
        self.error.as_ref().map(|error| Override::option("--error", "run.error", error))
    }

    /// `scene` with the run that is asked for.
    pub fn applied(&self, mut scene: Scene) -> Result<Scene, Failure> {
        if self.stroke {
            scene.run.duration = scene.stroke_duration().ok_or_else(|| {
                let why = "the scene states no run.stroke, or its drive no speed";
                Failure::Input(format!("--stroke: {why}; state one, such as --set run.stroke=80"))
            })?;
        }
        Ok(scene)
    }
}

/// How the controller steps, where it differs from the scene.
#[derive(Args)]
pub(super) struct StepArguments {
    /// Length of the controller's steps, such as 1ms; a bare number is in µs.
    #[arg(long, allow_hyphen_values = true)]
    step: Option<String>,
    /// Integration scheme of the controller.
    #[arg(long, value_parser = one_of(IntegratorKind::ALL, IntegratorKind::name))]
    integrator: Option<IntegratorKind>,
}

impl StepArguments {
    /// The options as settings of the scene.
    pub fn overrides(&self) -> Vec<Override> {
        let step = self.step.as_ref().map(|step| Override::option("--step", "controller.step", step));
        let name = |kind: IntegratorKind| Override::option("--integrator", "controller.integrator", kind.name());
        step.into_iter().chain(self.integrator.map(name)).collect()
    }
}

/// How the controller computes, where it differs from the scene.
#[derive(Args)]
pub(super) struct ControllerArguments {
    #[command(flatten)]
    steps: StepArguments,
    /// Number type of the controller.
    #[arg(long, value_parser = one_of(ScalarKind::ALL, ScalarKind::name))]
    scalar: Option<ScalarKind>,
}

impl ControllerArguments {
    /// Whether any of them was given.
    pub fn given(&self) -> bool {
        !self.overrides().is_empty()
    }

    /// The options as settings of the scene.
    pub fn overrides(&self) -> Vec<Override> {
        let scalar = self.scalar.map(|kind| Override::option("--scalar", "controller.scalar", kind.name()));
        self.steps.overrides().into_iter().chain(scalar).collect()
    }
}

#[derive(Serialize)]
struct Report<'a> {
    title: &'a str,
    n: &'a [f64],
    duration_s: f64,
    /// What computed the run.
    solver: Solved,
    integration_ms: f64,
    #[serde(flatten)]
    outcome: Outcome,
    gaps: Vec<GapReport>,
    trust: Trust,
    /// How the controller does; not where the run is its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    controller: Option<ControllerReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    audit_j: Option<Audit>,
    warnings: &'a [String],
    samples: &'a Trajectory,
}

/// How a controller's run does against the desk's.
#[derive(Serialize)]
struct ControllerReport {
    solver: Solved,
    verdict: Verdict,
    trust: Trust,
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let overrides: Vec<_> = self.controller.overrides().into_iter().chain(self.length.overrides()).collect();
        let (moving, product) = self.scene.load_moving_with_product(&overrides)?;
        let scene = match moving {
            Moving::Slide(scene) => self.length.applied(*scene)?,
            Moving::Mechanism(mechanism) => {
                if self.audit || self.controller.scalar.is_some() || self.length.stroke {
                    let why = "--audit, --scalar and --stroke are for slides on pins; a mechanism runs for run.duration, \
                               or to run.stroke, and its controller is computed in double precision";
                    return Err(Failure::Input(why.into()));
                }
                let by_controller = self.controller.given();
                let Self { scene, csv, plot, page, .. } = self;
                let of_product = product.iter().flat_map(|product| product.warnings.clone()).collect();
                let wanted = Wanted { scene, csv, plot, page, by_controller, of_product };
                let (mechanism, unit) = match self.unit {
                    Some(number) => {
                        let production =
                            Production::of_mechanism(&mechanism, product.as_ref(), self.correlation, self.seed);
                        let production = production.map_err(|error| Failure::Input(error.to_string()))?;
                        mechanism::OneUnit::of_production(&mechanism, &production, check_number(number)?)?
                    }
                    None => {
                        let unit = mechanism::OneUnit::at_levels(&mechanism, &self.n)?;
                        (*mechanism, unit)
                    }
                };
                return mechanism::simulate(&mechanism, &unit, parse_every(&self.every)?, &wanted);
            }
        };
        let (scene, n) = match self.unit {
            Some(number) => self.of_production(scene, number, &overrides)?,
            None => (scene, levels(&self.n)?),
        };
        let shown = if self.unit.is_some() { &n[..] } else { &self.n[..] };
        scene.check_gaps(&n).map_err(|error| Failure::Input(format!("--n: {error}")))?;
        let every = parse_every(&self.every)?;
        self.scene.check_outputs(&given([("--csv", &self.csv), ("--plot", &self.plot), ("--page", &self.page)]))?;
        let by_controller = self.audit || self.controller.given();
        let settings = if by_controller { Settings::controller(&scene, every) } else { Settings::desk(&scene, every) };
        let gaps = settings.gaps(&scene, &n);
        let run = if self.audit { audited } else { simulate };
        let run = confirmed(&scene, &gaps, &settings, run(&scene, &gaps, &settings)?)?;
        let controller = if by_controller { None } else { Some(controllers(&scene, &n)) };
        let mut controller = controller.transpose()?;
        let mut run = run;
        let tried = |run: &mut Run| with_step_tried(&scene, &n, run.trust).map(|trust| run.trust = trust);
        let of_controller = if by_controller { Some(&mut run) } else { controller.as_mut().and_then(Option::as_mut) };
        of_controller.map(tried).transpose()?;
        call::columns(Want::Columns, self.csv.as_deref(), || Ok(export::of_trajectory(&run.trajectory)))?;
        call::picture(self.plot.as_deref(), "motion", || unit_over_time(&run.trajectory, &scene.title, shown))?;
        let mut warnings = check::warnings_of(&scene);
        warnings.extend(product.into_iter().flat_map(|product| product.warnings));
        warnings.extend(run.trust.warning());
        let beside = controller.as_ref().and_then(|run| run.as_ref());
        let of_controller =
            |warning| format!("{warning}. This is about the controller beside it, not about the desk's result");
        warnings.extend(beside.and_then(|run| run.trust.warning()).map(of_controller));
        let reports = gap_reports(&scene, &scene.gaps_at(&n));
        let words = || self.describe(&scene, &run, controller.as_ref().map(Option::as_ref), &reports, shown);
        if let Some(path) = &self.page {
            let film = film(&scene, &scene.gaps_at(&n), MOMENTS)?;
            let page = self.page_of(&scene, &run, &film, (&words(), shown), &warnings)?;
            files::write(path, page.into_string().as_bytes())?;
        }
        if self.scene.json {
            let controller = controller.flatten().map(|run| ControllerReport {
                solver: run.solved,
                verdict: run.outcome.verdict,
                trust: run.trust,
            });
            print_json(&Report {
                title: &scene.title,
                n: shown,
                duration_s: scene.run.duration,
                solver: run.solved,
                integration_ms: run.integration.as_secs_f64() * 1e3,
                outcome: run.outcome,
                gaps: reports,
                trust: run.trust,
                controller,
                audit_j: run.audit,
                warnings: &warnings,
                samples: &run.trajectory,
            })
        } else {
            print(&words())?;
            warn(&warnings);
            Ok(())
        }
    }

    /// The page of a run: what it comes to, the player of the desk's `film`, velocity and force.
    fn page_of(
        &self,
        scene: &Scene,
        run: &Run,
        film: &Film,
        (words, n): (&str, &[f64]),
        remarks: &[String],
    ) -> Result<Markup, Failure> {
        let label = format!("{}: {}", self.of(n), word(run.outcome.verdict));
        let played = [player::of_slide(scene, label, film)];
        let player = player::figure(&played, "The desk's run, on its pins:").map_err(anyhow::Error::from)?;
        let svg = unit_over_time(&run.trajectory, &scene.title, n).map_err(anyhow::Error::from)?;
        let picture = Figure { caption: "Velocity and force of the drive over time.".into(), svg };
        Ok(unit_page(&scene.title, words, player, picture, remarks))
    }

    /// The scene of unit `number` of the production, and the levels at which its gaps are those of the unit.
    fn of_production(
        &self,
        scene: Scene,
        number: u64,
        overrides: &[Override],
    ) -> Result<(Scene, [f64; CONTACTS]), Failure> {
        let (_, product) = self.scene.load_with_product(overrides)?;
        let production = Production::new(&scene, product.as_ref(), self.correlation, self.seed)
            .map_err(|error| Failure::Input(error.to_string()))?;
        let (drawn, i) = production.draw_one(check_number(number)?);
        // What does not vary has any level.
        let levels = scene.levels_of(&drawn.gaps[i]);
        let n = std::array::from_fn(|i| levels[i].unwrap_or_default());
        Ok((scene_of(&scene, &drawn, i), n))
    }
}

/// The `number` of a unit, if there is one.
fn check_number(number: u64) -> Result<u64, Failure> {
    let most = MOST_UNITS - 1;
    if number > most { Err(Failure::Input(format!("--unit {number}: allowed is 0 to {most}"))) } else { Ok(number) }
}

/// The run of the scene's controller held against the desk's; `None` where it leaves the finite range.
fn controllers(scene: &Scene, n: &[f64; CONTACTS]) -> Result<Option<Run>, SimulateError> {
    // Samples on its own steps, a millisecond apart or a step where that is longer.
    let step = scene.controller.step;
    let every = (1e-3 / step).round().max(1.0) * step;
    let settings = Settings::controller(scene, every);
    let gaps = settings.gaps(scene, n);
    match simulate(scene, &gaps, &settings) {
        Ok(run) => confirmed(scene, &gaps, &settings, run).map(Some),
        Err(SimulateError::NotFinite { .. }) => Ok(None),
        Err(other) => Err(other),
    }
}

/// One level for all contacts, or one each.
fn levels(n: &[f64]) -> Result<[f64; CONTACTS], Failure> {
    if let Some(bad) = n.iter().find(|n| !n.is_finite()) {
        return Err(Failure::Input(format!("--n holds {bad}, allowed are finite numbers")));
    }
    match n {
        [all] => Ok([*all; CONTACTS]),
        _ => n
            .try_into()
            .map_err(|_| Failure::Input(format!("--n holds {} values, allowed are 1 or {CONTACTS}", n.len()))),
    }
}
