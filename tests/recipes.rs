//! The recipes of the guide: each is built as it says there and run on the emulated Cortex-M4F, and its forces are those of
//! the same kernel on the PC, bit for bit.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use serde_json::Value;
use slipfit::{
    firmware::kernel_source::{c_header, rust_source},
    scene::CD_ROM_SLIDE,
    setup::Scene,
};
use slipfit_core::pose::Pose;
use slipfit_tests::{
    cross::{self, TARGET, cargo, printed},
    guide,
};

#[rustfmt::skip]
#[path = "../core/examples/scene.rs"]
#[allow(dead_code, reason = "one of its functions is enough here")]
mod scene;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
const FOLDER: &str = env!("CARGO_TARGET_TMPDIR");

fn described() -> Scene {
    Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &[]).expect("the shipped scene")
}

/// What a recipe prints: 200 forces of the unit of level 2.5, hashed by FNV-1a.
fn expected() -> String {
    let kernel = scene::predictor(2.5).expect("the level is in bounds");
    let mut state = kernel.at_rest(Pose::nominal());
    let hash = (0..200).fold(0xcbf2_9ce4_8422_2325, |hash: u64, _| {
        let _ = kernel.step(&mut state);
        let force = kernel.mechanism().drive().force(kernel.time(state.steps), state.motion.velocity.z);
        let add = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        force.to_bits().to_le_bytes().into_iter().fold(hash, add)
    });
    format!("forces {hash:016x}\n")
}

/// What `image` prints on the emulated board. It takes a second; one that hangs is ended.
fn emulated(image: &Path) -> String {
    printed(Command::new("timeout").arg("60").arg(Path::new(ROOT).join(".cargo/qemu")).arg(image))
}

#[test]
fn the_committed_scene_is_current() {
    let path = Path::new(ROOT).join("core/examples/scene.rs");
    let found = rust_source(&described());
    if std::env::var_os("SLIPFIT_WRITE_SCENE").is_some() {
        fs::write(&path, &found).expect("the repository takes files");
    }
    let committed = fs::read_to_string(&path).expect("a file of the repository");
    assert!(committed == found, "to write it: SLIPFIT_WRITE_SCENE=1 cargo test --test recipes");
}

#[test]
fn the_guide_has_the_hash() {
    let shown = format!("```text\n{}```", expected());
    assert!(guide::page("firmware").contains(&shown), "{shown}");
}

#[test]
#[ignore = "builds what users build: `cargo verify --all`"]
fn recipes_in_rust_have_the_forces_of_the_pc() {
    cross::require_target();
    cross::require_emulator();
    let folder = format!("{FOLDER}/recipes");
    let in_examples = |arguments: &[&str]| {
        let folder_of_recipes = Path::new(ROOT).join("core/examples");
        printed(cargo(&folder).current_dir(folder_of_recipes).args(arguments).args(["--locked", "--target", TARGET]))
    };
    in_examples(&["fetch", "--quiet"]);
    in_examples(&["build", "--offline", "--release"]);
    for name in ["recipe-systick", "recipe-rtic", "recipe-embassy"] {
        assert_eq!(emulated(&cross::image(&folder, name)), expected(), "{name}");
    }
}

/// The folder of the FreeRTOS kernel, which the crate freertos-next carries.
fn freertos() -> PathBuf {
    let arguments = ["metadata", "--locked", "--offline", "--format-version", "1", "--filter-platform", TARGET];
    let said: Value = serde_json::from_str(&printed(cargo(FOLDER).args(arguments))).expect("JSON");
    let mut packages = said["packages"].as_array().expect("packages").iter();
    let package = packages.find(|package| package["name"] == "freertos-next").expect("it is a dependency");
    let manifest = Path::new(package["manifest_path"].as_str().expect("a path"));
    manifest.with_file_name("FreeRTOS-Kernel")
}

/// CMake, whose Cargo has the repository's flags.
fn cmake(arguments: &[&str]) -> String {
    let mut cmake = Command::new("cmake");
    for flags in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "CARGO_BUILD_TARGET", "CFLAGS", "LDFLAGS"] {
        cmake.env_remove(flags);
    }
    printed(cmake.current_dir(ROOT).args(arguments))
}

