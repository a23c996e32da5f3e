//! `slipfit table`: the flash table.

use std::{
    fmt::Write,
    path::{Path, PathBuf},
};

use clap::{Args, ValueEnum};
use serde::Serialize;
use slipfit_core::table::AxisKind;

use super::{
    Failure, JSON_VERSION, SceneArguments, ThreadArguments, check, print, print_json, progress,
    sweep::{LevelArguments, doubts},
    warn,
};
use crate::{
    files,
    flash::{
        AxisSpec, TABLE_ADDRESS, TABLE_REGION,
        export::{EXTENSIONS, ExportError, render},
    },
    force_table::{
        self, Demand, ForceTable,
        position::{self, PositionTable, Reach, Wish},
    },
    number::{fixed, level},
    outcome::Verdict,
    scene::{LevelRange, Scene, parse_levels},
};

/// Makes the flash table and says how large it is and how well it interpolates.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// File to write; the extension says how: .bin .hex .h .rs
    #[arg(short, long, value_name = "FILE", default_value = "table.bin")]
    output: PathBuf,
    /// What force is looked up by, beside the tolerance level. Over position the whole stroke is simulated.
    #[arg(long, value_enum, default_value_t)]
    over: Over,
    /// Commanded speeds (mm/s) of a table over position,speed; each takes the place of drive.speed.
    #[arg(long, value_name = "A:B:STEP", allow_hyphen_values = true)]
    speeds: Option<String>,
    /// Where the positions of a table end (mm). If not given: at the end of the stroke, or where the slowest unit is that
    /// runs at least at half its commanded speed when its run ends.
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    end: Option<f64>,
    /// Greatest error of force (N) where the table is used, over time from the ramp's start on, over position where every
    /// slide nearby comes to: the smallest table that meets it is made, as multiples of a scale (i16) or as numbers
    /// (f32).
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    max_error: Option<f64>,
    #[command(flatten)]
    levels: LevelArguments,
    /// Draws the table's force over its second axis at every level, as SVG.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    threads: ThreadArguments,
}

/// What a table is over, beside the tolerance level.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Over {
    /// Time since the motion's start.
    #[default]
    Time,
    /// How far the slide has come.
    Position,
    /// How far it has come, and the speed it is commanded to.
    #[value(name = "position,speed")]
    PositionAndSpeed,
}

