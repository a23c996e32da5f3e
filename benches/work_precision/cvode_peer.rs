//! SUNDIALS CVODE, driven by a C program that is compiled here if the library is installed (Debian: libsundials-dev).

use std::{
    path::{Path, PathBuf},
    process::Command,
    time::Duration,
};

use slipfit_tests::cross::whole_program;

use crate::entry::{Achieved, Entry, Tolerances};

const LIBRARIES: [&str; 8] = [
    "-lsundials_cvode",
    "-lsundials_nvecserial",
    "-lsundials_sunmatrixdense",
    "-lsundials_sunlinsoldense",
    "-lm",
    "-lpthread",
    "-ldl",
    "-lgcc_s",
];

/// The program.
pub struct Cvode(PathBuf);

impl Cvode {
    /// The program with the kernel's forces linked in.
    pub fn built() -> Result<Self, String> {
        let folder = env!("CARGO_TARGET_TMPDIR");
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/cvode/main.c");
        let probe = Command::new("cc").arg("-fsyntax-only").arg(&source).output().map_err(|error| error.to_string())?;
        if !probe.status.success() {
            return Err("libsundials-dev or a C compiler is not installed".to_owned());
        }
        succeed(whole_program(folder).args(["build", "--release", "-p", "slipfit-cvode"]))?;
        let program = Path::new(folder).join("cvode");
        let rates = Path::new(folder).join("cross/release/libslipfit_cvode.a");
        succeed(Command::new("cc").arg("-O3").arg(&source).arg(&rates).args(LIBRARIES).arg("-o").arg(&program))?;
        Ok(Self(program))
    }

    /// CVODE with every tolerance and its own difference quotients.
    pub fn entries(&self, milliseconds: u32) -> Vec<Entry> {
        let entry = |tolerances: Tolerances| {
            let Tolerances { relative, absolute, proportion } = tolerances;
            let program = self.0.clone();
            let arguments = [relative, absolute, proportion].map(|x| x.to_string());
            Entry {
                solver: "CVODE BDF",
                setting: tolerances.to_string(),
                work: Box::new(move || solve(&program, milliseconds, &arguments)),
            }
        };
        Tolerances::all().map(entry).collect()
    }
}

/// The quickest of several runs in one process; `None` if the solver gives up.
fn solve(program: &Path, milliseconds: u32, tolerances: &[String; 3]) -> Option<Achieved> {
    let output = Command::new(program).arg(milliseconds.to_string()).args(tolerances).output().ok()?;
    let text = String::from_utf8(output.stdout).ok().filter(|_| output.status.success())?;
    let numbers: Vec<f64> = text.lines().map(str::parse).collect::<Result<_, _>>().ok()?;
    let (time, force) = numbers.split_first()?;
    Some(Achieved { force: force.to_vec(), time: Duration::from_secs_f64(*time) })
}

fn succeed(command: &mut Command) -> Result<(), String> {
    let output = command.output().map_err(|error| error.to_string())?;
    output.status.success().then_some(()).ok_or_else(|| String::from_utf8_lossy(&output.stderr).into_owned())
}
