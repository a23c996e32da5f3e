//! Embeds slipfit-core's source, which `slipfit fmu` compiles, so that an installed program needs no repository.

use std::{env, fmt::Write, fs, io, path::Path};

fn main() -> io::Result<()> {
    let root = Path::new(&env::var("CARGO_MANIFEST_DIR").unwrap_or_default()).join("..");
    let mut paths = vec!["core/Cargo.toml".to_owned()];
    collect(&root, "core/src", &mut paths)?;
    paths.sort();
    let mut text = "&[\n".to_owned();
    for path in paths {
        let _ = writeln!(text, "    ({path:?}, include_str!({:?})),", root.join(&path).display().to_string());
    }
    text += "]\n";
    println!("cargo::rerun-if-changed={}", root.join("core/src").display());
    println!("cargo::rerun-if-changed={}", root.join("core/Cargo.toml").display());
    fs::write(Path::new(&env::var("OUT_DIR").unwrap_or_default()).join("core_source.rs"), text)
}

/// Adds the files in the folder at `path`.
fn collect(root: &Path, path: &str, paths: &mut Vec<String>) -> io::Result<()> {
    for entry in fs::read_dir(root.join(path))? {
        let entry = entry?;
        let inside = format!("{path}/{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            collect(root, &inside, paths)?;
        } else if inside.ends_with(".rs") {
            paths.push(inside);
        }
    }
    Ok(())
}
