//! A scene as a crate for firmware: the step of one type, so that it is compiled there and nowhere else, and one
//! line of a profile keeps it fast in an image that is built for size.

use std::path::{Path, PathBuf};

use super::{
    c_border::{Border, Driven as CDrive, bytes_of_mechanism},
    kernel_source::rust_source,
};
use crate::{
    dynamics::driven::{DriveKind, Driven},
    mechanism::{self, ByDrive, Mechanism, NamedDrive, RunError, command_name},
    setup::Scene,
};

/// A crate's name that Cargo or the compiler does not take.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NameError {
    /// Other characters than a crate's name has.
    #[error("a crate is not named {0:?}; allowed are a lower-case letter, then such letters, digits, - and _")]
    Characters(String),
    /// A keyword of Rust, a crate that it depends on, or a name that Windows reserves.
    #[error(
        "a crate is not named {0:?}, which is a keyword of Rust, a crate that it depends on or a file name of Windows"
    )]
    Taken(String),
}

/// Names that no crate of a kernel can have: keywords of Rust, also reserved ones; crates that it depends on, or that its names in C
/// would collide with; names of files that Windows reserves.
#[rustfmt::skip]
const TAKEN: [&str; 71] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate", "do", "dyn", "else", "enum",
    "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro", "match", "mod", "move", "mut",
    "override", "priv", "pub", "ref", "return", "self", "static", "struct", "super", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
    "alloc", "core", "proc_macro", "std", "test", "nalgebra", "libm", "slipfit", "slipfit_core", "slipfit_capi",
    "aux", "con", "nul", "prn", "com1", "com2", "com3", "lpt1", "lpt2", "lpt3",
];

/// The name of the crate in `folder`: the folder's own.
///
/// # Errors
/// [`NameError`] if no crate of that name compiles.
pub fn crate_name(folder: &Path) -> Result<String, NameError> {
    let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let is_letter = |letter: char| letter.is_ascii_lowercase();
    let is_good = name.starts_with(is_letter)
        && name.chars().all(|letter| is_letter(letter) || letter.is_ascii_digit() || ['-', '_'].contains(&letter));
    if !is_good {
        Err(NameError::Characters(name))
    } else if TAKEN.contains(&name.replace('-', "_").as_str()) {
        Err(NameError::Taken(name))
    } else {
        Ok(name)
    }
}

/// What every file of a crate has that slipfit wrote.
const WRITTEN: &str = "ritten by slipfit";

/// Whether `text` is that of a file of a crate which slipfit wrote.
pub fn is_written(text: &[u8]) -> bool {
    text.windows(WRITTEN.len()).take(4096).any(|window| window == WRITTEN.as_bytes())
}

/// Files, each with its path in the crate's folder.
pub type CrateFiles = [(PathBuf, String); 4];

/// Bytes of a slide's object for C, at least.
const BYTES_OF_SLIDE: usize = 1024;

/// The files of the crate `name` of a slide. `core` is where slipfit-core lies; if not given, its version is.
pub fn slide_crate(scene: &Scene, name: &str, core: Option<&Path>) -> CrateFiles {
    let found = "Driven { effort: force(parameters, state), speed: velocity(state) }";
    let border = Border {
        name,
        title: &scene.title,
        step: scene.controller.step as f32,
        hash: Some(scene.hash()),
        bytes: BYTES_OF_SLIDE,
        drives: vec![CDrive {
            function: "drive".into(),
            command: "command".into(),
            name: "drive",
            kind: DriveKind::Pushes,
            found: found.into(),
            set_command: "set_command(parameters, speed)".into(),
        }],
        start: "predictor(n).map(|unit| { let state = at_rest(&unit); (unit, state) })",
        at_start: "at_rest(parameters)",
    };
    crate_files(&rust_source(scene), OF_SLIDE, &border, core)
}

