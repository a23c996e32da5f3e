//! The crates that `slipfit kernel --crate` writes, from C: on the PC and on the emulated Cortex-M4F one program prints the bits of
//! the same kernel in Rust. It links only while no panic is reachable.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use slipfit::{
    firmware::kernel_crate::{mechanism_crate, slide_crate},
    scene::{CD_ROM_SLIDE, Override, SceneFile, shipped},
    setup::Scene,
};
use slipfit_core::{drive::Commandable as _, pose::Pose};
use slipfit_problems::mechanisms;
use slipfit_tests::cross::{self, TARGET, cargo, printed};

#[rustfmt::skip]
#[path = "reference/scene.rs"]
#[allow(dead_code, reason = "one of its functions is enough here")]
mod slide;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Level of the units.
const LEVEL: f32 = 1.5;

/// A C program for the kernel NAME, whose drive has the functions NAME_DRIVE and NAME_COMMAND: a hash of the bits of all that the drive gives and sees.
const PROGRAM: &str = r#"#include "NAME.h"

#include <stddef.h>

void put(const char *text);

static NAME_unit unit, memory;

/* FNV-1a over the bits of a number. */
static uint64_t add(uint64_t hash, float number) {
    union {
        float number;
        uint32_t bits;
    } seen;
    seen.number = number;
    for (int i = 0; i < 32; i += 8) {
        hash = (hash ^ (seen.bits >> i & 255u)) * 0x100000001b3ull;
    }
    return hash;
}

int main(void) {
    uint64_t hash = 0xcbf29ce484222325ull;
    char text[18];
    NAME_unit *misaligned = (NAME_unit *)((char *)&memory + 4);
    if (NAME_init(NULL, 0.0f) != UPPER_NULL || NAME_step(NULL) != UPPER_NULL || NAME_time(NULL) == NAME_time(NULL)) {
        put("null not refused\n");
    }
    if (NAME_init(misaligned, LEVELf) != UPPER_MISALIGNED || NAME_step(misaligned) != UPPER_MISALIGNED ||
        NAME_time(misaligned) == NAME_time(misaligned)) {
        put("misaligned not refused\n");
    }
    if (NAME_step(&unit) != UPPER_NOT_MADE || NAME_time(&unit) == NAME_time(&unit) ||
        NAME_DRIVE(&unit).effort == NAME_DRIVE(&unit).effort) {
        put("not made not refused\n");
    }
    /* Levels that no production makes; and what fails leaves no unit, not the one before. */
    for (int i = 0; i < 4; i++) {
        const float levels[4] = {1e12f, -1000.0f, -50.0f, 50.0f};
        if (NAME_init(&unit, LEVELf) != UPPER_OK || NAME_step(&unit) != UPPER_OK ||
            NAME_init(&unit, levels[i]) != UPPER_OUT_OF_BOUNDS || NAME_step(&unit) != UPPER_NOT_MADE ||
            NAME_DRIVE(&unit).speed == NAME_DRIVE(&unit).speed) {
            put("out of bounds not refused\n");
        }
    }
    if (NAME_init(&unit, LEVELf) != UPPER_OK || NAME_time(&unit) != 0.0f) {
        put("no unit\n");
    }
    for (int i = 0; i < STEPS; i++) {
        if (NAME_step(&unit) != UPPER_OK) {
            put("held\n");
        }
        NAME_driven found = NAME_DRIVE(&unit);
        hash = add(add(hash, found.effort), found.speed);
    }
    /* From the start again with a command. Invalid ones are refused, and a copy restores the unit. */
    if (NAME_restart(&unit) != UPPER_OK || NAME_time(&unit) != 0.0f || NAME_COMMAND(&unit, 1e9f) != UPPER_OUT_OF_BOUNDS ||
        NAME_restart(NULL) != UPPER_NULL || NAME_COMMAND(misaligned, 0.0f) != UPPER_MISALIGNED ||
        NAME_restart(&memory) != UPPER_NOT_MADE || NAME_COMMAND(&memory, 0.0f) != UPPER_NOT_MADE) {
        put("no command\n");
    }
    for (int i = 0; i < STEPS; i++) {
        if (NAME_COMMAND(&unit, 0.001f * (float)(i % 64 - 16)) != UPPER_OK) {
            put("no command\n");
        }
        if (i == STEPS / 2) {
            NAME_unit copy = unit;
            if (NAME_step(&unit) != UPPER_OK || NAME_restart(&unit) != UPPER_OK) {
                put("held\n");
            }
            unit = copy;
        }
        if (NAME_step(&unit) != UPPER_OK) {
            put("held\n");
        }
        NAME_driven found = NAME_DRIVE(&unit);
        hash = add(add(hash, found.effort), found.speed);
    }
    for (int i = 0; i < 16; i++) {
        text[i] = "0123456789abcdef"[hash >> (60 - 4 * i) & 15u];
    }
    text[16] = '\n';
    text[17] = 0;
    put(text);
    return 0;
}
"#;

