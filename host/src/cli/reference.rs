//! The command line's part of the reference.

use std::fmt::Write;

use clap::{Arg, Command, CommandFactory, builder::PossibleValue};

use super::Cli;

/// Every command with its arguments and options.
pub(crate) fn commands() -> String {
    let mut page = String::new();
    for command in Cli::command().get_subcommands() {
        let about = command.get_long_about().or(command.get_about()).map(ToString::to_string).unwrap_or_default();
        let about = sentence(&about);
        let _ = writeln!(page, "\n### `slipfit {}`\n\n{about}\n\n| option | meaning |\n|---|---|", command.get_name());
        for arg in command.get_arguments().filter(|arg| !arg.is_hide_set()) {
            let help =
                arg.get_long_help().or(arg.get_help()).unwrap_or_else(|| panic!("{arg} has no help")).to_string();
            let _ = writeln!(page, "| {} | {}{} |", name(arg), cell(&sentence(&help)), values(arg));
        }
    }
    page
}

/// The `text` with the full stop that clap takes from a single paragraph.
fn sentence(text: &str) -> String {
    format!("{text}{}", if text.ends_with('.') { "" } else { "." })
}

/// How an argument is typed.
fn name(arg: &Arg) -> String {
    let value = arg.get_value_names().map(|names| names.iter().map(|name| format!(" {name}")).collect::<String>());
    let value = value.filter(|_| arg.get_action().takes_values()).unwrap_or_default();
    match (arg.get_long(), arg.get_short()) {
        (Some(long), Some(short)) => format!("`-{short}`, `--{long}{value}`"),
        (Some(long), None) => format!("`--{long}{value}`"),
        (None, Some(short)) => format!("`-{short}{value}`"),
        (None, None) => format!("`{}`", value.trim()),
    }
}

/// What an argument takes, and what it is where it is not given.
fn values(arg: &Arg) -> String {
    let mut text = String::new();
    let possible: Vec<_> = arg.get_possible_values().iter().map(value).collect();
    if arg.get_action().takes_values() && !possible.is_empty() {
        let _ = write!(text, " One of {}.", possible.join(", "));
    }
    let default: Vec<_> = arg.get_default_values().iter().map(|value| value.to_string_lossy()).collect();
    if arg.get_action().takes_values() && !default.is_empty() {
        let _ = write!(text, " Default: `{}`.", default.join(" "));
    }
    cell(&text)
}

/// A value that an argument may have, and what it means if that is told.
fn value(value: &PossibleValue) -> String {
    let help = value.get_help().map(|help| format!(" ({help})")).unwrap_or_default();
    format!("`{}`{help}", value.get_name())
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace("\n\n", " ").replace('\n', " ")
}

/// The exit codes, which the program's own description tells.
pub(crate) fn exit_codes() -> String {
    let command: Command = Cli::command();
    let about = command.get_long_about().map(ToString::to_string).unwrap_or_default();
    let (_, codes) = about.split_once("Exit codes: ").expect("the program's description tells the exit codes");
    let rows = codes.trim_end_matches('.').split(", ").filter_map(|code| code.split_once(' '));
    let rows: String = rows.map(|(code, meaning)| format!("| {code} | {meaning} |\n")).collect();
    format!("| code | meaning |\n|---|---|\n{rows}")
}
