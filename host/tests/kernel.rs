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
        ("kernel --set controller.scalar=f64 -o x.h", "controller.scalar is f64"),
        ("kernel --set controller.scalar=f64 --crate x", "controller.scalar is f64"),
        ("kernel --scalar f32 -o x.h", "unexpected argument '--scalar'"),
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

/// Only what slipfit wrote, or nothing, makes room for a crate.
#[test]
fn a_folder_is_not_overwritten_unasked() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::create_dir_all(path("own/src")).unwrap();
    std::fs::write(path("own/Cargo.toml"), "[package]\nname = \"own\"\n").unwrap();
    std::fs::write(path("own/src/lib.rs"), "// mine\n").unwrap();
    std::fs::create_dir(path("notes")).unwrap();
    std::fs::write(path("notes/today.txt"), "mine").unwrap();
    for (scene, name, file) in
        [("", "own", "Cargo.toml"), (" slider-crank", "own", "Cargo.toml"), ("", "notes", "today.txt")]
    {
        let output = slipfit(folder.path(), &format!("kernel{scene} --crate {name}"));
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{name}: {errors}");
        assert!(errors.contains(&format!("{name}/{file} was not written by slipfit")), "{errors}");
    }
    assert_eq!(std::fs::read_to_string(path("own/src/lib.rs")).unwrap(), "// mine\n");
    assert_eq!(std::fs::read_dir(path("notes")).unwrap().count(), 1);
    // Of one's own crate the scene can change, unless one of its files is somebody else's.
    std::fs::create_dir(path("empty")).unwrap();
    for name in ["slide", "empty"] {
        json(folder.path(), &format!("kernel --crate {name}"));
        std::fs::write(path(name).join("Cargo.lock"), "").unwrap();
        json(folder.path(), &format!("kernel --set slide.mass=90 --crate {name}"));
        assert!(std::fs::read_to_string(path(name).join("src/lib.rs")).unwrap().contains("mass: 0.09,"));
        std::fs::write(path(name).join("src/lib.rs"), "// mine\n").unwrap();
        assert_eq!(slipfit(folder.path(), &format!("kernel --crate {name}")).status.code(), Some(2));
        assert_eq!(std::fs::read_to_string(path(name).join("src/lib.rs")).unwrap(), "// mine\n");
    }
}

/// What a C compiler makes of `text` in the `folder`: what the program prints, or nothing if it does not compile.
fn compiled(folder: &Path, text: &str) -> Option<String> {
    std::fs::write(folder.join("main.c"), text).unwrap();
    let strict = ["-std=c11", "-pedantic", "-Wall", "-Wextra", "-Werror", "-I"];
    let library = Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/capi/include");
    let mut compiler = Command::new("cc");
    let built =
        compiler.current_dir(folder).args(strict).arg(library).args(["main.c", "-o", "program"]).output().unwrap();
    let run = || Command::new(folder.join("program")).output().unwrap().stdout;
    built.status.success().then(|| String::from_utf8(run()).unwrap())
}

#[test]
fn a_program_includes_two_scenes() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("b")).unwrap();
    json(folder.path(), "kernel -o scene.h");
    json(folder.path(), "kernel --set slide.mass=90 -o Heavy-2.h");
    json(folder.path(), "kernel --set slide.mass=90 -o b/scene.h");
    let program = |headers: &str, values: &str| {
        format!(
            "#include \"slipfit.h\"\n{headers}\n#include <stdio.h>\nint main(void) {{ printf({values}); return 0; }}\n"
        )
    };
    let both = program(
        "#include \"scene.h\"\n#include \"Heavy-2.h\"\n#include \"scene.h\"\n",
        "\"%g %g %d\", slipfit_this_scene.mass, slipfit_this_heavy_2.mass, SLIPFIT_SCENE_HASH != SLIPFIT_HEAVY_2_HASH",
    );
    assert_eq!(compiled(folder.path(), &both).as_deref(), Some("0.0818 0.09 1"));
    // Of one name in two folders: the second one is not dropped but refused.
    let same = program("#include \"scene.h\"\n#include \"b/scene.h\"", "\"%g\", slipfit_this_scene.mass");
    assert_eq!(compiled(folder.path(), &same), None);
}

#[test]
fn headers_of_crates_compile_whatever_they_are_called() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["int", "class", "exit", "main", "float", "errno"] {
        json(folder.path(), &format!("kernel hatch --crate {name}"));
        let (header, upper) = (format!("{name}/{name}.h"), name.to_uppercase());
        let program = format!(
            "#include \"{header}\"\n#include <errno.h>\n#include <stdio.h>\n#include <stdlib.h>\n\
             {name}_unit unit;\nint main(void) {{ printf(\"%d\", {upper}_NOT_MADE); return 0; }}\n"
        );
        assert_eq!(compiled(folder.path(), &program).as_deref(), Some("5"), "{name}");
        let syntax = ["-std=c++17", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-x", "c++"];
        assert!(Command::new("c++").args(syntax).arg(folder.path().join(header)).status().unwrap().success(), "{name}");
    }
    for name in ["fn", "self", "std", "core", "slipfit-core", "con"] {
        let output = slipfit(folder.path(), &format!("kernel hatch --crate {name}"));
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.code() == Some(2) && errors.contains("--crate: a crate is not named"),
            "{name}: {errors}"
        );
        assert!(!folder.path().join(name).exists(), "{name}");
    }
}
