//! What `check` and `simulate` say of a mechanism of bodies and joints, one file a command.

mod check;
mod simulate;

use std::path::PathBuf;

use serde::Serialize;

use super::{arguments::SceneArguments, failure::Failure, terminal::given};
use crate::{
    dynamics::{error_control::Stopped, outcome::Outcome},
    mechanism::{Action, GapError, Mechanism, RunError},
};

pub(super) use check::{check, warnings_of};
pub(super) use simulate::{OneUnit, simulate};

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Mounts(_)
            | RunError::Bodies(_)
            | RunError::NoUnit(_)
            | RunError::NoKernel(_)
            | RunError::Stopped { stopped: Stopped::Parameter(_) } => Self::Input(error.to_string()),
            RunError::Stopped { .. } => Self::Work(error.into()),
        }
    }
}

impl From<GapError> for Failure {
    fn from(error: GapError) -> Self {
        Self::Input(format!("--n: {error}"))
    }
}

/// What to write and at which level.
pub(super) struct Wanted<'a> {
    pub scene: &'a SceneArguments,
    pub csv: &'a Option<PathBuf>,
    pub plot: &'a Option<PathBuf>,
    pub page: &'a Option<PathBuf>,
    /// Whether the controller's run is shown, not the desk's.
    pub by_controller: bool,
    /// Warnings about the product that the mechanism belongs to.
    pub of_product: Vec<String>,
}

impl Wanted<'_> {
    /// What a designer should know of the `mechanism` and its product before trusting a run.
    fn warnings(&self, mechanism: &Mechanism) -> Result<Vec<String>, Failure> {
        let mut warnings = warnings_of(mechanism)?;
        warnings.extend(self.of_product.iter().cloned());
        Ok(warnings)
    }

    fn check_outputs(&self) -> Result<(), Failure> {
        self.scene.check_outputs(&given([("--csv", self.csv), ("--plot", self.plot), ("--page", self.page)]))
    }
}

/// A drive's outcome with its name.
#[derive(Serialize)]
struct DriveReport<'a> {
    name: &'a str,
    /// N and m/s, or N·m and rad/s.
    unit: &'static str,
    #[serde(flatten)]
    outcome: Outcome,
}

#[derive(Serialize)]
struct GapReport<'a> {
    name: &'a str,
    mm: f64,
    /// The level that closes it; none where it does not vary.
    #[serde(skip_serializing_if = "Option::is_none")]
    closes_at_n: Option<f64>,
}

/// The unit of a drive's force and of its speed.
fn units(action: Action) -> [&'static str; 2] {
    [action.kind().effort_unit(), action.kind().speed_unit()]
}

/// What makes a drive's speed one in the unit that is shown.
fn shown(action: Action) -> f64 {
    action.kind().speed(1.0)
}

fn gap_reports<'a>(mechanism: &'a Mechanism, gaps: &[f64]) -> Vec<GapReport<'a>> {
    let report = |(gap, value): (&'a crate::mechanism::Gap, &f64)| GapReport {
        name: &gap.name,
        mm: value * 1e3,
        closes_at_n: gap.closes_at(),
    };
    mechanism.gaps.iter().zip(gaps).map(report).collect()
}

/// One level for all gaps, or one each.
fn levels<'a>(mechanism: &Mechanism, n: &'a [f64]) -> Result<&'a [f64], Failure> {
    let count = mechanism.gaps.len();
    if n.len() != 1 && n.len() != count {
        return Err(Failure::Input(format!("--n holds {} values, allowed are 1 or {count}, one a gap", n.len())));
    }
    match n.iter().find(|n| !n.is_finite()) {
        Some(bad) => Err(Failure::Input(format!("--n holds {bad}, allowed are finite numbers"))),
        None => Ok(n),
    }
}
