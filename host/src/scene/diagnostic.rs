//! What is wrong with a scene, and where.

use std::{cell::RefCell, fmt, ops::Range};

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet, normalize_untrusted_str};

use super::problem::Problem;

/// What has been found wrong with a scene so far. Reading goes on behind a wrong value, so that all of them are told at once.
#[derive(Debug, Default)]
pub struct Found {
    errors: RefCell<Vec<SceneError>>,
    warnings: RefCell<Vec<String>>,
}

impl Found {
    /// What `result` holds, or `instead` after its error is noted.
    pub fn recover<T>(&self, result: Result<T, SceneError>, instead: T) -> T {
        result.unwrap_or_else(|error| {
            self.note(error);
            instead
        })
    }

    /// Takes note of an error.
    pub fn note(&self, error: SceneError) {
        self.errors.borrow_mut().push(error);
    }

    /// Takes note of a warning, once.
    pub fn warn(&self, warning: String) {
        let mut warnings = self.warnings.borrow_mut();
        if !warnings.contains(&warning) {
            warnings.push(warning);
        }
    }

    /// The warnings so far, in the order in which they were noted.
    pub fn take_warnings(&self) -> Vec<String> {
        self.warnings.take()
    }

    /// Whether something is wrong.
    pub fn any(&self) -> bool {
        !self.errors.borrow().is_empty()
    }

    /// `result`, unless something was noted: then all of that, with the error of `result` where it would stand without it.
    pub fn conclude<T>(&self, result: Result<T, SceneError>) -> Result<T, SceneError> {
        let mut all: Vec<SceneError> = self.errors.take();
        match result {
            Ok(value) if all.is_empty() => return Ok(value),
            Err(error) if all.is_empty() || error.problem().stands_alone() => all.push(error),
            Ok(_) | Err(_) => {}
        }
        let mut reports = Vec::new();
        for report in all.into_iter().flat_map(|error| error.0) {
            if !reports.contains(&report) {
                reports.push(report);
            }
        }
        // A key that is misspelt is not missing as well.
        let misspelt: Vec<String> = reports
            .iter()
            .filter_map(|report| match &report.problem {
                Problem::UnknownKey { similar, .. } => similar.clone(),
                _ => None,
            })
            .collect();
        reports.retain(|report| !matches!(&report.problem, Problem::Missing(key) if misspelt.contains(key)));
        // The file before the command line, each from its beginning.
        reports.sort_by_key(|report| (report.name == COMMAND_LINE, report.text.clone(), report.span.start));
        Err(SceneError(reports))
    }
}

/// What settings on the command line are called in messages.
pub const COMMAND_LINE: &str = "command line";

/// What is wrong with a scene: one [`Problem`] or several, each with the place it was found at and what is allowed there.
///
/// Displays as several lines for a terminal: the problem; file, line and column; the line with a pointer; what is
/// allowed. A blank line stands between problems.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneError(Vec<Report>);

/// Where a problem is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place<'a> {
    /// The scene file, or [`COMMAND_LINE`].
    pub file: &'a str,
    /// Line, from 1 on.
    pub line: usize,
    /// Column in characters, from 1 on.
    pub column: usize,
    /// What is allowed there; may be empty.
    pub allowed: &'a str,
}

#[derive(Clone, Debug, PartialEq)]
struct Report {
    problem: Problem,
    allowed: String,
    name: String,
    text: String,
    span: Range<usize>,
}

impl SceneError {
    /// A `problem` at the bytes `span` of the `text` called `name`; `allowed` may be empty.
    pub(super) fn new(problem: Problem, allowed: String, name: &str, text: &str, span: Range<usize>) -> Self {
        // A TOML error may lie past the end or inside of a character.
        let floor = |at: usize| (0..=at.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
        let start = floor(span.start);
        let span = start..floor(span.end).max(start);
        Self(vec![Report { problem, allowed, name: name.into(), text: text.into(), span }])
    }

    /// What is wrong first.
    pub fn problem(&self) -> &Problem {
        &self.0[0].problem
    }

    /// All that is wrong, in the order of the text.
    pub fn problems(&self) -> impl Iterator<Item = &Problem> {
        self.0.iter().map(|report| &report.problem)
    }

    /// Where each problem is and what is allowed there, in the order of [`problems`](Self::problems).
    pub fn places(&self) -> impl Iterator<Item = Place<'_>> {
        self.0.iter().map(|report| {
            let before = &report.text[..report.span.start];
            let line = before.bytes().filter(|byte| *byte == b'\n').count() + 1;
            let column = before.chars().rev().take_while(|letter| *letter != '\n').count() + 1;
            Place { file: &report.name, line, column, allowed: &report.allowed }
        })
    }

    /// All that is wrong, each with what is allowed there.
    #[cfg(test)]
    pub(super) fn allowed(&self) -> impl Iterator<Item = (&Problem, &str)> {
        self.0.iter().map(|report| (&report.problem, report.allowed.as_str()))
    }

    /// The message for a terminal, in colour if `color`.
    pub fn render(&self, color: bool) -> String {
        let text = self.0.iter().map(|report| report.render(color)).collect::<Vec<_>>().join("\n\n");
        // The renderer shows the control characters of ASCII; those above it would steer a terminal too.
        text.replace(|letter| matches!(letter, '\u{80}'..='\u{9f}'), "\u{fffd}")
    }
}

impl Report {
    fn render(&self, color: bool) -> String {
        let Self { problem, allowed, name, text, span } = self;
        let pointer = AnnotationKind::Primary.span(span.clone());
        let snippet = Snippet::source(text).path(name).annotation(pointer);
        let group = Level::ERROR.primary_title(problem.to_string()).element(snippet);
        let help = Level::HELP.with_name("allowed").message(normalize_untrusted_str(allowed));
        let report = [if allowed.is_empty() { group } else { group.element(help) }];
        if color { Renderer::styled() } else { Renderer::plain() }.render(&report)
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for SceneError {}
