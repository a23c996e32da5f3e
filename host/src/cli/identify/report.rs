//! What is printed as JSON.

use serde::Serialize;
use slipfit_identify::{between::Between, compare::Compared, record::Record};

use super::found::{Found, OfUnit};

/// What the records of several units say.
#[derive(Serialize)]
pub struct Report<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// "slide", "mechanism" or "drive-train".
    pub model: &'static str,
    /// What is found of each unit.
    pub units: &'a [UnitReport<'a>],
    /// Each parameter over all units; none where there is one unit.
    pub between: Option<&'a [Between]>,
}

/// What the records of one unit say.
#[derive(Serialize)]
pub struct OneUnit<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// "slide", "mechanism" or "drive-train".
    pub model: &'static str,
    /// What is found.
    #[serde(flatten)]
    pub unit: &'a UnitReport<'a>,
}

/// What is found of one unit.
#[derive(Serialize)]
pub struct UnitReport<'a> {
    /// Files of the records.
    pub records: Vec<&'a str>,
    /// Duration of all of them (s).
    #[serde(skip)]
    pub duration: f64,
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

impl<'a> Report<'a> {
    /// The report of the first unit, where there is one alone.
    pub fn of_one(&self) -> Option<OneUnit<'a>> {
        self.units.first().map(|unit| OneUnit { title: self.title, model: self.model, unit })
    }
}

impl<'a> UnitReport<'a> {
    /// What was `found` of a `unit`.
    pub fn new(unit: &'a OfUnit, found: &'a Found) -> Self {
        Self {
            records: unit.records.iter().map(|record| record.name.as_str()).collect(),
            duration: unit.records.iter().map(Record::duration).sum(),
            law: &found.compared[found.chosen].name,
            spikes: found.spikes,
            cutoff_hz: found.cutoff_hz,
            compared: &found.compared,
            warnings: &found.warnings,
        }
    }
}
