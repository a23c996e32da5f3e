//! The C library: one C program, compiled for the host and for the emulated Cortex-M4F, prints the same bits as Rust; it
//! links only while no panic is reachable, and its image stays small and free of double precision.

#[path = "capi/abi.rs"]
mod abi;
#[path = "capi/panics.rs"]
mod panics;

use std::{
    fmt::Write,
    fs,
    path::{Path, PathBuf},
    process::Command,
    sync::{LazyLock, Mutex},
};

use slipfit::{
    firmware::{
        flash::export,
        force_table::{self, Demand},
        kernel_source,
    },
    scene::{CD_ROM_SLIDE, Override},
    setup::Scene,
};
use slipfit_core::{
    ahead::{self, Ahead, Prediction},
    drive::{Commandable as _, SetpointDrive},
    integrator::ImplicitEuler,
    kernel::{Kernel, Report},
    monitor::{JamWatch, LevelBank, Limits, Monitor, Sample, Verdict, Watch},
    pose::Pose,
    scene::SceneData,
    table::{Table, Word, layout},
};
use slipfit_problems::{
    arcs,
    cd_rom::{self, CdRomSlide},
};
use slipfit_tests::{
    cross::{self, TARGET, printed, whole_program},
    guide,
};

const FOLDER: &str = env!("CARGO_TARGET_TMPDIR");
const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// How C is compiled: as strictly as it goes, and never with fused multiply-add.
const STRICT: [&str; 8] =
    ["-std=c11", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O2", "-ffp-contract=off", "-Wno-unused-variable"];

static SCENE: LazyLock<Scene> = LazyLock::new(|| {
    let set = ["run.duration=1500"];
    let overrides: Vec<_> = set.iter().map(|set| Override::set(set)).collect();
    let levels = Override::option("", "sweep.n", "1:3.5:0.5");
    Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &[overrides, vec![levels]].concat()).expect("the shipped scene")
});

static TABLE: LazyLock<Vec<u8>> =
    LazyLock::new(|| force_table::make(&*SCENE, Demand::Full, || ()).expect("its table").0.bytes);

/// A folder with what the program includes.
static HEADERS: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = Path::new(FOLDER).join("capi");
    fs::create_dir_all(&folder).expect("a folder of the test's own");
    let table = export::render("table", "h", &TABLE, 0).expect("a header");
    fs::write(folder.join("table.h"), table).expect("the folder takes files");
    fs::write(folder.join("scene.h"), kernel_source::c_header(&SCENE, "scene").expect("an exponent of 1.5"))
        .expect("the folder takes files");
    folder
});

/// The library, built with these options of Cargo and kept as `name`: the builds share what they depend on, and each would
/// overwrite the one before.
fn library(name: &str, options: &[&str]) -> PathBuf {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _building = ONE_AT_A_TIME.lock();
    printed(
        whole_program(FOLDER)
            .args(["rustc", "--release", "-p", "slipfit-capi", "--crate-type=staticlib"])
            .args(options),
    );
    let target = if options.contains(&TARGET) { TARGET } else { "" };
    let built = Path::new(FOLDER).join("cross").join(target).join("release/libslipfit_capi.a");
    let kept = Path::new(FOLDER).join(format!("libslipfit_capi-{name}.a"));
    fs::copy(built, &kept).expect("the test's folder takes files");
    kept
}

/// A C compiler that finds every header.
fn compiler(name: &str) -> Command {
    let mut compiler = Command::new(name);
    compiler.current_dir(ROOT).args(STRICT).args(["-Icore/capi/include", "-I"]).arg(&*HEADERS);
    compiler
}

/// The compiler of an image of the C `program` for the target, up to its libraries.
fn compiler_for_target(program: &Path, image: &Path) -> Command {
    cross::require_c_compiler();
    let mut compiler = compiler("arm-none-eabi-gcc");
    compiler
        .args(["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", "-ffreestanding", "-nostdlib"])
        .args(["-Wl,--gc-sections", "-Tcore/capi/examples/m4.ld", "-L."])
        .arg(program)
        .args(["core/capi/examples/m4.c", "-o"])
        .arg(image);
    compiler
}

/// The example that both platforms run.
const EXAMPLE: &str = "core/capi/examples/program.c";

