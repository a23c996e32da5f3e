//! `slipfit kernel`: the scene as source text for firmware.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::{Failure, SceneArguments, print, print_json, simulate::SchemeArguments};
use crate::{
    files,
    force_table::scene_hash,
    kernel_source::{EXTENSIONS, c_header, rust_source},
    scheme::IntegratorKind,
};

/// Writes the scene as a constant and a type, for firmware to compile.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// File to write; the extension says for whom: .rs for slipfit-core, .h for the C library
    #[arg(short, long, value_name = "FILE", default_value = "scene.rs")]
    output: PathBuf,
    #[command(flatten)]
    scheme: SchemeArguments,
}

#[derive(Serialize)]
struct Report {
    file: String,
    scene_hash: String,
    table_hash: String,
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let mut scene = self.scene.load(&self.scheme.overrides())?;
        // What `slipfit table` makes its tables by: the same scene, but for the kernel's own scheme and step.
        let desk = self.scene.load(&[])?;
        let table_hash = scene_hash(&desk);
        let extension = self.output.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let text = match extension.as_str() {
            "rs" => rust_source(&scene, table_hash),
            "h" => {
                let (asked, known) = (scene.run.integrator, IntegratorKind::ImplicitEuler);
                if asked != known && asked != desk.run.integrator {
                    let (asked, known) = (asked.name(), known.name());
                    return Err(Failure::Input(format!(
                        "--integrator: the C library steps by {known}, not by {asked}"
                    )));
                }
                scene.run.integrator = known;
                c_header(&scene, table_hash).map_err(|error| Failure::Input(error.to_string()))?
            }
            _ => {
                let allowed = EXTENSIONS.join(", .");
                return Err(Failure::Input(format!(
                    "--output: a scene is not written as {extension:?}; allowed are .{allowed}"
                )));
            }
        };
        self.scene.check_output(&self.output)?;
        files::write(&self.output, text.as_bytes())?;
        let [scene_hash, table_hash] = [scene_hash(&scene), table_hash].map(|hash| format!("{hash:016x}"));
        let file = self.output.display().to_string();
        if self.scene.json {
            print_json(&Report { file, scene_hash, table_hash })
        } else {
            print(&format!("{file}, scene hash {scene_hash}, of its tables {table_hash}"))
        }
    }
}
