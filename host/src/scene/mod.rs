//! Scene files: what a designer writes, validated and in SI units.
//!
//! A file uses the units of the paper's Table 1 (mm, g, N/mm, N·s/mm) or says its own; this module is the one place
//! where they become SI.

mod contact;
mod diagnostic;
mod drawing;
mod file;
mod friction;
mod identify;
mod include;
mod key_checks;
mod keys;
mod levels;
mod measured;
mod mechanism;
mod parameter;
mod parse;
mod pins;
mod plausible;
mod problem;
mod product;
mod quantity;
#[cfg(test)]
pub(crate) mod reference;
mod shipped;
mod short_form;
mod slide_parameters;
#[cfg(test)]
mod tests;
mod tree;
mod uncertain;
mod value;
mod vary;
mod written;

pub use diagnostic::SceneError;
pub use file::SceneFile;
pub use levels::{LevelError, MOST_LEVELS, parse_levels};
pub use measured::file::{PartsError, is_qif, load as load_parts};
pub use parse::parse_every;
pub use problem::Problem;
pub use shipped::{CD_ROM_SLIDE, SHIPPED, shipped};
pub use written::{callout, tolerance, with_tolerances};

/// A change of one key, from the command line.
#[derive(Clone, Debug, PartialEq)]
pub struct Override {
    /// As typed, for messages: an option, a space, and what follows it.
    text: String,
    /// The key, unless what follows the option names it.
    key: Option<&'static str>,
}

impl std::fmt::Display for Override {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.text)
    }
}

impl Override {
    /// What follows `--set`: `key=value`. The value is TOML or, where that does not parse, a bare text:
    /// `slide.mass=90 g`. A pin goes by its name: `pin.left front.left=[0.01, 0.05]`.
    pub fn set(assignment: &str) -> Self {
        Self::assigned("--set", assignment)
    }

    /// The same behind another `option` (without spaces).
    pub fn assigned(option: &str, assignment: &str) -> Self {
        Self { text: format!("{option} {assignment}"), key: None }
    }

    /// The value of an `option` (without spaces) that stands for `key`.
    pub fn option(option: &str, key: &'static str, value: &str) -> Self {
        Self { text: format!("{option} {value}"), key: Some(key) }
    }
}
