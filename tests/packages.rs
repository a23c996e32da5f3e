//! What C and C++ projects take the library by: CMake, pkg-config, headers that are C++17, too; and Cargo's packages. The guide's
//! examples in C and Rust compile.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use slipfit::{
    firmware::{
        flash::export,
        force_table::{self, Demand},
        kernel_crate::mechanism_crate,
        kernel_source,
    },
    mechanism::rust_source,
    scene::{CD_ROM_SLIDE, Override, SceneFile, shipped},
    setup::Scene,
};
use slipfit_tests::{
    cross::{cargo, printed, require_crates},
    guide,
};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Prints every status of the library, and whether it is the header's.
const PROGRAM: &str = r#"#include <stdio.h>

#include "slipfit.h"

int main(void) {
    printf("%d\n", slipfit_version() == SLIPFIT_VERSION);
    for (slipfit_status status = 0; status < 64; status++) {
        const char *name = slipfit_status_name(status);
        if (name[0] == 'S') {
            printf("%s %d\n", name, (int)status);
        }
    }
    return 0;
}
"#;

/// A folder of the test's own, emptied.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the test's folder takes folders");
    folder
}

fn write(path: PathBuf, text: &str) {
    fs::write(path, text).expect("the test's folder takes files");
}

/// Every status that the header names, as the program prints it.
fn statuses() -> String {
    let header =
        fs::read_to_string(Path::new(ROOT).join("core/capi/include/slipfit.h")).expect("a file of the repository");
    let constants = header.lines().filter_map(|line| line.strip_prefix("#define SLIPFIT_")?.split_once(' '));
    let source = fs::read_to_string(Path::new(ROOT).join("core/capi/src/status.rs")).expect("a file of the repository");
    let is_status = |name: &str| source.contains(&format!("pub const SLIPFIT_{name}: slipfit_status"));
    let mut found: Vec<(u32, &str)> = constants
        .filter(|(name, _)| is_status(name))
        .map(|(name, value)| (value.parse().expect("a number"), name))
        .collect();
    found.sort_unstable();
    assert!(found.len() > 20, "{found:?}");
    found.into_iter().map(|(value, name)| format!("SLIPFIT_{name} {value}\n")).collect()
}

#[test]
#[ignore = "builds what users build: `cargo verify --all`"]
fn c_projects_find_the_library_by_cmake_and_by_pkg_config() {
    let folder = folder("packages");
    let prefix = folder.join("prefix");
    let run = |program: &str, arguments: &[&str]| {
        printed(Command::new(program).current_dir(&folder).env_remove("CARGO_TARGET_DIR").args(arguments))
    };
    let source = format!("{ROOT}/core/capi");
    run("cmake", &["-S", &source, "-B", "library", "-DCMAKE_INSTALL_LIBDIR=lib"]);
    run("cmake", &["--build", "library"]);
    run("cmake", &["--install", "library", "--prefix", &prefix.display().to_string()]);

    write(folder.join("program.c"), PROGRAM);
    write(
        folder.join("CMakeLists.txt"),
        "cmake_minimum_required(VERSION 3.20)\nproject(program LANGUAGES C)\nfind_package(slipfit 0.2 REQUIRED)\n\
         add_executable(program program.c)\ntarget_link_libraries(program PRIVATE slipfit::slipfit)\n",
    );
    run("cmake", &["-S", ".", "-B", "by-cmake", &format!("-DCMAKE_PREFIX_PATH={}", prefix.display())]);
    run("cmake", &["--build", "by-cmake"]);
    let expected = format!("1\n{}", statuses());
    assert_eq!(printed(&mut Command::new(folder.join("by-cmake/program"))), expected);

    let packages = prefix.join("lib/pkgconfig");
    let flags =
        printed(Command::new("pkg-config").env("PKG_CONFIG_PATH", packages).args(["--cflags", "--libs", "slipfit"]));
    let flags: Vec<_> = flags.split_whitespace().collect();
    run("cc", &[&["program.c", "-o", "by-pkg-config"], &flags[..]].concat());
    assert_eq!(printed(&mut Command::new(folder.join("by-pkg-config"))), expected);
}

/// The examples in C of the guide's page on firmware, each in a function of its own.
fn examples() -> String {
    let examples: String =
        blocks("c").iter().enumerate().map(|(i, block)| format!("void example_{i}(void) {{\n{block}}}\n")).collect();
    assert!(examples.contains("slipfit_jam_watch_step") && examples.contains("crank_step"), "{examples}");
    examples
}

/// Code of the firmware engineer's page in this `language`.
fn blocks(language: &str) -> Vec<String> {
    let page = guide::page("firmware");
    let fence = format!("```{language}\n");
    let rest = page.split(&fence).skip(1);
    rest.map(|rest| rest.split("```").next().unwrap_or_default().to_owned()).collect()
}

