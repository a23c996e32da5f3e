//! `slipfit kernel`: the scene as source text for firmware.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use slipfit_system::files;

use super::{
    arguments::{Moving, SceneArguments},
    failure::Failure,
    simulate::StepArguments,
    terminal::{print, print_json, warn},
};
use crate::{
    dynamics::{
        driven::Driven,
        scheme::{IntegratorKind, ScalarKind},
    },
    firmware::{
        kernel_crate::{CrateFiles, crate_name, is_written, mechanism_crate, slide_crate},
        kernel_source::{EXTENSIONS, c_header, rust_source},
    },
    mechanism::{self, ByDrive, Mechanism},
    setup::ControllerSpec,
};

/// Writes the scene as source code for firmware: a type and its constants.
///
/// For slides and mechanisms.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// File to write: .rs for slipfit-core, .h for the C library (slides only; `--crate` is for any scene).
    ///
    /// Names in a header follow the file's: `slipfit_this_left` in left.h.
    #[arg(short, long, value_name = "FILE", default_value = "scene.rs")]
    output: PathBuf,
    /// Writes a crate into this folder, with the folder's name, instead of a file; with functions and a header for C.
    ///
    /// The folder is new or empty, or one that `--crate` has written, which is overwritten.
    ///
    /// The step is compiled in that crate alone. So a line in the workspace's Cargo profile, which the crate's Cargo.toml shows, keeps
    /// the step fast in a firmware image that is built for size.
    #[arg(long = "crate", value_name = "DIR", conflicts_with = "output")]
    folder: Option<PathBuf>,
    /// Folder of slipfit-core, on which the crate depends.
    ///
    /// If not given, the crate asks crates.io for it. crates.io does not have it, so the crate does not build.
    #[arg(long, value_name = "DIR", requires = "folder", conflicts_with = "output")]
    core: Option<PathBuf>,
    #[command(flatten)]
    steps: StepArguments,
}

#[derive(Serialize)]
struct Report {
    file: String,
    /// What flash tables are stamped with; of a mechanism with one drive.
    #[serde(skip_serializing_if = "Option::is_none")]
    scene_hash: Option<String>,
}

/// The way from one absolute folder to another.
fn way(from: &Path, to: &Path) -> PathBuf {
    let common = from.components().zip(to.components()).take_while(|(one, other)| one == other).count();
    if common == 0 {
        return to.to_owned();
    }
    let up = from.components().skip(common).map(|_| std::path::Component::ParentDir);
    up.chain(to.components().skip(common)).collect()
}

/// The `folder` of slipfit-core that was given as `--core`, absolute and without links.
pub(super) fn core_folder(folder: &Path) -> Result<PathBuf, Failure> {
    let unusable = |why: &dyn std::fmt::Display| {
        Failure::Input(format!("--core: {} is not slipfit-core's folder: {why}", folder.display()))
    };
    let absolute = folder.canonicalize().map_err(|error| unusable(&error))?;
    std::fs::read(absolute.join("Cargo.toml")).map_err(|error| unusable(&format!("its Cargo.toml: {error}")))?;
    Ok(absolute)
}

/// Refuses a `folder` for a crate of these `files` that has anything in it which slipfit did not write.
fn check_folder(folder: &Path, files: &[&Path]) -> Result<(), Failure> {
    let is_foreign = |path: &Path| path.exists() && !std::fs::read(path).is_ok_and(|text| is_written(&text));
    let foreign = files.iter().find(|path| is_foreign(path)).map(|path| path.to_path_buf());
    let manifest = folder.join("Cargo.toml");
    // Without a manifest it is no crate of slipfit's, which may have other files beside.
    let first = || std::fs::read_dir(folder).ok()?.next()?.ok().map(|entry| entry.path());
    match foreign.or_else(|| if manifest.exists() { None } else { first() }) {
        Some(path) => Err(Failure::Input(format!(
            "--crate: {} was not written by slipfit and is not overwritten; name a folder that is new or empty, or one that \
             --crate has written",
            path.display()
        ))),
        None => Ok(()),
    }
}

