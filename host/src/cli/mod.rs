//! The command line: one file a command, each with its arguments and its `run`.

mod allocate;
mod check;
mod encoding;
mod endings;
mod failure;
mod fmu;
mod kernel;
mod mechanism;
mod merge;
mod population;
mod precision;
#[cfg(test)]
pub(crate) mod reference;
mod run;
mod simulate;
mod stability;
mod sweep;
mod table;
mod terminal;
mod tolerance;

use std::{
    borrow::Cow,
    io::{IsTerminal, Read},
    path::{Path, PathBuf},
    process::ExitCode,
};

use clap::{
    Args, CommandFactory, Parser, Subcommand,
    builder::{PossibleValuesParser, TypedValueParser},
};
use slipfit_system::{files, interrupt};
use slipfit_tolerance::product::Product;

use self::{
    failure::{Failure, refused},
    terminal::{counter, given, print, print_json, progress, tell, text_table, warn, write_out},
};
use crate::{
    mechanism::{ByDrive, Mechanism},
    scene::{Override, SHIPPED, SceneFile, shipped},
    setup::Scene,
};

/// A parser of the names of `all`.
fn one_of<T: Copy + Send + Sync + 'static, const N: usize>(
    all: [T; N],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(all.map(name)).try_map(move |given| {
        all.into_iter().find(|one| name(*one) == given).ok_or_else(|| format!("{given} is none of them"))
    })
}

/// From a drawing's tolerances to a flashed force table.
///
/// Without a scene, `run` and `tolerance` work on the shipped scene cd-rom-slide-drawing, a slide with its drawing. `allocate` has
/// no default. The other commands work on cd-rom-slide, the same slide with its gaps stated.
///
/// Exit codes: 0 done (a unit that jams or a measure outside its limits is a result), 1 failed (no result; requirements out of
/// reach; a full disk; interrupted), 2 bad input or usage.
#[derive(Parser)]
#[command(name = "slipfit", version, max_term_width = 100, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

const EXAMPLES: &str = "\
Examples:
  slipfit run                              the whole job on the CD-ROM slide, into slipfit-out/cd-rom-slide-drawing/
  slipfit check my-slide.toml              is the scene sound, at which level does a gap close
  slipfit tolerance three-part-stack       how a product's measures vary, and which tolerances cause it
  slipfit allocate clutch-processes        the cheapest tolerances that meet requirements
  slipfit simulate --n 2.5 --csv unit.csv  one unit, tighter by 2.5 sigma
  slipfit sweep --stroke --n 0:5:0.5 --plot force.svg
                                           at which levels n the slide jams on its stroke
  slipfit population --plot units.svg      how many units of the production malfunction, and why
  slipfit table -o force.h                 the flash table as a C header (.bin .hex .h .rs)
  slipfit kernel -o scene.rs               the scene as a Rust constant and type for firmware
  slipfit fmu -o slide.fmu                 the same kernel for system simulators (FMI)";

#[derive(Subcommand)]
enum Command {
    Run(run::Arguments),
    Check(check::Arguments),
    Tolerance(tolerance::Arguments),
    Allocate(allocate::Arguments),
    Simulate(simulate::Arguments),
    Sweep(sweep::Arguments),
    Population(population::Arguments),
    Table(table::Arguments),
    Kernel(kernel::Arguments),
    Fmu(fmu::Arguments),
    Precision(precision::Arguments),
    Merge(merge::Arguments),
}

/// The shipped scene that commands work on: the paper's slide with Table 2 as given.
const TABLE_2: &str = "cd-rom-slide";
/// The shipped scene of the commands that start from a drawing: the same slide, Table 2 following from its parts.
const DRAWING: &str = "cd-rom-slide-drawing";

