//! `slipfit table`: the flash table.

mod axis;
mod file;
mod production;
mod words;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde::Serialize;

use super::{
    arguments::{DriveArguments, Moving, SceneArguments, ThreadArguments},
    call, check,
    failure::Failure,
    mechanism,
    sweep::{LevelArguments, doubts},
    terminal::{print, print_json, progress, warn},
};
use crate::{
    dynamics::driven::{DriveKind, Driven},
    firmware::{
        force_table::{
            self, Demand, ForceTable,
            position::{self, PositionTable, Reach, Wish},
        },
        production_table,
    },
    scene::parse_levels,
    setup::LevelRange,
    show::force_table::picture,
};

use axis::AxisReport;
use production::{Output, ProductionArguments};
pub(super) use words::coarse;
use words::{describe, describe_short};

/// Makes the flash table of drive force and speed, and says how large and how exact it is.
///
/// For slides and mechanisms with a drive. The table is over the tolerance level and over time, or over position, or over position
/// and commanded speed.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// File to write; its extension gives the format: .bin, .hex, .h (C header) or .rs (Rust).
    ///
    /// Names in a header follow the file's: `slipfit_left_bytes` in left.h.
    #[arg(short, long, value_name = "FILE", default_value = "table.bin")]
    output: PathBuf,
    #[command(flatten)]
    drive: DriveArguments,
    /// What the table is over, besides the tolerance level.
    ///
    /// Over position a slide's whole stroke is simulated.
    #[arg(long, value_enum, default_value_t)]
    over: Over,
    /// Commanded speeds from A to B (mm/s, or rad/s where the drive turns) of a table over position,speed.
    ///
    /// Each speed is simulated in place of the scene's `drive.speed`.
    #[arg(long, value_name = "A:B:STEP", allow_hyphen_values = true)]
    speeds: Option<String>,
    /// Last position of the table (mm, or ° where the drive turns).
    ///
    /// If not given, it is where the slowest level with the verdict "runs" is when its run ends, at most the end of the stroke. Where no
    /// level runs, it is the farthest position that one reaches.
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    end: Option<f64>,
    /// Greatest force error (N, or N·m where the drive turns) that the smallest table may have.
    ///
    /// The error counts where the table is used: over time from the ramp's start on, over position where all neighbouring levels get
    /// to. Values are stored in 16 bits with a scale (i16), or as f32. If not given, the table has every level, the
    /// finest steps that fit into its region of flash, and f32.
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    max_error: Option<f64>,
    #[command(flatten)]
    levels: LevelArguments,
    /// Draws the force at every level over time or position, as SVG.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    production: ProductionArguments,
    #[command(flatten)]
    threads: ThreadArguments,
}

/// What a table is over, beside the tolerance level.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Over {
    /// Time since the start of the run.
    #[default]
    Time,
    /// Travel of the slide, or of the body with the drive.
    Position,
    /// Travel and commanded speed.
    #[value(name = "position,speed")]
    PositionAndSpeed,
}

