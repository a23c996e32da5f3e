//! The tests with one command, `cargo verify`: installs what they need where it may, and says what is missing where it may not.
//!
//! `cargo verify --all` adds those that are ignored because they take long, but studies, whose names start with `study_`: each has a smaller
//! test of its own. Other arguments go to `cargo test`.
#![forbid(unsafe_code)]

mod programs;

use std::{
    env,
    path::Path,
    process::{Command, ExitCode, Stdio},
};

use programs::Tier;

/// Targets that tests build for.
const TARGETS: [&str; 6] = [
    "thumbv7em-none-eabihf",
    "thumbv7em-none-eabi",
    "thumbv7m-none-eabi",
    "thumbv6m-none-eabi",
    "thumbv8m.main-none-eabihf",
    "riscv32imafc-unknown-none-elf",
];

/// The C library of the target, of which tests include headers.
const NEWLIB: &str = "newlib";

/// Programs that tests run, and the Debian packages that have them.
const TOOLS: [(&str, &str); 12] = [
    ("qemu-system-arm", "qemu-system-arm"),
    ("qemu-system-riscv32", "qemu-system-misc"),
    ("arm-none-eabi-gcc", "gcc-arm-none-eabi"),
    (NEWLIB, "libnewlib-arm-none-eabi"),
    ("chromium", "chromium"),
    ("npm", "npm"),
    ("c++", "g++"),
    // Its library reads the headers of the crate `fmi`.
    ("clang", "clang"),
    ("cmake", "cmake"),
    ("pkg-config", "pkg-config"),
    ("slurmd", "slurm-wlm"),
    ("munge", "munge"),
];

/// Packages of Python that tests import.
const PYTHON_PACKAGES: [&str; 2] = ["fmpy", "kconfiglib"];

/// The root of the repository.
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// A step's outcome: what it ascertained, or what is wrong.
type Outcome = Result<String, String>;

/// A step.
type Step = fn() -> Outcome;

fn main() -> ExitCode {
    let steps: [(&str, Step); 4] = [("targets", targets), ("tools", tools), ("python", python), ("tests", tests)];
    let mut done = Vec::new();
    for (name, step) in steps {
        eprintln!("== {name}");
        match step() {
            Ok(what) => done.push(format!("{name}: {what}")),
            Err(why) => {
                eprintln!("error: {why}");
                return ExitCode::FAILURE;
            }
        }
    }
    eprintln!("== all passed\n{}", done.join("\n"));
    ExitCode::SUCCESS
}

/// Has the targets installed.
fn targets() -> Outcome {
    let missing: Vec<_> = TARGETS.into_iter().filter(|target| !has_target(target)).collect();
    if !missing.is_empty() {
        let mut install = Command::new("rustup");
        install.args(["target", "add"]).args(&missing);
        if !runs(&mut install) || !missing.iter().all(|target| has_target(target)) {
            return Err(format!("targets are missing; to install them: rustup target add {}", missing.join(" ")));
        }
    }
    Ok(TARGETS.join(", "))
}

/// Whether the compiler has the target's core library.
fn has_target(target: &str) -> bool {
    let output = Command::new("rustc").args(["--print", "target-libdir", "--target", target]).output();
    output.is_ok_and(|output| Path::new(String::from_utf8_lossy(&output.stdout).trim()).is_dir())
}

/// Has the programs installed that tests run.
fn tools() -> Outcome {
    let missing: Vec<_> = TOOLS.into_iter().filter(|(program, _)| !has_program(program)).collect();
    if !missing.is_empty() {
        let packages: Vec<_> = missing.iter().map(|(_, package)| *package).collect();
        if !install(&packages) || !missing.iter().all(|(program, _)| has_program(program)) {
            let names: Vec<_> = missing.iter().map(|(program, _)| *program).collect();
            let (names, packages) = (names.join(", "), packages.join(" "));
            return Err(format!("missing: {names}; to install it on Debian: sudo apt-get install {packages}"));
        }
    }
    Ok(TOOLS.map(|(program, _)| program).join(", "))
}

