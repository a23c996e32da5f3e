//! The command line: one file a command, each with its arguments and its `run`.

mod allocate;
mod arguments;
mod by_one_drive;
pub mod call;
mod capability;
mod check;
mod encoding;
mod endings;
mod failure;
mod fmu;
mod identify;
mod import;
mod kernel;
mod mechanism;
mod merge;
mod population;
mod precision;
#[cfg(test)]
pub(crate) mod reference;
mod run;
mod schema;
mod self_locking;
mod simulate;
mod stability;
mod sweep;
mod table;
mod terminal;
mod tolerance;
mod watch;

use std::{ffi::OsString, io::IsTerminal, process::ExitCode, sync::Arc};

use clap::{CommandFactory, Parser, Subcommand};
use slipfit_system::interrupt;

use self::call::{Answer, Call};
pub use self::failure::Failure;
use self::terminal::{print, tell, write_out};

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
  slipfit run                              the whole job on the CD-ROM slide, into slipfit-out/
  slipfit check my-slide.toml              is the scene sound, at which level does a gap close
  slipfit tolerance three-part-stack       how a product's measures vary, and why
  slipfit allocate clutch-processes        the cheapest tolerances that meet requirements
  slipfit simulate --n 2.5 --csv unit.csv  one unit, tighter by 2.5 sigma
  slipfit sweep --stroke --n 0:5:0.5 --plot force.svg
                                           at which levels n the slide jams on its stroke
  slipfit population --plot units.svg      how many units of the production malfunction, and why
  slipfit table -o force.h                 the flash table as a C header (.bin .hex .h .rs)
  slipfit kernel -o scene.rs               the scene as a Rust constant and type for firmware";

#[derive(Subcommand)]
enum Command {
    Run(run::Arguments),
    Check(check::Arguments),
    Import(import::Arguments),
    Capability(capability::Arguments),
    Identify(identify::Arguments),
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
    Schema(schema::Arguments),
    Watch(watch::Arguments),
}

/// Runs the command that the process was started with.
pub fn main() -> ExitCode {
    ExitCode::from(run(std::env::args_os(), &[]))
}

/// The arguments and their help, for manual pages and completions of shells.
pub fn command() -> clap::Command {
    Cli::command()
}

/// Runs the command line `arguments`, the program's name first, on the terminal. Returns the exit code.
///
/// `program` is what starts this program again, for commands that work in processes of their own; if it is empty, what runs now.
pub fn run(arguments: impl IntoIterator<Item = OsString>, program: &[OsString]) -> u8 {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        // Help and version are asked for; a full disk must not pass unnoticed.
        Err(asked) if !asked.use_stderr() => {
            let text = asked.render();
            let text = if std::io::stdout().is_terminal() { text.ansi().to_string() } else { text.to_string() };
            return u8::from(write_out(&[&text]).is_err());
        }
        Err(wrong) => {
            let _ = wrong.print();
            return 2;
        }
    };
    if let Err(error) = interrupt::install() {
        tell(&format!("error: {error}"));
        return 1;
    }
    let result = match cli.command {
        Some(Command::Watch(arguments)) => arguments.run(program),
        _ => cli.execute(),
    };
    match result {
        Ok(()) => 0,
        Err(failure) => {
            match &failure {
                Failure::Scene(error) => tell(&error.render(std::io::stderr().is_terminal())),
                other => tell(&format!("error: {other}")),
            }
            if matches!(failure, Failure::Work(_)) { 1 } else { 2 }
        }
    }
}

/// Runs a command that another program calls. Nothing is printed.
///
/// # Errors
/// [`Failure`], also for arguments that the command does not have.
pub fn answer(call: &Arc<Call>) -> Result<Answer, Failure> {
    let arguments = std::iter::once("slipfit".into()).chain(call.arguments().iter().cloned());
    let cli = Cli::try_parse_from(arguments).map_err(|wrong| {
        let text = wrong.render().to_string();
        let text = text.split("\n\nUsage:").flat_map(|part| part.split("\n\nFor more")).next().unwrap_or_default();
        Failure::Input(text.trim().trim_start_matches("error: ").to_owned())
    })?;
    if let Some(Command::Watch(_)) = cli.command {
        return Err(Failure::Input("watch: it serves a page until it is stopped, and returns nothing".into()));
    }
    call::within(Some(call.clone()), || cli.execute())?;
    Ok(std::mem::take(&mut *call.answer()))
}

impl Cli {
    fn execute(self) -> Result<(), Failure> {
        match self.command {
            None => print(&Self::command().render_help().to_string()),
            Some(Command::Run(arguments)) => arguments.run(),
            Some(Command::Check(arguments)) => arguments.run(),
            Some(Command::Import(arguments)) => arguments.run(),
            Some(Command::Capability(arguments)) => arguments.run(),
            Some(Command::Identify(arguments)) => arguments.run(),
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
            Some(Command::Schema(arguments)) => arguments.run(),
            Some(Command::Watch(arguments)) => arguments.run(&[]),
        }
    }
}
