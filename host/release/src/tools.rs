//! Programs that build a release, in a folder of their own.

use std::{
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::Context;

use crate::ROOT;

/// What builds wheels, and the compiler and linker of all systems.
const PACKAGES: [&str; 2] = ["maturin>=1.9,<2", "ziglang>=0.13"];
/// What lists the crates of a program.
const CYCLONEDX: &str = "cargo-cyclonedx@0.5.9";

/// Where the tools are.
pub struct Tools {
    folder: PathBuf,
}

impl Tools {
    /// Installs what is missing.
    pub fn install() -> anyhow::Result<Self> {
        let folder = target_folder()?.join("release-tools");
        if !folder.join("bin/maturin").exists() {
            run(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&folder))?;
            run(Command::new(folder.join("bin/pip")).args(["install", "--quiet"]).args(PACKAGES))?;
        }
        Ok(Self { folder })
    }

    /// A command of maturin for the Python package.
    pub fn maturin(&self, command: &str) -> Command {
        let mut maturin = Command::new(self.folder.join("bin/maturin"));
        maturin.arg(command).current_dir(Path::new(ROOT).join("host/python"));
        maturin.env("VIRTUAL_ENV", &self.folder);
        maturin
    }

    /// Cargo's command that lists crates.
    pub fn cyclonedx(&self) -> anyhow::Result<Command> {
        let program = self.folder.join("bin/cargo-cyclonedx");
        if !program.exists() {
            run(Command::new("cargo").args(["install", "--quiet", "--locked", CYCLONEDX, "--root"]).arg(&self.folder))?;
        }
        Ok(Command::new(program))
    }
}

/// The folder in which Cargo builds.
pub fn target_folder() -> anyhow::Result<PathBuf> {
    // This program lies in one of its profiles' folders.
    let own = std::env::current_exe()?;
    Ok(own.ancestors().nth(2).context("the program lies in no folder of Cargo's")?.to_owned())
}

/// The folders of the workspace's crates.
pub fn members() -> anyhow::Result<Vec<PathBuf>> {
    let mut command = Command::new("cargo");
    let output = command.args(["metadata", "--no-deps", "--format-version", "1"]).current_dir(ROOT).output()?;
    let about: serde_json::Value = serde_json::from_slice(&output.stdout).context("cargo metadata")?;
    let manifests = about["packages"].as_array().into_iter().flatten().filter_map(|one| one["manifest_path"].as_str());
    Ok(manifests.filter_map(|path| Path::new(path).parent()).map(Path::to_owned).collect())
}

/// Runs a program, which has to succeed.
pub fn run(command: &mut Command) -> anyhow::Result<()> {
    eprintln!("{command:?}");
    let status = command.status().with_context(|| format!("{command:?}"))?;
    anyhow::ensure!(status.success(), "{command:?}: {status}");
    Ok(())
}
