//! `slipfit table`: the flash table.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::{
    Failure, SceneArguments, ThreadArguments, print, print_json, progress, simulate::SteppingArguments,
    sweep::LevelArguments,
};
use crate::{
    files,
    flash::{
        TABLE_ADDRESS, TABLE_REGION,
        export::{EXTENSIONS, ExportError, render},
    },
    force_table::{self, Demand, ForceTable},
    number::fixed,
};

/// Makes the flash table and says how large it is and how well it interpolates.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// File to write; the extension says how: .bin .hex .h .rs
    #[arg(short, long, value_name = "FILE", default_value = "table.bin")]
    output: PathBuf,
    /// Greatest error of force (N) from the ramp's start on: the smallest table that meets it is made, as multiples
    /// of a scale (i16) or as numbers (f32).
    #[arg(long, value_name = "N")]
    max_error: Option<f64>,
    #[command(flatten)]
    levels: LevelArguments,
    #[command(flatten)]
    stepping: SteppingArguments,
    #[command(flatten)]
    threads: ThreadArguments,
}

#[derive(Serialize)]
struct Report {
    file: String,
    bytes: usize,
    levels: usize,
    instants: usize,
    encoding: &'static str,
    scene_hash: String,
    worst_force_error_n: f64,
    worst_velocity_error_m_per_s: f64,
    worst_force_error_after_ramp_start_n: f64,
    worst_velocity_error_after_ramp_start_m_per_s: f64,
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let overrides: Vec<_> = self.stepping.overrides().into_iter().chain(self.levels.overrides()).collect();
        let scene = self.scene.load(&overrides)?;
        let extension = self.output.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        if !EXTENSIONS.contains(&extension.as_str()) {
            return Err(Failure::Input(format!("--output: {}", ExportError::Extension { found: extension })));
        }
        if let Some(error) = self.max_error.filter(|error| !(1e-9..=1e6).contains(error)) {
            return Err(Failure::Input(format!("--max-error is {error}, allowed is 1e-9 to 1e6 N")));
        }
        let demand = self.max_error.map_or(Demand::Full, Demand::MaxError);
        force_table::check(&scene, demand).map_err(|error| Failure::Input(error.to_string()))?;
        self.scene.check_output(&self.output)?;
        let bar = progress("simulating", force_table::levels(&scene.sweep).count);
        let made = self.threads.install(|| force_table::make(&scene, self.stepping.scalar, demand, || bar.inc(1)))?;
        bar.finish_and_clear();
        let (table, _) = made?;
        let file = render(&extension, &table.bytes, TABLE_ADDRESS).map_err(anyhow::Error::from)?;
        files::write(&self.output, &file)?;
        if self.scene.json {
            let [force, velocity] = table.worst_error;
            let [force_after, velocity_after] = table.worst_error_after_ramp_start;
            print_json(&Report {
                file: self.output.display().to_string(),
                bytes: table.bytes.len(),
                levels: table.shape[0],
                instants: table.shape[1],
                encoding: table.encoding.name(),
                scene_hash: format!("{:016x}", force_table::scene_hash(&scene)),
                worst_force_error_n: force,
                worst_velocity_error_m_per_s: velocity,
                worst_force_error_after_ramp_start_n: force_after,
                worst_velocity_error_after_ramp_start_m_per_s: velocity_after,
            })
        } else {
            print(&format!("{}\n{}", self.output.display(), describe(&table)))
        }
    }
}

/// Size and interpolation error in words.
pub(super) fn describe(table: &ForceTable) -> String {
    let [levels, instants] = table.shape;
    let errors = |[force, velocity]: [f64; 2]| {
        format!("force {} mN, velocity {} mm/s", fixed(force * 1e3, 3), fixed(velocity * 1e3, 4))
    };
    format!(
        "{} bytes of the {TABLE_REGION} in the TABLE region: {levels} levels of n by {instants} instants, {}\n\
         Worst interpolation error from the ramp's start on: {}\n\
         Worst interpolation error, release included:        {}\n",
        table.bytes.len(),
        table.encoding.name(),
        errors(table.worst_error_after_ramp_start),
        errors(table.worst_error),
    )
}