/// A drive of a mechanism, whose module has this `function` of it.
fn of_drive((function, drive): (String, &NamedDrive)) -> CDrive<'_> {
    CDrive {
        found: format!(
            "let found = {function}(parameters.mechanism(), parameters.time(state.steps), &state.motion.pose, \
             &state.motion.velocity);\n    Driven {{ effort: found.effort, speed: found.speed }}"
        ),
        set_command: format!("{}(parameters.mechanism_mut(), speed)", command_name(&function)),
        command: command_name(&function),
        function,
        name: &drive.name,
        kind: drive.action.kind(),
    }
}

/// The same of a mechanism.
///
/// # Errors
/// If the mechanism has no run, see [`RunError`].
pub fn mechanism_crate(mechanism: &Mechanism, name: &str, core: Option<&Path>) -> Result<CrateFiles, RunError> {
    let source = mechanism::rust_source(mechanism)?;
    let free = mechanism.bodies.len() * if mechanism.planar { 3 } else { 6 };
    // Bodies in space on ideal joints keep both their own data and those of the joints' coordinates.
    let joints = if mechanism.has_ideal_joints_in_space() { 2 * mechanism::dimension(mechanism)? } else { 0 };
    let coordinates = free + joints;
    let border = Border {
        name,
        title: &mechanism.title,
        step: mechanism.controller.step as f32,
        hash: ByDrive::new(mechanism, 0).filter(|_| mechanism.drives.len() == 1).map(|driven| driven.hash()),
        bytes: bytes_of_mechanism(&source, coordinates),
        drives: mechanism::drive_names(mechanism).into_iter().zip(&mechanism.drives).map(of_drive).collect(),
        start: "predictor(n)",
        at_start: "at_start(parameters)",
    };
    Ok(crate_files(&source, OF_MECHANISM, &border, core))
}

fn crate_files(source: &str, functions: &str, border: &Border, core: Option<&Path>) -> CrateFiles {
    let name = border.name;
    [
        (PathBuf::from("Cargo.toml"), manifest(name, core)),
        (Path::new("src").join("lib.rs"), library(source, functions, name)),
        (Path::new("src").join("c.rs"), border.rust()),
        (PathBuf::from(header_name(name)), border.header()),
    ]
}

/// What the crate of a slide has besides its module.
const OF_SLIDE: &str = "\
/// What does not change.
pub type Parameters = Predictor;

/// What changes from step to step.
pub type State = slipfit_core::kernel::StateOf<f32, Unit, 6>;

/// What a step says about itself.
pub type Report = slipfit_core::kernel::Report<f32>;

/// At rest in the nominal pose, at time 0.
pub fn at_rest(predictor: &Predictor) -> State {
    predictor.at_rest(slipfit_core::pose::Pose::nominal())
}

/// Moves `state` by one step of [`STEP`]: the same instructions whatever the state.
#[inline(never)]
pub fn step(predictor: &Predictor, state: &mut State) -> Report {
    predictor.step(state)
}

/// The force (N) of the drive now.
pub fn force(predictor: &Predictor, state: &State) -> f32 {
    predictor.mechanism().drive().force(predictor.time(state.steps), state.motion.velocity.z)
}

/// Velocity of the slide (m/s) along the drive.
pub fn velocity(state: &State) -> f32 {
    state.motion.velocity.z
}

/// How far the slide is (m) along the drive, from where it was at rest.
pub fn position(state: &State) -> f32 {
    state.motion.pose.displacement_w.z
}

/// From now on the commanded `speed` (m/s) is this, in place of the scene's ramp, until another one is set.
pub fn set_command(predictor: &mut Predictor, speed: f32) {
    slipfit_core::drive::Commandable::set_command(predictor.mechanism_mut().drive_mut(), speed);
}
";

/// The same of a mechanism, whose module has a function for each drive.
const OF_MECHANISM: &str = "\
/// What does not change.
pub type Parameters = Kernel<f32, Unit<f32>, Scheme>;

/// What changes from step to step.
pub type State = StateOf<f32, Unit<f32>, DIMENSION>;

/// What a step says about itself.
pub type Report = slipfit_core::kernel::Report<f32>;