#[test]
fn every_header_and_the_examples_of_the_guide_are_c_11_and_c_plus_plus_17() {
    let folder = folder("c-plus-plus");
    let scene =
        Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &[Override::set("run.duration=60")]).expect("it is shipped");
    write(folder.join("scene.h"), &kernel_source::c_header(&scene, "scene").expect("an exponent of 1.5"));
    let table = force_table::make(&scene, Demand::Full, || ()).expect("its table").0.bytes;
    write(
        folder.join("table.h"),
        &export::render("table", "h", &table, 0)
            .map(|text| String::from_utf8_lossy(&text).into_owned())
            .expect("a header"),
    );
    let crank =
        SceneFile::parse("slider-crank", shipped("slider-crank").expect("it is shipped"), &[]).expect("it is sound");
    for (path, text) in mechanism_crate(&crank.mechanism.expect("a mechanism"), "crank", None).expect("it runs") {
        if path.extension().is_some_and(|extension| extension == "h") {
            write(folder.join(path), &text);
        }
    }
    let program = "#include \"slipfit.h\"\n#include \"scene.h\"\n#include \"table.h\"\n#include \"crank.h\"\n\
                   extern float time, force, speed, command;\nextern slipfit_table table;\n\
                   int main(void) {\n    return slipfit_this_scene.mass > 0 && SLIPFIT_TABLE_SIZE > 0 && sizeof(crank_unit) > 0 ? 0 : 1;\n}\n";
    write(folder.join("program"), &format!("{program}{}", examples()));
    let strict = ["-pedantic", "-Wall", "-Wextra", "-Werror", "-Wno-unused", "-fsyntax-only", "program"];
    for (compiler, language) in [("cc", ["-xc", "-std=c11"]), ("c++", ["-xc++", "-std=c++17"])] {
        let mut compiler = Command::new(compiler);
        printed(compiler.current_dir(&folder).arg(format!("-I{ROOT}/core/capi/include")).args(language).args(strict));
    }
}

/// What the examples in Rust of the guide's page on firmware find around them.
const GIVEN: &str = "
use std::error::Error;

use embedded_storage::nor_flash::NorFlash;
use slipfit_core::table::Table;

mod crank;
mod scene;

pub struct Given<F> {
    bytes: &'static [u8],
    table: Table<'static, 2>,
    slots: [&'static [u8]; 2],
    spare: usize,
    number: u32,
    flash: F,
    pieces: Vec<Vec<u8>>,
    measured: [f32; 4],
}
";

/// The example number `i` as a function of its own.
fn in_function((i, block): (usize, &String)) -> String {
    format!(
        "\npub fn example_{i}<F: NorFlash>(given: Given<F>) -> Result<(), Box<dyn Error>>\nwhere\n    F::Error: 'static,\n{{\n\
         let Given {{ bytes, table, slots: [first, second], spare, number, mut flash, pieces, measured }} = given;\n\
         let pieces = pieces.iter().map(Vec::as_slice);\nlet [time, force, speed, command] = measured;\n{block}Ok(())\n}}\n"
    )
}

#[test]
#[ignore = "builds what users build: `cargo verify --all`"]
fn the_examples_of_the_guide_are_rust() {
    require_crates();
    let folder = folder("guide-rust");
    fs::create_dir(folder.join("src")).expect("the test's folder takes folders");
    let manifest = format!(
        "[package]\nname = \"examples\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n\
         embedded-storage = \"0.3\"\nslipfit-core = {{ path = \"{ROOT}/core\", features = [\"embedded-storage\"] }}\n"
    );
    write(folder.join("Cargo.toml"), &manifest);
    fs::copy(Path::new(ROOT).join("Cargo.lock"), folder.join("Cargo.lock")).expect("the repository's versions");
    let slide = Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &[]).expect("it is shipped");
    write(folder.join("src/scene.rs"), &kernel_source::rust_source(&slide));
    let crank =
        SceneFile::parse("slider-crank", shipped("slider-crank").expect("it is shipped"), &[]).expect("it is sound");
    let crank = rust_source(&crank.mechanism.expect("a mechanism")).expect("it runs");
    write(folder.join("src/crank.rs"), &crank);
    // A whole library has no function around it.
    let blocks: Vec<_> = blocks("rust").into_iter().filter(|block| !block.starts_with("#![no_std]")).collect();
    let examples: String = blocks.iter().enumerate().map(in_function).collect();
    assert!(examples.contains("JamWatch::default") && examples.contains("crank::predictor"), "{examples}");
    write(folder.join("src/lib.rs"), &format!("#![allow(dead_code, unused)]\n{GIVEN}{examples}"));
    printed(cargo(&folder.to_string_lossy()).current_dir(&folder).args(["check", "--quiet", "--offline"]));
}

/// Cargo unpacks and builds a package of a version once: what an earlier run left would be taken for that of now.
fn forget_unpacked(package: &str) {
    let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(std::env::home_dir()?.join(".cargo"))).expect("a home of Cargo's");
    for registry in fs::read_dir(home.join("registry/src")).into_iter().flatten().flatten() {
        let _ = fs::remove_dir_all(registry.path().join(package));
    }
}

/// As they would be published: each builds from its own files alone.
#[test]
#[ignore = "builds what users build: `cargo verify --all`"]
fn cargo_packages_core_and_the_c_library() {
    let folder = folder("cargo-packages");
    let version = env!("CARGO_PKG_VERSION");
    forget_unpacked(&format!("slipfit-core-{version}"));
    let mut package = cargo(folder.to_str().expect("a folder's name"));
    package.args(["package", "--offline", "--allow-dirty", "--quiet", "-p", "slipfit-core", "-p", "slipfit-capi"]);
    printed(&mut package);
    for name in ["slipfit-core", "slipfit-capi"] {
        let archive = folder.join(format!("cross/package/{name}-{version}.crate"));
        let files = printed(Command::new("tar").arg("tzf").arg(archive));
        for file in ["README.md", "Cargo.toml", "src/lib.rs", "LICENSE-MIT", "LICENSE-APACHE"] {
            assert!(files.contains(&format!("{name}-{version}/{file}\n")), "{file} is missing in {files}");
        }
    }
}
