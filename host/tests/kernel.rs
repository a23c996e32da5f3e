//! `slipfit kernel` as firmware meets it: what it refuses, and that its tables fit.

use std::{
    path::Path,
    process::{Command, Output},
};

fn slipfit(folder: &Path, line: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_slipfit")).current_dir(folder).args(line.split(' ')).output().unwrap()
}

fn json(folder: &Path, line: &str) -> serde_json::Value {
    let output = slipfit(folder, &format!("{line} --json"));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// A fine table for a coarse kernel, made by the two command lines that a controller needs: no hash is copied by hand.
#[test]
fn a_table_is_the_one_that_the_kernel_expects() {
    let folder = tempfile::tempdir().unwrap();
    let text = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let table = json(folder.path(), "table --n 0:1:0.5 -o table.rs");
    let stamp = table["scene_hash"].as_str().unwrap();
    for (name, options) in [("scene.rs", ""), ("scene.h", ""), ("scene.rs", " --step 250us --integrator sdirk2")] {
        let kernel = json(folder.path(), &format!("kernel{options} -o {name}"));
        assert_eq!(kernel["scene_hash"], stamp);
        let line = text(name).lines().find(|line| line.contains("SCENE_HASH")).unwrap().to_owned();
        assert!(line.contains(&format!("0x{stamp}")), "{line}");
    }
    assert!(text("table.rs").contains(&format!("pub const SLIPFIT_TABLE_HASH: u64 = 0x{stamp};")));
    // What is simulated changes it; how long, how well and by what does not.
    let hash = |line: &str| json(folder.path(), line)["scene_hash"].clone();
    assert_ne!(hash("kernel --set friction.coefficient=0.2 -o scene.rs"), stamp);
    assert_eq!(hash("table --n 0:1:0.5 --set run.duration=300 --set run.error=1e-5 -o table.bin"), stamp);
}

#[test]
fn what_c_cannot_do_is_refused_at_the_desk() {
    let folder = tempfile::tempdir().unwrap();
    for (line, why) in [
        ("kernel --set contact.exponent=2 -o x.h", "contact.exponent is 2, the C library is built for 1.5"),
        ("kernel --scalar f64 -o x.h", "controller.scalar is f64"),
        ("kernel --integrator sdirk2 -o x.h", "controller.integrator is sdirk2, the C library steps by implicit-euler"),
    ] {
        let output = slipfit(folder.path(), line);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {errors}");
        assert!(errors.contains(why), "{line}: {errors}");
        assert!(!folder.path().join("x.h").exists(), "{line}");
    }
}

#[test]
fn a_crate_is_written_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(folder.path().join("slipfit/core")).unwrap();
    std::fs::write(folder.path().join("slipfit/core/Cargo.toml"), "").unwrap();
    let written = json(folder.path(), "kernel --crate firmware/slide --core slipfit/core");
    assert_eq!(written["file"], "firmware/slide");
    let text = |name: &str| std::fs::read_to_string(folder.path().join("firmware/slide").join(name)).unwrap();
    assert!(text("Cargo.toml").contains("slipfit-core = { path = \"../../slipfit/core\" }\n"));
    let stamp = written["scene_hash"].as_str().unwrap();
    assert!(text("src/lib.rs").contains(&format!("pub const SCENE_HASH: u64 = 0x{stamp};")));
    for line in [
        "kernel --crate Slide",
        "kernel --crate slide -o scene.rs",
        "kernel --core ../core",
        "kernel --core ../core -o scene.rs",
    ] {
        let output = slipfit(folder.path(), line);
        assert_eq!(output.status.code(), Some(2), "{line}");
    }
    assert!(!folder.path().join("Slide").exists() && !folder.path().join("slide").exists());
}