/// Moves `state` by one step of [`STEP`]: the same instructions whatever the state.
#[inline(never)]
pub fn step(parameters: &Parameters, state: &mut State) -> Report {
    parameters.step(state)
}
";

/// The header's file name.
fn header_name(name: &str) -> String {
    format!("{}.h", name.replace('-', "_"))
}

fn manifest(name: &str, core: Option<&Path>) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let header = header_name(name);
    // As TOML has a string.
    let core = core.map(|path| format!("path = {}", toml::Value::from(path.to_string_lossy().as_ref())));
    let core = core.unwrap_or_else(|| format!("version = \"{version}\""));
    format!(
        "# Written by slipfit. In the workspace's Cargo.toml, for an image that is built for size:\n#\n\
         # [profile.release.package.{name}]\n# opt-level = 3\n\n\
         [package]\nname = \"{name}\"\nversion = \"{version}\"\nedition = \"2024\"\npublish = false\n\n\
         [features]\n# Functions for C, see {header}, for a library of this kernel alone.\nc = [\"c-functions\"]\n\
         # The same without a panic handler, for a library of several kernels, which has its own.\nc-functions = []\n\n[dependencies]\nslipfit-core = {{ {core} }}\n"
    )
}

fn library(source: &str, functions: &str, name: &str) -> String {
    // Its first line is a comment on the scene.
    let (title, module) = source.split_once('\n').unwrap_or((source, ""));
    let title = title.trim_start_matches("// ");
    format!(
        "//! {title} Written by slipfit.\n//!\n\
         //! The step is compiled in this crate alone, by what the profile says of it. In an image that\n\
         //! is built for size, or in a dev build, these lines in the workspace's Cargo.toml keep it fast:\n//!\n\
         //! ```toml\n//! [profile.release.package.{name}]\n//! opt-level = 3\n//!\n\
         //! [profile.dev.package.{name}]\n//! opt-level = 3\n//! ```\n#![no_std]\n#![cfg_attr(not(feature = \"c-functions\"), forbid(unsafe_code))]\n{module}\n{functions}\n\
         #[cfg(all(feature = \"c-functions\", not(target_os = \"none\")))]\nextern crate std;\n\n\
         #[cfg(feature = \"c-functions\")]\nmod c;\n"
    )
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{crate_name, slide_crate};
    use crate::dynamics::example;

    #[test]
    fn a_crate_is_named_like_its_folder() {
        assert_eq!(crate_name(Path::new("firmware/cd-rom_2")).as_deref(), Ok("cd-rom_2"));
        for bad in
            ["..", "/", "Slide", "2nd", "-a", "a b", "ä", "fn", "self", "core", "std", "slipfit-core", "slipfit_core"]
        {
            let error = crate_name(Path::new(bad)).unwrap_err().to_string();
            assert!(error.starts_with("a crate is not named"), "{bad}: {error}");
        }
        // Keywords of C and its library's names are good: no name in the header is that alone.
        for good in ["int", "float", "class", "exit", "main", "errno"] {
            assert_eq!(crate_name(Path::new(good)).as_deref(), Ok(good));
        }
    }

    #[test]
    fn says_where_core_is_and_which_line_keeps_it_fast() {
        let files = slide_crate(&example::cd_rom(), "slide", Some(Path::new("a \"b\"/core")));
        let manifest: toml::Table = files[0].1.parse().unwrap();
        assert_eq!(manifest["dependencies"]["slipfit-core"]["path"].as_str(), Some("a \"b\"/core"));
        let by_version: toml::Table = slide_crate(&example::cd_rom(), "slide", None)[0].1.parse().unwrap();
        let version = by_version["dependencies"]["slipfit-core"]["version"].as_str();
        assert_eq!(version, Some(env!("CARGO_PKG_VERSION")));
        assert!(files[..2].iter().all(|(_, text)| text.contains("[profile.release.package.slide]")));
        let header = &files[3];
        assert!(
            header.0 == Path::new("slide.h") && header.1.contains("int32_t slide_step(slide_unit *unit);"),
            "{header:?}"
        );
    }
}
