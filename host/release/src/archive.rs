//! The program for Linux as an archive to unpack into /usr/local or anywhere.

use std::{path::Path, process::Command};

use crate::{
    ROOT, manual,
    tools::{run, target_folder},
};

/// The system that the program is for.
const TARGET: &str = "x86_64-unknown-linux-gnu";
/// Texts that go with it.
const TEXTS: [&str; 4] = ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"];

/// Builds the archive into a folder: the program, which needs no library of the system, manual pages, completions, licences.
pub fn build(into: &Path) -> anyhow::Result<()> {
    run(Command::new("cargo")
        .args(["build", "--release", "--locked", "-p", "slipfit", "--target", TARGET])
        .env("CARGO_TARGET_DIR", target_folder()?)
        // With the C library in it.
        .env("CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_RUSTFLAGS", "-Ctarget-feature=+crt-static")
        .current_dir(ROOT))?;
    let name = format!("slipfit-{}-x86_64-linux", env!("CARGO_PKG_VERSION"));
    let whole = tempfile::tempdir()?;
    let folder = whole.path().join(&name);
    let (bin, doc) = (folder.join("bin"), folder.join("share/doc/slipfit"));
    std::fs::create_dir_all(&bin)?;
    std::fs::create_dir_all(&doc)?;
    std::fs::copy(target_folder()?.join(TARGET).join("release/slipfit"), bin.join("slipfit"))?;
    run(Command::new("strip").arg(bin.join("slipfit")))?;
    for text in TEXTS {
        std::fs::copy(Path::new(ROOT).join(text), doc.join(text))?;
    }
    manual::write(&slipfit::cli::command(), &folder)?;
    // The same bytes whoever packs it, and when.
    run(Command::new("tar")
        .args([
            "--sort=name",
            "--mtime=@0",
            "--owner=0",
            "--group=0",
            "--numeric-owner",
            "--use-compress-program=gzip -n9",
            "-cf",
        ])
        .arg(into.join(format!("{name}.tar.gz")))
        .args(["-C", &whole.path().display().to_string(), &name]))
}