/// Has the packages of Python installed.
fn python() -> Outcome {
    let missing: Vec<_> = PYTHON_PACKAGES.into_iter().filter(|package| !has_package(package)).collect();
    if !missing.is_empty() {
        // A Python that the system keeps for itself has no pip, and takes packages only when told so.
        let into = |options: &[&str]| {
            runs(Command::new("python3").args(["-m", "pip", "install", "--quiet"]).args(options).args(&missing))
        };
        let installed = into(&[]) || (install(&["python3-pip"]) && (into(&[]) || into(&["--break-system-packages"])));
        if !installed || !missing.iter().all(|package| has_package(package)) {
            let missing = missing.join(" ");
            return Err(format!("packages are missing; to install them: python3 -m pip install {missing}"));
        }
    }
    Ok(PYTHON_PACKAGES.join(", "))
}

/// Whether Python imports the package.
fn has_package(package: &str) -> bool {
    quietly(Command::new("python3").args(["-c", &format!("import {package}")]))
}

/// Whether the program starts; of the C library whether the compiler finds it.
fn has_program(program: &str) -> bool {
    if program == NEWLIB {
        let arguments = ["-E", "-include", "stdlib.h", "-x", "c", "/dev/null"];
        return quietly(Command::new("arm-none-eabi-gcc").args(arguments));
    }
    // Daemons lie where not every user's shell looks.
    [program.to_owned(), format!("/usr/sbin/{program}")].iter().any(|path| quietly(Command::new(path).arg("--version")))
}

/// Installs Debian packages, as root or with a sudo that asks nothing.
fn install(packages: &[&str]) -> bool {
    if !has_program("apt-get") {
        return false;
    }
    let is_root = Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout.trim_ascii() == b"0");
    if !is_root && !quietly(Command::new("sudo").args(["-n", "true"])) {
        return false;
    }
    let apt_get = || {
        let mut command = if is_root { Command::new("env") } else { Command::new("sudo") };
        command.args(["DEBIAN_FRONTEND=noninteractive", "apt-get"]);
        command
    };
    runs(apt_get().arg("update"))
        && runs(apt_get().args(["install", "--yes", "--no-install-recommends"]).args(packages))
}

/// Runs the tests of the whole workspace: several programs at a time, or by Cargo where it is given arguments.
fn tests() -> Outcome {
    let mut arguments: Vec<_> = env::args_os().skip(1).collect();
    let tier = if arguments.first().is_some_and(|first| first == "--all") {
        arguments.remove(0);
        Tier::All
    } else {
        Tier::Usual
    };
    if !arguments.is_empty() {
        let mut command = cargo_test();
        command.args(arguments);
        return if runs(&mut command) {
            Ok("cargo test --workspace".to_owned())
        } else {
            Err("tests failed".to_owned())
        };
    }
    let programs = programs::built(cargo_test(), &Path::new(ROOT).canonicalize().map_err(|error| error.to_string())?)?;
    let count = programs.len();
    programs::run(programs, tier)?;
    if !runs(cargo_test().args(["--doc", "--quiet"])) {
        return Err("examples in the documentation failed".to_owned());
    }
    Ok(format!("{count} programs, and the examples in the documentation"))
}

/// The Cargo that runs this, to test the whole workspace.
fn cargo_test() -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    // With the one feature that no member of the workspace asks for.
    command.current_dir(ROOT).args(["test", "--workspace", "--features", "slipfit-core/embedded-storage"]);
    command
}

/// Whether `command` starts and succeeds, saying what it is.
fn runs(command: &mut Command) -> bool {
    eprintln!("{command:?}");
    command.stdin(Stdio::null()).status().is_ok_and(|status| status.success())
}

/// Whether `command` starts and succeeds, silently.
fn quietly(command: &mut Command) -> bool {
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}
