//! The library and panics: none is reachable, and its archive has no handler that would meet the one of another.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use slipfit_tests::cross::{TARGET, cargo, finished, printed, require_crates, require_target};

use super::{EXAMPLE, FOLDER, IMAGE, ROOT, compiler_for_target, library, on_target};

#[test]
fn a_program_links_only_without_panics() {
    // It links as it is: that is what IMAGE does.
    assert!(IMAGE.exists());
    // So does one with every function of the library: none can panic.
    let link = |name: &str, whole: &str, library: PathBuf| {
        let mut compiler = compiler_for_target(Path::new(EXAMPLE), &Path::new(FOLDER).join(name));
        finished(compiler.arg(whole).arg(library).arg("-lgcc"))
    };
    let output = link("whole.elf", "-Wl,--no-gc-sections", library("whole", &["--target", TARGET]));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    // The other way round: with one panic in reach it does not, and for this reason.
    let library = library("panic", &["--target", TARGET, "--features", "reachable-panic"]);
    let output = link("panics.elf", "-Wl,--undefined=slipfit_panic", library);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && errors.contains("slipfit_panic_is_reachable"), "{errors}");
}

/// Another library of Rust: a function that panics for 0, and a handler that says so and ends the emulation.
const OTHER: &str = r#"#![no_std]

unsafe extern "C" {
    fn put(text: *const core::ffi::c_char);
    fn leave(code: u32) -> !;
}

#[unsafe(no_mangle)]
pub extern "C" fn other_divide(a: u32, b: u32) -> u32 {
    a / b
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe {
        put(c"panicked\n".as_ptr());
        leave(0)
    }
}
"#;

/// A program that calls both: a drive at rest is no jam.
const PROGRAM: &str = r#"#include "slipfit.h"

void put(const char *text);
uint32_t other_divide(uint32_t a, uint32_t b);

static slipfit_jam_watch watch;

int main(void) {
    const slipfit_sample rest = {0.0f, 0.0f, 0.0f, 0.0f};
    slipfit_limits limits;
    uint32_t verdict = 9;
    if (slipfit_limits_for_noise(1e-3f, 0.0f, &limits) == SLIPFIT_OK && slipfit_jam_watch_init(&watch, &limits) == SLIPFIT_OK &&
        slipfit_jam_watch_step(&watch, &rest, &verdict) == SLIPFIT_OK) {
        put("watched\n");
    }
    return (int)other_divide(1, verdict == SLIPFIT_JAM);
}
"#;

/// A file of the test's own.
fn file(path: &str, text: &str) -> PathBuf {
    let path = Path::new(FOLDER).join("panics").join(path);
    fs::create_dir_all(path.parent().expect("a folder")).expect("the test's folder takes folders");
    fs::write(&path, text).expect("the test's folder takes files");
    path
}

/// What the program of both prints, linked with `libraries` in this order.
fn printed_with(name: &str, libraries: &[&Path]) -> String {
    let program = file(&format!("{name}.c"), PROGRAM);
    let image = program.with_extension("elf");
    printed(compiler_for_target(&program, &image).args(libraries).arg("-lgcc"));
    on_target(&image)
}

#[test]
fn the_archive_links_beside_another_with_a_panic_handler() {
    require_target();
    let source = file("other.rs", OTHER);
    let other = source.with_file_name("libother.a");
    let mut compiler = Command::new("rustc");
    compiler.current_dir(ROOT).args([
        "--edition=2024",
        "--crate-type=staticlib",
        "-O",
        "-Cpanic=abort",
        "--target",
        TARGET,
    ]);
    printed(compiler.arg("-o").arg(&other).arg(source));
    let library = library("beside", &["--target", TARGET]);
    for (name, libraries) in [("first", [&*library, &*other]), ("second", [&*other, &*library])] {
        assert_eq!(printed_with(name, &libraries), "watched\npanicked\n", "{name}");
    }
}

/// Without its own handler the library is a part of another one.
#[test]
fn a_library_of_rust_takes_it_in() {
    require_target();
    require_crates();
    let dependency = format!("slipfit-capi = {{ path = \"{ROOT}/core/capi\", default-features = false }}");
    let manifest = format!(
        "[package]\nname = \"around\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[workspace]\n\n\
         [lib]\ncrate-type = [\"staticlib\"]\n\n[dependencies]\n{dependency}\n"
    );
    let manifest = file("around/Cargo.toml", &manifest);
    file("around/src/lib.rs", &OTHER.replacen("\n\n", "\n\nuse slipfit_capi as _;\n\n", 1));
    fs::copy(Path::new(ROOT).join("Cargo.lock"), manifest.with_file_name("Cargo.lock"))
        .expect("the repository's versions");
    let folder = manifest.with_file_name("target");
    let mut build = cargo(&folder.to_string_lossy());
    printed(build.args(["build", "--offline", "--release", "--target", TARGET, "--manifest-path"]).arg(&manifest));
    let library = folder.join("cross").join(TARGET).join("release/libaround.a");
    assert_eq!(printed_with("around", &[&library]), "watched\npanicked\n");
}
