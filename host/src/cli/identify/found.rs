//! What records of one or several units say.

use slipfit_identify::{compare::Compared, record::Record};

use crate::show::report::{Course, Identified};

/// The records of one unit.
pub struct OfUnit {
    /// As it is called on the command line.
    pub name: String,
    /// Its records.
    pub records: Vec<Record>,
}

/// What the records of one unit say.
pub struct Found {
    /// What was measured (SI), run after run.
    pub measured: Vec<f64>,
    /// When (s) each of it was measured.
    pub times: Vec<f64>,
    /// The number of samples of each run.
    pub runs: Vec<usize>,
    /// Every law with its estimate.
    pub compared: Vec<Compared>,
    /// Which of them counts.
    pub chosen: usize,
    /// Single wrong samples that were replaced.
    pub spikes: Option<usize>,
    /// Cut-off frequency (Hz) of the motion's filter.
    pub cutoff_hz: Option<f64>,
    /// What to know before trusting a figure.
    pub warnings: Vec<String>,
}

impl Found {
    /// What is shown of it on a page; the records are those of its `unit`.
    pub fn on_page<'a>(&'a self, unit: &'a OfUnit) -> Identified<'a> {
        let chosen = &self.compared[self.chosen];
        let (mut courses, mut at) = (Vec::new(), 0);
        for (record, samples) in unit.records.iter().zip(&self.runs) {
            let range = at..at + samples;
            at += samples;
            courses.push(Course {
                name: &record.name,
                times: &self.times[range.clone()],
                measured: &self.measured[range.clone()],
                residuals: &chosen.estimate.residuals[range],
            });
        }
        Identified { chosen, courses }
    }
}

/// How an estimate is written as a table of its scene.
pub struct Written<'a> {
    /// What was compared, with its unit.
    pub compared: &'static str,
    /// "slide", "mechanism" or "drive-train".
    pub model: &'static str,
    /// Exponent of the contacts, if there are any.
    pub exponent: Option<f64>,
    /// For each parameter of the scene the list that states it, if one does; `None` for what no key of a scene says.
    pub lists: &'a [Option<Option<&'static str>>],
}
