//! The files of a release, by one command: `cargo artefacts FOLDER`.
//!
//! Wheels for Linux (x86-64 and aarch64, also for free-threaded Python) and Windows, the sources of the Python package, the program for
//! Linux as an archive with manual pages and completions, a bill of materials, and SHA-256 sums of them all. Linkers for Linux come from
//! PyPI; that for Windows is Debian's gcc-mingw-w64-x86-64.
#![forbid(unsafe_code)]

mod archive;
mod manual;
mod tools;

use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::{Parser, ValueEnum};

use self::tools::{Tools, run};

/// The root of the repository.
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
/// Options for wheels of Linux: with the C library of 2014, which zig's linker has for each processor.
const LINUX: &[&str] = &["--zig", "--compatibility", "manylinux_2_17"];
/// Systems that have a wheel, and options of maturin. For Windows the linker is that of mingw-w64.
const WHEELS: [(&str, &[&str]); 3] =
    [("x86_64-unknown-linux-gnu", LINUX), ("aarch64-unknown-linux-gnu", LINUX), ("x86_64-pc-windows-gnu", &[])];

/// Python without a global interpreter lock, as pyo3 reads it. It has no stable interface yet, so that a wheel serves one version.
const FREE_THREADED: &str = "implementation=CPython
version=3.14
shared=true
abi3=false
pointer_width=64
build_flags=Py_GIL_DISABLED
suppress_build_script_link_lines=true
";

/// Builds the files of a release.
#[derive(Parser)]
#[command(name = "cargo artefacts")]
struct Arguments {
    /// Folder that gets the files; it may not exist yet.
    folder: PathBuf,
    /// Builds these alone.
    #[arg(long, value_delimiter = ',', default_values = ["wheels", "sources", "archive", "materials"])]
    only: Vec<Artefact>,
}

/// What is built.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Artefact {
    /// Python wheels, which have the program, too.
    Wheels,
    /// The sources of the Python package.
    Sources,
    /// The program for Linux.
    Archive,
    /// A bill of materials (CycloneDX).
    Materials,
}

fn main() -> anyhow::Result<()> {
    let Arguments { folder, only } = Arguments::parse();
    if folder.exists() {
        anyhow::bail!("{} exists already; allowed is a folder that does not", folder.display());
    }
    // It gets its name once everything is in it.
    let beside = std::path::absolute(&folder)?;
    let parent = beside.parent().context("the folder / exists already")?;
    std::fs::create_dir_all(parent)?;
    let unfinished = tempfile::Builder::new().prefix(".artefacts-").tempdir_in(parent)?;
    let into = unfinished.path();
    let tools = Tools::install()?;
    for artefact in only {
        match artefact {
            Artefact::Wheels => wheels(&tools, into)?,
            Artefact::Sources => run(tools.maturin("sdist").arg("--out").arg(into))?,
            Artefact::Archive => archive::build(into)?,
            Artefact::Materials => materials(&tools, into)?,
        }
    }
    sums(into)?;
    std::fs::rename(unfinished.keep(), &beside)?;
    println!("{}", beside.display());
    Ok(())
}

/// A wheel for each system, which serves all versions of Python from 3.11 on; and for Linux those for Python without a global lock.
fn wheels(tools: &Tools, into: &Path) -> anyhow::Result<()> {
    let free_threaded = tempfile::NamedTempFile::new()?;
    std::fs::write(&free_threaded, FREE_THREADED)?;
    let build = || {
        let mut build = tools.maturin("build");
        build.args(["--release", "--strip", "--locked", "--out"]).arg(into);
        build
    };
    for (target, options) in WHEELS {
        run(std::process::Command::new("rustup").args(["target", "add", target]))?;
        run(build().args(options).args(["--target", target]))?;
        if options == LINUX {
            let mut build = build();
            build.args(options).args(["--target", target, "--no-default-features"]);
            run(build.env("PYO3_CONFIG_FILE", free_threaded.path()))?;
        }
    }
    Ok(())
}

/// Every crate that the program is made of, with its version, licence and checksum.
fn materials(tools: &Tools, into: &Path) -> anyhow::Result<()> {
    let name = format!("slipfit-{}.cdx", env!("CARGO_PKG_VERSION"));
    let mut list = tools.cyclonedx()?;
    list.args(["cyclonedx", "--format", "json", "--override-filename", &name]);
    run(list.arg("--manifest-path").arg(Path::new(ROOT).join("host/Cargo.toml")))?;
    // The tool writes one for each crate of the workspace, beside its manifest.
    let name = format!("{name}.json");
    let own = Path::new(ROOT).join("host").join(&name);
    std::fs::copy(&own, into.join(&name)).with_context(|| own.display().to_string())?;
    tools::members()?.iter().try_for_each(|folder| Ok(std::fs::remove_file(folder.join(&name))?))
}

/// SHA-256 of every file in a `folder`, in the form that `sha256sum --check` reads.
fn sums(folder: &Path) -> anyhow::Result<()> {
    let mut names =
        std::fs::read_dir(folder)?.map(|entry| Ok(entry?.file_name())).collect::<std::io::Result<Vec<_>>>()?;
    names.sort();
    let sums =
        std::process::Command::new("sha256sum").args(&names).current_dir(folder).output().context("sha256sum")?;
    anyhow::ensure!(sums.status.success(), "sha256sum: {}", String::from_utf8_lossy(&sums.stderr));
    Ok(std::fs::write(folder.join("SHA256SUMS"), sums.stdout)?)
}