/// What `image` prints on the emulated target.
fn on_target(image: &Path) -> String {
    cross::require_emulator();
    printed(Command::new(Path::new(ROOT).join(".cargo/qemu")).arg(image))
}

/// The program's image for the target.
static IMAGE: LazyLock<PathBuf> = LazyLock::new(|| {
    cross::require_target();
    let image = Path::new(FOLDER).join("capi.elf");
    let library = library("target", &["--target", TARGET]);
    printed(compiler_for_target(Path::new(EXAMPLE), &image).arg(library).arg("-lgcc"));
    image
});

/// What the program prints on the host, linked with `library`.
fn on_host(name: &str, library: &Path) -> String {
    let program = Path::new(FOLDER).join(name);
    let mut compiler = compiler("cc");
    compiler.args([EXAMPLE, "core/capi/examples/desk.c", "-o"]).arg(&program);
    printed(compiler.arg(library));
    printed(&mut Command::new(&program))
}

#[test]
fn the_same_bits_from_c_on_host_and_target_and_from_rust() {
    let on_host = on_host("capi-program", &library("host", &[]));
    let expected = in_rust();
    assert!(on_host.starts_with(&expected), "C on the left, Rust on the right:\n{on_host}\n{expected}");

    assert_eq!(on_host, on_target(&IMAGE));

    let refusals: Vec<_> = on_host.strip_prefix(&expected).unwrap_or_default().lines().collect();
    let codes =
        ["null", "misaligned", "not made", "scene", "position", "closed then", "truncated", "foreign"].into_iter();
    let codes = codes.zip([1, 2, 4, 23, 24, 4, 16, 17]).map(|(name, code)| format!("{name} {code:016x}"));
    assert_eq!(refusals, codes.collect::<Vec<_>>());

    let first: String = on_host.split_inclusive('\n').take(5).collect();
    assert!(
        guide::page("firmware").contains(&format!("```text\n{first}```")),
        "the guide has other lines than\n{first}"
    );
}

/// Neither what the compiler optimises nor what the processor offers, fused multiply-add for one, changes a bit.
#[test]
fn the_same_bits_at_every_optimisation_and_for_every_processor() {
    let baseline = on_host("capi-program-baseline", &library("baseline", &[]));
    let level = |level: &str| {
        ["slipfit-capi", "slipfit-core"]
            .map(|package| format!("--config=profile.release.package.{package}.opt-level={level}"))
    };
    let (unoptimised, small) = (level("0"), level("\"s\""));
    for (name, options) in [
        ("unoptimised", &[&*unoptimised[0], &unoptimised[1]][..]),
        ("small", &[&small[0], &small[1]]),
        ("native", &["--", "-Ctarget-cpu=native"]),
    ] {
        assert_eq!(baseline, on_host(&format!("capi-program-{name}"), &library(name, options)), "{name}");
    }
}

/// FNV-1a over the bits of numbers.
fn hashed(numbers: impl IntoIterator<Item = f32>) -> u64 {
    hashed_bytes(numbers.into_iter().flat_map(|number| number.to_bits().to_le_bytes()))
}