/// A kernel as C has it, and what the program of it is to print.
struct Kernel {
    /// The crate.
    name: &'static str,
    /// Function of the drive, without the crate's name.
    drive: &'static str,
    /// The function that sets its command.
    command: &'static str,
    steps: i32,
    expected: String,
}

/// The program's command before step `i`.
fn command(i: i32) -> f32 {
    0.001 * (i % 64 - 16) as f32
}

/// FNV-1a over the bits of numbers, as the program prints it.
fn hashed(numbers: impl Iterator<Item = [f32; 2]>) -> String {
    let bytes = numbers.flatten().flat_map(|number| number.to_bits().to_le_bytes());
    let hash = bytes
        .fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
    format!("{hash:016x}\n")
}

/// The scene of the committed module: the paper's slide with exact friction.
fn slide_of() -> Kernel {
    let mut kernel = slide::predictor(LEVEL).expect("the level is in bounds");
    let steps = 300;
    let mut seen = Vec::new();
    for is_commanded in [false, true] {
        let mut state = kernel.at_rest(Pose::nominal());
        for i in 0..steps {
            if is_commanded {
                kernel.mechanism_mut().drive_mut().set_command(command(i));
            }
            let _ = kernel.step(&mut state);
            let speed = state.motion.velocity.z;
            seen.push([kernel.mechanism().drive().force(kernel.time(state.steps), speed), speed]);
        }
    }
    Kernel { name: "cd-rom-slide", drive: "drive", command: "command", steps, expected: hashed(seen.into_iter()) }
}

macro_rules! of_mechanisms {
    ($($module:ident, $name:literal, $drive:ident, $command:ident, $steps:literal;)*) => {[$({
        let (mut kernel, _) = mechanisms::$module::predictor(LEVEL).expect("the level is in bounds");
        let mut seen = Vec::new();
        for is_commanded in [false, true] {
            let mut state = mechanisms::$module::at_start(&kernel);
            for i in 0..$steps {
                if is_commanded {
                    mechanisms::$module::$command(kernel.mechanism_mut(), command(i));
                }
                let _ = kernel.step(&mut state);
                let (time, motion) = (kernel.time(state.steps), &state.motion);
                let found = mechanisms::$module::$drive(kernel.mechanism(), time, &motion.pose, &motion.velocity);
                seen.push([found.effort, found.speed]);
            }
        }
        let (drive, command, expected) = (stringify!($drive), stringify!($command), hashed(seen.into_iter()));
        Kernel { name: $name, drive, command, steps: $steps, expected }
    }),*]};
}

/// Every shipped mechanism with a drive.
fn kernels() -> Vec<Kernel> {
    let mechanisms = of_mechanisms! {
        four_bar, "four-bar", drive_motor, command_motor, 300;
        ball_rod, "ball-rod", drive_motor, command_motor, 300;
        hatch, "int", drive_motor, command_motor, 300;
        linear_guide, "linear-guide", drive_motor, command_motor, 300;
        slider_crank, "slider-crank", drive_motor, command_motor, 300;
        slider_crank_guide, "slider-crank-guide", drive_motor, command_motor, 300;
        telescopic_drawer, "telescopic-drawer", drive_motor, command_motor, 300;
    };
    mechanisms.into_iter().chain([slide_of()]).collect()
}

