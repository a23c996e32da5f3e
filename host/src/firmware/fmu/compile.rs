//! Compiles a unit's library by the machine's own Cargo.

use std::{
    env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS},
    ffi::OsString,
    fs, io,
    io::{BufRead, BufReader},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::mpsc::{RecvTimeoutError, channel},
    time::Duration,
};

use slipfit_system::interrupt;

use super::{Fmi, Unit};

/// The source of slipfit-core that this program was built with.
const CORE: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/core_source.rs"));

/// The workspace that it was built in: versions of libraries decide on bits too.
const WORKSPACE: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.toml"));
const LOCK: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.lock"));

/// How often somebody may ask to stop.
const LOOK: Duration = Duration::from_millis(50);

/// What is the same for every scene.
const TEMPLATE: [(&str, &str); 7] = [
    ("lib.rs", include_str!("template/lib.rs")),
    ("clock.rs", include_str!("template/clock.rs")),
    ("ffi.rs", include_str!("template/ffi.rs")),
    ("fmi2.rs", include_str!("template/fmi2.rs")),
    ("fmi3.rs", include_str!("template/fmi3.rs")),
    ("instance.rs", include_str!("template/instance.rs")),
    ("numbers.rs", include_str!("template/numbers.rs")),
];

/// Why there is no library.
#[derive(Debug, thiserror::Error)]
pub enum CompileError {
    /// No Cargo.
    #[error(
        "there is no cargo on the PATH: a unit is compiled on this machine, https://rustup.rs installs what that takes"
    )]
    NoCargo,
    /// Cargo could not be run, or what it made could not be read.
    #[error("cannot compile the unit: {0}")]
    System(#[from] io::Error),
    /// Somebody asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// The compiler's own words.
    #[error("cargo did not compile the unit:\n{0}")]
    Build(String),
}

/// Where slipfit-core's source is taken from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Sources {
    /// This program.
    Embedded,
    /// A folder.
    Folder(PathBuf),
}

impl Sources {
    /// Where it lies, seen from the crates that need it.
    pub fn path(&self) -> &Path {
        match self {
            Self::Embedded => Path::new("../core"),
            Self::Folder(folder) => folder,
        }
    }
}

/// The library of `unit`, compiled with optimisation in a temporary folder; `line` is told what Cargo says meanwhile.
///
/// # Errors
/// See [`CompileError`].
pub fn compile(unit: &Unit, sources: &Sources, mut line: impl FnMut(&str)) -> Result<Vec<u8>, CompileError> {
    let folder = tempfile::Builder::new().prefix("slipfit-fmu-").tempdir()?;
    write_sources(folder.path(), unit, sources)?;
    let mut command = Command::new("cargo");
    command
        .current_dir(folder.path())
        .args(["build", "--release", "--package", "fmu", "--target-dir", "target"])
        .env("CARGO_ENCODED_RUSTFLAGS", flags(folder.path()))
        .env_remove("CARGO_BUILD_TARGET")
        .env_remove("CARGO_BUILD_RUSTC_WRAPPER")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    // A group of its own, so that the compilers end with it.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    let mut child = command.spawn().map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => CompileError::NoCargo,
        _ => error.into(),
    })?;
    let mut said = String::new();
    let (send, receive) = channel();
    let errors = child.stderr.take();
    std::thread::spawn(move || {
        // Nobody listens after a stop.
        errors.into_iter().flat_map(|errors| BufReader::new(errors).lines()).try_for_each(|text| send.send(text))
    });
    loop {
        match receive.recv_timeout(LOOK) {
            Ok(text) => {
                let text = text?;
                line(text.trim());
                said.push_str(&text);
                said.push('\n');
            }
            Err(RecvTimeoutError::Timeout) if interrupt::requested() => {
                end(&mut child)?;
                return Err(CompileError::Interrupted);
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    if !child.wait()?.success() {
        return Err(CompileError::Build(said));
    }
    let library = format!("{DLL_PREFIX}fmu{DLL_SUFFIX}");
    Ok(fs::read(folder.path().join("target").join("release").join(library))?)
}

/// Ends Cargo and its compilers.
fn end(child: &mut Child) -> io::Result<()> {
    #[cfg(unix)]
    if let Ok(group) = i32::try_from(child.id()) {
        // It may have ended by itself meanwhile.
        let _ = nix::sys::signal::killpg(nix::unistd::Pid::from_raw(group), nix::sys::signal::Signal::SIGKILL);
    }
    #[cfg(not(unix))]
    child.kill()?;
    child.wait().map(drop)
}

/// Folder and name of the library `identifier` in the archive, on the machine that this program runs on.
pub fn library_path(fmi: Fmi, identifier: &str) -> PathBuf {
    let folder = match fmi {
        Fmi::Three => {
            let system = if OS == "macos" { "darwin" } else { OS };
            format!("{ARCH}-{system}")
        }
        Fmi::Two => {
            let system = match OS {
                "macos" => "darwin",
                "windows" => "win",
                other => other,
            };
            format!("{system}{}", usize::BITS)
        }
    };
    Path::new("binaries").join(folder).join(format!("{identifier}{DLL_SUFFIX}"))
}

fn write_sources(folder: &Path, unit: &Unit, sources: &Sources) -> Result<(), CompileError> {
    let mut files = vec![
        (PathBuf::from("Cargo.toml"), workspace()),
        (PathBuf::from("Cargo.lock"), LOCK.to_owned()),
        (PathBuf::from("fmu/Cargo.toml"), manifest(sources.path())),
        (PathBuf::from("fmu/src/model.rs"), unit.model.clone()),
    ];
    files.extend(TEMPLATE.map(|(name, text)| (Path::new("fmu/src").join(name), text.to_owned())));
    files.extend(unit.kernel.iter().map(|(path, text)| (Path::new("kernel").join(path), text.clone())));
    if *sources == Sources::Embedded {
        files.extend(CORE.iter().map(|(path, text)| (PathBuf::from(path), (*text).to_owned())));
    }
    for (path, text) in files {
        let path = folder.join(path);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent)?;
        }
        fs::write(path, text)?;
    }
    Ok(())
}