#[derive(Serialize)]
struct Report {
    file: String,
    bytes: usize,
    axes: Vec<AxisReport>,
    encoding: &'static str,
    /// N, or N·m of a drive that turns, whose forces and speeds are torques and rad/s.
    effort_unit: &'static str,
    scene_hash: String,
    worst_force_error_n: f64,
    worst_velocity_error_m_per_s: f64,
    worst_force_error_in_use_n: f64,
    worst_velocity_error_in_use_m_per_s: f64,
    rms_force_error_n: f64,
    rms_velocity_error_m_per_s: f64,
    /// Neighbouring levels between which a verdict changes, so that a lookup between them is no unit's and says so.
    mixed_levels: Vec<[f32; 2]>,
    /// Units that do not come to the last position, in SI units; over position only.
    #[serde(skip_serializing_if = "Option::is_none")]
    short: Option<Vec<Reach>>,
    warnings: Vec<String>,
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        if self.production.production {
            return self.of_production();
        }
        self.production.refuse()?;
        let overrides: Vec<_> = self.levels.overrides().into_iter().collect();
        let is_stroke = self.over != Over::Time;
        let (moving, product) = self.scene.load_moving_with_product(&overrides)?;
        match moving {
            Moving::Slide(mut scene) => {
                self.drive.refuse()?;
                let duration = scene.stroke_duration().filter(|_| is_stroke);
                scene.run.duration = scene.run.duration.max(duration.unwrap_or_default());
                let mut warnings = check::warnings_of(&scene);
                warnings.extend(product.into_iter().flat_map(|product| product.warnings));
                self.make(&*scene, warnings)
            }
            Moving::Mechanism(mechanism) => {
                let driven = self.drive.of(&mechanism)?;
                let mut warnings = mechanism::warnings_of(&mechanism)?;
                warnings.extend(product.into_iter().flat_map(|product| product.warnings));
                self.make(&driven, warnings)
            }
        }
    }

    fn of_production(&self) -> Result<(), Failure> {
        let given = [
            ("--speeds", self.speeds.is_some()),
            ("--end", self.end.is_some()),
            ("--max-error", self.max_error.is_some()),
            ("--plot", self.plot.is_some()),
            ("--n", self.levels.overrides().is_some()),
        ];
        if let Some((option, _)) = given.into_iter().find(|(_, is_given)| *is_given) {
            return Err(Failure::Input(format!("{option} has no effect on a table of the production")));
        }
        let over = match self.over {
            Over::Time => production_table::Over::Time,
            Over::Position => production_table::Over::Position,
            Over::PositionAndSpeed => {
                return Err(Failure::Input("--production is over time or position, not position,speed".into()));
            }
        };
        let Self { scene, drive, threads, output, .. } = self;
        self.production.make(&Output { scene, drive, threads, output, over })
    }

    fn make(&self, driven: &dyn Driven, mut warnings: Vec<String>) -> Result<(), Failure> {
        let kind = driven.kind();
        let extension = file::format_of(&self.output)?;
        if let Some(error) = self.max_error.filter(|error| !(1e-9..=1e6).contains(error)) {
            let unit = kind.effort_unit();
            return Err(Failure::Input(format!("--max-error is {error}, allowed is 1e-9 to 1e6 {unit}")));
        }
        let demand = self.max_error.map_or(Demand::Full, Demand::MaxError);
        let speeds = self.speeds(kind)?;
        let end = self.end.map(|end| end / kind.travel(1.0));
        if end.is_some() && self.over == Over::Time {
            return Err(Failure::Input("--end is for --over position".into()));
        }
        let outputs: Vec<_> = std::iter::once(("--output", self.output.as_path()))
            .chain(self.plot.iter().map(|path| ("--plot", path.as_path())))
            .collect();
        let (table, short, doubt) = match self.over {
            Over::Time => {
                let (table, doubt) = self.over_time(driven, demand, &outputs)?;
                (table, None, doubt)
            }
            Over::Position | Over::PositionAndSpeed => {
                let wish = Wish { speeds: speeds.as_ref(), stroke: end, demand };
                let made = self.over_position(driven, &wish, &outputs)?;
                (made.table, Some(made.short), made.warning)
            }
        };
        warnings.extend(doubt);
        warnings.extend(coarse(driven, &table));
        file::write(&self.output, &extension, &table.bytes)?;
        call::picture(self.plot.as_deref(), "table", || picture(kind, &table, driven.title()))?;
        if self.scene.json {
            let [force, velocity] = table.worst_error;
            let [force_in_use, velocity_in_use] = table.worst_error_in_use;
            let [rms_force, rms_velocity] = table.rms_error;
            print_json(&Report {
                file: self.output.display().to_string(),
                bytes: table.bytes.len(),
                axes: table.axes.iter().map(|axis| AxisReport::new(kind, axis)).collect(),
                effort_unit: kind.effort_unit(),
                encoding: table.encoding.name(),
                scene_hash: format!("{:016x}", driven.hash()),
                worst_force_error_n: force,
                worst_velocity_error_m_per_s: velocity,
                worst_force_error_in_use_n: force_in_use,
                worst_velocity_error_in_use_m_per_s: velocity_in_use,
                rms_force_error_n: rms_force,
                rms_velocity_error_m_per_s: rms_velocity,
                mixed_levels: table.mixed(),
                short,
                warnings,
            })
        } else {
            let short = short.map_or_else(String::new, |short| describe_short(driven, &short));
            print(&format!("{}\n{}{short}", self.output.display(), describe(kind, &table)))?;
            warn(&warnings);
            Ok(())
        }
    }

    /// The speeds asked for (m/s).
    fn speeds(&self, kind: DriveKind) -> Result<Option<LevelRange>, Failure> {
        match (&self.speeds, self.over) {
            (None, Over::Time | Over::Position) => Ok(None),
            (Some(text), Over::PositionAndSpeed) => {
                let range = parse_levels(text).map_err(|error| Failure::Input(format!("--speeds {text}: {error}")))?;
                let [first, step] = [range.first, range.step].map(|speed| speed / kind.speed(1.0));
                Ok(Some(LevelRange { first, step, count: range.count }))
            }
            (Some(_), _) => Err(Failure::Input("--speeds is for --over position,speed".into())),
            (None, Over::PositionAndSpeed) => Err(Failure::Input(
                "--over position,speed needs --speeds, such as --speeds 50:150:25 (mm/s, or rad/s)".into(),
            )),
        }
    }

    /// The table, and a warning where a run cannot be trusted.
    fn over_time(
        &self,
        driven: &dyn Driven,
        demand: Demand,
        outputs: &[(&str, &Path)],
    ) -> Result<(ForceTable, Option<String>), Failure> {
        force_table::check(driven, demand).map_err(|error| Failure::Input(error.to_string()))?;
        self.scene.check_outputs(outputs)?;
        let bar = progress("simulating", force_table::levels(driven.levels()).count);
        let made = self.threads.install(|| force_table::make(driven, demand, || bar.inc(1)))?;
        bar.finish_and_clear();
        let (table, sweep) = made?;
        Ok((table, doubts(&sweep)))
    }

    fn over_position(
        &self,
        driven: &dyn Driven,
        wish: &Wish<'_>,
        outputs: &[(&str, &Path)],
    ) -> Result<PositionTable, Failure> {
        position::check(driven, wish)?;
        self.scene.check_outputs(outputs)?;
        let bar = progress("simulating", position::runs(driven, wish.speeds));
        let made = self.threads.install(|| position::make(driven, wish, || bar.inc(1)))?;
        bar.finish_and_clear();
        Ok(made?)
    }
}