/// The shipped scene of the crate `name`. One of the crates is called like a keyword of C.
fn scene_of(name: &str) -> &str {
    if name == "int" { "hatch" } else { name }
}

/// Writes a workspace of the crates of all `kernels`, and their programs, into a folder of the test's own.
fn workspace(kernels: &[Kernel]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("c-kernels");
    let write = |path: PathBuf, text: &str| {
        fs::create_dir_all(path.parent().expect("a folder")).expect("the test's folder takes folders");
        fs::write(path, text).expect("the test's folder takes files");
    };
    let core = Path::new(ROOT).join("core");
    for Kernel { name, drive, command, steps, .. } in kernels {
        let files = if *name == "cd-rom-slide" {
            let set = ["friction.law=exact"].map(Override::set);
            slide_crate(&Scene::parse(name, CD_ROM_SLIDE, &set).expect("a shipped scene"), name, Some(&core))
        } else {
            let scene = shipped(scene_of(name)).expect("a shipped scene");
            let scene = SceneFile::parse(name, scene, &[]).expect("a shipped scene");
            mechanism_crate(&scene.mechanism.expect("a mechanism"), name, Some(&core)).expect("it runs")
        };
        for (path, text) in files {
            write(folder.join(name).join(path), &text);
        }
        let prefix = name.replace('-', "_");
        let program = PROGRAM
            .replace("NAME_DRIVE", &format!("{prefix}_{drive}"))
            .replace("NAME_COMMAND", &format!("{prefix}_{command}"))
            .replace("NAME", &prefix)
            .replace("UPPER", &prefix.to_uppercase())
            .replace("LEVEL", &format!("{LEVEL:?}"))
            .replace("STEPS", &steps.to_string());
        write(folder.join(name).join("program.c"), &program);
    }
    for (path, text) in both_kernels([kernels[0].name, kernels[1].name]) {
        write(folder.join(BOTH).join(path), &text);
    }
    let members = kernels.iter().map(|kernel| kernel.name).chain([BOTH]);
    let members: Vec<_> = members.map(|name| format!("{name:?}")).collect();
    write(folder.join("Cargo.toml"), &format!("[workspace]\nmembers = [{}]\nresolver = \"3\"\n", members.join(", ")));
    fs::copy(Path::new(ROOT).join("Cargo.lock"), folder.join("Cargo.lock")).expect("the repository's own versions");
    folder
}

/// For the PC, by the default profile.
const HOST: &[&str] = &[];

/// For the target, as the header says, by link-time optimisation.
const ALONE: &[&str] = &["--target", TARGET, "--config", "profile.release.lto=true"];

/// For the target, by the default profile: even so no panic is reachable.
const PLAIN: &[&str] = &["--target", TARGET];

/// The library of a kernel in the workspace `folder`, built with these `options`.
fn library(folder: &Path, name: &str, options: &[&str]) -> PathBuf {
    let mut build = cargo(&folder.to_string_lossy());
    build.current_dir(folder).args(["rustc", "--offline", "--release", "-p", name, "--features", "c"]);
    printed(build.args(["--crate-type", "staticlib"]).args(options));
    let target = if options.contains(&TARGET) { TARGET } else { "" };
    folder.join("cross").join(target).join(format!("release/lib{}.a", name.replace('-', "_")))
}