/// What every command takes.
#[derive(Args)]
struct SceneArguments {
    /// Scene file (TOML), or the name of a shipped scene.
    #[arg(default_value = TABLE_2)]
    scene: PathBuf,
    /// Sets a key of the scene, such as contact.stiffness=1000 or "slide.mass=90 g"; may be repeated.
    ///
    /// A table of a list goes by its name: "pin.left front.left=[0.01, 0.05]".
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Prints JSON instead of text.
    #[arg(long)]
    json: bool,
}

/// What moves in a scene.
enum Moving {
    /// A slide on pins.
    Slide(Box<Scene>),
    /// Bodies and joints.
    Mechanism(Box<Mechanism>),
}

/// The longest scene file (bytes).
const SCENE_MOST: u64 = 1 << 20;

impl SceneArguments {
    /// Whether all `outputs`, each with the option that asks for it, can be written, and none is the scene or another.
    fn check_outputs(&self, outputs: &[(&str, &Path)]) -> Result<(), Failure> {
        endings::check(outputs)?;
        files::check_distinct(&[("the scene", &self.scene)], outputs)?;
        outputs.iter().try_for_each(|(_, path)| files::check_writable(path).map_err(refused))
    }

    /// Reads the scene file, with `options` as further settings.
    fn load_file(&self, options: &[Override]) -> Result<SceneFile, Failure> {
        let (name, text) = self.text()?;
        Ok(SceneFile::parse(&name, &text, &self.overrides(options))?)
    }

    /// Reads what moves in the scene, with `options` as further settings, and warns about what is implausible in it: for commands
    /// whose result has no place for warnings.
    fn load_moving(&self, options: &[Override]) -> Result<Moving, Failure> {
        let (moving, _) = self.load_moving_with_product(options)?;
        warn(match &moving {
            Moving::Slide(scene) => &scene.warnings,
            Moving::Mechanism(found) => &found.warnings,
        });
        Ok(moving)
    }

    /// Reads what moves in the scene and the product it belongs to, if there is one, with `options` as further settings.
    fn load_moving_with_product(&self, options: &[Override]) -> Result<(Moving, Option<Product>), Failure> {
        let (name, text) = self.text()?;
        let mut file = SceneFile::parse(&name, &text, &self.overrides(options))?;
        if let Some(mechanism) = file.mechanism.take() {
            return Ok((Moving::Mechanism(Box::new(mechanism)), file.product));
        }
        let (scene, product) = file.into_slide(&name, &text)?;
        Ok((Moving::Slide(Box::new(scene)), product))
    }

    /// Reads the slide of the scene and the product it belongs to, if there is one, with `options` as further settings.
    fn load_with_product(&self, options: &[Override]) -> Result<(Scene, Option<Product>), Failure> {
        let (name, text) = self.text()?;
        Ok(SceneFile::parse_with_slide(&name, &text, &self.overrides(options))?)
    }

    fn overrides(&self, options: &[Override]) -> Vec<Override> {
        self.set.iter().map(|assignment| Override::set(assignment)).chain(options.iter().cloned()).collect()
    }

    /// Name and text of the scene: a file, or a shipped one by its name.
    /// The scene's name without folder and ending.
    fn stem(&self) -> &std::ffi::OsStr {
        self.scene.file_stem().unwrap_or("scene".as_ref())
    }

    /// Its name for messages, and its text.
    fn text(&self) -> Result<(String, Cow<'static, str>), Failure> {
        let path = &self.scene;
        let unreadable =
            |why: &dyn std::fmt::Display| Failure::Input(format!("cannot read the scene {}: {why}", path.display()));
        let name = path.to_string_lossy();
        // A folder is no scene: where there is one of that name, the shipped one is meant.
        if let Some(text) = shipped(&name).filter(|_| !path.exists() || path.is_dir()) {
            return Ok((format!("{name}.toml"), text.into()));
        }
        let file = std::fs::File::open(path).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => {
                let names: Vec<_> = SHIPPED.iter().map(|(name, _)| *name).collect();
                unreadable(&format!("{error}; shipped scenes are {}", names.join(", ")))
            }
            _ => unreadable(&error),
        })?;
        let mut bytes = Vec::new();
        file.take(SCENE_MOST + 1).read_to_end(&mut bytes).map_err(|error| unreadable(&error))?;
        if bytes.len() as u64 > SCENE_MOST {
            return Err(unreadable(&format!("it is longer than {SCENE_MOST} bytes")));
        }
        let text = encoding::text_of(bytes).map_err(|error| unreadable(&error))?;
        Ok((path.display().to_string(), text.into()))
    }
}

