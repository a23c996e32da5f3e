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
    for name in ["scene.rs", "scene.h"] {
        let kernel = json(folder.path(), &format!("kernel --step 1ms --integrator implicit-euler -o {name}"));
        assert_eq!(kernel["table_hash"], stamp);
        assert_ne!(kernel["scene_hash"], stamp);
        let line = text(name).lines().find(|line| line.contains("TABLE_HASH")).unwrap().to_owned();
        assert!(line.contains(&format!("0x{stamp}")), "{line}");
    }
    assert!(text("table.rs").contains(&format!("pub const SLIPFIT_TABLE_HASH: u64 = 0x{stamp};")));
    // Settings of the scene change both.
    let other = json(folder.path(), "kernel --set friction.coefficient=0.2 --step 1ms -o scene.rs");
    assert_ne!(other["table_hash"], stamp);
    // A table by the kernel's own scheme and step is the one of SCENE_HASH.
    let table = json(folder.path(), "table --n 0:1:0.5 --step 1ms --integrator implicit-euler -o table.bin");
    let kernel = json(folder.path(), "kernel --step 1ms --integrator implicit-euler -o scene.rs");
    assert_eq!(kernel["scene_hash"], table["scene_hash"]);
}

#[test]
fn what_c_cannot_do_is_refused_at_the_desk() {
    let folder = tempfile::tempdir().unwrap();
    for (line, why) in [
        ("kernel --set contact.exponent=2 -o x.h", "contact.exponent is 2, the C library is built for 1.5"),
        ("kernel --integrator sdirk2 -o x.h", "--integrator: the C library steps by implicit-euler, not by sdirk2"),
    ] {
        let output = slipfit(folder.path(), line);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {errors}");
        assert!(errors.contains(why), "{line}: {errors}");
        assert!(!folder.path().join("x.h").exists(), "{line}");
    }
    // Without a word about the scheme C gets its own, and says so by the hash.
    let [silent, said] = ["", " --integrator implicit-euler"]
        .map(|scheme| json(folder.path(), &format!("kernel --step 1ms{scheme} -o x.h"))["scene_hash"].clone());
    assert_eq!(silent, said);
}