#[test]
#[ignore = "builds what users build: `cargo verify --all`"]
fn kernels_of_all_scenes_have_the_same_bits_from_c_on_host_and_target_and_from_rust() {
    cross::require_target();
    cross::require_crates();
    cross::require_c_compiler();
    cross::require_emulator();
    let kernels = kernels();
    let folder = workspace(&kernels);
    let strict = ["-std=c11", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O2", "-ffp-contract=off"];
    for (i, Kernel { name, expected, .. }) in kernels.iter().enumerate() {
        let program = folder.join(name).join("program.c");
        let compiled = |compiler: &str, suffix: &str| {
            let mut command = Command::new(compiler);
            let image = folder.join(format!("{name}{suffix}"));
            command.current_dir(ROOT).args(strict).arg("-I").arg(folder.join(name)).arg(&program).arg("-o").arg(&image);
            (command, image)
        };
        let (mut compiler, image) = compiled("cc", "-host");
        printed(compiler.arg("core/capi/examples/desk.c").arg(library(&folder, name, HOST)));
        assert_eq!(printed(&mut Command::new(image)), *expected, "{name} on the PC");

        let (mut compiler, image) = compiled("arm-none-eabi-gcc", ".elf");
        // Link-time optimisation over the compiler's own library takes long: the first two have it, which are linked together, too.
        let options = if i < 2 { ALONE } else { PLAIN };
        compiler.args(M4).args(BARE).arg("core/capi/examples/m4.c").arg(library(&folder, name, options)).arg("-lgcc");
        printed(&mut compiler);
        let on_target = printed(Command::new(Path::new(ROOT).join(".cargo/qemu")).arg(image));
        assert_eq!(on_target, *expected, "{name} on the target");
    }
    let [one, other] = &kernels[..2] else { panic!("there are two") };
    let both = [one, other].map(|kernel| kernel.expected.as_str()).concat();
    let libraries = [one, other].map(|kernel| library(&folder, kernel.name, ALONE));
    assert_eq!(together(&folder, [one, other], strict, &libraries), both, "two libraries");
    let library = library(&folder, BOTH, PLAIN);
    assert_eq!(together(&folder, [one, other], strict, &[library]), both, "one library of both");
}

const M4: [&str; 5] = ["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", "-ffreestanding"];
const BARE: [&str; 4] = ["-nostdlib", "-Wl,--gc-sections", "-Tcore/capi/examples/m4.ld", "-L."];

/// What the programs of two kernels print, one after the other as one program on the target, linked with `libraries`.
fn together(folder: &Path, kernels: [&Kernel; 2], strict: [&str; 7], libraries: &[PathBuf]) -> String {
    let mut compiler = Command::new("arm-none-eabi-gcc");
    let image = folder.join("both.elf");
    compiler.current_dir(ROOT).args(strict).args(M4).args(BARE).arg("-o").arg(&image);
    for Kernel { name, .. } in kernels {
        let (object, entry) = (folder.join(format!("{name}.o")), name.replace('-', "_"));
        let mut own = Command::new("arm-none-eabi-gcc");
        own.current_dir(ROOT).args(strict).args(M4).arg("-I").arg(folder.join(name));
        printed(
            own.arg(format!("-Dmain={entry}_main"))
                .arg("-c")
                .arg(folder.join(name).join("program.c"))
                .arg("-o")
                .arg(&object),
        );
        compiler.arg(object);
    }
    let program = folder.join(BOTH).join("program.c");
    printed(compiler.arg(program).arg("core/capi/examples/m4.c").args(libraries).arg("-lgcc"));
    printed(Command::new(Path::new(ROOT).join(".cargo/qemu")).arg(image))
}

/// The crate that makes one library of two kernels.
const BOTH: &str = "both";

/// The files of that crate: what the guide tells to write.
fn both_kernels(kernels: [&str; 2]) -> [(&'static str, String); 3] {
    let [one, other] = kernels.map(|name| name.replace('-', "_"));
    let depends =
        kernels.map(|name| format!("{name} = {{ path = \"../{name}\", features = [\"c-functions\"] }}\n")).concat();
    let manifest = format!(
        "[package]\nname = \"{BOTH}\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[features]\nc = []\n\n[dependencies]\n{depends}"
    );
    let library = format!(
        "#![no_std]\n\nuse {{{one} as _, {other} as _}};\n\nunsafe extern \"C\" {{\n    safe fn a_panic_is_reachable() -> !;\n}}\n\n\
         #[panic_handler]\nfn panic(_: &core::panic::PanicInfo<'_>) -> ! {{\n    a_panic_is_reachable()\n}}\n"
    );
    let program = format!(
        "int {one}_main(void);\nint {other}_main(void);\n\nint main(void) {{\n    return {one}_main() + {other}_main();\n}}\n"
    );
    [("Cargo.toml", manifest), ("src/lib.rs", library), ("program.c", program)]
}
