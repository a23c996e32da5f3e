//! An image built for size, with the kernel as the crate that `slipfit kernel --crate` writes: one line of the profile keeps
//! the step as fast as in an image built for speed.

use std::{fmt::Write, fs, path::Path};

use slipfit::{firmware::kernel_crate::slide_crate, scene::CD_ROM_SLIDE, setup::Scene};
use slipfit_tests::cross::{self, TARGET, cargo, finished, printed};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Counts what steps take, in whatever the crate computes.
const PROGRAM: &str = r#"#![no_std]
#![no_main]

use core::hint::black_box;

use slipfit_firmware::{
    board::{Board, boot},
    count::Count,
    machine::{Machine, print},
};

fn run(board: &mut Board, _: &[u8]) -> bool {
    let predictor = black_box(slide::predictor(2.5).expect("the level is in bounds"));
    let mut state = slide::at_rest(&predictor);
    let mut count = Count::default();
    for _ in 0..200 {
        count.add(counted(board, &predictor, &mut state));
    }
    let (least, most) = count.range().expect("the board counts").ends();
    print(board, format_args!("{least} {most} {:08x}", slide::force(&predictor, &state).to_bits()));
    true
}

/// A function of its own, so that what is around the step is the same every time.
#[inline(never)]
fn counted(board: &mut Board, predictor: &slide::Predictor, state: &mut slide::State) -> Option<u32> {
    board.instructions(|| _ = black_box(slide::step(predictor, state)))
}

#[cortex_m_rt::entry]
fn main() -> ! {
    boot(run)
}
"#;

/// What one image printed: the least and the most instructions of a step, and the force after 200 of them.
#[derive(Debug, PartialEq)]
struct Steps {
    least: u32,
    most: u32,
    force: String,
}

/// Writes a workspace of the crate and an image that uses it into `folder`, as a user would.
fn workspace(folder: &Path, scene: &Scene) {
    let write = |path: &str, text: &str| {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().expect("a folder")).expect("the test's folder takes folders");
        fs::write(path, text).expect("the test's folder takes files");
    };
    for (path, text) in slide_crate(scene, "slide", Some(&Path::new(ROOT).join("core"))) {
        write(&format!("slide/{}", path.display()), &text);
    }
    write(
        "Cargo.toml",
        "[workspace]\nmembers = [\"slide\", \"image\"]\nresolver = \"3\"\n\n\
         [profile.release]\nlto = \"fat\"\ncodegen-units = 1\n",
    );
    let manifest = "[package]\nname = \"image\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[dependencies]\n\
                    cortex-m-rt = \"0.7\"\nslide = { path = \"../slide\" }\n";
    write("image/Cargo.toml", &format!("{manifest}slipfit-firmware = {{ path = \"{ROOT}/tests/firmware\" }}\n"));
    write("image/src/main.rs", PROGRAM);
    let build = "fn main() {\n    println!(\"cargo::rustc-link-search=ROOT\");\n    \
                 println!(\"cargo::rustc-link-arg-bins=-Tlink.x\");\n}\n";
    write("image/build.rs", &build.replace("ROOT", ROOT));
    fs::copy(Path::new(ROOT).join("Cargo.lock"), folder.join("Cargo.lock")).expect("the repository's own versions");
}

/// What steps take in the image in `folder` with all of it at `level`, but the crate at `of_the_crate`.
fn steps(folder: &Path, level: &str, of_the_crate: &str) -> Steps {
    // As the lines of the profile say; in the environment, so that one workspace serves all.
    let mut build = cargo(&folder.to_string_lossy());
    build
        .current_dir(folder)
        .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", level)
        .args(["build", "--offline", "--release", "-p", "image", "--target", TARGET])
        // The flags of the target, also where the target folder lies outside of the repository. After `build` like the other option of
        // that name: Cargo drops those before it if there are some after it.
        .arg("--config")
        .arg(Path::new(ROOT).join(".cargo/config.toml"))
        .arg("--config")
        .arg(format!("profile.release.package.slide.opt-level={of_the_crate}"));
    let built = finished(&mut build);
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let image = cross::image(&folder.to_string_lossy(), "image");
    let text = printed(std::process::Command::new(Path::new(ROOT).join(".cargo/qemu")).arg(image));
    let words: Vec<_> = text.split_whitespace().collect();
    let [least, most, force] = words[..] else { panic!("{text}") };
    let number = |word: &str| word.parse().expect("a number");
    Steps { least: number(least), most: number(most), force: force.to_owned() }
}

#[test]
#[ignore = "builds what users build: `cargo verify --all`"]
fn one_line_of_the_profile_keeps_a_step_fast() {
    cross::require_target();
    cross::require_crates();
    cross::require_emulator();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("small-image");
    workspace(&folder, &Scene::parse("cd-rom-slide.toml", CD_ROM_SLIDE, &[]).expect("the shipped scene"));
    let fast = steps(&folder, "3", "3");
    let mut table = String::from("image  crate  instructions of a step\n");
    for (level, of_the_crate) in [("3", "3"), ("\"s\"", "3"), ("\"z\"", "3"), ("\"s\"", "\"s\""), ("\"z\"", "\"z\"")] {
        let found = steps(&folder, level.trim_matches('"'), of_the_crate);
        let Steps { least, most, ref force } = found;
        assert_eq!(*force, fast.force, "the same bits");
        assert_eq!(least, most, "the same count every time");
        // What is not inlined lies in an order that goes by the folders that the crates are in.
        let count = if of_the_crate == "3" {
            assert!(f64::from(most) <= 1.02 * f64::from(fast.most), "{found:?} {fast:?}");
            format!("{most}")
        } else {
            format!("{:.0} times as many", f64::from(most) / f64::from(fast.most))
        };
        let _ = writeln!(table, "{:5}  {:5}  {count}", level.trim_matches('"'), of_the_crate.trim_matches('"'));
    }
    insta::assert_snapshot!("steps", table);
}