#[derive(Serialize)]
struct Report {
    json_version: u32,
    file: String,
    bytes: usize,
    axes: Vec<AxisReport>,
    encoding: &'static str,
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

#[derive(Serialize)]
struct AxisReport {
    kind: &'static str,
    unit: &'static str,
    first: f32,
    step: f32,
    count: usize,
}

impl From<&AxisSpec> for AxisReport {
    fn from(&AxisSpec { kind, first, step, count }: &AxisSpec) -> Self {
        Self { kind: kind.name(), unit: kind.unit(), first, step, count }
    }
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let overrides: Vec<_> = self.levels.overrides().into_iter().collect();
        let scene = self.scene.load(&overrides)?;
        let extension = self.output.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        if !EXTENSIONS.contains(&extension.as_str()) {
            return Err(Failure::Input(format!("--output: {}", ExportError::Extension { found: extension })));
        }
        if let Some(error) = self.max_error.filter(|error| !(1e-9..=1e6).contains(error)) {
            return Err(Failure::Input(format!("--max-error is {error}, allowed is 1e-9 to 1e6 N")));
        }
        let demand = self.max_error.map_or(Demand::Full, Demand::MaxError);
        let speeds = self.speeds()?;
        let end = self.end.map(|end| end * 1e-3);
        if end.is_some() && self.over == Over::Time {
            return Err(Failure::Input("--end is for --over position".into()));
        }
        let mut scene = scene;
        if self.over != Over::Time {
            let duration = scene.stroke_duration().unwrap_or(scene.run.duration);
            scene.run.duration = duration.max(scene.run.duration);
        }
        let outputs: Vec<_> = std::iter::once(("--output", self.output.as_path()))
            .chain(self.plot.iter().map(|path| ("--plot", path.as_path())))
            .collect();
        let (table, short, doubt) = match self.over {
            Over::Time => {
                let (table, doubt) = self.over_time(&scene, demand, &outputs)?;
                (table, None, doubt)
            }
            Over::Position | Over::PositionAndSpeed => {
                let wish = Wish { speeds: speeds.as_ref(), stroke: end, demand };
                let made = self.over_position(&scene, &wish, &outputs)?;
                (made.table, Some(made.short), made.warning)
            }
        };
        let mut warnings = check::warnings_of(&scene);
        warnings.extend(doubt);
        warnings.extend(coarse(&scene, &table));
        let file = render(&extension, &table.bytes, TABLE_ADDRESS).map_err(anyhow::Error::from)?;
        files::write(&self.output, &file)?;
        if let Some(path) = &self.plot {
            let svg = force_table::picture(&table, &scene.title).map_err(anyhow::Error::from)?;
            files::write(path, svg.as_bytes())?;
        }
        if self.scene.json {
            let [force, velocity] = table.worst_error;
            let [force_in_use, velocity_in_use] = table.worst_error_in_use;
            let [rms_force, rms_velocity] = table.rms_error;
            print_json(&Report {
                json_version: JSON_VERSION,
                file: self.output.display().to_string(),
                bytes: table.bytes.len(),
                axes: table.axes.iter().map(AxisReport::from).collect(),
                encoding: table.encoding.name(),
                scene_hash: format!("{:016x}", force_table::scene_hash(&scene)),
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
            let short = short.map_or_else(String::new, |short| describe_short(&scene, &short));
            print(&format!("{}\n{}{short}", self.output.display(), describe(&table)))?;
            warn(&warnings);
            Ok(())
        }
    }

    /// The speeds asked for (m/s).
    fn speeds(&self) -> Result<Option<LevelRange>, Failure> {
        match (&self.speeds, self.over) {
            (None, Over::Time | Over::Position) => Ok(None),
            (Some(text), Over::PositionAndSpeed) => {
                let range = parse_levels(text).map_err(|error| Failure::Input(format!("--speeds {text}: {error}")))?;
                Ok(Some(LevelRange { first: range.first * 1e-3, step: range.step * 1e-3, count: range.count }))
            }
            (Some(_), _) => Err(Failure::Input("--speeds is for --over position,speed".into())),
            (None, Over::PositionAndSpeed) => {
                Err(Failure::Input("--over position,speed needs --speeds, such as --speeds 50:150:25 (mm/s)".into()))
            }
        }
    }

    /// The table, and a warning where a run cannot be trusted.
    fn over_time(
        &self,
        scene: &Scene,
        demand: Demand,
        outputs: &[(&str, &Path)],
    ) -> Result<(ForceTable, Option<String>), Failure> {
        force_table::check(scene, demand).map_err(|error| Failure::Input(error.to_string()))?;
        self.scene.check_outputs(outputs)?;
        let bar = progress("simulating", force_table::levels(&scene.sweep).count);
        let made = self.threads.install(|| force_table::make(scene, demand, || bar.inc(1)))?;
        bar.finish_and_clear();
        let (table, sweep) = made?;
        Ok((table, doubts(&sweep)))
    }

    fn over_position(
        &self,
        scene: &Scene,
        wish: &Wish<'_>,
        outputs: &[(&str, &Path)],
    ) -> Result<PositionTable, Failure> {
        position::check(scene, wish)?;
        self.scene.check_outputs(outputs)?;
        let bar = progress("simulating", position::runs(scene, wish.speeds));
        let made = self.threads.install(|| position::make(scene, wish, || bar.inc(1)))?;
        bar.finish_and_clear();
        Ok(made?)
    }
}

/// Share of the drive's greatest force from which a table's error is worth a warning.
const COARSE: f64 = 0.05;

/// A warning where the table errs by much of what the drive can push.
pub(super) fn coarse(scene: &Scene, table: &ForceTable) -> Option<String> {
    let ([error, _], greatest) = (table.worst_error_in_use, scene.greatest_force());
    (error > COARSE * greatest).then(|| {
        format!(
            "the table errs by up to {} N where it is used, {} % of the drive's greatest force: neighbouring levels do \
             different things there; take the levels of one verdict, such as --n 1:3:0.1, or finer ones",
            fixed(error, 3),
            fixed(error / greatest * 100.0, 0)
        )
    })
}

/// Size and interpolation error in words.
pub(super) fn describe(table: &ForceTable) -> String {
    let nodes = |axis: &AxisSpec| {
        let what = match axis.kind {
            AxisKind::Level => "levels of n",
            AxisKind::Time => "instants",
            AxisKind::Position => "positions",
            AxisKind::Velocity => "speeds",
        };
        format!("{} {what}", axis.count)
    };
    let errors = |[force, velocity]: [f64; 2]| {
        format!("force {} mN, velocity {} mm/s", fixed(force * 1e3, 3), fixed(velocity * 1e3, 4))
    };
    let [in_use, rms, whole] = if table.axes.iter().any(|axis| axis.kind == AxisKind::Time) {
        [
            " from the ramp's start on: ",
            "Its root mean square:                             ",
            ", release included:        ",
        ]
    } else {
        [
            " where every slide comes to: ",
            "Its root mean square:                               ",
            ", the rest included:         ",
        ]
    };
    let mixed = match table.mixed() {
        pairs if pairs.is_empty() => String::new(),
        pairs => {
            let between: Vec<_> = pairs.iter().map(|pair| pair.map(|n| level(f64::from(n))).join(" and ")).collect();
            format!("The verdict changes between n = {}: a lookup there is no unit's and says so\n", between.join(", "))
        }
    };
    format!(
        "{} bytes of the {TABLE_REGION} in the TABLE region: {}, {}\n\
         Worst interpolation error{in_use}{}\n\
         {rms}{}\n\
         Worst interpolation error{whole}{}\n{mixed}",
        table.bytes.len(),
        table.axes.iter().map(nodes).collect::<Vec<_>>().join(" by "),
        table.encoding.name(),
        errors(table.worst_error_in_use),
        errors(table.rms_error),
        errors(table.worst_error),
    )
}

/// Which units come short, in words: a line for neighbouring levels with the same verdict.
fn describe_short(scene: &Scene, short: &[Reach]) -> String {
    let mut text = String::new();
    let mut by_speed = short.to_vec();
    // Stable: by level within a speed.
    by_speed.sort_by(|one, other| one.speed.total_cmp(&other.speed));
    let belong = |one: &Reach, other: &Reach| {
        one.speed == other.speed && one.verdict == other.verdict && other.n - one.n < 1.5 * scene.sweep.step
    };
    let range = |[one, other]: [String; 2]| if one == other { one } else { format!("{one} to {other}") };
    for group in by_speed.chunk_by(belong) {
        let ends = [group[0], group[group.len() - 1]];
        let (least, most) =
            group.iter().fold((f64::MAX, f64::MIN), |(least, most), at| (at.z.min(least), at.z.max(most)));
        let levels = range(ends.map(|end| level(end.n)));
        let places = range([least, most].map(|z| fixed(z * 1e3, 2)));
        let speed = fixed(ends[0].speed * 1e3, 1);
        let what = match ends[0].verdict {
            Verdict::Jammed => format!("jams at z = {places} mm"),
            other => format!("{other} and is at z = {places} mm after {} ms", fixed(scene.run.duration * 1e3, 0)),
        };
        let _ = writeln!(text, "n = {levels} at {speed} mm/s {what}");
    }
    if !short.is_empty() {
        text += "Beyond, the table holds the last force and velocity 0.\n";
    }
    text
}