/// Which drive of a mechanism.
#[derive(Args)]
struct DriveArguments {
    /// Name of the drive, where a mechanism has several.
    #[arg(long, value_name = "NAME")]
    drive: Option<String>,
}

impl DriveArguments {
    /// The drive of `mechanism` that is meant.
    fn of<'m>(&self, mechanism: &'m Mechanism) -> Result<ByDrive<'m>, Failure> {
        let names: Vec<_> = mechanism.drives.iter().map(|drive| drive.name.as_str()).collect();
        let found = match (&self.drive, &names[..]) {
            (_, []) => {
                Err("the mechanism has no [[drive]], which this command is about; simulate tells how it moves".into())
            }
            (None, [_]) => Ok(0),
            (None, _) => {
                Err(format!("the mechanism has several drives: --drive says which, one of {}", names.join(", ")))
            }
            (Some(name), _) => names
                .iter()
                .position(|one| one == name)
                .ok_or_else(|| format!("--drive: there is no drive {name:?}, there is {}", names.join(", "))),
        };
        let index = found.map_err(Failure::Input)?;
        Ok(ByDrive::new(mechanism, index).expect("a drive's index"))
    }

    /// An error if a drive is named for a slide.
    fn refuse(&self) -> Result<(), Failure> {
        let given = self.drive.is_some();
        if given { Err(Failure::Input("--drive is for mechanisms, a slide has one drive".into())) } else { Ok(()) }
    }
}

/// Number of threads of the commands that work on many units.
#[derive(Args)]
struct ThreadArguments {
    /// Number of threads; all cores if not given. The result does not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

impl ThreadArguments {
    /// Runs `work` on a pool of that many threads.
    fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
        let threads = self.threads.map_or(0, usize::from);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(anyhow::Error::from)?;
        Ok(pool.install(work))
    }
}

/// Runs the command that the process was started with.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        // Help and version are asked for; a full disk must not pass unnoticed.
        Err(asked) if !asked.use_stderr() => {
            let text = asked.render();
            let text = if std::io::stdout().is_terminal() { text.ansi().to_string() } else { text.to_string() };
            return ExitCode::from(u8::from(write_out(&[&text]).is_err()));
        }
        Err(wrong) => wrong.exit(),
    };
    if let Err(error) = interrupt::install() {
        tell(&format!("error: {error}"));
        return ExitCode::from(1);
    }
    let result = match cli.command {
        None => print(&Cli::command().render_help().to_string()),
        Some(Command::Run(arguments)) => arguments.run(),
        Some(Command::Check(arguments)) => arguments.run(),
        Some(Command::Tolerance(arguments)) => arguments.run(),
        Some(Command::Allocate(arguments)) => arguments.run(),
        Some(Command::Simulate(arguments)) => arguments.run(),
        Some(Command::Sweep(arguments)) => arguments.run(),
        Some(Command::Population(arguments)) => arguments.run(),
        Some(Command::Table(arguments)) => arguments.run(),
        Some(Command::Kernel(arguments)) => arguments.run(),
        Some(Command::Fmu(arguments)) => arguments.run(),
        Some(Command::Precision(arguments)) => arguments.run(),
        Some(Command::Merge(arguments)) => arguments.run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            match &failure {
                Failure::Scene(error) => tell(&error.render(std::io::stderr().is_terminal())),
                other => tell(&format!("error: {other}")),
            }
            ExitCode::from(if matches!(failure, Failure::Work(_)) { 1 } else { 2 })
        }
    }
}
