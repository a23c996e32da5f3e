//! What is printed as JSON.

use serde::Serialize;
use slipfit_identify::compare::Compared;

/// What the records say.
#[derive(Serialize)]
pub struct Report<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// "slide" or "drive-train".
    pub model: &'static str,
    /// Files of the records.
    pub records: Vec<&'a str>,
    /// The estimate that counts: of the stated law, else of the best one.
    pub law: &'a str,
    /// Single wrong samples that were replaced.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spikes: Option<usize>,
    /// Cut-off frequency (Hz) of the motion's filter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cutoff_hz: Option<f64>,
    /// Every law with its estimate.
    pub compared: &'a [Compared],
    /// What to know before trusting a figure.
    pub warnings: &'a [String],
}
