//! What is shown on the terminal: texts, tables, JSON, warnings, progress.

use std::{
    io::{ErrorKind, Write},
    path::{Path, PathBuf},
};

use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};

use super::{call, failure::Failure};

/// A progress bar with an estimate, on standard error, if that is a terminal.
pub fn progress(what: &'static str, length: usize) -> ProgressBar {
    if let Some(call) = call::current() {
        return call.bar(what, Some(length as u64));
    }
    let bar = ProgressBar::new(length as u64);
    if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len}{left}") {
        // Before anything is done nobody knows.
        let left = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
            if state.pos() > 0 {
                let _ = write!(out, ", {:#} left", HumanDuration(state.eta()));
            }
        };
        bar.set_style(style.with_key("left", left));
    }
    bar.set_message(what);
    // Shown from the first moment on, not from the first unit that is done.
    bar.enable_steady_tick(std::time::Duration::from_millis(250));
    bar
}

/// Counts what has been done of work whose end is not known.
pub fn counter(what: &'static str) -> ProgressBar {
    if let Some(call) = call::current() {
        return call.bar(what, None);
    }
    let bar = ProgressBar::no_length();
    if let Ok(style) = ProgressStyle::with_template("{spinner} {human_pos} {msg}, {elapsed}") {
        bar.set_style(style);
    }
    bar.set_message(what);
    bar
}

/// Prints a finished text.
pub fn print(text: &str) -> Result<(), Failure> {
    let end = if text.ends_with('\n') { "" } else { "\n" };
    write_out(&[text, end]).map_err(|error| anyhow::Error::from(error).context("standard output").into())
}

/// Writes `texts` to standard output. A reader that has closed its pipe, like `head`, has read what it wants: that is no error.
pub fn write_out(texts: &[&str]) -> std::io::Result<()> {
    if let Some(call) = call::current() {
        call.answer().text.extend(texts.iter().copied());
        return Ok(());
    }
    let mut out = std::io::stdout().lock();
    let written = texts.iter().try_for_each(|text| out.write_all(text.as_bytes())).and_then(|()| out.flush());
    written.or_else(|error| if error.kind() == ErrorKind::BrokenPipe { Ok(()) } else { Err(error) })
}

/// Writes a line to standard error. Where nobody reads it there is nobody to tell that.
pub fn tell(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// The version of what `--json` prints: raised when a field is renamed, removed or means something else.
const JSON_VERSION: u32 = 2;

/// Tells a person of `warnings`, on standard error whatever the command.
pub fn warn(warnings: &[String]) {
    if let Some(call) = call::current() {
        call.answer().warnings.extend_from_slice(warnings);
        return;
    }
    for warning in warnings {
        tell(&format!("warning: {warning}"));
    }
}

/// Those of the `options` that were given, with their paths.
pub fn given<'a, const N: usize>(options: [(&'a str, &'a Option<PathBuf>); N]) -> Vec<(&'a str, &'a Path)> {
    options.into_iter().filter_map(|(name, path)| Some((name, path.as_deref()?))).collect()
}

#[derive(serde::Serialize)]
struct Versioned<'a, T> {
    json_version: u32,
    #[serde(flatten)]
    value: &'a T,
}

/// Prints `value`, an object, as JSON with the version of the format before its fields.
pub fn print_json<T: serde::Serialize>(value: &T) -> Result<(), Failure> {
    let versioned = Versioned { json_version: JSON_VERSION, value };
    print(&serde_json::to_string_pretty(&versioned).map_err(anyhow::Error::from)?)
}

/// A table for people: a heading and rows, numbers to the right.
pub fn text_table(heading: &[&str], rows: &[Vec<String>]) -> String {
    let mut table = comfy_table::Table::new();
    table.load_preset(comfy_table::presets::NOTHING).set_header(heading);
    for rule in [comfy_table::TableComponent::HeaderLines, comfy_table::TableComponent::MiddleHeaderIntersections] {
        table.set_style(rule, '─');
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(comfy_table::CellAlignment::Right);
    }
    table.add_rows(rows);
    table.trim_fmt() + "\n"
}