fn hashed_bytes(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes
        .into_iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// The C program's command in a period.
fn command(period: u32) -> f32 {
    arcs(0.08, period, 800)
}

/// The C program's prediction ahead of the clock: a hash of all that it says, and in how many periods it is behind.
fn ahead_of_the_clock() -> (u64, u64) {
    let limits = ahead::Limits { period: 1e-3, tolerance: 7e-5, lead: 0.2, lag: 0.2, attempts: 1 };
    let scene = kernel_source::scene_data(&SCENE);
    let slower = SceneData { drive_speed: 0.05, ..scene };
    let unit = |scene: &SceneData<f32>, n| {
        let slide: CdRomSlide<f32> = cd_rom::from_data(&scene.at(n).expect("the deviations are in bounds"));
        let led = slide.driven_by(SetpointDrive::new(slide.drive().gain)).expect("the gain is in bounds");
        (Ahead::new(led, limits).expect("the limits are in bounds"), *slide.drive())
    };
    let (mut ahead, mut ramp) = unit(&scene, 2.5);
    let mut state: ahead::State<f32, _, 6, 256> = ahead.at_rest(Pose::nominal(), 70, |time| ramp.command(time));
    let horizon = ahead.horizon(&state);
    let (mut said, mut behind) = (Vec::new(), 0);
    for period in 0..70 + 3000 {
        if period == 70 + 750 {
            (ahead, ramp) = unit(&slower, 2.25);
            ahead.restart(&mut state);
            ahead.plan_all(&mut state, |time| ramp.command(time));
        }
        if period < 70 + 2250 {
            let by_ramp = ramp.command(ahead.time(&state, horizon + 1));
            ahead.plan(&mut state, horizon, if period < 70 + 1500 { by_ramp } else { command(period) });
        } else {
            ahead.follow(&mut state, command(period));
        }
        let Prediction { time, speed, position, force, deviation, lead, tolerance, excess, forced } =
            ahead.step(&mut state);
        behind += u64::from(lead < 0.0);
        said.extend([time, force, speed, lead, tolerance, excess, forced as f32, position, deviation]);
    }
    (hashed(said), behind)
}

/// What the C program prints of its predictions, computed by the kernel itself.
fn in_rust() -> String {
    let kernel = |n| {
        let unit = kernel_source::scene_data(&SCENE).at(n).expect("the deviations are in bounds");
        Kernel::<f32, _, ImplicitEuler<4>>::new(cd_rom::from_data(&unit), 1e-3).expect("the step is in bounds")
    };
    let run = |n: f32, steps: u32| {
        let kernel = kernel(n);
        let mut state = kernel.at_rest(Pose::nominal());
        (0..steps).map(move |_| {
            let Report { residual, .. } = kernel.step(&mut state);
            let (time, velocity) = (kernel.time(state.steps), state.motion.velocity.z);
            [time, kernel.mechanism().drive().force(time, velocity), velocity, residual]
        })
    };
    let mut text = String::new();
    let mut line = |name: &str, value: u64| {
        let _ = writeln!(text, "{name} {value:016x}");
    };
    line("predicted", hashed(run(2.5, 100_000).flatten()));
    line("failed", 0);
    let (ahead, behind) = ahead_of_the_clock();
    line("ahead", ahead);
    line("behind", behind);
    line("failed", 0);
    let mut kernel = kernel(2.5);
    let mut state = kernel.at_rest(Pose::nominal());
    let commanded = (0..20_000).flat_map(|period| {
        kernel.mechanism_mut().drive_mut().set_command(command(period));
        let _ = kernel.step(&mut state);
        let (time, velocity) = (kernel.time(state.steps), state.motion.velocity.z);
        let force = kernel.mechanism().drive().force(time, velocity);
        [time, force, velocity, state.motion.pose.displacement_w.z]
    });
    line("commanded", hashed(commanded));
    line("failed", 0);

    let table = Table::<2>::open(&TABLE).expect("its own table");
    let limits = Limits {
        period: 1e-3,
        blind: 0.2,
        force_most: 3.5,
        hold: 0.01,
        smoothing: 0.02,
        band: 0.5,
        margin: 0.01,
        rise: 0.5,
    };
    let monitor = Monitor::new(table, 2.25, limits).expect("the limits are in bounds");
    let mut bank = LevelBank::<_, 96>::new(table).expect("the table has few levels");
    let (mut watch, mut verdicts) = (Watch::default(), [0; 5]);
    let (weak, mut jam_watch, mut jams) = (Limits { force_most: 0.9, ..limits }, JamWatch::default(), 0);
    let (mut looked_up, mut watched) = (Vec::new(), Vec::new());
    for [time, force, speed, _] in run(2.25, 1500) {
        let found = table.lookup([2.25, time]);
        looked_up.extend([found.force, found.velocity, f32::from(u8::from(found.clamped) + 2 * u8::from(found.mixed))]);
        let command = speed + force / kernel_source::scene_data(&SCENE).drive_gain;
        let sample = Sample { time, force, speed, command };
        jams += u64::from(jam_watch.step(&weak, &sample) == Verdict::Jam);
        let report = monitor.step(&mut watch, &sample);
        verdicts[match report.verdict {
            Verdict::Blind => 0,
            Verdict::Free => 1,
            Verdict::Tight => 2,
            Verdict::Jam => 3,
            Verdict::NoData => 4,
            Verdict::Ended => unreachable!("that is a production's"),
        }] += 1;
        watched.extend([report.tightness.excess, report.tightness.band]);
        bank.add(time, force);
    }
    let rounds = 64 * 1500 / (TABLE.len() - layout::CHECKSUM_SIZE).next_multiple_of(64);
    let estimate = bank.estimate().expect("a stroke of samples");
    line("looked up", hashed(looked_up));
    line("watched", hashed(watched));
    for (name, count) in ["blind", "free", "tight", "jam", "no data"].into_iter().zip(verdicts) {
        line(name, count);
    }
    assert!(jams > 0, "the weak drive jams");
    line("jam of a weak drive", jams);
    line("rounds", rounds as u64);
    let [low, high] = estimate.interval;
    line("estimate", hashed([estimate.level, low, high]));
    line("failed", 0);
    line("record", hashed_bytes(Word::of(16).expect("a power of two").record(7).bytes().iter().copied()));
    text
}

/// Symbols of the image with their sizes (bytes), read-only and code.
fn symbols() -> Vec<(String, u32)> {
    let text = printed(Command::new("arm-none-eabi-nm").args(["--print-size", "--demangle"]).arg(&*IMAGE));
    let parsed = text.lines().filter_map(|line| {
        let mut words = line.splitn(4, ' ').skip(1);
        let (size, kind, name) = (words.next()?, words.next()?, words.next()?);
        let size = u32::from_str_radix(size, 16).ok()?;
        ["t", "T", "r", "R", "W"].contains(&kind).then(|| (name.to_owned(), size))
    });
    parsed.collect()
}

#[test]
fn the_linked_image_has_no_double_precision() {
    cross::assert_single_precision(&IMAGE);
}

/// Code and constants of the library after `--gc-sections`: everything but the program and its platform.
#[test]
fn the_library_takes_the_recorded_flash() {
    let program = [
        "slipfit_table_bytes",
        "slipfit_this_scene",
        "vectors",
        "main",
        "put",
        "reset",
        "run",
        "fault",
        "leave",
        "SVC_Handler",
        "PendSV_Handler",
        "SysTick_Handler",
        "put_hex",
        "add",
        "predict_ahead",
        "follow_command",
        "command",
    ];
    let library: Vec<_> = symbols().into_iter().filter(|(name, _)| !program.contains(&name.as_str())).collect();
    let whole: u32 = library.iter().map(|(_, size)| size).sum();
    let exported = library.iter().filter(|(name, _)| name.starts_with("slipfit_"));
    let mut lines: Vec<_> = exported.map(|(name, size)| format!("{size:6} {name}")).collect();
    lines.sort_unstable_by(|a, b| b.cmp(a));
    let of = |part: &str| -> u32 {
        library.iter().filter(|(name, _)| name.contains(part)).map(|(_, size)| size).sum::<u32>()
    };
    let (step, ahead) = (of("Predictor::advance"), of("slipfit_ahead") + of("capi::ahead::"));
    assert!(step > 0, "the step is a function of its own\n{library:#?}");
    assert!(whole - step - ahead <= 20 * 1024, "{whole} bytes\n{library:#?}");
    insta::assert_snapshot!("flash", format!("{whole:6} bytes in all\n{}\n", lines.join("\n")));
}

/// Objects are opaque words, which the header counts.
#[test]
fn the_guide_has_the_sizes_of_objects() {
    let header = fs::read_to_string(Path::new(ROOT).join("core/capi/include/slipfit.h")).expect("a file");
    let page = guide::page("firmware");
    let mut objects = 0;
    for text in header.split("typedef struct ").skip(1) {
        let Some((name, fields)) = text.split_once(" {\n  uint") else { continue };
        let Some((bits, count)) = fields.split_once("_t words[") else { continue };
        let number =
            |text: &str| text.split_once(']').map_or(text, |(number, _)| number).parse::<u32>().expect("a number");
        let bytes = number(bits) / 8 * number(count);
        let shown = if bytes < 1000 { bytes.to_string() } else { format!("{},{:03}", bytes / 1000, bytes % 1000) };
        let row = page.lines().find(|line| line.starts_with("| `") && line.contains(&format!("`{name}`")));
        let row = row.unwrap_or_else(|| panic!("{name}, {shown} bytes"));
        let sizes = row.split('|').nth(2).expect("a second cell").trim();
        assert!(sizes.split(", ").any(|size| size == shown), "{row}: {shown}");
        objects += 1;
    }
    assert!(objects >= 5, "{objects}");
}
