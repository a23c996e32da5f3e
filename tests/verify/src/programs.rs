//! The programs that Cargo builds of the tests, several at a time.
//!
//! Cargo runs one after the other. Many wait on one thread, for an image that they build or emulate, while the others idle.

use std::{
    collections::VecDeque,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    sync::Mutex,
    thread,
    time::Instant,
};

use serde_json::Value;

/// Which of its tests a program runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tier {
    /// What `cargo test` runs.
    Usual,
    /// Those that are ignored because they take long, too; but no studies.
    All,
}

impl Tier {
    /// The arguments of the program.
    fn arguments(self) -> &'static [&'static str] {
        match self {
            Self::Usual => &[],
            Self::All => &["--include-ignored", "--skip", "study_"],
        }
    }
}

/// A program with tests.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// What it tests.
    name: String,
    file: PathBuf,
    /// The folder of its package, in which it runs.
    folder: PathBuf,
}

/// Builds all programs with tests of the workspace at `root`, by name, by the `cargo` that would run them.
///
/// # Errors
/// If they cannot be built.
pub fn built(mut cargo: Command, root: &Path) -> Result<Vec<Program>, String> {
    cargo.args(["--no-run", "--message-format=json-render-diagnostics"]);
    eprintln!("{cargo:?}");
    let output = cargo.stdin(Stdio::null()).stderr(Stdio::inherit()).output().map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err("the tests cannot be built".to_owned());
    }
    let said = String::from_utf8_lossy(&output.stdout);
    let mut programs: Vec<_> = said.lines().filter_map(|line| program(line, root)).collect();
    programs.sort_by(|one, other| one.name.cmp(&other.name));
    if programs.is_empty() { Err("there are no tests".to_owned()) } else { Ok(programs) }
}

/// The program that a `line` of what Cargo says in the folder `root` is about.
fn program(line: &str, root: &Path) -> Option<Program> {
    let said: Value = serde_json::from_str(line).ok()?;
    if said["reason"] != "compiler-artifact" || said["profile"]["test"] != true {
        return None;
    }
    let source = Path::new(said["target"]["src_path"].as_str()?);
    Some(Program {
        name: source.strip_prefix(root).unwrap_or(source).display().to_string(),
        file: said["executable"].as_str()?.into(),
        folder: Path::new(said["manifest_path"].as_str()?).parent()?.to_owned(),
    })
}

/// Runs the tests of this `tier` of the `programs`, as many at a time as there are processors.
///
/// # Errors
/// If tests fail, with how many programs have such.
pub fn run(programs: Vec<Program>, tier: Tier) -> Result<(), String> {
    let waiting = Mutex::new(VecDeque::from(programs));
    let failed = Mutex::new(0);
    let threads = thread::available_parallelism().map_or(1, |count| count.get());
    thread::scope(|scope| {
        for i in 0..threads {
            let (waiting, failed) = (&waiting, &failed);
            scope.spawn(move || {
                // Images wait for each other while they are built. Their tests come last by name, so that one thread in two
                // takes them and the others what computes.
                let next = || {
                    let mut waiting = waiting.lock().expect("no thread panics");
                    if i % 2 == 0 { waiting.pop_back() } else { waiting.pop_front() }
                };
                while let Some(program) = next() {
                    if !program.passes(tier) {
                        *failed.lock().expect("no thread panics") += 1;
                    }
                }
            });
        }
    });
    match failed.into_inner().expect("no thread panics") {
        0 => Ok(()),
        count => Err(format!("tests of {count} programs failed")),
    }
}

impl Program {
    /// Whether its tests pass; prints a line, and all that it says if they do not.
    fn passes(&self, tier: Tier) -> bool {
        let start = Instant::now();
        let ran = Command::new(&self.file)
            .args(tier.arguments())
            .current_dir(&self.folder)
            .env("CARGO_MANIFEST_DIR", &self.folder)
            .stdin(Stdio::null())
            .output();
        let seconds = start.elapsed().as_secs_f64();
        match ran {
            Ok(Output { status, stdout, .. }) if status.success() => {
                let said = String::from_utf8_lossy(&stdout);
                let result = said.lines().rev().find(|line| line.starts_with("test result: ")).unwrap_or("");
                let count =
                    result.trim_start_matches("test result: ").split(';').next().filter(|count| !count.is_empty());
                eprintln!("{seconds:6.1} s  {}: {}", self.name, count.unwrap_or("ok"));
                true
            }
            Ok(Output { status, stdout, stderr }) => {
                let (stdout, stderr) = (String::from_utf8_lossy(&stdout), String::from_utf8_lossy(&stderr));
                eprintln!("{seconds:6.1} s  {}: {status}\n{stdout}\n{stderr}", self.name);
                false
            }
            Err(error) => {
                eprintln!("{}: {error}", self.file.display());
                false
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::program;

    #[test]
    fn only_programs_with_tests_are_run() {
        let line = |test: bool, executable: &str| {
            format!(
                r#"{{"reason":"compiler-artifact","manifest_path":"/a/Cargo.toml","target":{{"src_path":"/a/b.rs"}},
                "profile":{{"test":{test}}},"executable":{executable}}}"#
            )
        };
        let read = |line: &str| program(line, Path::new("/a"));
        let found = read(&line(true, r#""/t/b-1""#)).unwrap();
        assert_eq!((found.name.as_str(), found.folder.to_str()), ("b.rs", Some("/a")));
        assert_eq!(read(&line(false, r#""/t/b-1""#)), None);
        assert_eq!(read(&line(true, "null")), None);
        assert_eq!(read("no JSON"), None);
    }
}
