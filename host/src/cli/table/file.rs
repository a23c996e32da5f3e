//! The file of a table: its extension gives the format.

use std::path::Path;

use slipfit_system::files;

use crate::{
    cli::failure::Failure,
    firmware::flash::{
        TABLE_ADDRESS,
        export::{EXTENSIONS, ExportError, render},
    },
};

/// The extension of `output`, if a table can be written in its format.
pub fn format_of(output: &Path) -> Result<String, Failure> {
    let extension = output.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    if EXTENSIONS.contains(&extension.as_str()) {
        Ok(extension)
    } else {
        Err(Failure::Input(format!("--output: {}", ExportError::Extension { found: extension })))
    }
}

/// Writes the `bytes` of a table to `output`, in the format of its `extension`.
pub fn write(output: &Path, extension: &str, bytes: &[u8]) -> Result<(), Failure> {
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let file = render(&stem, extension, bytes, TABLE_ADDRESS).map_err(anyhow::Error::from)?;
    Ok(files::write(output, &file)?)
}
