//! Units on their way into a CSV file, or to a program that wants them as columns.

use std::{path::Path, sync::Arc};

use slipfit_system::files::{self, WriteError, Writing};

use crate::{
    cli::{
        call::{self, Call, Want},
        failure::Failure,
    },
    population::{Unit, subject::Subject},
    show::{columns::Columns, export::of_units},
};

/// Rows of units.
pub struct Rows<'a> {
    subject: &'a dyn Subject,
    file: Option<(&'a Path, csv::Writer<Writing>)>,
    /// Who wants them as columns.
    call: Option<Arc<Call>>,
}

impl<'a> Rows<'a> {
    /// For `count` units of `subject` into the file `path`, if there is one. None if nobody wants rows.
    pub fn begin(path: Option<&'a Path>, subject: &'a dyn Subject, count: u64) -> Result<Option<Self>, Failure> {
        let names = of_units(subject, &[]);
        let begin = |path| {
            let mut writer = csv::Writer::from_writer(Writing::begin(path)?);
            names.write_names(&mut writer).map_err(files::failed(path))?;
            Ok::<_, WriteError>((path, writer))
        };
        let file = path.map(begin).transpose()?;
        let call = call::current().filter(|call| call.wants(Want::Columns));
        if let Some(call) = &call {
            let mut none = names;
            Columns::check_space(count, none.0.len())?;
            none.reserve(count as usize);
            call.give(Want::Columns, none);
        }
        Ok((call.is_some() || file.is_some()).then_some(Self { subject, file, call }))
    }

    /// Adds some units.
    pub fn add(&mut self, units: &[Unit]) -> Result<(), WriteError> {
        let columns = of_units(self.subject, units);
        if let Some((path, writer)) = &mut self.file {
            columns.write_rows(writer).map_err(files::failed(path))?;
        }
        if let Some(call) = &self.call {
            call.give(Want::Columns, columns);
        }
        Ok(())
    }

    /// There are no more.
    pub fn end(self) -> Result<(), WriteError> {
        let Some((path, writer)) = self.file else { return Ok(()) };
        writer.into_inner().map_err(csv::IntoInnerError::into_error).map_err(files::failed(path))?.end(path)
    }
}