#[test]
#[ignore = "builds what users build: `cargo verify --all`"]
fn freertos_has_the_forces_of_the_pc() {
    cross::require_target();
    cross::require_crates();
    cross::require_c_library();
    cross::require_emulator();
    let folder = Path::new(FOLDER).join("freertos");
    fs::create_dir_all(&folder).expect("the test's folder takes folders");
    fs::write(folder.join("scene.h"), c_header(&described(), "scene").expect("an exponent of 1.5"))
        .expect("it takes files");
    let build = folder.join("build").display().to_string();
    let kernel = format!("-DFREERTOS_KERNEL={}", freertos().display());
    let scene = format!("-DSCENE={}", folder.display());
    cmake(&["-S", "core/capi/examples/freertos", "-B", &build, &kernel, &scene]);
    cmake(&["--build", &build]);
    assert_eq!(emulated(&folder.join("build/recipe-freertos")), expected());
}

/// A project as Zephyr has it when it comes to its modules: the configuration is known, and there is a library `app`.
const AS_ZEPHYR: &str = "cmake_minimum_required(VERSION 3.21)
project(app LANGUAGES C)
add_library(app app.c)
set(CONFIG_SLIPFIT y)
set(CONFIG_SLIPFIT_TARGET thumbv7em-none-eabihf)
add_subdirectory(${MODULE}/zephyr module)
target_link_libraries(app PRIVATE slipfit::slipfit)
get_target_property(location slipfit::slipfit IMPORTED_LOCATION)
message(STATUS \"links ${location}\")
";

/// Zephyr itself is in no package, so that these are only what its documentation asks of a module.
#[test]
#[ignore = "builds what users build: `cargo verify --all`"]
fn zephyrs_module_gives_the_library_for_the_chip() {
    let module = Path::new(ROOT).join("core/capi");
    let described = fs::read_to_string(module.join("zephyr/module.yml")).expect("a file of the repository");
    assert!(described.ends_with("name: slipfit\nbuild:\n  cmake: zephyr\n  kconfig: zephyr/Kconfig\n"), "{described}");

    let folder = Path::new(FOLDER).join("zephyr");
    fs::create_dir_all(&folder).expect("the test's folder takes folders");
    fs::write(folder.join("CMakeLists.txt"), AS_ZEPHYR).expect("it takes files");
    fs::write(folder.join("app.c"), "#include \"slipfit.h\"\n").expect("it takes files");
    let (source, build) = (folder.display().to_string(), folder.join("build").display().to_string());
    let said = cmake(&["-S", &source, "-B", &build, &format!("-DMODULE={}", module.display())]);
    let library = "module/library/cargo/thumbv7em-none-eabihf/release/libslipfit_capi.a";
    assert!(said.contains(&format!("links {build}/{library}\n")), "{said}");

    // Which target each processor has.
    let program = "import kconfiglib, sys\nkconfig = kconfiglib.Kconfig(sys.argv[1])\n\
                   kconfig.syms['SLIPFIT'].set_value('y')\nprint(kconfig.syms['SLIPFIT_TARGET'].str_value)\n";
    for (processor, target) in [
        ("CPU_CORTEX_M0PLUS", "thumbv6m-none-eabi"),
        ("CPU_CORTEX_M4", "thumbv7em-none-eabi"),
        ("CPU_CORTEX_M4 FP_HARDABI", "thumbv7em-none-eabihf"),
        ("CPU_CORTEX_M33 FP_HARDABI", "thumbv8m.main-none-eabihf"),
        ("", ""),
    ] {
        let mut text = format!("source \"{}\"\n", module.join("zephyr/Kconfig").display());
        text.extend(processor.split_whitespace().map(|name| format!("config {name}\n\tbool\n\tdefault y\n")));
        fs::write(folder.join("Kconfig"), text).expect("it takes files");
        let found = printed(Command::new("python3").args(["-c", program]).arg(folder.join("Kconfig")));
        assert_eq!(found, format!("{target}\n"), "{processor}");
    }
}
