//! Units on their way into a CSV file.

use std::path::Path;

use slipfit_system::files::{self, WriteError, Writing};

use crate::{
    population::{Unit, subject::Subject},
    show::export::UnitRows,
};

/// Rows of units on their way into a file.
pub struct Rows<'a> {
    path: &'a Path,
    subject: &'a dyn Subject,
    rows: UnitRows<Writing>,
}

impl<'a> Rows<'a> {
    /// Into the file `path`, for units of `subject`.
    pub fn begin(path: &'a Path, subject: &'a dyn Subject) -> Result<Self, WriteError> {
        let rows = UnitRows::new(Writing::begin(path)?, subject.kind(), &subject.gap_names());
        Ok(Self { path, subject, rows: rows.map_err(files::failed(path))? })
    }

    /// Adds some units.
    pub fn add(&mut self, units: &[Unit]) -> Result<(), WriteError> {
        let mut add = |unit: &Unit| self.rows.add(self.subject.tightness(&unit.gaps), unit);
        units.iter().try_for_each(&mut add).map_err(files::failed(self.path))
    }

    /// The file is whole.
    pub fn end(self) -> Result<(), WriteError> {
        self.rows.finish().map_err(files::failed(self.path))?.end(self.path)
    }
}
