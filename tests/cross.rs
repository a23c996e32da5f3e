//! Cargo for the emulated target, from inside a test.

use std::{
    env,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

/// The target that is emulated: a Cortex-M4F.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// A Cargo whose target folder is in `folder`, the test's `CARGO_TARGET_TMPDIR`, so that it never waits for the Cargo
/// that runs the test. Its compiler flags are the repository's, and nothing is compiled incrementally, whatever the
/// environment says: counts of instructions depend on both.
pub fn cargo(folder: &str) -> Command {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env("CARGO_TARGET_DIR", Path::new(folder).join("cross"))
        .env("CARGO_INCREMENTAL", "0")
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .env_remove("CARGO_BUILD_TARGET")
        .env_remove("DEFMT_LOG")
        .stdin(Stdio::null());
    cargo
}

/// The same, whose releases are optimised as a whole program, as firmware is.
pub fn whole_program(folder: &str) -> Command {
    let mut cargo = cargo(folder);
    cargo.env("CARGO_PROFILE_RELEASE_LTO", "fat");
    cargo
}

/// Runs `command` to its end.
///
/// # Panics
/// If it does not start.
pub fn finished(command: &mut Command) -> Output {
    command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"))
}

/// What `command` printed.
///
/// # Panics
/// If it fails, with all that it printed.
pub fn printed(command: &mut Command) -> String {
    let Output { status, stdout, stderr } = finished(command);
    let stdout = String::from_utf8_lossy(&stdout).into_owned();
    assert!(status.success(), "{command:?}: {status}\n{stdout}\n{}", String::from_utf8_lossy(&stderr));
    stdout
}

/// Fails, saying what to install, where images for the target cannot be built.
///
/// # Panics
/// As said.
pub fn require_target() {
    require_core_of(TARGET);
}

/// Fails, saying what to install, where images for `target` cannot be built.
///
/// # Panics
/// As said.
pub fn require_core_of(target: &str) {
    let folder = printed(Command::new("rustc").args(["--print", "target-libdir", "--target", target]));
    let installed = Path::new(folder.trim()).is_dir();
    assert!(installed, "the target {target} is not installed; to install it: rustup target add {target}");
}

/// Has the crates downloaded that images for the target are made of. A workspace of a test's own cannot do that: it is built
/// offline, so that it takes the versions of the repository's `Cargo.lock` and no newer ones.
///
/// # Panics
/// If they are neither there nor to be had.
pub fn require_crates() {
    printed(cargo("").args(["fetch", "--locked", "--quiet", "--target", TARGET]));
}

/// Fails, saying what to install, where C programs for the target cannot be built.
///
/// # Panics
/// As said.
pub fn require_c_compiler() {
    let found = Command::new("arm-none-eabi-gcc").arg("--version").output().is_ok();
    assert!(found, "arm-none-eabi-gcc is not installed; to install it: apt-get install gcc-arm-none-eabi");
}

/// Fails, saying what to install, where C programs for the target find no headers of a C library.
///
/// # Panics
/// As said.
pub fn require_c_library() {
    require_c_compiler();
    let mut compiler = Command::new("arm-none-eabi-gcc");
    let found = finished(compiler.args(["-E", "-include", "stdlib.h", "-x", "c", "/dev/null"])).status.success();
    assert!(found, "stdlib.h is not installed for it; to install it: apt-get install libnewlib-arm-none-eabi");
}

/// Fails, saying what to install, where images cannot be run.
///
/// # Panics
/// As said.
pub fn require_emulator() {
    require_emulator_of("arm", "qemu-system-arm");
}

/// Fails, saying which `package` to install, where images for the `architecture` cannot be run.
///
/// # Panics
/// As said.
pub fn require_emulator_of(architecture: &str, package: &str) {
    let emulator = format!("qemu-system-{architecture}");
    let found = Command::new(&emulator).arg("--version").output().is_ok();
    assert!(found, "{emulator} is not installed; to install it: apt-get install {package}");
}

/// The image of Rust of that `name` with its release settings, built.
///
/// # Panics
/// If it cannot be built.
pub fn built(folder: &str, name: &str) -> PathBuf {
    require_target();
    let mut build = whole_program(folder);
    build.args(["build", "--quiet", "--release", "-p", "slipfit-firmware", "--bin", name, "--target", TARGET]);
    printed(&mut build);
    image(folder, name)
}

/// The image that steps the slide on one core after another, built for a `target` and its `cpu`, as in `-C target-cpu`, if that
/// is not the target's own. Each `cpu` has its part of `folder`: tests that run beside each other must not overwrite what the other runs.
///
/// # Panics
/// If it cannot be built.
pub fn image_for(folder: &str, target: &str, cpu: Option<&str>) -> PathBuf {
    require_core_of(target);
    let folder = &format!("{folder}/{}", cpu.unwrap_or("default"));
    let mut build = cargo(folder);
    // In place of the repository's flags, also where there are none.
    build.env("CARGO_ENCODED_RUSTFLAGS", cpu.map(|cpu| format!("-Ctarget-cpu={cpu}")).unwrap_or_default());
    build.args(["build", "--quiet", "--locked", "--release", "--target", target]);
    printed(build.args(["--manifest-path", "tests/cores/Cargo.toml"]));
    Path::new(folder).join("cross").join(target).join("release/slipfit-cores")
}

/// An image of Rust, built and run before.
pub fn image(folder: &str, name: &str) -> PathBuf {
    Path::new(folder).join("cross").join(TARGET).join("release").join(name)
}

/// The machine code of every function in `image` whose name ends in `name`, a line an instruction.
///
/// # Panics
/// If there is none.
pub fn code(image: &Path, name: &str) -> Vec<String> {
    require_c_compiler();
    let mut objdump = Command::new("arm-none-eabi-objdump");
    let all = printed(objdump.args(["-d", "--no-show-raw-insn", "--demangle"]).arg(image));
    let title = format!("::{name}>:");
    let bodies = all.split("\n\n").filter(|body| body.lines().any(|line| line.ends_with(&title)));
    let instructions =
        |body: &str| body.lines().filter(|line| line.contains(":\t")).flat_map(|line| [line, "\n"]).collect();
    let found: Vec<_> = bodies.map(instructions).collect();
    assert!(!found.is_empty(), "no function of its own: {name}");
    found
}

/// Asserts that nothing in `image` computes in double precision, which would be a hundred times as slow.
///
/// # Panics
/// If something does, or nothing computes in single precision.
pub fn assert_single_precision(image: &Path) {
    require_c_compiler();
    let symbols = printed(Command::new("arm-none-eabi-nm").arg("--demangle").arg(image));
    let of_double =
        ["__aeabi_d", "__aeabi_cd", "__aeabi_f2d", "__aeabi_i2d", "__aeabi_ui2d", "__aeabi_l2d", "__aeabi_ul2d"];
    for soft in of_double.into_iter().chain(["adddf3", "subdf3", "muldf3", "divdf3"]) {
        assert!(!symbols.contains(soft), "{soft} in {}", image.display());
    }
    let code = printed(Command::new("arm-none-eabi-objdump").args(["-d", "--no-show-raw-insn"]).arg(image));
    assert!(!code.contains(".f64"), "an instruction of double precision in {}", image.display());
    assert!(code.contains(".f32"), "single precision is what there is in {}", image.display());
}