impl Arguments {
    pub fn run(&self) -> Result<(), Failure> {
        let moving = self.scene.load_moving(&self.steps.overrides())?;
        let ControllerSpec { integrator, scalar, .. } = match &moving {
            Moving::Slide(scene) => scene.controller,
            Moving::Mechanism(mechanism) => mechanism.controller,
        };
        if scalar != ScalarKind::F32 {
            return Err(Failure::Input(
                "controller.scalar is f64, kernels for firmware compute in f32: --set controller.scalar=f32".into(),
            ));
        }
        let scene = match moving {
            Moving::Slide(scene) => scene,
            Moving::Mechanism(mechanism) => return self.write_mechanism(&mechanism),
        };
        if let Some(folder) = &self.folder {
            let core = self.core_from(folder)?;
            let files = |name: &str| Ok(slide_crate(&scene, name, core.as_deref()));
            return self.write_crate(folder, Some(scene.hash()), files);
        }
        let extension = self.output.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let text = match extension.as_str() {
            "rs" => rust_source(&scene),
            "h" if integrator != IntegratorKind::ImplicitEuler => {
                let (asked, known) = (integrator.name(), IntegratorKind::ImplicitEuler.name());
                return Err(Failure::Input(format!(
                    "controller.integrator is {asked}, the C library steps by {known}; --integrator {known} takes that"
                )));
            }
            "h" => {
                let stem = self.output.file_stem().unwrap_or_default().to_string_lossy();
                c_header(&scene, &stem).map_err(|error| Failure::Input(error.to_string()))?
            }
            _ => {
                let allowed = EXTENSIONS.join(", .");
                return Err(Failure::Input(format!(
                    "--output: a scene is not written as {extension:?}; allowed are .{allowed}"
                )));
            }
        };
        self.write_text(&text)?;
        self.report(Some(scene.hash()), &self.output)
    }

    /// Where slipfit-core is, as seen from the `folder` of a crate that is about to be written.
    fn core_from(&self, folder: &Path) -> Result<Option<PathBuf>, Failure> {
        let Some(core) = &self.core else { return Ok(None) };
        let core = core_folder(core)?;
        let mut parent = std::path::absolute(folder).map_err(anyhow::Error::from)?;
        let mut missing = PathBuf::new();
        // Of what is not there yet there are no links to follow.
        while !parent.exists() {
            let Some(name) = parent.file_name().map(PathBuf::from) else { break };
            missing = name.join(missing);
            parent.pop();
        }
        let folder = parent.canonicalize().map_err(anyhow::Error::from)?.join(missing);
        Ok(Some(way(&folder, &core)))
    }

    fn write_text(&self, text: &str) -> Result<(), Failure> {
        self.scene.check_outputs(&[("--output", &self.output)])?;
        Ok(files::write(&self.output, text.as_bytes())?)
    }

    fn write_mechanism(&self, mechanism: &Mechanism) -> Result<(), Failure> {
        let hash = ByDrive::new(mechanism, 0).filter(|_| mechanism.drives.len() == 1).map(|driven| driven.hash());
        if let Some(folder) = &self.folder {
            let core = self.core_from(folder)?;
            let files = |name: &str| Ok(mechanism_crate(mechanism, name, core.as_deref())?);
            return self.write_crate(folder, hash, files);
        }
        if self.output.extension().is_none_or(|extension| extension != "rs") {
            return Err(Failure::Input(
                "a mechanism is written as a Rust module, --output FILE.rs, or as a crate that C can call, too, --crate DIR".into(),
            ));
        }
        self.write_text(&mechanism::rust_source(mechanism)?)?;
        self.report(hash, &self.output)
    }

    fn write_crate(
        &self,
        folder: &Path,
        hash: Option<u64>,
        files: impl Fn(&str) -> Result<CrateFiles, Failure>,
    ) -> Result<(), Failure> {
        let name = crate_name(folder).map_err(|error| Failure::Input(format!("--crate: {error}")))?;
        let files = files(&name)?.map(|(path, text)| (folder.join(path), text));
        check_folder(folder, &files.each_ref().map(|(path, _)| path.as_path()))?;
        let sources = folder.join("src");
        files::prepare_folder(&sources)?;
        self.scene.check_outputs(&files.each_ref().map(|(path, _)| ("--crate", path.as_path())))?;
        for (path, text) in &files {
            files::write(path, text.as_bytes())?;
        }
        if self.core.is_none() {
            warn(&[
                "the crate asks crates.io for slipfit-core, which is not there: give its folder as --core".to_owned()
            ]);
        }
        self.report(hash, folder)
    }

    fn report(&self, hash: Option<u64>, written: &Path) -> Result<(), Failure> {
        let file = written.display().to_string();
        let scene_hash = hash.map(|hash| format!("{hash:016x}"));
        if self.scene.json {
            return print_json(&Report { file, scene_hash });
        }
        match scene_hash {
            Some(scene_hash) => print(&format!("{file}, scene hash {scene_hash}")),
            None => print(&file),
        }
    }
}