/// The manifest of the temporary workspace: what slipfit-core takes from this one.
fn workspace() -> String {
    let table: toml::Table = WORKSPACE.parse().unwrap_or_default();
    let here = table.get("workspace").and_then(toml::Value::as_table).cloned().unwrap_or_default();
    let mut workspace = toml::Table::new();
    workspace.insert("members".into(), toml::Value::Array(vec!["fmu".into()]));
    for key in ["resolver", "package", "lints"] {
        workspace.extend(here.get(key).map(|value| (key.to_owned(), value.clone())));
    }
    let mut dependencies = here.get("dependencies").and_then(toml::Value::as_table).cloned().unwrap_or_default();
    dependencies.retain(|_, value| value.get("path").is_none());
    workspace.insert("dependencies".into(), dependencies.into());
    let release = toml::Table::from_iter([("strip".to_owned(), true.into()), ("opt-level".to_owned(), 3.into())]);
    let profile = toml::Table::from_iter([("release".to_owned(), release.into())]);
    toml::Table::from_iter([("workspace".to_owned(), workspace.into()), ("profile".to_owned(), profile.into())])
        .to_string()
}

fn manifest(core: &Path) -> String {
    let core = toml::Value::from(core.to_string_lossy().as_ref());
    format!(
        "[package]\nname = \"fmu\"\nversion = \"{}\"\nedition = \"2024\"\npublish = false\n\n\
         [lib]\ncrate-type = [\"cdylib\"]\n\n\
         [dependencies]\nkernel = {{ path = \"../kernel\" }}\nlibm = \"0.2\"\nslipfit-core = {{ path = {core} }}\n",
        env!("CARGO_PKG_VERSION")
    )
}

/// The compiler's flags, whatever the user's are: paths of this machine do not get into the library.
fn flags(folder: &Path) -> OsString {
    let mut flags = OsString::new();
    let home = std::env::var_os("CARGO_HOME").map(PathBuf::from).or_else(|| Some(std::env::home_dir()?.join(".cargo")));
    let named = [(Some(folder.to_owned()), "slipfit"), (home, "cargo")];
    for (path, name) in named.into_iter().filter_map(|(path, name)| Some((path?, name))) {
        if !flags.is_empty() {
            flags.push("\x1f");
        }
        flags.push("--remap-path-prefix=");
        flags.push(path);
        flags.push(format!("={name}"));
    }
    flags
}
